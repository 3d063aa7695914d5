"""Rough surfaces against figures that were computed without the renderer (C3 of the physics tests), and their corners.

Every law that the list of BSDFs claims is tested in test_bsdf_list.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import accuray
from accuray.testing import eval_albedo
from tests.kernels.support import SEED, Bsdf, FloatArray, bsdfs, uniform, unit

FIGURES = Path(__file__).parents[1] / "verify" / "physics_expected.json"
ALPHAS = (0.1, 0.3, 0.5, 1.0)
COSINES = (1.0, 0.5, 0.1)
SAMPLES = 40_000


@cache
def figures() -> dict[str, Any]:
    return json.loads(FIGURES.read_text())  # type: ignore[no-any-return]


def toward(cosine: float, below: bool = False) -> FloatArray:
    """A direction at an angle to the normal that is in no plane of symmetry."""
    sine = math.sqrt(1.0 - cosine * cosine)
    return np.array([0.6 * sine, 0.8 * sine, -cosine if below else cosine])


def rough(kind: str, alpha: float, **more: Any) -> Bsdf:
    return bsdfs([{"type": kind, "roughness": math.sqrt(alpha), **more}])[0]


def albedo(bsdf: Bsdf, wo: FloatArray, transmitted: bool | None = None) -> tuple[float, float]:
    """Energy that samples carry away (on one side), and its standard error."""
    s = bsdf.sample_one(wo, uniform(SAMPLES, 3, SEED))
    energy = s.weight[:, 0] * s.eta_scale
    if transmitted is not None:
        energy = np.where(s.transmitted == transmitted, energy, 0.0)
    return float(energy.mean()), float(energy.std(ddof=1) / math.sqrt(SAMPLES))


@pytest.mark.parametrize("masking", ["correlated", "separable"])
@pytest.mark.parametrize("alpha", ALPHAS)
def test_metal_that_scatters_once(alpha: float, masking: str) -> None:
    bsdf = rough("conductor", alpha, metal="perfect", masking=masking, compensate=False)
    for cosine in COSINES:
        expected = figures()[f"ggx_F1_albedo_alpha{alpha:g}"][f"mu{cosine:g}_{masking[:4].rstrip('a')}"]
        mean, error = albedo(bsdf, toward(cosine))
        assert abs(mean - expected) <= 4.5 * error + 1e-4, cosine


@pytest.mark.parametrize("alpha", [0.3, 0.5, 1.0])
def test_the_value_has_the_same_albedo_as_the_samples(alpha: float) -> None:
    """`eval` integrated over all directions, without sampling."""
    bsdf = rough("conductor", alpha, metal="perfect", compensate=False)
    for cosine in COSINES:
        wo = toward(cosine)
        integral = eval_albedo(lambda wi, at=bsdf, o=wo: at.eval_one(o, wi)[0][:, 0], tolerance=1e-4)
        assert integral == pytest.approx(figures()[f"ggx_F1_albedo_alpha{alpha:g}"][f"mu{cosine:g}_corr"], abs=3e-4)


def test_a_flat_hemisphere_of_slopes_in_closed_form() -> None:
    mean, error = albedo(rough("conductor", 1.0, metal="perfect", compensate=False), toward(1.0))
    assert abs(mean - (1.0 - math.log(2.0))) <= 4.5 * error


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("alpha", ALPHAS)
def test_glass_that_scatters_once(alpha: float, inside: bool) -> None:
    """Reflected and transmitted energy apart, from both sides."""
    bsdf = rough("dielectric", alpha, ior=1.5, compensate=False)
    for cosine in COSINES:
        key = f"mu{cosine:g}_{'exit' if inside else 'enter'}_R_T_sum"
        for transmitted, expected in zip(
            (False, True, None), figures()[f"ggx_dielectric1.5_energy_alpha{alpha:g}"][key], strict=True
        ):
            mean, error = albedo(bsdf, toward(cosine, inside), transmitted)
            assert abs(mean - expected) <= 4.5 * error + 3e-4, (cosine, transmitted)


@pytest.mark.parametrize("alpha", [0.003, 0.03, *ALPHAS])
@pytest.mark.parametrize(
    "material",
    [
        {"type": "conductor", "metal": "perfect"},
        {"type": "conductor", "metal": "perfect", "masking": "separable"},
        {"type": "dielectric", "ior": 1.5},
        {"type": "dielectric", "ior": 2.4},
        {"type": "dielectric", "ior": 0.75},
        {"type": "dielectric", "ior": "SF11"},
    ],
    ids=lambda m: "-".join(str(v) for v in m.values()),
)
def test_compensated_facets_keep_all_energy(material: dict[str, Any], alpha: float) -> None:
    bsdf = bsdfs([material | {"roughness": math.sqrt(alpha)}])[0]
    for cosine in COSINES:
        for below in (False, True):
            mean, error = albedo(bsdf, toward(cosine, below))
            assert abs(mean - 1.0) <= 0.005 + 4.5 * error, (cosine, below)


def test_stretched_facets_have_the_slopes_that_they_say() -> None:
    """Half of the facets lie within the ellipse of the two alphas, and half of them nearer its one axis."""
    anisotropy, alpha = 0.6, 0.2
    bsdf = rough("conductor", alpha, metal="perfect", anisotropy=anisotropy, compensate=False)
    along = alpha * math.sqrt(2.0 / (1.0 + (1.0 - anisotropy) ** 2))
    s = bsdf.sample_one(unit(0, 0, 1), uniform(SAMPLES, 3, SEED))
    half = s.wi[s.succeeded] + np.array([0.0, 0.0, 1.0])
    slopes = half[:, :2] / half[:, 2:] / np.array([along, (1.0 - anisotropy) * along])
    # Facets steeper than 45 degrees fail: they are missing from the outer half.
    noise = 4.5 * 0.5 / math.sqrt(SAMPLES)
    assert abs(np.count_nonzero((slopes**2).sum(axis=1) < 1.0) / SAMPLES - 0.5) <= noise
    inner = slopes[(slopes**2).sum(axis=1) < 1.0]
    assert abs(np.mean(np.abs(inner[:, 0]) < np.abs(inner[:, 1])) - 0.5) <= 1.5 * noise


def test_hardly_rough_is_smooth() -> None:
    for kind in ("conductor", "dielectric"):
        more = {"metal": "Au"} if kind == "conductor" else {"ior": 1.5}
        almost, smooth = rough(kind, 0.0009, **more), rough(kind, 0.0, **more)
        wo, u = toward(0.4), uniform(100, 3, SEED)
        a, b = almost.sample_one(wo, u), smooth.sample_one(wo, u)
        assert a.specular.all()
        assert np.array_equal(a.weight, b.weight)
        assert np.array_equal(a.wi, b.wi)


# --- Metals by colour ---------------------------------------------------------------------------------------------


def test_edge_tint_sets_the_reflectance_at_82_degrees() -> None:
    base, tint = 0.6, 0.4
    plain, tinted = bsdfs(
        [{"type": "conductor", "reflectance": base}, {"type": "conductor", "reflectance": base, "edge_tint": tint}]
    )

    def reflectance(bsdf: Bsdf, cosine: float) -> float:
        return float(bsdf.sample_one(toward(cosine), uniform(1, 3, SEED)).weight[0, 0])

    schlick = base + (1.0 - base) * (6.0 / 7.0) ** 5
    assert reflectance(plain, 1.0 / 7.0) == pytest.approx(schlick, rel=1e-5)
    assert reflectance(tinted, 1.0 / 7.0) == pytest.approx(tint * schlick, rel=1e-5)
    for bsdf in (plain, tinted):
        assert reflectance(bsdf, 1.0) == pytest.approx(base, rel=1e-6)
        assert reflectance(bsdf, 1e-6) == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("extra", [{"eta": 1.0, "k": 2.0}, {"metal": "Au"}])
def test_a_metal_has_one_description(extra: dict[str, Any]) -> None:
    with pytest.raises(accuray.SceneError, match="exactly one of"):
        bsdfs([{"type": "conductor", "reflectance": 0.5, **extra}])


# --- Thin and matte -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("degrees", "expected"), [(0.0, 0.92307692), (45.0, 0.90432679), (60.0, 0.83623246), (75.0, 0.59609205)]
)
def test_a_pane_transmits_what_a_slab_does(degrees: float, expected: float) -> None:
    """By the figures of C4 for unpolarised interfaces; light goes straight on."""
    bsdf = bsdfs([{"type": "thin_dielectric", "ior": 1.5}])[0]
    for below in (False, True):
        wo = toward(math.cos(math.radians(degrees)), below)
        u = np.full((4096, 3), 0.5)
        u[:, 2] = (np.arange(4096) + 0.5) / 4096
        s = bsdf.sample_one(wo, u)
        transmitted = s.weight[s.transmitted, 0].sum() / 4096
        assert abs(transmitted - expected) <= 1.0 / 4096
        assert abs(s.weight[:, 0].mean() - 1.0) <= 1e-5
        assert np.allclose(s.wi[s.transmitted], -wo)
        assert (s.eta_scale == 1.0).all()


def fujii(wo: FloatArray, wi: FloatArray, roughness: float) -> FloatArray:
    """Value times pi of a white surface after one scattering: Oren and Nayar's model in Fujii's form, scaled as EON."""
    s = wi @ wo - wi[:, 2] * wo[2]
    t = np.where(s > 0.0, np.maximum(wi[:, 2], wo[2]), 1.0)
    return np.asarray((1.0 + roughness * s / t) / (1.0 + (0.5 - 2.0 / (3.0 * math.pi)) * roughness))


def hemisphere_mean(f: Callable[[FloatArray], FloatArray]) -> float:
    """Mean over cosine-weighted directions, by the midpoints of a grid."""
    u, v = ((np.arange(n) + 0.5) / n for n in (200, 400))
    square, phi = (a.ravel() for a in np.meshgrid(u, 2.0 * math.pi * v, indexing="ij"))
    r = np.sqrt(square)
    return float(np.mean(f(np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1.0 - square)], axis=1))))


@pytest.mark.parametrize("roughness", [0.3, 1.0])
def test_rough_matte_surfaces_lose_nothing_and_shine_as_published(roughness: float) -> None:
    """Albedo rho E + rho^2 M (1 - E) / (1 - rho (1 - M)), E and its mean M by quadrature of the single scattering."""
    rho = 0.7

    def once(cosine: float) -> float:
        o = toward(cosine)
        return hemisphere_mean(lambda wi: fujii(o, wi, roughness))

    nodes, weights = np.polynomial.legendre.leggauss(12)
    mean = sum(w * c * once(c) for c, w in zip(0.5 * (nodes + 1.0), weights, strict=True))
    white, grey = bsdfs([{"type": "diffuse", "reflectance": r, "roughness": roughness} for r in (1.0, rho)])
    for cosine in COSINES:
        wo = toward(cosine)
        share = once(cosine)
        expected = rho * share + rho**2 * mean * (1.0 - share) / (1.0 - rho * (1.0 - mean))
        for bsdf, value in ((white, 1.0), (grey, expected)):
            found = hemisphere_mean(lambda wi, at=bsdf, o=wo: at.eval_one(o, wi)[0][:, 0] * math.pi / wi[:, 2])
            assert found == pytest.approx(value, abs=2e-4), cosine


def test_a_smooth_matte_surface_is_lambert() -> None:
    plain, rough_one = bsdfs([{"type": "diffuse", "reflectance": 0.4, "roughness": r} for r in (0.0, 1e-6)])
    wo, wi = np.tile(toward(0.3), (500, 1)), np.abs(uniform(500, 3, SEED) + 0.01)
    wi /= np.linalg.norm(wi, axis=1, keepdims=True)
    value = plain.eval(wo, wi)[0]
    assert np.allclose(value[:, 0], 0.4 * wi[:, 2] / math.pi, rtol=1e-6)
    assert np.allclose(rough_one.eval(wo, wi)[0], value, rtol=1e-5)


# --- Dispersion ---------------------------------------------------------------------------------------------------


def frosted_pane(integrator: dict[str, Any]) -> dict[str, Any]:
    """A lamp seen through a rough pane of flint glass: both faces disperse."""
    glass = {"type": "dielectric", "ior": "SF11", "roughness": 0.4}
    return {
        "accuray": 1,
        "integrator": integrator,
        "materials": {"glass": glass, "lamp": {"type": "diffuse", "reflectance": 0.0, "emission": 1.0}},
        "shapes": {
            "front": {"type": "disk", "normal": [0, 0, 1], "radius": 9, "material": "glass"},
            "back": {"type": "disk", "center": [0, 0, -0.2], "normal": [0, 0, -1], "radius": 9, "material": "glass"},
            "lamp": {"type": "disk", "center": [0.4, 0, -1.5], "normal": [0, 0, 1], "radius": 0.5, "material": "lamp"},
        },
    }


def test_all_strategies_agree_on_dispersing_frosted_glass() -> None:
    """In colour: lights chosen at a rough face reach all wavelengths, directions chosen there only the hero."""
    results = []
    for integrator in (
        {"type": "reference", "max_depth": 4},
        {"type": "path", "max_depth": 4},
        {"type": "path", "max_depth": 4, "strategy": "light"},
        {"type": "path", "max_depth": 4, "strategy": "bsdf"},
    ):
        scene = accuray.Scene.from_dict(frosted_pane(integrator))
        rays = 64
        found = accuray.radiance(scene, [[0, 0, 1]] * rays, [[0.05, 0.02, -1]] * rays, 2048, seed=SEED, space="xyz")
        results.append((found.mean.mean(axis=0), found.mean.std(axis=0, ddof=1) / math.sqrt(rays)))
    truth, its_error = results[0]
    assert (its_error < 0.02 * truth).all()
    for mean, error in results[1:]:
        assert (np.abs(mean - truth) <= 4.5 * np.hypot(error, its_error)).all(), (mean, truth, error)
        assert (error < 0.02 * truth).all()
