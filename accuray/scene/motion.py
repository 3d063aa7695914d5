"""Keyed transforms: where something is at any moment, from what it is at some.

A key is a time and a transform. The latter is taken apart into a translation, a rotation and a stretch, M = T R S, as
Shoemake and Duff (1992, "Matrix animation and polar decomposition") do it, and each is interpolated by itself:
translation and stretch in straight lines; the rotation at an even speed, about the keys' own axis by as many turns as
they say if they share one, else the shorter way about the axis that leads from one to the other (Shoemake 1985).

As in ``transforms``, everything has the same bits on every machine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from accuray.scene import rotations
from accuray.scene.clock import Clock
from accuray.scene.errors import Where
from accuray.scene.plain import quantity
from accuray.scene.rotations import UPRIGHT, Quaternion
from accuray.scene.schema import Param
from accuray.scene.transforms import (
    IDENTITY,
    LENGTH,
    Rows,
    Vector,
    flattens,
    parse_rotation,
    parse_scale,
    parse_transform,
    parse_vector,
    product,
    rotation_about,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Matrix = npt.NDArray[np.float64]

KEYS = "keys"
TIME = Param("time", "float", unit="s")
PARTS = ("translate", "rotate", "scale")
ALLOWED = (
    "{keys = [{time = 0, translate = [x, y, z], rotate = {axis = [x, y, z], turns = 1}, scale = s}, ...]}, or in a key "
    "a matrix, a look_at, or a list of steps"
)
MOST_KEYS = 100_000
PARALLEL = 1e-9
"""Sine of the largest angle between axes that count as one."""

PROBES = 16
"""Parts of the way between two keys of different stretch, at whose ends it must leave bodies a volume."""


class Pose(NamedTuple):
    """A transform taken apart.

    ``axis`` and ``degrees`` are those of a rotation that was written so, else None and 0.
    """

    move: Vector
    axis: Vector | None
    degrees: float
    turn: Quaternion
    stretch: Rows

    @property
    def turned(self) -> Rows:
        """The rotation."""
        return rotations.rows_of(self.turn) if self.axis is None else rotation_about(self.axis, self.degrees)

    def rows(self) -> Rows:
        """The transform."""
        return _assembled(self.move, self.turned, self.stretch)


@dataclass(frozen=True)
class Motion:
    """A transform that changes while the shutter is open.

    ``times`` in seconds, rising, and ``poses`` are the keys that count for it: those between ``open`` and ``close`` and
    the ones next to them on either side.
    """

    times: tuple[float, ...]
    poses: tuple[Pose, ...]
    open: float
    close: float

    def at(self, share: float) -> Matrix:
        """The 4x4 matrix at a share of the shutter interval, 0 to 1."""
        import numpy as np

        return np.array(self._rows((1.0 - share) * self.open + share * self.close), dtype=np.float64)

    @cached_property
    def bends(self) -> tuple[float, ...]:
        """Shares of the interval at which there are keys."""
        length = self.close - self.open
        return tuple((time - self.open) / length for time in self.times if self.open < time < self.close)

    @cached_property
    def degrees(self) -> float:
        """How far it turns in all, at most."""
        return sum(_angle_between(a, b) for a, b in pairwise(self.poses))

    def numbers(self) -> tuple[Any, ...]:
        """Every number that the motion is made of, for the identity of a scene."""
        return (self.open, self.close, self.times, self.poses)

    def _rows(self, time: float) -> Rows:
        if time <= self.times[0]:
            return self.poses[0].rows()
        for (begin, end), (a, b) in zip(pairwise(self.times), pairwise(self.poses), strict=True):
            if time < end:
                return between(a, b, (time - begin) / (end - begin))
        return self.poses[-1].rows()


def between(a: Pose, b: Pose, share: float) -> Rows:
    """The transform at a share of the way from one pose to another."""
    turned = _turned(a, b, share)
    move = _line(a.move, b.move, share)
    rows = tuple(_line(p, q, share) for p, q in zip(a.stretch, b.stretch, strict=True))
    return _assembled((move[0], move[1], move[2]), turned, rows)  # type: ignore[arg-type]


def _turned(a: Pose, b: Pose, share: float) -> Rows:
    axis = a.axis if a.axis is not None else b.axis
    first, second = _degrees_about(axis, a), _degrees_about(axis, b)
    if axis is not None and first is not None and second is not None:
        return rotation_about(axis, (1.0 - share) * first + share * second)
    about, degrees = rotations.way(a.turn, b.turn)
    return product(a.turned, rotation_about(about, share * degrees))


def _angle_between(a: Pose, b: Pose) -> float:
    axis = a.axis if a.axis is not None else b.axis
    first, second = _degrees_about(axis, a), _degrees_about(axis, b)
    return rotations.way(a.turn, b.turn)[1] if first is None or second is None else abs(second - first)


def _degrees_about(axis: Vector | None, pose: Pose) -> float | None:
    """The pose's angle about an axis, None if it turns about another one."""
    if pose.axis is None:
        return 0.0 if pose.turn == UPRIGHT else None
    if axis is None:
        return None
    x, y, z = (
        axis[(i + 1) % 3] * pose.axis[(i + 2) % 3] - axis[(i + 2) % 3] * pose.axis[(i + 1) % 3] for i in range(3)
    )
    if x * x + y * y + z * z > PARALLEL * PARALLEL:
        return None
    same = sum(p * q for p, q in zip(axis, pose.axis, strict=True)) > 0.0
    return pose.degrees if same else -pose.degrees


def _line(a: Iterable[float], b: Iterable[float], share: float) -> tuple[float, ...]:
    return tuple((1.0 - share) * p + share * q for p, q in zip(a, b, strict=True))


def _assembled(move: Vector, turned: Rows, stretch: Rows) -> Rows:
    a, b, c, last = product(turned, stretch)
    return (*a[:3], move[0]), (*b[:3], move[1]), (*c[:3], move[2]), last


def parse_motion(value: dict[str, Any], where: Where, clock: Clock) -> Motion | Matrix:
    """What a table with `keys` spells: a motion, or a 4x4 matrix where nothing moves while the shutter is open.

    Raises SceneError.
    """
    import numpy as np

    place = where.child(KEYS)
    for key in value:
        if key != KEYS:
            raise where.child(key).unknown(key, "part of a keyed transform", (KEYS,))
    keys = value[KEYS]
    if not isinstance(keys, list) or not 0 < len(keys) <= MOST_KEYS:
        raise place.error("is not a list of keys", value=keys, allowed=ALLOWED)
    times: list[float] = []
    poses: list[Pose] = []
    for index, key in enumerate(keys):
        time, pose = _key(key, place.child(index))
        if times and time <= times[-1]:
            raise place.child(index, "time").error(
                "is not later than the key before", value=time, allowed="rising times"
            )
        times.append(time)
        poses.append(pose)
    motion = _within(times, poses, clock)
    if all(pose == motion.poses[0] for pose in motion.poses):
        return np.array(motion.poses[0].rows(), dtype=np.float64)
    if clock.open == clock.close:
        return motion.at(0.0)
    _check_volume(motion, place)
    return motion


def _within(times: list[float], poses: list[Pose], clock: Clock) -> Motion:
    """The motion by the keys that count: from the last one before the shutter opens to the first after it closes."""
    first = max((i for i, time in enumerate(times) if time <= clock.open), default=0)
    last = min((i for i, time in enumerate(times) if time >= clock.close), default=len(times) - 1)
    chosen = slice(min(first, last), max(first, last) + 1)
    return Motion(tuple(times[chosen]), tuple(poses[chosen]), clock.open, clock.close)


def _key(key: Any, where: Where) -> tuple[float, Pose]:
    if not isinstance(key, dict) or "time" not in key:
        raise where.error("is not a key", value=key, allowed=ALLOWED)
    time = quantity(TIME, key["time"], where.child("time"))
    step = {name: value for name, value in key.items() if name != "time"}
    if set(step) <= set(PARTS):
        return time, _written(step, where)
    matrix = (
        parse_transform(step["steps"], where.child("steps")) if set(step) == {"steps"} else parse_transform(step, where)
    )
    return time, _taken_apart(matrix)


def _written(step: dict[str, Any], where: Where) -> Pose:
    """A pose from its parts, which keep what they say: an angle beyond half a turn, a scale below 0."""
    move = parse_vector(step["translate"], where.child("translate"), LENGTH) if "translate" in step else (0.0, 0.0, 0.0)
    x, y, z = parse_scale(step["scale"], where.child("scale")) if "scale" in step else (1.0, 1.0, 1.0)
    stretch = (x, 0.0, 0.0, 0.0), (0.0, y, 0.0, 0.0), (0.0, 0.0, z, 0.0), IDENTITY[3]
    if "rotate" not in step:
        return Pose(move, None, 0.0, UPRIGHT, stretch)
    axis, degrees = parse_rotation(step["rotate"], where.child("rotate"))
    return Pose(move, axis, degrees, rotations.quaternion_about(axis, degrees), stretch)


def _taken_apart(matrix: Matrix) -> Pose:
    rows = [[float(matrix[i, j]) for j in range(3)] for i in range(3)]
    turn, stretch = rotations.polar(rows)
    a, b, c = ((row[0], row[1], row[2], 0.0) for row in stretch)
    move = float(matrix[0, 3]), float(matrix[1, 3]), float(matrix[2, 3])
    return Pose(move, None, 0.0, turn, (a, b, c, IDENTITY[3]))


def matrices_of(transform: Motion | Matrix) -> list[Matrix]:
    """The matrices that a transform is made of: itself, or those of a motion's keys."""
    import numpy as np

    if not isinstance(transform, Motion):
        return [transform]
    return [np.array(pose.rows(), dtype=np.float64) for pose in transform.poses]


def _check_volume(motion: Motion, where: Where) -> None:
    """A body must not turn inside out between two keys, for then it is flat on the way."""
    import numpy as np

    for a, b in pairwise(motion.poses):
        shares = [0.0] if a.stretch == b.stretch else [i / PROBES for i in range(PROBES + 1)]
        matrices = [np.array(between(a, b, share), dtype=np.float64) for share in shares]
        if any(flattens(m) for m in matrices) or len({mirrors(m) for m in matrices}) > 1:
            raise where.error("flatten on the way", allowed="keys between which bodies keep a volume")


def mirrors(m: Matrix) -> bool:
    """Does the transform turn what is right into what is left?"""
    (a, b, c), (d, e, f), (g, h, i) = ((float(row[0]), float(row[1]), float(row[2])) for row in m[:3])
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0
