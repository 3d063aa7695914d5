"""Shapes that fill the rooms and meadows of ``benchmarks.worlds``: smooth ones with normals, boxes without."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks.geometry import Mesh

Doubles = NDArray[np.float64]
Grid = tuple[Doubles, Doubles]
"""Positions and unit normals (rows, columns, 3)."""


def grid_mesh(name: str, material: str, grid: Grid) -> Mesh:
    """Two triangles for each cell, front towards the normals when columns x rows points there; UVs from 0 to 1."""
    positions, normals = grid
    rows, columns = positions.shape[:2]
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns + 1, a + columns
    faces = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=2).reshape(-1, 3)
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    uvs = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)
    flat = [array.reshape(-1, 3).astype(np.float32) for array in (positions, normals)]
    return Mesh(name, material, flat[0], faces.astype(np.int32), flat[1], uvs)


def surface(point: Callable[[Doubles, Doubles], Doubles], rows: int, columns: int) -> Grid:
    """The grid of a function of (u around, v along), both from 0 to 1; normals by central differences."""
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    step = 1e-5
    along = point(u, v + step) - point(u, v - step)
    around = point(u + step, v) - point(u - step, v)
    normals = np.cross(around, along)
    return point(u, v), normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def lathe(profile: Callable[[Doubles], Doubles], height: float, flutes: int, depth: float) -> Callable[..., Doubles]:
    """A column along +y of the radius ``profile(v)``, with grooves of a relative depth."""

    def point(u: Doubles, v: Doubles) -> Doubles:
        angle = -2.0 * np.pi * u
        radius = profile(v) * (1.0 - depth * np.abs(np.sin(0.5 * flutes * angle)))
        return np.stack([radius * np.cos(angle), height * v, radius * np.sin(angle)], axis=-1)

    return point


def knot(p: int, q: int, radius: float, winding: float, tube: float) -> Callable[..., Doubles]:
    """A torus knot about +y: p times around the axis, q times through the ring."""

    def middle(v: Doubles) -> Doubles:
        turn, wind = 2.0 * np.pi * p * v, 2.0 * np.pi * q * v
        reach = radius + winding * np.cos(wind)
        return np.stack([reach * np.cos(turn), winding * np.sin(wind), reach * np.sin(turn)], axis=-1)

    def point(u: Doubles, v: Doubles) -> Doubles:
        along = middle(v + 1e-4) - middle(v - 1e-4)
        outwards = middle(v) * [1.0, 0.0, 1.0]
        across = _unit(np.cross(along, outwards))
        other = _unit(np.cross(along, across))
        angle = 2.0 * np.pi * u[..., None]
        return middle(v) + tube * (np.cos(angle) * across + np.sin(angle) * other)

    return point


def _unit(vectors: Doubles) -> Doubles:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def box(center: Sequence[float], size: Sequence[float], turn: float = 0.0) -> list[list[list[float]]]:
    """The six sides of a box as quads, fronts outside; ``turn`` about +y in radians."""
    quads = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            u, v = np.zeros(3), np.zeros(3)
            u[(axis + 1) % 3], v[(axis + 2) % 3] = sign, 1.0
            n = np.zeros(3)
            n[axis] = sign
            quads.append([n - u - v, n + u - v, n + u + v, n - u + v])
    corners = np.array(quads) * 0.5 * np.asarray(size)
    c, s = np.cos(turn), np.sin(turn)
    placed: list[list[list[float]]] = (corners @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) + center).tolist()
    return placed


def placed(mesh: Mesh, offset: Sequence[float]) -> Mesh:
    """The mesh moved."""
    moved = (mesh.positions + np.asarray(offset)).astype(np.float32)
    return Mesh(mesh.name, mesh.material, moved, mesh.triangles, mesh.normals, mesh.uvs)


def joined(name: str, material: str, parts: Sequence[Mesh]) -> Mesh:
    """Smooth meshes as one."""
    starts = np.cumsum([0, *(len(part.positions) for part in parts)])
    faces = [part.triangles + start for part, start in zip(parts, starts[:-1], strict=True)]
    columns = [np.concatenate([getattr(part, key) for part in parts]) for key in ("positions", "normals", "uvs")]
    return Mesh(name, material, columns[0], np.concatenate(faces).astype(np.int32), columns[1], columns[2])
