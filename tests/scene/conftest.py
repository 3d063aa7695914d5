"""Tests of the scene description run with the compiled module's parameter tables or a copy of them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from scene_support import plain_tables

from accuray.scene import schema


@pytest.fixture(autouse=True)
def schema_in_use(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The schema for one test, and no asset roots from the environment."""
    monkeypatch.delenv("ACCURAY_PATH", raising=False)
    schema.use(plain_tables())
    yield
    schema.use(None)
