"""Transforms: exact angles, order of steps, stretches and shears where shapes stay what they are."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray.scene import SceneError
from accuray.scene.errors import Document, Source, Where
from accuray.scene.transforms import parse_transform, sine_cosine


def parse(value: Any, length_unit: str = "m") -> Any:
    return parse_transform(value, Where(Document({}, Source(folder=Path(), length_unit=length_unit)), ("t",)))


@STEADY
@given(st.floats(-1e6, 1e6))
def test_sine_and_cosine(degrees: float) -> None:
    sin, cos = sine_cosine(degrees)
    reduced = math.radians(math.fmod(degrees, 360.0))
    assert (sin, cos) == pytest.approx((math.sin(reduced), math.cos(reduced)), abs=2e-15)


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [(0, (0, 1)), (90, (1, 0)), (180, (0, -1)), (270, (-1, 0)), (-90, (-1, 0)), (360, (0, 1)), (450, (1, 0))],
)
def test_right_angles_are_exact(degrees: float, expected: tuple[float, float]) -> None:
    assert sine_cosine(degrees) == expected


def test_rotation_is_counter_clockwise_seen_from_the_tip_of_its_axis() -> None:
    turned = parse({"rotate": {"axis": [0, 0, 2], "angle": 90}}) @ [1, 0, 0, 1]
    assert turned.tolist() == [0, 1, 0, 1]
    turned = parse({"rotate": {"axis": [1, 1, 1], "angle": "120 deg"}}) @ [1, 0, 0, 1]
    assert turned == pytest.approx([0, 1, 0, 1], abs=1e-15)


def test_one_table_scales_then_rotates_then_translates() -> None:
    together = parse({"translate": [1, 2, 3], "rotate": {"axis": [0, 1, 0], "angle": 30}, "scale": 2})
    steps = parse([{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "angle": 30}}, {"translate": [1, 2, 3]}])
    assert np.array_equal(together, steps)
    assert (together @ [0, 1, 0, 1]).tolist() == [1, 4, 3, 1]
    assert (parse([{"translate": [1, 0, 0]}, {"scale": 2}]) @ [0, 0, 0, 1]).tolist() == [2, 0, 0, 1]


def test_scales_along_the_axes_and_shears() -> None:
    assert np.diag(parse({"scale": [2, -3, 0.5]})).tolist() == [2, -3, 0.5, 1]
    slanted = parse([{"scale": [1, 4, 1]}, {"rotate": {"axis": [0, 0, 1], "angle": 90}}, {"scale": [1, 1, 2]}])
    assert (slanted @ [1, 1, 1, 1]).tolist() == [-4, 1, 2, 1]
    shear = [1, 0.5, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    assert (parse({"matrix": shear}) @ [0, 2, 0, 1]).tolist() == [4, 2, 0, 1]


def test_steps_of_all_kinds_in_any_order() -> None:
    steps = [
        {"translate": [1, 2, 3]},
        {"scale": [1, 2, 3]},
        {"look_at": {"origin": [0, 0, 5], "target": [1, 0, 4]}},
        {"rotate": {"axis": [1, 2, 3], "angle": 40}},
        {"matrix": [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
    ]
    expected = np.eye(4)
    for step in steps:
        expected = parse(step) @ expected
    assert parse(steps) == pytest.approx(expected, rel=1e-14)
    assert parse(steps[::-1]) != pytest.approx(expected, rel=1e-3)


def test_look_at_turns_as_a_camera() -> None:
    matrix = parse({"look_at": {"origin": [1, 2, 3], "target": [1, 2, -4]}})
    assert matrix.tolist() == [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    matrix = parse({"look_at": {"origin": [0, 0, "1 m"], "target": [2000, 0, 1000], "up": [0, 0, 3]}}, "mm")
    assert (matrix @ [0, 0, -1, 1]).tolist() == [1, 0, 1, 1]
    assert (matrix @ [0, 1, 0, 1]).tolist() == [0, 0, 2, 1]
    assert (matrix @ [1, 0, 0, 1]).tolist() == [0, -1, 1, 1]


@pytest.mark.parametrize(
    "value",
    [
        {"look_at": [0, 0, 1]}, {"look_at": {"origin": [0, 0, 0]}}, {"look_at": {"origin": [0] * 3, "target": [0] * 3}},
        {"look_at": {"origin": [0, 0, 0], "target": [0, 5, 0]}}, {"scale": [1, 2, 0]}, {"scale": [1, 2, 3, 4]},
        {"look_at": {"origin": [0, 0, 0], "target": [0, 0, 1], "roll": 3}}, {"scale": 2, "look_at": {}},
        [{"scale": [1, 1, 1e-13]}], {"matrix": [1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
    ],
)  # fmt: skip
def test_steps_that_flatten_or_lead_nowhere(value: Any) -> None:
    with pytest.raises(SceneError):
        parse(value)


def test_lengths_have_units() -> None:
    assert parse({"translate": [1, "2 m", "3 in"]}, "mm")[:3, 3].tolist() == [0.001, 2, 0.0762]
    rows = [0, -2, 0, 500, 2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]
    assert parse({"matrix": rows}, "mm")[0].tolist() == [0, -2, 0, 0.5]
    assert np.array_equal(parse(np.array(rows, dtype=float).reshape(4, 4)), parse({"matrix": rows}))


def test_mirroring_is_allowed() -> None:
    assert np.linalg.det(parse({"scale": -1})) == -1
    parse({"matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})


@STEADY
@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), st.floats(-720, 720), st.floats(1e-3, 1e3))
def test_result_is_a_similarity(axis: list[float], angle: float, scale: float) -> None:
    if sum(x * x for x in axis) < 1e-6:
        return
    linear = parse({"rotate": {"axis": axis, "angle": angle}, "scale": scale})[:3, :3]
    assert linear @ linear.T == pytest.approx(scale**2 * np.eye(3), rel=1e-12, abs=1e-12 * scale**2)


@pytest.mark.parametrize(
    "value",
    [
        None, 3, "up", [], [3], {"turn": 1}, {"scale": 0}, {"scale": "2 m"}, {"scale": math.nan}, {"scale": [1, 1]},
        {"scale": 1e200, "matrix": [1] * 16}, {"translate": [1, 2]}, {"translate": ["1 kg", 0, 0]}, {"rotate": 30},
        {"rotate": {"axis": [0, 0, 0], "angle": 1}}, {"rotate": {"axis": [0, 0, 1]}}, {"matrix": [1] * 15},
        {"rotate": {"axis": [0, 0, 1], "angle": "1 m"}}, {"matrix": [1] * 16}, {"matrix": [0] * 15 + [1]},
        {"scale": [1, 0, 1]}, [{"scale": 1e200}, {"scale": 1e200}],
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1]}, {"matrix": "1" * 16}, np.ones((2, 2)),
    ],
)  # fmt: skip
def test_everything_else_is_an_error(value: Any) -> None:
    with pytest.raises(SceneError):
        parse(value)
