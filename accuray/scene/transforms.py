"""Object-to-world transforms: rigid motions with uniform scale, mirroring allowed.

Everything is computed with IEEE additions, multiplications, divisions and square roots in a fixed order, never
with a libm sine or a BLAS product, so a transform has the same bits on every machine.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from accuray.scene.errors import Where
from accuray.scene.plain import finite_number, quantities, quantity
from accuray.scene.schema import Param

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

KEYS = ("translate", "rotate", "scale")
ALLOWED = (
    "{translate = [x, y, z], rotate = {axis = [x, y, z], angle = 30}, scale = s}, a list of such steps "
    "applied in order, or {matrix = [16 numbers, row by row]}"
)
LENGTH = Param("translate", "vec", unit="m")
ANGLE = Param("angle", "float", unit="deg")
RIGID_TOLERANCE = 1e-5
MAX_STEPS = 1000

Row = tuple[float, float, float, float]
Rows = tuple[Row, Row, Row, Row]

IDENTITY: Rows = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def parse_transform(value: Any, where: Where) -> npt.NDArray[np.float64]:
    """The 4x4 float64 matrix (column vectors, translation in metres) that ``value`` spells. Raises SceneError.

    In one table the scale comes first, then the rotation, then the translation; the steps of a list are applied
    in order. A 4x4 array from Python is taken as a matrix.
    """
    import numpy as np

    if isinstance(value, np.ndarray):
        rows = _matrix(value.tolist(), where)
    elif isinstance(value, dict):
        rows = _step(value, where)
    elif isinstance(value, list) and 0 < len(value) <= MAX_STEPS:
        rows = IDENTITY
        for index, step in enumerate(value):
            if not isinstance(step, dict):
                raise where.child(index).error("is not a step of a transform", value=step, allowed=ALLOWED)
            rows = _product(_step(step, where.child(index)), rows)
    else:
        raise where.error("is not a transform", value=value, allowed=ALLOWED)
    matrix = np.array(rows, dtype=np.float64)
    if not np.isfinite(matrix).all():
        raise where.error("is too large a transform", allowed="finite numbers")
    return matrix


def _step(step: dict[str, Any], where: Where) -> Rows:
    for key in step:
        if key not in (*KEYS, "matrix"):
            raise where.child(key).unknown(key, "part of a transform", (*KEYS, "matrix"))
    if "matrix" in step:
        if len(step) > 1:
            raise where.error("has other keys beside `matrix`", value=step, allowed="matrix alone")
        return _matrix(step["matrix"], where.child("matrix"))
    rows = IDENTITY
    if "scale" in step:
        rows = _product(_scaling(step["scale"], where.child("scale")), rows)
    if "rotate" in step:
        rows = _product(_rotation(step["rotate"], where.child("rotate")), rows)
    if "translate" in step:
        x, y, z = _vector(step["translate"], where.child("translate"), LENGTH)
        rows = _product(((1.0, 0.0, 0.0, x), (0.0, 1.0, 0.0, y), (0.0, 0.0, 1.0, z), IDENTITY[3]), rows)
    return rows


def _vector(value: Any, where: Where, param: Param) -> tuple[float, float, float]:
    if not isinstance(value, (list, tuple)) or len(value) != 3:
        raise where.error("is not a vector", value=value, allowed="[x, y, z]")
    x, y, z = (quantity(param, item, where.child(index)) for index, item in enumerate(value))
    return x, y, z


def _scaling(value: Any, where: Where) -> Rows:
    if isinstance(value, (list, tuple)):
        raise where.error("is not uniform", value=value, allowed="one number; stretched objects are not supported")
    s = finite_number(value, where, "one number other than 0")
    if s == 0.0:
        raise where.error("is not allowed", value=value, allowed="one number other than 0")
    return ((s, 0.0, 0.0, 0.0), (0.0, s, 0.0, 0.0), (0.0, 0.0, s, 0.0), IDENTITY[3])


def _rotation(value: Any, where: Where) -> Rows:
    """Rotation about an axis through the origin, counter-clockwise seen from its tip (Rodrigues 1840)."""
    if not isinstance(value, dict) or set(value) != {"axis", "angle"}:
        raise where.error("is not a rotation", value=value, allowed="{axis = [x, y, z], angle = 30}")
    x, y, z = _vector(value["axis"], where.child("axis"), Param("axis", "vec"))
    length = math.sqrt(x * x + y * y + z * z)
    if not 1e-100 < length < 1e100:
        raise where.child("axis").error("has no direction", value=value["axis"], allowed="a vector other than 0")
    x, y, z = x / length, y / length, z / length
    degrees, _ = quantities(ANGLE, value["angle"], where.child("angle"))
    sin, cos = sine_cosine(degrees)
    t = 1.0 - cos
    return (
        (t * x * x + cos, t * x * y - sin * z, t * x * z + sin * y, 0.0),
        (t * x * y + sin * z, t * y * y + cos, t * y * z - sin * x, 0.0),
        (t * x * z - sin * y, t * y * z + sin * x, t * z * z + cos, 0.0),
        IDENTITY[3],
    )


def sine_cosine(degrees: float) -> tuple[float, float]:
    """Sine and cosine of an angle in degrees by Taylor series after exact reduction; exact at multiples of 90."""
    reduced = math.fmod(degrees, 360.0)
    quadrant = math.floor(reduced / 90.0 + 0.5)
    x = (reduced - 90.0 * quadrant) * (math.pi / 180.0)
    square = x * x
    sin, cos = 1.0, 1.0
    for k in range(11, 0, -1):  # |x| <= pi/4: the first term left out is below 1e-24
        sin = 1.0 - square / ((2 * k) * (2 * k + 1)) * sin
        cos = 1.0 - square / ((2 * k - 1) * (2 * k)) * cos
    sin *= x
    return ((sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin))[quadrant % 4]


def _matrix(value: Any, where: Where) -> Rows:
    """Checks shape, last row, orthogonal columns of equal length; the translation is in the file's length unit."""
    flat = _flattened(value)
    if flat is None or len(flat) != 16:
        raise where.error("is not a matrix", value=value, allowed="16 numbers, row by row")
    m = [finite_number(item, where.child(index), "finite numbers") for index, item in enumerate(flat)]
    if m[12:] != [0.0, 0.0, 0.0, 1.0]:
        raise where.error("has another last row", value=m[12:], allowed="0, 0, 0, 1")
    columns = [(m[axis], m[4 + axis], m[8 + axis]) for axis in range(3)]
    square = [[sum(a * b for a, b in zip(u, v, strict=True)) for v in columns] for u in columns]
    size = (square[0][0] + square[1][1] + square[2][2]) / 3.0
    limit = RIGID_TOLERANCE * size
    skew = any(abs(square[i][j] - (size if i == j else 0.0)) > limit for i in range(3) for j in range(3))
    if skew or not 0.0 < size < math.inf:
        raise where.error("shears, flattens or stretches", allowed="a rotation times one scale, plus a translation")
    x, y, z = (quantity(LENGTH, m[4 * axis + 3], where.child(4 * axis + 3)) for axis in range(3))
    return (m[0], m[1], m[2], x), (m[4], m[5], m[6], y), (m[8], m[9], m[10], z), IDENTITY[3]


def _flattened(value: Any) -> list[Any] | None:
    """A list of numbers, or of rows, as one list; None for anything else."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        return None
    flat: list[Any] = []
    for item in value:
        flat.extend(item if isinstance(item, (list, tuple)) else [item])
    return flat


def _product(left: Rows, right: Rows) -> Rows:
    """Matrix product with the sums in index order."""

    def entry(i: int, j: int) -> float:
        a, b = left[i], right
        return a[0] * b[0][j] + a[1] * b[1][j] + a[2] * b[2][j] + a[3] * b[3][j] + 0.0

    def row(i: int) -> Row:
        return entry(i, 0), entry(i, 1), entry(i, 2), entry(i, 3)

    return row(0), row(1), row(2), row(3)
