"""`accuray verify`: proves the physics on this machine against closed forms."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence

from .parser import Parser

SUMMARY = "Prove the physics on this machine: measured against known values, case by case."


def configure(parser: Parser) -> None:
    """Adds the flags of `accuray verify`."""
    parser.add_argument(
        "--quick", action="store_true", help="only the precision that the rules ask for, under 5 minutes"
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON")


def run(options: Namespace) -> int:
    """Prints the report; the status is 1 if a case fails."""
    import accuray.verify

    report = accuray.verify.run(quick=options.quick, progress=show_progress if sys.stderr.isatty() else None)
    print(report.to_json() if options.json else report.table())
    return 0 if report.passed else 1


def show_progress(_rows: Sequence[object], done: int, total: int) -> None:
    """Redraws one line on the terminal, and takes it away when all cases are done."""
    text = f"\r\x1b[Kverifying: {done} of {total} cases" if done < total else "\r\x1b[K"
    print(text, end="", file=sys.stderr, flush=True)
