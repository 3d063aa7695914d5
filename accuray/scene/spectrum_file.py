"""Measured spectra in CSV files: one column of wavelengths in nm, then one or more columns of values.

Lines that begin with "#" are comments; the first other line names the columns. Every error names the file and
the line of the CSV and shows it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

from accuray.scene.errors import SceneError, Where, nearest_name
from accuray.scene.paths import display_path

MAX_ROWS = 100_000

Numbers = tuple[float, ...]


@dataclass(frozen=True)
class SpectrumFile:
    """The lines of a CSV file and the place in the scene that names it, for errors."""

    path: Path
    lines: tuple[str, ...]
    where: Where

    def error(
        self, row: int | None, problem: str, allowed: str | None = None, nearest: str | None = None
    ) -> SceneError:
        """An error at a 0-based line of the CSV; it also says which line of the scene names the file."""
        source = self.where.source
        line = source.line_of(self.where.path)
        named = f" (named in {source.name}{f':{line}' if line else ''})" if source.name else ""
        return SceneError(
            problem + named,
            file=display_path(self.path),
            line=None if row is None else row + 1,
            key=self.where.key,
            allowed=allowed,
            nearest=nearest,
            shown=None if row is None else self.lines[row],
        )


@dataclass(frozen=True)
class Column:
    """One column of a file: wavelengths in nm, values and the 0-based line of each row."""

    file: SpectrumFile
    wavelengths: Numbers
    values: Numbers
    rows: tuple[int, ...]


def read_column(path: Path, column: str | None, where: Where) -> Column:
    """Read the named column of a CSV file; ``None`` takes the only one. Raises SceneError."""
    file = _open(path, where)
    content = [row for row, line in enumerate(file.lines) if line.strip() and not line.lstrip().startswith("#")]
    if not content:
        raise file.error(None, "has no rows", "a header line and at least 2 rows of numbers")
    if len(content) - 1 > MAX_ROWS:
        raise file.error(None, f"has {len(content) - 1} rows", f"up to {MAX_ROWS}")
    header = [cell.strip() for cell in file.lines[content[0]].split(",")]
    if _is_number(header[0]):
        raise file.error(content[0], "starts with numbers", "a first line that names the columns")
    index = _column_index(file, content[0], header, column)
    wavelengths: list[float] = []
    values: list[float] = []
    for row in content[1:]:
        cells = file.lines[row].split(",")
        if len(cells) != len(header):
            raise file.error(row, f"has {len(cells)} cells", f"{len(header)}, as in the header")
        wavelengths.append(_number(file, row, header[0], cells[0]))
        values.append(_number(file, row, header[index], cells[index]))
    return Column(file, tuple(wavelengths), tuple(values), tuple(content[1:]))


def _open(path: Path, where: Where) -> SpectrumFile:
    file = SpectrumFile(path, (), where)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise file.error(None, f"is not UTF-8 text (byte {error.start})") from None
    except OSError as error:
        raise file.error(None, f"cannot be read ({error.strerror})") from None
    return replace(file, lines=tuple(text.replace("\r\n", "\n").split("\n")))


def _column_index(file: SpectrumFile, row: int, header: list[str], column: str | None) -> int:
    names = header[1:]
    if not names:
        raise file.error(row, "has one column only", "wavelengths in nm and at least one column of values")
    if column is None:
        if len(names) > 1:
            raise file.error(row, "has several columns; `column` must name one", ", ".join(names))
        return 1
    if column not in names:
        raise file.error(row, f'has no column "{column}"', ", ".join(names), nearest_name(column, names))
    return 1 + names.index(column)


def _number(file: SpectrumFile, row: int, name: str, cell: str) -> float:
    text = cell.strip()
    if not _is_number(text) or "_" in text:
        raise file.error(row, f'"{text}" in column "{name}" is not a number', "a decimal number")
    value = float(text)
    if not math.isfinite(value):
        raise file.error(row, f'{text} in column "{name}" is not finite', "a finite number")
    return value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
