"""Renders a square under four lamps by Mitsuba 3, in its own environment: see test_lamps_mitsuba.py, which calls this.

python mitsuba_lamps.py OUT.npz

OUT holds a stack of XYZ images for each lamp: a point, two spots, and parallel light.
"""

from __future__ import annotations

import sys
from typing import Any

import mitsuba as mi
import numpy as np

SIZE, SPP, IMAGES = 24, 512, 8
WHITE = {"type": "spectrum", "value": 10.0}
SURFACE = {"type": "diffuse", "reflectance": {"type": "spectrum", "value": 1.0}}

mi.set_variant("scalar_spectral")
Transform = mi.ScalarTransform4f


def spot(cutoff: float, beam: float) -> dict[str, Any]:
    to_world = Transform().look_at([0.4, 0.3, 1.5], [0.1, -0.2, 0], [0, 1, 0])
    return {"type": "spot", "intensity": WHITE, "cutoff_angle": cutoff, "beam_width": beam, "to_world": to_world}


LAMPS: dict[str, dict[str, Any]] = {
    "point": {"type": "point", "position": [0.4, 0.3, 1.5], "intensity": WHITE},
    "narrow": spot(20.0, 5.0),
    "wide": spot(60.0, 30.0),
    "directional": {"type": "directional", "direction": [0.2, 0.5, -1.0], "irradiance": WHITE},
}


def images(light: dict[str, Any]) -> Any:
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 2},
            "sensor": {
                "type": "perspective",
                "fov": 30,
                "fov_axis": "y",
                "to_world": Transform().look_at([0.5, -1.0, 3.5], [0, 0, 0], [0, 1, 0]),
                "film": {
                    "type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "xyz",
                    "component_format": "float32", "rfilter": {"type": "box"},
                },
                "sampler": {"type": "independent", "sample_count": SPP},
            },
            "light": light,
            "square": {"type": "rectangle", "bsdf": SURFACE},
        }
    )  # fmt: skip
    return np.stack([np.array(mi.render(scene, seed=seed)) for seed in range(IMAGES)])


if __name__ == "__main__":
    np.savez(sys.argv[1], **{name: images(light) for name, light in LAMPS.items()})
