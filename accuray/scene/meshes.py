"""Mesh files: fills the array parameters of a shape from the file that it names.

The readers belong to ``accuray.formats``, which registers them here when it is imported: this package describes
scenes and does not know file formats.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from accuray.scene.arrays import scale_to_metres
from accuray.scene.errors import Where
from accuray.scene.readers import Readers
from accuray.scene.schema import Type
from accuray.scene.scope import Scope

MeshReader = Callable[[Path], dict[str, Any]]
"""Reads a file into arrays by the names of the parameters: positions float32 (N, 3), faces uint32 (M, 3), and each or
None normals (N, 3), uvs (N, 2), colors (N, 4), linear; and "report", a dict of what was left out or made up. Raises
ValueError with file and line for a wrong file."""

_readers: Readers[dict[str, Any]] = Readers()
register_reader = _readers.register


def fill_from_file(type_: Type, values: dict[str, Any], path: Path, where: Where, scope: Scope) -> dict[str, Any]:
    """Read ``path`` into the array parameters of ``type_`` and return the reader's report.

    Coordinates in the file are in the length unit of the scene file that names it. A file that several shapes or
    frames name is read once.
    """
    key = path, where.source.length_unit
    if key not in scope.meshes:
        arrays = _readers.read(path, where)
        for param in type_.params:
            if param.kind == "array" and arrays.get(param.name) is not None:
                if param.unit == "m":
                    arrays[param.name] = scale_to_metres(arrays[param.name], where.source.length_unit)
                arrays[param.name].flags.writeable = False
        scope.meshes[key] = arrays
    arrays = scope.meshes[key]
    for param in type_.params:
        if param.kind == "array" and arrays.get(param.name) is not None:
            values[param.name] = arrays[param.name]
    report: dict[str, Any] = arrays.get("report") or {}
    return report
