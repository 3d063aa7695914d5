"""The spectral sky of Hosek and Wilkie (2012) from its coefficients, in double precision and one band at a time."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
FILE = Path(__file__).resolve().parents[2] / "accuray" / "data" / "hosek_wilkie_spectral.json"


@cache
def coefficients() -> dict[str, Any]:
    content: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    return content


def _blend(curve: Any, turbidity: float, albedo: float, elevation: float) -> FloatArray:
    """Bezier in the cube root of the elevation, linear in turbidity and albedo."""
    x = (elevation / (0.5 * math.pi)) ** (1.0 / 3.0)
    weights = np.array([math.comb(5, k) * (1.0 - x) ** (5 - k) * x**k for k in range(6)])
    low = int(turbidity)
    high = min(low + 1, 10)
    t = turbidity - low

    def at(a: int) -> FloatArray:
        lower, upper = (np.tensordot(weights, np.array(curve[a][n - 1]), 1) for n in (low, high))
        return np.asarray((1.0 - t) * lower + t * upper)

    return np.asarray((1.0 - albedo) * at(0) + albedo * at(1))


def band_radiance(
    band: int, turbidity: float, albedo: float, elevation: float, zenith: FloatArray, gamma: FloatArray
) -> FloatArray:
    """W m^-2 sr^-1 nm^-1 at zenith angles and angles from the sun, radians."""
    data = coefficients()
    a = _blend(data["sky"][band], turbidity, albedo, elevation)
    level = _blend(data["sky_radiance"][band], turbidity, albedo, elevation)
    cosine = np.cos(gamma)
    mie = (1.0 + cosine**2) / (1.0 + a[8] ** 2 - 2.0 * a[8] * cosine) ** 1.5
    up = np.maximum(np.cos(zenith), 0.0)
    around = a[2] + a[3] * np.exp(a[4] * gamma) + a[5] * cosine**2 + a[6] * mie + a[7] * np.sqrt(up)
    return np.asarray(level * (1.0 + a[0] * np.exp(a[1] / (up + 0.01))) * around)


def radiance(
    wavelength: float, turbidity: float, albedo: float, elevation: float, zenith: FloatArray, gamma: FloatArray
) -> FloatArray:
    """Linear between the bands at 320, 360, ... 720 nm."""
    position = (wavelength - 320.0) / 40.0
    low = min(int(position), 9)
    values = (band_radiance(band, turbidity, albedo, elevation, zenith, gamma) for band in (low, low + 1))
    lower, upper = values
    return np.asarray(lower + (position - low) * (upper - lower))


def irradiance(wavelength: float, turbidity: float, albedo: float, elevation: float, nodes: int = 400) -> float:
    """On level ground, by Gauss and Legendre over the dome; the sun's disc is not part of it."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    zenith, wz = 0.25 * math.pi * (x + 1.0), 0.25 * math.pi * w
    azimuth, wa = 0.5 * math.pi * (x + 1.0), 0.5 * math.pi * w  # from the sun's, half of the dome
    z, a = np.meshgrid(zenith, azimuth, indexing="ij")
    cosine = np.cos(z) * math.sin(elevation) + np.sin(z) * math.cos(elevation) * np.cos(a)
    values = radiance(wavelength, turbidity, albedo, elevation, z, np.arccos(np.clip(cosine, -1.0, 1.0)))
    return float(2.0 * np.einsum("i,j,ij", wz, wa, values * np.cos(z) * np.sin(z)))


def sun_middle(band: int, turbidity: float, elevation: float) -> float:
    """Radiance in the middle of the sun's disc (Hosek and Wilkie 2013)."""
    piece = min(44, int(45 * (2.0 * elevation / math.pi) ** (1.0 / 3.0)))
    t = elevation - (piece / 45) ** 3 * 0.5 * math.pi
    low = int(turbidity)
    lower, upper = (np.polyval(coefficients()["sun"][band][n - 1][piece], t) for n in (low, min(low + 1, 10)))
    return float(lower + (turbidity - low) * (upper - lower))


def sun_irradiance(band: int, turbidity: float, elevation: float, radius: float) -> float:
    """Of the whole disc, on a plane that faces it; the radius in radians."""
    limb = coefficients()["limb_darkening"][band]
    mean = sum(2.0 / (i + 2) * term for i, term in enumerate(limb))
    return sun_middle(band, turbidity, elevation) * mean * math.pi * math.sin(radius) ** 2
