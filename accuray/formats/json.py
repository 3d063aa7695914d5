"""Scene files in JSON, for programs that write scenes: the same structure as TOML."""

from __future__ import annotations

import json
from typing import Any

from accuray.formats.places import depth_error, value_error
from accuray.scene.errors import SceneError, show


def parse(text: str, name: str) -> dict[str, Any]:
    """The object in a JSON text; SceneError with ``name``, line and column for a syntax error.

    Duplicate keys and the non-standard constants NaN and Infinity are refused.
    """
    try:
        content = json.loads(text, object_pairs_hook=_unique, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise SceneError(
            f"column {error.colno}: JSON syntax error: {error.msg}",
            file=name,
            line=error.lineno,
            shown=text.split("\n")[error.lineno - 1],
        ) from None
    except RecursionError:
        raise depth_error(text, name) from None
    except ValueError as error:
        raise value_error(error, text, name) from None
    if not isinstance(content, dict):
        raise SceneError(f"{show(content)} is not an object", file=name, value=content, allowed='{"accuray": 1, ...}')
    return content


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) != len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {show(twice)} is there twice in one object", "each key once")
    return table


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is not a number of JSON", "finite numbers")
