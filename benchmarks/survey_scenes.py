"""The eight scenes of the survey, as dicts that both AccuRay and the translation for Cycles read.

All share a stage: a floor and a wall, a lamp above, a dim sky, and a torus knot with a ball beside it, whose materials
make the difference. Colours are linear Rec.709 and metals have one n and k for all wavelengths, so that an RGB renderer
can follow.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

TEXTURES = Path(__file__).parents[1] / "scenes" / "textures"
SIZE = 160
Table = dict[str, Any]

WHITE = {"type": "diffuse", "reflectance": [0.75, 0.75, 0.75]}
GREY = {"type": "diffuse", "reflectance": [0.4, 0.4, 0.4]}
RED = {"type": "diffuse", "reflectance": [0.65, 0.06, 0.04]}
BLUE = {"type": "diffuse", "reflectance": [0.05, 0.12, 0.6]}
MIRROR = {"type": "conductor", "eta": 0.2, "k": 3.9}
GLASS = {"type": "dielectric", "ior": 1.5}
BRICKS: Table = {"type": "image", "file": "bricks.png", "uv_scale": [4, 2]}
DENTS: Table = {"type": "image", "file": "bricks-normal.png", "uv_scale": [4, 2]}
BRICK_WALL = {"type": "diffuse", "reflectance": {"texture": "bricks"}}

# Title, materials that differ from a white floor, wall, ball and grey sides, and the textures that they name.
PAIRS: dict[str, tuple[str, Table, Table]] = {
    "diffuse": ("Diffuse interreflection", {"left": RED, "right": BLUE}, {}),
    "mirror": ("Mirror", {"left": RED, "right": BLUE, "knot": MIRROR}, {}),
    "mirror-textured": ("Mirror with textures", {"wall": BRICK_WALL, "knot": MIRROR}, {"bricks": BRICKS}),
    "rough-mirror-textured": (
        "Rough mirror with textures",
        {"wall": BRICK_WALL, "knot": {**MIRROR, "roughness": 0.35}},
        {"bricks": BRICKS},
    ),
    "glass": ("Glass", {"left": RED, "right": BLUE, "knot": GLASS, "ball": GLASS}, {}),
    "rough-glass": (
        "Rough glass",
        {"left": RED, "right": BLUE, "knot": {**GLASS, "roughness": 0.4}, "ball": {**GLASS, "roughness": 0.4}},
        {},
    ),
    "normal-map": (
        "Texture and normal map",
        {"wall": {**BRICK_WALL, "normal_map": "dents"}, "knot": WHITE},
        {"bricks": BRICKS, "dents": DENTS},
    ),
    "coloured-glass": (
        "Coloured glass",
        {
            "knot": {**GLASS, "transmission_color": [0.9, 0.25, 0.1], "transmission_depth": 0.3},
            "ball": {**GLASS, "transmission_color": [0.2, 0.7, 0.35], "transmission_depth": 0.5},
        },
        {},
    ),
}

SHAPES: Table = {
    "lamp": {
        "type": "rectangle",
        "material": "lamp",
        "corner": [-0.7, 2.8, -0.2],
        "edge_u": [1.4, 0, 0],
        "edge_v": [0, 0, 1.4],
    },
    "floor": {
        "type": "rectangle",
        "material": "floor",
        "corner": [-2, 0, 2.5],
        "edge_u": [4, 0, 0],
        "edge_v": [0, 0, -4],
    },
    "wall": {
        "type": "rectangle",
        "material": "wall",
        "corner": [-2, 0, -1.5],
        "edge_u": [4, 0, 0],
        "edge_v": [0, 3, 0],
    },
    "left": {
        "type": "rectangle",
        "material": "left",
        "corner": [-1.6, 0, 2.5],
        "edge_u": [0, 0, -4],
        "edge_v": [0, 3, 0],
    },
    "right": {
        "type": "rectangle",
        "material": "right",
        "corner": [1.6, 0, -1.5],
        "edge_u": [0, 0, 4],
        "edge_v": [0, 3, 0],
    },
    "knot": {
        "type": "torus_knot",
        "material": "knot",
        "p": 2,
        "q": 3,
        "center": [-0.35, 0.85, -0.2],
        "axis": [0.2, 0.3, 1],
        "radius": 0.55,
        "winding_radius": 0.26,
        "tube_radius": 0.15,
    },
    "ball": {"type": "sphere", "material": "ball", "center": [0.95, 0.45, 0.5], "radius": 0.45},
}


def description(name: str) -> Table:
    """One of `PAIRS` as `accuray.Scene.from_dict` takes it; pictures are named by their file in scenes/textures."""
    _, materials, textures = PAIRS[name]
    common = {"floor": WHITE, "wall": WHITE, "left": GREY, "right": GREY, "knot": WHITE, "ball": WHITE}
    lamp = {"type": "diffuse", "reflectance": [0, 0, 0], "emission": {"rgb": [1, 0.95, 0.88], "scale": 6}}
    return {
        "film": {"width": SIZE, "height": SIZE, "filter": {"type": "box"}},
        "camera": {"type": "perspective", "position": [0, 1.3, 5.4], "look_at": [0, 0.9, 0], "fov": 34},
        "lights": {"sky": {"type": "constant", "radiance": {"rgb": [0.6, 0.75, 1], "scale": 0.25}}},
        "materials": {**common, "lamp": lamp, **materials},
        "textures": textures,
        "shapes": SHAPES,
    }
