"""Single plain values: numbers, lists of numbers, quantities, texts; and the range check they share."""

from __future__ import annotations

import math
from typing import Any

from accuray.scene import units
from accuray.scene.errors import Where, nearest_name, show
from accuray.scene.schema import Param

MAX_TEXT = 4096


def range_text(param: Param) -> str | None:
    """The allowed range for an error message, None if there is none."""
    unit = f" {param.unit}" if param.unit not in ("", "1") else ""
    if param.min is None and param.max is None:
        return None
    if param.min is None:
        return f"up to {param.max:g}{unit}"
    if param.max is None:
        return f"at least {param.min:g}{unit}"
    return f"{plain_number(param.min)} to {plain_number(param.max)}{unit}"


def plain_number(value: float) -> str:
    """A limit without a needless ``.0`` or exponent."""
    return str(int(value)) if float(value).is_integer() and abs(value) < 1e15 else repr(value)


def in_range(param: Param, number: float) -> bool:
    """Is a number, in the documented unit, inside the parameter's range?"""
    return (param.min is None or number >= param.min) and (param.max is None or number <= param.max)


def finite_number(value: Any, where: Where, allowed: str) -> float:
    """A finite float from an int, float or numpy scalar; never from a bool or a text."""
    if isinstance(value, (bool, str, dict, list, tuple)) or value is None or not hasattr(value, "__float__"):
        raise where.error("is not a number", value=value, allowed=allowed)
    try:
        number = float(value)
    except OverflowError:
        raise where.error("is too large a number", value=value, allowed=allowed) from None
    except (TypeError, ValueError):
        raise where.error("is not a number", value=value, allowed=allowed) from None
    if not math.isfinite(number):
        raise where.error("is not a finite number", value=value, allowed=allowed)
    return number + 0.0  # -0.0 becomes 0.0: both spell the same scene


def number_list(value: Any, where: Where, allowed: str) -> tuple[float, ...]:
    """A flat list of finite numbers, from a list, tuple or one-dimensional array."""
    if isinstance(value, (str, dict)) or not hasattr(value, "__len__") or not hasattr(value, "__iter__"):
        raise where.error("is not a list of numbers", value=value, allowed=allowed)
    return tuple(finite_number(item, where.child(index), "finite numbers") for index, item in enumerate(value))


def quantity(param: Param, value: Any, where: Where, length_unit: str | None = None) -> float:
    """A number or quantity in the parameter's range, in the renderer's unit (metres, radians, ...)."""
    return quantities(param, value, where, length_unit)[1]


def quantities(param: Param, value: Any, where: Where, length_unit: str | None = None) -> tuple[float, float]:
    """As ``quantity``, but (value in the documented unit, value in the renderer's unit)."""
    allowed = range_text(param) or units.describe(param.unit)
    if not isinstance(value, str):
        value = value if type(value) is int else finite_number(value, where, allowed)
    try:
        documented, internal = units.resolve(value, param.unit, length_unit or where.source.length_unit)
    except units.UnitError as error:
        raise where.error(str(error), value=value, allowed=units.describe(param.unit)) from None
    if not in_range(param, documented):
        raise where.error("is out of range", value=value, allowed=allowed)
    return documented + 0.0, internal + 0.0


def text_value(value: Any, where: Where) -> str:
    """A short text without control characters."""
    if not isinstance(value, str):
        raise where.error("is not a text", value=value, allowed='a text such as "name"')
    if len(value) > MAX_TEXT or any(ord(character) < 32 for character in value):
        raise where.error(
            "is too long or has control characters", value=value, allowed=f"up to {MAX_TEXT} printable characters"
        )
    return value


def choice(param: Param, value: Any, where: Where) -> str:
    """One of the parameter's choices."""
    if isinstance(value, str) and value in param.choices:
        return value
    allowed = ", ".join(show(name) for name in param.choices)
    raise where.error("is not allowed", value=value, allowed=allowed, nearest=nearest_name(value, param.choices))
