"""Renders copies of a knot, and a floor under a picture that shines, by Mitsuba 3 in its own environment: see
test_scenes_mitsuba.py, which calls this.

    python mitsuba_scenes.py FOLDER OUT.npz

FOLDER has knot.ply, transforms.npy (N, 3, 4) and picture.npy (H, W) float32. OUT holds stacks of luminance images.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np
from mitsuba_images import View

COPIES = View((0.0, 2.5, 5.0), (0, 0.3, 0), fov=45, size=32, spp=1024, images=16, pixels="luminance")
PICTURE = View((0.0, 1.5, 4.0), (0, 0.4, 0), fov=45, size=32, spp=1024, images=16, pixels="luminance")

mi.set_variant("llvm_ad_mono")
Transform = mi.ScalarTransform4f


def grey(value: float) -> dict[str, Any]:
    """Matte on both sides."""
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {"type": "uniform", "value": value}}}


def floor() -> dict[str, Any]:
    """A square 6 m wide that faces up."""
    return {
        "type": "rectangle",
        "to_world": Transform().rotate([1, 0, 0], -90) @ Transform().scale([3, 3, 1]),
        "bsdf": grey(0.5),
    }


def lamp(radiance: dict[str, Any]) -> dict[str, Any]:
    """A square 1.6 m wide, 2 m above the origin, that shines down; u goes to the right, v towards the camera."""
    return {
        "type": "rectangle",
        "to_world": Transform().translate([0, 2, 0])
        @ Transform().rotate([1, 0, 0], 90)
        @ Transform().scale([0.8, 0.8, 1]),
        "bsdf": grey(0.2),
        "emitter": {"type": "area", "radiance": radiance},
    }


def copies(folder: Path) -> Any:
    last = np.array([[0.0, 0.0, 0.0, 1.0]])
    knot = {"type": "ply", "filename": str(folder / "knot.ply"), "bsdf": grey(0.7)}
    parts: dict[str, Any] = {"group": {"type": "shapegroup", "knot": knot}}
    for number, rows in enumerate(np.load(folder / "transforms.npy")):
        place = mi.ScalarTransform4f(np.vstack([rows, last]))
        parts[f"copy-{number}"] = {"type": "instance", "group": {"type": "ref", "id": "group"}, "to_world": place}
    sky = {"type": "constant", "radiance": {"type": "uniform", "value": 0.3}}
    return COPIES.of({**parts, "floor": floor(), "lamp": lamp({"type": "uniform", "value": 4.0}), "sky": sky})


def picture(folder: Path) -> Any:
    """The first row of the picture is at v = 1."""
    texels = np.load(folder / "picture.npy")[::-1, :, None]
    bitmap = {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(texels)),
        "raw": True,
        "filter_type": "nearest",
    }
    ball = {"type": "sphere", "center": [0.4, 0.4, 0.3], "radius": 0.4, "bsdf": grey(0.7)}
    return PICTURE.of({"floor": floor(), "lamp": lamp(bitmap), "ball": ball})


if __name__ == "__main__":
    np.savez(sys.argv[2], copies=copies(Path(sys.argv[1]))[..., 0], picture=picture(Path(sys.argv[1]))[..., 0])
