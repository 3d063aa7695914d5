"""8-bit sRGB PNG files for display and notebooks (W3C 2003, Portable Network Graphics, second edition)."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from .colour import exposure_scale, srgb8
from .film import row_blocks

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOUR_TYPES = {3: 2, 4: 6}
"""PNG's numbers for RGB and RGBA, by channels."""
_PERCEPTUAL = b"\0"
"""The rendering intent that goes with sRGB."""
_PIXELS_AT_ONCE = 1 << 18
"""Pixels filtered at a time, so that temporaries stay small."""


def encode_png(rgb: NDArray[np.float32], alpha: NDArray[np.float32] | None = None, *, exposure: float = 0.0) -> bytes:
    """The PNG file of a linear Rec.709 image, marked as sRGB. Equal arguments give equal bytes.

    Args:
        rgb: (height, width, 3) linear, premultiplied by alpha when alpha is given; NaN becomes black.
        alpha: (height, width) in 0..1, or None for an opaque PNG. PNG stores colour not premultiplied.
        exposure: in EV, applied before encoding.

    Raises:
        ImageError: exposure out of range.
    """
    scale = np.float32(exposure_scale(exposure))
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is white
        if alpha is None:
            return encode_codes(srgb8(rgb * scale))
        opacity = np.clip(np.nan_to_num(alpha), 0.0, 1.0)[:, :, None]
        straight = np.divide(rgb, opacity, out=np.zeros_like(rgb), where=opacity > 0)
        return encode_codes(np.concatenate([srgb8(straight * scale), np.rint(opacity * 255).astype(np.uint8)], axis=2))


def encode_codes(pixels: NDArray[np.uint8]) -> bytes:
    """The PNG file of 8-bit sRGB codes (height, width, 3 or 4)."""
    height, width, channels = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPES[channels], 0, 0, 0)
    chunks = ((b"IHDR", header), (b"sRGB", _PERCEPTUAL), (b"IDAT", _compressed(pixels)), (b"IEND", b""))
    return _SIGNATURE + b"".join(_chunk(name, content) for name, content in chunks)


def _chunk(name: bytes, content: bytes) -> bytes:
    """Length, name, content and CRC-32."""
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def _compressed(pixels: NDArray[np.uint8]) -> bytes:
    """The zlib stream of the filtered rows.

    A path-traced picture is noisy: its bytes hardly repeat, and the search for longer matches than runs makes the
    file larger as well as slower (measured on the Cornell box: 381 kB in 11 ms by runs, 426 kB in 25 ms by matches).
    """
    stream = zlib.compressobj(strategy=zlib.Z_RLE)
    height, width, channels = pixels.shape
    rows = np.ascontiguousarray(pixels).reshape(height, width * channels)
    above = np.zeros_like(rows[0])
    parts = []
    for block in row_blocks((height, width), _PIXELS_AT_ONCE):
        parts.append(stream.compress(_filtered(rows[block], above, channels).tobytes()))
        above = rows[block][-1]
    return b"".join(parts) + stream.flush()


def _filtered(rows: NDArray[np.uint8], above: NDArray[np.uint8], channels: int) -> NDArray[np.uint8]:
    """Each row (n, bytes) less its prediction, after the number of the filter: the one with the least sum of
    absolute differences, as the specification advises (12.8). ``above`` is the row over the first one.
    """
    left, up = np.zeros_like(rows), np.empty_like(rows)
    left[:, channels:] = rows[:, :-channels]
    up[0], up[1:] = above, rows[:-1]
    mean = (left >> 1) + (up >> 1) + (left & up & 1)
    differences = np.stack([rows, rows - left, rows - up, rows - mean])  # filters 0 to 3, modulo 256
    cost = np.abs(differences.view(np.int8).astype(np.int16)).sum(axis=2)
    best = cost.argmin(axis=0)
    result = np.empty((len(rows), rows.shape[1] + 1), dtype=np.uint8)
    result[:, 0] = best
    result[:, 1:] = differences[best, np.arange(len(rows))]
    return result


def shrink(image: NDArray[np.float32], limit: int) -> NDArray[np.float32]:
    """The (height, width, channels) image averaged over k x k blocks, k the least that gives width <= limit.

    Blocks at the right and lower edge are averaged over the pixels they have.
    """
    k = -(-image.shape[1] // limit)
    if k <= 1:
        return image
    ys, xs = np.arange(0, image.shape[0], k), np.arange(0, image.shape[1], k)
    total = np.add.reduceat(np.add.reduceat(image, ys, axis=0), xs, axis=1)
    rows = np.diff(np.append(ys, image.shape[0]))
    columns = np.diff(np.append(xs, image.shape[1]))
    area = rows[:, None] * columns[None, :]
    return np.asarray(total / area[:, :, None], dtype=np.float32)
