"""Every integrator, by every strategy, gives on every shipped scene, and on the zoo, what the naive `reference` gives.

Images are compared by the means of 8x8 blocks in X, Y and Z. A comparison counts only if the standard error of every
block's difference is at most 1 % of the block's mean; a scene whose images stay noisier than that at `MOST_SPP` fails
with "no power" until `fair.FAIR` says how it is made fair, or `JUDGES` names what judges it instead.

The quick tier compares path tracing as users get it on a quarter of the scenes, and on an eighth one of the others;
which these are changes with ACCURAY_TEST_SEED. `pytest -m long` compares all.
"""

from __future__ import annotations

import functools
import math
import os
import zlib
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from fair import FAIR, Table, all_scenes, fair_scene

import accuray
from accuray.film.estimates import pixel_estimates
from accuray.scene import schema
from accuray.testing import blocks

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
ALWAYS = ("cornell-box", "zoo")
"""Scenes that every run looks at."""
BLOCK = 8
POWER = 0.01
REFERENCE_ERROR, OTHER_ERROR = 0.0075, 0.0055
"""Relative standard errors of the noisiest block that are aimed at; together below `POWER`."""
PILOT_SPP = 64
MOST_SPP = 65536
SAFETY = 1.2
ALPHA = 1e-4 / 3
"""Chance that a comparison of one channel fails by noise alone."""
DEPTHS = {"direct": 1}
"""Largest number of scattering events of the integrators that do not follow all light."""
JUDGES: dict[tuple[str, str], str] = {}
"""(scene, integrator): what judges it where its fair form has no power yet."""


def candidates() -> dict[str, Table]:
    """Every integrator but the reference, by every strategy it has, as `path/mis`."""
    found: dict[str, Table] = {}
    for name, kind in schema.current().family("integrator").types.items():
        strategies = next((p.choices for p in kind.params if p.name == "strategy"), ())
        if name != "reference":
            found |= {f"{name}/{s}": {"type": name, "strategy": s} for s in strategies} or {name: {"type": name}}
    return found


def images_of_interest() -> list[tuple[str, str]]:
    """What the quick tier compares: (scene, integrator)."""
    others = [name for name in candidates() if name != "path/mis"]
    turns = [(i + SEED, scene) for i, scene in enumerate(all_scenes())]
    pairs = [(scene, "path/mis") for turn, scene in turns if turn % 4 == 0 or scene in ALWAYS]
    return pairs + [(scene, others[turn // 8 % len(others)]) for turn, scene in turns if turn % 8 == 1]


@functools.cache
def xyz(scene: str, which: str, max_depth: int | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """XYZ (H, W, 3) of a scene in its fair form and its standard error.

    A pilot tells how many samples the noisiest block asks for, and is not used otherwise, so that the images that are
    judged never decided their own length.
    """
    integrator: dict[str, Any] = dict(candidates().get(which, {"type": which}))
    if max_depth is not None:
        integrator["max_depth"] = max_depth
    aim = REFERENCE_ERROR if which == "reference" else OTHER_ERROR
    fair = fair_scene(scene, integrator)
    seed = (zlib.crc32(f"{scene} {which} {max_depth}".encode()) + 2 * SEED) % 2**32
    pilot = pixel_estimates(accuray.render(fair, spp=PILOT_SPP, seed=seed).film)
    spp = min(MOST_SPP, math.ceil(SAFETY * PILOT_SPP * (noisiest_block(*pilot) / aim) ** 2))
    whole = 4 * max(4, math.ceil(spp / 4))
    return pixel_estimates(accuray.render(fair, spp=whole, seed=(seed + 1) % 2**32).film)


def noisiest_block(mean: NDArray[np.float64], error: NDArray[np.float64]) -> float:
    """Largest relative standard error of the blocks' means; blocks that are black without noise do not count."""

    def block_sums(values: NDArray[np.float64]) -> NDArray[np.float64]:
        height, width, channels = values.shape
        return values.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels).sum(axis=(1, 3))

    level, noise = block_sums(mean), np.sqrt(block_sums(error**2))
    return float(np.max(np.divide(noise, level, out=np.zeros_like(noise), where=level > 0)))


def compare(scene: str, which: str) -> None:
    depth = DEPTHS.get(which.split("/")[0])
    mean, error = xyz(scene, which, None)
    truth, its_error = xyz(scene, "reference", depth)
    for channel, name in enumerate("XYZ"):
        columns = (values[:, :, channel] for values in (mean, error, truth, its_error))
        result = blocks(*columns, size=BLOCK, alpha=ALPHA, power=POWER, dof=3)
        if result.verdict == "no power" and (scene, which) in JUDGES:
            pytest.skip(f"no power; judged by {JUDGES[scene, which]}")
        assert result, f"{scene}, {which}, {name}: {result.reason}"


def test_the_tables_name_what_there_is() -> None:
    assert set(FAIR) <= set(all_scenes())
    assert {scene for scene, _ in JUDGES} <= set(all_scenes())
    assert {which for _, which in JUDGES} <= set(candidates())
    assert set(DEPTHS) <= {which.split("/")[0] for which in candidates()}


@pytest.mark.parametrize(("scene", "which"), images_of_interest())
def test_agrees_with_reference(scene: str, which: str) -> None:
    compare(scene, which)


@pytest.mark.long
@pytest.mark.parametrize("which", candidates())
@pytest.mark.parametrize("scene", all_scenes())
def test_all_agree_with_reference(scene: str, which: str) -> None:
    compare(scene, which)
