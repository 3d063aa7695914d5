"""Frames of an animation: the bits of each, what is built for it, and what a second run finds finished."""

from __future__ import annotations

import copy
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import accuray
from accuray import devices
from accuray.devices.kept import same, stands_alone
from accuray.scene.textures import TextureUse

PYRAMID = "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nv 0.5 1 -0.5\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n"
FRAMES = (0, 3, 7)


def keys(first: Any, last: Any) -> dict[str, Any]:
    """From one value to another in the first second."""
    return {"keys": [{"time": 0, "value": first}, {"time": 1, "value": last}]}


def description(**changes: Any) -> dict[str, Any]:
    """A mesh of a file, one of arrays, a solid, instances, pictures and lamps; ``changes`` by dotted key."""
    rng = np.random.default_rng(3)
    table: dict[str, Any] = {
        "film": {"width": 16, "height": 12},
        "animation": {"fps": 10},
        "camera": {"type": "perspective", "position": [0, 1, 6]},
        "textures": {
            "photo": {"type": "image", "pixels": rng.random((8, 8, 3), dtype=np.float32), "filter": "mipmap"},
            "tiles": {"type": "checker"},
        },
        "materials": {
            "grey": {"type": "diffuse"},
            "photo": {"type": "diffuse", "reflectance": {"texture": "photo"}},
            "lamp": {"type": "diffuse", "emission": 3},
        },
        "lights": {"map": {"type": "environment", "pixels": rng.random((4, 8, 3), dtype=np.float32)}},
        "shapes": {
            "pyramid": {"type": "mesh", "material": "grey", "file": "pyramid.obj"},
            "cloud": {
                "type": "mesh",
                "material": "grey",
                "positions": rng.normal(size=(300, 3)),
                "faces": rng.integers(0, 300, (100, 3)),
                "shading": "smooth",
            },
            "pot": {"type": "teapot", "material": "photo", "segments": 4},
            "lamp": {"type": "sphere", "material": "lamp", "center": [0, 3, 0], "radius": 0.3},
            "part": {"type": "cube", "material": "grey", "prototype": True},
            "copy": {"type": "instance", "of": "part", "transform": {"translate": [2, 0, 0]}},
        },
    }
    for path, value in changes.items():
        section, *names = path.split("__")
        target = table.setdefault(section, {})
        for name in names[:-1]:
            target = target.setdefault(name, {})
        target[names[-1]] = value
    return table


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the mesh that the scene names."""
    (tmp_path / "pyramid.obj").write_text(PYRAMID, encoding="utf-8")
    return tmp_path


ALL = {"mesh": 4, "picture": 2, "tables": 1, "structure": 1}
CASES = {
    # what moves: (changes, what is built for each frame after the first)
    "nothing": ({}, {}),
    "camera": ({"camera__position": keys([0, 1, 6], [1, 1, 6])}, {}),
    "zoom and lens": ({"camera__fov": keys(40, 20), "camera__aperture_radius": keys(0.01, 0.2)}, {}),
    "exposure": ({"film__exposure": keys(0, 0.3), "film__unit": 1e-7}, {}),
    "material": ({"materials__grey__reflectance": keys(0.1, 0.9)}, {"tables": 1}),
    "emission": ({"materials__lamp__emission": keys([1, 1, 1], [0, 2, 5])}, {"tables": 1}),
    "texture": ({"textures__tiles__uv_rotate": keys(0, 90)}, {"tables": 1}),
    "light": ({"lights__map__scale": keys(1, 2)}, {"tables": 1}),
    "sphere": ({"shapes__lamp__center": keys([0, 3, 0], [0, 2, 0])}, {"tables": 1, "structure": 1}),
    "solid": ({"shapes__pot__height": keys(1, 2)}, {"tables": 1, "structure": 1, "mesh": 1}),
}


@pytest.mark.parametrize("case", CASES)
def test_only_what_changed_is_built_and_the_bits_are_those_of_the_frame_alone(case: str, folder: Path) -> None:
    changes, expected = CASES[case]
    scene = accuray.Scene.from_dict(description(**changes), folder=folder)
    held, before = [], None
    for frame in FRAMES:
        at = scene.at(frame)
        loaded = devices.load(at)
        assert loaded.parts.built == (ALL if frame == FRAMES[0] else expected), frame
        total = {
            kind: loaded.parts.built.get(kind, 0) + loaded.parts.kept.get(kind, 0)
            for kind in {*loaded.parts.built, *loaded.parts.kept}
        }
        assert total == ALL
        held.append(loaded)
        # What the instance shows is never built twice.
        assert loaded.core.built_prototypes == (0 if "structure" in expected and frame != FRAMES[0] else 1)
        image = accuray.render(at, spp=4)
        alone = accuray.render(accuray.Scene.from_dict(description(**changes), folder=folder, frame=frame), spp=4)
        assert image.pixels_equal(alone)
        assert image.film.identical(alone.film)
        assert image.metadata["scene_hash"] == alone.metadata["scene_hash"]
        if case not in ("nothing", "texture", "exposure"):
            assert before is None or not image.film.identical(before.film), "the frame does not differ"
        before = image
    assert len({loaded.core.structure for loaded in held}) == (len(FRAMES) if "structure" in expected else 1)


def test_frames_in_any_order_have_the_same_bits(folder: Path) -> None:
    table = description(
        camera__position=keys([0, 1, 6], [1, 1, 6]),
        materials__grey__reflectance=keys(0.1, 0.9),
        shapes__pot__height=keys(1, 2),
    )
    films = {}
    for order in itertools.permutations(FRAMES):
        scene = accuray.Scene.from_dict(table, folder=folder)
        for frame in order:
            film = accuray.render(scene.at(frame), spp=4).film
            assert film.identical(films.setdefault(frame, film))


def test_what_depends_on_other_things_is_not_kept() -> None:
    """A shape that reads a texture, or is measured in pixels, is not its own affair."""
    ball = accuray.Scene.from_dict(
        {"materials": {"m": {"type": "diffuse"}}, "shapes": {"b": {"type": "sphere", "material": "m"}}}
    )
    table = ball.shapes["b"]
    assert stands_alone(table)
    assert not stands_alone({**table, "displacement": TextureUse("bumps")})
    assert same(table, {**table})
    assert not same(table, {**table, "transform": object()})
    arrays = np.zeros(3), np.zeros(3, dtype=np.float32), np.zeros((3, 1))
    assert same(arrays[0], np.zeros(3))
    assert not any(same(arrays[0], other) for other in arrays[1:])


def test_a_file_is_read_once_for_all_frames(folder: Path) -> None:
    scene = accuray.Scene.from_dict(
        description(shapes__pyramid__crease_angle=30.0, camera__fov=keys(30, 40)), folder=folder
    )
    (folder / "pyramid.obj").write_text("broken", encoding="utf-8")
    assert scene.at(4).shapes["pyramid"]["positions"] is scene.shapes["pyramid"]["positions"]


def test_a_camera_that_becomes_one_of_another_kind() -> None:
    """A pinhole whose lens opens: the lowered camera is another struct."""
    table = {
        "film": {"width": 16, "height": 12},
        "animation": {"fps": 10},
        "camera": {"type": "perspective", "aperture_radius": keys(0.0, 0.5)},
        "lights": {"sky": {"type": "constant"}},
        "materials": {"grey": {"type": "diffuse"}},
        "shapes": {"ball": {"type": "sphere", "material": "grey"}},
    }
    scene = accuray.Scene.from_dict(table)
    for frame in (0, 5, 0):
        alone = accuray.render(accuray.Scene.from_dict(table, frame=frame), spp=4)
        assert accuray.render(scene.at(frame), spp=4).film.identical(alone.film)


def test_a_wrong_camera_of_one_frame_is_told() -> None:
    camera = {"type": "perspective", "position": keys([0, 0, 5], [0, 0, -5])}
    scene = accuray.Scene.from_dict({"animation": {"fps": 10}, "camera": camera})
    accuray.render(scene.at(0), spp=4, crop=(0, 0, 8, 8))
    with pytest.raises(accuray.SceneError, match="camera"):
        accuray.render(scene.at(5), spp=4)


def test_scenes_of_frames_can_be_copied(folder: Path) -> None:
    scene = accuray.Scene.from_dict(description(camera__fov=keys(30, 40)), folder=folder)
    first = accuray.render(scene.at(2), spp=4)
    again = copy.deepcopy(scene)
    assert accuray.render(again.at(2), spp=4).film.identical(first.film)


SCENE = """
accuray = 1
[film]
width = 16
height = 12
[render]
spp = 8
[animation]
fps = 10
[camera]
type = "perspective"
fov = { keys = [{ time = 0, value = 30 }, { time = 1, value = 60 }] }
[materials.grey]
type = "diffuse"
[shapes.ball]
type = "sphere"
material = "grey"
[lights.sky]
type = "constant"
"""


@pytest.fixture
def animation(tmp_path: Path) -> accuray.Scene:
    """A scene of a file."""
    path = tmp_path / "zoom.toml"
    path.write_text(SCENE, encoding="utf-8")
    return accuray.load(path)


def test_render_frames_saves_and_skips(animation: accuray.Scene, tmp_path: Path) -> None:
    output, seen = tmp_path / "zoom.###.exr", []
    first = list(accuray.render_frames(animation, "1-5x2", output=output, progress=lambda n, _: seen.append(n)))
    assert [(f.number, f.skipped, f.problem) for f in first] == [(1, False, ""), (3, False, ""), (5, False, "")]
    assert sorted(set(seen)) == [1, 3, 5]
    for frame in first:
        assert frame.path == tmp_path / f"zoom.{frame.number:03d}.exr"
        assert frame.path.with_suffix(".png").exists()
        assert accuray.Image.load(frame.path).film.identical(frame.image.film)
        assert frame.scene.clock.time == pytest.approx(frame.number / 10)
    times = {frame.path: frame.path.stat().st_mtime_ns for frame in first if frame.path}
    (tmp_path / "zoom.003.png").unlink()
    second = list(accuray.render_frames(animation, [5, 4, 3], output=output))
    assert [(f.number, f.skipped) for f in second] == [(5, True), (4, False), (3, True)]
    assert second[0].image.film.identical(first[2].image.film)
    assert (tmp_path / "zoom.003.png").exists()
    assert {path: path.stat().st_mtime_ns for path in times} == times


def test_render_frames_without_files(animation: accuray.Scene) -> None:
    images = [frame.image for frame in accuray.render_frames(animation, range(2), spp=4)]
    assert len(images) == 2
    assert not images[0].film.identical(images[1].film)


@pytest.mark.parametrize(
    ("arguments", "frame", "problem"),
    [
        ({}, 2, ""),
        ({"spp": 8}, 2, ""),
        ({"samples": (0, 8)}, 2, ""),
        ({"spp": 12}, 2, "holds other samples, or was interrupted"),
        ({"samples": (4, 8)}, 2, "holds other samples, or was interrupted"),
        ({"seed": 1}, 2, "holds another seed"),
        ({"crop": (0, 0, 8, 8)}, 2, "holds another part of the picture or other layers"),
        ({"layers": ["indirect"]}, 2, "holds another part of the picture or other layers"),
        ({}, 3, "holds another scene"),
    ],
)
def test_what_counts_as_finished(
    arguments: dict[str, Any], frame: int, problem: str, animation: accuray.Scene, tmp_path: Path
) -> None:
    path = tmp_path / "frame.exr"
    assert accuray.find_frame(path, animation.at(2)) == (None, "")
    image = accuray.render(animation.at(2))
    image.save(path)
    found = accuray.find_frame(path, animation.at(frame), **arguments)
    assert found.problem == problem
    assert (found.image is not None) == (problem == "")


def test_other_versions_looks_and_files_are_not_finished(animation: accuray.Scene, tmp_path: Path) -> None:
    path = tmp_path / "frame.exr"
    scene = animation.at(2)
    for key, value in (("version", "0.0.0"), ("exposure", 1.5), ("white_balance", [1.0, 1.0, 0.5])):
        image = accuray.render(scene)
        image.metadata[key] = value
        image.save(path)
        assert accuray.find_frame(path, scene).problem.startswith("holds another ")
    path.write_bytes(path.read_bytes()[:-100])
    assert accuray.find_frame(path, scene).image is None
    path.write_text("no picture", encoding="utf-8")
    assert accuray.find_frame(path, scene).problem
