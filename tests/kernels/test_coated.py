"""Coats: known answers of plastics, varnished metals, slabs and absorbing layers, and scenes by every strategy.

Every layer reflects unpolarised light as (Rs + Rp) / 2 at each interface, so stacks are geometric series of these.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import accuray
from accuray.verify import optics
from tests.kernels.support import SEED, Bsdf, FloatArray, bsdfs, rows, uniform, unit

COUNT = 100_000
VALUES = 25_000
SIGMAS = 4.5
ANGLES = (0.0, 45.0, 80.0)


def coated(base: dict[str, Any], **layer: Any) -> Bsdf:
    return bsdfs([{"type": "coated", "base": base, **layer}])[0]


def at(degrees: float, below: bool = False) -> FloatArray:
    theta = math.radians(degrees)
    return unit(math.sin(theta), 0.0, -math.cos(theta) if below else math.cos(theta))


def check(values: FloatArray, expected: float, what: str, tolerance: float = 0.0) -> None:
    """Independent estimates have the expected mean, with an error of at most 2 %, or 0.0004 of what is small."""
    error = float(values.std(ddof=1) / math.sqrt(len(values)))
    assert error <= 0.02 * max(expected, 0.02), f"{what}: no power"
    difference = float(values.mean()) - expected
    allowed = SIGMAS * error + 1e-5 * expected + tolerance
    assert abs(difference) <= allowed, f"seed {SEED}, {what}: {values.mean():.6g} +- {error:.2g}, not {expected:.6g}"


def shares(bsdf: Bsdf, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Energy of each sample by the side that it goes to: reflected (N,) and transmitted (N,), 545 nm."""
    s = bsdf.sample_one(wo, uniform(COUNT, 3, SEED))
    energy = s.weight[:, 0] * s.eta_scale
    return np.where(s.transmitted, 0.0, energy), np.where(s.transmitted, energy, 0.0)


def refracted(theta: float, index: float) -> float:
    return math.asin(math.sin(theta) / index)


# --- Plastic: a smooth layer on Lambert's law -----------------------------------------------------------------------


def plastic(theta_o: float, theta_i: float, albedo: float, index: float) -> float:
    """Value f cos(theta_i): light refracted in, reflected under the interface any number of times, refracted out."""
    through = (1.0 - optics.fresnel(theta_o, index)) * (1.0 - optics.fresnel(theta_i, index)) / index**2
    series = albedo / (1.0 - albedo * optics.diffuse_reflectance_inside(index))
    return through * series * math.cos(theta_i) / math.pi


@pytest.mark.parametrize("albedo", [0.2, 0.8, 1.0])
@pytest.mark.parametrize("index", [1.5, 1.2])
def test_plastic(albedo: float, index: float) -> None:
    bsdf = coated({"type": "diffuse", "reflectance": albedo}, ior=index)
    for i, degrees in enumerate(ANGLES):
        theta, wo = math.radians(degrees), at(degrees)
        for other in (10.0, 70.0):
            value = bsdf.eval(rows(wo, VALUES), rows(at(other), VALUES), seed=SEED + i)[0][:, 0]
            check(value, plastic(theta, math.radians(other), albedo, index), f"value at {degrees}, {other}")
        reflected = optics.fresnel(theta, index)
        below = (1.0 - reflected) * (1.0 - optics.diffuse_reflectance_inside(index)) * albedo
        below /= 1.0 - albedo * optics.diffuse_reflectance_inside(index)
        check(shares(bsdf, wo)[0], reflected + below, f"albedo at {degrees}")


def test_an_absorbing_layer_on_plastic() -> None:
    """To lowest order in the albedo the light crosses the layer twice, on ways of 1 / cosine."""
    albedo, share = 1e-3, 0.3
    bsdf = coated({"type": "diffuse", "reflectance": albedo}, transmission_color=share)
    for degrees in ANGLES:
        ways = sum(1.0 / math.cos(refracted(math.radians(a), 1.5)) for a in (degrees, 30.0))
        expected = plastic(math.radians(degrees), math.radians(30.0), albedo, 1.5) * share**ways
        value = bsdf.eval(rows(at(degrees), VALUES), rows(at(30.0), VALUES), seed=SEED)[0][:, 0]
        check(value, expected, f"{degrees} degrees", tolerance=albedo * expected)


# --- Stacks of smooth interfaces ------------------------------------------------------------------------------------


def stack(first: float, second: float, share: float = 1.0) -> tuple[float, float]:
    """Reflectance and transmittance of two interfaces of these reflectances and the layer between them."""
    series = 1.0 / (1.0 - first * second * share**2)
    return first + (1.0 - first) ** 2 * share**2 * second * series, (1.0 - first) * (1.0 - second) * share * series


@pytest.mark.parametrize("share", [1.0, 0.6])
@pytest.mark.parametrize(("layer", "body"), [(1.33, 1.8), (1.5, 1.2), (2.0, 1.0)])
def test_a_coat_on_glass(layer: float, body: float, share: float) -> None:
    """From both sides; a body of index 1 makes the layer a slab: 2 R / (1 + R) where it is clear."""
    bsdf = coated({"type": "dielectric", "ior": body}, ior=layer, transmission_color=share)
    for degrees in ANGLES:
        for below in (False, True):
            outside = math.radians(degrees) if not below else math.asin(min(math.sin(math.radians(degrees)) * body, 1))
            if below and math.sin(math.radians(degrees)) * body >= 1.0:
                continue
            inside = refracted(outside, layer)
            first, second = optics.fresnel(outside, layer), optics.fresnel(inside, body / layer)
            left = share ** (1.0 / math.cos(inside))
            r, t = stack(second, first, left) if below else stack(first, second, left)
            reflected, transmitted = shares(bsdf, at(degrees, below))
            check(reflected, r, f"reflectance at {degrees}, below: {below}", tolerance=2e-6)
            check(transmitted, t, f"transmittance at {degrees}, below: {below}", tolerance=2e-6)
            if body == 1.0 and share == 1.0:
                assert r == pytest.approx(2.0 * first / (1.0 + first))


def test_a_coat_on_a_pane() -> None:
    """Three interfaces; what passes goes straight on, because both sides of the pane are air."""
    layer, pane = 1.3, 1.7
    bsdf = coated({"type": "thin_dielectric", "ior": pane}, ior=layer)
    for degrees in ANGLES:
        outside = math.radians(degrees)
        first = optics.fresnel(outside, layer)
        second = optics.fresnel(refracted(outside, layer), pane / layer)
        third = optics.fresnel(outside, pane)
        r, t = stack(first, stack(second, third)[0])
        for below in (False, True):
            reflected, transmitted = shares(bsdf, at(degrees, below))
            check(reflected, r, f"reflectance at {degrees}, below: {below}", tolerance=2e-6)
            check(transmitted, t, f"transmittance at {degrees}, below: {below}", tolerance=2e-6)
            s = bsdf.sample_one(at(degrees, below), uniform(1000, 3, SEED))
            assert np.abs(s.wi[s.transmitted] + at(degrees, below)).max() < 1e-5


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_a_varnished_metal(share: float) -> None:
    """The metal's reflectance is that of its index relative to the layer's; its back has no layer."""
    eta, k, layer = 0.4, 2.5, 1.5
    bsdf = coated({"type": "conductor", "eta": eta, "k": k}, ior=layer, transmission_color=share)
    for degrees in ANGLES:
        inside = refracted(math.radians(degrees), layer)
        second = optics.fresnel(inside, complex(eta, k) / layer)
        left = share ** (1.0 / math.cos(inside))
        r, _ = stack(optics.fresnel(math.radians(degrees), layer), second, left)
        check(shares(bsdf, at(degrees))[0], r, f"{degrees} degrees", tolerance=2e-6)
        bare = optics.fresnel(math.radians(degrees), complex(eta, k))
        assert shares(bsdf, at(degrees, below=True))[0][0] == pytest.approx(bare, rel=1e-5)


def test_a_layer_of_index_1_is_not_there() -> None:
    for base in ({"type": "diffuse", "reflectance": 0.7}, {"type": "conductor", "metal": "Cu", "roughness": 0.4}):
        with_it, without = coated(base, ior=1.0), bsdfs([base])[0]
        wo, wi = at(30.0), at(50.0)
        assert with_it.eval_one(wo, rows(wi, 1))[0] == pytest.approx(without.eval_one(wo, rows(wi, 1))[0], rel=1e-4)


# --- In scenes ------------------------------------------------------------------------------------------------------


def lit_plate(integrator: dict[str, Any], base: dict[str, Any], layer: dict[str, Any]) -> accuray.Scene:
    """A coated disk under a lamp, which it also mirrors."""
    return accuray.Scene.from_dict(
        {
            "integrator": integrator,
            "materials": {
                "base": base,
                "varnish": {"type": "coated", "base": "base", **layer},
                "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1},
            },
            "shapes": {
                "plate": {"type": "disk", "normal": [0, 1, 0], "radius": 2, "material": "varnish"},
                "lamp": {
                    "type": "disk",
                    "center": [0.5, 1, 0],
                    "normal": [0, -1, 0],
                    "radius": 0.7,
                    "material": "lamp",
                },
            },
        }
    )


@pytest.mark.parametrize(
    ("base", "layer"),
    [
        ({"type": "diffuse", "reflectance": 0.8}, {}),
        ({"type": "diffuse", "reflectance": 0.8}, {"roughness": 0.4}),
        (
            {"type": "conductor", "metal": "Cu", "roughness": 0.4},
            {"roughness": 0.3, "transmission_color": [0.9, 0.5, 0.2]},
        ),
    ],
    ids=["plastic", "satin plastic", "lacquered copper"],
)
def test_strategies_agree(base: dict[str, Any], layer: dict[str, Any]) -> None:
    kinds: list[dict[str, Any]] = [{"type": "path", "strategy": s} for s in ("mis", "light", "bsdf")]
    measured = []
    for kind in [*kinds, {"type": "reference"}]:
        found = accuray.radiance(
            lit_plate(kind, base, layer), [[1.0, 0.5, 0.2]] * 32, [[-1, -0.5, -0.1]] * 32, 512, space="xyz"
        )
        values = found.mean[:, 1]
        measured.append((values.mean(), values.std(ddof=1) / math.sqrt(32)))
    truth, its_error = measured[0]
    for mean, error in measured[1:]:
        assert error < 0.04 * truth, "no power"
        assert abs(mean - truth) < 5.0 * math.hypot(error, its_error), (mean, truth, error)


def test_coated_bodies_absorb_inside() -> None:
    """A furnace seen through a coated ball of coloured glass: the body is the base's."""
    glass = {"type": "dielectric", "ior": 1.2, "transmission_color": 0.5, "transmission_depth": 2.0}
    scene = accuray.Scene.from_dict(
        {
            "materials": {"glass": glass, "dipped": {"type": "coated", "base": "glass", "ior": 1.4}},
            "shapes": {"ball": {"type": "sphere", "material": "dipped"}},
            "lights": {"sky": {"type": "constant"}},
        }
    )
    found = accuray.radiance(scene, [[0, 0, 5]] * 32, [[0, 0, -1]] * 32, 2048, wavelengths=[550.0])
    r, t = stack(optics.fresnel(0.0, 1.4), optics.fresnel(0.0, 1.2 / 1.4))
    expected = r + t**2 * 0.5 / (1.0 - r * 0.5)
    check(found.mean[:, 0], expected, "straight through")
