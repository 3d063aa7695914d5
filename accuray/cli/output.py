"""Where images go: always an EXR, and beside it a PNG to look at."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .parser import Parser, UsageError

if TYPE_CHECKING:
    import accuray


def add_output_flag(parser: Parser, *, required: bool) -> None:
    """Adds `-o FILE.exr`."""
    default = "" if required else " (default: the scene's name in the current folder)"
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT.exr",
        type=Path,
        required=required,
        help=f"the file to write; a .png is put beside it, and one for each further layer{default}",
    )


def probe(exr: Path, command: str) -> None:
    """Checks that the EXR and its PNG can be written, before any time is spent on them.

    Raises:
        UsageError: another extension, no such folder, or no right to write there.
    """
    import accuray

    if exr.suffix.lower() != ".exr":
        raise UsageError(f"{exr}: the output is an EXR, so its name must end in .exr", command)
    for path in (exr, exr.with_suffix(".png")):
        try:
            accuray.probe_writable(path)
        except accuray.ImageError as error:
            raise UsageError(str(error), command) from error


def save(image: accuray.Image, exr: Path) -> list[Path]:
    """Writes the EXR, then the PNG and one for each further layer, `NAME.indirect.png`; returns their paths."""
    written = [exr, exr.with_suffix(".png")]
    for path in written:
        image.save(path)
    for layer in image.film.layers:
        written.append(exr.with_suffix(f".{layer}.png"))
        image.save(written[-1], layer=layer)
    return written
