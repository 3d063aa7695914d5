#!/usr/bin/env python3
"""Writes scenes/models/chess.glb: a corner of a garden chess with pawns, to show what a glTF file may hold.

Two meshes for the pawns share their vertices and differ in their material: glass, and red lacquer under a clear coat.
The board has a texture, a camera stands before it, and the pawns of a kind are instances of one.

    python tools/make_chess_model.py

All is computed here, so it belongs to this project; running it again writes the same bytes.
"""

from __future__ import annotations

import json
import math
import struct
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

SEGMENTS = 40
SQUARES = 4
WIDTH = 0.4  # of a square, metres
# Radius and height of a pawn's outline, from the foot to the top, decimetres.
OUTLINE = (
    (0.0, 0.0), (1.45, 0.0), (1.5, 0.12), (1.5, 0.45), (1.38, 0.62), (1.2, 0.72), (1.22, 0.9), (1.1, 1.05),
    (0.82, 1.35), (0.64, 1.75), (0.54, 2.2), (0.5, 2.55), (0.82, 2.66), (0.88, 2.76), (0.82, 2.86), (0.55, 2.95),
    (0.72, 3.1), (0.84, 3.3), (0.88, 3.52), (0.84, 3.75), (0.72, 3.95), (0.52, 4.12), (0.27, 4.22), (0.0, 4.25),
)  # fmt: skip
LENS = {"yfov": 0.55, "aspectRatio": 1.5, "znear": 0.01}
PAWNS = {"glass": ((-1, -1), (0, 0), (1, -1)), "lacquer": ((-2, 1), (0, 1), (1, 1), (-1, 0))}


class Buffer:
    """The binary part of the file, with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, content: bytes) -> int:
        """Appends bytes and returns the number of their view."""
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)})
        self.data += content
        return len(self.views) - 1

    def accessor(self, array: NDArray[Any]) -> int:
        """Appends an array of float32 (N, width) or uint16 (N,) and returns the number of its accessor."""
        kind = "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}"
        item: dict[str, Any] = {
            "bufferView": self.view(np.ascontiguousarray(array).tobytes()),
            "componentType": 5123 if array.ndim == 1 else 5126,
            "count": len(array),
            "type": kind,
        }
        if array.ndim == 2 and array.shape[1] == 3:
            item |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        self.accessors.append(item)
        return len(self.accessors) - 1


def pawn() -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint16]]:
    """Positions in metres, normals and triangles of a pawn: its outline turned about the y axis."""
    outline = np.array(OUTLINE) * 0.1
    along = np.gradient(outline, axis=0)
    across = np.stack([along[:, 1], -along[:, 0]], axis=1)
    across[0], across[-1] = (0, -1), (0, 1)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angles = 2 * math.pi * np.arange(SEGMENTS) / SEGMENTS

    def turned(profile: NDArray[np.float64]) -> NDArray[np.float32]:
        x, y = profile[:, 0, None], profile[:, 1, None]
        rings = np.stack([x * np.cos(angles), y + 0 * angles, -x * np.sin(angles)], axis=2)
        return rings.reshape(-1, 3).astype("<f4")

    ring, segment = np.mgrid[0 : len(outline) - 1, 0:SEGMENTS]
    a, b = ring * SEGMENTS + segment, ring * SEGMENTS + (segment + 1) % SEGMENTS
    below = np.stack([a, b, b + SEGMENTS], axis=-1)[1:].reshape(-1)  # at the foot and the top a ring is a point
    above = np.stack([a, b + SEGMENTS, a + SEGMENTS], axis=-1)[:-1].reshape(-1)
    return turned(outline), turned(across), np.concatenate([below, above]).astype("<u2")


def board_picture() -> bytes:
    """A PNG of two by two texels: cream and walnut."""
    cream, walnut = (226, 203, 163), (98, 58, 37)
    rows = b"".join(b"\0" + bytes((*first, *second)) for first, second in ((cream, walnut), (walnut, cream)))

    def chunk(name: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    header = struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def document() -> tuple[dict[str, Any], bytes]:
    """The JSON of the file, and its buffer."""
    buffer = Buffer()
    positions, normals, triangles = pawn()
    attributes = {"POSITION": buffer.accessor(positions), "NORMAL": buffer.accessor(normals)}
    indices = buffer.accessor(triangles)
    side = WIDTH * SQUARES / 2
    corners = np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]) * side
    plane = {
        "POSITION": buffer.accessor(corners.astype("<f4")),
        "TEXCOORD_0": buffer.accessor(np.array([[0, 1], [1, 1], [1, 0], [0, 0]], "<f4")),
    }
    plane_indices = buffer.accessor(np.array([0, 1, 2, 0, 2, 3], "<u2"))
    repeated = {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [SQUARES / 2, SQUARES / 2]}}}
    nodes: list[dict[str, Any]] = [{"name": "board", "mesh": 0}]
    for mesh, places in enumerate(PAWNS.values(), start=1):
        nodes += [
            {"name": "pawn", "mesh": mesh, "translation": [WIDTH * (x + 0.5), 0, WIDTH * (z - 0.5)]} for x, z in places
        ]
    tilt = math.radians(-24) / 2
    seat = {"translation": [0.12, 1.18, 2.3], "rotation": [math.sin(tilt), 0, 0, math.cos(tilt)]}
    data = {
        "asset": {"version": "2.0", "generator": "tools/make_chess_model.py"},
        "extensionsUsed": [
            "KHR_materials_clearcoat", "KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume",
            "KHR_texture_transform",
        ],
        "scene": 0,
        "scenes": [{"nodes": [*range(len(nodes)), len(nodes)]}],
        "nodes": [*nodes, {"name": "seat", "camera": 0, **seat}],
        "cameras": [{"name": "seat", "type": "perspective", "perspective": LENS}],
        "meshes": [
            {"name": "board", "primitives": [{"attributes": plane, "indices": plane_indices, "material": 0}]},
            *({"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": number}]}
              for number, name in enumerate(PAWNS, start=1)),
        ],
        "materials": materials(repeated),
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9728, "wrapS": 10497, "wrapT": 10497}],
        "images": [{"name": "squares", "bufferView": buffer.view(board_picture()), "mimeType": "image/png"}],
    }  # fmt: skip
    rest = {"bufferViews": buffer.views, "accessors": buffer.accessors, "buffers": [{"byteLength": len(buffer.data)}]}
    return {**data, **rest}, bytes(buffer.data)


def materials(board: dict[str, Any]) -> list[dict[str, Any]]:
    """Waxed wood with the board's texture, glass, and lacquer."""
    return [
        {
            "name": "wood",
            "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorTexture": board, "metallicFactor": 0, "roughnessFactor": 0.45},
        },
        {
            "name": "glass",
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
            "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_ior": {"ior": 1.5},
                "KHR_materials_volume": {
                    "thicknessFactor": 0.2,
                    "attenuationDistance": 0.3,
                    "attenuationColor": [0.55, 0.85, 0.75],
                },
            },
        },
        {
            "name": "lacquer",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.45, 0.02, 0.015, 1],
                "metallicFactor": 0,
                "roughnessFactor": 0.6,
            },
            "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.08}},
        },
    ]


def main() -> int:
    """Writes the file."""
    data, binary = document()
    text = json.dumps(data, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    content = b"glTF" + struct.pack("<III", 2, size, len(text)) + b"JSON" + text
    content += struct.pack("<I", len(binary)) + b"BIN\0" + binary
    path = Path(__file__).resolve().parents[1] / "scenes" / "models" / "chess.glb"
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(content)
    return 0


if __name__ == "__main__":
    sys.exit(main())
