"""Renders a square under four lamps by Mitsuba 3, in its own environment: see test_lamps_mitsuba.py, which calls this.

python mitsuba_lamps.py OUT.npz

OUT holds a stack of XYZ images for each lamp: a point, two spots, and parallel light.
"""

from __future__ import annotations

import sys
from typing import Any

import mitsuba as mi
import numpy as np
from mitsuba_images import View

VIEW = View((0.5, -1.0, 3.5), depth=2)
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
    return VIEW.of({"light": light, "square": {"type": "rectangle", "bsdf": SURFACE}})


if __name__ == "__main__":
    np.savez(sys.argv[1], **{name: images(light) for name, light in LAMPS.items()})
