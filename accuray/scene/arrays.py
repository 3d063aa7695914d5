"""Bulk values: vertex positions, normals, texture coordinates, polygons.

Lists (from files) and numpy arrays (from Python) become contiguous float32 or uint32 arrays. Vertex positions
may hold NaN and infinities: such vertices are counted and their triangles left out when the scene is lowered.
"""

from __future__ import annotations

import re
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any, TypeVar

from accuray.scene.errors import Where
from accuray.scene.schema import Param, Type
from accuray.scene.units import length_ratio

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float32]
    IndexArray = npt.NDArray[np.uint32]

FACES = "faces"
_Array = TypeVar("_Array", bound="npt.NDArray[Any]")
MAX_ROWS = 1 << 31
_ROLE = re.compile(r"([A-Z])x(\d+)(?: or \1x(\d+))?")


def row_widths(param: Param) -> tuple[int, ...]:
    """Columns that an array parameter with a role such as "Nx3" or "Nx3 or Nx4" may have."""
    match = _ROLE.fullmatch(param.role)
    if match is None:
        raise ValueError(f"parameter table: array {param.name} has the unknown role '{param.role}'")
    return tuple(int(width) for width in match.groups()[1:] if width is not None)


def parse_array(param: Param, value: Any, where: Where) -> FloatArray | IndexArray:
    """float32 (N, width), positions in metres; or for faces uint32 (M, 3) triangles. Raises SceneError.

    A last column that may be left out is filled with 1.
    """
    return _triangles(value, where) if param.role == FACES else _rows(param, value, where)


def check_together(type_: Type, values: dict[str, Any], where: Where) -> None:
    """Arrays of one object fit each other: equal numbers of rows where the roles share a letter, indices in range."""
    counts: dict[str, tuple[str, int]] = {}
    params = [param for param in type_.params if param.kind == "array" and values.get(param.name) is not None]
    for param in params:
        if param.role in (FACES, "pixels") or param.choices:
            continue
        letter, rows = param.role[0], values[param.name].shape[-2]
        first, expected = counts.setdefault(letter, (param.name, rows))
        if rows != expected:
            raise where.child(param.name).error(f"has {rows} rows", allowed=f"{expected}, as many as {first}")
    for param in params:
        if param.role == FACES and "N" in counts:
            _check_indices(values[param.name], counts["N"][1], where.child(param.name))


def _check_indices(triangles: IndexArray, vertices: int, where: Where) -> None:
    if triangles.size and int(triangles.max()) >= vertices:
        problem = f"vertex {int(triangles.max())} does not exist"
        raise where.error(problem, allowed=f"0 to {vertices - 1}" if vertices else "none (there are no vertices)")


def scale_to_metres(array: npt.NDArray[Any], length_unit: str) -> npt.NDArray[Any]:
    """Coordinates in a length unit as metres."""
    numerator, denominator = length_ratio(length_unit)
    return array if numerator == denominator else array * numerator / denominator


def _rows(param: Param, value: Any, where: Where) -> FloatArray:
    import numpy as np

    widths = row_widths(param)
    shape = f"rows of {' or '.join(map(str, widths))} numbers"
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in ("fiu" if len(widths) == 1 else "f"):
            raise where.error(f"is an array of {value.dtype}", allowed="an array of floating-point numbers")
        array, width = value.astype(np.float64), value.shape[-1] if value.ndim == 2 else 0
    else:
        rows = value if isinstance(value, (list, tuple)) else ()
        width = len(rows[0]) if rows and hasattr(rows[0], "__len__") and len(rows[0]) in widths else widths[0]
        _check_rows(value, width, where, shape)
        try:
            array = np.array(value, dtype=np.float64).reshape(-1, width)
        except OverflowError:
            raise where.error("has too large a number", allowed=shape) from None
    if array.ndim != 2 or width not in widths:
        raise where.error(f"has the shape {array.shape}", allowed=" or ".join(f"(N, {width})" for width in widths))
    if len(array) > MAX_ROWS:
        raise where.error(f"has {len(array)} rows", allowed=f"up to {MAX_ROWS}")
    if param.unit != "m":
        _check_numbers(param, array, where)
        array = np.pad(array, ((0, 0), (0, widths[-1] - width)), constant_values=1.0)
    else:
        array = scale_to_metres(array, where.source.length_unit)
    with np.errstate(over="ignore"):
        return _frozen(np.ascontiguousarray(array, dtype=np.float32) + np.float32(0.0))


def _check_rows(value: Any, width: int, where: Where, shape: str) -> None:
    """Lists of lists of plain numbers, nothing else; names the first element that is wrong."""
    if not isinstance(value, (list, tuple)):
        raise where.error("is not a list", value=value, allowed=shape)
    for index, row in enumerate(value):
        if not isinstance(row, (list, tuple)) or len(row) != width:
            raise where.child(index).error(f"is not a row of {width} numbers", value=row, allowed=shape)
    if set(map(type, chain.from_iterable(value))) <= {int, float}:
        return
    for index, row in enumerate(value):
        for column, item in enumerate(row):
            if isinstance(item, bool) or not hasattr(item, "__float__"):
                raise where.child(index, column).error(
                    "is not a number", value=item, allowed="numbers (in the file's length_unit)"
                )


def _check_numbers(param: Param, array: npt.NDArray[np.float64], where: Where) -> None:
    import numpy as np

    least = -np.inf if param.min is None else param.min
    for good, problem, allowed in (
        (np.isfinite(array), "is not a finite number", "finite numbers"),
        (array >= least, "is out of range", f"at least {least:g}"),
    ):
        bad = np.argwhere(~good)
        if len(bad):
            row, column = (int(index) for index in bad[0])
            raise where.child(row, column).error(problem, value=float(array[row, column]), allowed=allowed)


def _triangles(value: Any, where: Where) -> IndexArray:
    """Triangles of a list of polygons; each is a fan from its first corner."""
    import numpy as np

    if isinstance(value, np.ndarray) and value.ndim == 2 and value.shape[1] == 3 and value.dtype.kind in "iu":
        if value.size and (int(value.min()) < 0 or int(value.max()) >= 1 << 32):
            raise where.error("has an index out of range", value=int(value.min()), allowed="at least 0")
        return _frozen(np.ascontiguousarray(value, dtype=np.uint32))
    polygons = value.tolist() if isinstance(value, np.ndarray) else value
    if not isinstance(polygons, (list, tuple)):
        raise where.error("is not a list", value=value, allowed="polygons, each a list of 3 or more vertex indices")
    triangles: list[tuple[int, int, int]] = []
    for index, polygon in enumerate(polygons):
        _check_polygon(polygon, where.child(index))
        first = polygon[0]
        triangles.extend((first, b, c) for b, c in pairwise(polygon[1:]))
    return _frozen(np.array(triangles, dtype=np.uint32).reshape(-1, 3))


def polygon_sizes(value: Any) -> IndexArray:
    """How many corners each polygon has, uint32 (P,), of faces that ``parse_array`` has taken."""
    import numpy as np

    if isinstance(value, np.ndarray) and value.ndim == 2:
        return _frozen(np.full(len(value), value.shape[1], dtype=np.uint32))
    return _frozen(np.array([len(polygon) for polygon in value], dtype=np.uint32))


def _check_polygon(polygon: Any, where: Where) -> None:
    if not isinstance(polygon, (list, tuple)) or len(polygon) < 3:
        raise where.error("is not a polygon", value=polygon, allowed="3 or more vertex indices")
    for corner, index in enumerate(polygon):
        if isinstance(index, bool) or not hasattr(index, "__index__"):
            raise where.child(corner).error("is not a vertex index", value=index, allowed="whole numbers from 0")
        if not 0 <= index < 1 << 32:
            raise where.child(corner).error("is not a vertex index", value=index, allowed="whole numbers from 0")


def _frozen(array: _Array) -> _Array:
    """The array, no longer writable: a scene's identity must not change under it."""
    array.flags.writeable = False
    return array
