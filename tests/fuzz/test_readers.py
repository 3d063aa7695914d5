"""Every reader meets damaged files in every run of the tests: cut off, with single bits flipped, and mutated.

A process of its own reads them, with limits of memory and time. `make fuzz` does the same for as long as one likes.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz.child import kind_of
from tests.fuzz.readers import READERS
from tests.fuzz.support import run_module
from tests.kernels.support import SEED

MUTANTS = 100
STEPS = 25
GROUPS = {
    "scenes": ("toml", "json", "override", "csv", "ies", "npy", "rows"),
    "models": ("gltf", "glb", "obj", "mtl", "ply", "stl", "cage-obj", "cage-ply"),
    "pictures": ("png", "jpg", "exr", "hdr", "tif", "tga", "bmp"),
    "images": ("film", "rgb", "decoder"),
}


@pytest.mark.parametrize("group", GROUPS)
def test_damaged_files_are_read_or_refused(group: str, tmp_path: Path) -> None:
    found: dict[str, dict[str, int]] = {}
    options = ["--runs", str(MUTANTS), "--sweep", str(STEPS), "--seed", str(SEED)]
    for line in run_module("tests.fuzz.child", tmp_path, *options, *GROUPS[group]):
        found |= line
    assert set(found) == set(GROUPS[group])
    for name, counts in found.items():
        assert counts["runs"] >= MUTANTS + 2 * STEPS, name
        assert counts["read"] < counts["runs"], name
        assert counts["longest"] < 2000, name
        assert counts["kinds"] > 2, name


def test_every_reader_is_in_a_group() -> None:
    assert sorted(name for names in GROUPS.values() for name in names) == sorted(READERS)


def test_kinds_of_messages_forget_numbers_and_names() -> None:
    assert kind_of('a.obj:12: "cube" has 5 numbers') == kind_of('a.obj:3: "box" has 77 numbers')
    assert kind_of(None) != kind_of("")
