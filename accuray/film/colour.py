"""Colour of images: CIE XYZ to linear Rec.709, white balance, exposure and the sRGB encoding.

Image values are CIE 1931 XYZ with Y = integral(L ybar) / integral(ybar); an RGB triple is linear Rec.709 (ITU-R
BT.709-6). Matrices are tuples of rows, computed in plain IEEE double arithmetic so that their bits, and with them the
bits of an image, do not depend on a linear-algebra library.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from .errors import ImageError

Vector: TypeAlias = tuple[float, float, float]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

REC709_PRIMARIES_XY = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
"""Chromaticities of red, green and blue, ITU-R BT.709-6, item 1.3."""
D65_XY = (0.3127, 0.3290)
"""Chromaticity of the reference white, ITU-R BT.709-6, item 1.4."""
CHROMATICITIES = tuple(v for xy in (*REC709_PRIMARIES_XY, D65_XY) for v in xy)
"""Primaries and white as the EXR attribute of that name wants them: eight numbers."""

# Bradford cone response matrix (Lam 1985; CIE 160:2004).
_BRADFORD: Matrix = ((0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296))


def xy_to_xyz(xy: tuple[float, float]) -> Vector:
    """The XYZ of a chromaticity at Y = 1."""
    return xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]


def multiply(a: Matrix, b: Matrix) -> Matrix:
    """The matrix product a b."""
    columns = tuple(zip(*b, strict=True))
    x, y, z = (tuple(sum(p * q for p, q in zip(row, column, strict=True)) for column in columns) for row in a)
    return _vector(x), _vector(y), _vector(z)


def apply(m: Matrix, v: Sequence[float]) -> Vector:
    """The matrix times the column vector v."""
    return _vector(tuple(sum(p * q for p, q in zip(row, v, strict=True)) for row in m))


def invert(m: Matrix) -> Matrix:
    """The inverse by cofactors; m must be far from singular."""
    (a, b, c), (d, e, f), (g, h, i) = m
    cofactors = (
        (e * i - f * h, c * h - b * i, b * f - c * e),
        (f * g - d * i, a * i - c * g, c * d - a * f),
        (d * h - e * g, b * g - a * h, a * e - b * d),
    )
    determinant = a * cofactors[0][0] + b * cofactors[1][0] + c * cofactors[2][0]
    x, y, z = (tuple(value / determinant for value in row) for row in cofactors)
    return _vector(x), _vector(y), _vector(z)


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _rgb_to_xyz() -> Matrix:
    """Normalised primary matrix (SMPTE RP 177-1993): RGB = (1, 1, 1) is the white at Y = 1."""
    r, g, b = (xy_to_xyz(xy) for xy in REC709_PRIMARIES_XY)
    primaries: Matrix = ((r[0], g[0], b[0]), (r[1], g[1], b[1]), (r[2], g[2], b[2]))
    scale = apply(invert(primaries), xy_to_xyz(D65_XY))
    x, y, z = (tuple(p * s for p, s in zip(row, scale, strict=True)) for row in primaries)
    return _vector(x), _vector(y), _vector(z)


RGB_TO_XYZ = _rgb_to_xyz()
"""Linear Rec.709 to XYZ."""
XYZ_TO_RGB = invert(RGB_TO_XYZ)
"""XYZ to linear Rec.709."""


def bradford(source: Sequence[float], target: Sequence[float]) -> Matrix:
    """Von Kries adaptation of XYZ from one white to another in Bradford cone space (Lam 1985).

    Args:
        source: XYZ of the white to adapt from, of any luminance; only its chromaticity counts.
        target: XYZ of the white to adapt to, likewise.

    Raises:
        ImageError: a white that is not finite, has Y <= 0, or excites a cone negatively (too saturated to be a white).
    """
    cones = []
    for white in (source, target):
        x, y, z = (float(v) for v in white)
        if not all(math.isfinite(v) for v in (x, y, z)) or y <= 0:
            raise ImageError(f"white balance XYZ ({x}, {y}, {z}): allowed are finite values with Y > 0")
        response = apply(_BRADFORD, (x / y, 1.0, z / y))
        if min(response) <= 0:
            raise ImageError(f"white balance XYZ ({x}, {y}, {z}) is too saturated to adapt to (Bradford response <= 0)")
        cones.append(response)
    gain = tuple(t / s for s, t in zip(*cones, strict=True))
    scaled: Matrix = tuple(_vector(tuple(g * v for v in row)) for g, row in zip(gain, _BRADFORD, strict=True))  # type: ignore[assignment]
    return multiply(invert(_BRADFORD), scaled)


def white_balance_matrix(white: Sequence[float] | None) -> Matrix:
    """XYZ to XYZ: the given white becomes D65 at unchanged luminance; None changes nothing."""
    if white is None:
        return (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    return bradford(white, xy_to_xyz(D65_XY))


@lru_cache(maxsize=64)
def xyz_to_balanced_rgb(white: Vector | None = None) -> Matrix:
    """XYZ to linear Rec.709 under a white balance: the white, at Y = 1, becomes RGB (1, 1, 1)."""
    return XYZ_TO_RGB if white is None else multiply(XYZ_TO_RGB, white_balance_matrix(white))


def transform(m: Matrix, xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix applied to the planes (3, h, w); elementwise, so each pixel's bits depend on that pixel alone."""
    x, y, z = xyz
    result = np.empty_like(xyz)
    for row, plane in zip(m, result, strict=True):
        plane[...] = row[0] * x + row[1] * y + row[2] * z
    return result


def exposure_scale(ev: float) -> float:
    """The factor 2^ev of an exposure in EV (stops).

    Raises:
        ImageError: not finite or beyond +-64 EV.
    """
    if not -64.0 <= ev <= 64.0:
        raise ImageError(f"exposure {ev!r} EV is out of range: allowed -64 to 64")
    return math.pow(2.0, ev)


def srgb_encode(linear: NDArray[np.floating]) -> NDArray[np.float64]:
    """The sRGB transfer function (IEC 61966-2-1): linear 0..1 to encoded 0..1; clamped, NaN becomes 0."""
    v = np.clip(np.nan_to_num(linear.astype(np.float64), nan=0.0), 0.0, 1.0)
    encoded: NDArray[np.float64] = np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.power(v, 1 / 2.4) - 0.055)
    return encoded


def srgb_decode(encoded: float) -> float:
    """The linear value of an sRGB-encoded one, both 0..1 (IEC 61966-2-1)."""
    return encoded / 12.92 if encoded <= 0.04045 else math.pow((encoded + 0.055) / 1.055, 2.4)


@lru_cache(maxsize=1)
def _srgb8_tables() -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Values where the nearest 8-bit code changes from k to k + 1, and the code at each bucket's lower end.

    A bucket is all float32 with the same upper 16 bits, at most 0.8 percent wide; a code is never narrower, so a value
    has its bucket's code or the next one.
    """
    thresholds = np.array([*(srgb_decode((k + 0.5) / 255) for k in range(255)), np.inf], dtype=np.float32)
    lower_ends = (np.arange(1 << 14, dtype=np.uint32) << 16).view(np.float32)  # 0 to just below 2
    return thresholds, np.searchsorted(thresholds, lower_ends, side="right").astype(np.uint8)


def srgb8(linear: NDArray[np.floating]) -> NDArray[np.uint8]:
    """The nearest 8-bit sRGB codes; clamped, NaN becomes 0. By comparison only, hence the same on every processor."""
    values = np.ascontiguousarray(np.fmin(np.fmax(linear, 0.0), 1.0), dtype=np.float32)  # fmax drops NaN
    thresholds, codes = _srgb8_tables()
    code: NDArray[np.uint8] = codes[np.abs(values).view(np.uint32) >> 16]
    code += values >= thresholds[code]
    return code
