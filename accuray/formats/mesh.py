"""Mesh files, read by the compiled module, which is imported when the first one is met."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from accuray.scene.paths import display_path


def read_obj(path: Path, polygons: bool = False) -> dict[str, Any]:
    """Wavefront OBJ: arrays as ``accuray.scene.meshes.MeshReader`` says."""
    from accuray._core import mesh

    return _arrays(mesh.read_obj(display_path(path), polygons))


def read_ply(path: Path, polygons: bool = False) -> dict[str, Any]:
    """Stanford PLY, ASCII or binary: arrays as ``accuray.scene.meshes.MeshReader`` says."""
    from accuray._core import mesh

    return _arrays(mesh.read_ply(display_path(path), polygons))


def read_stl(path: Path, polygons: bool = False) -> dict[str, Any]:
    """STL, ASCII or binary, which has only triangles: arrays as ``accuray.scene.meshes.MeshReader`` says."""
    from accuray._core import mesh

    return _arrays(mesh.read_stl(display_path(path)))


def _arrays(mesh: Any) -> dict[str, Any]:
    """The reader's arrays under the names of the shape parameters."""
    return {
        "positions": mesh.positions,
        "faces": mesh.indices,
        "normals": mesh.normals,
        "uvs": mesh.uvs,
        "colors": mesh.colors,
        "polygons": mesh.polygons,
        "report": mesh.report,
    }
