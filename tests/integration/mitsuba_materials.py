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
from mitsuba_images import View

VIEW = View((0.5, -1.6, 3.2), spp=256, images=16, pixels="luminance")

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
    square = {"type": "rectangle", "bsdf": bsdf}
    return VIEW.of({"above": lamp(1.5), "below": lamp(-1.5), "square": square})[..., 0]


def main() -> None:
    cases = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    np.savez(sys.argv[2], **{name: images(bsdf) for name, bsdf in cases.items()})


if __name__ == "__main__":
    main()
