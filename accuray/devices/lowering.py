"""From a resolved scene to the compiled builder: one call for each material, shape, light and setting."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from functools import cache, partial
from math import fsum, inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray import data
from accuray.devices.emitters import spread_emissions
from accuray.devices.kept import Kept
from accuray.devices.lights import LightLowering
from accuray.devices.materials import MaterialLowering
from accuray.devices.motion import Eye, camera_in_place, camera_keys, check_error
from accuray.devices.refining import Refiner, Triangles
from accuray.devices.rgb_table import rgb_table
from accuray.devices.shapes import MeshReport, ShapeLowering, Tools, is_meshed, solids
from accuray.scene import Scene, SceneError, Spectrum
from accuray.scene import schema as schemas
from accuray.scene.motion import Motion
from accuray.scene.spectrum import interpolate
from accuray.scene.textures import CHANNELS, TextureUse

Values = dict[str, Any]


def lower(scene: Scene, kept: Kept | None = None) -> tuple[Any, dict[str, MeshReport]]:
    """The scene's relocatable block (``accuray._core.lower.Block``), and by shape what its mesh lost on the way.

    ``kept`` holds the parts of an earlier frame and takes those of this one. Raises SceneError for what only the
    builder can find out, such as a camera that looks at itself.
    """
    lowering = _Lowering(scene, kept)
    return lowering.block(), lowering.shapes.reports


def with_camera(scene: Scene, block: Any) -> Any | None:
    """The block of a scene that differs in its camera alone; None if it must be lowered anew. Raises SceneError."""
    from accuray._core import lower as core

    camera = scene.camera
    params = schemas.current().family("camera").types[camera["type"]].params
    plain = ("float", "vec", "enum", "int", "bool", "transform")
    if isinstance(camera["transform"], Motion) or any(
        camera[p.name] is not None and p.kind not in plain for p in params
    ):
        return None
    return _Lowering(scene)._with_camera(partial(core.with_camera, block))


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
    if not is_meshed(table):
        raise ValueError(f"{shape!r} is a {table['type']}: allowed are mesh, {', '.join(solids())}")
    lowering.add_textures()
    result: Triangles = lowering._guard(f"shapes.{shape}", partial(lowering.shapes.triangles, shape, table))
    return result


class _Lowering:
    """Walks the resolved tables once; names become the numbers that the block uses."""

    def __init__(self, scene: Scene, kept: Kept | None = None) -> None:
        from accuray._core import lower as core

        self.scene = scene
        self.kept = Kept() if kept is None else kept
        self.cmf, self.d65 = colour_arrays()
        self.builder = core.SceneBuilder(self.cmf, self.d65)
        self._has_rgb_table = False
        self._spectra: dict[Spectrum, Any] = {}
        self._pictures: dict[tuple[str, tuple[int, ...], bytes], int] = {}
        self.textures: dict[str, int] = {}
        self.materials: dict[str, int] = {}
        refiner = Refiner(
            lambda texture, uvs, points: self.builder.texture_values(self.textures[texture], uvs, points),
            cache(lambda: self._with_camera(core.camera_view)),
        )
        self.shapes = ShapeLowering(scene, Tools(self.builder, self.kept, self._values, self._guard, refiner))

    def block(self) -> Any:
        """Adds everything in a fixed order and finishes the block."""
        builder, film = self.builder, self.scene.film
        self.add_textures()
        self.shapes.admit()
        spread = partial(
            spread_emissions,
            *(self.scene.materials, self.scene.shapes, self.shapes.instancing, self.shapes.triangles),
        )
        materials = self._guard("materials", spread)
        self.materials = MaterialLowering(materials, builder, self._values_of, self._guard).numbers()
        self.shapes.add(self.materials)
        values_of = partial(self._values, "light")
        lights = LightLowering(builder, values_of, self._spectrum, self._picture, self._need_rgb_table)
        for name, light in self.scene.lights.items():
            self._guard(f"lights.{name}", partial(lights.add, light))
        pixel_filter, integrator = self.scene.filter, self.scene.integrator
        self._set_camera()
        builder.set_filter(pixel_filter["type"], self._values("filter", pixel_filter))
        builder.set_integrator(integrator["type"], self._values("integrator", integrator))
        builder.set_film(film["unit"], film["hide_environment"])
        builder.set_compact(self.scene.render["compact"])
        return builder.finish()

    def add_textures(self) -> None:
        """Gives the builder the scene's textures, which materials and displacement refer to."""
        for name, texture in self.scene.textures.items():
            self._guard(f"textures.{name}", partial(self._add_texture, name, texture))

    def _with_camera(self, action: Callable[..., Any]) -> Any:
        camera, film = self.scene.camera, self.scene.film
        values = self._values("camera", camera_in_place(camera))
        return self._guard("camera", partial(action, camera["type"], values, film["width"], film["height"]))

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
        from accuray._core import lower as core

        def shared() -> tuple[bytes, Any]:
            return hashlib.sha256(pixels.data).digest(), core.Picture(pixels)

        digest, picture = self.kept.part("picture", (pixels,), None, shared)
        key = (pixels.dtype.str, pixels.shape, digest)
        if key not in self._pictures:
            self._pictures[key] = self.builder.add_picture(picture)
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

    def _set_camera(self) -> None:
        self._with_camera(self.builder.set_camera)
        camera = self.scene.camera
        if isinstance(camera["transform"], Motion):
            keys = camera_keys(camera["transform"], camera["position"], Eye(camera, self.scene.film))
            self._guard("camera", partial(check_error, keys))
            self.builder.set_camera_motion(keys.rows)
        if (self.shapes.moves or isinstance(camera["transform"], Motion)) and self.scene.clock.shutter:
            self.builder.set_shutter(*np.array(self.scene.clock.shutter, dtype=np.float64).T.copy())

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
