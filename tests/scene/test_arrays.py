"""Bulk arrays: lists and numpy arrays, polygons, units, bad vertices that are kept."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from accuray.scene import SceneError
from accuray.scene.arrays import parse_array
from accuray.scene.errors import Document, Source, Where
from accuray.scene.schema import Param

POSITIONS = Param("positions", "array", unit="m", role="Nx3")
UVS = Param("uvs", "array", role="Nx2")
FACES = Param("faces", "array", role="faces")


def parse(param: Param, value: Any, length_unit: str = "m") -> Any:
    return parse_array(param, value, Where(Document({}, Source(folder=Path(), length_unit=length_unit)), ("a",)))


def test_positions_are_float32_metres() -> None:
    found = parse(POSITIONS, [[552.8, 0, -0.0], [1, 2, 3]], "mm")
    assert (found.dtype, found.shape) == (np.float32, (2, 3))
    assert found.tolist() == np.array([[0.5528, 0, 0], [0.001, 0.002, 0.003]], dtype=np.float32).tolist()
    assert not np.signbit(found).any()
    assert not found.flags.writeable


def test_length_units_do_not_show_in_positions() -> None:
    numbers = np.random.default_rng(1).integers(-999999, 999999, (1000, 3))
    millimetres = parse(POSITIONS, numbers, "mm")
    assert np.array_equal(millimetres, parse(POSITIONS, numbers / 1000))
    assert np.array_equal(millimetres, parse(POSITIONS, (numbers / 1000).tolist()))


def test_bad_vertices_are_kept_for_the_renderer_to_count() -> None:
    found = parse(POSITIONS, [[math.nan, math.inf, 1e300]])
    assert math.isnan(found[0, 0])
    assert np.isinf(found[0, 1:]).all()


def test_polygons_are_fans_from_their_first_corner() -> None:
    assert parse(FACES, [[0, 1, 2], [3, 4, 5, 6], [9, 8, 7, 6, 5]]).tolist() == [
        [0, 1, 2], [3, 4, 5], [3, 5, 6], [9, 8, 7], [9, 7, 6], [9, 6, 5],
    ]  # fmt: skip
    quads = np.array([[0, 1, 2, 3]])
    assert np.array_equal(parse(FACES, quads), [[0, 1, 2], [0, 2, 3]])
    triangles = parse(FACES, np.array([[0, 1, 2]], dtype=np.int16))
    assert (triangles.dtype, triangles.tolist()) == (np.uint32, [[0, 1, 2]])


def test_empty_arrays() -> None:
    assert parse(POSITIONS, []).shape == (0, 3)
    assert parse(FACES, []).shape == (0, 3)
    assert parse(UVS, np.zeros((0, 2))).shape == (0, 2)


@pytest.mark.parametrize(
    ("param", "value"),
    [
        (POSITIONS, None), (POSITIONS, 3), (POSITIONS, "x"), (POSITIONS, {}), (POSITIONS, [1, 2, 3]),
        (POSITIONS, [[1, 2]]), (POSITIONS, [[1, 2, True]]), (POSITIONS, [[1, 2, "3"]]), (POSITIONS, [[1, 2, [3]]]),
        (POSITIONS, [[1, 2, 10**400]]), (POSITIONS, np.zeros(3)), (POSITIONS, np.zeros((3, 2))),
        (POSITIONS, np.array([["a", "b", "c"]])), (POSITIONS, np.zeros((1, 3), dtype=complex)),
        (UVS, [[math.nan, 0]]), (UVS, np.array([[0, math.inf]])), (FACES, [[0, 1]]), (FACES, [0, 1, 2]),
        (FACES, [[0, 1, -2]]), (FACES, [[0, 1, 2**32]]), (FACES, [[0, 1, 2.0]]), (FACES, [[0, 1, True]]),
        (FACES, np.array([[0, 1, -2]])), (FACES, np.array([[0, 1, 2**32]])), (FACES, np.array([[0.0, 1.0, 2.0]])),
        (FACES, np.array([0, 1, 2])), (FACES, "012"),
    ],
)  # fmt: skip
def test_everything_else_is_an_error(param: Param, value: Any) -> None:
    with pytest.raises(SceneError):
        parse(param, value)
