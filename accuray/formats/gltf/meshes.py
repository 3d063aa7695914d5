"""Meshes: primitives as the arrays of shapes, each primitive read once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.formats.gltf.accessors import Accessors
from accuray.formats.gltf.document import GltfDocument
from accuray.formats.gltf.item import Item
from accuray.formats.gltf.materials import Materials, Surface
from accuray.formats.models.model import MOST_VERTICES, Model, Options, Table, mesh_table

TRIANGLES, STRIP, FAN = 4, 5, 6
MODES = 7


class Meshes:
    """The meshes of a file as tables of shapes, without the transforms of nodes."""

    def __init__(self, document: GltfDocument, model: Model, options: Options) -> None:
        self._document = document
        self._model = model
        self._options = options
        self._accessors = Accessors(document)
        self._materials = Materials(document, model, options)
        self._tables: dict[int, list[Table]] = {}
        self._prototypes: dict[int, list[str]] = {}
        self._vertices = 0

    def tables(self, index: int) -> list[Table]:
        """A shape for each primitive of a mesh that has triangles."""
        if index not in self._tables:
            mesh = self._document.objects("meshes")[index]
            if mesh.has("weights") or any(primitive.has("targets") for primitive in mesh.items("primitives")):
                self._model.note(mesh.where.key, "morph targets were left out")
            found = [self._table(primitive) for primitive in mesh.items("primitives")]
            self._tables[index] = [table for table in found if table is not None]
        return self._tables[index]

    def prototypes(self, index: int) -> list[str]:
        """The names of the mesh's shapes as prototypes, which are added when they are first asked for."""
        if index not in self._prototypes:
            name, shapes = self._document.objects("meshes")[index].name(f"mesh {index}"), self._model.shapes
            self._prototypes[index] = []
            for table in self.tables(index):
                member = self._model.free_name(shapes, name)
                shapes[member] = {**table, "prototype": True}
                self._prototypes[index].append(member)
        return self._prototypes[index]

    def _table(self, primitive: Item) -> Table | None:
        from accuray._core import mesh as core

        mode = primitive.integer("mode", TRIANGLES, 0, MODES - 1)
        if mode not in (TRIANGLES, STRIP, FAN):
            self._model.note(primitive.where.key, "points and lines were left out")
            return None
        attributes = primitive.table("attributes")
        if not attributes.has("POSITION"):
            self._model.note(primitive.where.key, "has no positions and was left out")
            return None
        for name in primitive.table("extensions").value:
            self._model.note(primitive.where.key, f"{name} was left out")
        colored = attributes.has("COLOR_0")
        material = primitive.index("material", len(self._document.objects("materials")))
        surface = self._materials.surface(material, colored)
        positions = self._accessors.floats(attributes, "POSITION", (3,))
        self._count(primitive, len(positions))
        faces = self._faces(primitive, mode, len(positions))
        arrays = core.repair(
            np.ascontiguousarray(positions),
            np.ascontiguousarray(faces),
            self._attribute(attributes, "NORMAL", (3,), len(positions)),
            self._coordinates(attributes, surface, len(positions)),
            self._colors(attributes, surface, len(positions)),
        )
        for key in ("nonfinite_triangles", "degenerate_triangles"):
            if arrays.report[key]:
                self._model.note(primitive.where.key, f"{arrays.report[key]} {key.replace('_', ' ')} were left out")
        return mesh_table(arrays, surface.name, self._options.crease_angle) if len(arrays.indices) else None

    def _count(self, primitive: Item, vertices: int) -> None:
        self._vertices += vertices
        if self._vertices > MOST_VERTICES:
            raise primitive.where.error(
                "is too large with what came before it", allowed=f"up to {MOST_VERTICES} vertices"
            )

    def _faces(self, primitive: Item, mode: int, vertices: int) -> NDArray[np.uint32]:
        """Triangles (M, 3) of an indexed or plain list, strip or fan."""
        if primitive.has("indices"):
            order = self._accessors.indices(primitive, "indices", vertices)
        else:
            order = np.arange(vertices, dtype=np.uint32)
        if mode == TRIANGLES:
            if len(order) % 3:
                self._model.note(primitive.where.key, "the last triangle lacks corners and was left out")
            return order[: len(order) - len(order) % 3].reshape(-1, 3)
        if len(order) < 3:
            return np.empty((0, 3), dtype=np.uint32)
        if mode == FAN:
            return np.stack([np.full(len(order) - 2, order[0]), order[1:-1], order[2:]], axis=1)
        faces = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
        faces[1::2] = faces[1::2][:, [1, 0, 2]]
        return faces

    def _coordinates(self, attributes: Item, surface: Surface, vertices: int) -> NDArray[np.float32] | None:
        """Texture coordinates with v upwards: in glTF it runs down the picture."""
        uvs = self._attribute(attributes, f"TEXCOORD_{surface.coordinates}", (2,), vertices)
        if uvs is None:
            return None
        return np.ascontiguousarray(np.stack([uvs[:, 0], np.float32(1.0) - uvs[:, 1]], axis=1))

    def _colors(self, attributes: Item, surface: Surface, vertices: int) -> NDArray[np.float32] | None:
        """Linear colours and alpha, times the material's factor; only where the material shows them."""
        if surface.tint is None:
            return None
        colors = self._attribute(attributes, "COLOR_0", (3, 4), vertices)
        if colors is None:
            return None
        if colors.shape[1] == 3:
            colors = np.concatenate([colors, np.ones((vertices, 1), dtype=np.float32)], axis=1)
        tinted = np.clip(colors, 0.0, 1.0) * np.array(surface.tint, dtype=np.float32)
        return np.ascontiguousarray(tinted, dtype=np.float32)

    def _attribute(self, attributes: Item, key: str, widths: tuple[int, ...], vertices: int) -> Any:
        """A float32 array of as many rows as there are vertices, None if the primitive has no such attribute."""
        if not attributes.has(key):
            return None
        array = self._accessors.floats(attributes, key, widths)
        if len(array) != vertices:
            raise attributes.child(key).error(f"has {len(array)} elements", f"{vertices}, as many as POSITION")
        return np.ascontiguousarray(array)
