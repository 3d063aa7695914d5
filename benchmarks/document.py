"""Writes the results of a run into ``docs/benchmarks.md``, between its two marks.

``python -m benchmarks.document [out/bench.json]``
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks import lights, memory, replay, report, settings, speed, startup, threads

Result = Mapping[str, Any]
PAGE = Path(__file__).parents[1] / "docs" / "benchmarks.md"
BEGIN, END = "<!-- results: begin -->", "<!-- results: end -->"
BUSY_SHARE = 0.25
"""Load at the start, per processor, beyond which a run's figures are called rough."""

GOAL_COLUMNS = {"what": "goal", "measured": "measured|.3g", "wanted": "wanted", "met": "met"}


def goals(result: Result) -> list[dict[str, Any]]:
    """Every goal whose figures are there: what, measured, wanted (with its direction) and whether it is met."""
    found = [
        {
            "what": f"ratio to the {row['what']}",
            "measured": row["ratio"],
            "wanted": f"at least {row['wanted']:g}",
            "met": row["met"],
        }
        for row in report.ratios(result)
    ]
    figures = list(_figures(result))
    for (_, _, limit, upper), row in zip(figures, report.limits(figures), strict=True):
        found.append(row | {"wanted": f"at {'most' if upper else 'least'} {limit:g}"})
    return [row | {"met": "yes" if row["met"] else "no"} for row in found]


def _figures(result: Result) -> Iterator[tuple[str, float, float, bool]]:
    """What is held to a plain limit: (what, measured, limit, whether the limit is an upper one)."""
    for row in _good(result, "replay"):
        if row["scene"] in replay.LARGE:
            yield f"render / fastest bare Embree loop, {row['scene']}", row["ratio"], replay.RATIO_LIMIT, True
    for row in _good(result, "startup"):
        if row["renderer"] == "accuray":
            yield "whole process at 1 spp, s", row["seconds"], startup.TIME_LIMIT_S, True
            yield "whole process at 1 spp, peak MB", row["peak_mb"], startup.MEMORY_LIMIT_MB, True
    for row in _good(result, "memory"):
        yield "bytes per triangle, resident", row["resident"], memory.RESIDENT_LIMIT, True
        yield "bytes per triangle, peak", row["peak"], memory.PEAK_LIMIT, True
    yield from lights.figures(_good(result, "lights"))
    for row in _good(result, "threads"):
        yield f"two threads over one, {row['scene']}", row["speed_up"], threads.SPEED_UP_WANTED, False


def _good(result: Result, name: str) -> list[dict[str, Any]]:
    return [row for row in result.get(name, ()) if "error" not in row]


def results(result: Result) -> str:
    """The Markdown between the marks."""
    parts = [_circumstances(result), "### Goals", report.table(goals(result), GOAL_COLUMNS)]
    for name, (title, columns) in TABLES.items():
        if rows := result.get(name):
            parts += [f"### {title}", report.table(rows, _filled(rows, columns))]
    for row in _good(result, "replay"):
        title = f"### Beside bare Embree loops: {row['scene']}"
        per_sample, seconds = row["rays"] / row["samples"], row["render"]["seconds"]
        rays = f"{per_sample:.2f} rays per sample; AccuRay renders in {seconds:.3f} s."
        parts += [title, rays, report.table(row["loops"], replay.COLUMNS)]
    return "\n\n".join(parts)


def _filled(rows: Sequence[Mapping[str, Any]], columns: Mapping[str, str]) -> dict[str, str]:
    """The columns that some row has a value for."""
    return {key: heading for key, heading in columns.items() if any(row.get(key) is not None for row in rows)}


def _circumstances(result: Result) -> str:
    machine = result["machine"]
    busy = machine["load_at_start"][0] > BUSY_SHARE * machine["cores"]
    versions = {
        f"{row['renderer'].partition(':')[0]} {row['answer']['version'].split()[0]}": None
        for name in ("cornell", "million", "efficiency", *(scene for scene, _, _ in report.EQUAL_ERROR))
        for row in result.get(name, ())
        if "answer" in row
    }
    lines = [
        f"Measured on {machine['date'][:10]}: {machine['processor']}, {machine['cores']} processors, "
        f"{machine['threads_used']} threads, {machine['system']}, Python {machine['python']}.",
        f"Versions: {', '.join(versions) or 'unknown'}.",
    ]
    if busy:
        lines.append(
            f"**The machine was busy (load {machine['load_at_start'][0]:.1f}): these figures are rough, and those per "
            "CPU second the better ones.**"
        )
    return "\n".join(lines)


def update(page: str, block: str) -> str:
    """The page with everything between its marks replaced. Raises ValueError if it has no marks."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the page lacks {BEGIN} or {END}")
    return f"{before}{BEGIN}\n\n{block}\n\n{END}{after}"


TABLES: dict[str, tuple[str, dict[str, str]]] = {
    "cornell": (f"Cornell box, {settings.SIZE} x {settings.SIZE}", dict(speed.SPEED_COLUMNS)),
    "million": (f"The box with a million triangles, {settings.SIZE} x {settings.SIZE}", dict(speed.SPEED_COLUMNS)),
    "efficiency": ("Time to equal error: Cornell box", dict(speed.EFFICIENCY_COLUMNS)),
    "glossy": ("Time to equal error: rough metal over a textured floor", dict(speed.EFFICIENCY_COLUMNS)),
    "frosted": ("Time to equal error: rough glass", dict(speed.EFFICIENCY_COLUMNS)),
    "environment": ("Time to equal error: environment map", dict(speed.EFFICIENCY_COLUMNS)),
    "interior": ("Time to equal error: a room behind a window", dict(speed.EFFICIENCY_COLUMNS)),
    "lamps": ("Time to equal error: 10 000 lamps", dict(speed.EFFICIENCY_COLUMNS)),
    "instanced": ("Time to equal error: 4000 instances", dict(speed.EFFICIENCY_COLUMNS)),
    "startup": ("Whole process at 1 sample per pixel", dict(startup.COLUMNS)),
    "threads": ("Threads", dict(threads.COLUMNS)),
    "lights": ("Many lamps", dict(lights.COLUMNS)),
}


def main() -> int:
    """Write the page's results from the JSON file of a run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.document", description=main.__doc__)
    parser.add_argument("file", type=Path, nargs="?", default=Path("out/bench.json"), help="default: out/bench.json")
    result = json.loads(parser.parse_args().file.read_text())
    PAGE.write_text(update(PAGE.read_text(encoding="utf-8"), results(result)), encoding="utf-8")
    print(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
