"""Environments, suns and skies in pictures: closed forms, what the camera sees, and how they add up."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")

import accuray
from accuray import devices
from accuray._core import probe
from accuray.data import LUMINOUS_EFFICACY, observer
from accuray.film.estimates import pixel_estimates

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
STRATEGIES = ("mis", "light", "bsdf")
LUX = LUMINOUS_EFFICACY * sum(observer().y)
"""Illuminance, lx, of an irradiance of Y = 1."""
Table = dict[str, Any]


def environment(pixels: Any, **more: Any) -> Table:
    return {"type": "environment", "pixels": pixels, **more}


def floor_under(lights: dict[str, Table], strategy: str = "mis", normal: tuple[float, float, float] = (0, 1, 0)) -> Any:
    """A diffuse disc of reflectance 0.5 at the origin; the strategy is one of path tracing, or the reference."""
    integrator = {"type": "reference"} if strategy == "reference" else {"type": "path", "strategy": strategy}
    return accuray.Scene.from_dict(
        {
            "lights": lights,
            "integrator": integrator | {"max_depth": 1},
            "materials": {"white": {"type": "diffuse", "reflectance": 0.5}},
            "shapes": {"floor": {"type": "disk", "material": "white", "normal": list(normal), "radius": 1}},
        }
    )


def seen(scene: Any, rays: Any, spp: int = 4096, origin: Any = (0, 0, 0)) -> tuple[NDArray[np.float64], Any]:
    """Y along rays from a place, and its error."""
    directions = np.atleast_2d(np.asarray(rays, dtype=np.float64))
    origins = np.broadcast_to(np.asarray(origin, dtype=np.float64), directions.shape)
    found = accuray.radiance(scene, origins, directions, spp, seed=SEED, space="xyz")
    return found.mean[:, 1], found.error[:, 1]


def irradiance(scene: Any, normal: Any = (0, 1, 0), rays: int = 32, spp: int = 2048) -> tuple[float, float]:
    """Y of the irradiance on the floor, from independent rays that look at it, and its error."""
    n = np.asarray(normal, dtype=np.float64)
    n = n / np.linalg.norm(n)
    mean, _ = seen(scene, np.tile(-n, (rays, 1)), spp, origin=0.1 * n)
    values = mean * math.pi / 0.5
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(rays))


def agrees(found: tuple[float, float], expected: float, power: float = 5e-3) -> None:
    value, error = found
    assert error <= power * expected, f"no power: {value} +- {error}"
    assert abs(value - expected) <= 4.0 * error + 2e-5 * expected, f"{value} +- {error}, not {expected}"


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_map_of_one_value_is_a_constant_environment(strategy: str) -> None:
    """White: what absorbs nothing is as bright as the sky behind it, in every way of sampling."""
    film = {"width": 24, "height": 24, "filter": {"type": "box"}}
    camera = {"type": "perspective", "position": [0, 1, 4], "look_at": [0, 0, 0]}
    scenes = [
        accuray.Scene.from_dict(
            {
                "film": film,
                "camera": camera,
                "integrator": {"type": "path", "strategy": strategy},
                "lights": {"sky": light},
                "materials": {"grey": {"type": "diffuse", "reflectance": 0.7, "roughness": 0.5}},
                "shapes": {"ball": {"type": "sphere", "material": "grey"}},
            }
        )
        for light in (environment(np.ones((4, 8))), {"type": "constant", "radiance": "D65"})
    ]
    ours, plain = (accuray.render(scene, spp=1024, seed=SEED + i).film for i, scene in enumerate(scenes))
    (mean, error), (truth, its_error) = pixel_estimates(ours), pixel_estimates(plain)
    difference = (mean - truth)[..., 1].mean()
    noise = math.hypot(*(float(np.sqrt((e[..., 1] ** 2).mean() / e[..., 1].size)) for e in (error, its_error)))
    assert noise < 1e-3
    assert abs(difference) <= 4.0 * noise + 1e-6


@pytest.mark.parametrize("strategy", STRATEGIES[:2])
@pytest.mark.parametrize("row", [0, 3, 6])
def test_one_bright_texel_has_the_irradiance_of_its_closed_form(strategy: str, row: int) -> None:
    """A texel is a tent of the map's bilinear surface: E = (2 pi / w) L (1/2) sin(2 c) (1 - cos 2 d) / (2 d)."""
    height, width = 16, 32
    pixels = np.zeros((height, width))
    pixels[row, 9] = 1000.0
    d = math.pi / height
    c = (row + 0.5) * d
    tent = 0.5 * math.sin(2 * c) * (1 - math.cos(2 * d)) / (2 * d)
    if row == 0:  # the surface is level from the first row's middle to the pole: by quadrature
        theta = (np.arange(100_000) + 0.5) * 1.5 * d / 100_000
        ramp = np.clip(1.5 - theta / d, 0.0, 1.0)
        tent = float((ramp * np.sin(theta) * np.cos(theta)).mean() * 1.5 * d)
    scene = floor_under({"sky": environment(pixels)}, strategy)
    agrees(irradiance(scene), 1000.0 * 2 * math.pi / width * tent)


def test_a_panorama_of_an_environment_is_its_map(tmp_path: Path) -> None:
    """A panorama camera sees the texels where they are stored."""
    pixels = np.random.default_rng(3).random((6, 12, 3))
    scene = accuray.Scene.from_dict({"camera": {"type": "panorama"}, "lights": {"sky": environment(pixels)}})
    y, x = np.meshgrid((np.arange(6) + 0.5) / 6, (np.arange(12) + 0.5) / 12, indexing="ij")
    film = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float32)
    rays = probe.camera_ray(devices.load(scene).core, film, np.full_like(film, 0.5))["direction"]
    found = accuray.radiance(scene, np.zeros_like(rays), rays, 20_000, space="rgb").mean
    assert np.abs(found - pixels.reshape(-1, 3)).max() < 0.02


@pytest.mark.parametrize("strategy", [*STRATEGIES[:2], "reference"])
@pytest.mark.parametrize("tilt", [0.0, 60.0])
def test_the_illuminance_of_the_sun(strategy: str, tilt: float) -> None:
    """D65 of 1.3 W/(m^2 nm) at Y = 1: 1.3 * 72983 = 94878 lx on a plane that faces the sun, half at 60 degrees."""
    towards = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])
    aside = np.cross(towards, [0, 0, 1.0])
    angle = math.radians(tilt)
    normal = math.cos(angle) * towards + math.sin(angle) * aside / np.linalg.norm(aside)
    sun = {"type": "sun", "towards": [1, 2, -0.5], "irradiance": {"illuminant": "D65", "scale": 1.3}}
    if strategy == "reference":  # finds a disc only if it is large: it touches the horizon at a tilt of 60 degrees
        sun["angular_diameter"] = 60
    scene = floor_under({"sun": sun}, strategy, tuple(normal))
    value, error = irradiance(scene, normal)
    assert pytest.approx(72983, rel=1e-5) == LUX
    agrees((value * LUX, error * LUX), 94878 * math.cos(angle), power=1e-2)


def test_the_sun_is_seen_where_it_stands_and_as_large_as_it_is() -> None:
    """Radiance of the disc: irradiance over pi sin^2 of its radius; nothing beside it."""
    scene = accuray.Scene.from_dict({"lights": {"sun": {"type": "sun", "elevation": 30, "azimuth": 90}}})
    radius = math.radians(0.533 / 2)
    level = 1.0 / (math.pi * math.sin(radius) ** 2)
    for offset, expected in ((0.0, level), (0.99, level), (1.01, 0.0)):
        angle = math.radians(30) + offset * radius
        mean, _ = seen(scene, [[math.cos(angle), math.sin(angle), 0.0]], 256)
        assert mean[0] == pytest.approx(expected, rel=2e-2)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_infinite_lights_add_up(strategy: str) -> None:
    """Three environments of 1, 2 and 0.5, and half a sky of sun of 4: the floor sees pi times their sum."""
    lights = {
        "a": {"type": "constant", "radiance": 1.0},
        "b": {"type": "constant", "radiance": "D65"},
        "c": environment(np.full((2, 4), 0.5)),
        "d": {"type": "sun", "elevation": 90, "angular_diameter": 180, "radiance": 4.0},
    }
    scene = floor_under(lights, strategy)
    agrees(irradiance(scene), 6.5 * math.pi)
    assert seen(scene, [[0, 1.0, 0]], 4096, origin=(5, 5, 5))[0][0] == pytest.approx(6.5, rel=1e-2)
    assert seen(scene, [[0, -1.0, 0]], 4096, origin=(5, -5, 5))[0][0] == pytest.approx(2.5, rel=1e-2)


def picture(lights: dict[str, Table], **film: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Y and alpha of a small picture of an empty scene, looking to the horizon."""
    size = {"width": 8, "height": 8, "filter": {"type": "box"}}
    scene = accuray.Scene.from_dict(
        {"film": size | film, "camera": {"type": "perspective", "position": [0, 0, 0], "look_at": [0, 0, -1]},
         "lights": lights}
    )  # fmt: skip
    image = accuray.render(scene, spp=64, seed=SEED)
    values = np.asarray(image, dtype=np.float64)
    return values.sum(axis=2), np.asarray(image.layers["alpha"], dtype=np.float64)


def test_hidden_lights_are_not_seen_and_leave_no_alpha() -> None:
    shown, hidden = environment(np.ones((2, 4))), environment(np.ones((2, 4)), visible=False)
    level, alpha = picture({"a": shown})
    assert level.min() > 2.5
    assert (alpha == 1.0).all()
    both, alpha = picture({"a": shown, "b": hidden})
    assert np.allclose(both, level, rtol=0.05)
    assert (alpha == 1.0).all()
    for dark in (picture({"b": hidden}), picture({"a": shown}, hide_environment=True), picture({})):
        assert (dark[0] == 0.0).all()
        assert (dark[1] == 0.0).all()
    plain = {"type": "constant", "radiance": 1.0, "visible": False}
    assert (picture({"a": plain})[1] == 0.0).all()


def test_alpha_is_where_a_light_is() -> None:
    """A black map is there; a sky is above the horizon, a sun in its disc."""
    assert (picture({"a": environment(np.zeros((2, 4)))})[1] == 1.0).all()
    alpha = picture({"a": {"type": "sky", "sun": False}})[1]
    assert (alpha[:4] == 1.0).all()
    assert (alpha[4:] == 0.0).all()
    alpha = picture({"a": {"type": "sun", "elevation": 0, "angular_diameter": 5}})[1]
    assert 0.0 < alpha.mean() < 0.2
    assert alpha[0].max() == 0.0


def test_a_hidden_light_still_lights_and_is_mirrored() -> None:
    hidden = environment(np.ones((2, 4)), visible=False)
    agrees(irradiance(floor_under({"a": hidden})), math.pi)
    scene = accuray.Scene.from_dict(
        {
            "lights": {"a": hidden},
            "materials": {"mirror": {"type": "conductor", "metal": "perfect"}},
            "shapes": {"ball": {"type": "sphere", "material": "mirror"}},
        }
    )
    assert seen(scene, [[0, 0, -1.0]], 1024, origin=(0, 0, 3))[0][0] == pytest.approx(1.0, rel=2e-2)


def test_turning_map_and_scene_together_changes_nothing() -> None:
    """Rotation equivariance: a tilted floor under a map, all turned by 50 degrees about +Y."""
    pixels = np.random.default_rng(9).random((8, 16, 3)) ** 4
    pixels[:, 2:7] += 3.0
    c, s = math.cos(math.radians(50)), math.sin(math.radians(50))
    normal = np.array([0.6, 0.7, -0.2])
    turned = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ normal
    plain = irradiance(floor_under({"a": environment(pixels)}, normal=tuple(normal)), normal)
    moved = irradiance(floor_under({"a": environment(pixels, rotation=50)}, normal=tuple(turned)), turned)
    agrees(plain, plain[0], 2e-3)
    assert abs(plain[0] - moved[0]) <= 4.0 * math.hypot(plain[1], moved[1])
    other = irradiance(floor_under({"a": environment(pixels)}, normal=tuple(turned)), turned)
    assert abs(plain[0] - other[0]) > 20.0 * plain[1], "no power: the map looks alike from there"


def test_a_picture_from_a_file_is_the_same_as_its_pixels(tmp_path: Path) -> None:
    import OpenImageIO as oiio  # noqa: N813

    pixels = np.random.default_rng(2).random((8, 16, 3)).astype(np.float32) * 20
    for name in ("map.exr", "map.hdr"):
        target = oiio.ImageBuf(oiio.ImageSpec(16, 8, 3, "float"))
        target.set_pixels(oiio.ROI(), pixels)
        assert target.write(str(tmp_path / name))
        scene = accuray.Scene.from_dict({"lights": {"a": {"type": "environment", "file": name}}}, folder=tmp_path)
        stored = scene.lights["a"]["pixels"]
        assert np.abs(stored - pixels).max() < (1e-6 if name == "map.exr" else 0.2)  # hdr keeps 8 bits of the largest
        found = seen(scene, [[0.3, 0.2, -0.8]], 4096)[0]
        expected = seen(accuray.Scene.from_dict({"lights": {"a": environment(stored)}}), [[0.3, 0.2, -0.8]], 4096)[0]
        assert found == expected
