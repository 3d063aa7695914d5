"""Energy, agreement of sample and eval, and reciprocity: right models pass, planted errors fail."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from samplers import FloatArray, cosine_pdf, ggx_reflection_pdf, ggx_reflection_sampler

from accuray.testing import (
    albedo,
    albedo_test,
    energy_test,
    eval_albedo,
    random_directions,
    reciprocity_error,
    white_furnace,
)

WO = np.array([np.sin(1.0), 0.0, np.cos(1.0)])


def ggx_eval(alpha: float, wi: FloatArray) -> FloatArray:
    """GGX reflection with F = 1, without shadowing, times the cosine: D / (4 cos_o)."""
    return np.asarray(ggx_reflection_pdf(WO, alpha, wi) * ggx_weight(wi))


def ggx_weight(wi: FloatArray) -> FloatArray:
    """Ratio of eval and pdf of the model above: (h . wo) / (cos_o cos_h)."""
    h = wi + WO
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    return np.asarray(np.abs(h @ WO) / (WO[2] * np.maximum(h[:, 2], 1e-12)))


def test_diffuse_albedo() -> None:
    assert albedo_test(lambda u: np.full(len(u), 0.7), 0.7)
    assert energy_test(lambda u: np.ones(len(u)))
    assert not energy_test(lambda u: np.full(len(u), 1.001))
    assert eval_albedo(lambda w: 0.7 * cosine_pdf(w)) == pytest.approx(0.7, rel=1e-5)


@pytest.mark.parametrize("alpha", [0.1, 0.4])
def test_sample_and_eval_agree(alpha: float) -> None:
    def weights(u: FloatArray) -> FloatArray:
        wi, valid = ggx_reflection_sampler(WO, alpha, u)
        return np.asarray(np.where(valid > 0, ggx_weight(np.where(valid[:, None] > 0, wi, WO)), 0.0))

    expected = eval_albedo(partial(ggx_eval, alpha))
    result = albedo_test(weights, expected, samples=200_000, tolerance=1e-4)
    assert result, result.reason
    assert not albedo_test(lambda u: 1.02 * weights(u), expected, samples=200_000, tolerance=1e-4)


def test_noise_is_allowed_for_but_not_energy() -> None:
    def unit_mean(u: FloatArray) -> FloatArray:
        return -np.log1p(-u[:, 0])

    assert energy_test(unit_mean, samples=100_000)
    assert not energy_test(lambda u: 1.05 * unit_mean(u), samples=100_000)
    estimate = albedo(unit_mean)
    assert estimate.error == pytest.approx(1 / np.sqrt(estimate.count), rel=0.05)


def test_weights_that_are_not_finite_are_refused() -> None:
    with pytest.raises(ValueError, match="not finite"):
        albedo(lambda u: u[:, 0] * np.nan)


def test_reciprocity() -> None:
    def lambert(wo: FloatArray, wi: FloatArray) -> FloatArray:
        return np.where(wo[:, 2] * wi[:, 2] > 0, 0.5 / np.pi, 0.0)

    def one_sided(wo: FloatArray, wi: FloatArray) -> FloatArray:
        return lambert(wo, wi) * (1 + 0.1 * wi[:, 2])

    def transmission(wo: FloatArray, wi: FloatArray) -> FloatArray:
        """Diffuse transmission into glass of index 1.5: f(wo, wi) carries the square of the index on wo's side."""
        return np.where(wo[:, 2] * wi[:, 2] < 0, np.where(wo[:, 2] > 0, 1.0, 1.5**2), 0.0)

    assert reciprocity_error(lambert) <= 1e-12
    assert reciprocity_error(one_sided) > 0.05
    assert reciprocity_error(transmission, eta=1.5) <= 1e-12
    assert reciprocity_error(transmission, eta=1.0) > 0.5
    assert np.isinf(reciprocity_error(lambda wo, wi: wo[:, 2] * np.nan))


def test_white_furnace_image() -> None:
    rng = np.random.default_rng(3)
    image = rng.normal(1.0, 0.01, (32, 32))
    assert white_furnace(image, 0.01)
    assert not white_furnace(image * 0.99, 0.01)
    bright = image.copy()
    bright[5, 5] = 1.2
    assert not white_furnace(bright, 0.01)
    assert not white_furnace(np.full((4, 4), np.nan), 0.01)


def test_random_directions() -> None:
    w = random_directions(1000, 0, upper=True)
    assert np.allclose(np.linalg.norm(w, axis=1), 1.0)
    assert (w[:, 2] >= 0).all()
