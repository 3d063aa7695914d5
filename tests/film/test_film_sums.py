"""Films: counts, means, validation, and the precision of 64-bit fixed point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from accuray.film import Film, ImageError

FilmMaker = Callable[..., Film]
STEP = 2.0**-24


def test_counts_leave_dropped_samples_out(make_film: FilmMaker) -> None:
    film = make_film(3, 13, dropped=True)
    assert film.dropped_total > 0
    assert film.counts().dtype == np.uint64
    residues = [sum(i % 4 == r for i in range(3, 13)) for r in range(4)]
    expected = np.array(residues) - film.dropped.astype(int)
    assert np.array_equal(film.counts(), expected)
    assert np.array_equal(film.samples(), expected.sum(axis=2))
    assert np.array_equal(film.samples(), film.sums[..., 3].sum(axis=2) >> 24)


def test_counts_follow_masks(make_film: FilmMaker) -> None:
    mask = np.array([[True, False, False], [False, True, True]])
    film = make_film(0, 8, mask=mask)
    film.cover(8, 10, ~mask)
    samples = film.samples()
    assert samples[0, 0] == 8
    assert samples[0, 16] == 2
    assert samples[20, 36] == 8
    assert samples[16, 15] == 2


def test_counts_beyond_32_bits_are_exact() -> None:
    film = Film.empty(2, 2)
    film.cover(0, 2**40)
    film.cover(2**40, 2**40 + 3)
    assert film.samples().tolist() == [[2**40 + 3] * 2] * 2


def test_mean_is_sum_over_count(make_film: FilmMaker) -> None:
    film = make_film(0, 7, dropped=True)
    exact = film.sums.sum(axis=2) * STEP / np.maximum(film.samples(), 1)[..., None]
    assert np.allclose(film.mean(), exact, rtol=1e-15, atol=0)
    assert np.array_equal(film.mean(slice(3, 4)), film.mean()[:, :, 3:])
    assert set(np.unique(film.mean()[..., 3])) <= {0.0, 1.0}


def test_empty_film_is_black() -> None:
    assert not Film.empty(5, 3).mean().any()


def test_mean_does_not_wrap_when_replicates_together_exceed_64_bits() -> None:
    film = Film.empty(1, 1)
    film.sums[...] = 2**63 - 1
    film.cover(0, 4)
    assert np.allclose(film.mean(), 2.0**63 * STEP, rtol=1e-15)


VALUES = [1e-4, 1e-3, 0.1, 1.0, 7.3, 1e3]


@pytest.mark.parametrize(("value", "samples"), [*((v, 10**8) for v in VALUES), (1e6, 10**5)])
def test_constant_radiance_is_kept_to_1e_7(value: float, samples: int) -> None:
    """The sum of dithered roundings of v = (k + f) steps is N k plus a binomial count of N trials of probability f."""
    film = Film.empty(8, 8, step=STEP)
    k, f = divmod(value / STEP, 1.0)
    per_replicate = samples // 4
    rng = np.random.default_rng(20261122)
    rounded_up = rng.binomial(per_replicate, f, size=film.sums.shape)
    assert (int(k) + 1) * samples < 2**63, "the whole sum fits 64 bits, not only a replicate's"
    film.sums[...] = int(k) * per_replicate + rounded_up
    film.cover(0, samples)
    assert np.abs(film.mean() / value - 1).max() <= 1e-7


def test_dithered_rounding_has_the_binomial_statistics_used_above(splitmix: Callable[[np.ndarray], np.ndarray]) -> None:
    n, value = 1 << 20, 1e-4
    u = (splitmix(np.arange(n, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(11)) * 2.0**-53
    sums = np.floor(value / STEP + u).reshape(64, -1).sum(axis=1)
    f = value / STEP % 1.0
    expected, deviation = n / 64 * value / STEP, np.sqrt(n / 64 * f * (1 - f))
    assert abs((sums - expected).mean()) < 4 * deviation / 8
    assert 0.7 < (sums - expected).std() / deviation < 1.3


def test_equal_films_are_identical_and_others_are_not(make_film: FilmMaker) -> None:
    film = make_film(0, 6)
    assert film.identical(make_film(0, 6))
    assert not film.identical(make_film(0, 7))
    assert not film.identical(make_film(0, 6, seed=2))
    assert not film.identical(make_film(0, 6, window=(0, 0, 37, 20)))


def _arrays(h: int = 2, w: int = 3) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros((h, w, 4, 4), dtype=np.int64), np.zeros((h, w, 4), dtype=np.uint32)


@pytest.mark.parametrize("window", [(0, 0, 4, 2), (1, 0, 1, 2), (-1, 0, 2, 2), (2, 0, 1, 2)])
def test_window_must_lie_in_the_image(window: tuple[int, int, int, int]) -> None:
    with pytest.raises(ImageError, match="window"):
        Film(*_arrays(), STEP, [], window, 3, 2)


@pytest.mark.parametrize("step", [0.0, -0.5, 0.3, float("nan"), float("inf")])
def test_step_must_be_a_power_of_two(step: float) -> None:
    with pytest.raises(ImageError, match="power of two"):
        Film(*_arrays(), step, [], (0, 0, 3, 2), 3, 2)


def test_arrays_must_fit() -> None:
    sums, dropped = _arrays()
    window = (0, 0, 3, 2)
    for bad in (sums.astype(np.float64), np.asfortranarray(sums), sums[:1]):
        with pytest.raises(ImageError, match="film sums"):
            Film(bad, dropped, STEP, [], window, 3, 2)
    with pytest.raises(ImageError, match="dropped"):
        Film(sums, dropped.astype(np.int32), STEP, [], window, 3, 2)
    with pytest.raises(ImageError, match="channels ask for"):
        Film(sums, dropped, STEP, [], window, 3, 2, ("X", "Y", "Z"))


def test_dropping_more_than_was_covered_is_refused() -> None:
    film = Film.empty(2, 2)
    film.cover(0, 4)
    film.dropped[1, 1, 2] = 2
    with pytest.raises(ImageError, match="drops more samples than it covers"):
        film.counts()
