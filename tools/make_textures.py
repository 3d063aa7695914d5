#!/usr/bin/env python3
"""Makes the pictures in scenes/textures: bricks in colour, their normal map, and a leaf with its outline as alpha.

    python tools/make_textures.py

All are computed here, so they belong to this project; running it again writes the same texels.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio  # noqa: N813
from numpy.typing import NDArray

FOLDER = Path(__file__).resolve().parents[1] / "scenes" / "textures"
SIZE = 256
ROWS, COLUMNS = 8, 4
JOINT = 3.0  # texels from a brick's edge to the middle of the joint
BEVEL = 5.0  # texels over which its edge falls

FloatArray = NDArray[np.float64]


def bricks() -> tuple[FloatArray, FloatArray]:
    """Height in texels (SIZE, SIZE), and the brick that each texel belongs to."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] + 0.5
    high, wide = SIZE / ROWS, SIZE / COLUMNS
    row = np.floor(y / high)
    shifted = (x + 0.5 * wide * (row % 2)) % SIZE
    to_edge = np.minimum(*(np.minimum(p % step, step - p % step) for p, step in ((y, high), (shifted, wide))))
    rise = np.clip((to_edge - JOINT) / BEVEL, 0.0, 1.0)
    return 3.0 * rise * rise * (3.0 - 2.0 * rise), row * COLUMNS + np.floor(shifted / wide)


def colours(height: FloatArray, brick: FloatArray) -> FloatArray:
    """Colours (SIZE, SIZE, 3) in sRGB: each brick has its own red, and some grain."""
    rng = np.random.default_rng(4)
    tones = rng.uniform(-1.0, 1.0, ROWS * COLUMNS)[brick.astype(int)][..., np.newaxis]
    grain = rng.normal(0.0, 0.02, (SIZE, SIZE, 1))
    clay = np.array([0.66, 0.36, 0.28]) + tones * np.array([0.12, 0.07, 0.05])
    mortar = np.array([0.72, 0.70, 0.66])
    share = np.clip(height / 1.5, 0.0, 1.0)[..., np.newaxis]
    mixed: FloatArray = np.clip(mortar + (clay - mortar) * share + grain, 0.0, 1.0)
    return mixed


def normals(height: FloatArray) -> FloatArray:
    """The normals of a height that repeats, as colours; green points up in the picture."""
    along_u = 0.5 * (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1))
    along_v = 0.5 * (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0))
    n = np.stack([-along_u, -along_v, np.ones_like(height)], axis=-1)
    coded: FloatArray = 0.5 + 0.5 * n / np.linalg.norm(n, axis=-1, keepdims=True)
    return coded


def leaf(size: int = 128) -> FloatArray:
    """A leaf (size, size, 4), sRGB and alpha, whose stem is at the bottom."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    along, across = 1.0 - y, np.abs(x - 0.5)
    width = 0.38 * np.sin(np.pi * np.clip((along - 0.12) / 0.85, 0.0, 1.0)) ** 0.7
    blade = np.clip((width - across) * size, 0.0, 1.0)
    stem = np.clip((0.02 - across) * size, 0.0, 1.0) * (along < 0.5)
    veins = np.clip(1.0 - size / 3.0 * np.minimum(across, np.abs((along - 0.9 * across) * 8.0 % 1.0 - 0.5) / 8.0), 0, 1)
    green = np.array([0.30, 0.47, 0.13]) + veins[..., np.newaxis] * np.array([0.22, 0.18, 0.12])
    return np.concatenate([green, np.maximum(blade, stem)[..., np.newaxis]], axis=-1)


def write(name: str, pixels: FloatArray) -> None:
    """Stores numbers from 0 to 1 with 8 bits."""
    stored: NDArray[Any] = np.floor(pixels * 255.0 + 0.5).astype(np.uint8)
    spec = oiio.ImageSpec(stored.shape[1], stored.shape[0], stored.shape[2], "uint8")
    spec.attribute("oiio:UnassociatedAlpha", 1)
    spec.attribute("png:compressionLevel", 9)
    output: Any = oiio.ImageOutput.create(name)
    if not (output.open(str(FOLDER / name), spec) and output.write_image(stored) and output.close()):
        raise SystemExit(output.geterror())


def main() -> None:
    """Writes all pictures."""
    FOLDER.mkdir(exist_ok=True)
    height, brick = bricks()
    write("bricks.png", colours(height, brick))
    write("bricks-normal.png", normals(height))
    write("leaf.png", leaf())


if __name__ == "__main__":
    main()
