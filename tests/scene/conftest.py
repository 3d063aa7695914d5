"""Every test of the scene description begins with the compiled module's schema and no asset roots."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from accuray.scene import schema


@pytest.fixture(autouse=True)
def schema_in_use(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Clears the environment's roots before the test and a schema that it put in use after it."""
    monkeypatch.delenv("ACCURAY_PATH", raising=False)
    yield
    schema.use(None)
