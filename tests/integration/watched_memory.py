"""Prepares one scene and prints, as JSON, what it took of memory: run by test_memory_estimates in a process of its own.

`estimate`: bytes by the budget; `grown`: by how much the peak of the process grew while the scene was prepared;
`ours`: what it held more, before Embree, than before the scene was described; `count`: about so many triangles,
instances or lights.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from instance_arrays import scene_with, similarities

import accuray
from accuray import devices
from accuray._core import engine
from accuray.devices.lowering import _Lowering as Lowering


def status(key: str) -> int:
    """Bytes that the system has in this process's status."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return int(next(line for line in lines if line.startswith(key)).split()[1]) << 10


def described(case: str, count: int, folder: Path) -> accuray.Scene:
    """The scene of a case, with about so many of what it is about."""
    shapes: dict[str, Any] = {}
    materials: dict[str, Any] = scene_with({})["materials"]
    if "mesh" in case:
        side = max(3, int((count / 2) ** 0.5))
        shapes = {"ring": {"type": "torus", "material": "grey", "segments": side, "tube_segments": side}}
    else:
        np.save(folder / "rows.npy", similarities(count, 1, 100.0))
        shapes = {"field": {"type": "instance", "of": "ball", "instances": "rows.npy"}}
        if case == "lights":
            materials = materials | {"glow": {"type": "diffuse", "reflectance": 0, "emission": 1}}
            shapes["field"]["material"] = "glow"
    render = {"compact": case.startswith("compact")}
    return accuray.Scene.from_dict(scene_with(shapes, materials=materials, render=render), folder=folder)


def main() -> None:
    """Measures the case that the command line names."""
    case = sys.argv[1]
    count = {"mesh": 200_000, "compact mesh": 200_000, "instances": 100_000, "lights": 40_000}[case]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        devices.load(described(case, 200, folder))
        before = status("VmRSS")
        scene = described(case, count, folder)
        start = status("VmRSS")
        lowering = Lowering(scene)
        block = lowering.block()
        ours = status("VmRSS") - before
        engine.LoadedScene(block)
        grown = status("VmHWM") - start
    print(json.dumps({"estimate": lowering.shapes.budget.claimed, "grown": grown, "ours": ours, "count": count}))
