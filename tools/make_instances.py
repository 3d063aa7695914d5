#!/usr/bin/env python3
"""Makes the transforms in scenes/instances: tea services on a round hill, in the order of a sunflower's seeds.

    python tools/make_instances.py

Each row of services.npy, N x 3 x 4, places one; services-kinds.npy says of which kind it is.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).resolve().parents[1] / "scenes" / "instances"
COUNT = 2400
SPACING = 0.62  # metres: the n-th service lies SPACING sqrt(n) from the middle (Vogel 1979)
HILL = 60.0  # radius of the sphere that the hill is a part of, metres
GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
KINDS = 3

FloatArray = NDArray[np.float64]


def places() -> tuple[FloatArray, FloatArray]:
    """Positions (N, 3) on the hill, whose top is the origin, and upward normals (N, 3)."""
    n = np.arange(COUNT) + 0.5
    radius, angle = SPACING * np.sqrt(n), GOLDEN_ANGLE * n
    x, z = radius * np.cos(angle), radius * np.sin(angle)
    y = np.sqrt(HILL**2 - radius**2)
    normals = np.stack([x, y, z], axis=1) / HILL
    return normals * HILL - [0.0, HILL, 0.0], normals


def transforms() -> NDArray[np.float32]:
    """(N, 3, 4): standing upright on the hill, turned and sized at random."""
    rng = np.random.default_rng(3)
    positions, up = places()
    turn = rng.uniform(0.0, 2.0 * np.pi, COUNT)
    size = rng.uniform(0.7, 1.0, COUNT)
    sideways = np.stack([np.cos(turn), np.zeros(COUNT), np.sin(turn)], axis=1)
    forward = np.cross(sideways, up)
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    axes = np.stack([np.cross(up, forward), up, forward], axis=2) * size[:, None, None]
    return np.concatenate([axes, positions[:, :, None]], axis=2).astype(np.float32)


def kinds() -> NDArray[np.uint8]:
    """(N,): every service is of one of the kinds, those of the spiral's arms alike."""
    return (np.arange(COUNT) % 21 // 7).astype(np.uint8)


def main() -> None:
    """Writes both files."""
    FOLDER.mkdir(exist_ok=True)
    np.save(FOLDER / "services.npy", transforms())
    np.save(FOLDER / "services-kinds.npy", kinds())


if __name__ == "__main__":
    main()
