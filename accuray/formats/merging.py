"""Puts scene documents on top of each other, and single overrides on top of a document.

Sections and named objects merge key by key; a parameter's value is always replaced as a whole. An object that
gets another ``type`` starts afresh, because the parameters of the old type do not apply to the new one.
"""

from __future__ import annotations

import tomllib
from typing import Any

from accuray.scene.errors import Document, Key, SceneError, Source, Where
from accuray.scene.scene import FILE_KEYS

NAMED_SECTIONS = ("models", "textures", "materials", "lights", "shapes")

Path = tuple[Key, ...]


def merge(below: Document, above: Document) -> Document:
    """One document with the values of ``above`` over those of ``below``; every part keeps its own source."""
    origins: dict[Path, Source] = {}
    data = _overlay(below, below.data, above, above.data, (), origins)
    return Document(data, above.top, origins)


def _overlay(
    below: Document,
    base: dict[str, Any],
    above: Document,
    over: dict[str, Any],
    path: Path,
    origins: dict[Path, Source],
) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key in [*base, *(key for key in over if key not in base)]:
        here = (*path, key)
        if not path and key in FILE_KEYS:
            if key in over:
                result[key] = over[key]
        elif key in over and key in base and _merges(here, base[key], over[key]):
            result[key] = _overlay(below, base[key], above, over[key], here, origins)
            origins[here] = above.source_of(here)
        else:
            document, value = (above, over[key]) if key in over else (below, base[key])
            result[key] = value
            _adopt(document, value, here, origins)
    return result


def _merges(path: Path, base: Any, over: Any) -> bool:
    """Do two values at this path merge key by key?"""
    if not (_is_container(path) and isinstance(base, dict) and isinstance(over, dict)):
        return False
    return "type" not in base or "type" not in over or bool(base["type"] == over["type"])


def _is_container(path: Path) -> bool:
    """Is this the path of a section or of an object, whose keys come from different files?"""
    return len(path) == 1 or (len(path) == 2 and (path[0] in NAMED_SECTIONS or path == ("film", "filter")))


def _adopt(document: Document, value: Any, path: Path, origins: dict[Path, Source]) -> None:
    """Record the source of a value and, in sections and objects, of each key."""
    origins[path] = document.source_of(path)
    if _is_container(path) and isinstance(value, dict):
        for key, item in value.items():
            _adopt(document, item, (*path, key), origins)


def parse_override(text: str) -> tuple[str, Any]:
    """Key and value of ``"film.width=256"``; a value that is no TOML value is a text. Raises SceneError."""
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise SceneError("is not an override", file=f"-D {text}", value=text, allowed="key=value, as in film.width=256")
    try:
        parsed = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        return key.strip(), value.strip()
    ok = len(parsed) == 1 and isinstance(parsed["value"], (bool, int, float, str, list, dict))
    return key.strip(), parsed["value"] if ok else value.strip()


def apply_override(document: Document, name: str, key: str, value: Any) -> None:
    """Set the value at a dotted key; ``name`` stands for the override in errors. Raises SceneError."""
    source = Source(name=name, folder=document.top.folder, length_unit=document.top.length_unit)
    path = _split(key, Where(Document({}, source)))
    where = Where(Document(document.data, source), path)
    if path[0] in FILE_KEYS:
        raise where.error("cannot be overridden", allowed="values inside the sections")
    table = document.data
    for depth, part in enumerate(path[:-1]):
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            inside = Where(where.document, path[: depth + 1])
            raise inside.error("is not a table, so nothing in it can be set", value=table)
    replaced = path
    if path[-1] == "type" and table.get("type", value) != value:
        table.clear()
        replaced = path[:-1]
    table[path[-1]] = value
    for known in [known for known in document.origins if known[: len(replaced)] == replaced]:
        del document.origins[known]
    document.origins[path] = source


def _split(key: str, where: Where) -> tuple[str, ...]:
    """The parts of a dotted key, each bare or quoted as in TOML."""
    try:
        node: Any = tomllib.loads(f"{key} = 0")
    except (ValueError, RecursionError):
        raise where.error("is not a dotted key", value=key, allowed="names joined by dots, as in film.width") from None
    parts: list[str] = []
    while isinstance(node, dict) and len(node) == 1:
        part, node = next(iter(node.items()))
        parts.append(part)
    if node != 0:
        raise where.error("is not a dotted key", value=key, allowed="names joined by dots, as in film.width")
    return tuple(parts)
