"""GLB files for the comparison with Cycles' import: one idea each, with a camera and with lights of their own."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "models"))
from model_files import SQUARE_UVS, GltfFile

Table = dict[str, Any]
WIDTH, HEIGHT = 72, 48
NO_GLOSS: Table = {"KHR_materials_specular": {"specularFactor": 0}}
SEGMENTS, RINGS = 96, 48


def paint(*color: float, **more: Any) -> Table:
    """Lambert's law in both renderers: no gloss."""
    pbr = {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 1}
    return {"pbrMetallicRoughness": pbr, "extensions": {**NO_GLOSS, **more.pop("extensions", {})}, **more}


def surface(metal: float, roughness: float, color: tuple[float, float, float], **extensions: Table) -> Table:
    """A material with gloss."""
    pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metal, "roughnessFactor": roughness}
    return {"pbrMetallicRoughness": pbr, "extensions": extensions}


def glowing(strength: float, color: tuple[float, float, float] = (1, 1, 1)) -> Table:
    """Light and nothing else, from both sides: Blender knows no other."""
    more = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    return {**paint(0, 0, 0, extensions=more), "emissiveFactor": list(color), "doubleSided": True}


def stage(floor: Table | None = None, eye: tuple[float, float, float] = (0, 2.2, 6)) -> GltfFile:
    """A file with a camera that looks down at the origin and a floor, a square 12 m wide."""
    file = GltfFile()
    file.add(
        "cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": WIDTH / HEIGHT, "znear": 0.1}}
    )
    angle = -np.arctan2(eye[1] - 0.5, eye[2])
    file.node(camera=0, translation=list(eye), rotation=[float(np.sin(angle / 2)), 0, 0, float(np.cos(angle / 2))])
    half = np.sqrt(0.5)
    add(file, floor or paint(0.5, 0.5, 0.5), translation=[-6, 0, 6], rotation=[-half, 0, 0, half], scale=[12, 12, 1])
    return file


def add(file: GltfFile, material: Table, attributes: dict[str, NDArray[Any]] | None = None, **place: Any) -> None:
    """A node with a mesh of this material: a unit square that faces +z, or other attributes."""
    normals = np.tile(np.array([[0, 0, 1]], "<f4"), (4, 1))
    given = attributes or {"TEXCOORD_0": SQUARE_UVS, "NORMAL": normals}
    file.node(mesh=file.mesh(file.material(**material), **given), **place)


def light(file: GltfFile, described: Table, **place: Any) -> None:
    """A punctual light."""
    lights = file.data.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
    lights.append(described)
    file.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **place)


def panel(file: GltfFile, strength: float = 6.0) -> None:
    """A lamp 3 m wide, 4 m above the origin, that shines down."""
    half = float(np.sqrt(0.5))
    add(file, glowing(strength), translation=[-1.5, 4, -1.5], rotation=[half, 0, 0, half], scale=[3, 3, 1])


def ball() -> dict[str, NDArray[Any]]:
    """A smooth sphere of radius 0.5."""
    theta = np.linspace(0, np.pi, RINGS + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, SEGMENTS + 1)[None, :]
    grid = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.sin(phi)], axis=-1)
    normals = grid.reshape(-1, 3)
    row, column = np.meshgrid(np.arange(RINGS), np.arange(SEGMENTS), indexing="ij")
    a = row * (SEGMENTS + 1) + column
    b, c, d = a + SEGMENTS + 1, a + SEGMENTS + 2, a + 1
    faces = np.concatenate([np.stack([a, b, c], -1)[:-1].reshape(-1, 3), np.stack([a, c, d], -1)[1:].reshape(-1, 3)])
    return {
        "POSITION": (0.5 * normals).astype("<f4"),
        "NORMAL": normals.astype("<f4"),
        "indices": faces.astype("<u4").ravel(),
    }


def balls(file: GltfFile, materials: list[Table]) -> GltfFile:
    """Three of them side by side under the panel."""
    for x, material in zip((-1.25, 0.0, 1.25), materials, strict=True):
        add(file, material, ball(), translation=[x, 0.5, 0])
    panel(file)
    return file


def lights() -> GltfFile:
    """A point, a spot and parallel light, each of its own colour, over a floor."""
    file = stage()
    light(file, {"type": "point", "intensity": 3, "color": [1, 0.5, 0.25]}, translation=[-1.5, 1.2, 0])
    spot = {
        "type": "spot",
        "intensity": 20,
        "color": [0.3, 0.6, 1],
        "spot": {"innerConeAngle": 0.398, "outerConeAngle": 0.4},
    }
    half = float(np.sqrt(0.5))
    light(file, spot, translation=[1.5, 2.5, 0], rotation=[-half, 0, 0, half])
    slanted = [float(np.sin(-0.5)), 0, 0, float(np.cos(-0.5))]
    light(file, {"type": "directional", "intensity": 0.4, "color": [0.6, 1, 0.6]}, rotation=slanted)
    return file


def emission() -> GltfFile:
    """Three standing panels of different strengths and colours before a floor."""
    file = stage()
    for x, strength, color in ((-1.9, 2, (1, 0.4, 0.2)), (-0.5, 0.5, (0.3, 1, 0.4)), (0.9, 1, (0.3, 0.5, 1))):
        add(file, glowing(strength, color), translation=[x, 0.2, -1])
    return file


def textures() -> GltfFile:
    """A picture in sRGB, repeated, turned and moved; colours of vertices; a factor of the base colour."""
    file = stage()
    rng = np.random.default_rng(1)
    pixels = np.kron(rng.integers(40, 250, (4, 4, 3)), np.ones((8, 8, 1))).astype(np.uint8)
    picture = file.picture(pixels, wrapS=10497, wrapT=10497)
    moved = {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [1.5, 2]}}
    for x, texture, factor in ((-2.1, {}, (1, 1, 1)), (-0.65, {"extensions": moved}, (1, 0.8, 0.6))):
        material = paint(*factor)
        material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": picture, **texture}
        add(file, material, translation=[x, 0.2, -1], scale=[1.3, 1.3, 1])
    colors = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], "<f4")
    normals = np.tile(np.array([[0, 0, 1]], "<f4"), (4, 1))
    add(
        file,
        paint(0.8, 0.8, 0.8),
        {"COLOR_0": colors, "NORMAL": normals},
        translation=[0.8, 0.2, -1],
        scale=[1.3, 1.3, 1],
    )
    light(file, {"type": "directional", "intensity": 2}, rotation=[float(np.sin(-0.25)), 0, 0, float(np.cos(-0.25))])
    return file


def metals() -> GltfFile:
    """Three roughnesses, three colours."""
    colors = ((0.9, 0.6, 0.3), (0.9, 0.9, 0.9), (0.4, 0.6, 0.9))
    return balls(stage(), [surface(1, r, c) for r, c in zip((0.25, 0.5, 0.8), colors, strict=True)])


def plastics() -> GltfFile:
    """Glossy, satin, and partly metal."""
    return balls(
        stage(),
        [surface(0, 0.3, (0.7, 0.1, 0.1)), surface(0, 0.6, (0.1, 0.4, 0.7)), surface(0.5, 0.5, (0.6, 0.5, 0.2))],
    )


COAT: Table = {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.2}}
SHEEN: Table = {"KHR_materials_sheen": {"sheenColorFactor": [0.6, 0.6, 0.6], "sheenRoughnessFactor": 0.5}}
RED, BLUE, GOLD = (0.7, 0.1, 0.1), (0.1, 0.1, 0.5), (0.9, 0.7, 0.4)


def coat() -> GltfFile:
    """Clear varnish over three paints."""
    return balls(stage(), [surface(0, 1, color, **NO_GLOSS, **COAT) for color in (RED, BLUE, (0.8, 0.8, 0.8))])


def fuzz() -> GltfFile:
    """Fibres over the paint of the ball in the middle."""
    return balls(stage(), [paint(*RED), surface(0, 1, BLUE, **NO_GLOSS, **SHEEN), paint(*GOLD)])


def coated_metal() -> GltfFile:
    """Varnish over the metal of the ball on the right."""
    return balls(stage(), [surface(1, 0.6, GOLD), paint(*BLUE), surface(1, 0.6, GOLD, **COAT)])


def glass() -> GltfFile:
    """Clear bodies of two indices and a coloured one."""

    def body(ior: float, **volume: Any) -> Table:
        return surface(
            0,
            0.3,
            (1, 1, 1),
            KHR_materials_transmission={"transmissionFactor": 1},
            KHR_materials_ior={"ior": ior},
            KHR_materials_volume={"thicknessFactor": 1, **volume},
        )

    return balls(stage(), [body(1.5), body(1.33), body(1.5, attenuationColor=[0.9, 0.4, 0.2], attenuationDistance=1.0)])


CASES: dict[str, Callable[[], GltfFile]] = {
    "lights": lights,
    "emission": emission,
    "textures": textures,
    "metals": metals,
    "plastics": plastics,
    "coat": coat,
    "fuzz": fuzz,
    "coated_metal": coated_metal,
    "glass": glass,
}
