"""Fresnel reflectances of the smooth BSDFs against complex arithmetic in double precision, up to grazing incidence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from accuray import data
from tests.kernels.support import SEED, WAVELENGTHS, Bsdf, FloatArray, bsdfs

#: From the normal to 0.06 deg above the surface, evenly in angle and in the cosine.
ANGLES = np.concatenate([np.radians(np.linspace(0.0, 89.0, 90)), np.arccos(np.geomspace(1e-3, 0.02, 20))])


def directions(side: float) -> FloatArray:
    phi = np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, len(ANGLES))
    sine = np.sin(ANGLES)
    return (
        np.stack([sine * np.cos(phi), sine * np.sin(phi), side * np.cos(ANGLES)], axis=1)
        .astype(np.float32)
        .astype(float)
    )


def exact(cosine: FloatArray, index: Any) -> FloatArray:
    """Reflectance of unpolarised light; `index` beyond the interface over that before it, complex for a metal."""
    n = np.asarray(index, dtype=np.complex128)
    beyond = np.sqrt(n * n - (1.0 - cosine * cosine))
    beyond = np.where(beyond.imag < 0, -beyond, beyond)
    s = (cosine - beyond) / (cosine + beyond)
    p = (n * n * cosine - beyond) / (n * n * cosine + beyond)
    return np.asarray(0.5 * (np.abs(s) ** 2 + np.abs(p) ** 2))


def chance_of_reflection(bsdf: Bsdf, wo: FloatArray) -> FloatArray:
    """The number below which the lobe is a reflection, by bisection: the reflectance where all lanes have the same."""
    low, high = np.zeros(len(wo)), np.ones(len(wo))
    for _ in range(24):
        middle = 0.5 * (low + high)
        u = np.stack([np.full(len(wo), 0.5), np.full(len(wo), 0.5), np.minimum(middle, 1.0 - 2.0**-24)], axis=1)
        reflected = ~bsdf.sample(wo, u).transmitted
        low, high = np.where(reflected, middle, low), np.where(reflected, high, middle)
    return np.asarray(low)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("ior", [1.0, 1.0003, 1.333, 1.5, 2.417, 0.75, 4.0])
def test_dielectric(ior: float, side: float) -> None:
    wo = directions(side)
    cosine = np.abs(wo[:, 2])
    eta = ior if side > 0 else 1.0 / ior
    bsdf = bsdfs([{"type": "dielectric", "ior": ior}])[0]
    wrong = np.abs(chance_of_reflection(bsdf, wo) - exact(cosine, eta))
    # Next to the critical angle the reflectance rises without bound: an ulp of the cosine moves it.
    critical = np.sqrt(max(0.0, 1.0 - eta * eta)) if eta < 1.0 else -1.0
    clear = np.abs(cosine - critical) > 1e-3
    # Just above the surface the cosine beyond it has lost digits where the index is next to 1.
    assert wrong[clear].max() < 1e-4, np.degrees(ANGLES[clear][np.argmax(wrong[clear])])


def test_refraction_follows_snell_and_carries_the_rest() -> None:
    for ior in (1.333, 1.5, 2.417):
        bsdf = bsdfs([{"type": "dielectric", "ior": ior}])[0]
        for side in (1.0, -1.0):
            wo = directions(side)
            eta = ior if side > 0 else 1.0 / ior
            s = bsdf.sample(wo, np.full((len(wo), 3), 1.0 - 2.0**-24))
            through = s.transmitted
            assert np.abs(s.wi[through, :2] * eta + wo[through, :2]).max() < 1e-6
            assert (np.sign(s.wi[through, 2]) == -side).all()
            assert np.allclose(s.weight[through, 0] * s.eta_scale[through], 1.0, rtol=1e-5)
            assert np.allclose(s.eta_scale[through], eta * eta, rtol=1e-6)
            assert np.allclose(np.linalg.norm(s.wi[through], axis=1), 1.0, atol=2e-6)


METALS: list[dict[str, Any]] = [
    {"metal": "Au"},
    {"metal": "Ag"},
    {"metal": "Al"},
    {"metal": "Cu"},
    {"eta": 1.5, "k": 0.0},
]
METALS += [{"eta": 0.02, "k": 5.0}, {"eta": 3.5, "k": 4.2}, {"eta": 0.2, "k": 0.0}]


@pytest.mark.parametrize("values", METALS, ids=str)
def test_conductor(values: dict[str, Any]) -> None:
    wo = directions(1.0)
    s = bsdfs([{"type": "conductor", **values}])[0].sample(wo, np.full((len(wo), 3), 0.5))
    for lane, wavelength in enumerate(WAVELENGTHS):
        if "metal" in values:
            metal = data.metals()[values["metal"]]
            n = complex(*(np.interp(wavelength, metal.wavelengths, x) for x in (metal.n, metal.k)))
        else:
            n = complex(values["eta"], values["k"])
        assert np.allclose(s.weight[:, lane], exact(wo[:, 2], n), atol=1e-5)
    assert np.array_equal(s.wi, wo * [-1.0, -1.0, 1.0])
