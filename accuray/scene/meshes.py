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
from accuray.scene.schema import Type

MeshReader = Callable[[Path], dict[str, Any]]
"""Reads a file into arrays by the names of the parameters: positions float32 (N, 3), faces uint32 (M, 3), and each or
None normals (N, 3), uvs (N, 2), colors (N, 4), linear; and "report", a dict of what was left out or made up. Raises
ValueError with file and line for a wrong file."""

_readers: dict[str, MeshReader] = {}


def register_reader(suffix: str, reader: MeshReader) -> None:
    """Use ``reader`` for files with this lower-case suffix (".obj")."""
    _readers[suffix] = reader


def fill_from_file(type_: Type, values: dict[str, Any], path: Path, where: Where) -> dict[str, Any]:
    """Read ``path`` into the array parameters of ``type_`` and return the reader's report.

    Coordinates in the file are in the length unit of the scene file that names it.
    """
    reader = _readers.get(path.suffix.lower())
    if reader is None:
        known = ", ".join(_readers) or "none (import accuray.formats)"
        raise where.error("has no reader", value=path.name, allowed=known)
    try:
        arrays = reader(path)
    except (ValueError, OSError) as error:
        raise where.error(f"cannot be read: {error}", value=path.name) from error
    for param in type_.params:
        if param.kind == "array" and arrays.get(param.name) is not None:
            array = arrays[param.name]
            values[param.name] = scale_to_metres(array, where.source.length_unit) if param.unit == "m" else array
    report: dict[str, Any] = arrays.get("report") or {}
    return report
