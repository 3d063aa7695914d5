"""Reads PNG files of every colour type and bit depth (W3C 2003, Portable Network Graphics, second edition).

Sizes are checked before memory is taken: a file may hold 2^26 pixels at most, and no more than deflate can expand its
bytes to.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .errors import ImageError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Channels by colour type: grey, RGB, palette, grey and alpha, RGB and alpha."""
_DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
_PALETTE = 3
_MOST_PIXELS = 1 << 26
_DEFLATE_LIMIT = 1032
"""Largest ratio of deflate."""
_ADAM7 = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
"""First column, first row, step across, step down of each pass of an interlaced file."""

Samples = NDArray[np.uint8] | NDArray[np.uint16]


@dataclass(frozen=True)
class _Header:
    width: int
    height: int
    depth: int
    colour: int
    interlaced: bool

    @property
    def channels(self) -> int:
        return _CHANNELS[self.colour]

    def row_bytes(self, width: int) -> int:
        """Bytes of a row of so many pixels, without the filter's number."""
        return (width * self.channels * self.depth + 7) // 8

    def passes(self) -> Iterator[tuple[int, int, int, int, int, int]]:
        """First column and row, steps, width and height of each pass that has pixels."""
        for x, y, dx, dy in _ADAM7 if self.interlaced else ((0, 0, 1, 1),):
            width, height = -(-(self.width - x) // dx), -(-(self.height - y) // dy)
            if width > 0 and height > 0:
                yield x, y, dx, dy, width, height


def read_png(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """The values of a PNG file as they are stored, 0 to 1: encoded for display.

    Returns:
        rgb (height, width, 3), grey repeated, not multiplied by alpha; and alpha (height, width), or None.

    Raises:
        ImageError: names the path and says whether the file is missing, no PNG, too large, truncated or damaged.
    """
    try:
        with open(path, "rb") as file:
            data = file.read()
    except (OSError, ValueError) as error:
        raise ImageError(f"cannot be read: {getattr(error, 'strerror', None) or error}", path) from error
    try:
        return _decode(data)
    except ImageError as error:
        raise ImageError(error.reason, path) from error.__cause__


def _decode(data: bytes) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    if not data.startswith(_SIGNATURE):
        raise ImageError("is not a PNG file" if data else "is empty, not a PNG file")
    chunks = _chunks(data)
    header = _header(chunks.get(b"IHDR", b""))
    samples = _samples(header, chunks.get(b"IDAT", b""))
    values = samples.astype(np.float64) / ((1 << header.depth) - 1)
    if header.colour == _PALETTE:
        return _from_palette(samples[:, :, 0], chunks.get(b"PLTE", b""), chunks.get(b"tRNS", b""))
    alpha = values[:, :, -1] if header.channels in (2, 4) else _keyed(samples, chunks.get(b"tRNS", b""))
    colours = values[:, :, :3] if header.channels >= 3 else np.repeat(values[:, :, :1], 3, axis=2)
    return colours, alpha


def _chunks(data: bytes) -> dict[bytes, bytes]:
    """Contents by name; those of one name are joined, as IDAT must be."""
    parts: dict[bytes, list[bytes]] = {}
    at = len(_SIGNATURE)
    while b"IEND" not in parts:
        if at + 12 > len(data):
            raise ImageError("is truncated: it has no end")
        length, name = struct.unpack_from(">I4s", data, at)
        end = at + 8 + length
        if end + 4 > len(data):
            raise ImageError(f"is truncated: its chunk {name!r} goes beyond the end")
        if zlib.crc32(data[at + 4 : end]) != struct.unpack_from(">I", data, end)[0]:
            raise ImageError(f"is damaged: the checksum of its chunk {name!r} does not match")
        parts.setdefault(name, []).append(data[at + 8 : end])
        at = end + 4
    return {name: b"".join(contents) for name, contents in parts.items()}


def _header(content: bytes) -> _Header:
    if len(content) != 13:
        raise ImageError("is damaged: it has no proper header")
    width, height, depth, colour, compression, filtering, interlacing = struct.unpack(">IIBBBBB", content)
    known = depth in _DEPTHS.get(colour, ()) and compression == filtering == 0 and interlacing in (0, 1)
    if not (known and width and height):
        raise ImageError("is damaged: its header describes no PNG that exists")
    if width * height > _MOST_PIXELS:
        raise ImageError(f"is too large: {width} x {height} pixels, and allowed are {_MOST_PIXELS}")
    return _Header(width, height, depth, colour, interlacing == 1)


def _samples(header: _Header, compressed: bytes) -> Samples:
    """The pixels (height, width, channels), of 8 bits or 16; smaller depths are not scaled."""
    expected = sum(height * (1 + header.row_bytes(width)) for *_, width, height in header.passes())
    if expected > (len(compressed) + 1) * _DEFLATE_LIMIT:
        raise ImageError(f"is damaged: {len(compressed)} bytes cannot hold its {expected} bytes of pixels")
    try:
        stream = zlib.decompressobj().decompress(compressed, expected)
    except zlib.error as error:
        raise ImageError(f"is damaged: {error}") from error
    if len(stream) < expected:
        raise ImageError(f"is truncated: {len(stream)} of {expected} bytes of pixels")
    kind = np.uint16 if header.depth == 16 else np.uint8
    result = np.empty((header.height, header.width, header.channels), dtype=kind)
    at = 0
    for x, y, dx, dy, width, height in header.passes():
        size = height * (1 + header.row_bytes(width))
        rows = np.frombuffer(stream, np.uint8, size, at).reshape(height, -1)
        result[y::dy, x::dx] = _unpacked(_unfiltered(rows, max(1, header.channels * header.depth // 8)), header, width)
        at += size
    return result


def _unfiltered(rows: NDArray[np.uint8], step: int) -> NDArray[np.uint8]:
    """Rows (n, 1 + bytes), each after its filter's number, as they were before filtering; `step` bytes per pixel.

    A byte follows from those left of it, above it and left above it, so all bytes on a diagonal follow at once. In an
    array with a border of zeros a diagonal is a slice: its pixels are `width` pixels apart.
    """
    filters, height = rows[:, 0], len(rows)
    if filters.max() > 4:
        raise ImageError(f"is damaged: there is no filter {filters.max()}")
    coded = rows[:, 1:].reshape(height, -1, step)
    width = coded.shape[1]
    bordered = np.zeros((height + 1, width + 1, step), dtype=np.uint8)
    bordered[1:, 1:] = coded
    flat = bordered.reshape(-1, step)
    for diagonal in range(height + width - 1):
        first, end = max(0, diagonal - width + 1), min(height, diagonal + 1)
        at = (first + 1) * (width + 1) + diagonal - first + 1
        stop = at + (end - first - 1) * width + 1
        left, up, corner = (flat[at - back : stop - back : width] for back in (1, width + 1, width + 2))
        flat[at:stop:width] += _prediction(filters[first:end, None], left, up, corner)
    return bordered[1:, 1:].reshape(height, -1)


def _prediction(
    filters: NDArray[np.uint8], left: NDArray[np.uint8], up: NDArray[np.uint8], corner: NDArray[np.uint8]
) -> NDArray[np.uint8]:
    """What filter 0 to 4 (none, left, up, mean, Paeth) expects, per pixel (n, step)."""
    a, b, c = (values.astype(np.int16) for values in (left, up, corner))
    from_a, from_b, from_c = np.abs(b - c), np.abs(a - c), np.abs(a + b - 2 * c)
    paeth = np.where((from_a <= from_b) & (from_a <= from_c), a, np.where(from_b <= from_c, b, c))
    return np.choose(filters, [np.zeros_like(a), a, b, (a + b) >> 1, paeth]).astype(np.uint8)


def _unpacked(rows: NDArray[np.uint8], header: _Header, width: int) -> Samples:
    """Rows of bytes as samples (height, width, channels)."""
    shape = (len(rows), width, header.channels)
    if header.depth == 16:
        return np.ascontiguousarray(rows).view(">u2").astype(np.uint16).reshape(shape)
    if header.depth == 8:
        return rows.reshape(shape)
    bits = np.unpackbits(rows, axis=1)[:, : width * header.depth].reshape(len(rows), width, header.depth)
    return np.packbits(bits, axis=2) >> np.uint8(8 - header.depth)


def _from_palette(
    indices: Samples, palette: bytes, opacity: bytes
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Colours and, if any entry is transparent, alpha."""
    if len(palette) % 3 or not 0 < len(palette) <= 768:
        raise ImageError("is damaged: its palette is none")
    colours = np.frombuffer(palette, np.uint8).reshape(-1, 3) / 255.0
    if indices.max() >= len(colours):
        raise ImageError(f"is damaged: it uses colour {indices.max()} of a palette of {len(colours)}")
    if not opacity:
        return colours[indices], None
    alpha = np.ones(256)
    alpha[: len(opacity)] = np.frombuffer(opacity[:256], np.uint8) / 255.0
    return colours[indices], alpha[indices]


def _keyed(samples: Samples, key: bytes) -> NDArray[np.float64] | None:
    """Alpha 0 where the pixel is the one colour that the file calls transparent; None if it calls none so."""
    if not key:
        return None
    if len(key) != 2 * samples.shape[2]:
        raise ImageError("is damaged: its transparent colour is none")
    return np.asarray(np.where((samples == np.frombuffer(key, ">u2")).all(axis=2), 0.0, 1.0))
