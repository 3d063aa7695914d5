"""Quantiles of Student's t distribution, without a dependency."""

from __future__ import annotations

import math
from functools import lru_cache

_SERIES_LIMIT = 200
"""Degrees of freedom up to which the finite series is summed; above, the expansion in 1/dof is accurate to 1e-9."""


@lru_cache(maxsize=256)
def student_t(confidence: float, dof: int) -> float:
    """The t with P(|T| <= t) = confidence for Student's t with `dof` degrees of freedom.

    Relative accuracy 1e-9 for 0.5 <= confidence <= 0.9999.

    Raises:
        ValueError: confidence outside (0, 1) or dof < 1.
    """
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence {confidence!r} is out of range: allowed above 0 and below 1")
    if dof < 1:
        raise ValueError(f"{dof} degrees of freedom: at least 1 is needed")
    if dof > _SERIES_LIMIT:
        return _expansion(confidence, dof)
    low, high = 0.0, math.pi / 2
    while (theta := 0.5 * (low + high)) not in (low, high):
        if _central_probability(theta, dof) < confidence:
            low = theta
        else:
            high = theta
    return math.sqrt(dof) * math.tan(high)


def _central_probability(theta: float, dof: int) -> float:
    """P(|T| <= sqrt(dof) tan(theta)): Abramowitz and Stegun 1964, 26.7.3 (odd dof) and 26.7.4 (even dof)."""
    cosine, sine = math.cos(theta), math.sin(theta)
    odd = dof % 2
    term = cosine if odd else 1.0
    total = 0.0
    for k in range(2 + odd, dof + 1, 2):
        total += term
        term *= cosine * cosine * (k - 1) / k
    return 2.0 / math.pi * (theta + sine * total) if odd else sine * total


def _expansion(confidence: float, dof: int) -> float:
    """Expansion about the normal quantile: Abramowitz and Stegun 1964, 26.7.5."""
    from statistics import NormalDist  # late: only regions and stopping rules need it

    x = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    x2 = x * x
    g1 = x * (x2 + 1) / 4
    g2 = x * ((5 * x2 + 16) * x2 + 3) / 96
    g3 = x * (((3 * x2 + 19) * x2 + 17) * x2 - 15) / 384
    g4 = x * ((((79 * x2 + 776) * x2 + 1482) * x2 - 1920) * x2 - 945) / 92160
    return x + (g1 + (g2 + (g3 + g4 / dof) / dof) / dof) / dof
