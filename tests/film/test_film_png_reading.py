"""PNG files: every kind is read as it was written, and a damaged one is an error, whatever the damage."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
from numpy.typing import NDArray

from accuray.film import ImageError
from accuray.film.png import encode_png
from accuray.film.png_reading import read_png

CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
KINDS = [
    (0, 1),
    (0, 2),
    (0, 4),
    (0, 8),
    (0, 16),
    (2, 8),
    (2, 16),
    (3, 1),
    (3, 4),
    (3, 8),
    (4, 8),
    (4, 16),
    (6, 8),
    (6, 16),
]
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
PALETTE = np.random.default_rng(5).integers(0, 256, (256, 3), dtype=np.uint8)


def chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def file_of(*chunks: bytes) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def header(width: int, height: int, depth: int, colour: int, interlaced: bool = False) -> bytes:
    return chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, int(interlaced)))


def filtered(rows: list[bytes], step: int, filters: list[int]) -> bytes:
    """Rows by the filters' definitions, byte after byte (PNG specification, chapter 9)."""
    result, above = bytearray(), bytes(len(rows[0]))
    for row, kind in zip(rows, filters, strict=True):
        result.append(kind)
        for i, value in enumerate(row):
            a = row[i - step] if i >= step else 0
            b, c = above[i], above[i - step] if i >= step else 0
            estimate = a + b - c
            paeth = min((abs(estimate - a), 0, a), (abs(estimate - b), 1, b), (abs(estimate - c), 2, c))[2]
            result.append((value - (0, a, b, (a + b) // 2, paeth)[kind]) % 256)
        above = row
    return bytes(result)


def packed(samples: NDArray[np.uint16], depth: int) -> list[bytes]:
    """Rows of bytes of samples (height, width, channels)."""
    flat = samples.reshape(len(samples), -1)
    if depth == 16:
        return [row.astype(">u2").tobytes() for row in flat]
    bits = (flat[:, :, None] >> np.arange(depth - 1, -1, -1)) & 1
    return [np.packbits(row.ravel().astype(np.uint8)).tobytes() for row in bits]


def encoded(samples: NDArray[np.uint16], depth: int, colour: int, interlaced: bool, more: bytes = b"") -> bytes:
    """A PNG file of samples (height, width, channels), with every filter in turn."""
    step = max(1, CHANNELS[colour] * depth // 8)
    stream = b""
    for x, y, dx, dy in PASSES if interlaced else [(0, 0, 1, 1)]:
        part = samples[y::dy, x::dx]
        if part.size:
            stream += filtered(packed(part, depth), step, [(3 * i + x) % 5 for i in range(len(part))])
    height, width = samples.shape[:2]
    data = zlib.compress(stream)
    third = len(data) // 3
    pieces = (data[:third], data[third : 2 * third], data[2 * third :])
    return file_of(
        header(width, height, depth, colour, interlaced),
        chunk(b"PLTE", PALETTE[: 1 << depth].tobytes()) if colour == 3 else b"",
        more,
        *(chunk(b"IDAT", piece) for piece in pieces),
        chunk(b"IEND", b""),
    )


def random_samples(depth: int, colour: int, size: tuple[int, int]) -> NDArray[np.uint16]:
    rng = np.random.default_rng(depth * 7 + colour)
    return rng.integers(0, 1 << depth, (size[1], size[0], CHANNELS[colour]), dtype=np.uint16)


def expected_rgb(samples: NDArray[np.uint16], depth: int, colour: int) -> NDArray[np.float64]:
    if colour == 3:
        return np.asarray(PALETTE[samples[:, :, 0]] / 255)
    values = samples / ((1 << depth) - 1)
    return np.asarray(values[:, :, :3] if colour in (2, 6) else np.repeat(values[:, :, :1], 3, axis=2))


@pytest.mark.parametrize("interlaced", [False, True], ids=["plain", "interlaced"])
@pytest.mark.parametrize("size", [(1, 1), (3, 9), (21, 13)], ids=str)
@pytest.mark.parametrize(("colour", "depth"), KINDS)
def test_every_kind_with_every_filter(
    colour: int, depth: int, size: tuple[int, int], interlaced: bool, tmp_path: Path
) -> None:
    samples = random_samples(depth, colour, size)
    path = tmp_path / "a.png"
    path.write_bytes(encoded(samples, depth, colour, interlaced))
    rgb, alpha = read_png(path)
    assert np.array_equal(rgb, expected_rgb(samples, depth, colour))
    if colour in (4, 6):
        assert alpha is not None
        assert np.array_equal(alpha, samples[:, :, -1] / ((1 << depth) - 1))
    else:
        assert alpha is None


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "RGB", "RGBA", "I;16"])
def test_pillows_files_are_read(mode: str, tmp_path: Path) -> None:
    """Against another reader of the same file."""
    y, x = np.mgrid[0:33, 0:47]
    picture = PIL.Image.fromarray(np.stack([x * 5, y * 7, x * y % 256, 255 - x * 4], axis=2).astype(np.uint8))
    if mode == "I;16":
        picture = PIL.Image.fromarray((x * 1300 + y).astype(np.uint16))
    else:
        picture = picture.convert(mode) if mode == "RGBA" else picture.convert("RGB").convert(mode)
    picture.save(tmp_path / "a.png")
    rgb, alpha = read_png(tmp_path / "a.png")
    if mode == "I;16":
        assert np.array_equal(rgb[:, :, 1], (x * 1300 + y) / 65535)
        return
    again = np.asarray(PIL.Image.open(tmp_path / "a.png").convert("RGBA")) / 255
    assert np.array_equal(rgb, again[:, :, :3])
    assert alpha is None or np.array_equal(alpha, again[:, :, 3])


def test_our_own_files_are_read(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    (tmp_path / "a.png").write_bytes(encode_png(rng.random((40, 30, 3), dtype=np.float32)))
    rgb, alpha = read_png(tmp_path / "a.png")
    assert np.array_equal(rgb * 255, np.asarray(PIL.Image.open(tmp_path / "a.png")))
    assert alpha is None


def test_transparent_colours(tmp_path: Path) -> None:
    samples = random_samples(2, 0, (9, 9))
    (tmp_path / "a.png").write_bytes(encoded(samples, 2, 0, False, chunk(b"tRNS", struct.pack(">H", 3))))
    alpha = read_png(tmp_path / "a.png")[1]
    assert alpha is not None
    assert np.array_equal(alpha, np.where(samples[:, :, 0] == 3, 0, 1))
    samples = random_samples(4, 3, (9, 9))
    (tmp_path / "b.png").write_bytes(encoded(samples, 4, 3, False, chunk(b"tRNS", bytes([0, 128]))))
    alpha = read_png(tmp_path / "b.png")[1]
    assert alpha is not None
    assert np.array_equal(alpha, np.array([0, 128 / 255, *[1.0] * 14])[samples[:, :, 0]])


def good() -> bytes:
    return encoded(random_samples(8, 2, (7, 5)), 8, 2, False)


def with_pixels(*chunks: bytes) -> bytes:
    return file_of(*chunks, chunk(b"IEND", b""))


ZEROS = zlib.compress(bytes(1000))
DAMAGED: dict[str, tuple[Callable[[], bytes], str]] = {
    "empty": (lambda: b"", "is empty, not a PNG"),
    "text": (lambda: b"not a picture at all", "is not a PNG file"),
    "a JPEG": (lambda: b"\xff\xd8\xff\xe0" + bytes(64), "is not a PNG file"),
    "no end": (lambda: good()[:-12], "truncated: it has no end"),
    "cut in the middle": (lambda: good()[:60], "truncated: its chunk"),
    "a flipped bit": (lambda: good()[:50] + bytes([good()[50] ^ 1]) + good()[51:], "checksum"),
    "no header": (lambda: with_pixels(chunk(b"IDAT", ZEROS)), "no proper header"),
    "no pixels": (lambda: with_pixels(header(4, 4, 8, 2)), "is truncated: 0 of 52 bytes"),
    "no size": (lambda: with_pixels(header(0, 4, 8, 2)), "no PNG that exists"),
    "depth 3": (lambda: with_pixels(header(4, 4, 3, 0), chunk(b"IDAT", ZEROS)), "no PNG that exists"),
    "colour 5": (lambda: with_pixels(header(4, 4, 8, 5), chunk(b"IDAT", ZEROS)), "no PNG that exists"),
    "huge": (lambda: with_pixels(header(2**31 - 1, 2**31 - 1, 16, 6), chunk(b"IDAT", ZEROS)), "is too large"),
    "bomb": (lambda: with_pixels(header(8000, 8000, 8, 2), chunk(b"IDAT", ZEROS)), "cannot hold"),
    "no zlib": (lambda: with_pixels(header(4, 4, 8, 2), chunk(b"IDAT", b"hello")), "is damaged: Error"),
    "too few": (lambda: with_pixels(header(40, 40, 8, 2), chunk(b"IDAT", ZEROS)), "1000 of 4840 bytes"),
    "filter 9": (
        lambda: with_pixels(header(4, 4, 8, 0), chunk(b"IDAT", zlib.compress(bytes([9] * 20)))),
        "there is no filter 9",
    ),
    "no palette": (lambda: with_pixels(header(4, 4, 8, 3), chunk(b"IDAT", ZEROS)), "palette"),
    "beyond the palette": (
        lambda: with_pixels(
            header(4, 1, 8, 3), chunk(b"PLTE", bytes(6)), chunk(b"IDAT", zlib.compress(bytes([0, 0, 1, 2, 1])))
        ),
        "colour 2 of a palette of 2",
    ),
    "no key": (
        lambda: with_pixels(header(4, 4, 8, 2), chunk(b"tRNS", b"x"), chunk(b"IDAT", ZEROS)),
        "transparent colour",
    ),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    make, message = DAMAGED[name]
    path = tmp_path / "broken.png"
    path.write_bytes(make())
    with pytest.raises(ImageError) as caught:
        read_png(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)


def test_missing_files_and_folders_are_named(tmp_path: Path) -> None:
    for path in (tmp_path / "none.png", tmp_path):
        with pytest.raises(ImageError, match="cannot be read"):
            read_png(path)
    with pytest.raises(ImageError, match="cannot be read"):
        read_png("a\0b.png")


def test_a_longer_stream_than_needed_is_cut(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(with_pixels(header(2, 2, 8, 0), chunk(b"IDAT", zlib.compress(bytes(10**6)))))
    assert read_png(tmp_path / "a.png")[0].tolist() == [[[0.0] * 3] * 2] * 2


def test_mutants_give_a_picture_or_an_error(tmp_path: Path) -> None:
    """Random injuries, with checksums repaired in half of them so that they reach the decoder."""
    rng = np.random.default_rng(3)
    seeds = [encoded(random_samples(d, c, (9, 7)), d, c, bool(i % 2)) for i, (c, d) in enumerate(KINDS)]
    outcomes = {"picture": 0, "error": 0}
    for i in range(600):
        data = bytearray(seeds[i % len(seeds)])
        for _ in range(1 + i % 3):
            at = int(rng.integers(8, len(data)))
            data[at : at + int(rng.integers(0, 4))] = rng.bytes(int(rng.integers(0, 5)))
        path = tmp_path / "mutant.png"
        path.write_bytes(repaired(bytes(data)) if i % 2 else bytes(data))
        try:
            rgb, _ = read_png(path)
        except ImageError:
            outcomes["error"] += 1
        else:
            assert np.isfinite(rgb).all()
            assert rgb.min() >= 0
            assert rgb.max() <= 1
            outcomes["picture"] += 1
    assert outcomes["error"] > 300
    assert outcomes["picture"] > 10


def repaired(data: bytes) -> bytes:
    """The same chunks with right checksums, as far as they can be made out."""
    stream, result = io.BytesIO(data[8:]), data[:8]
    while len(front := stream.read(8)) == 8:
        length, name = struct.unpack(">I4s", front)
        result += chunk(name, stream.read(min(length, len(data))))
        stream.read(4)
    return result
