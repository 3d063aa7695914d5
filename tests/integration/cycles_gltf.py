"""Renders GLB files by Cycles as Blender imports them: see test_gltf_cycles.py, which calls this.

    python cycles_gltf.py FOLDER WIDTH HEIGHT SPP DRIVERS NAME...

Reads FOLDER/NAME.glb and leaves FOLDER/NAME.npy, linear Rec.709 (H, W, 3). DRIVERS is the folder of blender.py.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

BOUNCES = 1024


def render(path: Path, width: int, height: int, spp: int, blender: Any) -> Any:
    """The picture by the file's camera. Lights are points, as in glTF, and keep the file's numbers: 1 cd is as
    bright as it is beside surfaces of 1 cd/m^2. The other modes divide lights, but not surfaces, by 683.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path), export_import_convert_lighting_mode="COMPAT")
    scene = bpy.context.scene
    blender.configure(scene, width, height, len(os.sched_getaffinity(0)), BOUNCES)
    scene.cycles.samples, scene.cycles.seed = spp, 1
    scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    for lamp in bpy.data.lights:
        if lamp.type == "SUN":
            lamp.angle = 0.0
        else:
            lamp.shadow_soft_size = 0.0
    bpy.ops.render.render(write_still=False)
    return blender.read_result(bpy, path.parent)


def main() -> None:
    folder, width, height, spp, drivers, *names = sys.argv[1:]
    sys.path.insert(0, drivers)
    import blender

    for name in names:
        pixels = render(Path(folder) / f"{name}.glb", int(width), int(height), int(spp), blender)
        np.save(Path(folder) / f"{name}.npy", pixels)


if __name__ == "__main__":
    main()
