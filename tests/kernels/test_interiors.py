"""Bodies of dielectrics: what they absorb along the way, and which of overlapping ones fills a place."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import accuray

GREEN = {"wavelengths": [400, 700], "values": [0.2, 0.8]}
#: The hero and three others (nm) and GREEN there.
NM = [430.0, 520.0, 610.0, 680.0]
SHARE = np.interp(NM, [400, 700], [0.2, 0.8])
SKY = {"sky": {"type": "constant"}}
Table = dict[str, Any]


def body(ior: Any = 1.0, color: Any = None, depth: float = 1.0, priority: int = 0) -> Table:
    """A dielectric; without a colour a clear one."""
    coloured = {} if color is None else {"transmission_color": color, "transmission_depth": depth}
    return {"type": "dielectric", "ior": ior, "priority": priority, **coloured}


def ball(material: str, radius: float = 1.0, center: tuple[float, float, float] = (0, 0, 0)) -> Table:
    return {"type": "sphere", "radius": radius, "center": list(center), "material": material}


def found(
    materials: Table, shapes: Table, lights: Table, origin: list[float], spp: int = 16, **more: Any
) -> accuray.Radiance:
    """Spectral radiance along +x from the origin."""
    scene = accuray.Scene.from_dict({"accuray": 1, "materials": materials, "shapes": shapes, "lights": lights, **more})
    count = 64
    origins, directions = np.tile(origin, (count, 1)), np.tile([1.0, 0.0, 0.0], (count, 1))
    return accuray.radiance(scene, origins, directions, spp, wavelengths=NM)


def mean(radiance: accuray.Radiance) -> Any:
    return radiance.mean.mean(axis=0)


def assert_agree(a: accuray.Radiance, b: accuray.Radiance) -> None:
    """Within 4.5 standard errors of the means over the rays."""
    error = np.hypot(*(np.asarray(r.mean).std(axis=0, ddof=1) / np.sqrt(len(r.mean)) for r in (a, b)))
    assert (error < 0.01 * mean(a)).all(), "no power"
    assert (np.abs(mean(a) - mean(b)) <= 4.5 * error).all(), (mean(a), mean(b), error)


@pytest.mark.parametrize("origin", [-3.0, 0.0, 0.5])
def test_beer(origin: float) -> None:
    """A ball of index 1 is only its absorption; a ray that starts inside has less of it before it."""
    way = 2.0 if origin < -1.0 else 1.0 - origin
    result = found({"m": body(color=GREEN, depth=0.5)}, {"b": ball("m")}, SKY, [origin, 0, 0])
    assert mean(result) == pytest.approx(SHARE ** (way / 0.5), rel=2e-6)


def test_what_is_inside_is_seen_through_the_body() -> None:
    lamp = {"type": "diffuse", "reflectance": 0, "emission": 3}
    shapes = {"b": ball("m"), "lamp": ball("lamp", 0.2)}
    result = found({"m": body(color=GREEN), "lamp": lamp}, shapes, {}, [-4, 0, 0])
    assert mean(result) == pytest.approx(3.0 * SHARE**0.8, rel=2e-6)


@pytest.mark.parametrize("kind", ["path", "reference"])
def test_light_inside_is_absorbed_on_both_ways(kind: str) -> None:
    """A point light and a wall inside a body: from the lamp to the wall, and from there to the eye outside."""
    wall = {"type": "disk", "center": [0.5, 0, 0], "normal": [-1, 0, 0], "radius": 0.2, "material": "wall"}
    materials = {"m": body(color=GREEN), "wall": {"type": "diffuse", "reflectance": 0.8}}
    light = {"p": {"type": "point", "position": [0.0, 0.3, 0], "intensity": 2}}
    integrator = {"type": kind, "max_depth": 2}  # through the surface, and off the wall
    result = found(materials, {"b": ball("m"), "w": wall}, light, [-3, 0, 0], integrator=integrator)
    distance = np.hypot(0.5, 0.3)
    clear = 0.8 / np.pi * 2 * (0.5 / distance) / distance**2
    assert mean(result) == pytest.approx(clear * SHARE ** (distance + 1.5), rel=1e-5)


def test_a_hidden_body_is_not_there() -> None:
    """Diamond of low priority inside water of a higher one."""
    materials = {"water": body(1.33, priority=2), "diamond": body(2.4, 0.01, priority=1)}
    both = found(materials, {"a": ball("water"), "b": ball("diamond", 0.5)}, SKY, [-3, 0.3, 0.1])
    assert mean(both) == pytest.approx(1.0, rel=1e-5)
    alone = found({"water": materials["water"]}, {"a": ball("water")}, SKY, [-3, 0.3, 0.1])
    assert mean(both) == pytest.approx(mean(alone), rel=1e-5)


def liquid_in_glass(overlap: bool) -> accuray.Radiance:
    """A plate of glass and one of dyed water: overlapping by priority, or as interfaces that touch exactly."""
    side = 40.0

    def plate(material: str, at: float, front: float, name: str) -> Table:
        shape = {"type": "disk", "center": [at, 0, 0], "normal": [front, 0, 0], "radius": side, "material": material}
        return {name: shape}

    lamp = {"type": "diffuse", "reflectance": 0, "emission": 1}
    shapes = plate("lamp", 2.0, -1.0, "l") | plate("glass", 0.0, -1.0, "a") | plate("water", 0.6, 1.0, "d")
    if overlap:  # glass from 0 to 0.2, water from 0.1 to 0.6
        materials = {"glass": body(1.6, priority=2), "water": body(1.3, GREEN, priority=1)}
        shapes |= plate("glass", 0.2, 1.0, "b") | plate("water", 0.1, -1.0, "c")
    else:  # one surface between them: from glass into water
        materials = {"glass": body(1.6), "water": body(1.3, GREEN), "between": body(1.3 / 1.6, GREEN)}
        shapes |= plate("between", 0.2, -1.0, "b")
    return found(materials | {"lamp": lamp}, shapes, {}, [-2, 0, 0], spp=4096)


def test_liquid_in_glass() -> None:
    """Three interfaces at normal incidence with all reflections between them, against the adding equations."""
    result = mean(liquid_in_glass(overlap=True))
    t = SHARE**0.4

    def reflectance(n: float) -> float:
        return ((n - 1.0) / (n + 1.0)) ** 2

    r1, r2, r3 = reflectance(1.6), reflectance(1.6 / 1.3), reflectance(1.3)
    # Glass plate of two interfaces: transmission and reflection from the water's side.
    through = (1 - r1) * (1 - r2) / (1 - r1 * r2)
    back = r2 + r1 * (1 - r2) ** 2 / (1 - r1 * r2)
    assert result == pytest.approx(through * t * (1 - r3) / (1 - back * r3 * t**2), rel=2e-3)


def test_touching_interfaces_give_the_same() -> None:
    assert_agree(liquid_in_glass(overlap=True), liquid_in_glass(overlap=False))


def test_nested_bodies_keep_a_white_furnace() -> None:
    materials = {"glass": body("N-BK7", priority=3), "water": body(1.33, priority=1), "oil": body(1.5, priority=2)}
    shapes = {
        "a": ball("glass", 1.0),
        "b": ball("oil", 0.9, (0.3, 0, 0)),
        "c": ball("water", 0.8, (0, 0.4, 0)),
        "d": ball("oil", 0.2, (-0.5, 0.1, 0)),
    }
    scene = accuray.Scene.from_dict(
        {
            "accuray": 1,
            "film": {"width": 24, "height": 24},
            "materials": materials,
            "shapes": shapes,
            "lights": SKY,
            "integrator": {"type": "path", "roulette_depth": 1000},
        }
    )
    luminance = accuray.render(scene, spp=64).film.mean()[:, :, 1]
    assert luminance.mean() == pytest.approx(1.0, rel=0.01)


def test_a_depth_without_a_colour_is_refused() -> None:
    material = body(color=0.5)
    del material["transmission_color"]
    scene = accuray.Scene.from_dict({"accuray": 1, "materials": {"m": material}, "shapes": {"b": ball("m")}})
    with pytest.raises(accuray.SceneError, match=r"transmission_depth: .*add transmission_color"):
        accuray.render(scene, spp=4)


def tinted(**more: Any) -> dict[str, Any]:
    return {"type": "dielectric", "transmission_color": 0.5, **more}


def test_a_colour_without_a_depth_tints_each_crossing() -> None:
    """A ball without refraction is crossed twice, however large it is; a slab as well, all reflections between."""
    for radius in (0.1, 2.0):
        scene = accuray.Scene.from_dict(
            {"materials": {"m": tinted(ior=1.0)}, "shapes": {"b": ball("m", radius)}, "lights": SKY}
        )
        found = accuray.radiance(scene, [[0, 0, 5]], [[0, 0, -1]], 64, wavelengths=[550.0])
        assert float(found.mean[0, 0]) == pytest.approx(0.25, rel=1e-5)


@pytest.mark.parametrize("strategy", ["light", "bsdf"])
def test_frosted_tinted_glass_by_every_strategy(strategy: str) -> None:
    """Light that is chosen through the surface has the tint of light that finds its own way."""

    def seen(kind: str, color: float) -> tuple[float, float]:
        glass = tinted(ior=1.3, roughness=0.8, transmission_color=color)
        lamp = {"type": "diffuse", "reflectance": 0, "emission": 1, "emission_sides": "both"}
        scene = accuray.Scene.from_dict(
            {
                "integrator": {"type": "path", "strategy": kind},
                "materials": {"m": glass, "lamp": lamp},
                "shapes": {
                    "b": {"type": "sphere", "material": "m"},
                    "l": {"type": "disk", "center": [0, 0, -2], "radius": 1, "material": "lamp"},
                },
            }
        )
        found = accuray.radiance(scene, [[0.2, 0.1, 5]] * 16, [[0, 0, -1]] * 16, 1024, wavelengths=[550.0])
        return float(found.mean[:, 0].mean()), float(found.mean[:, 0].std(ddof=1)) / 4.0

    mean, error = seen(strategy, 0.5)
    truth, its_error = seen("mis", 0.5)
    assert error < 0.05 * truth, "no power"
    assert abs(mean - truth) < 4.5 * (error**2 + its_error**2) ** 0.5
    assert truth < 0.5 * seen("mis", 1.0)[0]
