"""Quantities with units: ``"35 mm"``, ``"15 deg"``, ``"6500 K"``, ``"1000 cd/m^2"``.

Numbers are converted as exact fractions and rounded once, so ``"35 mm"``, ``"3.5 cm"`` and ``0.035`` metres
are the same float and give the same scene identity. A quantity of the wrong dimension is an error.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

LENGTH_UNITS = ("m", "mm", "cm", "km", "um", "in", "ft")

_NUMBER = re.compile(r"\s*([+-]?)(\d*)(?:\.(\d*))?(?:[eE]([+-]?\d{1,6}))?\s*(.*)", re.DOTALL)
_TOKEN = re.compile(r"\s*(?:([A-Za-zµμ°]+)|\^?([+-]?\d+)|([²³])|([/*·()]))")
_MAX_TEXT = 100
_MAX_EXPONENT = 500

# name -> (numerator, denominator) relative to the base unit, exponents of the base units
_UNITS: dict[str, tuple[int, int, dict[str, int]]] = {
    "m": (1, 1, {"m": 1}),
    "km": (1000, 1, {"m": 1}),
    "cm": (1, 100, {"m": 1}),
    "mm": (1, 1000, {"m": 1}),
    "um": (1, 10**6, {"m": 1}),
    "µm": (1, 10**6, {"m": 1}),
    "μm": (1, 10**6, {"m": 1}),
    "nm": (1, 10**9, {"m": 1}),
    "in": (254, 10**4, {"m": 1}),
    "ft": (3048, 10**4, {"m": 1}),
    "deg": (1, 1, {"deg": 1}),
    "°": (1, 1, {"deg": 1}),
    "rad": (1, 1, {"rad": 1}),
    "sr": (1, 1, {"sr": 1}),
    "s": (1, 1, {"s": 1}),
    "ms": (1, 1000, {"s": 1}),
    "K": (1, 1, {"K": 1}),
    "W": (1, 1, {"W": 1}),
    "kW": (1000, 1, {"W": 1}),
    "mW": (1, 1000, {"W": 1}),
    "lm": (1, 1, {"lm": 1}),
    "cd": (1, 1, {"lm": 1, "sr": -1}),
    "lx": (1, 1, {"lm": 1, "m": -2}),
    "lux": (1, 1, {"lm": 1, "m": -2}),
    "nit": (1, 1, {"lm": 1, "sr": -1, "m": -2}),
    "px": (1, 1, {"px": 1}),
    "EV": (1, 1, {"EV": 1}),
}

_EXAMPLES = {
    "m": 'a number in the file\'s length_unit or a length such as "35 mm"',
    "deg": 'a number of degrees or an angle such as "15 deg" or "0.2 rad"',
    "K": 'a number of kelvins or a temperature such as "6500 K"',
    "cd/m^2": 'a number of cd/m^2 or a luminance such as "1000 cd/m^2"',
    "": "a number without a unit",
    "1": "a number without a unit",
}


class UnitError(ValueError):
    """A quantity that cannot be read or has the wrong dimension; ``str()`` says what is wrong."""


@dataclass(frozen=True)
class Unit:
    """A product of base units: its ratio to them and their exponents, sorted by name."""

    numerator: int
    denominator: int
    exponents: tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Quantity:
    """An exact number, as a fraction, with the unit it was written in ("" if none)."""

    numerator: int
    denominator: int
    unit: str


def describe(unit: str) -> str:
    """What a parameter with this documented unit takes, for error messages."""
    return _EXAMPLES.get(unit, f'a number or a quantity such as "1 {unit}"')


def looks_like_quantity(text: str) -> bool:
    """True for texts that begin like a number: ``"6500 K"``, ``"-3"``, ``".5 m"``."""
    return re.match(r"\s*[+-]?\.?\d", text) is not None


def parse_quantity(text: str) -> Quantity:
    """Number and unit of a text such as ``"1.5e3 W/(m^2 sr nm)"``. Raises UnitError."""
    match = _NUMBER.match(text) if len(text) <= _MAX_TEXT else None
    if match is None or not (match[2] or match[3]):
        raise UnitError("is not a number with a unit")
    digits = match[2] + (match[3] or "")
    exponent = int(match[4] or 0) - len(match[3] or "")
    if abs(exponent) > _MAX_EXPONENT:
        raise UnitError("is too large or too small a number")
    value = int(match[1] + digits)
    unit = match[5].strip()
    parse_unit(unit)
    return Quantity(value * 10 ** max(exponent, 0), 10 ** max(-exponent, 0), unit)


def parse_unit(text: str) -> Unit:
    """A unit such as ``W/(m^2 sr nm)`` or ``cd/m^2``; "" and "1" are dimensionless. Raises UnitError."""
    if text in ("", "1"):
        return Unit(1, 1, ())
    if text in _UNITS:
        numerator, denominator, exponents = _UNITS[text]
        return Unit(numerator, denominator, tuple(sorted(exponents.items())))
    tokens = _tokens(text)
    numerator, denominator = 1, 1
    total: dict[str, int] = {}
    for name, power in _factors(tokens, text):
        if name not in _UNITS:
            raise UnitError(f"has the unknown unit '{name}' (known: {', '.join(k for k in _UNITS if k.isascii())})")
        up, down, exponents = _UNITS[name]
        if power < 0:
            up, down = down, up
        numerator, denominator = numerator * up ** abs(power), denominator * down ** abs(power)
        for base, exponent in exponents.items():
            total[base] = total.get(base, 0) + exponent * power
    return Unit(numerator, denominator, tuple(sorted((base, e) for base, e in total.items() if e)))


def _tokens(text: str) -> list[str]:
    found: list[str] = []
    position = 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise UnitError(f"has the unreadable unit '{text}'")
        found.append(match[1] or match[2] or {"²": "2", "³": "3"}.get(match[3] or "", "") or match[4])
        position = match.end()
    return found


def _factors(tokens: list[str], text: str) -> list[tuple[str, int]]:
    """Unit names with their powers; "/" turns the next factor or bracket upside down."""
    factors: list[tuple[str, int]] = []
    inverted = bracket = is_open = False  # "/" just before; the open bracket follows a "/"; a bracket is open
    for last, token in zip(["", *tokens], tokens, strict=False):
        if token == "/":
            inverted = True
        elif token == "(" and not is_open:
            is_open, bracket, inverted = True, inverted, False
        elif token == ")" and is_open:
            is_open = bracket = False
        elif token in ("*", "·"):
            continue
        elif token.lstrip("+-").isdigit() and last in _UNITS and abs(int(token)) <= 9:
            name, sign = factors[-1]
            factors[-1] = (name, sign * int(token))
        elif token[0].isalpha() or token == "°":
            factors.append((token, -1 if inverted != bracket else 1))
            inverted = False
        else:
            raise UnitError(f"has the unreadable unit '{text}'")
    if is_open or inverted:
        raise UnitError(f"has the unreadable unit '{text}'")
    return factors


def resolve(value: int | float | str, unit: str, length_unit: str = "m") -> tuple[float, float]:
    """A bare number or a quantity as (value in the documented ``unit``, value as the renderer wants it).

    The renderer wants metres, radians and seconds; compound units stay as documented. A bare number is in the
    documented unit, or in ``length_unit`` if that is "m". Raises UnitError for a wrong dimension, an
    unreadable text or a number that is not finite.
    """
    quantity = parse_quantity(value) if isinstance(value, str) else _bare(value)
    given = quantity.unit
    if not given:
        if isinstance(value, str):
            raise UnitError("has no unit (a number without a unit is written without quotes)")
        given = length_unit if unit == "m" else unit
    source, target = parse_unit(given), parse_unit(unit)
    if source.exponents == target.exponents:
        documented = _ratio(quantity, source, target)
    elif (source.exponents, target.exponents) == ((("rad", 1),), (("deg", 1),)):
        documented = _ratio(quantity, source, source) * (180.0 / math.pi)
    else:
        raise UnitError("has the wrong unit")
    return documented, to_internal(documented, unit)


def to_internal(documented: float, unit: str) -> float:
    """A value in a documented unit as the renderer wants it: metres, radians, seconds, else unchanged."""
    if unit == "deg":
        return documented * (math.pi / 180.0)
    target = parse_unit(unit)
    if target.exponents in ((("m", 1),), (("s", 1),)) and target.numerator != target.denominator:
        return _ratio(_bare(documented), target, Unit(1, 1, target.exponents))
    return documented


def _bare(value: int | float) -> Quantity:
    if isinstance(value, int):
        return Quantity(value, 1, "")
    if not math.isfinite(value):
        raise UnitError("is not a finite number")
    return parse_quantity(repr(value))


def _ratio(quantity: Quantity, source: Unit, target: Unit) -> float:
    """The quantity in the target unit, rounded once (true division of integers is correctly rounded)."""
    above = quantity.numerator * source.numerator * target.denominator
    below = quantity.denominator * source.denominator * target.numerator
    try:
        return above / below
    except OverflowError:
        raise UnitError("is too large a number") from None


def length_ratio(length_unit: str) -> tuple[int, int]:
    """Metres per length unit as an exact fraction."""
    numerator, denominator, _ = _UNITS[length_unit]
    return numerator, denominator
