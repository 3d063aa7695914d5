"""AccuRay's memory per triangle: a scene of a million triangles less the same scene without them.

``python -m benchmarks.memory`` prints JSON and a table.
"""

import json
import sys
from pathlib import Path
from typing import Any

from benchmarks import peers, report, scenes, settings

RESIDENT_LIMIT = 180
PEAK_LIMIT = 250
"""Bytes per triangle, vertex normals and UVs included."""


def measure(work: Path, peer: str = "accuray") -> dict[str, Any]:
    """Resident bytes while rendering and peak bytes since the process began, per triangle of the sphere."""
    observed = {}
    for name in ("room", "million"):
        folder = scenes.write(scenes.build(name), work / f"{name}-memory", settings.MEMORY_SIZE)
        task = {"kind": "memory", "spp": settings.MEMORY_SPP, "seed": settings.MEASURED_SEED}
        job = {"scene": str(folder), "threads": settings.THREADS, "passes": [task], "warm_up": False}
        contender = next(one for one in settings.SPEED_CONTENDERS if one.peer == peer)
        answer = peers.run_job(contender, job, folder)
        if "error" in answer:
            return {"renderer": peer, "error": answer["error"]}
        observed[name] = answer["passes"][0]
    triangles = 2 * settings.MILLION_SEGMENTS * settings.MILLION_RINGS
    per_triangle = {
        key: (observed["million"][f"{key}_bytes"] - observed["room"][f"{key}_bytes"]) / triangles
        for key in ("resident", "peak")
    }
    return {"renderer": peer, "triangles": triangles, **per_triangle, "observed": observed}


def rows(result: dict[str, Any]) -> list[dict[str, Any]]:
    """The two limits beside what was measured."""
    return report.limits(
        [
            ("bytes per triangle, resident", result["resident"], RESIDENT_LIMIT, True),
            ("bytes per triangle, peak", result["peak"], PEAK_LIMIT, True),
        ]
    )


def main() -> int:
    """Measure AccuRay, or the peer named on the command line."""
    result = measure(Path("out/bench"), sys.argv[1] if len(sys.argv) > 1 else "accuray")
    print(json.dumps(result))
    print(result["error"] if "error" in result else report.table(rows(result), report.LIMIT_COLUMNS))
    return 1 if "error" in result else 0


if __name__ == "__main__":
    sys.exit(main())
