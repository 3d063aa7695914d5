"""What the tests of the scene description share: where the parameter tables come from, how hypothesis runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hypothesis import settings

from accuray.scene import schema

STEADY = settings(max_examples=50, deadline=None, derandomize=True)
"""The same examples in every run, however slow the machine is."""

FIXTURE = Path(__file__).with_name("schema_fixture.json")


def has_core() -> bool:
    """Is the compiled module there?"""
    try:
        schema.load_tables()
    except ImportError:
        return False
    return True


def plain_tables() -> dict[str, Any]:
    """The parameter tables of the compiled module, or a copy of them where it is not built."""
    if has_core():
        return schema.load_tables()
    copy: dict[str, Any] = json.loads(FIXTURE.read_text(encoding="utf-8"))
    return copy
