"""Writes meshes as binary PLY files, which the reader gives back bit by bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_PROPERTIES = {
    "positions": ("x", "y", "z"),
    "normals": ("nx", "ny", "nz"),
    "uvs": ("u", "v"),
    "colors": ("red", "green", "blue", "alpha"),
}


def write_ply(path: Path, mesh: dict[str, Any]) -> None:
    """Writes ``positions``, ``faces`` (M, 3) and, where there are any, ``normals``, ``uvs`` and ``colors``.

    Colours are linear, as floats in a PLY file are. Raises OSError.
    """
    used = [name for name in _PROPERTIES if mesh.get(name) is not None]
    names = [prop for name in used for prop in _PROPERTIES[name]]
    vertices = np.concatenate([np.asarray(mesh[name], dtype="<f4") for name in used], axis=1)
    faces: NDArray[np.uint32] = np.asarray(mesh["faces"])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar uint vertex_indices", "end_header", ""]
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<u4", (3,))])
    rows["count"], rows["corners"] = 3, faces
    with path.open("wb") as file:
        file.write("\n".join(header).encode("ascii"))
        file.write(np.ascontiguousarray(vertices, dtype="<f4").tobytes())
        file.write(rows.tobytes())
