#!/usr/bin/env python3
"""Checks that files stay small and points at functions that no longer fit a screen.

A file over its stop fails the check: reaching the stop means that a noun is missing, and the file is two. Tables of
data (`*_data.*`) are exempt. A long Python function is only named, because a table of cases may well be one; for C++
functions clang-tidy has the same limit.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

from source_tree import CPP_SUFFIXES, PYTHON_SUFFIXES, Violation, read_source, run_check, source_files

FILE_LIMIT = 600
KERNEL_LIMIT = 300
INTEGRATOR_LIMIT = 200
FUNCTION_LIMIT = 60  # lines: one screen


def line_limit(relative: Path) -> tuple[int, str]:
    """The most lines that a file may have, and what kind of file it is counted as."""
    parts = relative.parts
    if parts[:2] == ("src", "kernels") and not relative.stem.endswith("_test"):
        if parts[2] == "integrator":
            return INTEGRATOR_LIMIT, "an integrator"
        return KERNEL_LIMIT, "a kernel header"
    return FILE_LIMIT, "a source file"


def check_sizes(root: Path) -> Iterator[Violation]:
    """Yields each file below `root` that is over its stop."""
    for path in source_files(root, CPP_SUFFIXES | PYTHON_SUFFIXES):
        relative = path.relative_to(root)
        if relative.stem.endswith("_data"):
            continue
        lines = len(read_source(path).splitlines())
        limit, kind = line_limit(relative)
        if lines > limit:
            yield Violation(relative.as_posix(), 0, f"{lines} lines, and {kind} has at most {limit}")


def long_functions(root: Path) -> Iterator[Violation]:
    """Yields each Python function below `root` that has more lines than a screen."""
    for path in source_files(root, PYTHON_SUFFIXES):
        try:
            tree = ast.parse(read_source(path))
        except SyntaxError:
            continue  # the layer check reports it
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                if lines > FUNCTION_LIMIT:
                    where = path.relative_to(root).as_posix()
                    yield Violation(where, node.lineno, f"note: {node.name}() has {lines} lines and fits no screen")


def check_and_note(root: Path) -> Iterator[Violation]:
    """The check of the command line: prints the notes, which do not fail, and yields the violations."""
    for note in long_functions(root):
        print(note)
    yield from check_sizes(root)


if __name__ == "__main__":
    sys.exit(run_check("Checks the sizes of files and names functions that fit no screen.", check_and_note))
