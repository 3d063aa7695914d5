"""AccuRay's memory and time for geometry of full size: ten million triangles from a PLY file, a million instances.

``python -m benchmarks.large`` prints JSON and a table. Each case is a process of its own, on files that it finds in the
cache. Memory is what a process takes beyond the same process with a small scene; times are processor seconds of one
process, so they can be compared with each other on a busy machine.
"""

import argparse
import gc
import json
import resource
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import geometry, report

WORK = Path("out/bench/large")
SEGMENTS, RINGS = 3163, 1581
"""Of a bumpy sphere of 10 001 406 triangles."""

INSTANCES = 1_000_000
RING = 317
"""Segments along and around the torus that is instanced: 100 489 quads."""

RESIDENT_LIMIT, PEAK_LIMIT = 180, 250
COMPACT_RESIDENT_LIMIT, COMPACT_PEAK_LIMIT = 100, 150
"""Bytes per triangle, vertex normals and UVs included."""

INSTANCE_LIMIT = 100
"""Bytes per instance beyond Embree's own."""

LOAD_LIMIT = 10.0
"""Seconds for a million instances."""

CASES = ("mesh", "compact", "instances")


def measure() -> dict[str, Any]:
    """The figures of all cases, by name."""
    WORK.mkdir(parents=True, exist_ok=True)
    if not (WORK / "sphere.ply").exists():
        geometry.write_ply(geometry.bumpy_sphere("s", "m", (0, 0, 0), 1.0, SEGMENTS, RINGS), WORK / "sphere.ply")
    if not (WORK / "places.npy").exists():
        rows = np.zeros((INSTANCES, 3, 4), dtype=np.float32)
        rows[:, [0, 1, 2], [0, 1, 2]] = 1.0
        rows[:, :, 3] = np.random.default_rng(1).uniform(-500.0, 500.0, (INSTANCES, 3))
        np.save(WORK / "places.npy", rows)
    return {case: _measured_apart(case) for case in CASES}


def _measured_apart(case: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.large", case]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    return dict(json.loads(answer.stdout))


def _description(shapes: dict[str, Any], compact: bool = False) -> dict[str, Any]:
    camera = {"type": "perspective", "position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 40}
    return {"camera": camera, "materials": {"m": {"type": "diffuse"}}, "render": {"compact": compact}, "shapes": shapes}


def _shapes(case: str) -> dict[str, Any]:
    if case != "instances":
        return {"s": {"type": "mesh", "file": "sphere.ply", "material": "m"}}
    ring = {"type": "torus", "segments": RING, "tube_segments": RING, "material": "m", "prototype": True}
    return {"ring": ring, "all": {"type": "instance", "of": "ring", "instances": "places.npy"}}


def _status(key: str) -> int:
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return int(next(line for line in lines if line.startswith(key)).split()[1]) << 10


def _seconds() -> float:
    return sum(resource.getrusage(resource.RUSAGE_SELF)[:2])


def _watch(case: str) -> dict[str, Any]:
    """One case, in this process: bytes resident and at the peak, and processor seconds of each step."""
    import accuray
    from accuray import devices
    from accuray._core import engine
    from accuray.devices.lowering import lower

    small = accuray.Scene.from_dict(_description({"s": {"type": "torus", "material": "m"}}))
    devices.load(small)
    gc.collect()
    before, times = _status("VmRSS"), [_seconds()]
    file = WORK / ("places.npy" if case == "instances" else "sphere.ply")
    with file.open("rb") as content:
        while content.read(1 << 20):
            pass
    times.append(_seconds())
    scene = accuray.Scene.from_dict(_description(_shapes(case), case == "compact"), folder=WORK)
    block, _ = lower(scene)
    times.append(_seconds())
    ours = _status("VmRSS") - before
    loaded = engine.LoadedScene(block)
    times.append(_seconds())
    count = INSTANCES if case == "instances" else 2 * SEGMENTS * RINGS
    resident, peak = _status("VmRSS") - before, _status("VmHWM") - before
    reading, lowering, building = (b - a for a, b in pairwise(times))
    return {
        "resident": resident / count,
        "peak": peak / count,
        "ours": ours / count,
        "read_s": reading,
        "load_s": lowering,
        "build_s": building,
        "lights": loaded.lights,
    }


def rows(found: dict[str, Any]) -> list[dict[str, Any]]:
    """The limits beside what was measured."""
    mesh, compact, instances = (found[case] for case in CASES)
    allowed = 2.0 * mesh["build_s"] + mesh["read_s"]
    return report.limits(
        [
            ("bytes per triangle of ten million, resident", mesh["resident"], RESIDENT_LIMIT, True),
            ("the same, peak", mesh["peak"], PEAK_LIMIT, True),
            ("the same, compact, resident", compact["resident"], COMPACT_RESIDENT_LIMIT, True),
            ("the same, compact, peak", compact["peak"], COMPACT_PEAK_LIMIT, True),
            ("CPU s to load and build them", mesh["load_s"] + mesh["build_s"], allowed, True),
            ("bytes per instance of a million, beyond Embree's own", instances["ours"], INSTANCE_LIMIT, True),
            ("CPU s to load and build them", instances["load_s"] + instances["build_s"], LOAD_LIMIT, True),
        ]
    )


def main() -> int:
    """Measure everything, or the case that the command line names."""
    parser = argparse.ArgumentParser(description="Memory and time for ten million triangles and a million instances.")
    parser.add_argument("case", nargs="?", choices=CASES, help="measure this one, in this process")
    if case := parser.parse_args().case:
        print(json.dumps(_watch(case)))
        return 0
    found = measure()
    print(json.dumps(found))
    print(report.table(rows(found), report.LIMIT_COLUMNS))
    return 0


if __name__ == "__main__":
    sys.exit(main())
