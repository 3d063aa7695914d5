"""Mesh files: fills the array parameters of a shape from the file that it names.

The readers belong to ``accuray.formats``, which registers them here when it is imported: this package describes
scenes and does not know file formats.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from accuray.scene.arrays import polygon_sizes, scale_to_metres
from accuray.scene.deformation import KeyedFiles, arrays_over_shutter
from accuray.scene.errors import Where
from accuray.scene.readers import Readers
from accuray.scene.schema import Type
from accuray.scene.scope import Scope

MeshReader = Callable[..., dict[str, Any]]
"""Reads a file into arrays by the names of the parameters: positions float32 (N, 3), faces uint32 (M, 3), and each or
None normals (N, 3), uvs (N, 2), colors (N, 4), linear; and "report", a dict of what was left out or made up. Raises
ValueError with file and line for a wrong file. With ``polygons=True``, for the control mesh of a surface: also
"polygons" uint32 (P,), the corners of each polygon whose fans the faces are, or None; and no normals."""

CATMULL_CLARK = "catmull_clark"
POLYGONS = "polygons"
"""What a control mesh has besides its parameters: how many corners each polygon has, None for triangles."""

_readers: Readers[dict[str, Any]] = Readers()
register_reader = _readers.register


def keep_polygons(values: dict[str, Any], given: dict[str, Any]) -> None:
    """Adds to a surface of polygons how many corners each of the ``faces`` has that the scene gives."""
    if values.get("subdivision") == CATMULL_CLARK and "faces" in given:
        values[POLYGONS] = polygon_sizes(given["faces"])


def fill_from_file(
    type_: Type, values: dict[str, Any], file: Path | KeyedFiles, where: Where, scope: Scope
) -> dict[str, Any]:
    """Read a file, or one for each key, into the array parameters of ``type_`` and return the first reader's report.

    Coordinates in the file are in the length unit of the scene file that names it. A file that several shapes or
    frames name is read once.
    """
    polygons = values.get("subdivision") == CATMULL_CLARK

    def read(path: Path, place: Where) -> dict[str, Any]:
        key = path, place.source.length_unit, polygons
        if key not in scope.meshes:
            scope.meshes[key] = _arrays_in_metres(type_, path, place, polygons)
        return scope.meshes[key]

    arrays = read(file, where) if isinstance(file, Path) else arrays_over_shutter(file, read, scope)
    if polygons:
        values[POLYGONS] = arrays.get(POLYGONS)
    for param in type_.params:
        if param.kind == "array" and arrays.get(param.name) is not None:
            values[param.name] = arrays[param.name]
    report: dict[str, Any] = arrays.get("report") or {}
    return report


def _arrays_in_metres(type_: Type, path: Path, where: Where, polygons: bool) -> dict[str, Any]:
    """What a file holds, no longer writable; with its polygons if they are asked for."""
    arrays = _readers.read(path, where, polygons=True) if polygons else _readers.read(path, where)
    for param in type_.params:
        if param.kind == "array" and arrays.get(param.name) is not None:
            if param.unit == "m":
                arrays[param.name] = scale_to_metres(arrays[param.name], where.source.length_unit)
            arrays[param.name].flags.writeable = False
    return arrays
