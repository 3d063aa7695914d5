"""Wavefront OBJ with the materials of its MTL files: one shape for each material."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.formats.mesh import read_compiled
from accuray.formats.models import mtl
from accuray.formats.models.model import Model, Options, mesh_table
from accuray.formats.models.mtl import MtlMaterial
from accuray.formats.models.mtl_materials import translate
from accuray.formats.models.plain import COLORED, MATERIAL, note_report, place
from accuray.scene.errors import Document, Source, Where
from accuray.scene.paths import display_path

MOST_LIBRARIES = 100


def read(path: Path, options: Options) -> Model:
    """The model in an OBJ file and its MTL files. Raises SceneError or ValueError."""
    arrays = read_compiled(path)
    model = Model(path.parent)
    note_report(model, path.stem, arrays.report)
    library = _libraries(path, arrays.libraries, model, options)
    if arrays.materials is None:
        _add(model, path.stem, arrays, _plain(model, arrays), options)
        return model
    names = [_material(model, name, library, arrays, options) for name in arrays.material_names]
    for number, name in enumerate(arrays.material_names):
        part = _part(arrays, np.flatnonzero(arrays.materials == number))
        _add(model, name or path.stem, part, names[number], options)
    return model


class _Part:
    """Triangles of one material, with the vertices that they use."""

    def __init__(self, arrays: Any, vertices: NDArray[Any], faces: NDArray[np.uint32]) -> None:
        self.positions = arrays.positions[vertices]
        self.indices = faces
        self.normals, self.uvs, self.colors = (
            None if values is None else values[vertices] for values in (arrays.normals, arrays.uvs, arrays.colors)
        )


def _part(arrays: Any, triangles: NDArray[np.intp]) -> _Part:
    corners = arrays.indices[triangles]
    vertices, faces = np.unique(corners, return_inverse=True)
    return _Part(arrays, vertices, faces.reshape(corners.shape).astype(np.uint32))


def _add(model: Model, name: str, arrays: Any, material: str, options: Options) -> None:
    if len(arrays.indices):
        shape = place(mesh_table(arrays, material, options.crease_angle), options)
        model.shapes[model.free_name(model.shapes, name)] = shape


def _plain(model: Model, arrays: Any) -> str:
    """The material of faces without one: matte, in the colours of the vertices if they have any."""
    if "surface" not in model.materials:
        if arrays.colors is not None:
            model.textures["vertex colours"] = {"type": "vertex_color"}
        model.materials["surface"] = dict(MATERIAL if arrays.colors is None else COLORED)
    return "surface"


def _material(model: Model, name: str, library: dict[str, MtlMaterial], arrays: Any, options: Options) -> str:
    """The name in the model of a material that the file uses; a matte one in place of one that is nowhere."""
    if name not in library:
        if name:
            model.note(f"material {name}", "is in none of the files that mtllib names; the surface is matte")
        return _plain(model, arrays)
    if name not in model.materials:
        model.materials[name] = translate(library[name], model, options)
    return name


def _libraries(path: Path, lines: list[str], model: Model, options: Options) -> dict[str, MtlMaterial]:
    """The materials of all MTL files; one that is not there is noted, one beyond the scene's folders an error."""
    found: dict[str, MtlMaterial] = {}
    where = Where(Document({}, Source(display_path(path), folder=path.parent)), ("mtllib",))
    for line in lines[:MOST_LIBRARIES]:
        for name in _file_names(line, path.parent):
            if not os.path.exists(path.parent / name):  # also false for names that no file can have
                model.note(f"mtllib {name}", "does not exist")
                continue
            found = {**mtl.read(options.files.resolve(name, where)), **found}
    if len(lines) > MOST_LIBRARIES:
        raise where.error(f"names {len(lines)} lines of files", allowed=f"up to {MOST_LIBRARIES}")
    return found


def _file_names(line: str, folder: Path) -> list[str]:
    """The files that a line names: one with blanks in its name if there is such a file, else one for each word."""
    line = line.replace("\\", "/")
    safe = 0 < len(line) < 256 and "\0" not in line
    return [line] if safe and (folder / line).exists() else line.split(maxsplit=MOST_LIBRARIES)[:MOST_LIBRARIES]
