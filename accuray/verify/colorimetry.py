"""Exact colours of spectra for the CIE 1931 observer, and Planck's law: the expected values of the spectral cases.

Tables are linear between their points, as in the renderer. All tables have their points on whole nanometres, so the
product of observer, light and reflectance is a cubic on each nanometre and Simpson's rule integrates it exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from accuray import data

FloatArray = NDArray[np.float64]
#: wavelengths in nm (N,) -> values (N,)
Spectrum = Callable[[FloatArray], FloatArray]

PLANCK = 6.62607015e-34
LIGHT_SPEED = 299792458.0
BOLTZMANN = 1.380649e-23


def table(wavelengths: Sequence[float], values: Sequence[float], outside: str = "hold") -> Spectrum:
    """Piecewise linear spectrum; `outside` its table the end values ("hold") or 0 ("zero")."""
    x, y = np.asarray(wavelengths, dtype=np.float64), np.asarray(values, dtype=np.float64)
    edge = None if outside == "hold" else 0.0
    return lambda w: np.interp(w, x, y, left=edge, right=edge)


def blackbody(kelvin: float) -> Spectrum:
    """Spectral radiance of a black body, W m^-2 sr^-1 nm^-1 (Planck 1901, exact SI constants of 2019)."""

    def radiance(w: FloatArray) -> FloatArray:
        metres = w * 1e-9
        exponent = PLANCK * LIGHT_SPEED / (BOLTZMANN * kelvin * metres)
        return np.asarray(2e-9 * PLANCK * LIGHT_SPEED**2 / (metres**5 * np.expm1(exponent)))

    return radiance


def illuminant(name: str) -> Spectrum:
    """CIE illuminant scaled to Y = 1."""
    wavelengths, values = data.illuminants()[name]
    shape = table(wavelengths, values, outside="zero")
    scale = float(xyz(shape)[1])
    return lambda w: shape(w) / scale


def product(*spectra: Spectrum) -> Spectrum:
    """Pointwise product."""
    return lambda w: np.asarray(math.prod(s(w) for s in spectra))


@cache
def _quadrature() -> tuple[FloatArray, FloatArray]:
    """Nodes (1410,) and weights (1410, 3) that turn a spectrum into XYZ, normalised so that a spectrum of 1 has Y = 1.

    Simpson's rule on each nanometre; its ends are taken just inside, so a table may jump on a whole nanometre.
    """
    cie = data.observer()
    left = np.asarray(cie.wavelengths[:-1])
    nodes = (left[:, None] + [1e-9, 0.5, 1.0 - 1e-9]).ravel()
    observer = np.stack([np.interp(nodes, cie.wavelengths, c) for c in (cie.x, cie.y, cie.z)], axis=1)
    weights = np.tile([1.0, 4.0, 1.0], len(left))[:, None] / 6.0 * observer
    return nodes, weights / weights[:, 1].sum()


def xyz(spectrum: Spectrum) -> FloatArray:
    """Tristimulus values (3,) of a spectrum, exact for piecewise linear factors on whole nanometres."""
    nodes, weights = _quadrature()
    return np.asarray(spectrum(nodes) @ weights)


def chromaticity(values: ArrayLike) -> tuple[float, float]:
    """CIE x and y of XYZ."""
    x, y, z = np.asarray(values, dtype=np.float64)
    return float(x / (x + y + z)), float(y / (x + y + z))


@cache
def _to_rec709() -> FloatArray:
    return np.asarray(data.colour_spaces()["sRGB / Rec.709"]["xyz_to_rgb"], dtype=np.float64)


def rec709(values: ArrayLike) -> FloatArray:
    """XYZ to linear Rec.709 RGB, both on the last axis."""
    return np.asarray(np.asarray(values, dtype=np.float64) @ _to_rec709().T)


def luminance(rgb: ArrayLike) -> FloatArray:
    """Y of linear Rec.709 RGB on the last axis."""
    weights = np.linalg.inv(_to_rec709())[1]
    return np.asarray(np.asarray(rgb, dtype=np.float64) @ weights)
