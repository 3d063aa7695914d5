"""Energy and symmetry of a scattering model: albedo, agreement of sample and eval, reciprocity, white furnace.

All adapters work on arrays of unit directions (N, 3) in the local frame whose +z is the shading normal.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from accuray.testing.domains import Sphere
from accuray.testing.quadrature import cell_integrals
from accuray.testing.stats import sidak, two_sided_threshold

FloatArray = NDArray[np.float64]
#: u (N, d) -> weights (N,): f |cos| / pdf of the sampled direction, 0 for a failed sample.
WeightSampler = Callable[[FloatArray], FloatArray]
#: wi (N, 3) -> f(wo, wi) |cos theta_i| (N,) for one fixed wo.
Eval = Callable[[FloatArray], FloatArray]
#: (wo, wi), both (N, 3) -> f(wo, wi) without the cosine (N,).
Bsdf = Callable[[FloatArray, FloatArray], FloatArray]


@dataclass(frozen=True)
class Estimate:
    """A mean, its standard error and the number of samples behind them."""

    mean: float
    error: float
    count: int


@dataclass(frozen=True)
class FurnaceResult:
    """Outcome of an energy test; true when it passed."""

    passed: bool
    reason: str
    albedo: Estimate

    def __bool__(self) -> bool:
        return self.passed


def albedo(weights: WeightSampler, *, samples: int = 100_000, dimensions: int = 3, seed: int = 0) -> Estimate:
    """Directional albedo by importance sampling: the mean weight. Raises ValueError for a weight that is not finite."""
    u = np.random.default_rng(seed).random((samples, dimensions), dtype=np.float32).astype(np.float64)
    w = np.asarray(weights(u), dtype=np.float64)
    if not np.isfinite(w).all():
        raise ValueError(f"{np.count_nonzero(~np.isfinite(w))} of {samples} weights are not finite")
    return Estimate(float(w.mean()), float(w.std(ddof=1) / math.sqrt(samples)), samples)


def energy_test(
    weights: WeightSampler, *, samples: int = 100_000, dimensions: int = 3, seed: int = 0, tests: int = 1
) -> FurnaceResult:
    """No direction may send back more than it received: albedo at most 1, noise allowed for."""
    value = albedo(weights, samples=samples, dimensions=dimensions, seed=seed)
    limit = 1.0 + 1e-5 + two_sided_threshold(2.0 * sidak(0.01, tests)) * value.error
    passed = value.mean <= limit
    return FurnaceResult(passed, f"albedo {value.mean:.6f} +- {value.error:.6f}, limit {limit:.6f}", value)


def albedo_test(
    weights: WeightSampler,
    expected: float,
    *,
    samples: int = 1_000_000,
    dimensions: int = 3,
    seed: int = 0,
    tests: int = 1,
    tolerance: float = 1e-5,
) -> FurnaceResult:
    """The mean weight equals `expected`: a closed form, 1 for a lossless model, or `eval_albedo` of its eval."""
    value = albedo(weights, samples=samples, dimensions=dimensions, seed=seed)
    limit = two_sided_threshold(sidak(0.01, tests)) * value.error + tolerance * abs(expected)
    passed = abs(value.mean - expected) <= limit
    return FurnaceResult(passed, f"albedo {value.mean:.6f} +- {value.error:.6f}, expected {expected:.6f}", value)


def eval_albedo(
    evaluate: Eval, *, domain: Sphere | None = None, resolution: tuple[int, int] = (32, 64), tolerance: float = 1e-6
) -> float:
    """Directional albedo by adaptive quadrature of `evaluate` over all directions: no sampling is involved."""
    grid = domain or Sphere()
    cells = cell_integrals(
        lambda plane: np.asarray(evaluate(grid.from_plane(plane)), dtype=np.float64),
        grid.bounds,
        resolution,
        tolerance / (resolution[0] * resolution[1]),
    )
    return float(cells.sum())


def random_directions(count: int, seed: int, upper: bool = False) -> FloatArray:
    """Uniform unit directions (count, 3), in the upper hemisphere only if `upper`."""
    v = np.random.default_rng(seed).normal(size=(count, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    if upper:
        v[:, 2] = np.abs(v[:, 2])
    return v


def reciprocity_error(
    bsdf: Bsdf, *, pairs: int = 100_000, seed: int = 0, eta: float = 1.0, floor: float = 1e-3
) -> float:
    """Largest violation of Helmholtz reciprocity over random pairs of directions, relative to max(f, `floor`).

    Reflection: f(wo, wi) = f(wi, wo). Across an interface radiance is compressed: f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2
    with n = `eta` below the surface and 1 above it (Veach 1997, section 5.2).
    """
    wo, wi = random_directions(pairs, seed), random_directions(pairs, seed + 1)
    forward = np.asarray(bsdf(wo, wi), dtype=np.float64) / np.where(wo[:, 2] > 0, 1.0, eta**2)
    backward = np.asarray(bsdf(wi, wo), dtype=np.float64) / np.where(wi[:, 2] > 0, 1.0, eta**2)
    if not (np.isfinite(forward).all() and np.isfinite(backward).all()):
        return math.inf
    return float(np.max(np.abs(forward - backward) / np.maximum(np.maximum(forward, backward), floor)))


def white_furnace(image: ArrayLike, error: ArrayLike, expected: float = 1.0, tolerance: float = 1e-3) -> FurnaceResult:
    """An image of a lossless object in an environment of radiance `expected`: nothing may stand out.

    The mean must lie within `tolerance` or four standard errors, and no value above the expected one by more than
    `tolerance` and Sidak's threshold for all values (darkness shows in the mean; a bright pixel is made energy).
    """
    values = np.asarray(image, dtype=np.float64)
    errors = np.broadcast_to(np.asarray(error, dtype=np.float64), values.shape)
    if not (np.isfinite(values).all() and np.isfinite(errors).all()):
        return FurnaceResult(False, "the image or its error is not finite", Estimate(math.nan, math.nan, values.size))
    mean = Estimate(float(values.mean()), float(np.sqrt(np.sum(errors**2)) / values.size), values.size)
    threshold = two_sided_threshold(sidak(0.01, values.size))
    excess = float(np.max(values - expected * (1.0 + tolerance) - threshold * errors))
    passed = excess <= 0.0 and abs(mean.mean - expected) <= max(tolerance * expected, 4.0 * mean.error)
    reason = f"mean {mean.mean:.6f} +- {mean.error:.6f}, expected {expected:g}; brightest excess {max(excess, 0.0):.3g}"
    return FurnaceResult(passed, reason, mean)
