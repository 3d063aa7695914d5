"""From a resolved scene to the compiled builder: one call for each material, shape, light and setting."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterable
from functools import partial
from math import fsum, inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray import data
from accuray.devices.budget import Budget
from accuray.devices.emitters import spread_emissions
from accuray.devices.instancing import Instancing
from accuray.devices.lights import LightLowering, matrix
from accuray.devices.materials import MaterialLowering
from accuray.devices.rgb_table import rgb_table
from accuray.scene import Scene, SceneError, Spectrum
from accuray.scene import schema as schemas
from accuray.scene.spectrum import interpolate
from accuray.scene.textures import CHANNELS, TextureUse
from accuray.scene.transforms import sine_cosine

Values = dict[str, Any]


MeshReport = dict[str, Any]


def lower(scene: Scene) -> tuple[Any, dict[str, MeshReport]]:
    """The scene's relocatable block (``accuray._core.lower.Block``), and by shape what its mesh lost on the way.

    Raises SceneError for what only the builder can find out, such as a camera that looks at itself.
    """
    lowering = _Lowering(scene)
    return lowering.block(), lowering.reports


class Triangles(NamedTuple):
    """The triangles that a shape is rendered as, before its transform: front sides run counter-clockwise.

    positions: float32 (N, 3), metres. faces: uint32 (M, 3), indices of positions. normals: float32 (N, 3), unit, or
    None for flat shading. uvs: float32 (N, 2), or None. colors: float32 (N, 4), linear Rec.709 and alpha, or None.
    """

    positions: NDArray[np.float32]
    faces: NDArray[np.uint32]
    normals: NDArray[np.float32] | None
    uvs: NDArray[np.float32] | None
    colors: NDArray[np.float32] | None = None


def triangles(scene: Scene, shape: str) -> Triangles:
    """The triangles of a shape of the scene, by its name: a mesh, or a shape that is rendered as one.

    Raises:
        ValueError: the scene has no such shape, or it is not made of triangles.
        SceneError: its parameters contradict each other, or it would take too many triangles.
    """
    lowering = _Lowering(scene)
    if shape not in scene.shapes:
        raise ValueError(f"the scene has no shape {shape!r}: it has {', '.join(scene.shapes) or 'none'}")
    table = scene.shapes[shape]
    if table["type"] != "mesh" and table["type"] not in lowering.solids:
        raise ValueError(f"{shape!r} is a {table['type']}: allowed are mesh, {', '.join(lowering.solids)}")
    result: Triangles = lowering._guard(f"shapes.{shape}", partial(lowering.triangles, shape, table))
    return result


class _Lowering:
    """Walks the resolved tables once; names become the numbers that the block uses."""

    def __init__(self, scene: Scene) -> None:
        from accuray._core import lower as core

        self.scene = scene
        self.cmf, self.d65 = colour_arrays()
        self.builder = core.SceneBuilder(self.cmf, self.d65)
        self.solids: tuple[str, ...] = core.SOLIDS
        self._has_rgb_table = False
        kinds = schemas.current().family("texture").types
        self.budget = Budget(scene.render["compact"])
        self.instancing = Instancing(scene.shapes)
        self._prototypes: dict[str, int] = {}
        self._groups: dict[tuple[str, ...], int] = {}
        self._reads_colors = any(kinds[texture["type"]].reads_colors for texture in scene.textures.values())
        self._spectra: dict[Spectrum, Any] = {}
        self._pictures: dict[tuple[str, tuple[int, ...], bytes], int] = {}
        self.textures: dict[str, int] = {}
        self.materials: dict[str, int] = {}
        self.reports: dict[str, MeshReport] = dict(scene.mesh_reports)

    def block(self) -> Any:
        """Adds everything in a fixed order and finishes the block."""
        builder, film = self.builder, self.scene.film
        for name, texture in self.scene.textures.items():
            self._guard(f"textures.{name}", partial(self._add_texture, name, texture))
        shown, nested = self.instancing.shown, self.instancing.nested
        total = self.instancing.total
        self._guard("shapes", lambda: self.budget.admit_instances(total(shown), total(nested)))
        spread = partial(spread_emissions, self.scene.materials, self.scene.shapes, self.instancing, self.triangles)
        materials = self._guard("materials", spread)
        self.materials = MaterialLowering(materials, builder, self._values_of, self._guard).numbers()
        self._add_shapes()
        values_of = partial(self._values, "light")
        lights = LightLowering(builder, values_of, self._spectrum, self._picture, self._need_rgb_table)
        for name, light in self.scene.lights.items():
            self._guard(f"lights.{name}", partial(lights.add, light))
        camera, pixel_filter, integrator = self.scene.camera, self.scene.filter, self.scene.integrator
        values = self._values("camera", camera)
        self._guard("camera", partial(builder.set_camera, camera["type"], values, film["width"], film["height"]))
        builder.set_filter(pixel_filter["type"], self._values("filter", pixel_filter))
        builder.set_integrator(integrator["type"], self._values("integrator", integrator))
        builder.set_film(film["unit"], film["hide_environment"])
        builder.set_compact(self.scene.render["compact"])
        return builder.finish()

    def _guard(self, key: str, action: Callable[[], Any]) -> Any:
        try:
            return action()
        except ValueError as error:
            file = None if self.scene.path is None else str(self.scene.path)
            problem, *parameter = error.args
            raise SceneError(problem, file=file, key=".".join([key, *parameter])) from error

    def _values(self, family: str, table: Values) -> Values:
        """The numbers, vectors, choices and spectra of a table; the rest has no place in the kernels' structs."""
        return self._values_of(schemas.current().family(family).types[table["type"]].params, table)

    def _values_of(self, params: Iterable[schemas.Param], table: Values) -> Values:
        values: Values = {}
        for param in params:
            value = table.get(param.name)
            if value is None or param.kind in ("text", "file", "transform", "array"):
                continue
            if param.kind == "reference" and isinstance(value, (str, list)):
                continue
            if param.kind == "enum":
                value = param.choices.index(value)
            elif isinstance(value, TextureUse):
                value = self._textured(param, value)
            elif param.kind == "spectrum":
                value = self._spectrum(value)
            elif param.kind == "vec":
                value = (*value, 0.0, 0.0)[:3]
            values[param.name] = float(value) if isinstance(value, (int, float)) else value
        return values

    def _add_texture(self, name: str, texture: Values) -> None:
        pixels = texture.get("pixels")
        picture = None if pixels is None else self._picture(pixels)
        srgb = texture.get("color_space") == "srgb"
        values = self._values("texture", texture)
        self.textures[name] = self.builder.add_texture(texture["type"], values, picture, srgb)

    def _picture(self, pixels: NDArray[Any]) -> int:
        """The builder's number of a picture; those of equal content share one."""
        key = (pixels.dtype.str, pixels.shape, hashlib.sha256(pixels.data).digest())
        if key not in self._pictures:
            self._pictures[key] = self.builder.add_picture(pixels)
        return self._pictures[key]

    def _textured(self, param: schemas.Param, use: TextureUse) -> Any:
        """The builder's form of a value that a texture gives."""
        from accuray._core import lower as core

        texture = self.textures[use.texture]
        if use.channel:
            channel = CHANNELS.index(use.channel) if use.channel in CHANNELS else 0
            if param.kind == "spectrum":
                return self.builder.textured_index(texture, channel, use.scale, param.min, param.max or inf)
            return core.TexturedReal(texture, channel, use.scale)
        self._need_rgb_table()
        if param.role == "emission":
            return self.builder.textured_emission(texture, use.scale)
        return self.builder.textured_reflectance(texture, use.scale)

    def _add_shapes(self) -> None:
        """First what the scene shows itself, then the prototypes, group by group, with their instances."""
        for name, table in self.scene.shapes.items():
            if table["type"] != "instance" and not table["prototype"]:
                self._guard(f"shapes.{name}", partial(self._add_shape, name, table))
        shown = self.instancing.shown
        self.builder.reserve_instances(self.instancing.total(shown))
        for name in shown:
            self._guard(f"shapes.{name}", partial(self._add_instances, name))
        for table in self.scene.shapes.values():
            if table.get("instances") is not None:
                table["instances"].forget()

    def _add_instances(self, name: str) -> None:
        """All instances of groups that an instance shape comes to."""
        lights = 0
        for group, count in self.instancing.counts[name].items():
            number, material = self._group(group.members), self._covering(group.material)
            lights += count * self.builder.most_lights(number, len(group.members), material)
        self.budget.admit_lights(lights)
        for group, rows in self.instancing.copies(name):
            number, material = self._group(group.members), self._covering(group.material)
            self.builder.add_instances(number, len(group.members), rows, material)

    def _covering(self, material: str | None) -> int | None:
        return None if material is None else self.materials[material]

    def _group(self, members: tuple[str, ...]) -> int:
        """The number of the first of some prototypes that follow each other."""
        if members not in self._groups:
            first, *_ = [self._prototype(name) for name in members]
            self._groups[members] = first
        return self._groups[members]

    def _prototype(self, name: str) -> int:
        """A new number for a prototype, whose arrays are in the block once."""
        if name in self._prototypes:
            again: int = self.builder.repeat_geometry(self._prototypes[name])
            return again
        add = partial(self._add_shape, name, self.scene.shapes[name])
        self._prototypes[name] = self._guard(f"shapes.{name}", add)
        return self._prototypes[name]

    def _add_shape(self, name: str, table: Values) -> int:
        material, transform = self.materials[table["material"]], matrix(table["transform"])
        number: int
        if table["type"] == "mesh" or table["type"] in self.solids:
            mesh = self.triangles(name, table)
            if not self._reads_colors:
                mesh = mesh._replace(colors=None)
            self.budget.admit_mesh(mesh)
            number = self.builder.add_mesh(*mesh, transform, material, table["prototype"])
        else:
            values = self._values("shape", table)
            number = self.builder.add_shape(table["type"], values, transform, material, table["prototype"])
        return number

    def triangles(self, name: str, table: Values) -> Triangles:
        """The triangles of a mesh or of one of `solids`."""
        if table["type"] == "mesh":
            return self._mesh(name, table)
        from accuray._core import lower as core

        newell = np.array(data.teapot()) if table["type"] == "teapot" else None
        return Triangles(*core.tessellate(table["type"], self._values("shape", table), newell))

    def _mesh(self, name: str, table: Values) -> Triangles:
        """Arrays of a mesh; those that came from no file are repaired first, as readers do."""
        from accuray._core import mesh as core

        positions, faces, normals, uvs, colors = (
            table[key] for key in ("positions", "faces", "normals", "uvs", "colors")
        )
        if table["file"] is None:
            mesh = core.repair(positions, faces, normals, uvs, colors)
            positions, faces, normals, uvs = mesh.positions, mesh.indices, mesh.normals, mesh.uvs
            colors = mesh.colors
            if mesh.report["nonfinite_triangles"] or mesh.report["degenerate_triangles"]:
                self.reports[name] = mesh.report
        if table["shading"] == "flat":
            normals = None
        elif table["crease_angle"] is not None and normals is None:
            cosine = least_cosine(table["crease_angle"])
            source, faces, normals = core.creased_normals(positions, faces, cosine)
            positions, uvs, colors = (None if a is None else a[source] for a in (positions, uvs, colors))
        elif table["shading"] == "smooth" and normals is None:
            normals = core.smooth_normals(positions, faces)
        return Triangles(positions, faces, normals, uvs, colors)

    def _spectrum(self, spectrum: Spectrum) -> Any:
        """The builder's reference to a spectrum; equal spectra share one."""
        if spectrum not in self._spectra:
            self._spectra[spectrum] = self._make_spectrum(spectrum)
        return self._spectra[spectrum]

    def _make_spectrum(self, s: Spectrum) -> Any:
        b = self.builder
        if s.form == "constant":
            return b.spectrum_constant(s.value * s.scale)
        if s.form == "table":
            points, values = np.array(s.wavelengths, dtype=np.float64), np.array(s.values, dtype=np.float64)
            return b.spectrum_table(points, values, s.extrapolate == "hold", s.scale)
        if s.form == "blackbody":
            return b.spectrum_blackbody(s.kelvin, s.scale)
        if s.form == "sellmeier":
            return b.spectrum_sellmeier(s.A0, list(s.B), list(s.C), s.scale)
        if s.form == "cauchy":
            return b.spectrum_cauchy(s.A0, s.B[0], s.scale)
        if len(set(s.rgb)) > 1:
            self._need_rgb_table()
        add = b.spectrum_rgb_emission if s.role == "emission" else b.spectrum_rgb_reflectance
        return add(*s.rgb, s.scale)

    def _need_rgb_table(self) -> None:
        if not self._has_rgb_table:
            self.builder.set_rgb_table(*rgb_table(self.cmf))
            self._has_rgb_table = True


def colour_arrays() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """CIE 1931 functions (471, 3) and D65 (471,), scaled to Y = 1, at 360, 361, ... 830 nm.

    Only correctly rounded operations in a fixed order: the bits are the same on every machine.
    """
    observer = data.observer()
    cmf = np.ascontiguousarray(np.array([observer.x, observer.y, observer.z], dtype=np.float64).T)
    white = [interpolate(*data.illuminants()["D65"], 360.0 + i, "zero") for i in range(471)]
    scale = fsum(observer.y) / fsum(w * y for w, y in zip(white, observer.y, strict=True))
    return cmf, np.array([w * scale for w in white])


def least_cosine(crease_angle: float) -> float:
    """Cosine of the largest angle, in radians, that is no crease; below all cosines for half a turn."""
    degrees = math.degrees(crease_angle)
    return -2.0 if degrees >= 180.0 else sine_cosine(degrees)[1]
