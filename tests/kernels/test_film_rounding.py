"""The film's integer sums: unbiased, as precise as promised, and never wrapped."""

from __future__ import annotations

import numpy as np
import pytest

from accuray._core import probe
from tests.kernels.support import SEED

WHITE_STEP = 2.0**-24
ULP = 2.0**-52


def exact(value: list[float]) -> list[float]:
    """The values as the single precision that the kernels receive."""
    return [float(np.float32(v)) for v in value]


def means(value: list[float], step: float, count: int, key: int = SEED) -> np.ndarray:
    return np.asarray(probe.quantized_sums(value, step, key, count)).astype(np.float64) * step / count


def test_whole_steps_are_exact() -> None:
    value = [0.0, 1.0, 4096.0, 3.0 * WHITE_STEP]
    assert list(probe.quantized_sums(value, WHITE_STEP, SEED, 1000)) == [round(v / WHITE_STEP) * 1000 for v in value]


@pytest.mark.parametrize("fraction", [2.0**-12, 0.1, 0.25, 0.5, 0.9])
def test_fractions_of_a_step_are_right_in_the_mean(fraction: float) -> None:
    """Each sample is rounded up with the probability of the fraction: a binomial number of steps."""
    count = 1_000_000
    value = exact([fraction, 1.0 + fraction, 17.0 + fraction, 1000.0 + fraction])
    sums = np.asarray(probe.quantized_sums(value, 1.0, SEED + 1, count)).astype(np.float64)
    chance = np.array(value) % 1.0
    z = (sums - np.array(value) * count) / np.sqrt(count * chance * (1.0 - chance))
    assert np.abs(z).max() < 4.5, z


def test_negative_values_are_rounded_without_bias_too() -> None:
    count = 1_000_000
    value = exact([-0.25, -0.7, -1.5, -100.25])
    chance = np.array(value) % 1.0
    sums = np.asarray(probe.quantized_sums(value, 1.0, SEED + 2, count)).astype(np.float64)
    z = (sums - np.array(value) * count) / np.sqrt(count * chance * (1.0 - chance))
    assert np.abs(z).max() < 4.5, z


def test_keys_and_channels_are_dithered_independently() -> None:
    """Products of the roundings of two channels, and of two keys, average to the product of their means."""
    sums = np.array([probe.quantized_sums([0.5] * 4, 1.0, key, 1) for key in range(SEED, SEED + 40_000)]) - 0.5
    pairs = [sums[:, a] * sums[:, b] for a in range(4) for b in range(a)] + [
        sums[1:, c] * sums[:-1, c] for c in range(4)
    ]
    z = [4.0 * pair.mean() * np.sqrt(len(pair)) for pair in pairs]
    assert np.abs(z).max() < 4.5, z


def test_consecutive_samples_are_dithered_independently() -> None:
    """The sum of n roundings varies between keys as a sum of n independent ones does."""
    count, keys = 256, 4000
    sums = np.array([probe.quantized_sums([0.5] * 4, 1.0, key, count) for key in range(SEED, SEED + keys)])
    ratio = sums.var(axis=0, ddof=1) / (0.25 * count)
    assert np.abs(ratio - 1.0).max() < 4.5 * np.sqrt(2.0 / keys)


def test_constant_radiance_keeps_seven_digits_over_1e8_samples() -> None:
    """From 1e-4 to 1e3 times white. The rounding's own noise is 3e-8 of the darkest."""
    value = exact([1e-4, 0.013, 0.7, 1e3])
    assert np.abs(means(value, WHITE_STEP, 100_000_000) / value - 1.0).max() <= 1e-7


def test_a_million_times_white_keeps_seven_digits_over_1e5_samples() -> None:
    value = exact([1e6, 0.9e6, 123456.7, 999999.9])
    assert np.abs(means(value, WHITE_STEP, 100_000) / value - 1.0).max() <= 1e-7


def test_sums_up_to_the_last_bit() -> None:
    """Two values of 2^61 and one of 2^62 - 2^38 are held exactly; what leaves 64 bits is refused."""
    large = float(np.nextafter(np.float32(2.0**62), np.float32(0.0)))
    assert list(probe.quantized_sums([large, -large, 2.0**61, 0.0], 1.0, SEED, 2)) == [
        2 * int(large),
        -2 * int(large),
        2**62,
        0,
    ]
    for value in ([large, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -large]):
        with pytest.raises(OverflowError):
            probe.quantized_sums(value, 1.0, SEED, 3)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf"), 2.0**62, -(2.0**62), 3e38])
def test_what_is_no_number_of_steps_is_not_added(bad: float) -> None:
    for channel in range(4):
        value = [1.0] * 4
        value[channel] = bad
        with pytest.raises(ValueError, match="fit"):
            probe.quantized_sums(value, 1.0, SEED, 1)


def test_rounding_is_a_pure_function() -> None:
    """The sum over n + m samples contains that over n: nothing is carried along."""
    whole = [np.asarray(probe.quantized_sums([0.3] * 4, 1.0, SEED, n)) for n in range(40)]
    again = [np.asarray(probe.quantized_sums([0.3] * 4, 1.0, SEED, n)) for n in range(40)]
    assert np.array_equal(whole, again)
    assert set(np.unique(np.diff(whole, axis=0))) <= {0, 1}
