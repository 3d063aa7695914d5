"""Error bars: the estimator, its calibration on known distributions, Student's t, and the relative error."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy import stats

from accuray.film import Film, Image, ImageError, pixel_estimates, region_estimate, relative_error, student_t

FilmMaker = Callable[..., Film]
STEP = 2.0**-24


def normal_film(
    rng: np.random.Generator,
    size: tuple[int, int],
    spp: int,
    *,
    mean: float = 0.4,
    sigma: float = 1.0,
    replicates: int = 4,
) -> Film:
    """Samples from a normal distribution, drawn as the sums of each replicate."""
    film = Film.empty(*size, replicates=replicates, step=STEP)
    for r in range(replicates):
        count = len(range(r, spp, replicates))
        drawn = rng.normal(mean * count, sigma * math.sqrt(count), size=(*film.shape, 4))
        film.sums[:, :, r] = np.rint(drawn / STEP)
    film.cover(0, spp)
    return film


def test_equal_counts_give_the_standard_error_of_r_means(make_film: FilmMaker) -> None:
    film = make_film(0, 16)
    means = film.sums[..., :3] * STEP / 4
    mean, error = pixel_estimates(film)
    assert np.allclose(mean, means.mean(axis=2), rtol=1e-14)
    assert np.allclose(error, means.std(axis=2, ddof=1) / 2, rtol=1e-12)


def test_rgb_errors_come_from_rgb_replicates(make_film: FilmMaker) -> None:
    image = Image(make_film(0, 16), {"white_balance": [1.1, 1.0, 0.4]})
    means = image.film.sums[..., :3] * STEP / 4 @ np.array(image.colour_matrix).T
    assert np.allclose(image.error, means.std(axis=2, ddof=1) / 2, rtol=1e-6)


@pytest.mark.parametrize("spp", [5, 6, 7, 18])
def test_unequal_counts_give_an_unbiased_variance(spp: int) -> None:
    film = normal_film(np.random.default_rng(spp), (200, 200), spp)
    variance = np.square(pixel_estimates(film)[1])
    # The estimate of one value has a relative deviation of about sqrt(2 / 3); 120 000 values are averaged.
    assert variance.mean() * spp == pytest.approx(1.0, abs=4 * math.sqrt(2 / 3 / variance.size))


@pytest.mark.parametrize("replicates", [2, 4, 8])
def test_intervals_of_pixels_and_regions_cover_the_truth(replicates: int) -> None:
    """95 % intervals over 2000 images each, both of one pixel and of 5 x 4 pixels."""
    rng = np.random.default_rng(5)
    covered = {1: 0, 20: 0}
    trials = 2000 // 20
    for _ in range(trials):
        film = normal_film(rng, (20, 5), 32, replicates=replicates)
        for area in [(5 * k, 5 * k + 5, y, y + 4) for k in range(4) for y in (0,)]:
            for pixels, box in ((20, area), (1, (area[0], area[0] + 1, 4, 5))):
                result = region_estimate(film, *box)
                assert result.pixels == pixels
                assert result.dof == pixels * (replicates - 1)
                covered[pixels] += sum(low <= 0.4 <= high for low, high in zip(result.low, result.high, strict=True))
    for count in covered.values():
        total = trials * 4 * 3
        assert abs(count / total - 0.95) < 4 * math.sqrt(0.95 * 0.05 / total)


def test_a_region_sums_the_variances_of_its_pixels(make_film: FilmMaker) -> None:
    film = make_film(0, 8)
    mean, error = pixel_estimates(film)
    result = region_estimate(film, 2, 7, 3, 6, confidence=0.9)
    assert np.allclose(result.mean, mean[3:6, 2:7].mean(axis=(0, 1)), rtol=1e-12)
    assert np.allclose(result.error, np.sqrt(np.square(error[3:6, 2:7]).sum(axis=(0, 1))) / 15, rtol=1e-12)
    half = stats.t.ppf(0.95, 45) * np.array(result.error)
    assert np.allclose(np.array(result.high) - result.mean, half, rtol=1e-9)
    assert np.allclose(np.array(result.mean) - result.low, half, rtol=1e-9)
    assert result.note == ""


def test_region_uses_coordinates_of_the_full_image(make_film: FilmMaker) -> None:
    crop = make_film(0, 8, window=(5, 4, 30, 20))
    assert region_estimate(crop, 6, 9, 7, 9) == region_estimate(make_film(0, 8), 6, 9, 7, 9)
    for box in ((4, 9, 7, 9), (6, 31, 7, 9), (6, 6, 7, 9), (6, 9, 9, 7), (6, 9, 3, 9), (6, 9, 7, 21)):
        with pytest.raises(ImageError, match="region"):
            region_estimate(crop, *box)


def test_what_is_not_known_is_infinite_and_noted(make_film: FilmMaker) -> None:
    for film in (make_film(0, 3), make_film(0, 8, replicates=1)):
        assert np.isinf(pixel_estimates(film)[1]).all()
        result = region_estimate(film, 0, 5, 0, 5)
        assert result.low == (-math.inf,) * 3
        assert result.high == (math.inf,) * 3
        assert result.note
        assert relative_error(*pixel_estimates(film)) == math.inf


def test_uneven_counts_are_noted(make_film: FilmMaker) -> None:
    assert "no multiple of the 4 replicates" in region_estimate(make_film(0, 9), 0, 5, 0, 5).note


@pytest.mark.parametrize("confidence", [0.5, 0.683, 0.9, 0.95, 0.99, 0.995, 0.9999])
def test_student_t_agrees_with_scipy(confidence: float) -> None:
    for dof in [*range(1, 40), 99, 100, 199, 200, 201, 202, 500, 5000, 196608, 10**8]:
        assert student_t(confidence, dof) == pytest.approx(stats.t.ppf(0.5 + confidence / 2, dof), rel=1e-9)


@pytest.mark.parametrize(("confidence", "dof"), [(0.0, 3), (1.0, 3), (math.nan, 3), (0.95, 0)])
def test_student_t_refuses_nonsense(confidence: float, dof: int) -> None:
    with pytest.raises(ValueError, match=r"confidence|degrees"):
        student_t(confidence, dof)


def test_relative_error_estimates_the_true_one() -> None:
    """Over films of one truth, the mean square of the estimate equals that of the true relative error."""
    rng = np.random.default_rng(11)
    truth, estimates, trues = 0.4, [], []
    for _ in range(40):
        mean, error = pixel_estimates(normal_film(rng, (16, 16), 4096, mean=truth))
        estimates.append(relative_error(mean, error) ** 2)
        trues.append(np.mean((mean - truth) ** 2 / (truth**2 + 0.01 * truth**2)))
    assert np.mean(estimates) == pytest.approx(np.mean(trues), rel=0.05)


def test_relative_error_of_simple_images() -> None:
    assert relative_error(np.full((2, 2, 3), 2.0), np.full((2, 2, 3), 0.1)) == pytest.approx(0.05 / math.sqrt(1.01))
    assert relative_error(np.zeros((2, 2, 3)), np.zeros((2, 2, 3))) == 0.0
    assert relative_error(np.zeros((2, 2, 3)), np.ones((2, 2, 3))) == math.inf
    half_known = np.full((1, 2, 3), 0.1)
    half_known[0, 0] = math.inf
    assert relative_error(np.full((1, 2, 3), 2.0), half_known) == pytest.approx(0.05 / math.sqrt(1.01))
