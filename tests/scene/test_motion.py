"""Keyed transforms and the shutter: what scenes may say, what is interpolated how, and what the identity covers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import accuray
from accuray.scene import rotations
from accuray.scene.motion import Motion

Array = NDArray[np.float64]
Y = [0.0, 1.0, 0.0]


def scene(transform: Any, kind: str = "sphere", animation: Any = None, **more: Any) -> accuray.Scene:
    shape = {"type": kind, "material": "grey", "transform": transform}
    return accuray.Scene.from_dict(
        {
            "materials": {"grey": {"type": "diffuse"}},
            "animation": animation or {"shutter_open": 0, "shutter_close": 1},
            "shapes": {"body": shape},
            **more,
        }
    )


def keyed(*keys: Any) -> dict[str, Any]:
    return {"keys": [{"time": index / max(len(keys) - 1, 1), **key} for index, key in enumerate(keys)]}


def motion(*keys: Any, kind: str = "cube") -> Motion:
    found = scene(keyed(*keys), kind).shapes["body"]["transform"]
    assert isinstance(found, Motion)
    return found


def rotation(axis: Any, degrees: float) -> Array:
    """Rodrigues 1840, with numpy."""
    x, y, z = np.asarray(axis, dtype=np.float64) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = math.radians(degrees)
    return np.asarray(np.eye(3) + math.sin(a) * cross + (1 - math.cos(a)) * cross @ cross)


def about(axis: Any, **angle: float) -> dict[str, Any]:
    return {"rotate": {"axis": axis, **angle}}


def test_translation_and_scale_change_in_straight_lines() -> None:
    found = motion({"translate": [1, 0, 0], "scale": 1}, {"translate": [3, 4, 0], "scale": [2, 3, 1]}).at(0.25)
    assert found == pytest.approx(np.array([[1.25, 0, 0, 1.5], [0, 1.5, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]]))


@pytest.mark.parametrize("last", [{"angle": 900.0}, {"turns": 2.5}])
def test_a_shared_axis_turns_as_often_as_the_keys_say(last: dict[str, float]) -> None:
    found = motion(about(Y, angle=0), about([0, 2, 0], **last))
    for share in (0.1, 0.37, 0.9):
        assert found.at(share)[:3, :3] == pytest.approx(rotation(Y, 900 * share), abs=1e-12)


def test_opposite_axes_are_one_and_a_key_without_a_rotation_shares_any() -> None:
    found = motion(about(Y, angle=30), about([0, -1, 0], angle=330), {})
    assert found.at(0.25)[:3, :3] == pytest.approx(rotation(Y, -150), abs=1e-12)
    assert found.at(0.75)[:3, :3] == pytest.approx(rotation(Y, -165), abs=1e-12)


def test_other_rotations_go_the_shorter_way() -> None:
    """Halfway, what is left to turn is what has been turned: R(1/2) R(0)^-1 R(1/2) = R(1)."""
    a, b = rotation([1, 0, 0], 100), rotation([1, 2, 3], 250)
    found = motion(about([1, 0, 0], angle=100), about([1, 2, 3], angle=250))
    half = found.at(0.5)[:3, :3]
    assert half @ a.T @ half == pytest.approx(b, abs=1e-12)
    turned = math.degrees(math.acos((np.trace(a.T @ half) - 1) / 2))
    assert turned == pytest.approx(math.degrees(math.acos((np.trace(a.T @ b) - 1) / 2)) / 2)
    assert turned < 90


def test_matrices_are_taken_apart_and_put_together_again() -> None:
    rng = np.random.default_rng(1)
    for sign in (1, -1):
        matrices = []
        for _ in range(2):
            linear = rotation(rng.normal(size=3), 50) @ np.diag([1, 2, sign * 0.5])
            matrix = np.eye(4)
            matrix[:3, :3], matrix[:3, 3] = 1e3 * linear, rng.normal(size=3)
            matrices.append(matrix)
        found = motion(*({"matrix": [float(v) for v in m.ravel()]} for m in matrices))
        for share, matrix in zip((0.0, 1.0), matrices, strict=True):
            assert found.at(share) == pytest.approx(matrix, rel=1e-12, abs=1e-9)


def test_the_polar_rotation_is_the_one_of_the_singular_values() -> None:
    rng = np.random.default_rng(2)
    for _ in range(50):
        matrix = rng.normal(size=(3, 3)) * 10.0 ** rng.integers(-6, 6)
        matrix *= np.sign(np.linalg.det(matrix))
        u, _, vt = np.linalg.svd(matrix)
        turn, stretch = rotations.polar(matrix.tolist())
        rows = np.array(rotations.rows_of(turn))[:3, :3]
        assert rows == pytest.approx(u @ vt, abs=1e-9)
        assert rows @ np.array(stretch) == pytest.approx(matrix, rel=1e-9, abs=1e-9 * np.abs(matrix).max())


def test_the_arc_tangent_of_the_way() -> None:
    for degrees in (1e-9, 0.1, 37.0, 90.0, 179.0, 180.0):
        _, found = rotations.way(rotations.UPRIGHT, rotations.quaternion_about((0.6, 0.0, 0.8), degrees))
        assert found == pytest.approx(degrees, rel=1e-13)


def test_outside_the_keys_it_stays_what_it_was() -> None:
    keys = {"keys": [{"time": 2, "translate": [1, 0, 0]}, {"time": "3000 ms", "translate": [2, 0, 0]}]}
    for opens, x in ((0, 1.0), (5, 2.0)):
        still = scene(keys, animation={"shutter_open": opens, "shutter_close": opens + 1}).shapes["body"]["transform"]
        assert isinstance(still, np.ndarray)
        assert still[0, 3] == x
    half = scene(keys, animation={"shutter_open": 2.5, "shutter_close": 2.5}).shapes["body"]["transform"]
    assert isinstance(half, np.ndarray)
    assert half[0, 3] == 1.5


def test_what_does_not_move_is_the_same_scene_as_a_still_one() -> None:
    keys = keyed({"translate": [1, 0, 0]}, {"translate": [1, 0, 0]}, {"translate": [1, 0, 0]})
    assert scene(keys).identity == scene({"translate": [1, 0, 0]}).identity
    shaped = {"shutter_open": 0, "shutter_close": 1, "shutter_shape": "triangle"}
    assert scene(keys, animation=shaped).identity == scene({"translate": [1, 0, 0]}).identity


def test_the_identity_covers_the_keys_about_the_shutter_and_its_shape() -> None:
    def moving(*extra: Any, **animation: Any) -> str:
        keys = {"keys": [{"time": 0}, {"time": 1, "translate": [1, 0, 0]}, *extra]}
        return scene(keys, animation={"shutter_open": 0, "shutter_close": 1, **animation}).identity

    assert moving() == moving({"time": 2, "translate": [7, 7, 7]})
    different = [
        moving(),
        moving(shutter_close=0.5),
        moving(shutter_shape="triangle"),
        moving(shutter_shape="trapezoid"),
        moving(shutter_shape="trapezoid", shutter_ramp=0.1),
        scene(keyed({}, {"translate": [1, 0, 0]}, {"translate": [1, 0, 0]})).identity,
    ]
    assert len(set(different)) == len(different)


def test_a_camera_starts_at_the_origin_where_a_transform_places_it() -> None:
    placed = accuray.Scene.from_dict({"camera": {"type": "perspective", "transform": {"translate": [1, 2, 3]}}})
    assert placed.camera["position"] == (0, 0, 0)
    assert placed.camera["look_at"] == (0, 0, -1)
    said = {"type": "perspective", "transform": {"translate": [1, 2, 3]}, "position": [0, 0, 9]}
    assert accuray.Scene.from_dict({"camera": said}).camera["position"] == (0, 0, 9)


STEP = {"time": 0, "translate": [0, 0, 0]}


@pytest.mark.parametrize(
    ("transform", "key", "text"),
    [
        ({"keys": []}, "keys", "list of keys"),
        ({"keys": [1]}, "keys[0]", "not a key"),
        ({"keys": [{"translate": [0, 0, 0]}]}, "keys[0]", "not a key"),
        ({"keys": [STEP, STEP]}, "keys[1].time", "not later"),
        ({"keys": [{"time": "1 m"}]}, "keys[0].time", ""),
        ({"keys": [{"time": 0, "turn": 1}]}, "keys[0].turn", "part of a transform"),
        ({"keys": [{"time": 0, "rotate": {"axis": Y, "angle": 1, "turns": 1}}]}, "keys[0].rotate", "not a rotation"),
        ({"keys": [{"time": 0, "rotate": {"axis": Y, "turns": "x"}}]}, "keys[0].rotate.turns", "not a number"),
        ({"keys": [STEP], "interpolation": "x"}, "interpolation", "keyed"),
        (keyed({"scale": 1}, {"scale": -1}), "keys", "flatten"),
        (keyed({"scale": 1}, {"scale": [-1, -1, 1]}), "keys", "flatten"),
        (keyed({}, {"scale": [1, 2, 1]}), "", "stretches"),
    ],
)
def test_bad_keys_are_named(transform: Any, key: str, text: str) -> None:
    with pytest.raises(accuray.SceneError, match=text) as caught:
        scene(transform)
    assert caught.value.key == ".".join(part for part in ("shapes.body.transform", key) if part)


@pytest.mark.parametrize(
    ("animation", "key"),
    [
        ({"shutter_open": 1, "shutter_close": 0}, "shutter_close"),
        ({"shutter_shape": "round"}, "shutter_shape"),
        ({"shutter_ramp": 0.6}, "shutter_ramp"),
        ({"shutter_curve": [[0, 1]]}, "shutter_curve"),
        ({"shutter_curve": [[0, 1], [0.5, 1]]}, "shutter_curve"),
        ({"shutter_curve": [[0, 1], [0, 1], [1, 1]]}, "shutter_curve[1][0]"),
        ({"shutter_curve": [[0, 0], [1, 0]]}, "shutter_curve"),
        ({"shutter_curve": [[0, -1], [1, 0]]}, "shutter_curve[0][1]"),
        ({"shutter_curve": [[0, 1], [1, 0]], "shutter_shape": "box"}, "shutter_curve"),
    ],
)
def test_bad_shutters_are_named(animation: Any, key: str) -> None:
    with pytest.raises(accuray.SceneError) as caught:
        scene({"scale": 1}, animation=animation)
    assert caught.value.key == f"animation.{key}"


def test_what_stands_still_takes_no_keys() -> None:
    moving = keyed({}, {"translate": [1, 0, 0]})
    with pytest.raises(accuray.SceneError, match="its instances") as caught:
        accuray.Scene.from_dict(
            {
                "materials": {"grey": {"type": "diffuse"}},
                "animation": {"shutter_open": 0, "shutter_close": 1},
                "shapes": {"body": {"type": "cube", "material": "grey", "prototype": True, "transform": moving}},
            }
        )
    assert caught.value.key == "shapes.body.transform"
    with pytest.raises(accuray.SceneError, match="stands still"):
        accuray.Scene.from_dict(
            {"lights": {"sky": {"type": "environment", "pixels": np.ones((2, 4, 3), np.float32), "transform": moving}}}
        )
    with pytest.raises(accuray.SceneError, match="mirrors"):
        accuray.Scene.from_dict({"camera": {"type": "perspective", "transform": {"scale": -1}}})
