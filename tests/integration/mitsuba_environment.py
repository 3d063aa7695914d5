"""Renders a ball on a floor under an environment map by Mitsuba 3, in its own environment: see
test_environment_mitsuba.py, which calls this.

    python mitsuba_environment.py MAP.npy OUT.npy

MAP is (H, W) float32, grey, its first and last row at the poles; OUT is a stack of luminance images (N, H, W).
"""

from __future__ import annotations

import sys

import mitsuba as mi
import numpy as np
from mitsuba_images import View

VIEW = View((0.5, 1.0, 3.2), (0, 0.6, 0), fov=50, size=32, images=16, pixels="luminance")

mi.set_variant("llvm_ad_mono")
Transform = mi.ScalarTransform4f


def grey(value: float) -> dict[str, object]:
    return {"type": "diffuse", "reflectance": {"type": "uniform", "value": value}}


def main() -> None:
    pixels = np.repeat(np.load(sys.argv[1])[:, :, None], 3, axis=2)
    parts = {
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(pixels))},
        "ball": {"type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "bsdf": grey(0.7)},
        "floor": {
            "type": "rectangle",
            "to_world": Transform().rotate([1, 0, 0], -90) @ Transform().scale([2, 2, 1]),
            "bsdf": grey(0.5),
        },
    }
    np.save(sys.argv[2], VIEW.of(parts)[..., 0])


if __name__ == "__main__":
    main()
