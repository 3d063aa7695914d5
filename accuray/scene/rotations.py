"""Rotations as unit quaternions (w, x, y, z), and what of a matrix is a rotation; the same bits on every machine."""

from __future__ import annotations

import math

from accuray.scene.transforms import IDENTITY, Rows, Vector, sine_cosine

Quaternion = tuple[float, float, float, float]
Square = list[list[float]]

UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)
"""No rotation."""

POLAR_STEPS = 100
HALVINGS = 4
TERMS = 12


def quaternion_about(axis: Vector, degrees: float) -> Quaternion:
    """The rotation about a unit axis; an angle and the same less two turns have the same quaternion."""
    sin, cos = sine_cosine(0.5 * degrees)
    return cos, sin * axis[0], sin * axis[1], sin * axis[2]


def rows_of(q: Quaternion) -> Rows:
    """The rotation as a matrix (Shoemake 1985)."""
    w, x, y, z = q
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), 0.0),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), 0.0),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), 0.0),
        IDENTITY[3],
    )


def way(a: Quaternion, b: Quaternion) -> tuple[Vector, float]:
    """Unit axis and angle, in degrees up to 180, of the rotation that comes before ``a`` to make it ``b``."""
    w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    x = a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1]
    sign = -1.0 if w < 0.0 else 1.0
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0.0:
        return (0.0, 0.0, 1.0), 0.0
    axis = sign * x / length, sign * y / length, sign * z / length
    return axis, 2.0 * _angle(length, sign * w) * (180.0 / math.pi)


def _angle(sin: float, cos: float) -> float:
    """The angle in [0, pi/2] of a sine and cosine: halved until the series of the arc tangent needs few terms."""
    tangent = sin / (math.sqrt(sin * sin + cos * cos) + cos)
    for _ in range(HALVINGS - 1):
        tangent /= 1.0 + math.sqrt(1.0 + tangent * tangent)
    square = tangent * tangent
    series = 0.0
    for k in range(TERMS, -1, -1):  # tangent <= tan(pi/32): the first term left out is below 1e-26
        series = 1.0 / (2 * k + 1) - square * series
    return float(1 << HALVINGS) * tangent * series


def polar(m: Square) -> tuple[Quaternion, Square]:
    """The rotation R and the symmetric stretch S with M = R S; S mirrors if M does (Shoemake and Duff 1992).

    R is the limit of Newton's steps from M to the mean of itself and its inverse transposed (Higham 1986).
    """
    size = math.sqrt(sum(value * value for row in m for value in row) / 3.0)
    sign = -1.0 if _determinant([[value / size for value in row] for row in m]) < 0.0 else 1.0
    r = [[sign * value / size for value in row] for row in m]
    for _ in range(POLAR_STEPS):
        n = _inverse_transposed(r)
        after = [[0.5 * (p + q) for p, q in zip(a, b, strict=True)] for a, b in zip(r, n, strict=True)]
        moved = max(abs(p - q) for a, b in zip(after, r, strict=True) for p, q in zip(a, b, strict=True))
        r = after
        if moved < 1e-15:
            break
    s = [[sum(r[k][i] * m[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    stretch = [[0.5 * (s[i][j] + s[j][i]) for j in range(3)] for i in range(3)]
    return quaternion_of(r), stretch


def quaternion_of(r: Square) -> Quaternion:
    """The quaternion of a rotation matrix, by its largest component (Shepperd 1978)."""
    trace = r[0][0] + r[1][1] + r[2][2]
    squares = [trace, r[0][0], r[1][1], r[2][2]]
    largest = squares.index(max(squares))
    if largest == 0:
        q = [1.0 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q = [r[k][j] - r[j][k], 0.0, 0.0, 0.0]
        q[1 + i] = 1.0 + r[i][i] - r[j][j] - r[k][k]
        q[1 + j] = r[j][i] + r[i][j]
        q[1 + k] = r[k][i] + r[i][k]
    length = math.sqrt(sum(value * value for value in q))
    return q[0] / length, q[1] / length, q[2] / length, q[3] / length


def _determinant(m: Square) -> float:
    return sum(m[0][i] * _cofactor(m, 0, i) for i in range(3))


def _cofactor(m: Square, i: int, j: int) -> float:
    a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
    return m[a][c] * m[b][d] - m[a][d] * m[b][c]


def _inverse_transposed(m: Square) -> Square:
    determinant = _determinant(m)
    return [[_cofactor(m, i, j) / determinant for j in range(3)] for i in range(3)]
