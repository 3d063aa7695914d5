"""A scene from Python objects and arrays: no scene file, no mesh file.

A ringing drum skin of gold, computed as an array, in a circle of balls that are instances of one. Writes drum.exr and
drum.png into the current folder:

    .venv/bin/python examples/01_scene_in_python.py
"""

import math

import numpy as np

import accuray


def drum_skin(rings: int, sectors: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in metres of a rippled disk of radius 1, and its triangles (m, 3), front side up."""
    r, angle = np.meshgrid(np.linspace(0.02, 1.0, rings), np.linspace(0.0, 2.0 * math.pi, sectors), indexing="ij")
    y = 0.05 * np.cos(22.0 * r + angle) * (1.0 - r)
    vertices = np.stack([r * np.cos(angle), y, -r * np.sin(angle)], axis=2).reshape(-1, 3)
    number = np.arange(rings * sectors).reshape(rings, sectors)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    return vertices, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


positions, faces = drum_skin(rings=100, sectors=300)

# The structure is that of a scene file (docs/scene-format.md); arrays may be numpy arrays.
description = {
    "film": {"width": 480, "height": 300},
    "camera": {"type": "perspective", "position": [0.0, 2.2, 3.6], "look_at": [0.0, 0.05, 0.1], "fov": 33},
    "lights": {"sky": {"type": "constant", "radiance": [0.25, 0.35, 0.6]}},
    "materials": {
        "gold": {"type": "conductor", "metal": "Au"},
        "glass": {"type": "dielectric", "ior": "SF11"},
        "rubber": {"type": "diffuse", "reflectance": [0.05, 0.25, 0.3]},
        "table": {"type": "diffuse", "reflectance": 0.25},
        "lamp": {
            "type": "diffuse",
            "reflectance": 0,
            "emission": {"blackbody": "4500 K", "normalize": True, "scale": 25},
        },
    },
    "shapes": {
        "drum": {
            "type": "mesh",
            "material": "gold",
            "positions": positions,
            "faces": faces,
            "shading": "smooth",
            "transform": {"translate": [0.0, 0.15, 0.0]},
        },
        "table": {"type": "disk", "material": "table", "radius": "8 m"},
        "lamp": {"type": "sphere", "material": "lamp", "center": [-2.2, 3.0, -1.0], "radius": "40 cm"},
        # A prototype is described once and shown by its instances.
        "ball": {"type": "sphere", "material": "rubber", "radius": 0.17, "prototype": True},
    },
}
for number in range(12):
    angle = 2.0 * math.pi * number / 12
    description["shapes"][f"ball-{number}"] = {
        "type": "instance",
        "of": "ball",
        "material": "glass" if number % 3 == 0 else "rubber",
        "transform": {"translate": [1.25 * math.cos(angle), 0.17, 1.25 * math.sin(angle)]},
    }

scene = accuray.Scene.from_dict(description)
print(f"{len(faces)} triangles, scene {scene.identity[:16]}")
image = accuray.render(scene, spp=128)
image.save("drum.exr")
image.save("drum.png")
print(f"drum.png, estimated relative error {image.relative_error:.1%}")
