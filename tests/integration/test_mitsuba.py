"""The Cornell box against Mitsuba 3, an independent renderer: block by block, in linear XYZ.

Both render the very same bytes of geometry and tables of spectra, which `benchmarks/scenes.py` writes for both. Mitsuba
lives in a virtual environment of its own (`python -m benchmarks.setup_peers mitsuba`); without it the test is skipped.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks import peers, scenes
from benchmarks.settings import Contender

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.film.colour import XYZ_TO_RGB
from accuray.film.estimates import pixel_estimates

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SIZE, BLOCK = 48, 8
MITSUBA = Contender("mitsuba", "llvm_ad_spectral", "multijitter")
IMAGES, MITSUBA_SPP = 64, 1024
SPP = 49152
"""Samples that bring the darkest blocks, in the shadow of the tall block, below `NOISE` in both renderers."""
TOLERANCE = 5e-3
NOISE = 3e-3
"""Largest relative standard error of a block's difference with which the comparison counts."""
SIGMAS = 4.0
WHOLE = 1e-3
"""Largest relative difference of the mean of all blocks."""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scene as all renderers read it."""
    return scenes.write(scenes.build("cornell"), tmp_path_factory.mktemp("cornell"), SIZE)


def block_means(pixels: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means of blocks, (..., H, W, 3) to (..., H / 8, W / 8, 3)."""
    *others, height, width, channels = pixels.shape
    return pixels.reshape(*others, height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels).mean(axis=(-4, -2))


def by_mitsuba(folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """XYZ of the blocks and standard errors, from images of different seeds."""
    first = 1 + SEED * IMAGES
    task = {"kind": "time", "spp": MITSUBA_SPP, "seed": first, "repeats": IMAGES, "keep": IMAGES}
    job = {"scene": str(folder), "threads": len(os.sched_getaffinity(0)), "warm_up": False}
    answer = peers.run_job(MITSUBA, job | {"passes": [task | {"images": str(folder / "mitsuba")}]}, folder)
    assert "error" not in answer, answer["error"]
    rgb = np.stack([np.load(folder / f"mitsuba-{k}.npy") for k in range(IMAGES)]).astype(np.float64)
    blocks = block_means(rgb @ np.linalg.inv(XYZ_TO_RGB).T)
    return blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / np.sqrt(IMAGES)


def by_accuray(folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    film = accuray.render(accuray.load(folder / "scene.toml"), spp=SPP, seed=SEED).film
    mean, error = pixel_estimates(film)
    return block_means(mean), np.sqrt(block_means(error**2)) / BLOCK


def test_the_cornell_box_agrees_with_mitsuba(folder: Path) -> None:
    theirs, their_error = by_mitsuba(folder)
    ours, our_error = by_accuray(folder)
    relative = ours / theirs - 1.0
    noise = np.hypot(our_error, their_error) / theirs
    whole = ours.mean(axis=(0, 1)) / theirs.mean(axis=(0, 1)) - 1.0
    print(f"worst block {np.abs(relative).max():.3%}, noise at most {noise.max():.3%}, whole image {whole}")
    assert noise.max() <= NOISE, f"no power: blocks differ by noise of up to {noise.max():.2%}"
    allowed = np.maximum(TOLERANCE, SIGMAS * noise)
    assert np.argwhere(np.abs(relative) > allowed).tolist() == [], relative
    assert np.abs(whole).max() <= WHOLE
