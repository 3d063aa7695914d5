"""How much faster two threads are than one, on the Cornell box and on a million triangles.

``python -m benchmarks.threads`` prints JSON and a table.
"""

import json
import sys
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks import peers, report, scenes, settings

SPEED_UP_WANTED = 1.9
COLUMNS = {
    "renderer": "renderer",
    "scene": "scene",
    "one": "1 thread s|.2f",
    "two": "2 threads s|.2f",
    "speed_up": "speed-up|.2f",
    "cpu_ratio": "CPU s of two / of one|.2f",
    "wanted": "wanted|.2f",
    "error": "error",
}


def measure(
    work: Path, peer: str = "accuray", rounds: int = settings.THREAD_ROUNDS, spp: int | None = None
) -> list[dict[str, Any]]:
    """Median seconds with one thread and with two, taken in turn so that other load meets both alike."""
    contender = next(one for one in settings.SPEED_CONTENDERS if one.peer == peer)
    found = []
    for name in ("cornell", "million"):
        folder = scenes.write(scenes.build(name), work / f"{name}-threads", settings.SIZE)
        task = {"kind": "time", "spp": spp or settings.SPP[peer], "seed": settings.MEASURED_SEED, "repeats": 2}
        seconds: dict[int, list[float]] = {1: [], 2: []}
        cpu: dict[int, list[float]] = {1: [], 2: []}
        row: dict[str, Any] = {"renderer": contender.name, "scene": name, "wanted": SPEED_UP_WANTED}
        for threads in (1, 2) * rounds:
            answer = peers.run_job(contender, {"scene": str(folder), "threads": threads, "passes": [task]}, folder)
            if "error" in answer:
                row["error"] = answer["error"]
                break
            seconds[threads] += answer["passes"][0]["render_s"]
            cpu[threads] += answer["passes"][0]["cpu_s"]
        else:
            row |= {"one": median(seconds[1]), "two": median(seconds[2])}
            row |= {"speed_up": row["one"] / row["two"], "cpu_ratio": median(cpu[2]) / median(cpu[1])}
        found.append(row)
    return found


def main() -> int:
    """Measure AccuRay, or the peer named on the command line."""
    found = measure(Path("out/bench"), sys.argv[1] if len(sys.argv) > 1 else "accuray")
    print(json.dumps(found))
    print(report.table(found, COLUMNS))
    return 1 if any("error" in row for row in found) else 0


if __name__ == "__main__":
    sys.exit(main())
