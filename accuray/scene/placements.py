"""Transforms by the million: arrays from Python or from files that the readers of ``accuray.formats`` know.

They are checked all at once, never one by one, and kept as float32, as the kernels do.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.scene.arrays import scale_to_metres
from accuray.scene.errors import Where
from accuray.scene.readers import Readers
from accuray.scene.schema import Param
from accuray.scene.scope import Scope
from accuray.scene.transforms import FLAT, RIGID_TOLERANCE

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float32]
    Doubles = npt.NDArray[np.float64]

TRANSFORMS = "file or Nx3x4"
IDS = "file or N"
"""Roles of array parameters that may name a file."""

COLUMNS = 12
MAX_ROWS = 1 << 31
CHUNK = 1 << 16
"""Rows that are worked on at a time."""

MOST = 1e15
"""Entries and scales of a transform, and of its inverse, stay below this: rays are carried into an instance's own space
within Embree's limit of 1.8e18."""

SHAPES = "(N, 3, 4) or (N, 12)"

ArrayReader = Callable[[Path], "npt.NDArray[Any]"]
"""Reads a file into an array of numbers. Raises ValueError for a wrong file."""

_readers: Readers[Any] = Readers()
register_array_reader = _readers.register


class Transforms:
    """N transforms, float32 (N, 12), three rows of four each, lengths in metres; content that does not change.

    ``ids``: uint32 (N,), from the thirteenth column of the file, or None. What came from a file can be forgotten, to be
    read again if it is needed again, so that a rendered scene holds its instances once.
    """

    def __init__(self, rows: Floats, ids: npt.NDArray[np.uint32] | None, again: Callable[[], Floats] | None) -> None:
        self.count = len(rows)
        self.ids = ids
        self.sha256 = hashlib.sha256(rows.data).hexdigest()
        self._rows: Floats | None = rows
        self._again = again

    def rows(self) -> Floats:
        """The transforms. Raises ValueError if they were forgotten and the file has changed since."""
        rows = self._rows
        if rows is None and self._again is not None:
            rows = self._again()
            if hashlib.sha256(rows.data).hexdigest() != self.sha256:
                raise ValueError("the file of the instances has changed since the scene was read")
            self._rows = rows
        assert rows is not None
        return rows

    def forget(self) -> None:
        """Let go of what a file can give again."""
        if self._again is not None:
            self._rows = None


def parse_filed(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    """Transforms, or ids as uint32 (N,), from an array or from the file that ``value`` names. Raises SceneError."""
    import numpy as np

    if isinstance(value, np.ndarray):
        array = value
        again = None
    elif isinstance(value, (str, Path)):
        path = scope.files.resolve(value, where, param.choices, bulk=True)
        array = _readers.read(path, where)
        unit = where.source.length_unit

        def again() -> Floats:
            return _in_metres(_as_rows(_readers.read(path, where))[0], unit)
    else:
        raise where.error("is not a file name", value=value, allowed='a file such as "trees.npy", or a numpy array')
    if param.role == IDS:
        return _whole(array.reshape(-1) if array.ndim == 2 and array.shape[1] == 1 else array, where)
    return _transforms(array, where, again)


def _transforms(array: npt.NDArray[Any], where: Where, again: Callable[[], Floats] | None) -> Transforms:
    if array.dtype.kind not in "fiu":
        raise where.error(f"is an array of {array.dtype}", allowed="an array of numbers")
    try:
        flat, ids = _as_rows(array)
    except ValueError as error:
        raise where.error(str(error)) from None
    if len(flat) > MAX_ROWS:
        raise where.error(f"has {len(flat)} rows", allowed=f"up to {MAX_ROWS}")
    rows = _in_metres(flat, where.source.length_unit)
    check_similar(rows, where)
    rows.flags.writeable = False
    return Transforms(rows, None if ids is None else _whole(ids, where), again)


def _as_rows(array: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any] | None]:
    """(N, 12) and, where there is a thirteenth column, its (N,) ids."""
    if array.ndim == 3 and array.shape[1:] == (3, 4):
        return array.reshape(len(array), COLUMNS), None
    if array.ndim == 2 and array.shape[1] == COLUMNS:
        return array, None
    if array.ndim == 2 and array.shape[1] == COLUMNS + 1:
        return array[:, :COLUMNS], array[:, COLUMNS]
    raise ValueError(f"has the shape {array.shape}: allowed {SHAPES}, or a thirteenth column of ids")


def _in_metres(flat: npt.NDArray[Any], length_unit: str) -> Floats:
    """float32, contiguous; the array itself if it is that already and cannot be written to."""
    import numpy as np

    if flat.dtype == np.float32 and flat.flags.c_contiguous and not flat.flags.writeable and length_unit == "m":
        return flat
    rows = np.empty((len(flat), COLUMNS), dtype=np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        for first in range(0, len(flat), CHUNK):
            chunk = flat[first : first + CHUNK].astype(np.float64)
            chunk[:, 3::4] = scale_to_metres(chunk[:, 3::4], length_unit)
            rows[first : first + CHUNK] = chunk + 0.0  # -0.0 becomes 0.0: both spell the same scene
    return rows


def _whole(array: npt.NDArray[Any], where: Where) -> npt.NDArray[np.uint32]:
    """Ids as uint32; SceneError for what is not a whole number from 0."""
    import numpy as np

    if array.ndim != 1 or array.dtype.kind not in "fiu":
        raise where.error(f"is an array of {array.dtype} of the shape {array.shape}", allowed="N whole numbers")
    with np.errstate(invalid="ignore"):
        bad = np.flatnonzero(~((array >= 0) & (array < 1 << 32) & (array == np.floor(array))))
    if len(bad):
        row = int(bad[0])
        raise where.child(row).error("is not an id", value=array[row].item(), allowed="whole numbers from 0")
    ids = array.astype(np.uint32)
    ids.flags.writeable = False
    return ids


def check_similar(rows: Floats, where: Where) -> None:
    """SceneError at the first row that is no rotation, mirrored or not, times one scale, plus a translation."""
    import numpy as np

    for first in range(0, len(rows), CHUNK):
        chunk = rows[first : first + CHUNK].astype(np.float64)
        for good, problem, allowed in _judgements(chunk):
            if not good.all():
                row = int(np.argmin(good))
                value = chunk[row].tolist()
                raise where.child(first + row).error(problem, value=value, allowed=allowed)


def _judgements(rows: Doubles) -> Iterator[tuple[npt.NDArray[np.bool_], str, str]]:
    """Which rows are good, what the others are, and what is allowed; each judgement relies on those before."""
    import numpy as np

    yield np.isfinite(rows).min(axis=1, initial=True), "is not finite", "finite numbers"
    x, y, z = (rows[:, axis::4] for axis in range(3))
    xx, yy, zz = (_dot(v, v) for v in (x, y, z))
    size = (xx + yy + zz) / 3.0
    largest = np.sqrt(np.maximum(xx, np.maximum(yy, zz)))
    volume = np.abs(_dot(_cross(x, y), z))
    yield (volume > FLAT * largest**3) & (size > 0.0), "flattens", "a transform that leaves bodies a volume"
    skew = np.maximum(np.maximum(np.abs(_dot(x, y)), np.abs(_dot(y, z))), np.abs(_dot(z, x)))
    stretch = np.maximum(np.maximum(np.abs(xx - size), np.abs(yy - size)), np.abs(zz - size))
    rigid = np.maximum(skew, stretch) <= RIGID_TOLERANCE * size
    yield rigid, "shears or stretches an instance", "a rotation times one scale, plus a translation"
    scale = np.sqrt(size)
    far = np.abs(rows[:, 3::4]).max(axis=1, initial=0.0)
    within = (scale < MOST) & (far < MOST) & (scale > 1.0 / MOST) & (far < MOST * scale)
    yield within, "moves or scales too far", "scales and translations from 1e-15 to 1e15"


def _dot(a: Doubles, b: Doubles) -> Doubles:
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def _cross(a: Doubles, b: Doubles) -> Doubles:
    import numpy as np

    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)
