"""The C++ tests that sit beside their headers (`src/**/*_test.cpp`): built by CMake, reported here file by file."""

from __future__ import annotations

import fcntl
import re
from pathlib import Path

import pytest

from tests.commands import REPOSITORY, run

BUILD = REPOSITORY / "build" / "cpp-tests"
FILES = sorted(path.relative_to(REPOSITORY).as_posix() for path in (REPOSITORY / "src").rglob("*_test.cpp"))
SUITE = re.compile(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,", re.MULTILINE)


@pytest.fixture(scope="session")
def program() -> Path:
    """The program that holds all tests. Only what changed is built again, and by one process at a time."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run("cmake", "-S", ".", "-B", str(BUILD), "-G", "Ninja", "-DACCURAY_TESTS=ON")
        run("cmake", "--build", str(BUILD), "--target", "accuray_tests", "--parallel", "2")
    return BUILD / "accuray_tests"


@pytest.mark.parametrize("name", FILES)
def test_cpp(name: str, program: Path) -> None:
    suites = sorted(set(SUITE.findall((REPOSITORY / name).read_text(encoding="utf-8"))))
    assert suites, f"{name} holds no test"
    # A suite may be instantiated with a prefix (parameters) or a suffix (types).
    patterns = [pattern for suite in suites for pattern in (f"{suite}.*", f"*/{suite}.*", f"{suite}/*")]
    output = run(str(program), "--gtest_brief=1", f"--gtest_filter={':'.join(patterns)}")
    assert re.search(r"[1-9]\d* tests? from", output), f"no test of {name} was run:\n{output}"
