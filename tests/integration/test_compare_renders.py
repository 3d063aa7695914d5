"""`accuray.compare` on renders: noise explains another seed, but no other paint, lamp or size."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from fair import FOLDER

import accuray


def render(scene: str, seed: int, overrides: dict[str, Any] | None = None) -> accuray.Image:
    small = {"film.width": 96, "film.height": 64, **(overrides or {})}
    return accuray.render(accuray.load(FOLDER / f"{scene}.toml", overrides=small), spp=64, seed=seed)


@pytest.mark.parametrize("scene", ["spheres", "teapot"])
def test_another_seed_is_the_same_picture(scene: str) -> None:
    c = accuray.compare(render(scene, 1), render(scene, 2))
    assert c.noise is not None
    assert c.noise, c.noise.reason
    assert c.accuracy < 99.9
    assert 0.3 < c.relative_mse / (2 * render(scene, 1).relative_error ** 2) < 3


@pytest.mark.parametrize(
    ("scene", "change"),
    [
        ("spheres", {"materials.chalk.reflectance": 0.76}),
        ("spheres", {"materials.lamp.emission": {"illuminant": "D65", "scale": 6.8}}),
        ("teapot", {"shapes.smooth.height": 1.05}),
    ],
    ids=["paint", "lamp", "size"],
)
def test_another_scene_is_not(scene: str, change: dict[str, Any]) -> None:
    c = accuray.compare(render(scene, 1, change), render(scene, 2))
    assert c.noise is not None
    assert c.noise.verdict == "fail"


def test_the_same_samples_are_identical() -> None:
    c = accuray.compare(render("spheres", 1), render("spheres", 1))
    assert c.identical
    assert c.accuracy == 100
