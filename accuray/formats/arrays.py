"""Files of numbers: NumPy's .npy (formats 1.0 and 2.0) and CSV, for what comes by the million.

What a file claims is held against its size before anything is allocated, and a .npy file is never unpickled.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from accuray.scene.memory import check_fits

MAX_HEADER = 10_000
"""Bytes of a .npy header; NumPy's own limit, below which parsing one is harmless."""

CSV_GROWTH = 8
"""Most bytes in memory, while it is parsed, for each byte of a CSV file: a number takes two there and eight here."""


def read_npy(path: Path) -> NDArray[Any]:
    """The array in a .npy file: numbers of any size and byte order, in any order of the axes. Raises ValueError."""
    with path.open("rb") as file:
        shape, fortran, dtype = _npy_header(file)
        count = 1
        for size in shape:
            count *= size
        room = os.fstat(file.fileno()).st_size - file.tell()
        if count * dtype.itemsize != room:
            raise ValueError(f"it claims {count} numbers of {dtype.itemsize} bytes, and has {room} bytes for them")
        check_fits(2 * room, f"its {room} bytes")
        flat = np.fromfile(file, dtype=dtype, count=count)
    if len(flat) != count:
        raise ValueError("it became shorter while it was read")
    flat.flags.writeable = False
    return flat.reshape(shape, order="F" if fortran else "C")


def _npy_header(file: BinaryIO) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether the first axis runs fastest, and type of the numbers."""
    try:
        version = npy.read_magic(file)
        if version == (1, 0):
            shape, fortran, dtype = npy.read_array_header_1_0(file, max_header_size=MAX_HEADER)
        elif version == (2, 0):
            shape, fortran, dtype = npy.read_array_header_2_0(file, max_header_size=MAX_HEADER)
        else:
            raise ValueError("another version of the format")
    except Exception as error:  # Python's own parser reads the header, and raises whatever it likes
        raise ValueError(f"it is no .npy file ({type(error).__name__})") from error
    if dtype.hasobject or dtype.kind not in "fiu" or dtype.subdtype is not None:
        raise ValueError(f"it holds {dtype.name}; allowed are floating-point and whole numbers")
    if any(size < 0 for size in shape):
        raise ValueError(f"it claims the shape {shape}")
    return shape, fortran, dtype


def read_csv(path: Path) -> NDArray[np.float64]:
    """The numbers of a CSV file, (rows, columns); a first line of names and comments after # are left out.

    Raises ValueError that names the row.
    """
    check_fits(CSV_GROWTH * path.stat().st_size, f"its {path.stat().st_size} bytes of text")
    skipped = _lines_before_numbers(path)
    try:
        return np.loadtxt(path, delimiter=",", comments="#", skiprows=skipped, ndmin=2, encoding="utf-8")
    except ValueError as error:
        raise ValueError(f"{str(error).split(';')[0]} (after {skipped} lines before the numbers)") from None


def _lines_before_numbers(path: Path) -> int:
    """How many lines to skip: blank ones, comments, and one of names."""
    has_names = False
    with path.open(encoding="utf-8") as file:
        for number, line in enumerate(file):
            fields = line.partition("#")[0].strip()
            if not fields:
                continue
            if has_names or _is_number(fields.partition(",")[0]):
                return number
            has_names = True
    raise ValueError("it has no rows")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
