"""What fuzzing once found stays found: each file in findings/READER once crashed that reader, hung, or took it beyond
its errors. A new finding goes there under a name that says what was wrong; one of the C++ target `arrays` becomes a
case of src/mesh/checks_test.cpp.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz.readers import READERS
from tests.fuzz.support import run_module

FOLDER = Path(__file__).with_name("findings")
FILES = sorted(path for path in FOLDER.rglob("*") if path.is_file())


def test_no_finding_has_come_back(tmp_path: Path) -> None:
    outcomes = run_module("tests.fuzz.replay", tmp_path, *map(str, FILES))
    assert len(outcomes) == len(FILES)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_findings_are_small_and_in_their_reader_s_folder(path: Path) -> None:
    assert path.parent.name in READERS
    assert path.stat().st_size < 1 << 16
