"""Parameter sets for tests that loop over every type of every list.

The renderer describes each type in a table (`accuray schema`): names, kinds, ranges, defaults. `parameter_sets` turns
one table into concrete scene values, so a type that is added to a list is tested without a line in the tests.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

Table = Mapping[str, Any]

#: Stand-ins for the ends of ranges that the tables leave open.
_OPEN_MAXIMUM = {"index": 2.5, "emission": 10.0, "reflectance": 1.0, "": 4.0}
_SKIPPED_KINDS = ("file", "transform", "array", "reference")


def types_of(tables: Table, *families: str) -> Iterator[tuple[str, Table]]:
    """(family, type table) of every type of the given families, of all families if none is given."""
    for family, content in tables["families"].items():
        if not families or family in families:
            for table in content["types"]:
                yield family, table


def alternatives(table: Table) -> list[frozenset[str]]:
    """Every choice of parameter names that satisfies the "exactly one of" groups of a type.

    A group is written "set:alternative", or "set?:alternative" where none need be given. Parameters outside groups are
    in every choice.
    """
    choices: list[frozenset[str]] = [frozenset(p["name"] for p in table["params"] if not p["group"])]
    sets: dict[str, dict[str, list[str]]] = {}
    for p in table["params"]:
        if p["group"]:
            name, _, alternative = p["group"].partition(":")
            sets.setdefault(name, {}).setdefault(alternative, []).append(p["name"])
    for name, branches in sets.items():
        if name.endswith("?"):
            branches[""] = []
        choices = [base | frozenset(branch) for base in choices for branch in branches.values()]
    return choices


def parameter_sets(
    table: Table, count: int = 24, seed: int = 0, texts: Mapping[str, tuple[str, ...]] | None = None
) -> list[dict[str, Any]]:
    """About `count` parameter sets of a type: defaults first, then the ends of all ranges, then random values.

    `texts` lists values for text parameters by name (a metal, say); a choice of parameters that needs a text without
    one, a file, an array or a reference is left out.
    """
    rng = np.random.default_rng(seed)
    parameters = {p["name"]: p for p in table["params"]}
    usable = [c for c in alternatives(table) if all(_can_make(parameters[n], texts or {}) for n in c)]
    result: list[dict[str, Any]] = []
    for choice in usable:
        names = [n for n in parameters if n in choice and parameters[n]["kind"] not in _SKIPPED_KINDS]
        modes = ["default", "low", "high"] + ["random"] * max(0, count // len(usable) - 3)
        for mode in modes:
            values = {n: _value(parameters[n], mode, rng, (texts or {}).get(n, ())) for n in names}
            candidate = {n: v for n, v in values.items() if v is not None}
            if candidate not in result:
                result.append(candidate)
    return result


def _can_make(p: Table, texts: Mapping[str, tuple[str, ...]]) -> bool:
    """Whether a value for this parameter can be invented, or is not needed."""
    needed = bool(p["required"] or p["group"]) and p["default"] is None
    if p["kind"] in _SKIPPED_KINDS:
        return not needed
    if p["kind"] == "text":
        return not needed or bool(texts.get(p["name"]))
    return True


def _value(p: Table, mode: str, rng: np.random.Generator, texts: tuple[str, ...]) -> Any:
    """One value of a parameter; None leaves it out."""
    kind = p["kind"]
    if mode == "default" and p["default"] is not None:
        return p["default"]
    if kind == "bool":
        return {"low": False, "high": True}.get(mode, bool(rng.integers(2)))
    if kind in ("enum", "text"):
        choices = list(p["choices"]) if kind == "enum" else list(texts)
        return choices[_pick(mode, len(choices), rng)] if choices else None
    low = float(p["min"]) if p["min"] is not None else 0.0
    high = float(p["max"]) if p["max"] is not None else low + _OPEN_MAXIMUM.get(p["role"], 4.0)
    if kind == "vec":
        return [float(x) for x in rng.uniform(-1.0, 1.0, 3)]
    number = {"low": low, "high": high}.get(mode, float(rng.uniform(low, high)))
    return round(number) if kind == "int" else number


def _pick(mode: str, count: int, rng: np.random.Generator) -> int:
    return {"low": 0, "high": count - 1}.get(mode, int(rng.integers(max(1, count))))
