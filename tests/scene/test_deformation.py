"""Meshes that deform while the shutter is open: keys of positions, normals and files, sampled at equal steps."""

from __future__ import annotations

import numpy as np
import pytest

import accuray
from accuray.formats.ply_writing import write_ply

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
FACES = [[0, 1, 2]]
SHUTTER = {"shutter_open": 0.0, "shutter_close": 1.0}


def scene_with(positions, animation=SHUTTER, **shape):
    return accuray.Scene.from_dict(
        {
            "animation": animation,
            "materials": {"grey": {"type": "diffuse"}},
            "lights": {"sky": {"type": "constant"}},
            "shapes": {"sheet": {"type": "mesh", "positions": positions, "faces": FACES, "material": "grey", **shape}},
        }
    )


def keyed(*pairs):
    return {"keys": [{"time": time, "value": value} for time, value in pairs]}


def test_two_keys_around_the_shutter_are_cut_to_it():
    scene = scene_with(keyed((-1.0, TRIANGLE), (3.0, TRIANGLE + 4.0)))
    np.testing.assert_allclose(scene.shapes["sheet"]["positions"], [TRIANGLE + 1.0, TRIANGLE + 2.0], atol=1e-6)


def test_what_stays_while_the_shutter_is_open_is_still():
    keys = keyed((0.0, TRIANGLE), (1.0, TRIANGLE), (2.0, TRIANGLE + 1.0))
    assert scene_with(keys).shapes["sheet"]["positions"].shape == (3, 3)
    later = scene_with(keys, {"shutter_open": 5.0, "shutter_close": 6.0})
    np.testing.assert_array_equal(later.shapes["sheet"]["positions"], TRIANGLE + 1.0)


def test_a_key_within_the_shutter_lies_on_the_grid():
    scene = scene_with(keyed((0.0, TRIANGLE), (0.25, TRIANGLE + 1.0), (1.0, TRIANGLE)))
    positions = scene.shapes["sheet"]["positions"]
    assert len(positions) == 5
    np.testing.assert_allclose(positions[:, 0, 0], [0.0, 1.0, 2 / 3, 1 / 3, 0.0], atol=1e-6)


def test_keys_that_no_grid_meets_are_followed_within_the_tolerance():
    time = 1.0 / np.pi
    positions = scene_with(keyed((0.0, TRIANGLE), (time, TRIANGLE + 1.0), (1.0, TRIANGLE))).shapes["sheet"]["positions"]
    grid = np.linspace(0.0, 1.0, len(positions))
    assert abs(np.interp(time, grid, positions[:, 0, 0]) - 1.0) <= 2e-3


def test_keys_too_close_together_are_refused():
    keys = keyed((0.0, TRIANGLE), (0.0011, TRIANGLE + 1.0), (0.0019, TRIANGLE), (1.0, TRIANGLE))
    with pytest.raises(accuray.SceneError, match=r"shapes\.sheet\.positions.*equally spaced"):
        scene_with(keys)


def test_files_as_keys(tmp_path):
    for name, offset in (("a", 0.0), ("b", 2.0)):
        write_ply(tmp_path / f"{name}.ply", {"positions": TRIANGLE + np.float32(offset), "faces": FACES})
    shape = {"type": "mesh", "file": keyed((0.0, "a.ply"), (1.0, "b.ply")), "material": "grey"}
    scene = accuray.Scene.from_dict(
        {"animation": SHUTTER, "materials": {"grey": {"type": "diffuse"}}, "shapes": {"sheet": shape}}, folder=tmp_path
    )
    np.testing.assert_array_equal(scene.shapes["sheet"]["positions"], [TRIANGLE, TRIANGLE + 2.0])


def test_the_identity_follows_the_forms_not_their_spelling():
    moving = scene_with(keyed((0.0, TRIANGLE), (1.0, TRIANGLE + 1.0)))
    longer = scene_with(keyed((-1.0, TRIANGLE - 1.0), (2.0, TRIANGLE + 2.0)))
    still = scene_with(keyed((0.0, TRIANGLE), (1.0, TRIANGLE)))
    assert moving.identity == longer.identity != still.identity == scene_with(TRIANGLE).identity


@pytest.mark.parametrize(
    ("shape", "problem"),
    [
        ({"positions": keyed((0, TRIANGLE), (1, TRIANGLE[:2]))}, "has 2 rows"),
        ({"positions": keyed((1, TRIANGLE), (0, TRIANGLE))}, "rising times"),
        ({"positions": keyed((0, TRIANGLE), (1, TRIANGLE * np.nan))}, "not finite"),
        ({"positions": {**keyed((0, TRIANGLE)), "interpolation": "smooth"}}, "linear"),
        ({"positions": keyed((0, TRIANGLE), (1, 2 * TRIANGLE)), "uvs": keyed((0, TRIANGLE[:, :2]))}, "is not a list"),
        ({"positions": keyed((0, TRIANGLE), (1, 2 * TRIANGLE)), "crease_angle": 30}, "creases"),
        ({"positions": keyed((0, TRIANGLE), (1, 2 * TRIANGLE)), "material": "lamp"}, "emits"),
    ],
)
def test_wrong_keys_are_refused(shape, problem):
    description = {
        "animation": SHUTTER,
        "materials": {"grey": {"type": "diffuse"}, "lamp": {"type": "diffuse", "emission": 1.0}},
        "shapes": {"sheet": {"type": "mesh", "faces": FACES, "material": "grey", **shape}},
    }
    with pytest.raises(accuray.SceneError, match=problem):
        accuray.Scene.from_dict(description)


def test_files_of_other_meshes_are_refused(tmp_path):
    write_ply(tmp_path / "a.ply", {"positions": TRIANGLE, "faces": FACES})
    write_ply(tmp_path / "b.ply", {"positions": TRIANGLE, "faces": [[0, 2, 1]]})
    shape = {"type": "mesh", "file": keyed((0.0, "a.ply"), (1.0, "b.ply")), "material": "grey"}
    with pytest.raises(accuray.SceneError, match="other faces"):
        accuray.Scene.from_dict({"materials": {"grey": {"type": "diffuse"}}, "shapes": {"s": shape}}, folder=tmp_path)
