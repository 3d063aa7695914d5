"""A deterministic finite-element solution of diffuse interreflection, independent of the renderer.

Radiosity after Goral et al. (1984), constant elements, in units of radiance: L_i = rho_i (D_i + sum_j F_ij L_j), where
D is what the lamp's emission alone brings. The inner integral of a form factor is exact including visibility
(`form_factors.py`); the outer one, over the receiving element, is a 2 x 2 Gauss rule, 4 x 4 for the direct light D,
which carries the shadows' edges. Area averages converge with the square of the element size.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .enclosure import Enclosure, Piece
from .form_factors import Array, Patches, factors

CHUNK = 256
"""Receiving points handled at once: bounds the memory of one step."""


@dataclass(frozen=True, eq=False)
class Elements:
    """A mesh of one planar piece: the patches it shows to others and their areas (N,)."""

    piece: Piece
    patches: Patches
    areas: Array

    def quadrature(self, order: int) -> tuple[Array, Array]:
        """Gauss points (N, order**2, 3) on every element and their weights (N, order**2), which add up to 1."""
        nodes, weights = np.polynomial.legendre.leggauss(order)
        s, t = (grid.ravel() for grid in np.meshgrid(0.5 + 0.5 * nodes, 0.5 + 0.5 * nodes))
        basis = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
        along = np.stack([t - 1, 1 - t, t, -t])
        across = np.stack([s - 1, -s, s, 1 - s])
        corners = self.patches.vertices[self.patches.quads]
        d_s, d_t = (np.einsum("kq,nki->nqi", derivative, corners) for derivative in (along, across))
        jacobian = np.linalg.norm(np.cross(d_s, d_t), axis=2) * np.outer(weights, weights).ravel()
        return np.einsum("kq,nki->nqi", basis, corners), jacobian / jacobian.sum(axis=1, keepdims=True)


def macro_elements(scene: Enclosure, size: float, finer: dict[str, float] | None = None) -> list[Array]:
    """Quadrilaterals (Q, 4, 3) per piece, at most `size` wide or what `finer` says for the piece's surface."""
    sizes = [(finer or {}).get(piece.surface, size) for piece in scene.pieces]
    return [
        np.concatenate([_cells(corners, *_counts(corners, width)) for corners in piece.quads])
        for piece, width in zip(scene.pieces, sizes, strict=True)
    ]


def mesh(scene: Enclosure, macros: list[Array], refinement: int) -> list[Elements]:
    """Divide every macro element of every piece into refinement x refinement elements."""
    meshes = []
    for piece, quads in zip(scene.pieces, macros, strict=True):
        corners = np.concatenate([_cells(quad, refinement, refinement) for quad in quads])
        areas = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
        meshes.append(Elements(piece, _patches(scene, piece, corners), areas))
    return meshes


def _counts(corners: Array, size: float) -> tuple[int, int]:
    """How many elements of at most the given size a quadrilateral needs in its two directions."""
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    columns, rows = np.ceil(np.maximum(sides[:2], sides[2:]) / size)
    return int(columns), int(rows)


def _cells(corners: Array, columns: int, rows: int) -> Array:
    """The cells (columns * rows, 4, 3) of a bilinear grid over a quadrilateral (4, 3)."""
    s, t = np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    basis = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=2)
    grid = basis @ corners
    cells = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)
    return np.asarray(cells.reshape(-1, 4, 3))


def _patches(scene: Enclosure, piece: Piece, corners: Array) -> Patches:
    """Quadrilaterals (N, 4, 3) of a piece as targets: the blocks that may hide them are all but the piece's own.

    Coincident corners become one vertex, so that neighbours share edges and each edge is evaluated once.
    """
    loose = corners.reshape(-1, 3)
    _, first, index = np.unique(loose.round(6), axis=0, return_index=True, return_inverse=True)
    normal = piece.normal
    offset = float(loose[0] @ normal)
    blocks = {k: block.clipped(normal, offset) for k, block in enumerate(scene.blocks) if k != piece.block}
    return Patches(loose[first], index.reshape(-1, 4), normal, blocks)


def _seen(receiver: Elements, targets: list[Patches], order: int) -> Iterator[Array]:
    """Form factors (N, e, order**2) of all N targets at the Gauss points of a receiver's elements, e at a time."""
    points = receiver.quadrature(order)[0]
    step = max(1, CHUNK // order**2)
    for start in range(0, len(points), step):
        part = points[start : start + step]
        flat = part.reshape(-1, 3)
        columns = [factors(flat, receiver.patches.normal, target, receiver.piece.block) for target in targets]
        yield np.concatenate(columns).reshape(-1, *part.shape[:2])


def form_factors(meshes: list[Elements], order: int = 2) -> Array:
    """Form factors (N, N) between all elements: row i holds what element i receives from each."""
    targets = [elements.patches for elements in meshes]
    total = sum(len(elements.areas) for elements in meshes)
    matrix = np.empty((total, total))
    row = 0
    for receiver in meshes:
        weights, first = receiver.quadrature(order)[1], 0
        for seen in _seen(receiver, targets, order):
            count = seen.shape[1]
            matrix[row : row + count] = np.einsum("neq,eq->en", seen, weights[first : first + count])
            row, first = row + count, first + count
    return matrix


def direct(scene: Enclosure, meshes: list[Elements], lamp: str, order: int = 4) -> list[Array]:
    """Form factors (N, order**2) of the whole, undivided lamp at the Gauss points of the elements of every piece."""
    lamps = [_patches(scene, piece, piece.quads) for piece in scene.pieces if piece.surface == lamp]
    return [np.concatenate([seen.sum(axis=0) for seen in _seen(receiver, lamps, order)]) for receiver in meshes]


@dataclass(frozen=True, eq=False)
class Solution:
    """Area averages (W,) of outgoing radiance by name, per unit of lamp radiance, and what bounds their errors.

    `closure` is the largest deviation of a row sum of the form factors from 1; `reciprocity` compares A_i F_ij with
    A_j F_ji: the root mean square of the differences over that of the values.
    """

    averages: dict[str, Array]
    elements: int
    closure: float
    reciprocity: float


def solve(scene: Enclosure, meshes: list[Elements], reflectance: dict[str, Array], lamp: str) -> Solution:
    """Radiance averages for reflectances (W,) by material and a lamp of radiance 1, its emission included."""
    matrix = form_factors(meshes)
    areas = np.concatenate([elements.areas for elements in meshes])
    owner = np.repeat(np.arange(len(meshes)), [len(elements.areas) for elements in meshes])
    light = zip(direct(scene, meshes, lamp), meshes, strict=True)
    source = np.concatenate([np.sum(samples * elements.quadrature(4)[1], axis=1) for samples, elements in light])
    albedo = np.stack([reflectance[piece.material] for piece in scene.pieces])[owner]
    emission = np.array([float(piece.surface == lamp) for piece in scene.pieces])[owner]
    radiance = emission[:, None] + sum_of_bounces(matrix, albedo, source[:, None])

    averages = {}
    for name, numbers in scene.groups().items():
        inside = np.isin(owner, numbers)
        averages[name] = np.average(radiance[inside], axis=0, weights=areas[inside])
    return Solution(averages, len(areas), float(np.abs(matrix.sum(axis=1) - 1.0).max()), asymmetry(matrix, areas))


def sum_of_bounces(matrix: Array, albedo: Array, source: Array) -> Array:
    """Reflected radiance (N, W) for form factors (N, N), albedos (N, W) and direct light (N, 1)."""
    bounce = albedo * source
    total = bounce.copy()
    while bounce.max() > 1e-12 * total.max():
        bounce = albedo * (matrix @ bounce)
        total += bounce
    return np.asarray(total)


def asymmetry(matrix: Array, areas: Array) -> float:
    """Root mean square of A_i F_ij - A_j F_ji over that of A_i F_ij."""
    difference, magnitude = 0.0, 0.0
    for row, column, area in zip(matrix, matrix.T, areas, strict=True):
        difference += float(np.sum((row * area - column * areas) ** 2))
        magnitude += float(np.sum((row * area) ** 2))
    return float(np.sqrt(difference / magnitude))


def extrapolate(coarse: Array, fine: Array, ratio: float) -> Array:
    """Richardson's limit of two solutions, for errors that fall as the square of an element size reduced by `ratio`."""
    return np.asarray(fine + (fine - coarse) / (ratio**2 - 1.0))
