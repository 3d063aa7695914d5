"""The C++ tests that sit beside their headers (`src/**/*_test.cpp`): built by CMake, run by CTest, reported here."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
BUILD = REPOSITORY / "build" / "cpp-tests"
TESTS = sorted(path.stem for path in (REPOSITORY / "src").rglob("*_test.cpp"))


def run(*command: str) -> str:
    """Runs a command in the repository, the tools of this Python's environment first; fails with its output."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    result = subprocess.run(
        command,
        cwd=REPOSITORY,
        env=os.environ | {"PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if result.returncode != 0:
        pytest.fail(f"{' '.join(command)}\n{result.stdout}", pytrace=False)
    return result.stdout


@pytest.fixture(scope="session")
def built_tests() -> Path:
    """The folder with the built tests. Only what changed is built again, and by one process at a time."""
    nanobind = run(sys.executable, "-m", "nanobind", "--cmake_dir").strip()
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run(
            *("cmake", "-S", ".", "-B", str(BUILD), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DACCURAY_TESTS=ON"),
            *(f"-DPython_EXECUTABLE={sys.executable}", f"-Dnanobind_DIR={nanobind}"),
        )
        run("cmake", "--build", str(BUILD), "--target", "cpp_tests", "--parallel", "2")
    return BUILD


@pytest.mark.parametrize("name", TESTS)
def test_cpp(name: str, built_tests: Path) -> None:
    run("ctest", "--test-dir", str(built_tests), "-R", f"^{name}$", "--no-tests=error", "--output-on-failure")
