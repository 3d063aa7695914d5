"""Reads the binary PLY files of the benchmark scenes (those that ``benchmarks.geometry.write_ply`` writes)."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def read_ply(path: Path) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Vertex columns (N, 3 or 8) in the file's order and triangles (M, 3)."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    columns = sum(line.startswith("property float") for line in header)
    vertices = np.frombuffer(data, "<f4", counts["vertex"] * columns, end).reshape(-1, columns)
    layout = np.dtype([("count", "u1"), ("indices", "<i4", 3)])
    faces = np.frombuffer(data, layout, counts["face"], end + vertices.nbytes)
    if not np.all(faces["count"] == 3):
        raise ValueError(f"{path}: only triangles are expected")
    return vertices, np.ascontiguousarray(faces["indices"])
