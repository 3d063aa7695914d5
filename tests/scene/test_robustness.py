"""Damaged scene files: whatever the text is, loading gives a Scene or a SceneError, never another exception."""

from __future__ import annotations

import random
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray.formats import load
from accuray.scene import Scene, SceneError

SCENES = Path(__file__).resolve().parents[2] / "scenes"


@pytest.mark.parametrize("name", ["spheres", "closed-box", "mirror-and-glass"])
def test_damaged_bytes(name: str, tmp_path: Path) -> None:
    """Deleted, repeated and replaced bytes, 60 times a scene, always the same ones."""
    content = (SCENES / f"{name}.toml").read_bytes()
    (tmp_path / "parts").symlink_to(SCENES / "parts")
    generator = random.Random(7)
    longest = 0
    for round_ in range(60):
        damaged = bytearray(content)
        for _ in range(generator.randrange(1, 4)):
            at = generator.randrange(len(damaged))
            piece = bytes(generator.choice([b"", b"[", b"]", b'"', b"{", b"1e999", b"nan", b"-", b"\xff", b"\n"]))
            damaged[at : at + generator.randrange(3)] = piece
        path = tmp_path / f"s{round_}.toml"
        path.write_bytes(bytes(damaged))
        try:
            load(path)
        except SceneError as error:
            longest = max(longest, len(str(error)))
    assert 0 < longest < 2000


@pytest.mark.parametrize("name", ["spheres", "cornell-box"])
def test_every_prefix_is_a_scene_or_an_error(name: str, tmp_path: Path) -> None:
    content = (SCENES / f"{name}.toml").read_bytes()
    (tmp_path / "parts").symlink_to(SCENES / "parts")
    path = tmp_path / "s.toml"
    for end in range(0, len(content), 31):
        path.write_bytes(content[:end])
        with suppress(SceneError):
            load(path, roots=[SCENES])


_LEAVES = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=6)
    | st.sampled_from(["diffuse", "sphere", "mesh", "point", "35 mm", "D65", "m", "6500 K", "builtin:x.csv"])
)
_KEYS = st.sampled_from(
    ["type", "material", "radius", "positions", "faces", "transform", "translate", "rotate", "axis", "angle", "matrix",
     "scale", "reflectance", "emission", "value", "rgb", "file", "wavelengths", "values", "m", "of", "metal", "ior"]
)  # fmt: skip
_VALUES = st.recursive(
    _LEAVES, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(_KEYS, inner, max_size=4), max_leaves=10
)
_SECTIONS = st.sampled_from(
    ["accuray", "length_unit", "film", "camera", "integrator", "render", "spectra", "materials", "lights", "shapes"]
)


@STEADY
@given(st.dictionaries(_SECTIONS, _VALUES, max_size=5))
def test_any_structure_is_a_scene_or_an_error(description: dict[str, Any]) -> None:
    with suppress(SceneError):
        Scene.from_dict(description)


def test_lists_that_contain_themselves() -> None:
    loop: list[Any] = []
    loop.append(loop)
    for value in (loop, [loop] * 3):
        with pytest.raises(SceneError):
            Scene.from_dict({"camera": {"type": "perspective", "position": value}})
        with pytest.raises(SceneError):
            Scene.from_dict({"materials": {"m": {"type": "diffuse", "reflectance": value}}})
