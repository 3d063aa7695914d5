"""Integrals of a density over the cells of a grid, refined where the density is peaked or broken.

Every cell starts as one 4 x 4 Gauss-Legendre rule. A cell whose integral changes when it is split in four is split
again, so the work goes to narrow peaks and to edges (the horizon, the rim of a light) and the rest stays cheap.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Density = Callable[[FloatArray], FloatArray]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_CHUNK = 1 << 16


def cell_integrals(
    density: Density,
    bounds: tuple[tuple[float, float], tuple[float, float]],
    resolution: tuple[int, int],
    tolerance: FloatArray | float,
    max_depth: int = 10,
    budget: int = 4_000_000,
    suspects: NDArray[np.bool_] | None = None,
    forced_depth: int = 6,
) -> FloatArray:
    """Integral of `density` over each cell of a regular grid.

    `density` maps points (N, 2) in the plane to values (N,). `bounds` are the grid's limits on the two axes and
    `resolution` its cells. A piece is split until its integral changes by less than its share of `tolerance` (a scalar
    or one value per cell; the share halves with each split, as an edge crosses twice as many pieces), `max_depth` is
    reached or `budget` evaluations are spent. `suspects` (shape `resolution`) marks cells
    that are split `forced_depth` times whatever the estimate says: a peak between all nodes changes nothing.
    Returns an array of shape `resolution`.
    """
    rows, columns = resolution
    limits = np.broadcast_to(np.asarray(tolerance, dtype=np.float64), resolution).ravel()
    forced = np.zeros(rows * columns, dtype=bool) if suspects is None else suspects.ravel()
    totals = np.zeros(rows * columns)

    cells = np.arange(rows * columns)
    size = np.array([(bounds[0][1] - bounds[0][0]) / rows, (bounds[1][1] - bounds[1][0]) / columns])
    origin = np.array([bounds[0][0], bounds[1][0]])
    corners = origin + size * np.stack([cells // columns, cells % columns], axis=1)
    coarse = _gauss(density, corners, size)
    spent = 16 * len(cells)

    for depth in range(1, max_depth + 1):
        if len(cells) == 0:
            break
        size = 0.5 * size
        children = corners[:, None, :] + size * np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
        fine = _gauss(density, children.reshape(-1, 2), size).reshape(-1, 4)
        spent += 64 * len(cells)
        total = fine.sum(axis=1)
        split = np.abs(total - coarse) > limits[cells] * 0.5 ** (depth - 1)
        split |= forced[cells] & (depth < forced_depth)
        if depth == max_depth or spent + 256 * np.count_nonzero(split) > budget:
            split[:] = False
        np.add.at(totals, cells[~split], total[~split])
        corners = children[split].reshape(-1, 2)
        coarse = fine[split].ravel()
        cells = np.repeat(cells[split], 4)
    return totals.reshape(resolution)


def _gauss(density: Density, corners: FloatArray, size: FloatArray) -> FloatArray:
    """4 x 4 Gauss-Legendre integral over each rectangle (corner, size)."""
    offsets = 0.5 * (_NODES + 1.0)
    u, v = np.meshgrid(offsets, offsets, indexing="ij")
    nodes = size * np.stack([u.ravel(), v.ravel()], axis=1)
    weights = 0.25 * size[0] * size[1] * np.outer(_WEIGHTS, _WEIGHTS).ravel()
    result = np.empty(len(corners))
    for start in range(0, len(corners), _CHUNK):
        part = corners[start : start + _CHUNK]
        values = density((part[:, None, :] + nodes).reshape(-1, 2))
        result[start : start + _CHUNK] = values.reshape(len(part), -1) @ weights
    return result
