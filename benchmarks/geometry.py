"""Triangle meshes for the benchmark scenes, and binary PLY to hand the same bytes to every renderer."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Quad = Sequence[Sequence[float]]


@dataclass(frozen=True)
class Mesh:
    """Triangles of one material, in metres, front side counter-clockwise.

    ``positions`` is (N, 3) float32, ``triangles`` (M, 3) int32; ``normals`` (N, 3) and ``uvs`` (N, 2) come together
    with a smooth mesh and are None for a flat one.
    """

    name: str
    material: str
    positions: Floats
    triangles: NDArray[np.int32]
    normals: Floats | None = None
    uvs: Floats | None = None


def quad_mesh(name: str, material: str, quads: Sequence[Quad], unit: float) -> Mesh:
    """Mesh of quads (v0, v1, v2, v3), each split along v0-v2; ``unit`` is their unit in metres."""
    corners = np.asarray(quads, dtype=np.float64).reshape(-1, 3) * unit
    first = np.arange(0, len(corners), 4, dtype=np.int32)[:, None, None]
    split = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    return Mesh(name, material, corners.astype(np.float32), (first + split).reshape(-1, 3))


def carpet(name: str, material: str, corner: Sequence[float], size: float, repeats: float) -> Mesh:
    """A square that faces up, from ``corner`` along +x and -z, with UVs from 0 to ``repeats`` along its sides."""
    x, y, z = corner
    positions = [[x, y, z], [x + size, y, z], [x + size, y, z - size], [x, y, z - size]]
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=np.float32) * np.float32(repeats)
    normals = np.tile(np.array([0, 1, 0], dtype=np.float32), (4, 1))
    faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    return Mesh(name, material, np.array(positions, dtype=np.float32), faces, normals, uvs)


def widened(quad: Quad, factor: float) -> list[list[float]]:
    """A horizontal quad scaled about its middle."""
    corners = np.asarray(quad, dtype=np.float64)
    middle = corners.mean(axis=0)
    scaled: list[list[float]] = (middle + (corners - middle) * [factor, 1.0, factor]).tolist()
    return scaled


def frame_around(outer: Quad, hole: Quad) -> list[Quad]:
    """Four quads between two coplanar quads of the same winding and first corner; all share corners (no T-junction)."""
    around = [(k, (k + 1) % 4) for k in range(4)]
    return [[outer[a], outer[b], hole[b], hole[a]] for a, b in around]


def bumpy_sphere(name: str, material: str, center: Sequence[float], radius: float, segments: int, rings: int) -> Mesh:
    """A closed sphere with bumps: 2 * segments * rings triangles, exact smooth normals, latitude-longitude UVs.

    The radius in direction d is ``radius * (1 + f(d))`` with f a sum of products of sines; the normal is the gradient
    of |p| - radius (1 + f(p / |p|)). The first meridian is stored twice, with equal positions and u = 0 and 1.
    """
    theta = np.arange(1, rings + 1) * (np.pi / (rings + 1))
    phi = (np.arange(segments + 1) % segments) * (2 * np.pi / segments)
    sin_theta = np.sin(theta)[:, None]
    grid = np.stack([sin_theta * np.cos(phi), np.cos(theta)[:, None] + 0 * phi, -sin_theta * np.sin(phi)], axis=-1)
    directions = np.concatenate([[[0.0, 1.0, 0.0]], grid.reshape(-1, 3), [[0.0, -1.0, 0.0]]])
    height, slope = _bumps(directions)
    tangential = slope - directions * np.sum(slope * directions, axis=1, keepdims=True)
    normals = directions - tangential / (1 + height)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    positions = np.asarray(center) + radius * (1 + height) * directions
    u, v = np.meshgrid(np.arange(segments + 1) / segments, 1 - theta / np.pi)
    uvs = np.concatenate([[[0.5, 1.0]], np.stack([u, v], axis=-1).reshape(-1, 2), [[0.5, 0.0]]])
    return Mesh(
        name,
        material,
        positions.astype(np.float32),
        _sphere_triangles(segments, rings),
        normals.astype(np.float32),
        uvs.astype(np.float32),
    )


def _bumps(directions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Relative height (N, 1) and its gradient (N, 3) in direction space."""
    height = np.zeros((len(directions), 1))
    slope = np.zeros_like(directions)
    for amplitude, frequency in ((0.10, 5.0), (0.015, 23.0)):
        sine, cosine = np.sin(frequency * directions + 0.5), np.cos(frequency * directions + 0.5)
        height += amplitude * np.prod(sine, axis=1, keepdims=True)
        for axis in range(3):
            others = np.prod(np.delete(sine, axis, axis=1), axis=1)
            slope[:, axis] += amplitude * frequency * cosine[:, axis] * others
    return height, slope


def _sphere_triangles(segments: int, rings: int) -> NDArray[np.int32]:
    """Triangles of a latitude-longitude grid: vertex 0 is the pole +y, then rings of segments + 1, then the pole -y."""
    width = segments + 1
    row, column = np.meshgrid(np.arange(rings - 1), np.arange(segments), indexing="ij")
    a = 1 + row * width + column
    b, c, d = a + width, a + width + 1, a + 1
    body = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=2).reshape(-1, 3)
    k = np.arange(segments)
    last = 1 + (rings - 1) * width
    top = np.stack([np.zeros_like(k), 1 + k, 2 + k], axis=-1)
    bottom = np.stack([np.full_like(k, 1 + rings * width), last + k + 1, last + k], axis=-1)
    return np.concatenate([top, body, bottom]).astype(np.int32)


def write_ply(mesh: Mesh, path: Path) -> None:
    """Binary little-endian PLY: x y z, with nx ny nz s t for a smooth mesh, and triangles as uchar + 3 int."""
    names, columns = ["x", "y", "z"], [mesh.positions]
    if mesh.normals is not None and mesh.uvs is not None:
        names += ["nx", "ny", "nz", "s", "t"]
        columns += [mesh.normals, mesh.uvs]
    faces = np.empty(len(mesh.triangles), dtype=[("count", "u1"), ("indices", "<i4", 3)])
    faces["count"], faces["indices"] = 3, mesh.triangles
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.positions)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    with path.open("wb") as file:
        file.write(("\n".join(header) + "\n").encode())
        file.write(np.hstack(columns).astype("<f4").tobytes())
        file.write(faces.tobytes())
