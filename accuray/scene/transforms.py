"""Object-to-world transforms: any sequence of moves, turns, scales and matrices that leaves bodies their volume.

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

KEYS = ("translate", "rotate", "scale", "matrix", "look_at")
WHOLE = ("matrix", "look_at")
"""Keys that make up a step by themselves."""

ALLOWED = (
    "{translate = [x, y, z], rotate = {axis = [x, y, z], angle = 30}, scale = s}, {matrix = [16 numbers, row by row]}, "
    "{look_at = {origin = [x, y, z], target = [x, y, z]}}, or a list of such steps applied in order"
)
LENGTH = Param("translate", "vec", unit="m")
ANGLE = Param("angle", "float", unit="deg")
RIGID_TOLERANCE = 1e-5
FLAT = 1e-12
"""A matrix flattens if its determinant is below this share of the cube of its longest column."""

MAX_STEPS = 1000

Vector = tuple[float, float, float]
Row = tuple[float, float, float, float]
Rows = tuple[Row, Row, Row, Row]

IDENTITY: Rows = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def parse_transform(value: Any, where: Where) -> npt.NDArray[np.float64]:
    """The 4x4 float64 matrix (column vectors, translation in metres) that ``value`` spells. Raises SceneError.

    In one table the scale comes first, then the rotation, then the translation; the steps of a list are applied
    in order. A 4x4 array from Python is taken as a matrix. Whether a shape can be sheared is for ``check_rigid``.
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
            rows = product(_step(step, where.child(index)), rows)
    else:
        raise where.error("is not a transform", value=value, allowed=ALLOWED)
    matrix = np.array(rows, dtype=np.float64)
    if not np.isfinite(matrix).all():
        raise where.error("is too large a transform", allowed="finite numbers")
    if flattens(matrix):
        raise where.error("flattens", allowed="a transform that leaves bodies a volume")
    return matrix


def flattens(matrix: npt.NDArray[np.float64]) -> bool:
    """Does the transform leave nothing of a volume, or a number that is not finite?"""
    x, y, z = ((float(matrix[0, i]), float(matrix[1, i]), float(matrix[2, i])) for i in range(3))
    size = max(map(abs, (*x, *y, *z)))
    if not 1e-100 < size < 1e100:
        return True
    a, b, c = ((v[0] / size, v[1] / size, v[2] / size) for v in (x, y, z))
    volume = sum(p * q for p, q in zip(_cross(a, b), c, strict=True))
    return abs(volume) < FLAT


def _step(step: dict[str, Any], where: Where) -> Rows:
    for key in step:
        if key not in KEYS:
            raise where.child(key).unknown(key, "part of a transform", KEYS)
        if key in WHOLE and len(step) > 1:
            raise where.error(f"has other keys beside `{key}`", value=step, allowed=f"{key} alone, as a step of a list")
    if "matrix" in step:
        return _matrix(step["matrix"], where.child("matrix"))
    if "look_at" in step:
        return _look_at(step["look_at"], where.child("look_at"))
    rows = IDENTITY
    if "scale" in step:
        x, y, z = parse_scale(step["scale"], where.child("scale"))
        rows = product(((x, 0.0, 0.0, 0.0), (0.0, y, 0.0, 0.0), (0.0, 0.0, z, 0.0), IDENTITY[3]), rows)
    if "rotate" in step:
        rows = product(rotation_about(*parse_rotation(step["rotate"], where.child("rotate"))), rows)
    if "translate" in step:
        x, y, z = parse_vector(step["translate"], where.child("translate"), LENGTH)
        rows = product(((1.0, 0.0, 0.0, x), (0.0, 1.0, 0.0, y), (0.0, 0.0, 1.0, z), IDENTITY[3]), rows)
    return rows


def parse_vector(value: Any, where: Where, param: Param) -> Vector:
    """Three quantities of the parameter's unit. Raises SceneError."""
    if not isinstance(value, (list, tuple)) or len(value) != 3:
        raise where.error("is not a vector", value=value, allowed="[x, y, z]")
    x, y, z = (quantity(param, item, where.child(index)) for index, item in enumerate(value))
    return x, y, z


def parse_scale(value: Any, where: Where) -> Vector:
    """Factors of the three axes, none of them 0. Raises SceneError."""
    allowed = "a number other than 0, or one for each of x, y and z"
    factors = value if isinstance(value, (list, tuple)) else [value] * 3
    if len(factors) != 3:
        raise where.error("is not a scale", value=value, allowed=allowed)
    x, y, z = (finite_number(factor, where, allowed) for factor in factors)
    if 0.0 in (x, y, z):
        raise where.error("flattens", value=value, allowed=allowed)
    return x, y, z


def parse_rotation(value: Any, where: Where) -> tuple[Vector, float]:
    """Unit axis and angle in degrees, of any size, of a rotation. Raises SceneError."""
    if not isinstance(value, dict) or set(value) not in ({"axis", "angle"}, {"axis", "turns"}):
        raise where.error("is not a rotation", value=value, allowed="{axis = [x, y, z], angle = 30}, or turns = 2.5")
    x, y, z = parse_vector(value["axis"], where.child("axis"), Param("axis", "vec"))
    length = math.sqrt(x * x + y * y + z * z)
    if not 1e-100 < length < 1e100:
        raise where.child("axis").error("has no direction", value=value["axis"], allowed="a vector other than 0")
    if "turns" in value:
        degrees = 360.0 * finite_number(value["turns"], where.child("turns"), "a number of turns, 1 all the way round")
    else:
        degrees, _ = quantities(ANGLE, value["angle"], where.child("angle"))
    return (x / length, y / length, z / length), degrees


def rotation_about(axis: Vector, degrees: float) -> Rows:
    """Rotation about a unit axis through the origin, counter-clockwise seen from its tip (Rodrigues 1840)."""
    x, y, z = axis
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
    """Checks shape, last row and that it does not flatten; the translation is in the file's length unit."""
    flat = _flattened(value)
    if flat is None or len(flat) != 16:
        raise where.error("is not a matrix", value=value, allowed="16 numbers, row by row")
    m = [finite_number(item, where.child(index), "finite numbers") for index, item in enumerate(flat)]
    if m[12:] != [0.0, 0.0, 0.0, 1.0]:
        raise where.error("has another last row", value=m[12:], allowed="0, 0, 0, 1")
    x, y, z = (quantity(LENGTH, m[4 * axis + 3], where.child(4 * axis + 3)) for axis in range(3))
    return (m[0], m[1], m[2], x), (m[4], m[5], m[6], y), (m[8], m[9], m[10], z), IDENTITY[3]


def _look_at(value: Any, where: Where) -> Rows:
    """Moves the object to ``origin`` and turns its -z axis, as a camera's, to ``target`` and its +y towards ``up``."""
    known = ("origin", "target", "up")
    if not isinstance(value, dict) or not {"origin", "target"} <= set(value) <= set(known):
        raise where.error(
            "is no look_at", value=value, allowed="{origin = [x, y, z], target = [x, y, z], up = [x, y, z]}"
        )
    origin, target = (parse_vector(value[key], where.child(key), LENGTH) for key in known[:2])
    up = parse_vector(value.get("up", [0, 1, 0]), where.child("up"), Param("up", "vec"))
    z = _unit((origin[0] - target[0], origin[1] - target[1], origin[2] - target[2]))
    x = None if z is None else _unit(_cross(up, z))
    if z is None or x is None:
        raise where.error("has no direction", value=value, allowed="a target apart from the origin, and not along `up`")
    y = _cross(z, x)
    a, b, c = ((x[i], y[i], z[i], origin[i]) for i in range(3))
    return a, b, c, IDENTITY[3]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(v: Vector) -> Vector | None:
    """The direction of a vector, None if it is lost in rounding."""
    size = max(map(abs, v))
    if not 1e-100 < size < 1e100:
        return None
    x, y, z = v[0] / size, v[1] / size, v[2] / size
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def is_similarity(matrix: npt.NDArray[np.float64]) -> bool:
    """Is the transform a rotation, mirrored or not, times one scale, plus a translation?"""
    columns = [tuple(float(matrix[row, axis]) for row in range(3)) for axis in range(3)]
    square = [[sum(a * b for a, b in zip(u, v, strict=True)) for v in columns] for u in columns]
    size = (square[0][0] + square[1][1] + square[2][2]) / 3.0
    limit = RIGID_TOLERANCE * size
    skew = any(abs(square[i][j] - (size if i == j else 0.0)) > limit for i in range(3) for j in range(3))
    return not skew and 0.0 < size < math.inf


def check_rigid(matrix: npt.NDArray[np.float64], noun: str, where: Where, instead: str = "") -> None:
    """SceneError at ``where`` if the transform does more than turn, mirror, move and scale what ``noun`` names.

    ``instead`` says what else is allowed.
    """
    if not is_similarity(matrix):
        raise where.error(
            f"shears or stretches {noun}", allowed=f"a rotation times one scale, plus a translation{instead}"
        )


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


def product(left: Rows, right: Rows) -> Rows:
    """Matrix product with the sums in index order."""

    def entry(i: int, j: int) -> float:
        a, b = left[i], right
        return a[0] * b[0][j] + a[1] * b[1][j] + a[2] * b[2][j] + a[3] * b[3][j] + 0.0

    def row(i: int) -> Row:
        return entry(i, 0), entry(i, 1), entry(i, 2), entry(i, 3)

    return row(0), row(1), row(2), row(3)
