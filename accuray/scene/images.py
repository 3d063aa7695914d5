"""Pictures of textures: arrays from Python, and files through the reader that ``accuray.formats`` registers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.scene.errors import Where
from accuray.scene.scope import Scope

if TYPE_CHECKING:
    import numpy.typing as npt

    Pixels = npt.NDArray[Any]

MAX_SIDE = 1 << 20
MAX_TEXELS = 1 << 30
MAX_BYTES = 4 << 30
"""Largest picture: texels on a side, texels in all, and bytes in memory. Files that claim more are refused unread."""

LIMITS = f"up to {MAX_SIDE} texels on a side, {MAX_TEXELS} in all and {MAX_BYTES >> 30} GiB in memory"
_KINDS = ("uint8", "uint16", "float16", "float32")
_SHAPES = "height x width numbers, or height x width x channels with 1 to 4 channels"

ImageReader = Callable[[Path], "Pixels"]
"""Reads a file into (height, width, channels) of uint8, uint16, float16 or float32, from the top. Raises ValueError."""

_reader: ImageReader | None = None


def register_image_reader(reader: ImageReader) -> None:
    """Use ``reader`` for all image files."""
    global _reader
    _reader = reader


def read_pixels(path: Path, where: Where, scope: Scope) -> Pixels:
    """The picture in a file; one that several textures name is read once. Raises SceneError."""
    pixels: Pixels | None = scope.images.get(path)
    if pixels is None:
        if _reader is None:
            raise where.error("has no reader", value=path.name, allowed="none (import accuray.formats)")
        try:
            pixels = _reader(path)
        except (ValueError, OSError) as error:
            raise where.error(f"cannot be read: {error}", value=path.name, allowed="an image file") from error
        scope.images[path] = _checked(pixels, where)
    return pixels


def check_size(width: int, height: int, bytes_per_texel: int) -> None:
    """ValueError for a picture that is empty or beyond the limits."""
    if width < 1 or height < 1:
        raise ValueError(f"it claims {width} x {height} texels; allowed are at least 1 x 1")
    size = width * height * bytes_per_texel
    if max(width, height) > MAX_SIDE or width * height > MAX_TEXELS or size > MAX_BYTES:
        raise ValueError(f"it claims {width} x {height} texels, {size} bytes; allowed are {LIMITS}")


def parse_pixels(value: Any, where: Where) -> Pixels:
    """A picture given as an array or as nested lists of numbers. Raises SceneError."""
    import numpy as np

    if not isinstance(value, np.ndarray):
        if not isinstance(value, (list, tuple)):
            raise where.error("is not a picture", value=value, allowed=_SHAPES)
        try:
            value = np.array(value, dtype=np.float32)
        except (ValueError, TypeError, OverflowError):
            raise where.error("is not a picture", value=value, allowed=_SHAPES) from None
    if value.dtype == np.float64:
        value = value.astype(np.float32)
    if value.ndim == 2:
        value = value[..., np.newaxis]
    if value.dtype.name not in _KINDS:
        raise where.error(f"is an array of {value.dtype}", allowed=", ".join((*_KINDS, "float64")))
    if value.ndim != 3 or not 1 <= value.shape[2] <= 4:
        raise where.error(f"has the shape {value.shape}", allowed=_SHAPES)
    try:
        check_size(value.shape[1], value.shape[0], value.shape[2] * value.itemsize)
    except ValueError as error:
        raise where.error(str(error)) from None
    return _checked(np.array(value, order="C"), where)


def _checked(pixels: Pixels, where: Where) -> Pixels:
    """The array, no longer writable, if all its texels are finite numbers."""
    import numpy as np

    if pixels.dtype.kind == "f" and not np.isfinite(pixels).all():
        row, column, channel = (int(index) for index in np.argwhere(~np.isfinite(pixels))[0])
        raise where.error(
            f"has a texel that is not a finite number: row {row}, column {column}, channel {channel}",
            allowed="finite numbers",
        )
    pixels.flags.writeable = False
    return pixels
