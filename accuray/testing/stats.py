"""Distributions needed by statistical tests, in plain Python: no SciPy at run time.

Tail probabilities are accurate to about 1e-12 relative over the range that hypothesis tests use. Scalars in, scalars
out; a caller with arrays compares them with one quantile instead of asking for a million tail probabilities.
"""

from __future__ import annotations

import math
from collections.abc import Callable

_TINY = 1e-300
_EPSILON = 1e-16
_MAX_TERMS = 100_000


def normal_sf(z: float) -> float:
    """Upper tail probability of the standard normal distribution."""
    return 0.5 * math.erfc(z / math.sqrt(2.0))


def normal_quantile(p: float) -> float:
    """The z below which a standard normal variable falls with probability `p`, 0 < p < 1."""
    if not 0.0 < p < 1.0:
        raise ValueError(f"p = {p} is out of range: allowed 0 to 1, ends excluded")
    if p > 0.5:
        return _invert_sf(normal_sf, 1.0 - p)
    return -_invert_sf(normal_sf, p)


def gamma_p(a: float, x: float) -> float:
    """Regularised lower incomplete gamma function P(a, x), a > 0, x >= 0."""
    return _gamma_pair(a, x)[0]


def gamma_q(a: float, x: float) -> float:
    """Regularised upper incomplete gamma function Q(a, x) = 1 - P(a, x), without cancellation in the tail."""
    return _gamma_pair(a, x)[1]


def chi2_sf(statistic: float, dof: float) -> float:
    """Probability that a chi-square variable with `dof` degrees of freedom exceeds `statistic`."""
    if dof <= 0:
        raise ValueError(f"dof = {dof} is out of range: must be positive")
    return gamma_q(0.5 * dof, 0.5 * statistic)


def beta_i(a: float, b: float, x: float) -> float:
    """Regularised incomplete beta function I_x(a, b) (continued fraction 26.5.8 of Abramowitz and Stegun 1964)."""
    if not 0.0 <= x <= 1.0:
        raise ValueError(f"x = {x} is out of range: allowed 0 to 1")
    if x in (0.0, 1.0):
        return x
    if x > (a + 1.0) / (a + b + 2.0):
        return 1.0 - beta_i(b, a, 1.0 - x)
    log_front = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)

    def numerator(n: int) -> float:
        m = n // 2
        if n % 2:
            return -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        return m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))

    return math.exp(log_front) / (a * _continued_fraction(lambda n: 1.0, numerator))


def student_t_sf(t: float, dof: float) -> float:
    """Upper tail probability of Student's t distribution with `dof` degrees of freedom (infinity: normal)."""
    if dof <= 0:
        raise ValueError(f"dof = {dof} is out of range: must be positive")
    if math.isinf(dof):
        return normal_sf(t)
    tail = 0.5 * beta_i(0.5 * dof, 0.5, dof / (dof + t * t))
    return tail if t >= 0 else 1.0 - tail


def student_t_quantile(p: float, dof: float) -> float:
    """The t below which a Student variable with `dof` degrees of freedom falls with probability `p`."""
    if not 0.0 < p < 1.0:
        raise ValueError(f"p = {p} is out of range: allowed 0 to 1, ends excluded")
    if p > 0.5:
        return _invert_sf(lambda t: student_t_sf(t, dof), 1.0 - p)
    return -_invert_sf(lambda t: student_t_sf(t, dof), p)


def two_sided_threshold(alpha: float, dof: float = math.inf) -> float:
    """The |z| (or |t|) that a standard variable exceeds with probability `alpha`."""
    return _invert_sf(lambda t: student_t_sf(t, dof), 0.5 * alpha)


def sidak(alpha: float, tests: int) -> float:
    """Significance of each of `tests` independent tests that gives `alpha` for all of them together (Sidak 1967)."""
    if tests < 1 or not 0.0 < alpha < 1.0:
        raise ValueError(f"sidak({alpha}, {tests}): alpha must lie between 0 and 1 and tests be at least 1")
    return -math.expm1(math.log1p(-alpha) / tests)


def _gamma_pair(a: float, x: float) -> tuple[float, float]:
    """(P, Q) by the power series where it converges fast, else by the continued fraction for Q."""
    if a <= 0 or x < 0 or math.isnan(x):
        raise ValueError(f"incomplete gamma function of a = {a}, x = {x}: needs a > 0 and x >= 0")
    if x == 0.0:
        return 0.0, 1.0
    if math.isinf(x):
        return 1.0, 0.0
    front = math.exp(a * math.log(x) - x - math.lgamma(a))
    if x < a + 1.0:
        term = total = 1.0 / a
        for n in range(1, _MAX_TERMS):
            term *= x / (a + n)
            total += term
            if term < total * _EPSILON:
                break
        p = min(front * total, 1.0)
        return p, 1.0 - p
    fraction = _continued_fraction(lambda n: x - a + 1.0 + 2.0 * n, lambda n: -n * (n - a))
    q = min(front / fraction, 1.0)
    return 1.0 - q, q


def _continued_fraction(b: Callable[[int], float], a: Callable[[int], float]) -> float:
    """b(0) + a(1) / (b(1) + a(2) / (b(2) + ...)) by Lentz's method as modified by Thompson and Barnett 1986."""
    value = b(0) or _TINY
    c, d = value, 0.0
    for n in range(1, _MAX_TERMS):
        d = b(n) + a(n) * d
        c = b(n) + a(n) / c
        d = 1.0 / (d or _TINY)
        c = c or _TINY
        value *= c * d
        if abs(c * d - 1.0) < 4 * _EPSILON:
            break
    return value


def _invert_sf(sf: Callable[[float], float], tail: float) -> float:
    """The x >= 0 where the decreasing function `sf` equals `tail` <= 1/2, by bisection."""
    low, high = 0.0, 1.0
    while sf(high) > tail:
        low, high = high, 2.0 * high
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if sf(middle) > tail:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
