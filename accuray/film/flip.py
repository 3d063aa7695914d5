"""FLIP: the error that a person sees who flips between two images (Andersson et al. 2020).

Written from the paper and its supplement for low dynamic range. Names follow the paper: a colour pipeline (contrast
sensitivity filters in the opponent space YCxCz, then the HyAB distance in L*a*b* with the Hunt effect) whose result a
feature pipeline (edges and points, from derivatives of a Gaussian) amplifies.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .colour import RGB_TO_XYZ, XYZ_TO_RGB, transform

Plane = NDArray[np.float64]
"""(height, width)."""
Planes = NDArray[np.float64]
"""(3, height, width)."""

DEFAULT_PIXELS_PER_DEGREE = 0.7 * (3840 / 0.7) * (math.pi / 180)
"""About 67: a screen 0.7 m wide of 3840 pixels, seen from 0.7 m (section 6 of the paper)."""

_WHITE = np.array([sum(row) for row in RGB_TO_XYZ])[:, None, None]
_CSF = {"A": ((1.0, 0.0047),), "RG": ((1.0, 0.0053),), "BY": ((34.1, 0.04), (13.5, 0.025))}
"""Contrast sensitivity (table 1): terms a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; zero terms left out."""
_CSF_REACH = 0.04
"""The largest b, which bounds the radius of all three filters."""
_COLOUR_EXPONENT, _FEATURE_EXPONENT = 0.7, 0.5
_P_C, _P_T = 0.4, 0.95
"""Where the colour error's two linear pieces meet, as shares of the largest error and of the result."""
_FEATURE_WIDTH = 0.082
"""Width in degrees of the features that are detected."""


def flip(
    reference: NDArray[np.floating],
    test: NDArray[np.floating],
    pixels_per_degree: float = DEFAULT_PIXELS_PER_DEGREE,
) -> NDArray[np.float32]:
    """The error of each pixel, 0 to 1, float32 (height, width).

    Args:
        reference: (height, width, 3), linear Rec.709 in 0..1 as a display would show it.
        test: likewise.
        pixels_per_degree: of the visual field.

    Raises:
        ValueError: pixels_per_degree out of range.
    """
    if not 1.0 <= pixels_per_degree <= 1000.0:
        raise ValueError(f"{pixels_per_degree!r} pixels per degree are out of range: allowed 1 to 1000")
    a, b = (_to_ycxcz(np.moveaxis(image.astype(np.float64), 2, 0)) for image in (reference, test))
    colour = _colour_error(a, b, pixels_per_degree)
    feature = _feature_error((a[0] + 16.0) / 116.0, (b[0] + 16.0) / 116.0, pixels_per_degree)
    return np.asarray(colour ** (1.0 - feature), dtype=np.float32)


def _to_ycxcz(rgb: Planes) -> Planes:
    """The linearised L*a*b* of Flohr et al. 1993."""
    x, y, z = transform(RGB_TO_XYZ, rgb) / _WHITE
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def _from_ycxcz(ycxcz: Planes) -> Planes:
    y = (ycxcz[0] + 16.0) / 116.0
    return transform(XYZ_TO_RGB, np.stack([ycxcz[1] / 500.0 + y, y, y - ycxcz[2] / 200.0]) * _WHITE)


def _colour_error(reference: Planes, test: Planes, ppd: float) -> Plane:
    """The error of the colour pipeline, 0 to 1 (sections 4.1 to 4.3)."""
    a, b = (_to_hunt_lab(_from_ycxcz(_contrast_filtered(image, ppd))) for image in (reference, test))
    green, blue = (_to_hunt_lab(np.array(rgb, dtype=np.float64).reshape(3, 1, 1)) for rgb in ((0, 1, 0), (0, 0, 1)))
    largest = float(_hyab(green, blue).item()) ** _COLOUR_EXPONENT
    error: Plane = _hyab(a, b) ** _COLOUR_EXPONENT
    knee = _P_C * largest
    above = _P_T + (error - knee) / (largest - knee) * (1.0 - _P_T)
    return np.asarray(np.where(error < knee, _P_T / knee * error, above))


def _contrast_filtered(ycxcz: Planes, ppd: float) -> Planes:
    """Each opponent channel without the detail that the eye does not see at this distance."""
    radius = math.ceil(3.0 * math.sqrt(_CSF_REACH / (2.0 * math.pi**2)) * ppd)
    squared = (np.arange(-radius, radius + 1) / ppd) ** 2
    result = np.zeros_like(ycxcz)
    for channel, terms, filtered in zip(ycxcz, _CSF.values(), result, strict=True):
        total = 0.0
        for a, b in terms:
            kernel = np.exp(-(math.pi**2) / b * squared)
            weight = a * math.sqrt(math.pi / b)
            filtered += weight * _convolved(channel, kernel, kernel)
            total += weight * float(kernel.sum()) ** 2
        filtered /= total
    return result


def _convolved(plane: Plane, across: Plane, down: Plane) -> Plane:
    """The plane correlated with the outer product of two odd kernels; edge pixels repeat beyond the edge."""
    for kernel, axis in ((across, 1), (down, 0)):
        radius, size = len(kernel) // 2, plane.shape[axis]
        padded = np.pad(plane, [(radius, radius) if axis == k else (0, 0) for k in range(2)], mode="edge")
        plane = np.zeros_like(plane)
        for k, weight in enumerate(kernel):
            plane += weight * (padded[:, k : k + size] if axis else padded[k : k + size])
    return plane


def _to_hunt_lab(rgb: Planes) -> Planes:
    """L*a*b* (CIE 1976) of the clamped colours, chroma scaled by lightness: the Hunt effect."""
    ratio = transform(RGB_TO_XYZ, np.clip(rgb, 0.0, 1.0)) / _WHITE
    delta = 6.0 / 29.0
    x, y, z = np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3.0 * delta**2) + 4.0 / 29.0)
    lightness = 116.0 * y - 16.0
    return np.stack([lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)])


def _hyab(a: Planes, b: Planes) -> Plane:
    """City-block distance in lightness, Euclidean in chroma (Abasi et al. 2020)."""
    difference = a - b
    return np.asarray(np.abs(difference[0]) + np.hypot(difference[1], difference[2]))


def _feature_error(reference: Plane, test: Plane, ppd: float) -> Plane:
    """How much edges and points differ, 0 to 1 (section 4.4); luminances in 0..1."""
    sigma = 0.5 * _FEATURE_WIDTH * ppd
    radius = math.ceil(3.0 * sigma)
    x = np.arange(-radius, radius + 1, dtype=np.float64)
    gauss = np.exp(-(x**2) / (2.0 * sigma**2))
    differences = []
    for derivative in (-x * gauss, (x**2 / sigma**2 - 1.0) * gauss):
        # Over the 2D kernel, positive weights add up to 1 and negative ones to -1.
        side = float(gauss.sum())
        across = np.where(
            derivative > 0,
            derivative / (derivative[derivative > 0].sum() * side),
            derivative / (-derivative[derivative < 0].sum() * side),
        )
        magnitudes = [
            np.hypot(_convolved(image, across, gauss), _convolved(image, gauss, across)) for image in (reference, test)
        ]
        differences.append(np.abs(magnitudes[0] - magnitudes[1]))
    return np.asarray((np.maximum(*differences) / math.sqrt(2.0)) ** _FEATURE_EXPONENT)
