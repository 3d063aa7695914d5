"""``python -m benchmarks``: everything in one run; JSON in ``out/bench.json``, Markdown tables on stdout."""

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks import lights, memory, peers, replay, report, settings, speed, startup, threads

BENCHMARKS = (
    "cornell",
    "million",
    "efficiency",
    "glossy",
    "frosted",
    "environment",
    "interior",
    "lamps",
    "instanced",
    "lights",
    "replay",
    "startup",
    "memory",
    "threads",
)
QUICK = {"repeats": 2, "spp": 4, "reference_factor": 16, "runs": 3}
"""``--quick`` shows that everything runs; its figures are not comparable."""


def main() -> int:
    """Run the chosen benchmarks; 0 when each renderer that is installed answered."""
    arguments = _arguments()
    options = speed.Options(
        work=arguments.out.parent / "bench",
        wanted=arguments.peers,
        repeats=arguments.repeats,
        size=arguments.size,
        spp=arguments.spp,
        reference_factor=arguments.reference_factor,
    )
    result: dict[str, Any] = {"machine": machine(), "arguments": {k: str(v) for k, v in vars(arguments).items()}}
    for name in arguments.only:
        print(f"\n## {name}\n", flush=True)
        result[name] = RUN[name](options, arguments)
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(json.dumps(result, indent=1))
    if compared := report.ratios(result):
        print("\n## ratios\n\n" + report.table(compared, report.RATIO_COLUMNS))
        result["ratios"] = compared
    result["machine"]["load_at_end"] = os.getloadavg()
    arguments.out.write_text(json.dumps(result, indent=1))
    print(f"\n{arguments.out}")
    return 1 if _failures(result) else 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--only", type=_list_of(BENCHMARKS), default=BENCHMARKS, help=", ".join(BENCHMARKS))
    parser.add_argument("--peers", type=_list_of(peers.PEERS), default=peers.PEERS, help=", ".join(peers.PEERS))
    parser.add_argument("--repeats", type=int, default=settings.REPEATS)
    parser.add_argument("--size", type=int, help="width and height of the timed images")
    parser.add_argument("--spp", type=int, help="samples per pixel of the timed images")
    parser.add_argument("--reference-factor", type=float, default=settings.REFERENCE_FACTOR)
    parser.add_argument("--runs", type=int, default=settings.STARTUP_RUNS, help="processes per renderer in startup")
    parser.add_argument("--quick", action="store_true", help=str(QUICK))
    parser.add_argument("--out", type=Path, default=Path("out/bench.json"))
    arguments = parser.parse_args()
    if arguments.quick:
        vars(arguments).update(QUICK)
    return arguments


def _list_of(allowed: tuple[str, ...]) -> Callable[[str], tuple[str, ...]]:
    def parse(text: str) -> tuple[str, ...]:
        names = tuple(text.split(","))
        for name in names:
            if name not in allowed:
                raise argparse.ArgumentTypeError(f"unknown {name!r}: allowed {', '.join(allowed)}")
        return names

    return parse


def machine() -> dict[str, Any]:
    """What the figures were measured on, and how busy it was."""
    cpu = Path("/proc/cpuinfo")
    lines = cpu.read_text().splitlines() if cpu.exists() else []
    model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown")
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "threads_used": settings.THREADS,
        "system": platform.platform(),
        "python": platform.python_version(),
        "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        "load_at_start": os.getloadavg(),
    }


def _speed(scene: str) -> Callable[[speed.Options, argparse.Namespace], Any]:
    def run(options: speed.Options, _arguments: argparse.Namespace) -> Any:
        rows = speed.measure_speed(scene, options)
        print(report.table(rows, speed.SPEED_COLUMNS))
        return rows

    return run


def _efficiency(
    scene: str, contenders: tuple[settings.Contender, ...], size: int
) -> Callable[[speed.Options, argparse.Namespace], Any]:
    def run(options: speed.Options, _arguments: argparse.Namespace) -> Any:
        rows = speed.measure_efficiency(scene, contenders, options, size)
        print(report.table(rows, speed.EFFICIENCY_COLUMNS))
        return rows

    return run


def _startup(options: speed.Options, arguments: argparse.Namespace) -> Any:
    """In a process of its own: see ``benchmarks.startup``."""
    line = [sys.executable, "-m", "benchmarks.startup", "--work", str(options.work)]
    line += ["--runs", str(arguments.runs), "--peers", ",".join(options.wanted)]
    rows = json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout.splitlines()[0])
    print(report.table(rows, startup.COLUMNS))
    if ours := [row for row in rows if row["renderer"] == "accuray" and "error" not in row]:
        figures = [
            ("seconds of a 1 spp process", ours[0]["seconds"], startup.TIME_LIMIT_S, True),
            ("its peak in MB", ours[0]["peak_mb"], float(startup.MEMORY_LIMIT_MB), True),
        ]
        print("\n" + report.table(report.limits(figures), report.LIMIT_COLUMNS))
    return rows


def _memory(options: speed.Options, _arguments: argparse.Namespace) -> Any:
    if "accuray" not in options.wanted:
        return []
    found = memory.measure(options.work)
    print(found["error"] if "error" in found else report.table(memory.rows(found), report.LIMIT_COLUMNS))
    return [found]


def _threads(options: speed.Options, _arguments: argparse.Namespace) -> Any:
    rounds = min(settings.THREAD_ROUNDS, options.repeats)
    rows = threads.measure(options.work, "accuray", rounds, options.spp) if "accuray" in options.wanted else []
    print(report.table(rows, threads.COLUMNS))
    return rows


def _lights(options: speed.Options, _arguments: argparse.Namespace) -> Any:
    if "accuray" not in options.wanted:
        return []
    rows = lights.measure(options.repeats, options.spp or settings.EFFICIENCY_SPP)
    print(report.table(rows, lights.COLUMNS))
    print("\n" + report.table(report.limits(lights.figures(rows)), report.LIMIT_COLUMNS))
    return rows


def _replay(options: speed.Options, _arguments: argparse.Namespace) -> Any:
    if "accuray" not in options.wanted:
        return []
    found = replay.measure(options.work, options.repeats, options.spp or settings.REPLAY_SPP)
    print(replay.text(found))
    return found


def _failures(result: dict[str, Any]) -> bool:
    """Whether a renderer failed; one that is not installed is reported in its row but is no failure."""
    rows = [row for name in BENCHMARKS for row in result.get(name, [])]
    return any("error" in row and not row["error"].startswith(("not installed", "needs")) for row in rows)


RUN: dict[str, Callable[[speed.Options, argparse.Namespace], Any]] = {
    "cornell": _speed("cornell"),
    "million": _speed("million"),
    "efficiency": _efficiency("cornell", settings.EFFICIENCY_CONTENDERS, settings.EFFICIENCY_SIZE),
    "glossy": _efficiency("glossy", settings.MATERIALS_CONTENDERS, settings.MATERIALS_SIZE),
    "frosted": _efficiency("frosted", settings.MATERIALS_CONTENDERS, settings.MATERIALS_SIZE),
    **{
        name: _efficiency(name, settings.MATERIALS_CONTENDERS, settings.WORLDS_SIZE)
        for name in ("environment", "interior", "lamps")
    },
    "instanced": _efficiency("instanced", settings.INSTANCES_CONTENDERS, settings.WORLDS_SIZE),
    "replay": _replay,
    "startup": _startup,
    "memory": _memory,
    "threads": _threads,
    "lights": _lights,
}
