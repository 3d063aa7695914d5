"""Renders one square of each material by Mitsuba 3, in its own environment: see test_materials_mitsuba.py.

    python mitsuba_materials.py CASES.json OUT.npz

CASES is a table of Mitsuba's BSDFs by name, all of them grey. OUT holds for each a stack of luminance images (N, H, W).
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

SIZE, SPP, IMAGES = 24, 256, 16

mi.set_variant("llvm_ad_mono")
Transform = mi.ScalarTransform4f


def lamp(height: float) -> dict[str, Any]:
    """A black lamp of 1 x 1 that faces the square at z = 0, on either side of it."""
    facing = Transform().translate([0.2 if height > 0 else -0.6, 0.9, height])
    if height > 0:
        facing = facing @ Transform().rotate([1, 0, 0], 180)
    emitter = {"type": "area", "radiance": {"type": "uniform", "value": 1.0}}
    black = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
    place = facing @ Transform().scale([0.5, 0.5, 1])
    return {"type": "rectangle", "to_world": place, "emitter": emitter, "bsdf": black}


def images(bsdf: dict[str, Any]) -> Any:
    film = {
        "type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "luminance", "component_format": "float32",
        "rfilter": {"type": "box"},
    }  # fmt: skip
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": -1},
            "sensor": {
                "type": "perspective",
                "fov": 30,
                "fov_axis": "y",
                "to_world": Transform().look_at([0.5, -1.6, 3.2], [0, 0, 0], [0, 1, 0]),
                "film": film,
                "sampler": {"type": "independent", "sample_count": SPP},
            },
            "above": lamp(1.5),
            "below": lamp(-1.5),
            "square": {"type": "rectangle", "bsdf": bsdf},
        }
    )
    return np.stack([np.array(mi.render(scene, seed=seed))[:, :, 0] for seed in range(IMAGES)])


def main() -> None:
    cases = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    np.savez(sys.argv[2], **{name: images(bsdf) for name, bsdf in cases.items()})


if __name__ == "__main__":
    main()
