"""Every shell command in the documentation runs.

All lines of the ```sh blocks of a page run one after the other in one folder that holds links to what a clone has, so
that later commands find the files of earlier ones. What would take long, need the network or change the machine is
replaced, as this table says; a command that no row matches fails the test.

| command | runs as |
|---|---|
| `make TARGET` | `make -n TARGET` in the repository: the target exists and its recipe can be expanded |
| `accuray render ...` | the same with `-q -w 16 --height 12`, and 4 samples unless it names some itself |
| `accuray verify ...` | `accuray verify ... --help`: the flags exist |
| other `accuray ...` | as it is |
| `python -m benchmarks...` | the same with `--help` in place of other arguments, in the repository |
| `python examples/...` | the small AccuRay of `small.py` |
| `python tools/...` | the same with `--help` in place of other arguments, in the repository |
| `python -m pytest ...` | the same with `--collect-only` |
| `ruff ...`, `clang-format ...` | the tool with `--version`, if it is installed |
| `... > FILE` | without the redirection |
| `pip`, `uv pip`, `uv build`, `uvx`, `venv`, `apt-get`, `unzip` | not run: `tests/packaging` runs what they do |
| `ffmpeg ...` | not run: it is not ours |
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from pages import PAGES, REPOSITORY, blocks, name_of

pytest.importorskip("accuray._core", reason="the compiled module is not built")

BIN = Path(sys.executable).parent
SMALL = Path(__file__).with_name("small.py")
LINKS = ("scenes", "examples", "tests", "pyproject.toml")
SIZE = ["-q", "-w", "16", "--height", "12"]
TOOLS = {"ruff", "clang-format"}
# Where a command of the pages writes to a file.
REDIRECTION = re.compile(r"\s*>\s*\S+$")
ELSEWHERE = {"ffmpeg", "pip", "apt-get", "venv", "uvx", "build", "unzip"}
PAGES_WITH_COMMANDS = [page for page in PAGES if blocks(page, "sh")]


def commands(page: Path) -> list[str]:
    """The commands of a page, without comments; a backslash joins lines."""
    found = []
    for block in blocks(page, "sh"):
        lines = block.text.replace("\\\n", " ").splitlines()
        found += [line for line in (re.sub(r"\s+#.*|^#.*", "", raw).strip() for raw in lines) if line]
    return found


def substitute(command: str) -> tuple[list[str], Path | None] | None:
    """What runs in place of a documented command, and where if not in the page's folder; None: nothing does."""
    words = shlex.split(REDIRECTION.sub("", command))
    if words[:2] == ["uv", "run"] and "--no-project" not in words:
        words = words[2:]
    words = [word for word in words if word != "sudo"]
    program = Path(words[0]).name
    if program == "make":
        return ["make", "-n", *words[1:]], REPOSITORY
    if ELSEWHERE & {program, *(words[1:3] if program in ("uv", "python3") else ())}:
        return None
    if program == "accuray":
        return [str(BIN / "accuray"), *small_arguments(words[1:])], None
    if program in ("python", "python3") and words[1] == "-m" and words[2] == "pytest":
        return [sys.executable, *words[1:], "--collect-only", "-q"], REPOSITORY
    if program in ("python", "python3") and words[1] == "-m" and words[2].startswith("benchmarks"):
        return [sys.executable, "-m", words[2], "--help"], REPOSITORY
    if program in ("python", "python3") and words[1].startswith("examples/"):
        return [sys.executable, str(SMALL), words[1]], None
    if program in ("python", "python3") and words[1].startswith("tools/"):
        return [sys.executable, words[1], "--help"], REPOSITORY
    if program in TOOLS:
        return ([str(BIN / program), "--version"], None) if (BIN / program).exists() else None
    raise AssertionError(f"no rule says how to test: {command}")


def small_arguments(words: list[str]) -> list[str]:
    """Arguments of `accuray`, so changed that the command takes a moment."""
    if words[:1] == ["verify"]:
        return [*words, "--help"]
    if words[:1] != ["render"]:
        return words
    few = [] if "--samples" in words or "--spp" in words else ["--spp", "4"]
    return [*words, *SIZE, *few]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder that looks like a clone, with the files that the pages speak of."""
    for name in LINKS:
        (tmp_path / name).symlink_to(REPOSITORY / name)
    for block in blocks(REPOSITORY / "docs/scene-format.md", "toml")[:1]:
        (tmp_path / "clay.toml").write_text(block.text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("page", PAGES_WITH_COMMANDS, ids=name_of)
def test_commands_of_a_page_run(page: Path, folder: Path) -> None:
    for command in commands(page):
        chosen = substitute(command)
        if chosen is None or (chosen[0][0] == "make" and shutil.which("make") is None):
            continue
        arguments, where = chosen
        done = subprocess.run(arguments, cwd=where or folder, capture_output=True, text=True, check=False, timeout=120)
        assert done.returncode == 0, f"{command}\nran as {shlex.join(arguments)}\n{done.stderr}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_make_targets_in_the_text_exist(page: Path) -> None:
    known = set(re.findall(r"^([a-z-]+):", (REPOSITORY / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    named = set(re.findall(r"`make ([a-z-]+)`", page.read_text(encoding="utf-8")))
    assert named <= known


def test_a_command_without_a_rule_fails() -> None:
    with pytest.raises(AssertionError, match="no rule"):
        substitute("curl -O something")


def test_pages_have_commands() -> None:
    """The search for blocks finds them: the three pages that a newcomer reads are there."""
    assert {"README.md", "CONTRIBUTING.md", "docs/scene-format.md"} <= {name_of(page) for page in PAGES_WITH_COMMANDS}
