"""The renderer's Cornell box against the finite-element radiosity solution of `tests/oracles`.

Area averages of outgoing radiance are measured with rays that look straight down at uniformly distributed points of a
surface, in independent batches whose scatter is the standard error. The stored solution is good to 0.02 % for whole
surfaces and 0.2 % for single faces of the blocks; the darkest faces see the lamp only over several bounces.
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
import accuray  # noqa: E402

SURFACES = ["floor", "ceiling", "back_wall", "right_wall", "left_wall", "short_block", "tall_block"]
FACES = [f"{block}/{k}" for block in ("short_block", "tall_block") for k in range(5)]
TOLERANCE = 5e-3
POWER = 1e-3
"""Largest relative standard error with which a comparison counts."""
BATCHES = 32
LOG2_RAYS = 13
SPP = 4
ROUNDS = 12
SHIPPED = DATA.parents[1] / "scenes" / "cornell-box.toml"


@functools.cache
def enclosure() -> Enclosure:
    return cornell_box()


@functools.cache
def measured_box() -> accuray.Scene:
    """The box built from arrays: the oracle's own pieces, the measured spectra, and the lamp's listed radiance."""
    spectra = {}
    for name, file in (("paint", "cornell_box_reflectance.csv"), ("lamp", "cornell_box_light.csv")):
        spectra[name] = np.genfromtxt(DATA / file, delimiter=",", skip_header=2)
    lamp = {"wavelengths": spectra["lamp"][:, 0].tolist(), "values": spectra["lamp"][:, 1].tolist()}
    materials: dict[str, Any] = {"light": {"type": "diffuse", "reflectance": 0.78, "emission": lamp}}
    for column, name in enumerate(("white", "green", "red"), 1):
        table = {"wavelengths": spectra["paint"][:, 0].tolist(), "values": spectra["paint"][:, column].tolist()}
        materials[name] = {"type": "diffuse", "reflectance": table}
    shapes = {}
    for number, piece in enumerate(enclosure().pieces):
        if piece.surface != "opening":
            corners = np.arange(4 * len(piece.quads)).reshape(-1, 4)
            faces = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]).astype(np.uint32)
            positions = piece.quads.reshape(-1, 3).astype(np.float32)
            mesh = {"type": "mesh", "positions": positions, "faces": faces, "material": piece.material}
            shapes[f"{piece.surface}_{number}"] = mesh
    camera = {"type": "perspective", "position": [278, 273, -800], "look_at": [278, 273, 0], "fov": 39.3077}
    document = {"accuray": 1, "length_unit": "mm", "camera": camera, "materials": materials, "shapes": shapes}
    return accuray.Scene.from_dict(document)


@functools.cache
def measured(scene: accuray.Scene, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean radiance of a surface at the three wavelengths and its standard error, from as many rounds as it takes."""
    means: list[NDArray[np.float64]] = []
    for round_ in range(ROUNDS):
        seeds = range(round_ * BATCHES, (round_ + 1) * BATCHES)
        rays = [enclosure().probes(name, LOG2_RAYS, seed) for seed in seeds]
        origins = 1e-3 * np.concatenate([origin for origin, _ in rays])
        directions = np.concatenate([direction for _, direction in rays])
        found = accuray.radiance(scene, origins, directions, SPP, seed=round_, wavelengths=WAVELENGTHS)
        means.extend(np.asarray(found.mean, dtype=float).reshape(BATCHES, -1, len(WAVELENGTHS)).mean(axis=1))
        mean, error = np.mean(means, axis=0), np.std(means, axis=0, ddof=1) / np.sqrt(len(means))
        if np.all(error <= POWER * mean):
            break
    return mean, error


def compare(name: str, found: NDArray[np.float64], error: NDArray[np.float64], expected: NDArray[np.float64]) -> None:
    assert np.all(error <= POWER * found), f"{name}: no power, standard errors {error / found}"
    np.testing.assert_allclose(found, expected, rtol=TOLERANCE, err_msg=name)


@pytest.mark.parametrize("name", [*SURFACES, "light"])
def test_surfaces_agree_with_radiosity(name: str) -> None:
    lamp = cornell_spectra(WAVELENGTHS)[1]
    compare(name, *measured(measured_box(), name), lamp * reference()["limit"][name])


@pytest.mark.parametrize("name", FACES)
def test_faces_of_the_blocks_agree_with_radiosity(name: str) -> None:
    lamp = cornell_spectra(WAVELENGTHS)[1]
    compare(name, *measured(measured_box(), name), lamp * reference()["limit"][name])


@pytest.mark.parametrize("name", SURFACES)
def test_the_shipped_scene_agrees_with_radiosity(name: str) -> None:
    """Relative to the lamp's own radiance, whose scale nobody measured and the scene file may choose."""
    scene = shipped_box()
    lamp, lamp_error = measured(scene, "light")
    mean, error = measured(scene, name)
    limit = {key: np.array(values) for key, values in reference()["limit"].items()}
    ratio = mean / lamp
    compare(name, ratio, ratio * np.hypot(error / mean, lamp_error / lamp), limit[name] / limit["light"])


@functools.cache
def shipped_box() -> accuray.Scene:
    return accuray.load(SHIPPED)


def test_the_oracle_used_the_same_data() -> None:
    data = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))
    assert data["unit"] == "mm"
    reflectance = cornell_spectra(WAVELENGTHS)[0]
    assert {name: pytest.approx(values) for name, values in reference()["reflectance"].items()} == reflectance
