"""Shapes on their way to the compiled builder: what stands, what moves, and groups that instances show."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray import data
from accuray.devices.budget import Budget
from accuray.devices.instancing import IDENTITY, Instancing, Rows, product
from accuray.devices.kept import Kept, stands_alone
from accuray.devices.lights import matrix
from accuray.devices.motion import Eye, body_keys, box_under, check_error, shape_box
from accuray.devices.refining import Refiner, Triangles, is_refined, least_cosine
from accuray.scene import Scene
from accuray.scene import schema as schemas
from accuray.scene.deformation import deforms
from accuray.scene.motion import Motion

Values = dict[str, Any]
MeshReport = dict[str, Any]


def solids() -> tuple[str, ...]:
    """Types of shapes that are rendered as triangles, besides meshes and rectangles."""
    from accuray._core import lower as core

    return tuple(core.SOLIDS)


def is_meshed(table: Values) -> bool:
    """Does Python make the triangles of a shape?"""
    return table["type"] == "mesh" or table["type"] in solids() or is_refined(table)


class Tools(NamedTuple):
    """What shapes need of the scene's lowering.

    builder: ``accuray._core.lower.SceneBuilder``. kept: parts of an earlier frame. values: numbers of a family's table
    for the builder. guard: runs an action under a key for errors. refiner: cuts shapes finely.
    """

    builder: Any
    kept: Kept
    values: Callable[[str, Values], Values]
    guard: Callable[[str, Callable[[], Any]], Any]
    refiner: Refiner


class ShapeLowering:
    """Adds the shapes of a scene to its builder.

    ``reports`` says, by shape, what its mesh lost on the way and what was made up; ``moves`` whether anything does
    while the shutter is open.
    """

    def __init__(self, scene: Scene, tools: Tools) -> None:
        self.scene = scene
        self.builder, self.kept, self._values, self._guard, self._refiner = tools
        self.budget = Budget(scene.render["compact"])
        self.instancing = Instancing(scene.shapes)
        self.reports: dict[str, MeshReport] = dict(scene.mesh_reports)
        self.moves = False
        self.materials: dict[str, int] = {}
        kinds = schemas.current().family("texture").types
        self._reads_colors = any(kinds[texture["type"]].reads_colors for texture in scene.textures.values())
        self._eye = Eye(scene.camera, scene.film)
        self._boxes: dict[str, NDArray[np.float64]] = {}
        self._prototypes: dict[str, int] = {}
        self._groups: dict[tuple[str, ...], int] = {}
        self._refined: dict[str, Triangles] = {}

    def admit(self) -> None:
        """Refuses more instances than memory holds. Raises SceneError."""
        shown, nested = self.instancing.shown(), self.instancing.nested()
        total = self.instancing.total
        self._guard("shapes", lambda: self.budget.admit_instances(total(shown), total(nested)))

    def add(self, materials: dict[str, int]) -> None:
        """First what the scene shows itself and is still, then the prototypes, group by group, with their instances.

        What moves is an instance of itself. ``materials``: numbers of the materials by their names.
        """
        self.materials = materials
        moving = []
        for name, table in self.scene.shapes.items():
            if table["type"] == "instance" or table["prototype"]:
                continue
            if isinstance(table["transform"], Motion):
                moving.append(name)
            else:
                self._guard(f"shapes.{name}", partial(self._add_shape, name, table))
        for name in moving:
            table = {**self.scene.shapes[name], "transform": None, "prototype": True}
            number = self._guard(f"shapes.{name}", partial(self._add_shape, name, table))
            self._guard(f"shapes.{name}", partial(self._add_moving, name, number, (name,), IDENTITY, None))
        shown = self.instancing.shown()
        self.builder.reserve_instances(self.instancing.total(shown) + len(moving))
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
        moves = isinstance(self.scene.shapes[name]["transform"], Motion)
        for group, rows in self.instancing.copies(name):
            number, material = self._group(group.members), self._covering(group.material)
            if moves:
                self._add_moving(name, number, group.members, rows, material)
            else:
                self.builder.add_instances(number, len(group.members), rows, material)

    def _add_moving(self, name: str, first: int, members: tuple[str, ...], rows: Rows, material: int | None) -> None:
        """A group under each of some transforms (n, 12), all of which move as the shape of this name does."""
        boxes = np.array([self._boxes[member] for member in members])
        around = np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
        for row in rows:
            keys = body_keys(self.scene.shapes[name]["transform"], box_under(row, around), self._eye)
            check_error(keys)
            if keys.error > 0.0:
                self.reports[name] = {**self.reports.get(name, {}), "motion_error": keys.error}
            self.builder.add_moving_instance(first, len(members), product(keys.rows, row[None]), material)
        self.moves = True

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
        material = self.materials[table["material"]]
        number: int
        if is_meshed(table):
            mesh = self._placed_mesh(name, table)
            self._boxes[name] = np.array(mesh.box, dtype=np.float64)
            number = self.builder.add_mesh(mesh, material, table["prototype"])
        else:
            self._boxes[name] = shape_box(table)
            values, transform = self._values("shape", table), matrix(table["transform"])
            number = self.builder.add_shape(table["type"], values, transform, material, table["prototype"])
        return number

    def _placed_mesh(self, name: str, table: Values) -> Any:
        """The mesh of a shape in its place, which scenes that show the same one share."""
        from accuray._core import lower as core

        sources: list[Any] = []
        options: list[Any] = [self._reads_colors, None if stands_alone(table) else object()]
        for key, value in table.items():
            if isinstance(value, np.ndarray) and key != "transform":
                sources.append(value)
            elif key not in ("material", "prototype", "file"):
                options.append((key, value.tobytes() if isinstance(value, np.ndarray) else value))

        def place() -> tuple[Any, MeshReport | None]:
            self.reports.pop(name, None)
            mesh = self.triangles(name, table)
            if not self._reads_colors:
                mesh = mesh._replace(colors=None)
            self.budget.admit_mesh(mesh)
            segments = 0 if mesh.positions.ndim == 2 else len(mesh.positions) - 1
            rows = mesh._replace(
                positions=mesh.positions.reshape(-1, 3),
                normals=None if mesh.normals is None else np.ascontiguousarray(mesh.normals).reshape(-1, 3),
            )
            return core.place_mesh(*rows, matrix(table["transform"]), segments), self.reports.get(name)

        self.moves |= deforms(table)
        placed, report = self.kept.part("mesh", tuple(sources), tuple(options), place)
        if report is not None:
            self.reports[name] = report
        return placed

    def triangles(self, name: str, table: Values) -> Triangles:
        """The triangles of a shape that is_meshed()."""
        if not is_refined(table):
            return self._plain(name, table)
        if name not in self._refined:
            self._refined[name], report = self._refiner.triangles(table, partial(self._plain, name, table))
            self.reports[name] = self.reports.get(name, {}) | report
        return self._refined[name]

    def _plain(self, name: str, table: Values) -> Triangles:
        """The triangles that a shape has before it is refined."""
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
        if positions.ndim == 3:
            return self._deforming_mesh(table)
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

    @staticmethod
    def _deforming_mesh(table: Values) -> Triangles:
        """A mesh of several forms, with a form of its normals for each; what moves is not repaired."""
        from accuray._core import mesh as core

        positions, faces, normals = table["positions"], table["faces"], table["normals"]
        if table["shading"] == "flat":
            normals = None
        elif table["shading"] == "smooth" and normals is None:
            normals = np.stack([core.smooth_normals(form, faces) for form in positions])
        elif normals is not None and normals.ndim == 2:
            normals = np.broadcast_to(normals, positions.shape)
        return Triangles(positions, faces, normals, table["uvs"], table["colors"])
