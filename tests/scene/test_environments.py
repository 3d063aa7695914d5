"""Environment maps, suns and skies that are wrong: what the errors name. And what the colour space of a map is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from accuray import devices, load
from accuray.scene import Scene, SceneError

Table = dict[str, Any]
GREY = np.full((2, 4), 0.5)


def with_texel(value: float, channels: int = 3) -> Any:
    pixels = np.ones((2, 4, channels), dtype=np.float32)
    pixels[1, 2, channels - 1] = value
    return pixels


BAD = [
    ({}, "lights.l", "exactly one of file | pixels"),
    ({"pixels": np.zeros((0, 4))}, "lights.l.pixels", "at least 1 x 1"),
    ({"pixels": [[1, 2], [3]]}, "lights.l.pixels", "is not a picture"),
    ({"pixels": with_texel(np.nan)}, "lights.l.pixels", "row 1, column 2, channel 2"),
    ({"pixels": with_texel(np.inf)}, "lights.l.pixels", "not a finite number"),
    ({"pixels": with_texel(-0.25)}, "lights.l.pixels", "radiance -0.25: row 1, column 2, channel 2"),
    ({"pixels": with_texel(-0.25).astype(np.float16)}, "lights.l.pixels", "radiance -0.25"),
    ({"pixels": with_texel(2e30)}, "lights.l.pixels", "0 to 1e+30"),
    ({"pixels": GREY, "color_space": "data"}, "lights.l.color_space", '"auto", "srgb", "linear"'),
    ({"pixels": GREY, "scale": -1}, "lights.l.scale", "at least 0"),
    ({"pixels": GREY, "rotation": "2 m"}, "lights.l.rotation", "deg"),
    ({"pixels": GREY, "transform": {"scale": [1, 2, 1]}}, "lights.l.transform", "one scale"),
    ({"file": "missing.exr"}, "lights.l.file", '"missing.exr" does not exist'),
    ({"file": "../a.exr"}, "lights.l.file", "leads outside"),
    ({"type": "sun", "towards": [0, 0, 0]}, "lights.l.towards", "any length but zero"),
    ({"type": "sun", "towards": [0, 1, 0], "elevation": 3}, "lights.l.elevation", "`towards` and `elevation`"),
    ({"type": "sun", "elevation": 91}, "lights.l.elevation", "-90 to 90 deg"),
    ({"type": "sun", "angular_diameter": 0}, "lights.l.angular_diameter", "0.001 to 180 deg"),
    ({"type": "sun", "radiance": 1, "irradiance": 1}, "lights.l.radiance", "at once"),
    ({"type": "sky", "turbidity": 0.9}, "lights.l.turbidity", "1 to 10"),
    ({"type": "sky", "turbidity": 11}, "lights.l.turbidity", "1 to 10"),
    ({"type": "sky", "elevation": -1}, "lights.l.elevation", "0 to 90 degrees above it"),
    ({"type": "sky", "towards": [1, -0.1, 0]}, "lights.l.towards", "0 to 90 degrees above it"),
    ({"type": "sky", "ground_albedo": 1.5}, "lights.l.ground_albedo", "1.5"),
]


@pytest.mark.parametrize(("light", "key", "text"), BAD, ids=lambda value: value if isinstance(value, str) else "")
def test_errors_name_what_is_wrong(light: Table, key: str, text: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        devices.load(Scene.from_dict({"lights": {"l": {"type": "environment", **light}}}, folder=tmp_path))
    assert caught.value.key == key, str(caught.value)
    assert text in str(caught.value)


@pytest.mark.parametrize("content", [b"", b"#?RADIANCE\n\n-Y 4 +X 8\n", b"v/1\x01 no picture"])
def test_broken_files_are_named(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "map.hdr").write_bytes(content)
    scene = tmp_path / "scene.toml"
    scene.write_text('accuray = 1\n[lights.sky]\ntype = "environment"\nfile = "map.hdr"\n', encoding="utf-8")
    with pytest.raises(SceneError, match=r"scene\.toml:4: lights\.sky\.file: .*cannot be read") as caught:
        load(scene)
    assert '"map.hdr"' in str(caught.value)


@pytest.mark.parametrize(
    ("pixels", "expected"), [(np.full((2, 4), 128, dtype=np.uint8), "srgb"), (GREY, "linear"), (GREY * 9, "linear")]
)
def test_the_colour_space_follows_from_the_texels(pixels: Any, expected: str) -> None:
    light: Table = {"type": "environment", "pixels": pixels}
    assert Scene.from_dict({"lights": {"l": light}}).lights["l"]["color_space"] == expected
    said = Scene.from_dict({"lights": {"l": {**light, "color_space": "linear"}}})
    assert said.lights["l"]["color_space"] == "linear"


def test_the_identity_is_that_of_the_texels(tmp_path: Path) -> None:
    def identity(pixels: Any, **more: Any) -> str:
        return Scene.from_dict({"lights": {"l": {"type": "environment", "pixels": pixels, **more}}}).identity

    assert identity(GREY) == identity(GREY.copy())
    assert len({identity(GREY), identity(GREY * 2), identity(GREY, rotation=1), identity(GREY, visible=False)}) == 4
