"""A case: a number that theory knows and the renderer must reproduce, and the rule that decides whether it did."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from accuray.verify.probes import Probe

FloatArray = NDArray[np.float64]
#: batches (K, n) -> estimates (m,) and their standard errors (m,)
Summary = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

SIGMAS = 4.0
ROUNDING = 1e-5
POWER = 1e-3


def mean_and_error(batches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean of the batches and its standard error."""
    return batches.mean(axis=0), batches.std(axis=0, ddof=1) / math.sqrt(len(batches))


def chromaticity_and_error(batches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """CIE x and y of batches of XYZ, errors by linearising the ratio at the mean."""
    total = batches.mean(axis=0)
    level = total.sum()
    ratio = total[:2] / level
    residual = (batches[:, :2] - ratio * batches.sum(axis=1, keepdims=True)) / level
    return ratio, residual.std(axis=0, ddof=1) / math.sqrt(len(batches))


@dataclass(frozen=True)
class Case:
    """One experiment with one or several known numbers.

    `labels` names the numbers when there are several. `quick` cases belong to the short run. `tolerance` is what the
    renderer may be off by, for a model that is documented as approximate.
    """

    id: str
    sentence: str
    source: str
    expected: tuple[float, ...]
    probe: Probe
    labels: tuple[str, ...] = ("",)
    summary: Summary = mean_and_error
    quick: bool = True
    tolerance: float = 0.0

    def __post_init__(self) -> None:
        if len(self.labels) != len(self.expected):
            raise ValueError(f"{self.id}: {len(self.expected)} expected values but {len(self.labels)} labels")


@dataclass(frozen=True)
class Row:
    """One number of the report."""

    id: str
    sentence: str
    source: str
    expected: float
    measured: float
    error: float
    samples: int
    seconds: float
    note: str = ""
    tolerance: float = 0.0

    @property
    def verdict(self) -> str:
        """Either "pass", "fail", or "no power" where the measurement is too noisy to tell right from wrong."""
        if self.note or not (math.isfinite(self.measured) and math.isfinite(self.error)):
            return "fail"
        if self.expected == 0.0:
            return "pass" if self.measured == 0.0 and self.error == 0.0 else "fail"
        allowed = SIGMAS * self.error + ROUNDING * abs(self.expected) + self.tolerance
        if abs(self.measured - self.expected) > allowed:
            return "fail"
        return "pass" if self.error <= POWER * abs(self.expected) else "no power"

    @property
    def passed(self) -> bool:
        return self.verdict == "pass"

    @property
    def sigmas(self) -> float:
        """Deviation in standard errors; 0 if it is within rounding, infinite without noise to explain it."""
        difference = self.measured - self.expected
        if abs(difference) <= ROUNDING * abs(self.expected):
            return difference / self.error if self.error > abs(difference) else 0.0
        return difference / self.error if self.error > 0.0 else math.copysign(math.inf, difference)
