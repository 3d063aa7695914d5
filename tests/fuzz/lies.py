"""Small files that claim to be huge: each must be refused before memory is taken for what it claims.

    python -m tests.fuzz.lies FOLDER

reads them all in this process, which may take no more than ROOM bytes for each, and writes the messages as JSON.
"""

from __future__ import annotations

import json
import re
import struct
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.fuzz import seeds
from tests.fuzz.child import attempt, limit_memory, report_ends
from tests.fuzz.readers import READERS

ROOM = 48 << 20

HUGE = 2**32 - 1


def ply_files() -> Iterator[bytes]:
    """Rows and corners without end, in text and in both orders of bytes."""
    vertex = "property float x\nproperty float y\nproperty float z\n"
    face = "property list uint int vertex_indices\n"
    for kind, order in (("ascii", ""), ("binary_little_endian", "<"), ("binary_big_endian", ">")):
        for vertices, faces in ((2**32 - 2, 1), (3, 2**32), (2**64 - 1, 0), (2**32, 0), (0, 2**63)):
            head = (
                f"ply\nformat {kind} 1.0\nelement vertex {vertices}\n{vertex}element face {faces}\n{face}end_header\n"
            )
            yield head.encode() + bytes(60)
        if order:
            head = f"ply\nformat {kind} 1.0\nelement vertex 3\n{vertex}element face 1\n{face}end_header\n"
            yield head.encode() + bytes(36) + struct.pack(order + "I", HUGE) + bytes(16)
            other = f"element other 1\nproperty list uint double d\nelement vertex 3\n{vertex}element face 1\n{face}"
            lie = struct.pack(order + "I", HUGE) + bytes(80)
            yield f"ply\nformat {kind} 1.0\n{other}end_header\n".encode() + lie


def stl_files() -> Iterator[bytes]:
    """Triangles that are not there."""
    for count in (HUGE, 2**31, 3, 1 << 26):
        yield bytes(80) + struct.pack("<I", count) + bytes(100)


def gltf_documents() -> Iterator[dict[str, Any]]:
    """Accessors, views and buffers beyond all data."""
    for accessor in (
        {"bufferView": 0, "count": HUGE - 1},
        {"count": HUGE - 1},
        {"count": 1 << 25},
        {"count": 3, "sparse": {"count": HUGE - 1, "indices": {"bufferView": 0, "componentType": 5125}}},
        {"bufferView": 0, "count": 1 << 28, "byteOffset": 1 << 33},
    ):
        yield {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": 2**32, "uri": "data:;base64,AAAA"}],
            "bufferViews": [{"buffer": 0, "byteLength": 2**32}],
            "accessors": [{"type": "VEC3", "componentType": 5126, **accessor}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "nodes": [{"mesh": 0}],
        }


def glb_files() -> Iterator[bytes]:
    """The same in the container, and chunks beyond the file."""
    whole = seeds.glb()[0]
    for size in (HUGE, 2**31, len(whole)):
        yield whole[:12] + struct.pack("<I", size) + whole[16:]
    yield whole[:8] + struct.pack("<I", HUGE) + whole[12:]
    for document in gltf_documents():
        text = json.dumps(document).encode()
        yield b"glTF" + struct.pack("<IIII", 2, 20 + len(text), len(text), 0x4E4F534A) + text


def png_files() -> Iterator[bytes]:
    """Headers of any size before a hundred bytes of pixels."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    for width, height, depth, color in (
        (2**31 - 1, 2**31 - 1, 16, 6),
        (1, 2**31 - 1, 8, 0),
        (2**31 - 1, 1, 8, 0),
        (65535, 65535, 8, 0),
        (32768, 32768, 8, 0),
        (16384, 16384, 16, 6),
        (8192, 8192, 8, 2),
    ):
        head = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
        pixels = chunk(b"IDAT", zlib.compress(bytes(100)))
        yield b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + pixels + chunk(b"IEND", b"")


def exr_files() -> Iterator[bytes]:
    """Another data window in a picture of 31 x 24, with and without as large a display window."""
    for content in seeds.pictures("exr"):
        small = struct.pack("<4i", 0, 0, 30, 23)
        for x, y in ((2**31 - 2, 2**31 - 2), (2**30, 1), (1, 2**30), (65535, 65535), (16383, 16383), (30, 2**22)):
            large = struct.pack("<4i", 0, 0, x, y)
            yield content.replace(small, large)
            yield content.replace(small, large, 1)


def film_files() -> Iterator[bytes]:
    """The same in an image of ours."""
    (content,) = seeds.films()
    for x, y in ((2**31 - 2, 2**31 - 2), (65535, 65535), (16383, 16383)):
        lie = content.replace(struct.pack("<4i", 0, 0, 5, 4), struct.pack("<4i", 0, 0, x, y))
        yield lie
        start = lie.index(b"accuray:ledger\0string\0") + len(b"accuray:ledger\0string\0")
        end = start + 4 + struct.unpack_from("<i", lie, start)[0]
        ledger = lie[start + 4 : end].replace(b'"window":[0,0,6,5]', b'"window":[0,0,%d,%d]' % (x + 1, y + 1))
        yield lie[:start] + struct.pack("<i", len(ledger)) + ledger + lie[end:]


def hdr_files() -> Iterator[bytes]:
    """Resolutions without pixels."""
    for y, x in ((400000, 400000), (2**31 - 1, 2**31 - 1), (32768, 16384), (8192, 8192)):
        yield f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {y} +X {x}\n".encode()


def tif_files() -> Iterator[bytes]:
    """The tags of width and height (256, 257) with other values."""
    content = seeds.pictures("tif")[0]
    for width, height in ((HUGE, HUGE), (2**20, 1024), (16384, 16384), (31, 2**27)):
        lie = content
        for tag, value in ((256, width), (257, height)):
            start = re.search(re.escape(struct.pack("<H", tag)) + rb"[\x03\x04]\x00\x01\x00\x00\x00", lie)
            if start is None:
                raise ValueError(f"the good file has no tag {tag}")
            lie = lie[: start.start()] + struct.pack("<HHII", tag, 4, 1, value) + lie[start.start() + 12 :]
        yield lie


def tga_files() -> Iterator[bytes]:
    """The largest that 16 bits can say."""
    content = seeds.pictures("tga")[0]
    yield content[:12] + struct.pack("<HH", 65535, 65535) + content[16:]
    yield content[:12] + struct.pack("<HH", 16384, 16384) + content[16:]


def bmp_files() -> Iterator[bytes]:
    """The same with 32 bits."""
    content = seeds.pictures("bmp")[0]
    for width, height in ((2**31 - 1, 2**31 - 1), (2**20, 2**10), (16384, 16384)):
        yield content[:18] + struct.pack("<ii", width, height) + content[26:]


def jpg_files() -> Iterator[bytes]:
    """Sizes of the frame header (SOF0)."""
    content = seeds.pictures("jpg")[0]
    at = content.index(b"\xff\xc0")
    for height, width in ((65535, 65535), (32768, 32768), (16384, 16384)):
        yield content[: at + 5] + struct.pack(">HH", height, width) + content[at + 9 :]


def ies_files() -> Iterator[bytes]:
    """Counts of angles."""
    for counts in ("1000000 1000000", "4294967296 1", "1000000 1", "1048576 1"):
        yield f"TILT=NONE\n1 1000 1 {counts} 1 2 0 0 0\n1 1 10\n0 90\n".encode()


def npy_files() -> Iterator[bytes]:
    """Shapes of more numbers than there are."""
    for shape in ("(4294967296, 3, 4)", "(2**62, 3, 4)", "(4611686018427387904, 12)", "(100000000, 12)", "(0, 12)"):
        header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n"
        yield b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + bytes(100)


LIES: dict[str, list[bytes]] = {
    "ply": list(ply_files()),
    "stl": list(stl_files()),
    "gltf": [json.dumps(document).encode() for document in gltf_documents()],
    "glb": list(glb_files()),
    "png": list(png_files()),
    "decoder": list(png_files()),
    "exr": list(exr_files()),
    "rgb": list(exr_files()),
    "film": list(film_files()),
    "hdr": list(hdr_files()),
    "tif": list(tif_files()),
    "tga": list(tga_files()),
    "bmp": list(bmp_files()),
    "jpg": list(jpg_files()),
    "ies": list(ies_files()),
    "npy": list(npy_files()),
}


def answer(name: str, folder: Path, content: bytes) -> str | None:
    """The message for a file; None if it is read, and the error's name if memory ends."""
    try:
        return attempt(READERS[name], folder, content)
    except MemoryError as error:
        return type(error).__name__


def main() -> None:
    """The command."""
    report_ends()
    folder = Path(sys.argv[1])
    answers: dict[str, list[str | None]] = {}
    for name, files in LIES.items():
        (folder / "reader").write_text(name)
        for content in READERS[name].seeds():
            attempt(READERS[name], folder, content)
        limit_memory(ROOM)
        answers[name] = [answer(name, folder, content) for content in files]
        limit_memory(1 << 40)
    print(json.dumps(answers))


if __name__ == "__main__":
    main()
