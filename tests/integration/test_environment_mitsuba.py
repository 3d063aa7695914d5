"""An environment map against Mitsuba 3, an independent renderer: a z-test pixel by pixel, background, light and shadow.

Mitsuba puts a map's middle at +Z, so ours is turned by 180 degrees, and its first and last row at the poles, where ours
has the edges of texels: each gets the same smooth function at its own places.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks import peers

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.film.estimates import pixel_estimates
from accuray.testing import image_z_test

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("mitsuba_environment.py")
SIZE, SPP, REPLICATES = 32, 4096, 16
HEIGHT, WIDTH = 512, 1024
ALPHA = 1e-3

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]


def sky(polar: NDArray[np.float64], across: NDArray[np.float64]) -> NDArray[np.float32]:
    """A lamp of 20 degrees to the left of the middle and half up, over a sky of two waves; `across` from 0 to 1."""
    theta, phi = np.meshgrid(polar, 2 * np.pi * across, indexing="ij")
    lamp = np.cos(theta) * np.cos(0.9) + np.sin(theta) * np.sin(0.9) * np.cos(phi - 2 * np.pi * 0.35)
    waves = 0.3 * np.sin(2 * phi + 1) * np.sin(theta) ** 2 + 0.2 * np.cos(theta)
    return np.asarray(0.6 + waves + 20.0 * np.exp(30.0 * (lamp - 1.0)), dtype=np.float32)


COLUMNS = (np.arange(WIDTH) + 0.5) / WIDTH


def test_an_environment_map_agrees_with_mitsuba(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", sky(np.linspace(0.0, np.pi, HEIGHT + 1), COLUMNS))
    command = [str(peers.python_of("mitsuba")), str(SCRIPT), str(tmp_path / "map.npy"), str(tmp_path / "out.npy")]
    subprocess.run(command, check=True, env=peers.environment("mitsuba"), timeout=1800)
    stack = np.load(tmp_path / "out.npy").astype(np.float64)

    pixels = sky((np.arange(HEIGHT) + 0.5) * np.pi / HEIGHT, COLUMNS)
    scene = accuray.Scene.from_dict(
        {
            "render": {"replicates": REPLICATES},
            "film": {"width": SIZE, "height": SIZE, "filter": {"type": "box"}},
            "camera": {"type": "perspective", "position": [0.5, 1, 3.2], "look_at": [0, 0.6, 0], "fov": 50},
            "lights": {"sky": {"type": "environment", "pixels": pixels, "rotation": 180}},
            "materials": {
                "light": {"type": "diffuse", "reflectance": 0.7},
                "dark": {"type": "two_sided", "front": "grey", "back": "black"},
                "grey": {"type": "diffuse", "reflectance": 0.5},
                "black": {"type": "diffuse", "reflectance": 0},
            },
            "shapes": {
                "ball": {"type": "sphere", "material": "light", "center": [0, 0.5, 0], "radius": 0.5},
                "floor": {
                    "type": "rectangle",
                    "material": "dark",
                    "corner": [-2, 0, 2],
                    "edge_u": [4, 0, 0],
                    "edge_v": [0, 0, -4],
                },
            },
        }
    )
    mean, error = (values[:, :, 1] for values in pixel_estimates(accuray.render(scene, spp=SPP, seed=SEED).film))
    other, noise = stack.mean(axis=0), stack.std(axis=0, ddof=1) / np.sqrt(len(stack))
    result = image_z_test(mean, error, other, noise, alpha=ALPHA, dof=REPLICATES - 1, floor=1e-4)
    total = mean.sum() / other.sum() - 1.0
    print(f"whole image {total:+.3%}, worst z {result.worst:.2f}, overall z {result.overall:.2f}")
    assert result, result.reason
    assert noise.sum() / other.sum() < 0.02, "no power"
