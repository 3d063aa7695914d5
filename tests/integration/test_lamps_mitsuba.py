"""Spot lights and parallel light against Mitsuba 3, an independent renderer, pixel by pixel in linear XYZ.

Both are compared as ratios to a point light at the same place, so sensors and amounts of light do not matter.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks import peers

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.film.estimates import pixel_estimates

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("mitsuba_lamps.py")
SIZE, SPP = 24, 4096
INSIDE = slice(6, 18)
"""Rows and columns of pixels that show nothing but the square."""
SIGMAS, FLOOR = 5.0, 2e-3

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]

Images = tuple[NDArray[np.float64], NDArray[np.float64]]

PLACE: dict[str, Any] = {"position": [0.4, 0.3, 1.5], "intensity": 10}
SPOT = {"type": "spot", **PLACE, "target": [0.1, -0.2, 0], "falloff": "linear"}
SQUARE = {"type": "rectangle", "material": "m", "corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
LAMPS: dict[str, dict[str, Any]] = {
    "point": {"type": "point", **PLACE},
    "narrow": {**SPOT, "outer_angle": 20, "inner_angle": 5},
    "wide": {**SPOT, "outer_angle": 60, "inner_angle": 30},
    "directional": {"type": "directional", "direction": [0.2, 0.5, -1], "irradiance": 10},
}


@pytest.fixture(scope="module")
def theirs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Images]:
    """Means and standard errors of Mitsuba's images."""
    out = tmp_path_factory.mktemp("mitsuba") / "out.npz"
    command = [str(peers.python_of("mitsuba")), str(SCRIPT), str(out)]
    subprocess.run(command, check=True, env=peers.environment("mitsuba"), timeout=600)
    with np.load(out) as found:
        stacks = {name: found[name].astype(np.float64)[:, INSIDE, INSIDE] for name in found}
    return {name: (s.mean(axis=0), s.std(axis=0, ddof=1) / np.sqrt(len(s))) for name, s in stacks.items()}


def ours(light: dict[str, Any]) -> Images:
    scene = accuray.Scene.from_dict(
        {
            "film": {"width": SIZE, "height": SIZE, "filter": {"type": "box"}},
            "camera": {"type": "perspective", "position": [0.5, -1, 3.5], "look_at": [0, 0, 0], "fov": 30},
            "integrator": {"type": "direct"},
            "lights": {"light": light},
            "materials": {"m": {"type": "diffuse", "reflectance": 1}},
            "shapes": {"square": SQUARE},
        }
    )
    mean, error = pixel_estimates(accuray.render(scene, spp=SPP, seed=SEED).film)
    return mean[INSIDE, INSIDE], error[INSIDE, INSIDE]


@pytest.mark.parametrize("name", ["narrow", "wide", "directional"])
def test_a_lamp_agrees_with_mitsuba(name: str, theirs: dict[str, Images]) -> None:
    (mean, error), white = ours(LAMPS[name]), ours(LAMPS["point"])[0].mean(axis=(0, 1))
    (other, noise), their_white = theirs[name], theirs["point"][0].mean(axis=(0, 1))
    assert (other > 0.0).mean() > 0.3, "the lamp lights the square"
    difference = np.abs(mean / white - other / their_white)
    allowed = SIGMAS * np.hypot(error / white, noise / their_white) + FLOOR * np.maximum(other / their_white, 0.1)
    print(f"{name}: largest difference over what is allowed {(difference / allowed).max():.2f}")
    assert (difference <= allowed).all()
