"""IES files: measured light distributions (ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019), type C photometry.

A file is lines of text up to ``TILT=``, then numbers between blanks, commas and line ends: of the lamps, of the
luminaire, the vertical and the horizontal angles, and for each horizontal angle the candelas at all vertical ones.
Real files break lines anywhere, so only the order of the numbers counts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from accuray.scene.photometry import Photometry

MAX_BYTES = 16 << 20
MAX_VALUES = 1 << 20
MAX_LUMENS = 1e15
FIRST_LINES = {
    "IESNA91": 1991,
    "IESNA:LM-63-1995": 1995,
    "IESNA:LM-63-2002": 2002,
    "IES:LM-63-2019": 2019,
}
"""First line of a file -> year of its format; a file of 1986 has none."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?")
_LINE_END = re.compile(r"\r\n|\n|\r")
_TYPES = {1: "C", 2: "B", 3: "A"}

Array = NDArray[np.float64]


def read(path: Path) -> Photometry:
    """The light distribution in an IES file, unfolded by its symmetry. Raises ValueError that names the line."""
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"it is larger than {MAX_BYTES} bytes")
    lines = _LINE_END.split(content.decode("latin-1").removeprefix("\xef\xbb\xbf"))
    year = FIRST_LINES.get(lines[0].strip().upper(), 1986)
    tilt = next((number for number, line in enumerate(lines) if line.strip().upper().startswith("TILT")), None)
    if tilt is None:
        raise ValueError("it has no line `TILT=`, so it is no IES file")
    numbers = _Numbers(lines, tilt + 1)
    _pass_tilt(lines[tilt], tilt + 1, numbers)
    return _photometry(numbers, year)


@dataclass
class _Numbers:
    """The numbers of the lines from ``first`` (0-based) on, one after the other; ``line`` is the 1-based last one's."""

    lines: list[str]
    first: int
    line: int = 0
    words: Iterator[tuple[int, str]] = field(init=False)

    def __post_init__(self) -> None:
        rest = enumerate(self.lines[self.first :], self.first + 1)
        self.words = ((line, word) for line, text in rest for word in text.replace(",", " ").split())

    def take(self, what: str) -> float:
        """The next number; ``what`` says what it means."""
        found = next(self.words, None)
        if found is None:
            raise ValueError(f"it ends before {what}")
        self.line, word = found
        value = float(word) if _NUMBER.fullmatch(word) else math.nan
        if not math.isfinite(value):
            raise ValueError(f"line {self.line}: {_shown(word)} is no finite number, in place of {what}")
        return value

    def count(self, what: str, least: int) -> int:
        """The next number as a count."""
        value = self.take(what)
        if value != int(value) or not least <= value <= MAX_VALUES:
            raise ValueError(f"line {self.line}: {what} is {value:g}; allowed are whole numbers from {least} up")
        return int(value)

    def factor(self, what: str) -> float:
        """The next number as a positive factor."""
        value = self.take(what)
        if not value > 0.0:
            raise ValueError(f"line {self.line}: {what} is {value:g}; allowed is more than 0")
        return value

    def several(self, count: int, what: str) -> Array:
        """The next numbers; no more memory is used than the file has numbers."""
        return np.array([self.take(f"{what} {i + 1} of {count}") for i in range(count)], dtype=np.float64)

    def end(self) -> None:
        """Nothing but blanks may follow."""
        found = next(self.words, None)
        if found is not None:
            raise ValueError(f"line {found[0]}: {_shown(found[1])} follows the last candela; the counts are wrong")


def _shown(word: str) -> str:
    """A word of the file, short and printable."""
    return repr(word[:24])


def _pass_tilt(text: str, line: int, numbers: _Numbers) -> None:
    """Reads over the table of how the lamp's flux depends on a tilt of the luminaire: it hangs as it was measured."""
    value = text.partition("=")[2].strip().upper()
    if value == "INCLUDE":
        numbers.take("the lamp's position")
        count = numbers.count("the number of tilt angles", 1)
        numbers.several(count, "tilt angle")
        numbers.several(count, "tilt factor")
    elif value != "NONE":
        raise ValueError(f"line {line}: {_shown(text.strip())} is not read; allowed are TILT=NONE and TILT=INCLUDE")


def _photometry(numbers: _Numbers, year: int) -> Photometry:
    lamps = numbers.count("the number of lamps", 0)
    lumens = numbers.take("the lumens of a lamp")
    if lumens > MAX_LUMENS:
        raise ValueError(f"line {numbers.line}: the lumens of a lamp are {lumens:g}; allowed are up to {MAX_LUMENS:g}")
    multiplier = numbers.factor("the candela multiplier")
    verticals = numbers.count("the number of vertical angles", 2)
    horizontals = numbers.count("the number of horizontal angles", 1)
    if verticals * horizontals > MAX_VALUES:
        raise ValueError(f"line {numbers.line}: it claims {verticals} x {horizontals} candelas; allowed {MAX_VALUES}")
    kind = numbers.count("the type of photometry", 1)
    if kind != 1:
        name = _TYPES.get(kind, f"number {kind}")
        raise ValueError(f"line {numbers.line}: its photometry is of type {name}; allowed is type C (1)")
    if numbers.count("the unit of lengths", 1) > 2:
        raise ValueError(f"line {numbers.line}: the unit of lengths is unknown; allowed are 1 (feet) and 2 (metres)")
    numbers.several(3, "size of the opening")
    multiplier *= numbers.factor("the ballast factor")
    lamp_factor = numbers.take("the ballast-lamp factor")
    if year < 1995:  # since then the place is kept for other uses
        multiplier *= lamp_factor
    numbers.take("the input watts")
    vertical = _rising(numbers.several(verticals, "vertical angle"), "vertical", numbers.line)
    if vertical[0] < 0.0 or vertical[-1] > 180.0:
        span = f"{vertical[0]:g} to {vertical[-1]:g}"
        raise ValueError(f"line {numbers.line}: vertical angles are {span}; allowed are 0 to 180")
    horizontal = _rising(numbers.several(horizontals, "horizontal angle"), "horizontal", numbers.line)
    last = numbers.line
    candela = numbers.several(verticals * horizontals, "candela").reshape(horizontals, verticals)
    with np.errstate(over="ignore"):
        candela = candela * multiplier
    numbers.end()
    if not np.isfinite(candela).all() or candela.min() < 0.0 or candela.max() > 1e30:
        raise ValueError(f"candelas are {candela.min():g} to {candela.max():g}; allowed are 0 to 1e30")
    horizontal, candela = _unfolded(horizontal, candela, last)
    return Photometry(vertical, horizontal, candela, lamps * lumens if lumens > 0.0 and lamps else None)


def _rising(angles: Array, name: str, line: int) -> Array:
    """The angles in thousandths of a degree, which single precision in radians still tells apart."""
    angles = np.round(angles, 3)
    if (np.diff(angles) <= 0.0).any():
        at = int(np.argmax(np.diff(angles) <= 0.0))
        raise ValueError(f"line {line}: the {name} angle {angles[at + 1]:g} does not rise from {angles[at]:g}")
    return angles


def _unfolded(horizontal: Array, candela: Array, line: int) -> tuple[Array, Array]:
    """Angles from 0 to 360 and their candelas, by the symmetry that the first and the last angle stand for.

    The last angle of a whole circle may be left out, a step before 360; there the first one's candelas stand again.
    """
    if len(horizontal) == 1:
        return np.zeros(1), candela
    first, last = float(horizontal[0]), float(horizontal[-1])
    if first == 0.0 and 0.0 < 360.0 - last <= 1.001 * float(np.diff(horizontal).min()):
        horizontal, candela, last = np.append(horizontal, 360.0), np.vstack([candela, candela[:1]]), 360.0
    if (first, last) == (0.0, 90.0):  # each quadrant alike
        angles = np.concatenate([horizontal, 180.0 - horizontal, 180.0 + horizontal, 360.0 - horizontal])
        source = 90.0 - np.abs(90.0 - np.unique(angles) % 180.0)
    elif (first, last) == (0.0, 180.0):  # both sides of the plane of 0 and 180 alike
        angles = np.concatenate([horizontal, 360.0 - horizontal])
        source = 180.0 - np.abs(180.0 - np.unique(angles))
    elif (first, last) == (90.0, 270.0):  # both sides of the plane of 90 and 270 alike
        angles = np.concatenate([horizontal, (540.0 - horizontal) % 360.0, [0.0, 360.0]])
        source = _mirrored(np.unique(angles))
    elif (first, last) == (0.0, 360.0):
        return horizontal, candela
    else:
        span = f"{first:g} to {last:g}"
        raise ValueError(f"line {line}: horizontal angles are {span}; allowed are 0, 0 to 90, 180 or 360, or 90 to 270")
    unique = np.unique(angles)
    columns = [np.interp(source, horizontal, candela[:, i]) for i in range(candela.shape[1])]
    return unique, np.stack(columns, axis=1)


def _mirrored(angles: Array) -> Array:
    """Angles of 0 to 360 on the side of 90 to 270."""
    return np.where(angles < 90.0, 180.0 - angles, np.where(angles > 270.0, 540.0 - angles, angles))
