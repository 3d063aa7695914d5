#!/usr/bin/env python3
"""Checks who may use whom: C++ includes and Python imports against the layers of the design.

The tables below are the rules. A room is a folder of `src/` or of `accuray/`. Kernels are also held to the language
that every device compiler understands: no standard header, no allocation, no exceptions, no virtual functions, and
nothing that asks which compiler is running outside `port.h`.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from source_tree import CPP_SUFFIXES, PYTHON_SUFFIXES, Violation, read_source, run_check, source_files, without_text

# C++ room -> the other rooms that it may include.
CPP_LAYERS: dict[str, frozenset[str]] = {
    "kernels": frozenset(),
    "mesh": frozenset(),
    "lower": frozenset({"kernels", "mesh"}),
    "engine": frozenset({"kernels"}),
    "bindings": frozenset({"kernels", "mesh", "lower", "engine"}),
}

# Python room -> the other modules of `accuray` that it may import; a name covers everything below it, and "" is
# `import accuray` itself. Two rooms are part of the public API. `data` holds only tables, so every room may read it.
PUBLIC = frozenset({"", "verify", "testing"})
PYTHON_LAYERS: dict[str, frozenset[str]] = {
    "data": frozenset(),
    "scene": frozenset({"data", "_core.schema"}),
    "formats": frozenset({"data", "scene", "_core.mesh"}),
    "film": frozenset({"data", "testing"}),
    "devices": frozenset({"data", "scene", "film", "_core"}),
    "render": frozenset({"data", "scene", "film", "devices"}),
    "farm": PUBLIC,
    "studio": PUBLIC,
    "verify": PUBLIC | {"data"},
    "cli": PUBLIC,
    "testing": PUBLIC,
}
# Rooms that may import, besides the standard library, only these packages of others.
FOREIGN_PACKAGES: dict[str, frozenset[str]] = {"testing": frozenset({"numpy"})}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)

# What a kernel may not say, and why. Searched in code without comments and literals.
KERNEL_BANS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"\bstd\s*::\s*\w+"), "a device compiler has no standard library; take the name from port.h"),
    (re.compile(r"\bnew\b"), "kernels do not allocate"),
    (re.compile(r"(?<!=\s)(?<!=)\bdelete\b"), "kernels do not allocate"),
    (re.compile(r"\b(?:malloc|calloc|realloc|free|alloca)\s*\("), "kernels do not allocate"),
    (re.compile(r"\b(?:throw|try|catch)\b"), "kernels know no exceptions"),
    (re.compile(r"\b(?:virtual|dynamic_cast|typeid)\b"), "kernels dispatch over type lists, not virtual functions"),
    (
        re.compile(r"\b(?:__[A-Z]\w*|_MSC_VER|_WIN32|__(?:clang|linux|x86_64|has|attribute)_\w*)"),
        "only port.h knows which compiler is running",
    ),
    (
        re.compile(r"\b(?:__(?:host|device|global|shared|forceinline|restrict)(?:__)?\b|asm\b|_mm\d*_\w+)"),
        "only port.h knows what a compiler or a device adds to C++",
    ),
)


def line_of(text: str, position: int) -> int:
    """The line, from 1, of a position in a text."""
    return text.count("\n", 0, position) + 1


def check_cpp_file(root: Path, path: Path) -> Iterator[Violation]:
    """Yields the layer violations of one file of `src/`."""
    where = path.relative_to(root).as_posix()
    room = path.relative_to(root / "src").parts[0]
    if room not in CPP_LAYERS:
        yield Violation(where, 0, f"src/{room} is no room of the design; rooms are {', '.join(CPP_LAYERS)}")
        return
    text = read_source(path)
    is_kernel = room == "kernels" and not path.stem.endswith("_test")
    for match in INCLUDE.finditer(text):
        ours, foreign = match.groups()
        line = line_of(text, match.start(match.lastindex or 0))
        if ours is not None:
            target = included_room(root, path, ours)
            if target is None:
                yield Violation(where, line, f'"{ours}" is no file below src/; system headers take <>')
            elif target != room and target not in CPP_LAYERS[room]:
                yield Violation(where, line, f"{room} may not include {target} ({ours})")
        elif is_kernel and path.name != "port.h":
            yield Violation(where, line, f"kernels include no system header (<{foreign}>): only port.h does")
    if is_kernel and path.name != "port.h":
        yield from check_kernel_language(where, text)


def included_room(root: Path, includer: Path, name: str) -> str | None:
    """The room of the file that `#include "name"` means, or None if there is no such file in `src/`."""
    source = (root / "src").resolve()
    for base in (source, includer.parent.resolve()):
        target = (base / name).resolve()
        if target.is_file() and target.is_relative_to(source):
            return target.relative_to(source).parts[0]
    return None


def check_kernel_language(where: str, text: str) -> Iterator[Violation]:
    """Yields each use in a kernel header of what device compilers lack."""
    code = without_text(text)
    for pattern, reason in KERNEL_BANS:
        for match in pattern.finditer(code):
            yield Violation(where, line_of(code, match.start()), f"{match.group()}: {reason}")


def imported_modules(tree: ast.Module, package: str) -> Iterator[tuple[int, str]]:
    """Yields (line, dotted name) for each import in a module of `package`, relative ones resolved.

    `from a import b` gives `a.b`: whether b is a module or a name in a, it may be judged by what its front says.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package.split(".")
                above = ".".join(parents[: len(parents) - node.level + 1])
                base = f"{above}.{base}" if base else above
            for alias in node.names:
                yield node.lineno, f"{base}.{alias.name}"


def room_of_module(name: str) -> str:
    """What a module of ours belongs to: "scene", "_core.schema", ..., or "" for a name of the public API."""
    inner = name.split(".")[1:]
    if inner[:1] == ["_core"]:
        return ".".join(inner[:2])
    return inner[0] if inner and inner[0] in PYTHON_LAYERS else ""


def check_python_file(root: Path, path: Path) -> Iterator[Violation]:
    """Yields the layer violations of one file of a room of `accuray/`, or of `blender/`."""
    where = path.relative_to(root).as_posix()
    parts = path.relative_to(root).parts
    if parts[0] == "blender":
        room, allowed = "blender", PUBLIC
    elif len(parts) == 2:
        return  # accuray/__init__.py and its neighbours make up the public API and reach every room
    else:
        room = parts[1]
        if room not in PYTHON_LAYERS:
            yield Violation(where, 0, f"accuray/{room} is no room of the design; rooms are {', '.join(PYTHON_LAYERS)}")
            return
        allowed = PYTHON_LAYERS[room]

    try:
        tree = ast.parse(read_source(path), filename=where)
    except SyntaxError as error:
        yield Violation(where, error.lineno or 0, f"cannot be parsed: {error.msg}")
        return
    for line, name in imported_modules(tree, ".".join(parts[:-1])):
        front = name.split(".")[0]
        if front == "accuray":
            target = room_of_module(name)
            if target != room and not is_allowed(target, allowed):
                what = f"accuray.{target}" if target else "the public API (accuray)"
                yield Violation(where, line, f"{room} may not import {what}")
        elif room in FOREIGN_PACKAGES and front not in FOREIGN_PACKAGES[room] | sys.stdlib_module_names:
            yield Violation(where, line, f"{room} may import only {', '.join(FOREIGN_PACKAGES[room])}, not {front}")


def is_allowed(target: str, allowed: frozenset[str]) -> bool:
    """True if a name in `allowed` is the target or covers it."""
    return any(target == name or (name and target.startswith(f"{name}.")) for name in allowed)


def check_layers(root: Path) -> Iterator[Violation]:
    """Yields every layer violation in the tree below `root`."""
    for path in source_files(root, CPP_SUFFIXES):
        if path.is_relative_to(root / "src"):
            yield from check_cpp_file(root, path)
    for path in source_files(root, PYTHON_SUFFIXES):
        if path.is_relative_to(root / "accuray") or path.is_relative_to(root / "blender"):
            yield from check_python_file(root, path)


if __name__ == "__main__":
    sys.exit(run_check("Checks the layers of the design.", check_layers))
