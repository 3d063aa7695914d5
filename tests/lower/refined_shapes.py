"""Scenes of one refined shape, control meshes, and what the tests of them measure."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray

Floats = NDArray[np.float64]

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
LOWER_LOOP = [[0, 1, 10], [1, 5, 10], [5, 4, 10], [4, 0, 10]]
"""The edges of the cube's side y = 0."""


def scene_of(shape: dict[str, Any], **sections: Any) -> accuray.Scene:
    grey = {"type": "diffuse", "reflectance": 0.5}
    return accuray.Scene.from_dict(
        {"materials": {"grey": grey}, "shapes": {"it": {"material": "grey", **shape}}, **sections}
    )


def mesh_of(shape: dict[str, Any], **sections: Any) -> accuray.Triangles:
    return accuray.triangles(scene_of(shape, **sections), "it")


def surface(
    positions: Any, faces: Any, levels: int = 2, scheme: str = "catmull_clark", **keys: Any
) -> accuray.Triangles:
    arrays = {"positions": np.asarray(positions), "faces": faces}
    return mesh_of({"type": "mesh", "subdivision": scheme, "subdivision_levels": levels, **arrays, **keys})


def cut(faces: list[list[int]]) -> list[list[int]]:
    """The triangles of quadrilaterals."""
    return [triangle for a, b, c, d in faces for triangle in ([a, b, c], [a, c, d])]


def grid(n: int, m: int) -> list[list[int]]:
    """Quadrilaterals between n x m vertices, row by row."""
    corners = [(i * m + j, i * m + j + 1) for i in range(n - 1) for j in range(m - 1)]
    return [[a, a + m, b + m, b] for a, b in corners]


def open_edges(mesh: accuray.Triangles) -> int:
    """Directed edges between places that no triangle runs along the other way exactly once."""
    _, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    triangles = place.ravel()[mesh.faces]
    ends = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    edges = Counter(map(tuple, ends.tolist()))
    return sum(count != 1 or edges[b, a] != 1 for (a, b), count in edges.items())


def missing(points: Floats, mesh: accuray.Triangles) -> float:
    """The largest distance of one of the points from the nearest vertex."""
    apart = np.abs(points[:, None] - mesh.positions.astype(np.float64)[None]).max(axis=2)
    return float(apart.min(axis=1).max())
