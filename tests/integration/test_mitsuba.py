"""The Cornell box against Mitsuba 3, an independent renderer: block by block, in linear XYZ.

Both render the very same bytes of geometry and tables of spectra: see benchmarks/cornell_box.py. Mitsuba lives in a
virtual environment of its own (`python -m benchmarks.setup_peers mitsuba`); without it the test is skipped.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from benchmarks import peers

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from benchmarks import cornell_box

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
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


def test_the_cornell_box_agrees_with_mitsuba(tmp_path: Path) -> None:
    cornell_box.write_scene(tmp_path, cornell_box.BLOCK_SIZE)
    theirs = cornell_box.mitsuba_blocks(tmp_path, SEED)
    ours = cornell_box.accuray_blocks(tmp_path, SEED)
    relative = ours.mean / theirs.mean - 1.0
    noise = np.hypot(ours.error, theirs.error) / theirs.mean
    whole = ours.mean.mean(axis=(0, 1)) / theirs.mean.mean(axis=(0, 1)) - 1.0
    print(f"worst block {np.abs(relative).max():.3%}, noise at most {noise.max():.3%}, whole image {whole}")
    assert noise.max() <= NOISE, f"no power: blocks differ by noise of up to {noise.max():.2%}"
    allowed = np.maximum(TOLERANCE, SIGMAS * noise)
    assert np.argwhere(np.abs(relative) > allowed).tolist() == [], relative
    assert np.abs(whole).max() <= WHOLE


def test_the_picture_is_as_accurate_as_the_report_asks(tmp_path: Path) -> None:
    """The original report reached 97.3 % against a photograph's digital values; two renderers do better."""
    figures = cornell_box.compare_pictures(tmp_path, tmp_path)
    assert figures["accuracy"] >= 99.5
    assert sorted(path.name for path in tmp_path.glob("*.png")) == [
        f"cornell-box-{name}.png" for name in ("accuray", "difference", "mitsuba")
    ]
