"""The sign-off of the tests themselves: each bug planted in a copy of the source is seen by at least one case.

The quick tier checks that every bug still applies to the source as it is; `pytest -m long` builds and measures.
"""

from __future__ import annotations

import pytest
from planted_bugs import BUGS, Bug

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from extra_cases import cases
from planted_build import applied, build, measure

NAMED = tuple(sorted({case for bug in BUGS for case in bug.cases}))


def test_there_are_enough_bugs_and_they_name_cases() -> None:
    assert len(BUGS) >= 14
    assert len({bug.name for bug in BUGS}) == len(BUGS)
    quick = {case.id for case in cases() if case.quick}
    assert [case for case in NAMED if case not in quick] == []


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: bug.name)
def test_still_applies(bug: Bug) -> None:
    assert bug.changes
    assert bug.cases
    texts = applied(bug.changes)
    assert set(texts) == {change.file for change in bug.changes}


@pytest.mark.long
@pytest.mark.parametrize("case", NAMED)
def test_source_without_bugs_passes(case: str) -> None:
    rows = measure(build("none", ()), (case,))
    assert rows
    assert [row for row in rows if row[1] != "pass"] == []


@pytest.mark.long
@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: bug.name)
def test_bug_is_caught(bug: Bug) -> None:
    """By a case that fails: one that only lost its power has caught nothing."""
    rows = measure(build(bug.name, bug.changes), bug.cases)
    assert [row for row in rows if row[1] == "fail"], rows
