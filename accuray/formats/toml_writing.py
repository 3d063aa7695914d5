"""Writes the sections of a scene as TOML, one table for each object."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")
WIDTH = 110
"""Lists longer than this get a line for each element."""


def write_toml(data: dict[str, Any], comments: Iterable[str] = ()) -> str:
    """The text of a scene file: ``data`` holds sections of plain values, ``comments`` come first, a line each."""
    lines = [f"# {comment}" for text in comments for comment in text.split("\n")]
    lines += [f"{key_text(key)} = {value_text(value)}" for key, value in data.items() if not isinstance(value, dict)]
    for name, section in data.items():
        if isinstance(section, dict):
            lines += _section(name, section)
    return "\n".join(lines) + "\n"


def _section(name: str, section: dict[str, Any]) -> list[str]:
    """A single table, or a table for each of the objects in it."""
    if not section:
        return []
    if not all(isinstance(item, dict) for item in section.values()):
        return ["", f"[{name}]", *_pairs(section)]
    lines: list[str] = []
    for key, table in section.items():
        lines += ["", f"[{name}.{key_text(key)}]", *_pairs(table)]
    return lines


def _pairs(table: dict[str, Any]) -> list[str]:
    return [f"{key_text(key)} = {value_text(value)}" for key, value in table.items()]


def key_text(key: str) -> str:
    """A key, quoted where it has to be."""
    return key if _BARE.fullmatch(key) else _text(key)


def value_text(value: Any) -> str:
    """A value: truth value, number, text, list or inline table."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(_pairs(value)) + " }"
    items = [value_text(item) for item in value]
    short = "[" + ", ".join(items) + "]"
    return short if len(short) <= WIDTH else "[\n  " + ",\n  ".join(items) + ",\n]"


def _text(text: str) -> str:
    """A basic string; TOML has the escapes of JSON, and forbids one more character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
