"""Renders a textured square by Mitsuba 3, in its own environment: see test_textures_mitsuba.py, which calls this.

    python mitsuba_textures.py COLOURS.npy NORMALS.npy OUT.npz

COLOURS is (H, W, 3) uint8 in sRGB, NORMALS (H, W, 3) float32; both repeat twice along u and three times along v. OUT
holds four stacks of XYZ images: a white and a textured square under D65, a white and a normal-mapped one under a point
light.
"""

from __future__ import annotations

import sys
from typing import Any

import mitsuba as mi
import numpy as np
from mitsuba_images import View

VIEW = View((0.5, -1.0, 3.5), spp=1024, depth=2)

mi.set_variant("scalar_spectral")
Transform = mi.ScalarTransform4f


def bitmap(pixels: Any, raw: bool) -> dict[str, Any]:
    """A texture whose first row is at v = 1, as in AccuRay."""
    flipped = mi.Bitmap(np.ascontiguousarray(pixels[::-1]))
    return {
        "type": "bitmap",
        "bitmap": flipped,
        "raw": raw,
        "wrap_mode": "repeat",
        "to_uv": Transform().scale([2, 3, 1]),
    }


def images(bsdf: dict[str, Any], light: dict[str, Any]) -> Any:
    return VIEW.of({"light": light, "square": {"type": "rectangle", "bsdf": bsdf}})


def main() -> None:
    colours, normals = np.load(sys.argv[1]), np.load(sys.argv[2])
    sky = {"type": "constant", "radiance": {"type": "d65"}}
    lamp = {"type": "point", "position": [1.5, 1.0, 1.0], "intensity": {"type": "uniform", "value": 10.0}}
    white = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 1.0}}
    coloured = {"type": "diffuse", "reflectance": bitmap(colours, raw=False)}
    # Without what Mitsuba does beyond the model that is compared: softened terminators, flipped normals.
    plain = {"use_shadowing_function": False, "flip_invalid_normals": False}
    mapped = {"type": "normalmap", "normalmap": bitmap(normals, raw=True), "bsdf": white, **plain}
    np.savez(
        sys.argv[3],
        white_sky=images(white, sky),
        coloured=images(coloured, sky),
        white_lamp=images(white, lamp),
        mapped=images(mapped, lamp),
    )


if __name__ == "__main__":
    main()
