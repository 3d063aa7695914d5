"""Eight scenes by AccuRay and, from the same description, by Cycles: ``python -m benchmarks.survey``.

Prints how far the pictures are apart, by the measures of ``accuray compare``, as a Markdown table, and writes each pair
and its difference as one PNG file.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray.film.colour import srgb8
from accuray.film.heat import heat_map
from accuray.film.png import encode_codes
from benchmarks import peers
from benchmarks.survey_scenes import PAIRS, TEXTURES, description

SPP = 96
HEAT_LIMIT = 0.2
GAP = 4
BLOCK = 8
HEAD = """| scene | accuracy | mean difference R, G, B | relMSE | FLIP | accuracy of 8 x 8 blocks |
|---|---|---|---|---|---|"""

Table = dict[str, Any]


def scene_of(described: Table) -> accuray.Scene:
    """AccuRay's scene, with the pictures that the description names."""
    pictures = {name: {**table, "file": str(TEXTURES / table["file"])} for name, table in described["textures"].items()}
    return accuray.Scene.from_dict({**described, "textures": pictures})


def write_for_cycles(described: Table, folder: Path, spp: int) -> Path:
    """The description with its triangles as arrays beside it, as the driver reads it."""
    scene = scene_of(described)
    for name, shape in described["shapes"].items():
        if shape["type"] not in ("rectangle", "sphere"):
            mesh = accuray.triangles(scene, name)
            np.savez(folder / f"{name}.npz", positions=mesh.positions, faces=mesh.faces, normals=mesh.normals)
    job = {**described, "textures_folder": str(TEXTURES), "folder": str(folder), "spp": spp}
    job["threads"] = len(os.sched_getaffinity(0))
    path = folder / "job.json"
    path.write_text(json.dumps(job), encoding="utf-8")
    return path


def by_cycles(described: Table, spp: int) -> NDArray[np.float32]:
    """Linear Rec.709 pixels (H, W, 3) by Cycles, in its own process.

    Raises:
        RuntimeError: with the last lines of what it said.
    """
    with tempfile.TemporaryDirectory() as folder:
        job = write_for_cycles(described, Path(folder), spp)
        command = [str(peers.python_of("cycles")), str(peers.DRIVERS / "survey_driver.py"), str(job)]
        done = subprocess.run(command, env=peers.environment("cycles"), capture_output=True, text=True, check=False)
        result = Path(folder) / "image.npy"
        if done.returncode != 0 or not result.exists():
            raise RuntimeError("\n".join(done.stderr.splitlines()[-8:]))
        pixels: NDArray[np.float32] = np.load(result)
        return pixels


def side_by_side(ours: NDArray[Any], theirs: NDArray[Any], found: accuray.Comparison) -> bytes:
    """A PNG file: AccuRay's picture, Cycles' picture, their difference in false colours."""
    gap = np.full((ours.shape[0], GAP, 3), 255, dtype=np.uint8)
    parts = [srgb8(ours), gap, srgb8(theirs), gap, heat_map(found.difference_map, HEAT_LIMIT)]
    return encode_codes(np.ascontiguousarray(np.concatenate(parts, axis=1)))


def row(title: str, found: accuray.Comparison, smooth: accuray.Comparison) -> str:
    """A line of the table; the second comparison is that of the blocks."""
    difference = ", ".join(f"{value:.4f}" for value in found.difference)
    figures = f"{difference} | {found.relative_mse:.2g} | {found.flip:.3f} | {smooth.accuracy:.2f} %"
    return f"| {title} | {found.accuracy:.2f} % | {figures} |"


def averaged(pixels: NDArray[np.float32]) -> NDArray[np.float64]:
    """Means of blocks: most of the noise goes, and what differs otherwise stays."""
    height, width, _ = pixels.shape
    shape = (height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3)
    means: NDArray[np.float64] = (
        pixels[: height // BLOCK * BLOCK, : width // BLOCK * BLOCK].reshape(shape).mean(axis=(1, 3), dtype=np.float64)
    )
    return means


def main() -> int:
    """Renders the pairs that are named, or all."""
    parser = argparse.ArgumentParser(description="Renders the survey's scenes by AccuRay and Cycles.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of: {', '.join(PAIRS)}; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the pictures (default: out)")
    parser.add_argument("--spp", type=int, default=SPP, help=f"samples per pixel (default: {SPP})")
    arguments = parser.parse_args()
    names = arguments.names or list(PAIRS)
    if unknown := sorted(set(names) - set(PAIRS)):
        parser.error(f"there is no pair {unknown[0]}")
    if reason := peers.missing("cycles"):
        print(f"Cycles: {reason}", file=sys.stderr)
        return 1
    arguments.out.mkdir(parents=True, exist_ok=True)
    print(HEAD)
    for name in names:
        described = description(name)
        ours = np.asarray(accuray.render(scene_of(described), spp=arguments.spp))
        theirs = by_cycles(described, arguments.spp)
        found = accuray.compare(ours, theirs)
        (arguments.out / f"survey-{name}.png").write_bytes(side_by_side(ours, theirs, found))
        smooth = accuray.compare(averaged(ours), averaged(theirs))
        print(row(PAIRS[name][0], found, smooth), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
