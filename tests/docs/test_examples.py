"""Every example runs, small, from an empty folder; and stays as short as an example should be."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from pages import REPOSITORY, Block, blocks

pytest.importorskip("accuray._core", reason="the compiled module is not built")

SMALL = Path(__file__).with_name("small.py")
EXAMPLES = sorted((REPOSITORY / "examples").glob("*.py"))
FIRST_LINES = 60
MOST_LINES = 90


def run_small(program: Path, folder: Path) -> str:
    """Standard output of a program, run with a small AccuRay in a folder of its own."""
    command = [sys.executable, str(SMALL), str(program)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    assert run_small(example, tmp_path).strip()


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_example_is_short_and_begins_with_a_docstring(example: Path) -> None:
    text = example.read_text(encoding="utf-8")
    assert text.startswith('"""')
    assert len(text.splitlines()) <= (FIRST_LINES if example.name.startswith("00") else MOST_LINES)


def test_examples_are_numbered_without_gaps() -> None:
    assert [int(example.name[:2]) for example in EXAMPLES] == list(range(len(EXAMPLES)))


def test_the_first_example_writes_what_it_says(tmp_path: Path) -> None:
    run_small(EXAMPLES[0], tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first-render.exr", "first-render.png"]


@pytest.mark.parametrize("block", blocks(REPOSITORY / "README.md", "python"), ids=str)
def test_python_of_the_readme_runs(block: Block, tmp_path: Path) -> None:
    (tmp_path / "scenes").symlink_to(REPOSITORY / "scenes")
    # The region of the text lies outside of the small image, and nothing else does.
    text = block.text.replace("region(192, 320, 128, 192)", "region(6, 10, 4, 6)")
    program = tmp_path / "program.py"
    program.write_text(text, encoding="utf-8")
    assert "relative error" in run_small(program, tmp_path)
