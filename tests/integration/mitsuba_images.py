"""What the scripts for Mitsuba's own environment share: a camera, a box filter, a stack of images of many seeds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mitsuba as mi
import numpy as np

Point = tuple[float, float, float]


@dataclass(frozen=True)
class View:
    """Square images by a pinhole camera; ``fov`` in degrees, ``depth`` in edges of a path, -1 for any."""

    origin: Point
    target: Point = (0, 0, 0)
    fov: float = 30
    size: int = 24
    spp: int = 512
    images: int = 8
    depth: int = -1
    pixels: str = "xyz"

    def of(self, parts: dict[str, Any]) -> Any:
        """A stack (images, size, size, channels) of the scene made of these lights and shapes."""
        film = {
            "type": "hdrfilm",
            "width": self.size,
            "height": self.size,
            "pixel_format": self.pixels,
            "component_format": "float32",
            "rfilter": {"type": "box"},
        }
        to_world = mi.ScalarTransform4f().look_at(list(self.origin), list(self.target), [0, 1, 0])
        sensor = {
            "type": "perspective",
            "fov": self.fov,
            "fov_axis": "y",
            "to_world": to_world,
            "film": film,
            "sampler": {"type": "independent", "sample_count": self.spp},
        }
        integrator = {"type": "path", "max_depth": self.depth}
        scene = mi.load_dict({"type": "scene", "integrator": integrator, "sensor": sensor, **parts})
        return np.stack([np.array(mi.render(scene, seed=seed)) for seed in range(self.images)])
