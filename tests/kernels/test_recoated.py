"""Two layers on a matte surface: closed forms where both are smooth, a furnace and all strategies where they are rough.

Unpolarised light meets three interfaces. Of two smooth ones the pair is a stack with a known transmittance T, and light
that is inside of the lower layer gets out as its integral says.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import accuray
from accuray.verify import optics
from tests.kernels.support import SEED, Bsdf, FloatArray, load, rows, uniform, unit

COUNT = 40_000
VALUES = 20_000
SIGMAS = 4.5
INDICES = [(1.6, 1.5), (1.3, 2.5)]


def described(base: dict[str, Any], lower: dict[str, Any], upper: dict[str, Any]) -> dict[str, Any]:
    """The materials of a coated coat; the last one, "top", is the whole."""
    return {
        "base": base,
        "lower": {"type": "coated", "base": "base", **lower},
        "top": {"type": "coated", "base": "lower", **upper},
    }


def recoated(albedo: float, lower: dict[str, Any], upper: dict[str, Any]) -> Bsdf:
    return Bsdf(load({"materials": described({"type": "diffuse", "reflectance": albedo}, lower, upper)}), 2)


def at(degrees: float) -> FloatArray:
    theta = math.radians(degrees)
    return unit(math.sin(theta), 0.0, math.cos(theta))


def check(values: FloatArray, expected: float, what: str) -> None:
    """Independent estimates have the expected mean, with an error of at most 2 %."""
    error = float(values.std(ddof=1) / math.sqrt(len(values)))
    assert error <= 0.02 * expected, f"{what}: no power"
    difference = float(values.mean()) - expected
    allowed = SIGMAS * error + 1e-5 * expected
    assert abs(difference) <= allowed, f"seed {SEED}, {what}: {values.mean():.6g} +- {error:.2g}, not {expected:.6g}"


def through(theta: float, upper: float, lower: float) -> float:
    """Transmittance of both interfaces, the reflections between them included."""
    first = optics.fresnel(theta, upper)
    second = optics.fresnel(math.asin(math.sin(theta) / upper), lower / upper)
    return (1.0 - first) * (1.0 - second) / (1.0 - first * second)


def kept_inside(upper: float, lower: float) -> float:
    """Share of diffuse light in the lower layer that the interfaces send back: by the square of the sine."""
    nodes = (np.arange(4000) + 0.5) / (4000 * lower**2)
    return 1.0 - float(np.mean([through(math.asin(math.sqrt(u) * lower), upper, lower) for u in nodes])) / lower**2


@pytest.mark.parametrize(("upper", "lower"), INDICES)
def test_smooth_layers_on_a_matte_surface(upper: float, lower: float) -> None:
    albedo, back = 0.8, kept_inside(upper, lower)
    bsdf = recoated(albedo, {"ior": lower}, {"ior": upper})
    for i, degrees in enumerate((0.0, 45.0, 80.0)):
        theta, wo = math.radians(degrees), at(degrees)
        passed = through(theta, upper, lower)
        for other in (10.0, 70.0):
            leaving = through(math.radians(other), upper, lower) * math.cos(math.radians(other))
            expected = passed * leaving / lower**2 * albedo / (1.0 - albedo * back) / math.pi
            value = bsdf.eval(rows(wo, VALUES), rows(at(other), VALUES), seed=SEED + i)[0][:, 0]
            check(value, expected, f"value at {degrees}, {other}")
        weight = bsdf.sample_one(wo, uniform(COUNT, 3, SEED)).weight[:, 0]
        check(weight, 1.0 - passed + passed * albedo * (1.0 - back) / (1.0 - albedo * back), f"albedo at {degrees}")


def test_both_layers_have_their_gloss() -> None:
    """The mirrored light is that of the stack, so the lower layer has not lost its interface under the upper one."""
    bsdf = recoated(0.0, {"ior": 2.5}, {"ior": 1.3})
    for degrees in (0.0, 60.0):
        s = bsdf.sample_one(at(degrees), uniform(COUNT, 3, SEED))
        mirrored = np.where(s.specular, s.weight[:, 0], 0.0)
        check(mirrored, 1.0 - through(math.radians(degrees), 1.3, 2.5), f"{degrees} degrees")
    rough = recoated(0.0, {"ior": 2.5, "roughness": 0.5}, {"ior": 1.3})
    s = rough.sample_one(at(0.0), uniform(COUNT, 3, SEED))
    sharp = np.where(s.specular, s.weight[:, 0], 0.0)
    error = float(sharp.std(ddof=1)) / math.sqrt(COUNT)
    assert abs(sharp.mean() - optics.fresnel(0.0, 1.3)) <= SIGMAS * error, "the upper gloss is sharp"
    wide = np.where(s.specular, 0.0, s.weight[:, 0])
    assert wide.mean() > 2.0 * optics.fresnel(0.0, 1.3), "the lower gloss is wide"


def test_both_layers_absorb() -> None:
    """To lowest order in the albedo, straight in and out: each layer is crossed twice."""
    albedo = 1e-3
    bsdf = recoated(albedo, {"transmission_color": 0.5, "ior": 1.5}, {"transmission_color": 0.6, "ior": 1.5})
    value = bsdf.eval(rows(at(0.0), VALUES), rows(at(0.0), VALUES), seed=SEED)[0][:, 0]
    expected = albedo * (1.0 - optics.fresnel(0.0, 1.5)) ** 2 / 1.5**2 / math.pi * (0.5 * 0.6) ** 2
    check(value, expected * (1.0 + optics.fresnel(0.0, 1.5) * 1e-3), "value")


@pytest.mark.parametrize(
    ("lower", "upper"),
    [
        ({"roughness": 0.5}, {"ior": 1.6}),
        ({"roughness": 0.3}, {"roughness": 0.6, "ior": 1.3}),
        ({"ior": 1.8}, {"roughness": 0.4}),
        ({"roughness": 0.5, "film_thickness": 400}, {}),
    ],
)
def test_no_light_is_lost_between_the_layers(lower: dict[str, Any], upper: dict[str, Any]) -> None:
    """White stays white, from samples and from the integral of the values besides the mirrored part."""
    bsdf = recoated(1.0, lower, upper)
    for degrees in (20.0, 70.0):
        wo, rng = at(degrees), np.random.default_rng(SEED)
        s = bsdf.sample_one(wo, uniform(COUNT, 3, SEED))
        error = float(s.weight[:, 0].std(ddof=1) / math.sqrt(COUNT))
        assert error < 0.01, "no power"
        assert abs(s.weight[:, 0].mean() - 1.0) <= SIGMAS * error + 5e-3
        wide = np.where(s.specular, 0.0, s.weight[:, 0])
        z, turn = rng.random(VALUES), 2.0 * np.pi * rng.random(VALUES)
        r = np.sqrt(1.0 - z * z)
        value, pdf = bsdf.eval(rows(wo, VALUES), np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=-1), seed=SEED)
        integral = 2.0 * np.pi * value[:, 0]
        spread = math.hypot(error, float(integral.std(ddof=1)) / math.sqrt(VALUES))
        assert abs(integral.mean() - wide.mean()) <= SIGMAS * spread, f"seed {SEED}, {degrees}: {integral.mean()}"
        assert (pdf > 0.0).all(), "a density of 0 means a mirror"


def test_an_upper_layer_of_index_1_is_not_there() -> None:
    one = Bsdf(load({"materials": described({"type": "diffuse", "reflectance": 0.7}, {"ior": 1.5}, {})}), 1)
    two = recoated(0.7, {"ior": 1.5}, {"ior": 1.0})
    for degrees in (0.0, 60.0):
        expected = one.eval(rows(at(degrees), VALUES), rows(at(30.0), VALUES), seed=SEED)[0][:, 0].mean()
        check(two.eval(rows(at(degrees), VALUES), rows(at(30.0), VALUES), seed=SEED + 1)[0][:, 0], expected, "value")


@pytest.mark.parametrize(
    ("lower", "upper"), [({}, {}), ({"roughness": 0.5}, {}), ({"roughness": 0.4}, {"roughness": 0.3})]
)
def test_strategies_agree(lower: dict[str, Any], upper: dict[str, Any]) -> None:
    """A plate under a lamp that it also mirrors."""
    measured = []
    for kind in [*({"type": "path", "strategy": s} for s in ("mis", "light", "bsdf")), {"type": "reference"}]:
        paint = described({"type": "diffuse", "reflectance": 0.8}, lower, {"ior": 1.3, **upper})
        lamp = {"type": "disk", "center": [0.5, 1, 0], "normal": [0, -1, 0], "radius": 0.7, "material": "lamp"}
        scene = accuray.Scene.from_dict(
            {
                "integrator": kind,
                "materials": {**paint, "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1}},
                "shapes": {
                    "plate": {"type": "disk", "normal": [0, 1, 0], "radius": 2, "material": "top"},
                    "lamp": lamp,
                },
            }
        )
        found = accuray.radiance(scene, [[1.0, 0.5, 0.2]] * 32, [[-1, -0.5, -0.1]] * 32, 256, space="xyz")
        measured.append((found.mean[:, 1].mean(), found.mean[:, 1].std(ddof=1) / math.sqrt(32)))
    truth, its_error = measured[0]
    for mean, error in measured[1:]:
        assert error < 0.06 * truth, "no power"
        assert abs(mean - truth) < 5.0 * math.hypot(error, its_error), (mean, truth, error)
