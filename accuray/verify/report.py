"""The report of a verification: a table for people, JSON for machines."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import dataclass
from typing import Any

import accuray
from accuray.verify.case import POWER, ROUNDING, SIGMAS, Row

_WIDTHS = (32, 13, 13, 9, 8)


@dataclass(frozen=True)
class Report:
    """All measured rows of one run."""

    rows: tuple[Row, ...]
    quick: bool
    seed: int
    seconds: float

    @property
    def passed(self) -> bool:
        """Whether there are rows and every one of them passed."""
        return bool(self.rows) and all(row.passed for row in self.rows)

    def table(self) -> str:
        """One line per number, failures explained below, a summary at the end."""
        heading = _columns("case", "expected", "measured", "+- error", "sigmas") + "  verdict"
        lines = [heading, "-" * len(heading)]
        for row in self.rows:
            numbers = (_number(row.expected), _number(row.measured), f"{row.error:.1e}", f"{row.sigmas:+.2f}")
            lines.append(f"{_columns(row.id, *numbers)}  {row.verdict}")
        failures = [row for row in self.rows if not row.passed]
        if failures:
            lines += ["", "Not passed:"]
            lines += [f"  {row.id}: {row.sentence} ({row.source}). {_reason(row)}" for row in failures]
        return "\n".join([*lines, "", self.summary()])

    def summary(self) -> str:
        """One sentence."""
        verdicts = Counter(row.verdict for row in self.rows)
        parts = [f"{verdicts[v]} {w}" for v, w in (("fail", "failed"), ("no power", "without power")) if verdicts[v]]
        tail = f" ({', '.join(parts)})" if parts else ""
        cases = len({row.id.partition("[")[0] for row in self.rows})
        samples = sum({row.id.partition("[")[0]: row.samples for row in self.rows}.values())
        return (
            f"{verdicts['pass']} of {len(self.rows)} numbers of {cases} cases passed{tail}, "
            f"{samples / 1e6:.0f} M paths in {self.seconds:.0f} s"
        )

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain values; numbers that are not finite become null."""
        rows = [
            {
                "id": row.id,
                "sentence": row.sentence,
                "source": row.source,
                "expected": row.expected,
                "measured": _finite(row.measured),
                "error": _finite(row.error),
                "sigmas": _finite(row.sigmas),
                "verdict": row.verdict,
                "note": row.note,
                "samples": row.samples,
                "seconds": round(row.seconds, 4),
            }
            for row in self.rows
        ]
        return {
            "accuray": getattr(accuray, "__version__", None),
            "quick": self.quick,
            "seed": self.seed,
            "seconds": round(self.seconds, 3),
            "rule": {"sigmas": SIGMAS, "rounding": ROUNDING, "power": POWER},
            "passed": self.passed,
            "rows": rows,
        }

    def to_json(self) -> str:
        """`to_dict` as JSON text."""
        return json.dumps(self.to_dict(), indent=1, allow_nan=False)


def _columns(name: str, *numbers: str) -> str:
    cells = [f"{n:>{w}}" for n, w in zip(numbers, _WIDTHS[1:], strict=True)]
    return " ".join([f"{name:<{_WIDTHS[0]}}", *cells])


def _number(value: float) -> str:
    return f"{value:.8g}"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _reason(row: Row) -> str:
    """Why a row did not pass."""
    if row.note:
        return row.note
    if row.verdict == "no power":
        return f"The standard error is {row.error / abs(row.expected):.2%} of the answer, allowed {POWER:.1%}"
    off = f"{row.measured / row.expected - 1.0:+.3%} off" if row.expected else f"{row.measured:.3g} instead of 0"
    return f"{off}, {abs(row.sigmas):.1f} standard errors"
