"""Amounts of light over all wavelengths: what nit, cd, lx, lm and W say about a spectrum.

The parameters of lights are spectral: their units hold nm^-1. An amount in the same unit without it is the integral
from 360 to 830 nm, as W/sr is of an intensity; with lm in place of W it is weighted by the eye, as cd is (683.002 lm/W
times the CIE 1931 ybar). lm and W by themselves are the flux of the whole emitter, where that has one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from accuray import data
from accuray.scene import units
from accuray.scene.errors import Where
from accuray.scene.plain import quantity
from accuray.scene.schema import Param
from accuray.scene.spectrum import Spectrum, radiant, xyz

NAMES = {
    "luminance": ("cd/m^2",),
    "radiance": ("W/(m^2 sr)",),
    "intensity": ("cd", "W/sr"),
    "illuminance": ("lx",),
    "irradiance": ("W/m^2",),
    "flux": ("lm", "W"),
}
"""Keys of a spectrum that give its amount, and the units that each takes; a bare number is in the first."""

FOLDED_DIGITS = 12
_SPECTRAL_UNITS = ("W/(m^2 sr nm)", "W/(sr nm)", "W/(m^2 nm)")

Exponents = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Amount:
    """A number of W or lm, by m^2 and sr as the parameter is, or ``flux`` of the whole emitter."""

    value: float
    luminous: bool
    flux: bool


def lumens_per_y() -> float:
    """lm/m^2/sr of a spectral radiance with Y = 1: 683.002 lm/W times the integral of ybar, 72 983."""
    return data.LUMINOUS_EFFICACY * sum(data.observer().y)


@cache
def kinds(param: Param) -> dict[Exponents, tuple[bool, bool]]:
    """Dimensions of the amounts that fit a parameter: (weighted by the eye, flux of the whole emitter) of each."""
    spectral = dict(units.parse_unit(param.unit).exponents)
    if param.role != "emission" or "W" not in spectral:
        return {}
    radiant_unit = {**spectral, "m": spectral.get("m", 0) + 1}
    luminous_unit = {("lm" if base == "W" else base): power for base, power in radiant_unit.items()}
    found = {_exponents(radiant_unit): (False, False), _exponents(luminous_unit): (True, False)}
    if param.takes_flux:
        found |= {(("W", 1),): (False, True), (("lm", 1),): (True, True)}
    return found


def _exponents(powers: dict[str, int]) -> Exponents:
    return tuple(sorted((base, power) for base, power in powers.items() if power))


def fitting_units(param: Param) -> list[str]:
    """Units of the amounts that fit a parameter, as the reference writes them."""
    known = [unit for choices in NAMES.values() for unit in choices]
    return [unit for unit in known if units.parse_unit(unit).exponents in kinds(param)]


def fitting_names(param: Param) -> list[str]:
    """Keys of a spectrum whose amounts fit a parameter."""
    return [name for name, choices in NAMES.items() if units.parse_unit(choices[0]).exponents in kinds(param)]


def spectral_unit(name: str) -> tuple[str, bool]:
    """A unit of a parameter that an amount of this name fits, and whether it must take a flux."""
    if name == "flux":
        return _SPECTRAL_UNITS[0], True
    fits = (u for u in _SPECTRAL_UNITS if name in fitting_names(Param("", "spectrum", unit=u, role="emission")))
    return next(fits), False


def named_amount(param: Param, name: str, value: Any, where: Where) -> Amount:
    """The amount that a spectrum's key ``name`` gives. Raises SceneError."""
    choices = NAMES[name]
    unit = next((unit for unit in choices if isinstance(value, str) and _is_in(value, unit)), choices[0])
    number = quantity(Param(name, "float", unit=unit, min=0.0), value, where)
    if units.parse_unit(unit).exponents not in kinds(param):
        fitting = [*fitting_names(param), f"scale, for a quantity in {param.unit or 'any unit'}"]
        raise where.error("does not fit this parameter", value=value, allowed=" or ".join(fitting))
    return Amount(number, *kinds(param)[units.parse_unit(unit).exponents])


def plain_amount(param: Param, text: str, where: Where) -> Amount:
    """The amount that a text gives whose dimension is one of ``kinds``. Raises SceneError."""
    exponents = units.parse_unit(units.parse_quantity(text).unit).exponents
    base = " ".join(f"{name}^{power}" for name, power in exponents)
    number = quantity(Param(param.name, "float", unit=base, min=0.0), text, where)
    return Amount(number, *kinds(param)[exponents])


def _is_in(text: str, unit: str) -> bool:
    try:
        return units.parse_unit(units.parse_quantity(text).unit).exponents == units.parse_unit(unit).exponents
    except units.UnitError:
        return False


def scaled_to(spectrum: Spectrum, amount: Amount, where: Where) -> Spectrum:
    """The spectrum times the factor that gives it this amount. Raises SceneError where none does."""
    if amount.luminous:
        present = xyz(spectrum)[1] * lumens_per_y()
        problem = "has no visible light, so it cannot be scaled to a luminous amount"
    else:
        present = radiant(spectrum)
        problem = "has no light between 360 and 830 nm, so it cannot be scaled to an amount in W"
        if math.isnan(present):
            problem = "is an RGB colour, whose power is known in lm but not in W"
    if not present > 0.0 or not math.isfinite(amount.value / present):
        raise where.error(problem)
    return replace(folded(spectrum, amount.value / present), flux=amount.flux)


def folded(spectrum: Spectrum, factor: float) -> Spectrum:
    """The spectrum times a factor, which is rounded to 12 digits, so no platform's libm shows in it."""
    return spectrum.times(float(f"{factor:.{FOLDED_DIGITS - 1}e}"))
