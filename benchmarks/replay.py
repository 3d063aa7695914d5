"""How long AccuRay renders beside bare Embree loops over the very same rays.

``replay/`` holds the program: it records the rays of a render, and times the render and the loops in turn. Beyond
100 000 triangles a render should take at most 1.6 times as long as the fastest loop. ``python -m benchmarks.replay``
prints JSON and tables.
"""

import json
import os
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

from benchmarks import report, scenes, settings

REPOSITORY = Path(__file__).parents[1]
RATIO_LIMIT = 1.6
SCENES = ("cornell", "million", "glossy", "frosted")
LARGE = ("million", "glossy", "frosted")
"""Scenes of more than 100 000 triangles, which the limit holds for."""
ALIGNMENT = 16
COLUMNS = {
    "name": "loop",
    "rays_per_s": "Mrays/s|.2f",
    "seconds": "s|.3f",
    "cpu_s": "CPU s|.3f",
    "ratio": "render / loop|.2f",
    "cpu_ratio": "the same in CPU s|.2f",
    "counts": "counts",
}


def measure(work: Path, repeats: int = settings.REPEATS, spp: int = settings.REPLAY_SPP) -> list[dict[str, Any]]:
    """One row per scene: its rays, the render, every loop and the render's ratio to the fastest loop that counts."""
    try:
        program = build(work / "replay-build")
        return [_replay(program, work, scene, repeats, spp) for scene in SCENES]
    except subprocess.CalledProcessError as problem:
        return [{"renderer": "accuray", "error": "\n".join((problem.stderr or problem.stdout).splitlines()[-5:])}]


def build(folder: Path) -> Path:
    """The program, built in ``folder`` from the sources as they are. Raises subprocess.CalledProcessError."""
    folder.mkdir(parents=True, exist_ok=True)
    tools = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}
    for line in (
        ["cmake", "-S", str(REPOSITORY), "-B", str(folder), "-G", "Ninja", "-DACCURAY_BENCH=ON"],
        ["cmake", "--build", str(folder), "--target", "accuray_replay", "--parallel", str(settings.THREADS)],
    ):
        subprocess.run(line, env=tools, check=True, capture_output=True, text=True)
    return folder / "accuray_replay"


def write_block(scene: Any, file: Path) -> None:
    """Lower a scene and write the bytes as ``replay/block_file.h`` describes."""
    from accuray.devices.lowering import lower

    block, _ = lower(scene)
    sections = [block.section(i) for i in range(block.sections)]
    header = struct.pack(f"={1 + len(sections)}Q", len(sections), *map(len, sections))
    with file.open("wb") as stream:
        stream.write(header + bytes(-len(header) % ALIGNMENT))
        for section in sections:
            stream.write(section)
            stream.write(bytes(-len(section) % ALIGNMENT + ALIGNMENT))


def _replay(program: Path, work: Path, name: str, repeats: int, spp: int) -> dict[str, Any]:
    import accuray

    size = settings.REPLAY_SIZE
    folder = scenes.write(scenes.build(name), work / f"{name}-replay", size)
    scene, file = accuray.load(folder / "scene.toml"), folder / "scene.block"
    write_block(scene, file)
    numbers = (size, size, spp, settings.MEASURED_SEED, scene.render["replicates"], settings.THREADS, repeats)
    line = [str(program), str(file), *map(str, numbers)]
    answer: dict[str, Any] = json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout)
    return {"renderer": "accuray", "scene": name, **compared(answer)}


def compared(answer: dict[str, Any]) -> dict[str, Any]:
    """The program's answer with each loop's rate and ratio, and the ratio to the fastest loop that counts."""
    rays, render = answer["closest"] + answer["shadow"], answer["render"]
    loops = [
        loop
        | {
            "rays_per_s": rays / loop["seconds"] / 1e6,
            "ratio": render["seconds"] / loop["seconds"],
            "cpu_ratio": render["cpu_s"] / loop["cpu_s"],
        }
        for loop in answer["loops"]
    ]
    fastest = min((loop for loop in loops if loop["counts"]), key=lambda loop: float(loop["seconds"]))
    return answer | {
        "loops": loops,
        "rays": rays,
        "fastest": fastest["name"],
        **{key: fastest[key] for key in ("ratio", "cpu_ratio")},
    }


def text(found: list[dict[str, Any]]) -> str:
    """A table of loops for every scene, and the limit for those with many triangles."""
    parts, limits = [], []
    for row in found:
        if "error" in row:
            parts.append(row["error"])
            continue
        parts.append(
            f"{row['scene']}: {row['rays'] / row['samples']:.2f} rays per sample, {row['rays']} rays, rendered in "
            f"{row['render']['seconds']:.3f} s ({row['render']['cpu_s']:.3f} CPU s)"
        )
        parts.append(report.table(row["loops"], COLUMNS))
        if row["scene"] in LARGE:
            limits.append((f"render over the fastest bare loop, {row['scene']}", row["ratio"], RATIO_LIMIT, True))
    if limits:
        parts.append(report.table(report.limits(limits), report.LIMIT_COLUMNS))
    return "\n\n".join(parts)


def main() -> int:
    """Measure and print; the first line is JSON."""
    found = measure(Path("out/bench"))
    print(json.dumps(found))
    print(text(found))
    return 1 if any("error" in row for row in found) else 0


if __name__ == "__main__":
    sys.exit(main())
