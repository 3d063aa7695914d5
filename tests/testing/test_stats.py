"""The distributions agree with SciPy's (a development dependency only)."""

from __future__ import annotations

import math

import pytest

from accuray.testing import stats

scipy_stats = pytest.importorskip("scipy.stats")
scipy_special = pytest.importorskip("scipy.special")


@pytest.mark.parametrize("a", [0.5, 1.0, 2.5, 50.0, 1e4])
@pytest.mark.parametrize("factor", [0.01, 0.5, 0.99, 1.0, 1.01, 1.5, 4.0])
def test_incomplete_gamma(a: float, factor: float) -> None:
    x = a * factor
    assert stats.gamma_p(a, x) == pytest.approx(scipy_special.gammainc(a, x), rel=1e-10, abs=1e-300)
    assert stats.gamma_q(a, x) == pytest.approx(scipy_special.gammaincc(a, x), rel=1e-9, abs=1e-300)


@pytest.mark.parametrize("dof", [1, 2, 10, 200, 20401])
@pytest.mark.parametrize("quantile", [1e-9, 1e-4, 0.3, 0.5, 0.9, 0.99999])
def test_chi2_tail(dof: int, quantile: float) -> None:
    x = scipy_stats.chi2.ppf(quantile, dof)
    assert stats.chi2_sf(x, dof) == pytest.approx(scipy_stats.chi2.sf(x, dof), rel=1e-9)


@pytest.mark.parametrize("dof", [1, 3, 12, 63, 1000, math.inf])
@pytest.mark.parametrize("t", [-3.0, 0.0, 0.1, 1.0, 4.0, 20.0])
def test_student_tail(dof: float, t: float) -> None:
    assert stats.student_t_sf(t, dof) == pytest.approx(scipy_stats.t.sf(t, dof), rel=1e-8, abs=1e-30)


@pytest.mark.parametrize("p", [1e-12, 1e-5, 0.025, 0.5, 0.975, 1 - 1e-9])
def test_quantiles(p: float) -> None:
    assert stats.normal_quantile(p) == pytest.approx(scipy_stats.norm.ppf(p), rel=1e-9, abs=1e-12)
    assert stats.student_t_quantile(p, 3) == pytest.approx(scipy_stats.t.ppf(p, 3), rel=1e-7, abs=1e-12)


def test_thousand_tests_need_4_42_sigmas() -> None:
    assert stats.sidak(0.01, 1000) == pytest.approx(1.0e-5, rel=0.01)
    assert stats.two_sided_threshold(stats.sidak(0.01, 1000)) == pytest.approx(4.42, abs=0.01)


@pytest.mark.parametrize(
    "call",
    [
        lambda: stats.normal_quantile(0.0),
        lambda: stats.student_t_quantile(1.5, 3),
        lambda: stats.chi2_sf(1.0, 0),
        lambda: stats.gamma_p(-1.0, 1.0),
        lambda: stats.beta_i(1.0, 1.0, 1.5),
        lambda: stats.sidak(0.0, 3),
    ],
)
def test_values_outside_the_domain_are_refused(call: object) -> None:
    with pytest.raises(ValueError, match=r"range|needs|must"):
        call()  # type: ignore[operator]
