"""Comparing estimates that carry error bars: numbers, images, and images by blocks.

Every function takes means and standard errors (of the mean, not of one sample) and asks whether the difference is
explained by noise. With many tests at once the significance of each is Sidak's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from accuray.testing.stats import sidak, student_t_sf, two_sided_threshold

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ZResult:
    """Outcome of a comparison; true when the two agree.

    `verdict` is "pass", "fail" or "no power"; `worst` is the largest |z| and `at` its index; `overall` is the z of the
    two totals, which sees a small bias that is the same everywhere; `threshold` applies to `worst`.
    """

    verdict: str
    reason: str
    worst: float
    at: tuple[int, ...]
    overall: float
    threshold: float

    def __bool__(self) -> bool:
        return self.verdict == "pass"


def z_test(
    mean: float,
    error: float,
    reference: float,
    reference_error: float = 0.0,
    *,
    tests: int = 1,
    alpha: float = 0.01,
    dof: float = math.inf,
    rounding: float = 1e-5,
) -> ZResult:
    """Two-sided test of two means, or of a mean against a known number.

    `dof` are the degrees of freedom behind `error` (K - 1 for K batches). `rounding` is a relative difference of the
    reference that is forgiven without being noise: the arithmetic is finite.
    """
    if not all(map(math.isfinite, (mean, error, reference, reference_error))):
        return ZResult("fail", "a mean or an error is not finite", math.inf, (), math.inf, 0.0)
    threshold = two_sided_threshold(sidak(alpha, tests), dof)
    z = _z(np.asarray(mean - reference), np.hypot(error, reference_error), rounding * abs(reference))
    worst = float(np.abs(z))
    p_value = 2.0 * student_t_sf(min(worst, 1e100), dof)
    verdict = "pass" if worst <= threshold else "fail"
    return ZResult(verdict, f"z = {float(z):.2f}, p = {p_value:.3g}", worst, (), float(z), threshold)


def image_z_test(
    mean: ArrayLike,
    error: ArrayLike,
    reference: ArrayLike,
    reference_error: ArrayLike = 0.0,
    *,
    alpha: float = 0.01,
    allowed: float = 0.0025,
    dof: float = math.inf,
    floor: float = 0.0,
) -> ZResult:
    """z-test of every pixel and channel of two images, and of their totals.

    Arrays broadcast to one shape. It passes when at most the fraction `allowed` of the values exceeds Sidak's
    threshold for all of them (rare bright samples are not normally distributed) and the difference of the totals is
    not significant either. `floor` is the smallest standard error believed, for pixels whose few samples agree by
    chance. `dof` are the degrees of freedom of one pixel's standard error.
    """
    a, b, ea, eb = (
        np.asarray(x, dtype=np.float64) for x in np.broadcast_arrays(mean, reference, error, reference_error)
    )
    if not all(np.isfinite(x).all() for x in (a, b, ea, eb)):
        return ZResult("fail", "a mean or an error is not finite", math.inf, (), math.inf, 0.0)
    spread = np.maximum(np.hypot(ea, eb), floor)
    z = _z(a - b, spread, 1e-6 * np.abs(b))
    threshold = two_sided_threshold(sidak(alpha, a.size), dof)
    beyond = np.count_nonzero(np.abs(z) > threshold)
    overall = float(_z(np.sum(a - b), np.sqrt(np.sum(spread**2)), 1e-6 * abs(float(np.sum(b)))))
    overall_limit = two_sided_threshold(alpha)
    at = tuple(int(i) for i in np.unravel_index(int(np.argmax(np.abs(z))), a.shape))
    worst = float(np.abs(z[at]))
    passed = beyond <= allowed * a.size and abs(overall) <= overall_limit
    reason = (
        f"{beyond} of {a.size} values beyond |z| = {threshold:.2f} (allowed {allowed:.2%}), worst {worst:.2f} at {at}, "
        f"totals z = {overall:.2f} (limit {overall_limit:.2f})"
    )
    return ZResult("pass" if passed else "fail", reason, worst, at, overall, threshold)


def blocks(
    mean: ArrayLike,
    error: ArrayLike,
    reference: ArrayLike,
    reference_error: ArrayLike = 0.0,
    *,
    size: int = 8,
    alpha: float = 0.01,
    power: float = 0.01,
    dof: float = math.inf,
) -> ZResult:
    """Compare two images (H, W) or (H, W, C) by the means of blocks of `size` x `size` pixels.

    The verdict is "no power" if the standard error of any block's difference exceeds `power` times the block's mean:
    such images agree with anything. Otherwise every block, at Sidak's significance for all of them, and the totals
    must agree. Pixels are taken as independent; `dof` are the degrees of freedom of one pixel's standard error.
    Blocks at the right and lower edge may be smaller.
    """
    shape = np.broadcast_shapes(np.shape(mean), np.shape(reference), np.shape(error), np.shape(reference_error))
    a, b, ea, eb = (_as_channels(x, shape) for x in (mean, reference, error, reference_error))
    if not all(np.isfinite(x).all() for x in (a, b, ea, eb)):
        return ZResult("fail", "a mean or an error is not finite", math.inf, (), math.inf, 0.0)
    count = _block_sums(np.ones_like(a), size)
    block_a, block_b = _block_sums(a, size) / count, _block_sums(b, size) / count
    spread = np.sqrt(_block_sums(ea**2 + eb**2, size)) / count
    level = np.maximum(np.abs(block_a), np.abs(block_b))
    threshold = two_sided_threshold(sidak(alpha, block_a.size), dof * size * size)
    z = _z(block_a - block_b, spread, 1e-6 * level)
    at = tuple(int(i) for i in np.unravel_index(int(np.argmax(np.abs(z))), z.shape))
    worst = float(np.abs(z[at]))
    weight = np.sum(count**2 * spread**2)
    overall = float(_z(np.sum(a - b), np.sqrt(weight), 1e-6 * float(np.sum(np.abs(b)))))

    weak = np.argwhere(spread > power * level)
    if len(weak):
        row, column, channel = (int(i) for i in weak[0])
        reason = (
            f"no power: {len(weak)} of {z.size} blocks have a standard error above {power:.1%} of their mean, "
            f"first block ({row}, {column}) channel {channel}"
        )
        return ZResult("no power", reason, worst, at, overall, threshold)
    passed = worst <= threshold and abs(overall) <= two_sided_threshold(alpha)
    reason = f"worst block {at}: |z| = {worst:.2f} (limit {threshold:.2f}), totals z = {overall:.2f}"
    return ZResult("pass" if passed else "fail", reason, worst, at, overall, threshold)


def _z(difference: ArrayLike, spread: ArrayLike, forgiven: ArrayLike) -> FloatArray:
    """Differences in standard errors, what is `forgiven` as rounding taken off first; no spread: 0 or infinite."""
    d = np.asarray(difference, dtype=np.float64)
    rest = np.sign(d) * np.maximum(np.abs(d) - forgiven, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(rest == 0.0, 0.0, rest / np.asarray(spread, dtype=np.float64)))


def _as_channels(values: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """The image as (H, W, C) doubles."""
    image = np.broadcast_to(np.asarray(values, dtype=np.float64), shape)
    if image.ndim not in (2, 3):
        raise ValueError(f"an image has 2 or 3 axes, not {image.ndim}")
    return image if image.ndim == 3 else image[:, :, None]


def _block_sums(image: FloatArray, size: int) -> FloatArray:
    """Sums over blocks of `size` x `size` pixels, the last ones cut off by the edges."""
    rows = np.add.reduceat(image, np.arange(0, image.shape[0], size), axis=0)
    return np.asarray(np.add.reduceat(rows, np.arange(0, image.shape[1], size), axis=1))
