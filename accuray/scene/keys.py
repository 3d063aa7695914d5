"""Values that change with time: ``{keys = [{time = 0, value = 1}, ...], interpolation = "linear"}``.

A keyed value is evaluated once per frame, at the frame's time, and is constant while the shutter is open. Before the
first key and after the last one it stays what it is there. Numbers and vectors are interpolated in the renderer's
units; spectra in the numbers of their spelling, a temperature as a temperature and a luminance as a luminance, so all
keys of one must be spelled alike.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

from accuray.scene import units
from accuray.scene.errors import Where
from accuray.scene.plain import choice, finite_number, quantity
from accuray.scene.schema import Param
from accuray.scene.scope import Scope

KINDS = ("float", "vec", "spectrum")
"""Parameter kinds that can be keyed; keys of transforms are the transforms' own."""

INTERPOLATION = Param("interpolation", "enum", default="linear", choices=("linear", "step", "smooth"))
TIME = Param("time", "float", unit="s", min=-1e9, max=1e9)
ALLOWED = '{keys = [{time = 0, value = ...}, {time = "500 ms", value = ...}], interpolation = "linear"}'
MAX_KEYS = 100_000

Resolver = Callable[[Any, Where], Any]
"""Resolves a plain value that is written at a place. Raises SceneError."""


class Span(NamedTuple):
    """The keys around a moment: ``before`` and ``after`` are their numbers, ``along`` in [0, 1) the way between."""

    before: int
    after: int
    along: float


def is_keyed(value: Any) -> bool:
    """Is a value of a scene given by keys?"""
    return isinstance(value, dict) and "keys" in value


def takes_keys(param: Param) -> bool:
    """May the value of a parameter be given by keys?"""
    return param.animatable and param.kind in KINDS


def has_keys(value: Any) -> bool:
    """Does anything in a description change with time? Looks into tables and lists of tables."""
    if isinstance(value, dict):
        return "keys" in value or any(map(has_keys, value.values()))
    return isinstance(value, (list, tuple)) and any(has_keys(item) for item in value if isinstance(item, (dict, list)))


def first_value(value: Any, where: Where) -> tuple[Any, Where]:
    """The value of the first key and its place; a plain value itself. Raises SceneError for keys without one."""
    if not is_keyed(value):
        return value, where
    return read_keys(value, where)[1][0], where.child("keys", 0, "value")


def resolve_keyed(param: Param, value: dict[str, Any], where: Where, scope: Scope, resolve: Resolver) -> Any:
    """The canonical value at the time of ``scope.clock``. Every key is checked, whatever the time. Raises SceneError.

    ``resolve`` gives the canonical value of a plain one.
    """
    if not takes_keys(param):
        raise where.error("cannot change with time", value=value, allowed=f"a {param.kind} without keys")
    times, values = read_keys(value, where)
    places = [where.child("keys", number, "value") for number in range(len(values))]
    resolved = [resolve(item, place) for item, place in zip(values, places, strict=True)]
    kind = choice(INTERPOLATION, value.get("interpolation", INTERPOLATION.default), where.child("interpolation"))
    if param.kind == "spectrum":
        for item, place in zip(values[1:], places[1:], strict=True):
            _mix(values[0], item, 0.0, place)
    span = span_at(times, kind, scope.clock.time)
    if span.along == 0.0:
        return resolved[span.before]
    if param.kind == "spectrum":
        mixed = _mix(values[span.before], values[span.after], span.along, places[span.after])
        return resolve(mixed, places[span.after])
    first, last = resolved[span.before], resolved[span.after]
    if param.kind == "float":
        return between(first, last, span.along)
    return tuple(between(a, b, span.along) for a, b in zip(first, last, strict=True))


def span_at(times: list[float], interpolation: str, time: float) -> Span:
    """Where a moment lies among rising times, in seconds. "smooth" is 3 s^2 - 2 s^3 of the linear way s."""
    before = bisect_right(times, time) - 1
    if before < 0:
        return Span(0, 0, 0.0)
    if before == len(times) - 1 or interpolation == "step":
        return Span(before, before, 0.0)
    along = (time - times[before]) / (times[before + 1] - times[before])
    if interpolation == "smooth":
        along = along * along * (3.0 - 2.0 * along)
    return Span(before, before + 1, along)


def between(first: float, last: float, along: float) -> float:
    """Linear interpolation that never leaves its ends."""
    value = first + (last - first) * along
    return min(max(value, min(first, last)), max(first, last))


def read_keys(value: dict[str, Any], where: Where) -> tuple[list[float], list[Any]]:
    """Rising times in seconds and the values of the keys, as they are written."""
    for key in value:
        if key not in ("keys", "interpolation"):
            raise where.child(key).unknown(key, "part of a keyed value", ("keys", "interpolation"))
    keys, place = value["keys"], where.child("keys")
    if not isinstance(keys, (list, tuple)) or not 1 <= len(keys) <= MAX_KEYS:
        raise place.error("is not a list of keys", value=keys, allowed=f"1 to {MAX_KEYS} keys: {ALLOWED}")
    times: list[float] = []
    values: list[Any] = []
    for number, key in enumerate(keys):
        here = place.child(number)
        if not isinstance(key, dict) or set(key) != {"time", "value"}:
            raise here.error("is not a key", value=key, allowed="{time = 0, value = ...}")
        times.append(quantity(TIME, key["time"], here.child("time")))
        if is_keyed(key["value"]) or (isinstance(key["value"], dict) and "texture" in key["value"]):
            raise here.child("value").error("is not a plain value", value=key["value"], allowed="a value without keys")
        values.append(key["value"])
    for number, (earlier, later) in enumerate(pairwise(times)):
        if not earlier < later:
            problem = f"comes at {later:g} s, not after the key before it at {earlier:g} s"
            raise place.child(number + 1, "time").error(problem, value=keys[number + 1]["time"], allowed="rising times")
    return times, values


def _mix(first: Any, last: Any, along: float, where: Where) -> Any:
    """Two spellings of a spectrum, interpolated number by number. Raises SceneError unless they are alike."""
    if isinstance(first, dict) and isinstance(last, dict):
        if set(first) != set(last):
            raise where.error("has another form than the first key", value=last, allowed=", ".join(first))
        return {key: _mix_entry(key, first[key], last[key], along, where.child(key)) for key in first}
    if isinstance(first, (bool, str)) or isinstance(last, (bool, str)) or first is None or last is None:
        return _mix_texts(first, last, along, where)
    if hasattr(first, "__len__") and hasattr(last, "__len__"):
        if len(first) != len(last):
            raise where.error(f"has {len(last)} numbers", allowed=f"{len(first)}, as many as the first key")
        return [_mix(a, b, along, where.child(index)) for index, (a, b) in enumerate(zip(first, last, strict=True))]
    if hasattr(first, "__len__") or hasattr(last, "__len__"):
        raise where.error("has another form than the first key", value=last, allowed="keys that are spelled alike")
    start, end = (finite_number(item, where, "a number") for item in (first, last))
    return between(start, end, along)


def _mix_entry(key: str, first: Any, last: Any, along: float, where: Where) -> Any:
    """An entry of a spectrum's table; wavelengths stay what they are."""
    if key == "wavelengths" and list(first) != list(last):
        raise where.error("differ from those of the first key", allowed="the same wavelengths in all keys")
    return first if key == "wavelengths" else _mix(first, last, along, where)


def _mix_texts(first: Any, last: Any, along: float, where: Where) -> Any:
    """Equal names, or two quantities: then one in the unit of the first."""
    if type(first) is type(last) and first == last:
        return first
    if not (isinstance(first, str) and isinstance(last, str)):
        raise where.error("has another form than the first key", value=last, allowed="keys that are spelled alike")
    try:
        unit = units.parse_quantity(first).unit
        start, end = (units.resolve(text, unit)[0] for text in (first, last))
    except units.UnitError:
        raise where.error(
            "cannot be interpolated with the key before it",
            value=last,
            allowed='the same name in all keys, or quantities of one unit such as "6500 K"',
        ) from None
    return f"{between(start, end, along)!r} {unit}"
