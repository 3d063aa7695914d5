"""Fuzz against quadrature of its formula, and what its table says of it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from accuray._core import probe
from tests.kernels.support import SEED, Bsdf, FloatArray, bsdfs, uniform, unit

ROUGHNESSES = (0.0, 0.05, 0.11, 0.2, 0.37, 0.5, 0.73, 1.0)
COSINES = (0.02, 0.1, 0.3, 0.6, 0.95, 1.0)
#: Of interpolation in the table.
TABLE_ERROR = 0.012


def bare(wo: FloatArray, wi: FloatArray, alpha: float) -> FloatArray:
    """D V cos_i of the papers, for unit vectors (..., 3), by angles."""
    half = wo + wi
    angle = np.arctan2(np.hypot(half[..., 0], half[..., 1]), half[..., 2])
    density = (2.0 + 1.0 / alpha) * np.sin(angle) ** (1.0 / alpha) / (2.0 * np.pi)
    o, i = wo[..., 2], wi[..., 2]
    return np.asarray(density * i / (4.0 * (o + i - o * i)))


def hemisphere(side: int = 200) -> tuple[FloatArray, FloatArray]:
    """Directions (N, 3), and their solid angles (N,), finer towards the horizon."""
    t = (np.arange(side) + 0.5) / side
    cosine, phi = (a.ravel() for a in np.meshgrid(t * t, 2.0 * np.pi * t, indexing="ij"))
    sine = np.sqrt(1.0 - cosine * cosine)
    weight = np.repeat(2.0 * t, side) * 2.0 * np.pi / side**2
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=1), weight


def toward(cosine: float) -> FloatArray:
    return np.array([0.6 * np.sqrt(1.0 - cosine**2), 0.8 * np.sqrt(1.0 - cosine**2), cosine])


def sheen(roughness: float) -> Bsdf:
    return bsdfs([{"type": "sheen", "roughness": roughness}])[0]


@pytest.mark.parametrize("roughness", ROUGHNESSES)
def test_value_and_albedo(roughness: float) -> None:
    """The value is the papers' where they give back less than there was, and else divided by the larger albedo."""
    wi, weight = hemisphere()
    alpha = max(roughness, 0.05)
    grid = np.linspace(0.005, 1.0, 100) ** 2
    albedos = [float((bare(toward(c), wi, alpha) * weight).sum()) for c in grid]
    bsdf = sheen(roughness)
    for cosine in COSINES:
        wo = toward(cosine)
        value = bsdf.eval_one(wo, wi)[0][:, 0]
        paper = bare(wo, wi, alpha)
        most = np.maximum(np.interp(wi[:, 2], grid, albedos), float((paper * weight).sum()))
        expected = paper / np.maximum(most, 1.0)
        albedo = float((value * weight).sum())
        assert abs(albedo - float((expected * weight).sum())) < TABLE_ERROR, cosine
        assert albedo < 1.0 + 1e-3, cosine
        untouched = most < 1.0 - TABLE_ERROR
        assert np.allclose(value[untouched], paper[untouched], rtol=2e-4, atol=1e-6), cosine


def test_the_table_is_the_albedo() -> None:
    """`probe.sheen_albedo`, which layers read, is what the samples carry away."""
    for roughness in ROUGHNESSES:
        bsdf = sheen(roughness)
        for cosine in COSINES:
            s = bsdf.sample_one(toward(cosine), uniform(40_000, 3, SEED))
            error = float(s.weight[:, 0].std(ddof=1)) / 200.0
            known = probe.sheen_albedo(cosine, roughness)
            assert abs(float(s.weight[:, 0].mean()) - known) < TABLE_ERROR + 4.5 * error, (roughness, cosine)


def test_both_sides_are_alike_and_nothing_passes() -> None:
    wi, _ = hemisphere(40)
    wo = unit(0.3, 0.2, 0.8)
    bsdf = sheen(0.3)
    down = np.array([1.0, 1.0, -1.0])
    front, back = bsdf.eval_one(wo, wi)[0], bsdf.eval_one(wo * down, wi * down)[0]
    assert np.array_equal(front, back)
    assert (bsdf.eval_one(wo, wi * down)[0] == 0.0).all()
    s = bsdf.sample_one(wo, uniform(1000, 3, SEED))
    assert (s.wi[:, 2] > 0.0).all()


def test_an_edge_shines() -> None:
    for roughness in (0.1, 0.3, 0.6, 1.0):
        albedos = [probe.sheen_albedo(c, roughness) for c in np.linspace(0.02, 1.0, 30)]
        assert all(a >= b for a, b in pairwise(albedos)), roughness
        assert albedos[0] > 0.5
