"""Every broken scene of the table, given to the command line: exit status 2, an explanation, and no image.

Most run in this process; a few that are nasty to parsers, and some that change with ACCURAY_TEST_SEED, run as a user's
would. What is wrong with geometry alone does not stop a render: see test_bad_geometry.py.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from scene.bad_scenes import BAD_SCENES, BadScene

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from accuray.cli import main

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
NASTY = ("toml-deep-arrays", "json-deep", "toml-huge-integer", "not-utf8", "file-pipe", "mesh-file-ply-size-lie")
ROTATING = 4


def arguments(case: BadScene) -> list[str]:
    """What to give to `accuray`; -D precedes, as flags may stand anywhere."""
    settings = [word for text in case.overrides for word in ("-D", text)]
    return ["render", *settings, case.main, "--spp", "1", "-o", "picture.exr"]


def as_processes() -> list[BadScene]:
    plain = [case for case in BAD_SCENES if case.name not in NASTY]
    some = [plain[(SEED * ROTATING + k) % len(plain)] for k in range(ROTATING)]
    return [case for case in BAD_SCENES if case.name in NASTY] + some


def check(case: BadScene, status: int, complaint: str, folder: Path, before: set[Path]) -> None:
    assert status == 2, complaint
    assert [text for text in case.expected if text not in complaint] == [], complaint
    assert complaint.startswith("accuray: error: ")
    assert "Traceback" not in complaint
    assert len(complaint) < 3000
    assert set(folder.rglob("*")) == before


def test_table_is_large() -> None:
    names = {case.name for case in BAD_SCENES}
    assert len(names) >= 60
    assert set(NASTY) <= names


@pytest.mark.parametrize("case", BAD_SCENES, ids=lambda case: case.name)
def test_command_line(
    case: BadScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    case.write(tmp_path)
    before = set(tmp_path.rglob("*"))
    status = main(arguments(case))
    printed = capsys.readouterr()
    assert printed.out == ""
    check(case, status, printed.err, tmp_path, before)


@pytest.mark.parametrize("case", as_processes(), ids=lambda case: case.name)
def test_process(case: BadScene, tmp_path: Path) -> None:
    case.write(tmp_path)
    before = set(tmp_path.rglob("*"))
    command = [sys.executable, "-m", "accuray", *arguments(case)]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert result.stdout == ""
    check(case, result.returncode, result.stderr, tmp_path, before)
