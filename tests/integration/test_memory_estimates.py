"""What is estimated before a scene is prepared, against what a process really takes: never too little, never half as
much again; and what an instance takes beyond Embree's own.

Each case is a process of its own that prepares a small scene, so that everything is loaded, and then the large one.
"""

from __future__ import annotations

import functools
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")

WATCHED = Path(__file__).parent / "watched_memory.py"
INSTANCE_LIMIT = 100
"""Bytes that an instance may take beyond Embree's own."""


@functools.cache
def watched(case: str) -> dict[str, Any]:
    """See ``watched_memory``."""
    command = [
        sys.executable,
        "-c",
        f"import sys; sys.path[:0] = {sys.path!r}; import watched_memory as w; w.main()",
    ]
    returning = {**os.environ, "MALLOC_MMAP_THRESHOLD_": "65536"}  # what is freed goes back to the system at once
    answer = subprocess.run([*command, case], capture_output=True, text=True, check=False, env=returning)
    assert answer.returncode == 0, answer.stderr
    return dict(json.loads(answer.stdout))


@pytest.mark.parametrize("case", ["mesh", "compact mesh", "instances", "lights"])
def test_estimates_hold(case: str) -> None:
    seen = watched(case)
    assert seen["grown"] <= seen["estimate"] <= 1.5 * seen["grown"] + (8 << 20), seen


def test_an_instance_takes_less_than_100_bytes_beyond_embrees_own() -> None:
    seen = watched("instances")
    assert 64 <= seen["ours"] / seen["count"] <= INSTANCE_LIMIT, seen
