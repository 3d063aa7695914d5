"""The chi-square test passes right samplers, fails planted errors, and its p-values are uniform."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from samplers import (
    FloatArray,
    cone_pdf,
    cone_sampler,
    cosine_pdf,
    cosine_sampler,
    ggx_reflection_pdf,
    ggx_reflection_sampler,
    spherical,
    uniform_pdf,
    uniform_sampler,
)

from accuray.testing import Plane, Sphere, chi2_test
from accuray.testing.chi2 import pearson
from accuray.testing.quadrature import cell_integrals

AXIS = np.array([0.48, 0.6, 0.64])
AXIS = AXIS / np.linalg.norm(AXIS)
NORMAL_VIEW = np.array([0.0, 0.0, 1.0])
GRAZING_VIEW = np.array([np.sin(np.radians(85.0)), 0.0, np.cos(np.radians(85.0))])


@pytest.mark.parametrize(
    ("sampler", "pdf"),
    [
        (cosine_sampler, cosine_pdf),
        (uniform_sampler, uniform_pdf),
        (partial(cone_sampler, AXIS, 0.8), partial(cone_pdf, AXIS, 0.8)),
        (partial(ggx_reflection_sampler, NORMAL_VIEW, 0.3), partial(ggx_reflection_pdf, NORMAL_VIEW, 0.3)),
        (partial(ggx_reflection_sampler, GRAZING_VIEW, 0.1), partial(ggx_reflection_pdf, GRAZING_VIEW, 0.1)),
        (partial(ggx_reflection_sampler, NORMAL_VIEW, 0.01), partial(ggx_reflection_pdf, NORMAL_VIEW, 0.01)),
    ],
    ids=["cosine", "uniform", "cone", "ggx", "ggx grazing", "ggx narrow"],
)
def test_right_samplers_pass(sampler, pdf) -> None:  # type: ignore[no-untyped-def]
    result = chi2_test(sampler, pdf, samples=300_000, tests=6, seed=1, resolution=(51, 102))
    assert result, result.reason
    assert result.pdf_total == pytest.approx(result.histogram_total, abs=0.005)


def lower_hemisphere(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    w, weights = cosine_sampler(u)
    return w * [1, 1, -1], weights


def without_cosine(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    return spherical(u[:, 0], 2 * np.pi * u[:, 1]), np.ones(len(u))


def slightly_lopsided(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Azimuth density 1 + 0.06 cos phi to first order: six percent more light on one side."""
    phi = 2 * np.pi * u[:, 1]
    return spherical(np.sqrt(u[:, 0]), phi - 0.06 * np.sin(phi)), np.ones(len(u))


@pytest.mark.parametrize(
    ("sampler", "pdf", "reason"),
    [
        (cosine_sampler, lambda w: 2 * cosine_pdf(w), "integrates to 2"),
        (cosine_sampler, lambda w: 0.5 * cosine_pdf(w), "p ="),
        (cosine_sampler, lambda w: np.where(w[:, 2] > 0, 0.5 / np.pi, 0.0), "p ="),
        (without_cosine, cosine_pdf, "p ="),
        (lower_hemisphere, cosine_pdf, "where the pdf is 0"),
        (slightly_lopsided, cosine_pdf, "p ="),
        (cosine_sampler, lambda w: 0.98 * cosine_pdf(w), "p ="),
        (lambda u: (cosine_sampler(u)[0], -np.ones(len(u))), cosine_pdf, "negative"),
        (lambda u: (cosine_sampler(u)[0], np.full(len(u), np.nan)), cosine_pdf, "not finite"),
        (lambda u: (cosine_sampler(u)[0] * np.inf, np.ones(len(u))), cosine_pdf, "not finite"),
        (lambda u: (cosine_sampler(u)[0], np.full(len(u), 1.5)), cosine_pdf, "histogram sums to 1.5"),
        (cosine_sampler, lambda w: cosine_pdf(w) / np.where(w[:, 2] > 0, 1.0, 0.0), "pdf is not finite"),
        (cosine_sampler, lambda w: w[:, 2] / np.pi, "pdf is negative"),
    ],
    ids=[
        "pdf x 2",
        "pdf / 2",
        "pdf lacks the cosine",
        "sampler lacks the cosine",
        "wrong hemisphere",
        "6 % lopsided",
        "pdf 2 % low",
        "negative weights",
        "nan weights",
        "infinite directions",
        "weights above one",
        "nan pdf",
        "negative pdf",
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_planted_errors_fail(sampler, pdf, reason: str) -> None:  # type: ignore[no-untyped-def]
    result = chi2_test(sampler, pdf, samples=300_000, seed=2, resolution=(25, 50))
    assert not result
    assert reason in result.reason


def test_p_values_are_uniform() -> None:
    stats = pytest.importorskip("scipy.stats")
    p_values = [
        chi2_test(cosine_sampler, cosine_pdf, samples=10_000, resolution=(7, 12), seed=s).p_value for s in range(200)
    ]
    assert stats.kstest(p_values, "uniform").pvalue > 1e-3


def test_failed_samples_are_one_more_cell() -> None:
    def half(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        w, weights = uniform_sampler(u)
        return w, weights * (w[:, 2] > 0)

    assert chi2_test(half, lambda w: np.where(w[:, 2] > 0, 0.25 / np.pi, 0.0), samples=100_000, resolution=(25, 50))
    assert not chi2_test(half, lambda w: np.where(w[:, 2] > 0, 0.5 / np.pi, 0.0), samples=100_000, resolution=(25, 50))


def test_narrow_light_needs_a_narrow_domain() -> None:
    cos_max = 1.0 - 1e-8
    sampler, pdf = partial(cone_sampler, AXIS, cos_max), partial(cone_pdf, AXIS, cos_max)
    window = Sphere(axis=tuple(AXIS), cos_min=1.0 - 2e-8)  # type: ignore[arg-type]
    assert chi2_test(sampler, pdf, samples=50_000, domain=window, resolution=(8, 16), stray=1e-2)
    assert not chi2_test(sampler, lambda w: 0.5 * pdf(w), samples=50_000, domain=window, resolution=(8, 16), stray=1e-2)


def test_one_cell_has_no_power() -> None:
    result = chi2_test(uniform_sampler, uniform_pdf, samples=1000, resolution=(1, 1))
    assert not result
    assert "no power" in result.reason


def test_plane_domain_for_filters() -> None:
    def tent(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        x = np.where(u < 0.5, np.sqrt(2 * u) - 1, 1 - np.sqrt(2 * (1 - u)))
        return x, np.ones(len(u))

    def density(x: FloatArray) -> FloatArray:
        return np.asarray(np.prod(np.maximum(0.0, 1.0 - np.abs(x)), axis=1))

    assert chi2_test(tent, density, domain=Plane((-1, 1), (-1, 1)), samples=200_000, resolution=(40, 40))
    line = Plane((-1, 1))
    assert chi2_test(tent, density, domain=line, samples=200_000, resolution=(100, 1), dimensions=1)
    assert not chi2_test(tent, lambda x: 0.5 * np.ones(len(x)), domain=line, resolution=(100, 1), dimensions=1)


def test_pooling_keeps_totals_and_minimum() -> None:
    expected = np.array([0.0, 1.0, 2.0, 3.0, 100.0, 50.0])
    observed = np.array([0.0, 2.0, 2.0, 2.0, 90.0, 60.0])
    statistic, dof = pearson(observed, expected)
    assert dof == 2
    assert statistic == pytest.approx(0.0 + 1.0 + 2.0)
    lonely = pearson(np.array([3.0, 97.0]), np.array([1.0, 99.0]))
    assert lonely == (0.0, 0)


def test_quadrature_of_a_broken_density() -> None:
    """A disk's indicator: the curved edge is found by refinement."""
    cells = cell_integrals(
        lambda p: (np.sum(p**2, axis=1) < 0.49).astype(np.float64), ((-1, 1), (-1, 1)), (10, 10), 1e-6, max_depth=10
    )
    assert cells.sum() == pytest.approx(0.49 * np.pi, rel=5e-4)


def test_quadrature_finds_a_peak_that_is_pointed_out() -> None:
    def peak(p: FloatArray) -> FloatArray:
        width = 0.01
        return np.asarray(np.exp(-0.5 * np.sum((p - 0.0131) ** 2, axis=1) / width**2) / (2 * np.pi * width**2))

    missed = cell_integrals(peak, ((-1, 1), (-1, 1)), (1, 1), 1e-6)
    found = cell_integrals(peak, ((-1, 1), (-1, 1)), (1, 1), 1e-6, suspects=np.ones((1, 1), dtype=bool), forced_depth=8)
    assert missed.sum() < 0.5
    assert found.sum() == pytest.approx(1.0, rel=1e-5)
