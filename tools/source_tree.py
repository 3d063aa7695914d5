"""What the checks of this folder share: the files of a source tree, C++ without its text, and the report."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

CPP_SUFFIXES = frozenset({".h", ".cpp", ".cu"})
PYTHON_SUFFIXES = frozenset({".py"})

# The folders that hold source. Everything else in a checkout (environments, build products, pictures) is not ours.
SOURCE_FOLDERS = ("src", "accuray", "blender", "tests", "tools", "benchmarks", "examples")

# A comment, or a literal of either kind; raw strings first, because their quotes follow no escapes.
_CPP_TEXT = re.compile(
    r"""
      //[^\n]*
    | /\*.*?\*/
    | (?:u8|[uUL])?R"(?P<delimiter>[^\s()\\]{0,16})\(.*?\)(?P=delimiter)"
    | "(?:\\.|[^"\\\n])*"
    | (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'
    """,
    re.VERBOSE | re.DOTALL,
)


@dataclass(frozen=True, order=True)
class Violation:
    """One broken rule. `path` is relative to the checked root; `line` counts from 1, 0 means the whole file."""

    path: str
    line: int
    message: str

    def __str__(self) -> str:
        place = f"{self.path}:{self.line}" if self.line else self.path
        return f"{place}: {self.message}"


def source_files(root: Path, suffixes: frozenset[str]) -> Iterator[Path]:
    """Yields the source files below `root` with one of the suffixes, in a fixed order."""
    for folder in SOURCE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in suffixes and path.is_file():
                yield path


def read_source(path: Path) -> str:
    """The text of a source file; bytes that are no UTF-8 become the replacement character."""
    return path.read_text(encoding="utf-8", errors="replace")


def without_text(cpp: str) -> str:
    """C++ with comments and literals blanked out; line numbers stay as they are."""
    return _CPP_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), cpp)


def run_check(description: str, check: Callable[[Path], Iterable[Violation]]) -> int:
    """Runs `check` on the tree that the command line names; prints what it finds. Returns the exit status."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[1], help="the tree to check")
    root: Path = parser.parse_args().root
    violations = sorted(set(check(root)))
    for violation in violations:
        print(violation)
    if violations:
        print(f"{Path(sys.argv[0]).name}: {len(violations)} violation{'s' if len(violations) > 1 else ''}")
    return 1 if violations else 0
