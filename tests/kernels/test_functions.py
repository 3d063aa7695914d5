"""The elementary functions of the kernels against double or extended precision.

The bounds are what the functions are known to reach, a little above the largest error seen over 10^7 arguments. They
are stated in units in the last place of the exact result (ulp) where a function keeps its relative accuracy, and as an
absolute error where it does not.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from accuray._core import probe
from tests.kernels.support import SEED, FloatArray

COUNT = 400_000
Reference = Callable[[NDArray[np.longdouble]], NDArray[np.longdouble]]


def arguments(low: float, high: float) -> FloatArray:
    """Single-precision numbers: even ones between the ends, and many near zero and the ends."""
    rng = np.random.default_rng(SEED)
    even = rng.uniform(low, high, COUNT)
    small = np.exp(rng.uniform(np.log(1e-30), 0.0, COUNT // 4))
    near = np.concatenate([low + (high - low) * 0.5 * small, high - (high - low) * 0.5 * small])
    both = [small * high, small * low, near, [low, high, 0.0 if low <= 0.0 <= high else low]]
    return np.clip(np.concatenate([even, *both]), low, high).astype(np.float32).astype(np.float64)


def errors(name: str, reference: Reference, x: FloatArray, dtype: type) -> tuple[float, float]:
    """Largest absolute error, and largest error in units in the last place."""
    exact = reference(x.astype(np.longdouble))
    wrong = np.abs(probe.function(name, x).astype(np.longdouble) - exact)
    spacing = np.spacing(np.abs(exact).astype(dtype)).astype(np.longdouble)
    return float(wrong.max()), float((wrong / np.maximum(spacing, np.finfo(dtype).smallest_normal)).max())


SINGLE = [
    # name, reference, low, high, absolute error, ulp (None: the relative error is not bounded there)
    ("sin", np.sin, -np.pi / 4, np.pi / 4, 9e-8, 2.0),
    ("cos", np.cos, -np.pi / 4, np.pi / 4, 9e-8, 2.0),
    ("sin", np.sin, -8192.0, 8192.0, 1e-7, None),
    ("cos", np.cos, -8192.0, 8192.0, 1e-7, None),
    ("atan", np.arctan, -1.0, 1.0, 1e-7, 4.0),
    ("atan", np.arctan, -1e6, 1e6, 2e-7, 4.0),
    ("asin", np.arcsin, -1.0, 1.0, 2e-7, 5.0),
    ("acos", np.arccos, -1.0, 1.0, 3.5e-7, 5.0),
]


@pytest.mark.parametrize(("name", "reference", "low", "high", "absolute", "ulp"), SINGLE)
def test_single_precision(
    name: str, reference: Reference, low: float, high: float, absolute: float, ulp: float | None
) -> None:
    largest, units = errors(name, reference, arguments(low, high), np.float32)
    assert largest <= absolute
    assert ulp is None or units <= ulp


@pytest.mark.parametrize(("name", "reference"), [("sin64", np.sin), ("cos64", np.cos)])
def test_double_precision_of_the_circle(name: str, reference: Reference) -> None:
    """The part of pi/2 that two doubles do not hold leaves an absolute error at the zeros far out."""
    largest, units = errors(name, reference, np.random.default_rng(SEED).uniform(-8.0, 8.0, COUNT), np.float64)
    assert largest <= 2.5e-16
    assert units <= 2.5
    largest, _ = errors(name, reference, np.random.default_rng(SEED).uniform(-8192.0, 8192.0, COUNT), np.float64)
    assert largest <= 2.5e-16


def test_exponential() -> None:
    x = np.random.default_rng(SEED).uniform(-708.0, 709.0, COUNT)
    assert errors("exp", np.exp, x, np.float64)[1] <= 2.0
    assert errors("exp", np.exp, x / 709.0, np.float64)[1] <= 2.0
    assert probe.function("exp", np.array([0.0]))[0] == 1.0


def test_exponential_at_the_ends() -> None:
    y = probe.function("exp", np.array([-np.inf, -1e300, -708.5, 709.5, 1e300, np.inf]))
    assert list(y) == [0.0, 0.0, 0.0, np.inf, np.inf, np.inf]


def test_logarithm() -> None:
    rng = np.random.default_rng(SEED)
    wide = np.exp(rng.uniform(-708.0, 709.0, COUNT))
    near_one = 1.0 + rng.uniform(-0.5, 1.0, COUNT) ** 3
    for x in (wide, near_one, 1.0 + np.ldexp(rng.uniform(-1.0, 1.0, COUNT), -20)):
        assert errors("log", np.log, x[x > 0], np.float64)[1] <= 4.0
    assert probe.function("log", np.array([1.0]))[0] == 0.0


@pytest.mark.parametrize("name", ["sin", "atan", "asin", "sin64"])
def test_odd_functions_are_odd_to_the_bit(name: str) -> None:
    x = np.abs(arguments(0.0, 1.0))
    assert np.array_equal(probe.function(name, x), -probe.function(name, -x))


@pytest.mark.parametrize("name", ["atan", "asin", "acos"])
def test_angles_stay_in_their_range(name: str) -> None:
    y = np.abs(probe.function(name, arguments(-1.0, 1.0)))
    assert y.max() <= np.float32(np.pi if name == "acos" else np.pi / 2)


def test_sine_and_cosine_lie_on_the_circle() -> None:
    x = arguments(-8192.0, 8192.0)
    s, c = probe.function("sin", x), probe.function("cos", x)
    assert np.abs(np.hypot(s, c) - 1.0).max() <= 1.2e-7
