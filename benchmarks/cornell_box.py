"""The measured Cornell box beside Mitsuba 3, an independent renderer: ``python -m benchmarks.cornell_box``.

Both read the very same bytes of geometry and tables of spectra, which ``benchmarks.scenes`` writes, and both render
spectrally. The pictures are compared by the measure of the original report, in display values; small images of very
many samples block by block, in linear XYZ.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray.film.colour import RGB_TO_XYZ, exposure_scale, srgb8, xyz_to_balanced_rgb
from accuray.film.estimates import pixel_estimates
from accuray.film.png import encode_codes
from accuray.scene.spectrum import xyz
from benchmarks import peers, scenes
from benchmarks.settings import Contender

MITSUBA = Contender("mitsuba", "llvm_ad_spectral", "multijitter")
BLOCK = 8
EXPOSURE = 1.5
"""Of the pictures, in EV: that of scenes/cornell-box.toml."""
PICTURE_SIZE, PICTURE_SPP, PICTURE_IMAGES = 160, 1536, 4
BLOCK_SIZE, BLOCK_SPP = 48, 49152
"""Samples that bring the darkest blocks, in the shadow of the tall block, below 0.3 % in both renderers."""
BLOCK_IMAGES, MITSUBA_SPP = 64, 1024
QUICK = 8

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Blocks:
    """Means of 8 x 8 pixels in XYZ (H, W, 3), and their standard errors."""

    mean: Floats
    error: Floats


def block_means(pixels: Floats) -> Floats:
    """Means of blocks, (..., H, W, 3) to (..., H / 8, W / 8, 3)."""
    *others, height, width, channels = pixels.shape
    return pixels.reshape(*others, height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels).mean(axis=(-4, -2))


def write_scene(folder: Path, size: int) -> Path:
    """The box with its two blocks as both renderers read it."""
    return scenes.write(scenes.build("cornell"), folder, size)


def by_mitsuba(folder: Path, spp: int, images: int, seed: int = 0) -> Floats:
    """Linear Rec.709 images (N, H, W, 3) of different seeds.

    Raises:
        RuntimeError: with what Mitsuba said.
    """
    first = 1 + seed * images
    task = {"kind": "time", "spp": spp, "seed": first, "repeats": images, "keep": images}
    job: dict[str, Any] = {"scene": str(folder), "threads": len(os.sched_getaffinity(0)), "warm_up": False}
    answer = peers.run_job(MITSUBA, job | {"passes": [task | {"images": str(folder / "mitsuba")}]}, folder)
    if "error" in answer:
        raise RuntimeError(answer["error"])
    return np.stack([np.load(folder / f"mitsuba-{k}.npy") for k in range(images)]).astype(np.float64)


def mitsuba_blocks(folder: Path, seed: int = 0, fraction: int = 1) -> Blocks:
    """XYZ of the blocks of small images, and standard errors from images of different seeds.

    ``fraction`` divides the samples.
    """
    images = by_mitsuba(folder, MITSUBA_SPP // fraction, BLOCK_IMAGES, seed)
    blocks = block_means(images @ np.array(RGB_TO_XYZ).T)
    return Blocks(blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / np.sqrt(len(blocks)))


def accuray_blocks(folder: Path, seed: int = 0, fraction: int = 1) -> Blocks:
    """The same by AccuRay; errors from its replicates."""
    film = accuray.render(accuray.load(folder / "scene.toml"), spp=BLOCK_SPP // fraction, seed=seed).film
    mean, error = pixel_estimates(film)
    return Blocks(block_means(mean), np.sqrt(block_means(error**2)) / BLOCK)


def compare_pictures(folder: Path, out: Path) -> dict[str, Any]:
    """Renders both pictures, writes them and the difference as PNG files to ``out``, and returns the figures."""
    write_scene(folder, PICTURE_SIZE)
    light = accuray.load(Path(__file__).parents[1] / "scenes" / "cornell-box.toml").film["white_balance"]
    to_white = np.array(xyz_to_balanced_rgb(xyz(light)))
    film = accuray.render(accuray.load(folder / "scene.toml"), spp=PICTURE_SPP).film
    ours = film.mean(slice(0, 3)) @ to_white.T
    theirs = by_mitsuba(folder, PICTURE_SPP // PICTURE_IMAGES, PICTURE_IMAGES).mean(axis=0)
    theirs = theirs @ np.array(RGB_TO_XYZ).T @ to_white.T
    found = accuray.compare(ours, theirs, exposure=EXPOSURE)
    for name, pixels in (("accuray", ours), ("mitsuba", theirs)):
        (out / f"cornell-box-{name}.png").write_bytes(encode_codes(srgb8(pixels * exposure_scale(EXPOSURE))))
    limit = found.save_heat_map(out / "cornell-box-difference.png")
    keys = ("accuracy", "difference", "largest", "relative_mse", "flip")
    return {key: found.to_dict()[key] for key in keys} | {"heat_map_white": limit}


def compare_blocks(folder: Path, fraction: int) -> dict[str, Any]:
    """The largest relative difference of a block, the noise there, and the difference of the whole image."""
    write_scene(folder, BLOCK_SIZE)
    theirs, ours = mitsuba_blocks(folder, 0, fraction), accuray_blocks(folder, 0, fraction)
    relative = ours.mean / theirs.mean - 1.0
    noise = np.hypot(ours.error, theirs.error) / theirs.mean
    y, x, channel = np.unravel_index(np.abs(relative).argmax(), relative.shape)
    whole = ours.mean.mean(axis=(0, 1)) / theirs.mean.mean(axis=(0, 1)) - 1.0
    return {
        "blocks": relative.shape[0] * relative.shape[1],
        "worst": float(np.abs(relative).max()),
        "at": [int(x), int(y), "XYZ"[channel]],
        "noise_there": float(noise[y, x, channel]),
        "largest_noise": float(noise.max()),
        "root_mean_square": float(np.sqrt(np.mean(relative**2))),
        "expected_from_noise": float(np.sqrt(np.mean(noise**2))),
        "whole": whole.tolist(),
    }


def main() -> int:
    """Prints the figures as JSON."""
    parser = argparse.ArgumentParser(description="Compares the Cornell box with Mitsuba's.")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the pictures (default: out)")
    parser.add_argument("--only", choices=("picture", "blocks"), help="one of the two comparisons")
    parser.add_argument("--quick", action="store_true", help=f"a {QUICK}th of the samples for the blocks")
    arguments = parser.parse_args()
    if reason := peers.missing("mitsuba"):
        print(f"Mitsuba: {reason}", file=sys.stderr)
        return 1
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        figures: dict[str, Any] = {}
        if arguments.only != "blocks":
            figures["picture"] = compare_pictures(Path(folder), arguments.out)
        if arguments.only != "picture":
            figures["blocks"] = compare_blocks(Path(folder), QUICK if arguments.quick else 1)
    print(json.dumps(figures, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
