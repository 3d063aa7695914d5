"""tools/check_sizes.py: this tree keeps the sizes, and a file over its stop is seen."""

from __future__ import annotations

from pathlib import Path

import pytest
from trees import REPOSITORY, check, plant


def test_this_tree_keeps_the_sizes() -> None:
    result = check("check_sizes", REPOSITORY)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("src/kernels/bsdf/diffuse.h", 300),
        ("src/kernels/integrator/path.h", 200),
        ("src/kernels/integrator/path_test.cpp", 600),
        ("src/engine/render.cpp", 600),
        ("accuray/film/film.py", 600),
        ("tests/test_film.py", 600),
    ],
)
def test_stop_is_exact(tmp_path: Path, name: str, limit: int) -> None:
    plant(tmp_path, name, "\n" * limit)
    assert check("check_sizes", tmp_path).returncode == 0
    plant(tmp_path, name, "\n" * (limit + 1))
    result = check("check_sizes", tmp_path)
    assert result.returncode == 1
    assert f"{name}: {limit + 1} lines" in result.stdout


def test_data_tables_are_exempt(tmp_path: Path) -> None:
    plant(tmp_path, "src/kernels/spectrum/cie_data.h", "\n" * 5000)
    assert check("check_sizes", tmp_path).returncode == 0


def test_long_function_is_named_but_passes(tmp_path: Path) -> None:
    fits = "def fits():\n" + "    x = 1\n" * 59
    plant(tmp_path, "accuray/film/a.py", fits + "def long():\n" + "    x = 1\n" * 60)
    result = check("check_sizes", tmp_path)
    assert result.returncode == 0
    assert "accuray/film/a.py:61: note: long() has 61 lines" in result.stdout
    assert "fits()" not in result.stdout
