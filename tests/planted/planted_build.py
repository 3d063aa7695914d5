"""Builds AccuRay from a copy of its sources with a bug planted in it, and measures cases with that copy.

A copy lies in build/planted/NAME and stays there: a second run compiles only what has changed since. ccache shares
what the bug does not touch with the other copies.
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from planted_bugs import Change

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("CMakeLists.txt", "src", "accuray")
BUILDS = ROOT / "build" / "planted"
JOBS = 2

MEASURE = """
import json, sys
sys.path.insert(0, sys.argv[1])
import accuray._core
import extra_cases
from accuray.verify import runner
assert accuray._core.__file__.startswith(sys.argv[2]), accuray._core.__file__
chosen = [case for case in extra_cases.cases() if case.id in sys.argv[3:]]
rows = [row for case in chosen for row in runner.measure(case, runner.QUICK)]
print(json.dumps([[row.id, row.verdict, row.measured, row.error, row.expected] for row in rows]))
"""


class DoesNotApply(Exception):
    """A change's text is not in its file exactly once."""


class BuildFailed(Exception):
    """The copy does not compile; the compiler's words are the message."""


def sources() -> Iterator[str]:
    """Names of the files that make the package, relative to the repository."""
    for name in COPIED:
        path = ROOT / name
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file() and "__pycache__" not in file.parts:
                yield file.relative_to(ROOT).as_posix()


def applied(changes: tuple[Change, ...]) -> dict[str, str]:
    """The texts of the changed files, by name.

    Raises:
        DoesNotApply: the source has moved on; the table has to follow it.
    """
    texts: dict[str, str] = {}
    for change in changes:
        path = ROOT / change.file
        if not path.is_file():
            raise DoesNotApply(f"{change.file}: there is no such file")
        text = texts.get(change.file) or path.read_text(encoding="utf-8")
        found = text.count(change.old)
        if found != 1:
            raise DoesNotApply(f"{change.file}: {change.old!r} is there {found} times, not once")
        texts[change.file] = text.replace(change.old, change.new)
    return texts


def make_copy(folder: Path, changes: tuple[Change, ...]) -> None:
    """Brings the copy up to date; files that stay as they were keep their times, so nothing compiles them again."""
    changed = applied(changes)
    wanted = {name: changed.get(name, "").encode() or (ROOT / name).read_bytes() for name in sources()}
    for name in COPIED:
        for file in sorted((folder / name).rglob("*")):
            if file.is_file() and file.suffix != ".so" and file.relative_to(folder).as_posix() not in wanted:
                file.unlink()
    for name, content in wanted.items():
        file = folder / name
        if not (file.is_file() and file.read_bytes() == content):
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)


def build(name: str, changes: tuple[Change, ...]) -> Path:
    """The folder of a copy with the changes, compiled.

    Raises:
        DoesNotApply: see `applied`.
        BuildFailed: CMake, the compiler or the linker failed.
    """
    folder = BUILDS / name
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder / "lock"):
        make_copy(folder, changes)
        nanobind = run([sys.executable, "-m", "nanobind", "--cmake_dir"], folder).strip()
        settings = {
            "SKBUILD": "2",
            "SKBUILD_SABI_COMPONENT": "Development.SABIModule",
            "nanobind_DIR": nanobind,
            "Python_EXECUTABLE": sys.executable,
            "ACCURAY_WERROR": "OFF",  # what a bug leaves unused is no matter
        }
        options = [f"-D{key}={value}" for key, value in settings.items()]
        run(["cmake", "-S", ".", "-B", "build", "-G", "Ninja", *options], folder)
        run(["cmake", "--build", "build", "--target", "_core", "--parallel", str(JOBS)], folder)
        for module in (folder / "build").glob("_core*.so"):
            shutil.copy2(module, folder / "accuray" / module.name)
    return folder


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """One process at a time."""
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def run(command: list[str], folder: Path) -> str:
    """Standard output of a command, with this Python's tools first in the path and ccache sharing between folders."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    sharing = {"CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}
    result = subprocess.run(
        command, cwd=folder, env=os.environ | sharing | {"PATH": path}, capture_output=True, text=True, check=False
    )
    if result.returncode != 0:
        raise BuildFailed(f"{' '.join(command)}\n{result.stdout}\n{result.stderr}")
    return result.stdout


def measure(folder: Path, cases: tuple[str, ...]) -> list[tuple[str, str, float, float, float]]:
    """Rows (id, verdict, measured, error, expected) of the cases by the copy in a process of its own.

    Without the site module, which would put the installed package before the copy.
    """
    paths = os.pathsep.join([str(folder), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")])
    command = [sys.executable, "-S", "-c", MEASURE, str(Path(__file__).parent), str(folder), *cases]
    result = subprocess.run(
        command, cwd=folder, env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True, check=False
    )
    if result.returncode != 0:
        raise RuntimeError(f"measuring {', '.join(cases)} failed:\n{result.stderr}")
    return [tuple(row) for row in json.loads(result.stdout.splitlines()[-1])]
