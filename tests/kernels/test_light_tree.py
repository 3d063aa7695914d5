"""The choice of lights: its probabilities sum to 1, are those with which lights are chosen, and leave none out."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import chi2

import accuray
from accuray._core import probe
from accuray.testing.chi2 import pearson
from tests.kernels.support import SEED, FloatArray, load, single

Description = dict[str, Any]
PLAIN = {"type": "diffuse", "reflectance": 0.5}


def lamp(scale: float = 1.0, sides: str = "front") -> Description:
    return {"type": "diffuse", "emission": {"illuminant": "D65", "scale": scale}, "emission_sides": sides}


def directions(count: int, rng: np.random.Generator) -> FloatArray:
    v = rng.normal(size=(count, 3))
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def triangles(count: int, rng: np.random.Generator, size: float = 0.1) -> Description:
    """An emissive mesh of triangles that lie anyhow in a cube of 4 metres; one in ten has no area, one hardly any."""
    corners = rng.uniform(-2, 2, (count, 1, 3)) + size * rng.normal(size=(count, 3, 3))
    corners[::10, 2] = corners[::10, 1]
    corners[5::10, 2] = corners[5::10, 1] + 1e-5
    faces = np.arange(3 * count, dtype=np.uint32).reshape(-1, 3)
    return {"type": "mesh", "positions": corners.reshape(-1, 3).astype(np.float32), "faces": faces, "material": "lamp"}


def random_points(count: int, rng: np.random.Generator, radius: float = 3.0) -> Description:
    """Point lights of very different intensities; one in eight emits nothing."""
    lights = {}
    for i in range(count):
        place = [float(x) for x in rng.uniform(-radius, radius, 3)]
        intensity = 0.0 if i % 8 == 3 else float(10.0 ** rng.uniform(-3, 3))
        lights[f"p{i:03d}"] = {"type": "point", "position": place, "intensity": intensity}
    return lights


def described(name: str) -> Description:
    """Scenes by what is difficult about their lights."""
    rng = np.random.default_rng([SEED, len(name)])
    sky = {"sky": {"type": "constant", "radiance": 0.3}}
    if name == "points":
        return {"lights": random_points(60, rng)}
    if name == "points and sky":
        return {"lights": random_points(20, rng) | sky}
    if name == "triangles":
        return {"materials": {"lamp": lamp()}, "shapes": {"mesh": triangles(150, rng)}}
    if name == "both sides":
        return {"materials": {"lamp": lamp(sides="both")}, "shapes": {"mesh": triangles(40, rng)}, "lights": sky}
    if name == "coincident":
        one = {"type": "point", "position": [0.5, 0.25, 1.0], "intensity": 1.0}
        return {"lights": {f"p{i:03d}": one for i in range(70)}}
    if name == "ceiling":
        tiles = {
            f"t{i}": {"type": "rectangle", "material": "lamp", "corner": [i % 6, 2, i // 6]}
            | {"edge_u": [0.5, 0, 0], "edge_v": [0, 0, 0.5]}
            for i in range(30)
        }
        return {"materials": {"lamp": lamp()}, "shapes": tiles}
    assert name == "shapes"
    shapes: Description = {
        "ball": {"type": "sphere", "material": "lamp", "center": [0.3, 1, 0], "radius": 0.4},
        "plate": {"type": "disk", "material": "lamp", "center": [0, 2, 0], "normal": [0, -1, 0.5], "radius": 0.7},
        "panel": {"type": "rectangle", "material": "dim", "corner": [-1, 0, -1], "edge_u": [2, 0, 0]}
        | {"edge_v": [0, 1, 1]},
    }
    bulb = {"bulb": {"type": "point", "position": [1, 1, 1], "intensity": 2.0}}
    return {"materials": {"lamp": lamp(), "dim": lamp(1e-4, "both")}, "shapes": shapes, "lights": bulb}


NAMES = ("points", "points and sky", "triangles", "both sides", "coincident", "ceiling", "shapes")
each_scene = pytest.mark.parametrize("name", NAMES)


@functools.cache
def scene(name: str) -> Any:
    return load(described(name))


def places(count: int, seed: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Points near, among and far from the lights, with normals; a quarter of them has none."""
    rng = np.random.default_rng([SEED, seed])
    scale = 10.0 ** rng.uniform(-1, 2, (count, 1))
    normals = directions(count, rng)
    normals[::4] = 0.0
    return single(scale * rng.uniform(-2, 2, (count, 3))), single(normals)


@each_scene
def test_probabilities_sum_to_one(name: str) -> None:
    probability = probe.choice_probabilities(scene(name), *places(1000, 1))
    assert np.isfinite(probability).all()
    assert (probability >= 0.0).all()
    assert np.abs(probability.sum(axis=1, dtype=np.float64) - 1.0).max() < 2e-5


@each_scene
def test_the_choice_gives_the_very_probability_of_its_light(name: str) -> None:
    points, normals = places(1000, 2)
    u = np.random.default_rng(SEED).random(1000, dtype=np.float32)
    light, chosen = probe.choose_lights(scene(name), points, normals, u)
    probability = probe.choice_probabilities(scene(name), points, normals)
    assert (chosen == probability[np.arange(1000), light]).all()
    assert (chosen > 0.0).all()


@each_scene
def test_lights_are_chosen_as_often_as_their_probability_says(name: str) -> None:
    rng = np.random.default_rng([SEED, 3])
    for point, normal in zip(*places(6, 4), strict=True):
        count = 100_000
        u = rng.random(count, dtype=np.float32)
        many = (np.tile(point, (count, 1)), np.tile(normal, (count, 1)))
        light, _ = probe.choose_lights(scene(name), *many, u)
        expected = count * probe.choice_probabilities(scene(name), point[None], normal[None])[0].astype(np.float64)
        seen = np.bincount(light, minlength=len(expected)).astype(np.float64)
        assert seen[expected == 0.0].sum() == 0.0
        chi2_agrees(seen, expected)


def chi2_agrees(seen: FloatArray, expected: FloatArray) -> None:
    """Pearson's test, at a level of 1e-6 for each of some forty."""
    statistic, freedom = pearson(seen, expected)
    assert chi2.sf(statistic, max(freedom, 1)) > 1e-6, (seen, expected)


@each_scene
def test_no_light_that_sends_something_is_left_out(name: str) -> None:
    """By sampling each light: what comes from above the horizon with emission on its side has a chance."""
    points, normals = places(200, 5)
    core = scene(name)
    dark = dark_lights(described(name))
    u = single(np.random.default_rng(SEED).random((16, 2)))
    probability = probe.choice_probabilities(core, points, normals)
    for i, (point, normal) in enumerate(zip(points, normals, strict=True)):
        for light in range(probability.shape[1]):
            if light in dark:
                assert probability[i, light] == 0.0
                continue
            s = probe.light_sample(core, light, [float(x) for x in point], u)
            sends = (s["pdf"] > 0.0) & (s["scale"] > 0.0) & np.isfinite(s["pdf"])
            if normal.any():
                sends &= s["wi"] @ normal > 1e-4
            assert probability[i, light] > 0.0 or not sends.any(), f"light {light} at {point}, normal {normal}"


def dark_lights(description: Description) -> set[int]:
    """Numbers of the lights of intensity 0; named lights come in the order of their names."""
    if "shapes" in description:
        return set()
    lights = description["lights"]
    return {i for i, name in enumerate(sorted(lights)) if lights[name].get("intensity") == 0.0}


def test_one_light_and_none_are_chosen_without_a_tree() -> None:
    bulb = {"type": "point", "position": [0, 0, 0], "intensity": 1.0}
    points, normals = places(8, 6)
    light, probability = probe.choose_lights(load({"lights": {"bulb": bulb}}), points, normals, points[:, 0] * 0)
    assert (light == 0).all()
    assert (probability == 1.0).all()
    light, _ = probe.choose_lights(load({}), points, normals, points[:, 0] * 0)
    assert (light == 2**32 - 1).all()


def test_lights_that_emit_nothing_are_no_choice() -> None:
    bulb = {"type": "point", "position": [0, 0, 0], "intensity": 0.0}
    core = load({"lights": {"a": bulb, "b": bulb, "c": bulb}})
    light, _ = probe.choose_lights(core, *places(8, 6), np.zeros(8, dtype=np.float32))
    assert (light == 2**32 - 1).all()


def test_a_near_lamp_is_preferred_to_far_ones() -> None:
    """Equal points at 1, 2, 4, ... metres along the normal: the chance falls with the square."""
    lights = {f"p{i}": {"type": "point", "position": [0, 0, 2.0**i], "intensity": 1.0} for i in range(4)}
    zero, up = single(np.zeros((1, 3))), single(np.array([[0.0, 0.0, 1.0]]))
    probability = probe.choice_probabilities(load({"lights": lights}), zero, up)[0]
    assert np.allclose(probability / probability[0], [1, 1 / 4, 1 / 16, 1 / 64], rtol=0.01)


def test_the_units_of_a_scene_do_not_matter() -> None:
    """From micrometres to hundreds of kilometres the same choices."""
    rng = np.random.default_rng(SEED)
    where, points, normals = rng.uniform(-2, 2, (30, 3)), rng.uniform(-2, 2, (50, 3)), directions(50, rng)
    found = []
    for scale in (1.0, 2.0**-20, 2.0**20):
        lights = {
            f"p{i:02d}": {"type": "point", "position": list(map(float, scale * p)), "intensity": scale**2}
            for i, p in enumerate(where)
        }
        found.append(probe.choice_probabilities(load({"lights": lights}), single(scale * points), single(normals)))
    assert np.allclose(found[1], found[0], rtol=1e-3, atol=1e-7)
    assert np.allclose(found[2], found[0], rtol=1e-3, atol=1e-7)


def test_a_surface_that_lets_light_through_gathers_it_from_both_sides() -> None:
    """Rough glass between the camera and two lamps, one before it and one behind: both are found by their choice."""
    description = {
        "accuray": 1,
        "film": {"width": 8, "height": 8},
        "camera": {"type": "perspective", "position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 20},
        "materials": {"glass": {"type": "dielectric", "roughness": 0.5, "ior": 1.5}},
        "shapes": {"ball": {"type": "sphere", "material": "glass", "radius": 1.0}},
        "integrator": {"type": "path", "max_depth": 2, "strategy": "light"},
    }
    lamps = {"front": [0.5, 1, 3], "back": [0.2, 0.3, -3]}
    lights = {k: {"type": "point", "position": p, "intensity": 1.0} for k, p in lamps.items()}

    def picture(some: Description, seed: int) -> FloatArray:
        image = accuray.render(accuray.Scene.from_dict(description | {"lights": some}), spp=1024, seed=seed)
        return np.asarray(image, dtype=np.float64).mean(axis=(0, 1))

    both = picture(lights, 1)
    apart = sum(picture({k: v}, 2 + i) for i, (k, v) in enumerate(lights.items()))
    assert np.allclose(both, apart, rtol=0.03)
