"""Every test of models begins without asset roots, in a folder of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")


@pytest.fixture(autouse=True)
def _own_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("ACCURAY_PATH", raising=False)
    monkeypatch.chdir(tmp_path)
