"""The spectrum value that the renderer receives, and what can be computed from it without rendering.

A scene's spectrum is handed over as its form (constant, RGB, table, blackbody, Sellmeier, Cauchy) and a scale;
samples evaluate the form in the kernels. Here are only the colour of an emission (for normalisation and white
balance) and the bounds that validation needs.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

from accuray import data

FIRST_NM, LAST_NM = 360.0, 830.0

# CODATA 2018, exact since the SI of 2019: Planck, light speed, Boltzmann
_H, _C, _K = 6.62607015e-34, 299792458.0, 1.380649e-23

# XYZ of the linear Rec.709 primaries with D65 at Y = 1 (accuray/data/rgb_colourspaces.json)
_REC709_TO_XYZ = (
    (0.412390799266, 0.357584339384, 0.180480788402),
    (0.212639005872, 0.715168678768, 0.072192315361),
    (0.019330818716, 0.119194779795, 0.95053215225),
)

XYZ = tuple[float, float, float]
Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Spectrum:
    """A spectrum as a function of the wavelength in nanometres, times ``scale``.

    ``form`` decides which fields count: "constant" (value), "rgb" (rgb, linear Rec.709; an emission multiplies
    the illuminant named by white, scaled to Y = 1), "table" (wavelengths, values, extrapolate "hold" or "zero";
    linear between the points), "blackbody" (kelvin; absolute Planck radiance in W m^-2 sr^-1 nm^-1), "sellmeier"
    (n^2 = 1 + A0 + sum B L^2 / (L^2 - C)), "cauchy" (n = A0 + B[0] / L^2); L in micrometres.
    ``role`` is "reflectance", "emission" or "index". With ``flux`` an emission is that of the whole emitter, W/nm,
    which the lowering spreads over its surface or directions.
    """

    form: str
    role: str
    value: float = 0.0
    rgb: Numbers = ()
    white: str = ""
    wavelengths: Numbers = ()
    values: Numbers = ()
    extrapolate: str = "hold"
    kelvin: float = 0.0
    A0: float = 0.0
    B: Numbers = ()
    C: Numbers = ()
    scale: float = 1.0
    flux: bool = False

    def at(self, wavelength: float) -> float:
        """Value at a wavelength in nm (not for "rgb", which the renderer upsamples); nan where undefined."""
        return self.scale * _EVALUATE[self.form](self, wavelength)

    def times(self, factor: float) -> Spectrum:
        """The spectrum times a factor; constants and RGB absorb it, so equal spellings stay equal."""
        if self.form == "constant":
            return replace(self, value=self.value * factor)
        if self.form == "rgb":
            return replace(self, rgb=tuple(component * factor for component in self.rgb))
        return replace(self, scale=self.scale * factor)

    def bounds(self) -> tuple[float, float]:
        """Smallest and largest value over 360-830 nm; tables: of all their points; RGB: of the components."""
        if self.form == "rgb":
            values = [component * self.scale for component in self.rgb]
        elif self.form == "table":
            values = [value * self.scale for value in self.values]
        else:
            values = [self.at(FIRST_NM + 5.0 * step) for step in range(95)]
        if any(math.isnan(value) for value in values):
            return math.nan, math.nan
        return min(values), max(values)


def planck(wavelength: float, kelvin: float) -> float:
    """Blackbody spectral radiance, W m^-2 sr^-1 nm^-1, at a wavelength in nm (Planck 1901)."""
    metres = wavelength * 1e-9
    exponent = _H * _C / (metres * _K * kelvin)
    return 2e-9 * _H * _C * _C / metres**5 / math.expm1(exponent) if exponent < 700.0 else 0.0


def interpolate(wavelengths: Numbers, values: Numbers, wavelength: float, extrapolate: str) -> float:
    """Linear interpolation; outside, the end values ("hold") or 0 ("zero")."""
    if wavelength < wavelengths[0] or wavelength > wavelengths[-1]:
        if extrapolate == "zero":
            return 0.0
        return values[0] if wavelength < wavelengths[0] else values[-1]
    upper = min(bisect_right(wavelengths, wavelength), len(wavelengths) - 1)
    left, right = wavelengths[upper - 1], wavelengths[upper]
    along = (wavelength - left) / (right - left)
    return values[upper - 1] * (1.0 - along) + values[upper] * along


def _sellmeier(spectrum: Spectrum, wavelength: float) -> float:
    square = (wavelength * 1e-3) ** 2
    total = 1.0 + spectrum.A0
    for strength, resonance in zip(spectrum.B, spectrum.C, strict=True):
        if square == resonance:
            return math.nan
        total += strength * square / (square - resonance)
    return math.sqrt(total) if total >= 0.0 else math.nan


def _cauchy(spectrum: Spectrum, wavelength: float) -> float:
    return spectrum.A0 + spectrum.B[0] / (wavelength * 1e-3) ** 2


_EVALUATE: dict[str, Callable[[Spectrum, float], float]] = {
    "constant": lambda s, _: s.value,
    "rgb": lambda _s, _w: math.nan,
    "table": lambda s, wavelength: interpolate(s.wavelengths, s.values, wavelength, s.extrapolate),
    "blackbody": lambda s, wavelength: planck(wavelength, s.kelvin),
    "sellmeier": _sellmeier,
    "cauchy": _cauchy,
}


def xyz(spectrum: Spectrum) -> XYZ:
    """CIE 1931 tristimulus values of an emission: integral(L xyzbar) / integral(ybar) over 360-830 nm.

    Exact for tables and the linearly interpolated observer (Simpson's rule on every piece of the product);
    RGB gives the values of its primaries.
    """
    if spectrum.form == "rgb":
        sums = [sum(m * c for m, c in zip(row, spectrum.rgb, strict=True)) for row in _REC709_TO_XYZ]
    elif spectrum.form == "constant":
        sums = [spectrum.value * weight for weight in _white_xyz()]
    else:
        sums = [total / _y_integral() for total in _integrals(spectrum)]
    x, y, z = (spectrum.scale * total for total in sums)
    return x, y, z


def radiant(spectrum: Spectrum) -> float:
    """Integral over 360-830 nm, nm times the unit, by the rule of ``xyz``; nan for RGB."""
    if spectrum.form == "constant":
        return spectrum.scale * spectrum.value * (LAST_NM - FIRST_NM)
    unscaled = replace(spectrum, scale=1.0)
    total = 0.0
    for left, right in _pieces(spectrum):
        middle = 0.5 * (left + right)
        total += (right - left) / 6.0 * (unscaled.at(left) + 4.0 * unscaled.at(middle) + unscaled.at(right))
    return spectrum.scale * total


def _integrals(spectrum: Spectrum) -> XYZ:
    """Integrals of the unscaled spectrum times each colour matching function, nm times the unit."""
    observer = data.observer()
    unscaled = replace(spectrum, scale=1.0)
    totals = [0.0, 0.0, 0.0]
    for left, right in _pieces(spectrum):
        ends = [unscaled.at(left), unscaled.at(0.5 * (left + right)), unscaled.at(right)]
        step = int(min(left, LAST_NM - 1.0) - FIRST_NM)
        a, b = left - FIRST_NM - step, right - FIRST_NM - step
        for axis, function in enumerate((observer.x, observer.y, observer.z)):
            slope = function[step + 1] - function[step]
            low, high = function[step] + a * slope, function[step] + b * slope
            totals[axis] += (right - left) / 6.0 * (ends[0] * low + 2.0 * ends[1] * (low + high) + ends[2] * high)
    return totals[0], totals[1], totals[2]


def _pieces(spectrum: Spectrum) -> Iterator[tuple[float, float]]:
    """Intervals on which both the observer and the spectrum are smooth, without those that are zero."""
    breaks = {FIRST_NM + step for step in range(471)}
    first, last = FIRST_NM, LAST_NM
    if spectrum.form == "table":
        if spectrum.extrapolate == "zero":
            first, last = max(first, spectrum.wavelengths[0]), min(last, spectrum.wavelengths[-1])
        breaks.update(spectrum.wavelengths)
    inside = sorted(point for point in breaks | {first, last} if first <= point <= last)
    return pairwise(inside)


@cache
def _y_integral() -> float:
    """Integral of ybar over 360-830 nm."""
    return _integrals(Spectrum("constant", "emission", value=1.0))[1]


@cache
def _white_xyz() -> XYZ:
    """Tristimulus values of the constant spectrum 1."""
    x, y, z = _integrals(Spectrum("constant", "emission", value=1.0))
    return x / y, 1.0, z / y
