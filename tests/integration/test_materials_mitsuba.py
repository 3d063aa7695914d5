"""Materials against Mitsuba 3, an independent renderer, where both have the same model: z-tests pixel by pixel.

A square between two black lamps (the backs of Mitsuba's surfaces are black), all of it grey, so that neither sensors
nor tables of spectra matter. Mitsuba's facets mask and shadow each other independently, which conductors can do as
well. Dielectrics know of the common height only; seen and lit from within 60 degrees, as here, the two differ by less
than the noise.
"""

from __future__ import annotations

import json
import math
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
from accuray.testing import image_z_test

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("mitsuba_materials.py")
SIZE, SPP, REPLICATES = 24, 4096, 16
ALPHA = 1e-3
PLAIN = {"compensate": False}
SILVER = {"eta": 0.2, "k": 3.9}

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]


def grey(value: float) -> dict[str, Any]:
    """A constant of Mitsuba's."""
    return {"type": "uniform", "value": value}


def metal(roughness: float, anisotropy: float = 0.0) -> dict[str, Any]:
    """Mitsuba's rough metal with the alphas of ours: the mean square slope stays when they are stretched."""
    ratio = 1.0 - anisotropy
    alpha_u = roughness**2 * math.sqrt(2.0 / (1.0 + ratio**2))
    alpha_v = ratio * alpha_u
    constants = {name: grey(value) for name, value in SILVER.items()}
    return {"type": "roughconductor", "distribution": "ggx", "alpha_u": alpha_u, "alpha_v": alpha_v, **constants}


def ours_metal(roughness: float, anisotropy: float = 0.0) -> dict[str, Any]:
    """The same of ours."""
    facets = {"roughness": roughness, "anisotropy": anisotropy, "masking": "separable", **PLAIN}
    return {"type": "conductor", **SILVER, **facets}


OUTSIDE = {"int_ior": 1.5, "ext_ior": 1.0}
CASES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "diffuse": ({"type": "diffuse", "reflectance": 0.6}, {"type": "diffuse", "reflectance": grey(0.6)}),
    "mirror": (
        {"type": "conductor", **SILVER},
        {"type": "conductor", **{name: grey(value) for name, value in SILVER.items()}},
    ),
    "satin": (ours_metal(0.5), metal(0.5)),
    "rough": (ours_metal(0.8), metal(0.8)),
    "brushed": (ours_metal(0.7, 0.6), metal(0.7, 0.6)),
    "glass": ({"type": "dielectric", "ior": 1.5}, {"type": "dielectric", **OUTSIDE}),
    "pane": ({"type": "thin_dielectric", "ior": 1.5}, {"type": "thindielectric", **OUTSIDE}),
    "frosted": (
        {"type": "dielectric", "ior": 1.5, "roughness": 0.4, **PLAIN},
        {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.16, **OUTSIDE},
    ),
}


@pytest.fixture(scope="module")
def theirs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, NDArray[np.float64]]:
    folder = tmp_path_factory.mktemp("mitsuba")
    cases, out = folder / "cases.json", folder / "out.npz"
    cases.write_text(json.dumps({name: bsdf for name, (_, bsdf) in CASES.items()}), encoding="utf-8")
    command = [str(peers.python_of("mitsuba")), str(SCRIPT), str(cases), str(out)]
    subprocess.run(command, check=True, env=peers.environment("mitsuba"), timeout=1800)
    with np.load(out) as found:
        return {name: found[name].astype(np.float64) for name in found}


def lamp(height: float) -> dict[str, Any]:
    """As in the script: the front is the side of edge_u x edge_v."""
    width = 1 if height < 0 else -1
    corner = [(0.2 if height > 0 else -0.6) - width / 2, 0.4, height]
    return {"type": "rectangle", "material": "lamp", "corner": corner, "edge_u": [width, 0, 0], "edge_v": [0, 1, 0]}


def ours(material: dict[str, Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Luminance and its standard error."""
    square = {"type": "rectangle", "material": "m", "corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
    scene = accuray.Scene.from_dict(
        {
            "render": {"replicates": REPLICATES},
            "film": {"width": SIZE, "height": SIZE, "filter": {"type": "box"}},
            "camera": {"type": "perspective", "position": [0.5, -1.6, 3.2], "look_at": [0, 0, 0], "fov": 30},
            "materials": {"m": material, "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1}},
            "shapes": {"square": square, "above": lamp(1.5), "below": lamp(-1.5)},
        }
    )
    mean, error = pixel_estimates(accuray.render(scene, spp=SPP, seed=SEED).film)
    return mean[:, :, 1], error[:, :, 1]


@pytest.mark.parametrize("name", CASES)
def test_a_material_agrees_with_mitsuba(name: str, theirs: dict[str, NDArray[np.float64]]) -> None:
    stack = theirs[name]
    mean, error = ours(CASES[name][0])
    other, noise = stack.mean(axis=0), stack.std(axis=0, ddof=1) / np.sqrt(len(stack))
    result = image_z_test(mean, error, other, noise, alpha=ALPHA, dof=REPLICATES - 1, floor=1e-5)
    total = mean.sum() / other.sum() - 1.0
    print(f"{name}: whole image {total:+.3%}, worst z {result.worst:.2f}, overall z {result.overall:.2f}")
    assert result, result.reason
    assert noise.sum() / other.sum() < 0.05, "no power"
