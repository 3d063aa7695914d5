"""Pearson's chi-square test of a sampler against the probability density it claims to have.

A histogram of samples is compared, cell by cell, with the integral of the density over the cell. Cells that expect
fewer than five samples are pooled, and samples that the sampler gave up (weight 0) or that fall outside the grid form
one more cell, so a density that integrates to less than one is tested as well as one that integrates to one.

    result = chi2_test(sampler, lambda w: np.maximum(w[:, 2], 0) / np.pi)
    assert result, result.reason
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from accuray.testing.domains import Domain, Sphere
from accuray.testing.quadrature import cell_integrals
from accuray.testing.stats import chi2_sf, sidak

FloatArray = NDArray[np.float64]
#: u (N, d) in [0, 1) -> samples (N, k) and weights (N,): 1 for a sample, 0 for one that the sampler gave up.
Sampler = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
#: samples (N, k) -> density (N,) with respect to the measure of the domain (solid angle for directions).
Pdf = Callable[[FloatArray], FloatArray]

_MIN_EXPECTED = 5.0
_MAX_SUSPECTS = 400


@dataclass(frozen=True)
class Chi2Result:
    """Outcome of one test; true when it passed."""

    passed: bool
    reason: str
    p_value: float
    statistic: float
    dof: int
    samples: int
    histogram_total: float
    pdf_total: float

    def __bool__(self) -> bool:
        return self.passed


@dataclass(frozen=True)
class _Histogram:
    counts: FloatArray
    outside: float
    fault: str


def chi2_test(
    sampler: Sampler,
    pdf: Pdf,
    *,
    domain: Domain | None = None,
    samples: int = 1_000_000,
    resolution: tuple[int, int] = (101, 202),
    dimensions: int = 2,
    tests: int = 1,
    alpha: float = 0.01,
    seed: int = 0,
    tolerance: float = 1e-3,
    stray: float = 1e-5,
) -> Chi2Result:
    """Test `sampler` against `pdf` with `samples` random inputs of `dimensions` numbers each.

    `tests` is the number of tests made together: each uses Sidak's significance for `alpha` in all. Apart from the
    p-value the test fails when a weight is negative, anything is not finite, the pdf is negative anywhere, more than
    the fraction `stray` of the samples lies where the pdf is 0 (rounding at an edge explains a few), or the histogram
    or the pdf sums to more than 1 + `tolerance`. A test with a single cell has no power and fails.
    Single-precision inputs are used, so `u` is exactly representable on both sides and below 1.
    """
    grid = domain or Sphere()
    rng = np.random.default_rng(seed)
    u = rng.random((samples, dimensions), dtype=np.float32).astype(np.float64)
    points, weights = sampler(u)
    points, weights = np.asarray(points, dtype=np.float64), np.asarray(weights, dtype=np.float64)
    histogram = _histogram(points, weights, pdf, grid, resolution, stray)
    total = (histogram.counts.sum() + histogram.outside) / samples
    if not histogram.fault and total > 1.0 + tolerance:
        histogram = _Histogram(histogram.counts, histogram.outside, f"the histogram sums to {total:.6g}, more than 1")
    if histogram.fault:
        return Chi2Result(False, histogram.fault, 0.0, np.inf, 0, samples, float(total), np.nan)

    expected, fault = _expected_counts(pdf, grid, resolution, histogram.counts, samples)
    pdf_total = float(expected.sum()) / samples
    if not fault and pdf_total > 1.0 + tolerance:
        fault = f"the pdf integrates to {pdf_total:.6g}, more than 1"
    if fault:
        return Chi2Result(False, fault, 0.0, np.inf, 0, samples, float(total), pdf_total)

    missing_observed = samples - float(histogram.counts.sum())
    missing_expected = max(0.0, samples - float(expected.sum()))
    statistic, dof = pearson(np.append(histogram.counts, missing_observed), np.append(expected, missing_expected))
    if dof < 1:
        reason = "no power: all expected samples fall into one cell; use a narrower domain or a finer grid"
        return Chi2Result(False, reason, 0.0, statistic, dof, samples, float(total), pdf_total)
    p_value = chi2_sf(statistic, dof)
    limit = sidak(alpha, tests)
    passed = p_value >= limit
    reason = f"p = {p_value:.4g} ({'not ' if passed else ''}below {limit:.3g}), chi2 = {statistic:.1f} with {dof} dof"
    return Chi2Result(passed, reason, p_value, statistic, dof, samples, float(total), pdf_total)


def pearson(observed: FloatArray, expected: FloatArray) -> tuple[float, int]:
    """Pearson's statistic and its degrees of freedom, cells below five expected counts pooled (smallest first).

    Both arrays hold one value per cell, of equal totals. A pool that stays below five joins the smallest other cell.
    """
    order = np.argsort(expected, kind="stable")
    observed, expected = observed[order], expected[order]
    cumulative = np.cumsum(expected)
    small = int(np.searchsorted(expected, _MIN_EXPECTED))
    if small and cumulative[small - 1] < _MIN_EXPECTED:
        small = min(small + 1, len(expected))
    if small:
        observed = np.append(observed[small:], observed[:small].sum())
        expected = np.append(expected[small:], expected[:small].sum())
    if len(expected) < 2:
        return 0.0, 0
    return float(np.sum((observed - expected) ** 2 / expected)), len(expected) - 1


def _histogram(
    points: FloatArray, weights: FloatArray, pdf: Pdf, domain: Domain, resolution: tuple[int, int], stray: float
) -> _Histogram:
    """Weighted counts per cell, the weight outside the grid, and what is plainly wrong with the samples."""
    empty = np.zeros(resolution)
    if not np.isfinite(weights).all():
        return _Histogram(empty, 0.0, f"{np.count_nonzero(~np.isfinite(weights))} weights are not finite")
    if (weights < 0).any():
        return _Histogram(empty, 0.0, f"{np.count_nonzero(weights < 0)} weights are negative")
    points, weights = points[weights > 0], weights[weights > 0]
    if not np.isfinite(points).all():
        return _Histogram(empty, 0.0, f"{np.count_nonzero(~np.isfinite(points))} sample coordinates are not finite")

    (x0, x1), (y0, y1) = domain.bounds
    plane = domain.to_plane(points)
    scaled = (plane - [x0, y0]) / [x1 - x0, y1 - y0]
    inside = ((scaled >= 0.0) & (scaled <= 1.0)).all(axis=1)
    cell = np.minimum((scaled[inside] * resolution).astype(np.int64), np.asarray(resolution) - 1)
    flat = cell[:, 0] * resolution[1] + cell[:, 1]
    counts = np.bincount(flat, weights=weights[inside], minlength=resolution[0] * resolution[1]).astype(np.float64)
    histogram = _Histogram(counts.reshape(resolution), float(weights[~inside].sum()), "")

    density = np.asarray(pdf(points))
    fault = _density_fault(density)
    impossible = int(np.count_nonzero(density <= 0.0)) if not fault else 0
    if impossible > stray * max(1, len(density)):
        fault = f"{impossible} of {len(density)} samples lie where the pdf is 0"
    return _Histogram(histogram.counts, histogram.outside, fault)


def _density_fault(density: FloatArray) -> str:
    """What is wrong with values of a density, or nothing."""
    if not np.isfinite(density).all():
        return f"the pdf is not finite at {np.count_nonzero(~np.isfinite(density))} points"
    if (density < 0.0).any():
        return f"the pdf is negative at {np.count_nonzero(density < 0.0)} points"
    return ""


def _expected_counts(
    pdf: Pdf, domain: Domain, resolution: tuple[int, int], counts: FloatArray, samples: int
) -> tuple[FloatArray, str]:
    """Expected count of each cell: the quadrature error is kept well below the statistical noise of the cell.

    Cells whose count disagrees with the first estimate are integrated again with forced refinement: they hold either
    a fault of the sampler, which stays, or a peak that the first nodes missed, which goes.
    """
    faults: list[str] = []

    def density(plane: FloatArray) -> FloatArray:
        values = np.asarray(pdf(domain.from_plane(plane)), dtype=np.float64)
        fault = _density_fault(values)
        if fault:
            faults.append(fault)
        return samples * values

    tolerance = 0.1 * np.sqrt(counts + _MIN_EXPECTED)
    expected = cell_integrals(density, domain.bounds, resolution, tolerance)
    suspects = np.abs(counts - expected) > 4.0 * np.sqrt(np.maximum(expected, _MIN_EXPECTED))
    if not faults and 0 < np.count_nonzero(suspects) <= _MAX_SUSPECTS:
        expected = cell_integrals(density, domain.bounds, resolution, tolerance, suspects=suspects)
    return expected, faults[0] if faults else ""
