"""z-tests accept noise, find bias, and refuse to judge without power."""

from __future__ import annotations

import numpy as np
import pytest

from accuray.testing import blocks, image_z_test, z_test

SHAPE = (32, 40, 3)


def noisy(seed: int, level: float = 1.0, error: float = 0.05, bias: float = 0.0) -> np.ndarray:  # type: ignore[type-arg]
    return np.random.default_rng(seed).normal(level * (1 + bias), error, SHAPE)


def test_number_against_known_value() -> None:
    assert z_test(1.002, 0.001, 1.0)
    assert not z_test(1.004, 0.001, 1.0)
    assert z_test(1.004, 0.001, 1.0, tests=1000)
    assert z_test(1.0 + 9e-6, 0.0, 1.0), "rounding is forgiven"
    assert not z_test(1.0 + 2e-5, 0.0, 1.0)
    assert not z_test(float("nan"), 0.1, 1.0)


def test_few_degrees_of_freedom_widen_the_limit() -> None:
    assert not z_test(1.0, 0.25, 0.0)
    assert z_test(1.0, 0.25, 0.0, dof=3)


def test_false_alarm_rate_of_the_image_test() -> None:
    fails = sum(not image_z_test(noisy(2 * s), 0.05, noisy(2 * s + 1), 0.05, allowed=0.0) for s in range(300))
    assert fails <= 15, "alpha is 1 % for the pixels and 1 % for the totals"


def test_image_test_sees_one_wrong_region() -> None:
    image = noisy(1)
    image[4:10, 4:10] += 0.4
    result = image_z_test(image, 0.05, noisy(2), 0.05)
    assert not result
    assert 4 <= result.at[0] < 10


def test_totals_see_a_bias_too_small_for_any_pixel() -> None:
    result = image_z_test(noisy(1, bias=0.005), 0.05, 1.0)
    assert not result
    assert result.worst < result.threshold


def test_image_test_refuses_nan() -> None:
    image = noisy(1)
    image[3, 3, 1] = np.nan
    assert "not finite" in image_z_test(image, 0.05, 1.0).reason


def test_blocks_pass_fail_and_have_no_power() -> None:
    good = blocks(noisy(1), 0.05, noisy(2), 0.05)
    assert good.verdict == "pass", good.reason
    assert blocks(noisy(1, bias=0.01), 0.05, noisy(2), 0.05).verdict == "fail"
    weak = blocks(noisy(1, error=0.2), 0.2, noisy(2, error=0.2), 0.2)
    assert weak.verdict == "no power"
    assert not weak


def test_one_noisy_block_takes_the_power_away() -> None:
    error = np.full(SHAPE, 0.05)
    error[8:16, 8:16] = 0.2
    result = blocks(noisy(1), error, noisy(2), 0.05)
    assert result.verdict == "no power"
    assert "1 of 60" in result.reason or "3 of 60" in result.reason


def test_blocks_find_a_local_bias_and_its_place() -> None:
    image = noisy(1)
    image[16:24, 8:16, 2] += 0.05
    result = blocks(image, 0.05, noisy(2), 0.05)
    assert result.verdict == "fail"
    assert result.at == (2, 1, 2)


def test_black_blocks_agree_without_noise() -> None:
    assert blocks(np.zeros((16, 16)), 0.0, np.zeros((16, 16)), 0.0).verdict == "pass"


def test_uneven_sizes_and_grey_images() -> None:
    image = np.random.default_rng(5).normal(1.0, 0.01, (13, 21))
    assert blocks(image, 0.01, np.ones((13, 21))).verdict == "pass"
    with pytest.raises(ValueError, match="axes"):
        blocks(np.ones(4), 0.1, np.ones(4))


def test_false_alarm_rate_of_blocks() -> None:
    fails = sum(not blocks(noisy(2 * s), 0.05, noisy(2 * s + 1), 0.05) for s in range(300))
    assert fails <= 15
