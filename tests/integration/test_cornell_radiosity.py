"""The renderer's Cornell box against the finite-element radiosity solution of `tests/oracles`.

Area averages of outgoing radiance are measured with rays that look straight down at uniformly distributed points of a
surface, in independent batches whose scatter gives the standard error; batches are added until that is small enough.
The stored solution is good to 0.02 % for whole surfaces and 0.2 % for the blocks' darkest faces.
"""

from __future__ import annotations

import functools
import json
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.cornell import DATA, WAVELENGTHS, cornell_box, cornell_spectra, reference
from oracles.enclosure import Enclosure

pytest.importorskip("accuray._core")
import accuray

SURFACES = ["floor", "ceiling", "back_wall", "right_wall", "left_wall", "short_block", "tall_block"]
FACES = [f"{block}/{k}" for block in ("short_block", "tall_block") for k in range(5)]
TOLERANCE = 5e-3
POWER = 1e-3
"""Largest relative standard error with which a comparison counts."""
BATCHES = 32
LOG2_RAYS = 11
SPP = 16
ROUNDS = 16
SHIPPED = DATA.parents[1] / "scenes" / "cornell-box.toml"


@functools.cache
def enclosure() -> Enclosure:
    return cornell_box()


@functools.cache
def scene_called(which: str) -> accuray.Scene:
    """The shipped scene file, or the box built from the measured arrays."""
    return accuray.load(SHIPPED) if which == "shipped" else box_from_arrays()


def box_from_arrays() -> accuray.Scene:
    """The listed quadrilaterals, the ceiling cut around the lamp, with the measured spectra and lamp radiance."""
    listed = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))["surfaces"]
    quads = {name: np.array(entry["quads"], dtype=np.float32) for name, entry in listed.items()}
    quads["ceiling"] = next(p.quads for p in enclosure().pieces if p.surface == "ceiling").astype(np.float32)
    shapes = {}
    for name, entry in listed.items():
        corners = np.arange(4 * len(quads[name]), dtype=np.uint32).reshape(-1, 4)
        faces = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
        positions = quads[name].reshape(-1, 3)
        shapes[name] = {"type": "mesh", "positions": positions, "faces": faces, "material": entry["material"]}

    paint = np.genfromtxt(DATA / "cornell_box_reflectance.csv", delimiter=",", skip_header=2)
    lamp = np.genfromtxt(DATA / "cornell_box_light.csv", delimiter=",", skip_header=2)
    materials: dict[str, Any] = {
        name: {"type": "diffuse", "reflectance": table(paint[:, 0], paint[:, column])}
        for column, name in enumerate(("white", "green", "red"), 1)
    }
    materials["light"] = {"type": "diffuse", "reflectance": 0.78, "emission": table(lamp[:, 0], lamp[:, 1])}
    camera = {"type": "perspective", "position": [278, 273, -800], "look_at": [278, 273, 0], "fov": "39.3 deg"}
    document = {"accuray": 1, "length_unit": "mm", "camera": camera, "materials": materials, "shapes": shapes}
    return accuray.Scene.from_dict(document)


def table(wavelengths: NDArray[np.float64], values: NDArray[np.float64]) -> dict[str, list[float]]:
    return {"wavelengths": wavelengths.tolist(), "values": values.tolist()}


@functools.cache
def measured(which: str, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean radiance of a surface at the three wavelengths and its standard error, from as many rounds as it takes."""
    means: list[NDArray[np.float64]] = []
    for round_ in range(ROUNDS):
        seeds = range(round_ * BATCHES, (round_ + 1) * BATCHES)
        rays = [enclosure().probes(name, LOG2_RAYS, seed) for seed in seeds]
        origins = 1e-3 * np.concatenate([origin for origin, _ in rays])
        directions = np.concatenate([direction for _, direction in rays])
        found = accuray.radiance(scene_called(which), origins, directions, SPP, seed=round_, wavelengths=WAVELENGTHS)
        means.extend(np.asarray(found.mean, dtype=float).reshape(BATCHES, -1, len(WAVELENGTHS)).mean(axis=1))
        mean, error = np.mean(means, axis=0), np.std(means, axis=0, ddof=1) / np.sqrt(len(means))
        if np.all(error <= POWER * mean):
            break
    return mean, error


def compare(name: str, found: NDArray[np.float64], error: NDArray[np.float64], expected: NDArray[np.float64]) -> None:
    assert np.all(error <= POWER * found), f"{name}: no power, standard errors {error / found}"
    np.testing.assert_allclose(found, expected, rtol=TOLERANCE, err_msg=name)


@pytest.mark.parametrize("name", [*SURFACES, "light", *FACES])
def test_the_box_agrees_with_radiosity(name: str) -> None:
    lamp = cornell_spectra(WAVELENGTHS)[1]
    compare(name, *measured("arrays", name), lamp * reference()["limit"][name])


@pytest.mark.parametrize("name", SURFACES)
def test_the_shipped_scene_agrees_with_radiosity(name: str) -> None:
    """Relative to the lamp's own radiance, whose scale nobody measured, so that the scene file may choose it."""
    lamp = measured("shipped", "light")[0]  # its error is far below the others', being almost all emission
    mean, error = measured("shipped", name)
    limit = {key: np.array(values) for key, values in reference()["limit"].items()}
    compare(name, mean / lamp, error / lamp, limit[name] / limit["light"])
