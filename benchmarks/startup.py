"""Whole-process time and peak memory of a Cornell box of 256 x 256 pixels at 1 sample, written to disk.

``python -m benchmarks.startup [--runs N] [--peers accuray,mitsuba,cycles]`` prints JSON and a table. A process of its
own and free of large imports: a child's peak memory as the system reports it is at least what its parent held.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks import peers, report, settings

TIME_LIMIT_S = 0.4
MEMORY_LIMIT_MB = 150
GIVE_UP_S = 60
COLUMNS = {
    "renderer": "renderer",
    "seconds": "median s|.3f",
    "fastest": "min s|.3f",
    "peak_mb": "peak MB|.0f",
    "error": "error",
}


def measure(work: Path, wanted: tuple[str, ...], runs: int) -> list[dict[str, Any]]:
    """Time the renderers in turn, ``runs`` times each after one untimed run."""
    folder = (work / "startup").resolve()
    maker = [sys.executable, "-m", "benchmarks.scenes", "cornell", str(folder)]
    subprocess.run([*maker, "--size", str(settings.STARTUP_SIZE), "--xml"], check=True, capture_output=True)
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: settings.THREADS])
    seen: dict[str, list[tuple[float, float]]] = {peer: [] for peer in wanted}
    problems = {peer: reason for peer in wanted if (reason := peers.missing(peer))}
    lines = {peer: _command(peer, folder) for peer in wanted if peer not in problems}
    for _ in range(runs + 1):
        for peer in [one for one in wanted if one not in problems]:
            output = folder / f"{peer}.exr"
            output.unlink(missing_ok=True)
            code, seconds, peak = _run(lines[peer], peers.environment(peer), folder)
            seen[peer].append((seconds, peak))
            if code != 0 or not output.exists():
                problems[peer] = f"exit code {code}, image written: {output.exists()}"
    return [_row(peer, seen[peer][1:], problems.get(peer)) for peer in wanted]


def _command(peer: str, folder: Path) -> list[str]:
    """The renderer's own command line, or for a renderer without one its driver. Each writes ``folder/PEER.exr``."""
    output = str(folder / f"{peer}.exr")
    if peer == "accuray":
        arguments = ["render", str(folder / "scene.toml"), "-o", output, "--spp", "1", "-t", str(settings.THREADS)]
        return [str(Path(sys.executable).parent / "accuray"), *arguments, "-q"]
    if peer == "mitsuba":  # without -t: with it the program of 3.9.1 may not end
        inside = peers.python_of(peer).parent.parent / "lib" / f"python{settings.PEER_PYTHON}" / "site-packages"
        program = inside / "mitsuba" / "mitsuba"
        return [str(program), "-m", settings.STARTUP_VARIANT, "-o", output, str(folder / "mitsuba.xml")]
    task = {"kind": "write", "spp": 1, "seed": settings.MEASURED_SEED, "images": output.removesuffix(".exr")}
    job = {"scene": str(folder), "variant": "", "sampler": "", "threads": settings.THREADS, "warm_up": False}
    return peers.command(peer, job | {"passes": [task]}, folder)


def _run(line: list[str], variables: dict[str, str], folder: Path) -> tuple[int, float, float]:
    """Exit code, wall seconds and peak megabytes of one process."""
    with (folder / "log.txt").open("w") as log:
        started = time.perf_counter()
        process = subprocess.Popen(line, env=variables, stdout=log, stderr=log)
        status, usage = _wait(process.pid, started + GIVE_UP_S)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, time.perf_counter() - started, usage.ru_maxrss * 1024 / 1e6


def _wait(pid: int, deadline: float) -> Any:
    """Status and resource usage of a child once it has ended; kills it at the deadline."""
    while time.perf_counter() < deadline:
        ended, status, usage = os.wait4(pid, os.WNOHANG)
        if ended:
            return status, usage
        time.sleep(0.001)
    os.kill(pid, 9)
    return os.wait4(pid, 0)[1:]


def _row(peer: str, observed: list[tuple[float, float]], problem: str | None) -> dict[str, Any]:
    if problem:
        return {"renderer": peer, "error": problem}
    seconds, peaks = [run[0] for run in observed], [run[1] for run in observed]
    return {"renderer": peer, "seconds": median(seconds), "fastest": min(seconds), "peak_mb": max(peaks)}


def main() -> int:
    """Measure and print; the first line is JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=settings.STARTUP_RUNS)
    parser.add_argument("--peers", default="accuray,mitsuba,cycles")
    parser.add_argument("--work", type=Path, default=Path("out/bench"))
    arguments = parser.parse_args()
    found = measure(arguments.work, tuple(arguments.peers.split(",")), arguments.runs)
    print(json.dumps(found))
    print(report.table(found, COLUMNS))
    return 0


if __name__ == "__main__":
    sys.exit(main())
