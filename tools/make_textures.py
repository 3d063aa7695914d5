#!/usr/bin/env python3
"""Makes the pictures in scenes/textures: bricks in colour, their normal map, a leaf with its outline as alpha, a
window of coloured glass, and an evening all around as an environment map.

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


def window(width: int = 160, height: int = 240) -> FloatArray:
    """A pointed window (height, width, 3) in sRGB: a sun of glass over hills, cut by lead, in a black wall."""
    y, x = np.mgrid[0:height, 0:width] + 0.5
    u, v = (x - 0.5 * width) / (0.5 * width), (height - y) / height
    rng = np.random.default_rng(12)
    sites = np.stack([rng.uniform(0, width, 90), rng.uniform(0, height, 90)], axis=-1)
    away = np.hypot(x[..., np.newaxis] - sites[:, 0], y[..., np.newaxis] - sites[:, 1])
    cell, two = away.argmin(axis=-1), np.sort(away, axis=-1)
    lead = two[..., 1] - two[..., 0]
    sun = np.hypot(x - 0.5 * width, y - 0.38 * height) / width
    hills = v - (0.22 + 0.07 * np.sin(4.2 * u + 0.6))
    region = np.where(sun < 0.17, 0, np.where(sun < 0.31, 1, np.where(hills < 0.0, 3, 2)))
    lead = np.minimum(lead, np.where(region < 1, 9.0, lead))
    for distance in (
        width * np.abs(sun - 0.17),
        width * np.abs(sun - 0.31),
        height * np.abs(hills) + 99.0 * (sun < 0.31),
    ):
        lead = np.minimum(lead, 1.4 * distance)
    base = np.array([[0.98, 0.80, 0.30], [0.93, 0.42, 0.12], [0.13, 0.30, 0.78], [0.12, 0.52, 0.25]])[region]
    tone = rng.uniform(-1.0, 1.0, (90, 3))[cell] * np.array([0.12, 0.12, 0.10])
    arch = np.minimum(v < 0.62, 1) + ((v >= 0.62) & (np.abs(u) < 2.0 * np.cos(0.5 * np.pi * (v - 0.62) / 0.38) - 1.0))
    glass = np.clip(base + tone, 0.0, 1.0) * np.clip(0.8 * (lead - 1.0), 0.03, 1.0)[..., np.newaxis]
    inside: FloatArray = glass * ((arch > 0) & (np.abs(u) < 0.96) & (v > 0.02))[..., np.newaxis]
    return inside


def evening(width: int = 256, height: int = 128) -> FloatArray:
    """An environment (height, width, 3), linear: a low sun behind bands of cloud, hills around."""
    y, x = (np.mgrid[0:height, 0:width] + 0.5) / [[[height]], [[width]]]
    up, around = np.pi * (0.5 - y), 2.0 * np.pi * (x - 0.5)
    sun_up, sun_around = np.radians(9.0), np.radians(62.0)
    cosine = np.sin(up) * np.sin(sun_up) + np.cos(up) * np.cos(sun_up) * np.cos(around - sun_around)
    away = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    low = np.exp(-np.maximum(up, 0.0) / 0.22)[..., np.newaxis]
    sky = (1.0 - low) * np.array([0.10, 0.19, 0.42]) + low * np.array([0.75, 0.42, 0.24])
    sky += np.exp(-away / 14.0)[..., np.newaxis] * np.array([3.0, 1.5, 0.5])
    waves = sum(np.sin(k * around + 9.0 * k * up + k * k) / k for k in (2, 3, 5, 8)) + 4.0 * np.sin(19.0 * up)
    cloud = np.clip(0.25 * waves - 0.35, 0.0, 1.0) * np.clip(4.0 * up, 0.0, 1.0) * np.clip(2.4 - 2.2 * up, 0.0, 1.0)
    lit = np.array([0.35, 0.30, 0.36]) + np.exp(-away / 30.0)[..., np.newaxis] * np.array([2.2, 0.9, 0.45])
    sky += cloud[..., np.newaxis] * (lit - sky)
    sky += np.clip(4.5 - away, 0.0, 1.0)[..., np.newaxis] * np.array([150.0, 90.0, 38.0])
    hills = 0.02 + 0.03 * np.sin(3.0 * around) + 0.02 * np.sin(7.0 * around + 1.0)
    ground = np.array([0.075, 0.06, 0.045]) * (1.0 + np.clip(-up, 0.0, 1.0))[..., np.newaxis]
    share = np.clip((up - hills) * height / np.pi + 0.5, 0.0, 1.0)[..., np.newaxis]
    result: FloatArray = ground + share * (sky - ground)
    return result


def write_radiance(name: str, pixels: FloatArray) -> None:
    """Stores numbers in half precision."""
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "half")
    spec.attribute("compression", "piz")
    output: Any = oiio.ImageOutput.create(name)
    if not (output.open(str(FOLDER / name), spec) and output.write_image(pixels.astype(np.float32)) and output.close()):
        raise SystemExit(output.geterror())


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
    write("window.png", window())
    write_radiance("evening.exr", evening())


if __name__ == "__main__":
    main()
