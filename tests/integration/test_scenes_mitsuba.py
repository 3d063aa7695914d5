"""Instances of a mesh, and a lamp that shows a picture, against Mitsuba 3: z-tests pixel by pixel.

All is grey, so that neither sensors nor tables of spectra matter.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks import furniture, peers, worlds
from benchmarks.geometry import write_ply

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.film.estimates import pixel_estimates
from accuray.testing import image_z_test

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("mitsuba_scenes.py")
SIZE, SPP, REPLICATES = 32, 4096, 16
COPIES = 24
ALPHA = 1e-3

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]

Images = NDArray[np.float64]
FLOOR = {"type": "rectangle", "material": "floor", "corner": [-3, 0, 3], "edge_u": [6, 0, 0], "edge_v": [0, 0, -6]}
LAMP = {
    "type": "rectangle",
    "material": "lamp",
    "corner": [-0.8, 2, -0.8],
    "edge_u": [1.6, 0, 0],
    "edge_v": [0, 0, 1.6],
}
PICTURE = np.array([[8, 0.5, 0, 1], [0, 2, 6, 0], [1, 0, 0, 12]], dtype=np.float32)


def crowd() -> Images:
    """Turned and scaled copies on the floor, (COPIES, 3, 4)."""
    found = worlds.crowd(COPIES)
    found[:, :, 3] *= [0.12, 0.25, 0.08]
    found[:, 2, 3] += 1.5
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The mesh, the transforms, and Mitsuba's images."""
    where: Path = tmp_path_factory.mktemp("scenes")
    knot = furniture.grid_mesh("knot", "m", furniture.surface(furniture.knot(2, 3, 0.5, 0.24, 0.15), 121, 25))
    write_ply(knot, where / "knot.ply")
    np.save(where / "transforms.npy", crowd())
    np.save(where / "picture.npy", PICTURE)
    command = [str(peers.python_of("mitsuba")), str(SCRIPT), str(where), str(where / "out.npz")]
    subprocess.run(command, check=True, env=peers.environment("mitsuba"), timeout=1800)
    return where


def compare(name: str, described: dict[str, Any], folder: Path) -> None:
    stack = np.load(folder / "out.npz")[name].astype(np.float64)
    film = {"width": SIZE, "height": SIZE, "filter": {"type": "box"}}
    materials = {
        "floor": {"type": "diffuse", "reflectance": 0.5},
        "light": {"type": "diffuse", "reflectance": 0.7},
        **described.pop("materials"),
    }
    scene = accuray.Scene.from_dict(
        {"render": {"replicates": REPLICATES}, "film": film, "materials": materials, **described},
        folder=folder,
    )
    mean, error = (values[:, :, 1] for values in pixel_estimates(accuray.render(scene, spp=SPP, seed=SEED).film))
    other, noise = stack.mean(axis=0), stack.std(axis=0, ddof=1) / np.sqrt(len(stack))
    result = image_z_test(mean, error, other, noise, alpha=ALPHA, dof=REPLICATES - 1, floor=1e-4)
    total = mean.sum() / other.sum() - 1.0
    print(f"{name}: whole image {total:+.3%}, worst z {result.worst:.2f}, overall z {result.overall:.2f}")
    assert result, result.reason
    assert noise.sum() / other.sum() < 0.02, "no power"


def test_instances_agree_with_mitsuba(folder: Path) -> None:
    copies = {
        f"copy-{i}": {"type": "instance", "of": "knot", "transform": {"matrix": [*rows.ravel().tolist(), 0, 0, 0, 1]}}
        for i, rows in enumerate(crowd())
    }
    knot = {"type": "mesh", "material": "light", "file": "knot.ply", "prototype": True}
    described = {
        "camera": {"type": "perspective", "position": [0, 2.5, 5], "look_at": [0, 0.3, 0], "fov": 45},
        "lights": {"sky": {"type": "constant", "radiance": 0.3}},
        "materials": {"lamp": {"type": "diffuse", "reflectance": 0.2, "emission": 4}},
        "shapes": {"floor": FLOOR, "lamp": LAMP, "knot": knot, **copies},
    }
    compare("copies", described, folder)


def test_a_lamp_that_shows_a_picture_agrees_with_mitsuba(folder: Path) -> None:
    """Numbers of a picture without colours; ours are times D65, whose Y is 1, theirs times the spectrum 1."""
    texture = {"type": "image", "pixels": PICTURE[:, :, None].repeat(3, axis=2), "color_space": "linear"}
    described = {
        "camera": {"type": "perspective", "position": [0, 1.5, 4], "look_at": [0, 0.4, 0], "fov": 45},
        "textures": {"t": {**texture, "filter": "nearest"}},
        "materials": {"lamp": {"type": "diffuse", "reflectance": 0.2, "emission": {"texture": "t"}}},
        "shapes": {
            "floor": FLOOR,
            "lamp": LAMP,
            "ball": {"type": "sphere", "material": "light", "center": [0.4, 0.4, 0.3], "radius": 0.4},
        },
    }
    compare("picture", described, folder)
