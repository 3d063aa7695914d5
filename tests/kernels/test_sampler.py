"""The sampler: scrambled nets in every set, for every key, at any index; independent across sets and keys."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import chi2, norm
from scipy.stats.qmc import Sobol

import accuray
from accuray._core import probe
from tests.kernels.support import SEED, FloatArray

BLOCK = 1 << 16
KEYS = [int(k) for k in np.random.default_rng(SEED).integers(0, 1 << 32, 6)]
PAIRS = list(combinations(range(4), 2))


def points(key: int, point_set: int, first: int, count: int) -> FloatArray:
    return np.asarray(probe.sampler_points(key, point_set, first, count), dtype=np.float64)


def cells(x: FloatArray, axes: tuple[int, ...], bits: tuple[int, ...]) -> NDArray[np.int64]:
    """Number of points in each elementary interval that is cut into 2^bits on the given axes."""
    index = np.zeros(len(x), dtype=np.int64)
    for axis, b in zip(axes, bits, strict=True):
        index = (index << b) | np.floor(np.ldexp(x[:, axis], b)).astype(np.int64)
    return np.bincount(index, minlength=1 << sum(bits))


def shapes(axes: int, total: int) -> list[tuple[int, ...]]:
    """All ways to share `total` cuts among the axes."""
    if axes == 1:
        return [(total,)]
    return [(first, *rest) for first in range(total + 1) for rest in shapes(axes - 1, total - first)]


def sobol(count: int) -> FloatArray:
    """The sequence before scrambling, from another implementation with the same direction numbers."""
    return np.asarray(Sobol(4, scramble=False).random(count))


@pytest.mark.parametrize("first", [0, 3 * 256, 5 * BLOCK, 0xFFFF0000])
@pytest.mark.parametrize("key", KEYS)
def test_each_coordinate_is_stratified(key: int, first: int) -> None:
    """Every aligned block of 2^m samples has one point in each of 2^m equal intervals, on all four axes."""
    for m in range(1, 9):
        for point_set in (0, 1, 7):
            x = points(key, point_set, first, 1 << m)
            assert all((cells(x, (axis,), (m,)) == 1).all() for axis in range(4)), (key, point_set, m)


@pytest.mark.parametrize("first", [0, 9 * BLOCK])
def test_the_first_two_coordinates_form_a_perfect_net(first: int) -> None:
    for key in KEYS:
        for m in (3, 6, 9):
            x = points(key, 2, first, 1 << m)
            assert all((cells(x, axes, s) == 1).all() for axes in ((0, 1),) for s in shapes(2, m)), (key, m)


@pytest.mark.parametrize("m", [4, 8])
def test_elementary_intervals_hold_as_many_points_as_in_the_unscrambled_sequence(m: int) -> None:
    """Scrambling and shuffling permute the elementary intervals of each shape; the counts stay the same."""
    original = sobol(1 << m)
    groups = [(0, 1, 2, 3), *PAIRS]
    expected = {(axes, s): np.sort(cells(original, axes, s)) for axes in groups for s in shapes(len(axes), m)}
    for key in KEYS[:3]:
        x = points(key, 5, 0, 1 << m)
        for (axes, s), counts in expected.items():
            assert np.array_equal(np.sort(cells(x, axes, s)), counts), (key, axes, s)


def test_a_count_beyond_2_to_the_16_is_a_net_too() -> None:
    """2^17 samples span two blocks of shuffled indices; four blocks together are one net of 2^18."""
    x = points(KEYS[0], 3, 0, 4 * BLOCK)
    assert all((cells(x, (axis,), (18,)) == 1).all() for axis in range(4))
    assert all((cells(x, (0, 1), s) == 1).all() for s in shapes(2, 18)[::3])
    assert all((cells(x[: 2 * BLOCK], (axis,), (17,)) == 1).all() for axis in range(4))


@pytest.mark.parametrize("first", [0, 100, BLOCK - 3, (1 << 24) + 5, (1 << 31) - 4, (1 << 32) - 8])
def test_points_are_a_pure_function_of_key_set_and_index(first: int) -> None:
    for key in KEYS[:3]:
        together = points(key, 4, first, 7)
        alone = np.concatenate([points(key, 4, first + i, 1) for i in reversed(range(7))])[::-1]
        assert np.array_equal(together, alone)
        assert (together >= 0.0).all()
        assert (together < 1.0).all()
        assert len(np.unique(together[:, 0])) == 7


def test_single_precision_never_reaches_one() -> None:
    """The largest number is 1 - 2^-24, which is what the kernels' formulas rely on."""
    x = points(KEYS[0], 0, 0, 1 << 19)
    assert x.min() >= 0.0
    assert x.max() <= 1.0 - 2.0**-24


@pytest.mark.parametrize("index", [0, 1, 5, 70_000])
def test_every_sample_is_uniform_over_the_keys(index: int) -> None:
    """One sample number of one set, over many keys: nothing of the sequence shows."""
    keys = 20_000
    rng = np.random.default_rng((SEED, index))
    x = np.concatenate([points(int(k), 2, index, 1) for k in rng.integers(0, 1 << 32, keys)])
    for axes in [(a,) for a in range(4)] + PAIRS:
        counts = cells(x, axes, (6,) if len(axes) == 1 else (3, 3))
        statistic = float(((counts - keys / 64.0) ** 2).sum() / (keys / 64.0))
        assert chi2.sf(statistic, 63) > 1e-5, (axes, statistic)


def test_neighbouring_keys_are_as_independent_as_any() -> None:
    """Keys 0, 1, 2, ...: the same coordinate of one key and the next is uniform in the plane."""
    x = np.concatenate([points(k, 1, 0, 1) for k in range(SEED, SEED + 40_001)])
    for axis in range(4):
        plane = np.stack([x[:-1, axis], x[1:, axis]], axis=1)
        counts = cells(plane, (0, 1), (3, 3))
        statistic = float(((counts - 625.0) ** 2).sum() / 625.0)
        assert chi2.sf(statistic, 63) > 1e-5, (axis, statistic)


@pytest.mark.parametrize(("set_a", "set_b"), [(0, 1), (1, 2), (2, 3), (2, 4), (0, 9)])
def test_sets_of_one_key_are_independent(set_a: int, set_b: int) -> None:
    """All pairs of coordinates of two sets, over many keys with 16 samples each: every cell as often as any.

    Within a key the points are stratified, so the spread of a cell's count is measured between the keys.
    """
    keys, count = 4000, 16
    rng = np.random.default_rng((SEED, set_a, set_b))
    drawn = [int(k) for k in rng.integers(0, 1 << 32, keys)]
    a = np.stack([points(k, set_a, 0, count) for k in drawn])
    b = np.stack([points(k, set_b, 0, count) for k in drawn])
    worst = 0.0
    for axis_a in range(4):
        for axis_b in range(4):
            cell = (np.floor(4 * a[:, :, axis_a]) * 4 + np.floor(4 * b[:, :, axis_b])).astype(np.int64)
            counts = np.stack([(cell == c).sum(axis=1) for c in range(16)], axis=1)
            z = (counts.mean(axis=0) - count / 16.0) / (counts.std(axis=0, ddof=1) / np.sqrt(keys))
            worst = max(worst, float(np.abs(z).max()))
    assert worst < norm.isf(0.5 * 0.01 / (5 * 256)), worst


def test_estimates_are_unbiased_and_far_better_than_random() -> None:
    """A smooth integral over one set: the mean over keys is right, the error ten times below that of random numbers."""
    count, keys = 1024, 200
    rng = np.random.default_rng((SEED, 77))
    estimates = np.array(
        [np.prod(1.0 + (points(int(k), 6, 0, count) - 0.5), axis=1).mean() for k in rng.integers(0, 1 << 32, keys)]
    )
    error = estimates.std(ddof=1)
    assert abs(estimates.mean() - 1.0) < 4.0 * error / np.sqrt(keys)
    random_error = np.sqrt(((1.0 + 1.0 / 12.0) ** 4 - 1.0) / count)
    assert error < 0.1 * random_error


def test_replicates_are_independent_nets() -> None:
    """Samples i with the same i mod R share a key and follow each other in its sequence: each replicate is a net."""
    replicates = [points(key, 2, 0, 64) for key in KEYS[:4]]
    for x in replicates:
        assert all((cells(x, (0, 1), s) == 1).all() for s in shapes(2, 6))
    assert len(np.unique(np.concatenate(replicates)[:, 0])) == 256


def noise(seed: int) -> FloatArray:
    """Deviations (H, W, R) of one sample of each pixel and replicate that all see the same point of a lit floor."""
    scene = accuray.Scene.from_dict(
        {
            "accuray": 1,
            "film": {"width": 96, "height": 96, "filter": {"type": "box"}},
            "camera": {"type": "perspective", "position": [0, 1, 0.5], "look_at": [0, 0, 0], "fov": 1e-4},
            "materials": {"floor": {"type": "diffuse"}, "lamp": {"type": "diffuse", "emission": "D65"}},
            "shapes": {
                "floor": {"type": "disk", "radius": 9.0, "material": "floor"},
                "lamp": {"type": "disk", "center": [1.5, 1, 0], "normal": [0, -1, 0], "material": "lamp"},
            },
        }
    )
    film = accuray.render(scene, spp=4, seed=seed).film
    y = film.sums[..., 1].astype(np.float64)
    return np.asarray((y - y.mean()) / y.std())


def test_pixels_replicates_and_seeds_are_independent() -> None:
    """The correlation of the noise between neighbours of every kind is that of random numbers."""
    a, b = noise(SEED), noise(SEED + 1)
    pairs = {
        "right": (a[:, 1:], a[:, :-1]),
        "below": (a[1:], a[:-1]),
        "diagonal": (a[1:, 1:], a[:-1, :-1]),
        "transposed": (a, a.transpose(1, 0, 2)[::-1]),
        "tile": (a[16:], a[:-16]),
        "replicate": (a[..., 1:], a[..., :-1]),
        "seed": (a, b),
        "seed and pixel": (a[:, 1:], b[:, :-1]),
    }
    z = {name: float((x * y).mean() * np.sqrt(x.size)) for name, (x, y) in pairs.items()}
    assert max(map(abs, z.values())) < 4.5, z
