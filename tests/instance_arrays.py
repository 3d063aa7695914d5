"""Transforms by the many for tests of instances."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.float32]


def similarities(count: int, seed: int, room: float = 3.0, mirror: bool = True) -> Rows:
    """Random rotations (Shoemake 1992), every other one mirrored, scaled and moved: (count, 3, 4)."""
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    turn = np.moveaxis(np.array(rows), 2, 0).copy()
    if mirror:
        turn[::2, :, 0] *= -1
    turn *= rng.uniform(0.2, 0.6, (count, 1, 1))
    place = rng.uniform(-room, room, (count, 3, 1))
    return np.concatenate([turn, place], axis=2).astype(np.float32)


def matrix(row: NDArray[Any]) -> dict[str, Any]:
    """One of them as the `transform` of a scene."""
    return {"matrix": [*np.asarray(row, dtype=np.float64).ravel().tolist(), 0.0, 0.0, 0.0, 1.0]}


def scene_with(shapes: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A description with two materials, light from everywhere and a camera before the shapes."""
    prototypes = {
        "ball": {"type": "sphere", "radius": 0.8, "material": "grey", "prototype": True},
        "box": {"type": "cube", "material": "red", "prototype": True},
        "lid": {"type": "disk", "radius": 1.2, "material": "grey", "prototype": True},
    }
    return {
        "film": {"width": 24, "height": 16},
        "camera": {"type": "perspective", "position": [0, 0, 10], "look_at": [0, 0, 0], "fov": 45},
        "materials": {
            "grey": {"type": "diffuse", "reflectance": 0.5},
            "red": {"type": "diffuse", "reflectance": [0.6, 0.1, 0.1]},
        },
        "lights": {"sky": {"type": "constant", "radiance": 1}},
        "shapes": {**prototypes, **shapes},
        **more,
    }
