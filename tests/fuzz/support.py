"""How the ordinary tests run a module of this folder in a process that may crash."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.fuzz.seeds import REPOSITORY

ENVIRONMENT = os.environ | {
    "MALLOC_ARENA_MAX": "2",  # each arena of glibc reserves 64 MiB of addresses, which are limited
    "PYTHONPATH": os.pathsep.join([*filter(None, sys.path), str(REPOSITORY)]),
}


def run_module(module: str, folder: Path, *arguments: str) -> list[Any]:
    """The JSON objects that the module writes, one a line; fails with what it says if it ends badly."""
    command = [sys.executable, "-m", module, str(folder), *arguments]
    done = subprocess.run(
        command, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, errors="replace", check=False, timeout=300
    )
    if done.returncode != 0:
        reader = (folder / "reader").read_text() if (folder / "reader").exists() else "before the first"
        pytest.fail(f"{module}, reader {reader}: status {done.returncode}\n{done.stderr[-4000:]}", pytrace=False)
    return [json.loads(line) for line in done.stdout.splitlines()]
