"""Every test of the command line runs in an empty folder, with no variable of the environment that it reads."""

from __future__ import annotations

from pathlib import Path

import fake_engine
import pytest


@pytest.fixture(autouse=True)
def empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder of the test."""
    monkeypatch.chdir(tmp_path)
    for name in ("ACCURAY_THREADS", "SLURM_CPUS_PER_TASK", "ACCURAY_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.fixture
def engine(monkeypatch: pytest.MonkeyPatch) -> fake_engine.FakeEngine:
    """A fake engine behind the public API."""
    return fake_engine.install(monkeypatch)
