"""The rule that judges a case, the choice of sample counts, and the report; known noise stands in for the renderer."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from accuray.verify import Case, Report, Row, runner
from accuray.verify.case import chromaticity_and_error


@dataclass
class Noise:
    """A probe whose batches are normal about `mean` with the relative spread `sigma`."""

    mean: float = 2.0
    sigma: float = 0.01
    start: int = 64
    samples_per_batch: int = 100
    calls: list[tuple[int, int]] = field(default_factory=list)

    def batches(self, count: int, seed: int) -> NDArray[np.float64]:
        self.calls.append((count, seed))
        return np.random.default_rng(seed).normal(self.mean, self.sigma * self.mean, (count, 1))


def case(probe: Noise, expected: float = 2.0) -> Case:
    return Case("T.noise", "A number.", "arithmetic", (expected,), probe)


def row(expected: float, measured: float, error: float, note: str = "") -> Row:
    return Row("T.row", "A number.", "arithmetic", expected, measured, error, 1000, 0.1, note)


@pytest.mark.parametrize(
    ("expected", "measured", "error", "verdict"),
    [
        (1.0, 1.0, 0.0, "pass"),
        (1.0, 1.000009, 0.0, "pass"),
        (1.0, 1.00002, 0.0, "fail"),
        (1.0, 1.0039, 0.00099, "pass"),
        (1.0, 1.0041, 0.00099, "fail"),
        (1.0, 1.001, 0.0011, "no power"),
        (1.0, 2.0, 0.5, "no power"),
        (0.0, 0.0, 0.0, "pass"),
        (0.0, 1e-12, 1e-12, "fail"),
        (1.0, math.nan, 0.0, "fail"),
        (1.0, 1.0, math.inf, "fail"),
    ],
)
def test_rule(expected: float, measured: float, error: float, verdict: str) -> None:
    assert row(expected, measured, error).verdict == verdict


def test_a_quiet_case_takes_one_run() -> None:
    probe = Noise(sigma=0.001)
    (result,) = runner.measure(case(probe), runner.QUICK)
    assert result.passed
    assert [count for count, _ in probe.calls] == [64]


def test_a_noisy_case_is_measured_again_with_fresh_seeds() -> None:
    probe = Noise(sigma=0.1)
    (result,) = runner.measure(case(probe), runner.QUICK)
    assert result.passed
    (first, seed), (second, other) = probe.calls
    assert second == pytest.approx(1.3 * (0.1 / runner.QUICK.target) ** 2, rel=0.5)
    assert seed != other
    assert result.samples == 100 * second > 100 * first


def test_a_hopeless_case_has_no_power() -> None:
    probe = Noise(sigma=1.0)
    (result,) = runner.measure(case(probe), runner.Effort(7e-4, 100_000))
    assert result.verdict == "no power"
    assert probe.calls[-1][0] == 1000


def test_a_bias_of_half_a_percent_is_found() -> None:
    (result,) = runner.measure(case(Noise(mean=2.01, sigma=0.1)), runner.QUICK)
    assert result.verdict == "fail"
    assert result.sigmas > 4


def test_false_alarms_are_rare() -> None:
    verdicts = [runner.measure(case(Noise(sigma=0.005)), runner.QUICK, seed)[0].verdict for seed in range(500)]
    assert verdicts.count("pass") >= 498


def test_an_error_of_the_renderer_is_a_failed_row() -> None:
    class Broken(Noise):
        def batches(self, count: int, seed: int) -> NDArray[np.float64]:
            raise ValueError("metal 'perfect' is not known")

    (result,) = runner.measure(case(Broken()), runner.QUICK)
    assert result.verdict == "fail"
    assert "perfect" in Report((result,), True, 0, 0.0).table()


def test_chromaticity_error_is_the_spread_of_chromaticities() -> None:
    rng = np.random.default_rng(1)
    batches = rng.normal([0.95, 1.0, 1.09], 0.01, (4000, 3)) * rng.normal(1.0, 0.2, (4000, 1))
    xy, error = chromaticity_and_error(batches)
    assert xy == pytest.approx([0.95 / 3.04, 1.0 / 3.04], rel=1e-3)
    groups = np.array([chromaticity_and_error(g)[0] for g in batches.reshape(100, 40, 3)])
    assert error * math.sqrt(100) == pytest.approx(groups.std(axis=0, ddof=1), rel=0.3)


def test_table_and_json() -> None:
    rows = (row(1.0, 1.0001, 0.0005), row(2.0, 2.1, 0.001), row(3.0, 3.0, 0.5), row(4.0, math.nan, 0.0, "it broke"))
    report = Report(rows, True, 7, 1.5)
    text = report.table()
    assert not report.passed
    assert "1 of 4 numbers" in text
    assert "2 failed" in text
    assert "1 without power" in text
    assert "+5.000% off" in text
    assert "it broke" in text
    content = json.loads(report.to_json())
    assert content["passed"] is False
    assert [r["verdict"] for r in content["rows"]] == ["pass", "fail", "no power", "fail"]
    assert content["rows"][3]["measured"] is None
    assert Report(rows[:1], True, 0, 1.0).passed
    assert not Report((), True, 0, 1.0).passed


def test_run_reports_progress_and_honours_the_choice(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = [Case(f"T.{i}", "A number.", "arithmetic", (2.0,), Noise(sigma=0.001), quick=i != 2) for i in range(4)]
    monkeypatch.setattr(runner, "all_cases", lambda: cases)
    seen: list[tuple[int, int, int]] = []

    def progress(rows: Sequence[Row], done: int, total: int) -> None:
        seen.append((len(rows), done, total))

    report = runner.run(True, progress)
    assert [r.id for r in report.rows] == ["T.0", "T.1", "T.3"]
    assert seen == [(1, 1, 3), (2, 2, 3), (3, 3, 3)]
    assert [r.id for r in runner.run(False, only=lambda c: c.id > "T.1").rows] == ["T.2", "T.3"]
    again = runner.run(True)
    assert [r.measured for r in again.rows] == [r.measured for r in report.rows]
