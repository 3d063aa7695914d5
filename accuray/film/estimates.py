"""Error bars from replicates.

The R replicates of a pixel are independent estimates m_r of the same mean, from n_r samples each. With m the mean over
all N samples and w_r = n_r / N, the squared standard error of m is

    se^2 = sum_r w_r (m_r - m)^2 / (R - 1).

For equal counts this is the variance of the mean of R numbers. When counts differ (by one where N is no multiple of R,
or where samples were dropped), it is unbiased if the variance of m_r is proportional to 1 / n_r, as for independent
samples; for stratified ones the difference is of second order. A pixel with an empty replicate has no estimate: its
error is infinite, which is what an unknown error bar is.

Pixels are independently scrambled, so the error of a region sums the variances of its pixels, and its mean follows
Student's t with n (R - 1) degrees of freedom, n the number of pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .colour import Matrix, transform
from .errors import ImageError
from .film import Film, planes, pooled_mean, row_blocks
from .student import student_t

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RegionEstimate:
    """The mean of a region of an image, per channel, and how well it is known.

    Attributes:
        mean: the estimate.
        error: its standard error; infinite where a pixel has an empty replicate.
        low, high: ends of the confidence interval.
        confidence: probability that the interval covers the truth, e.g. 0.95.
        dof: degrees of freedom of Student's t.
        pixels: pixels in the region.
        note: empty, or what the reader should know about the error bar.
    """

    mean: tuple[float, ...]
    error: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    confidence: float
    dof: int
    pixels: int
    note: str


def pixel_estimates(
    film: Film, matrix: Matrix | None = None, dtype: DTypeLike = np.float64, *, layer: str = ""
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Mean and standard error of each pixel, both (height, width, 3).

    Args:
        film: has channels X, Y, Z, and those of the layer.
        matrix: applied to XYZ before the error is taken (the error of an RGB is not the transform of XYZ errors).
        dtype: of the results; the arithmetic is double.
        layer: one of `film.layers`; "" is the picture itself.

    Returns:
        mean (0 in a pixel without samples) and standard error (infinite where a replicate of the pixel is empty).
    """
    mean = np.empty((*film.shape, 3), dtype=dtype)
    error = np.empty_like(mean)
    counts = film.counts()
    start = film.layer_start(layer)
    xyz = film.sums[:, :, :, start : start + 3]
    for rows in row_blocks(film.shape):
        mean[rows], error[rows] = _estimate(xyz[rows], counts[rows], film.step, matrix)
    return mean, error


def _estimate(
    sums: NDArray[np.int64], counts: NDArray[np.uint64], step: float, matrix: Matrix | None
) -> tuple[Floats, Floats]:
    """`pixel_estimates` of one block: sums of XYZ (h, w, R, 3), counts (h, w, R)."""
    samples = counts.sum(axis=2, dtype=np.uint64)
    replicates = planes(sums)
    xyz = pooled_mean(replicates, samples, step)
    mean = xyz if matrix is None else transform(matrix, xyz)
    error = np.full_like(mean, math.inf)
    known = (counts != 0).all(axis=2)
    if len(replicates) > 1 and known.any():
        np.sqrt(_variance(replicates, counts, step, xyz, matrix), out=error, where=known)
    return np.moveaxis(mean, 0, 2), np.moveaxis(error, 0, 2)


def _variance(
    replicates: Floats, counts: NDArray[np.uint64], step: float, xyz: Floats, matrix: Matrix | None
) -> Floats:
    """se^2 of the module's formula, (3, h, w), from replicate sums (R, 3, h, w) and their mean xyz (3, h, w)."""
    scatter = np.zeros_like(xyz)
    total = np.zeros(xyz.shape[1:])
    for r, sums in enumerate(replicates):
        count = counts[:, :, r].astype(np.float64)
        deviation = sums * (step / np.maximum(count, 1.0)) - xyz
        if matrix is not None:
            deviation = transform(matrix, deviation)
        deviation *= deviation
        deviation *= count
        scatter += deviation
        total += count
    scatter /= np.maximum(total, 1.0) * (len(replicates) - 1)
    return scatter


def region_estimate(
    film: Film, x0: int, x1: int, y0: int, y1: int, *, matrix: Matrix | None = None, confidence: float = 0.95
) -> RegionEstimate:
    """Mean over the pixels x0 <= x < x1, y0 <= y < y1 (coordinates of the full image), with its interval.

    Raises:
        ImageError: the region is empty or leaves the film's window.
        ValueError: confidence outside (0, 1).
    """
    wx0, wy0, wx1, wy1 = film.window
    if not (wx0 <= x0 < x1 <= wx1 and wy0 <= y0 < y1 <= wy1):
        raise ImageError(f"region x {x0}:{x1}, y {y0}:{y1} is empty or leaves the image x {wx0}:{wx1}, y {wy0}:{wy1}")
    area = (slice(y0 - wy0, y1 - wy0), slice(x0 - wx0, x1 - wx0))
    counts = film.counts()[area]
    means, errors = _estimate(film.sums[area][:, :, :, :3], counts, film.step, matrix)
    pixels = (x1 - x0) * (y1 - y0)
    mean = means.sum(axis=(0, 1)) / pixels
    error = np.sqrt(np.square(errors).sum(axis=(0, 1))) / pixels
    dof = max(pixels * (film.replicates - 1), 1)
    half = student_t(confidence, dof) * error
    return RegionEstimate(
        mean=tuple(mean.tolist()),
        error=tuple(error.tolist()),
        low=tuple((mean - half).tolist()),
        high=tuple((mean + half).tolist()),
        confidence=confidence,
        dof=dof,
        pixels=pixels,
        note=_note(counts, film.replicates),
    )


def _note(counts: NDArray[np.uint64], replicates: int) -> str:
    """What to know about an error bar from these counts (h, w, R)."""
    if replicates == 1:
        return "one replicate only: no error can be estimated"
    if not counts.all():
        return f"some pixels have fewer than {replicates} samples, one per replicate: their error is unknown"
    if (counts != counts[:, :, :1]).any():
        return f"sample counts are no multiple of the {replicates} replicates: replicates are weighted by their counts"
    return ""


def relative_error(mean: Floats, error: Floats) -> float:
    """Estimated relative error of an image, the square root of mean(se^2 / (x^2 + 0.01 m^2)).

    Mean is over pixels and channels; x is the pixel's value, standing in for the truth, and m the mean of x, so dark
    pixels cannot dominate. Pixels whose error is unknown are left out.

    Args:
        mean: as from `pixel_estimates`.
        error: as from `pixel_estimates`.

    Returns:
        The relative error, 0.01 for one percent; infinite when no pixel has a known error or the image is black with
        errors.
    """
    known = np.isfinite(error)
    if not known.any():
        return math.inf
    level = float(mean[known].mean())
    variance = np.square(error[known])
    scale = np.square(mean[known]) + 0.01 * level * level
    ratio = np.divide(variance, scale, out=np.where(variance > 0, math.inf, 0.0), where=scale > 0)
    return math.sqrt(float(ratio.mean()))
