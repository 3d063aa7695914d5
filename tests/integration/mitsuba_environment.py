"""Renders a ball on a floor under an environment map by Mitsuba 3, in its own environment: see
test_environment_mitsuba.py, which calls this.

    python mitsuba_environment.py MAP.npy OUT.npy

MAP is (H, W) float32, grey, its first and last row at the poles; OUT is a stack of luminance images (N, H, W).
"""

from __future__ import annotations

import sys

import mitsuba as mi
import numpy as np

SIZE, SPP, IMAGES = 32, 512, 16

mi.set_variant("llvm_ad_mono")
Transform = mi.ScalarTransform4f


def grey(value: float) -> dict[str, object]:
    return {"type": "diffuse", "reflectance": {"type": "uniform", "value": value}}


def main() -> None:
    pixels = np.repeat(np.load(sys.argv[1])[:, :, None], 3, axis=2)
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
                "fov": 50,
                "fov_axis": "y",
                "to_world": Transform().look_at([0.5, 1.0, 3.2], [0, 0.6, 0], [0, 1, 0]),
                "film": film,
                "sampler": {"type": "independent", "sample_count": SPP},
            },
            "sky": {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(pixels))},
            "ball": {"type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "bsdf": grey(0.7)},
            "floor": {
                "type": "rectangle",
                "to_world": Transform().rotate([1, 0, 0], -90) @ Transform().scale([2, 2, 1]),
                "bsdf": grey(0.5),
            },
        }
    )
    np.save(sys.argv[2], np.stack([np.array(mi.render(scene, seed=seed))[:, :, 0] for seed in range(IMAGES)]))


if __name__ == "__main__":
    main()
