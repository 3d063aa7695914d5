"""Mesh files, read by the compiled module, which is imported when the first one is met."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from accuray.scene import memory
from accuray.scene.paths import display_path

TEXT = 6
"""Bytes of a file for each byte of its arrays, at most: numbers as text."""


def read(path: Path, polygons: bool = False) -> dict[str, Any]:
    """Wavefront OBJ, Stanford PLY or STL, by its ending: arrays as ``accuray.scene.meshes.MeshReader`` says."""
    mesh = read_compiled(path, polygons)
    return {
        "positions": mesh.positions,
        "faces": mesh.indices,
        "normals": mesh.normals,
        "uvs": mesh.uvs,
        "colors": mesh.colors,
        "polygons": mesh.polygons,
        "report": mesh.report,
    }


def read_compiled(path: Path, polygons: bool = False) -> Any:
    """The compiled reader's mesh; with polygons a control mesh.

    Raises ValueError for a wrong file, and for one whose arrays do not fit in memory.
    """
    from accuray._core import mesh

    if path.suffix.lower() == ".ply":
        return mesh.read_ply(display_path(path), polygons, memory.available_bytes())
    size = path.stat().st_size
    memory.check_fits(size // TEXT, f"a mesh from {size} bytes")
    if path.suffix.lower() == ".obj":
        return mesh.read_obj(display_path(path), polygons)
    return mesh.read_stl(display_path(path))
