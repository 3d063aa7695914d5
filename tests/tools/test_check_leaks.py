"""tools/check_leaks.py: nothing committed names one machine or a package registry.

The bad names are put together here, so that this file does not hold them.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from trees import REPOSITORY, check, plant


def test_this_tree_leaks_nothing() -> None:
    result = check("check_leaks", REPOSITORY)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize(
    "words",
    [
        ("/", "home/someone/scene.toml"),
        ("cache = '/", "root/.cache'"),
        ("/", "work/main"),
        ("url = https://py", "pi.org/simple"),
        ("https://files.python", "hosted.org/x.whl"),
    ],
)
def test_leak_is_seen(tmp_path: Path, words: tuple[str, str]) -> None:
    plant(tmp_path, "docs/guide.md", "# Guide\n" + "".join(words) + "\n")
    result = check("check_leaks", tmp_path)
    assert result.returncode == 1
    assert "docs/guide.md:2:" in result.stdout


def test_innocent_text_passes(tmp_path: Path) -> None:
    plant(tmp_path, "docs/guide.md", "build/home/x and accuray/farm.py, https://www.embree.org, pip install accuray\n")
    result = check("check_leaks", tmp_path)
    assert result.returncode == 0, result.stdout


def test_ignored_files_are_not_looked_at(tmp_path: Path) -> None:
    plant(tmp_path, ".gitignore", "uv.lock\n")
    plant(tmp_path, "uv.lock", "/" + "home/someone\n")
    subprocess.run(["git", "init", "--quiet", str(tmp_path)], check=True)
    result = check("check_leaks", tmp_path)
    assert result.returncode == 0, result.stdout
