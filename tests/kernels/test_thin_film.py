"""Thin films against transfer matrices in double precision, and against what is known of soap, coatings and oxides.

The laws that all BSDFs keep (energy, reciprocity, densities) are tested with films in test_bsdf_list.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import accuray
from tests.kernels.support import SEED, WAVELENGTHS, Bsdf, FloatArray, bsdfs, load
from tests.kernels.test_fresnel import chance_of_reflection, directions

STACKS = 40
GREEN = 550.0
#: A film of n thickness units turns the phase by 2 pi thickness n / wavelength: what single precision makes of the
#: thickness shifts the fringes of a film of 50 um by as much as this.
PHASE_ERROR = 2e-3


def transfer_matrix(cosine: FloatArray, indices: list[complex], thickness: float, wavelength: float) -> FloatArray:
    """Reflectance of unpolarised light at a film, from the first medium; the matrices are those of the two interfaces
    and of the way between them, for the amplitudes that run forward and backward.
    """
    along = indices[0] ** 2 * (1.0 - cosine.astype(np.complex128) ** 2)
    w = [np.sqrt(n * n - along) for n in indices]
    w = [np.where(x.imag < 0.0, -x, x) for x in w]
    total = np.zeros(len(cosine))
    for scale in ([1.0, 1.0, 1.0], [n * n for n in indices]):
        q = [x / s for x, s in zip(w, scale, strict=True)]
        phase = np.exp(2j * np.pi * w[1] * thickness / wavelength)
        ahead, back = [0.5 * (1.0 + q[j + 1] / q[j]) for j in (0, 1)], [0.5 * (1.0 - q[j + 1] / q[j]) for j in (0, 1)]
        forward = ahead[0] * ahead[1] + back[0] * back[1] * phase**2
        backward = back[0] * ahead[1] + ahead[0] * back[1] * phase**2
        total += 0.5 * np.abs(backward / forward) ** 2
    return total


def filmed(material: dict[str, Any], thickness: float, index: float, wavelengths: list[float]) -> Bsdf:
    film = {"film_thickness": thickness, "film_ior": index}
    return Bsdf(load({"materials": {"m": material | film}}), 0, wavelengths)


def glass(ior: float, thickness: float, index: float, wavelength: float = GREEN) -> Bsdf:
    return filmed({"type": "dielectric", "ior": ior}, thickness, index, [wavelength] * 4)


def single(*values: float) -> list[float]:
    return [float(np.float32(v)) for v in values]


def at_normal(bsdf: Bsdf, side: float = 1.0) -> float:
    return float(chance_of_reflection(bsdf, np.array([[0.0, 0.0, side]]))[0])


@pytest.mark.parametrize("thickest", [100.0, 1500.0, 50_000.0])
def test_film_on_glass(thickest: float) -> None:
    """Random indices (films of less than their surroundings' too), thicknesses and wavelengths, from both sides."""
    rng = np.random.default_rng(SEED + int(thickest))
    for _ in range(STACKS):
        ior, index = single(*np.exp(rng.uniform(np.log(0.5), np.log(3.0), 2)))
        thickness, wavelength = single(rng.uniform(0.0, thickest), rng.uniform(360.0, 830.0))
        bsdf = glass(ior, thickness, index, wavelength)
        for side, (before, behind) in ((1.0, (1.0, ior)), (-1.0, (ior, 1.0))):
            wo = directions(side)
            cosine = np.abs(wo[:, 2])
            expected = transfer_matrix(cosine, [before, index, behind], thickness, wavelength)
            wrong = np.abs(chance_of_reflection(bsdf, wo) - expected)
            critical = np.sqrt(max(0.0, 1.0 - (behind / before) ** 2))
            clear = (np.abs(cosine - critical) > 1e-3) | (behind >= before)
            allowed = 2e-5 + PHASE_ERROR * thickness / 50_000.0
            assert wrong[clear].max() < allowed, f"seed {SEED}: {ior}, {index}, {thickness} nm, {wavelength} nm"


METALS = [(0.2, 3.5), (2.7, 3.4), (1.5, 0.0), (0.05, 0.4), (4.0, 1e-3), (0.0, 1.0)]


@pytest.mark.parametrize("metal", METALS, ids=str)
def test_film_on_metal(metal: tuple[float, float]) -> None:
    rng = np.random.default_rng(SEED)
    n = complex(*single(*metal))
    for thickest in (100.0, 1500.0, 50_000.0):
        for _ in range(8):
            (index,) = single(rng.uniform(0.7, 3.0))
            (thickness,) = single(rng.uniform(0.0, thickest))
            bsdf = filmed({"type": "conductor", "eta": metal[0], "k": metal[1]}, thickness, index, WAVELENGTHS)
            wo = directions(1.0)
            weight = bsdf.sample(wo, np.full((len(wo), 3), 0.5)).weight
            for lane, wavelength in enumerate(WAVELENGTHS):
                expected = transfer_matrix(wo[:, 2], [1.0, index, n], thickness, wavelength)
                allowed = 2e-5 + PHASE_ERROR * thickness / 50_000.0
                assert np.abs(weight[:, lane] - expected).max() < allowed, f"seed {SEED}: {index}, {thickness} nm"


def test_lanes_have_their_own_colours() -> None:
    """A lane's weight is its reflectance over the chance, the mean of the four; likewise for what passes."""
    bsdf = filmed({"type": "dielectric", "ior": 1.0}, 330.0, 1.33, WAVELENGTHS)
    wo = directions(1.0)[:80]
    exact = np.stack([transfer_matrix(wo[:, 2], [1.0, single(1.33)[0], 1.0], 330.0, w) for w in WAVELENGTHS], axis=1)
    mean = exact.mean(axis=1, keepdims=True)
    for number, expected in ((0.0, exact / mean), (1.0 - 2.0**-24, (1.0 - exact) / (1.0 - mean))):
        s = bsdf.sample(wo, np.full((len(wo), 3), number))
        assert np.allclose(s.weight, expected, atol=1e-4)


# --- What is known of films ---------------------------------------------------------------------------------------


def test_a_soap_film_that_is_about_to_burst_is_black() -> None:
    assert at_normal(glass(1.0, 1e-2, 1.33)) < 1e-6


def test_a_soap_film_follows_airys_formula() -> None:
    """Between equal media: R = 2 r^2 (1 - cos delta) / (1 + r^4 - 2 r^2 cos delta)."""
    index, r2 = 1.33, (0.33 / 2.33) ** 2
    for thickness in (50.0, 103.4, 206.8, 400.0, 777.0):
        delta = 4.0 * np.pi * index * thickness / GREEN
        expected = 2.0 * r2 * (1.0 - np.cos(delta)) / (1.0 + r2 * r2 - 2.0 * r2 * np.cos(delta))
        for side in (1.0, -1.0):
            assert at_normal(glass(1.0, thickness, index), side) == pytest.approx(expected, abs=2e-6)


def test_a_quarter_wave_of_the_right_index_reflects_nothing() -> None:
    index = np.sqrt(1.5)
    assert at_normal(glass(1.5, GREEN / (4.0 * index), index)) < 1e-6
    assert at_normal(glass(1.5, GREEN / (4.0 * index), index), -1.0) < 1e-6
    quarter = at_normal(glass(1.5, GREEN / (4.0 * 1.38), 1.38))
    assert quarter == pytest.approx(((1.5 - 1.38**2) / (1.5 + 1.38**2)) ** 2, abs=1e-6)


def test_half_a_wave_is_as_if_it_were_not_there() -> None:
    assert at_normal(glass(1.5, GREEN / (2.0 * 2.2), 2.2)) == pytest.approx(0.04, abs=1e-6)
    metal = {"type": "conductor", "eta": 0.2, "k": 3.5}
    wo, u = np.array([[0.0, 0.0, 1.0]]), np.full((1, 3), 0.5)
    coated = filmed(metal, GREEN / (2.0 * 2.2), 2.2, [GREEN] * 4).sample(wo, u).weight[0, 0]
    assert coated == pytest.approx(bsdfs([metal])[0].sample(wo, u).weight[0, 0], abs=1e-6)


def test_no_thickness_is_no_film() -> None:
    for material in ({"type": "dielectric", "ior": 1.5}, {"type": "conductor", "metal": "Ti", "roughness": 0.4}):
        bare, filmed_ = bsdfs([material, material | {"film_thickness": 0, "film_ior": 2.0}])
        wo, u = directions(1.0), np.random.default_rng(SEED).random((len(directions(1.0)), 3))
        assert np.array_equal(bare.sample(wo, u).weight, filmed_.sample(wo, u).weight)


def test_total_reflection_stays_total_and_leaks_through_a_gap() -> None:
    """Beyond the critical angle of glass to air no film helps; a thin gap between glass and glass leaks."""
    wo = directions(-1.0)
    total = np.abs(wo[:, 2]) < np.sqrt(1.0 - 1.0 / 1.5**2) - 1e-3
    assert (chance_of_reflection(glass(1.5, 300.0, 1.33), wo[total]) > 1.0 - 1e-6).all()
    gap = [chance_of_reflection(glass(1.0, thickness, 1.0 / 1.5), wo[total]) for thickness in (1.0, 100.0, 3000.0)]
    assert (gap[0] < 0.05).sum() > 20
    assert (gap[1] > gap[0]).all()
    assert (gap[2] > 0.999).sum() > 20


# --- What scenes say ----------------------------------------------------------------------------------------------


def test_thickness_has_a_unit() -> None:
    def material(thickness: object) -> Any:
        scene = {"materials": {"m": {"type": "dielectric", "film_thickness": thickness}}, "length_unit": "km"}
        return accuray.Scene.from_dict({"accuray": 1, **scene}).materials["m"]["film_thickness"]

    assert material(250) == material("250 nm") == material("0.25 um") == 2.5e-7
    with pytest.raises(accuray.SceneError, match=r"materials.m.film_thickness: .* allowed 0 to 100000 nm"):
        material("1 mm")


def test_a_texture_gives_the_thickness() -> None:
    """A texture's value times its scale, which has the unit too; the probe asks the middle of the picture."""
    oxide = {"type": "conductor", "metal": "Ti", "film_ior": 2.4}
    scene = {
        "textures": {"ramp": {"type": "image", "pixels": [[0.5]]}},
        "materials": {
            "a": oxide | {"film_thickness": {"texture": "ramp", "scale": 90}},
            "b": oxide | {"film_thickness": 45},
            "c": oxide | {"film_thickness": {"texture": "ramp", "scale": "0.09 um"}},
        },
    }
    core = load(scene)
    wo, u = directions(1.0), np.full((len(directions(1.0)), 3), 0.5)
    a, b, c = (Bsdf(core, i).sample(wo, u).weight for i in range(3))
    assert np.allclose(a, b, atol=1e-5)
    assert np.array_equal(a, c)


@pytest.mark.parametrize("tint", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("colour", [0.05, 0.6, 0.98])
def test_a_metal_given_by_its_colour_keeps_it_under_a_film(colour: float, tint: float) -> None:
    """A film of index 1 is none: along the normal the index that was found reflects the colour itself, and towards the
    edge the less the darker the tint is. A film of another index changes the colour.
    """
    metal = {"type": "conductor", "reflectance": colour, "edge_tint": tint}
    bare, clear, oil = bsdfs([metal, metal | {"film_thickness": 80, "film_ior": 1.0}, metal | {"film_thickness": 80}])
    u, normal = np.full((1, 3), 0.5), np.array([[0.0, 0.0, 1.0]])
    assert clear.sample(normal, u).weight[0] == pytest.approx(bare.sample(normal, u).weight[0], rel=1e-3)
    assert np.abs(oil.sample(normal, u).weight - bare.sample(normal, u).weight).max() > 1e-3
    edge = np.array([[np.sqrt(1.0 - 0.15**2), 0.0, 0.15]])
    darker = bsdfs([metal | {"film_thickness": 80, "film_ior": 1.0, "edge_tint": 0.0}])[0]
    assert (darker.sample(edge, u).weight <= clear.sample(edge, u).weight + 1e-6).all()
