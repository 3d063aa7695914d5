"""Scenes in a form in which the naive `reference` integrator can be compared with the others.

`reference` finds light only where its paths run into it, so a small lamp leaves it nothing but noise. Each scene is
changed for all integrators alike: few pixels, the box filter, and what `FAIR` says for it. A scene that is not in the
table is taken as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray.scene import Spectrum

FOLDER = Path(__file__).resolve().parents[2] / "scenes"
SIZE = 32
Table = dict[str, Any]


def as_it_is(scene: accuray.Scene) -> accuray.Scene:
    """No change."""
    return scene


def enlarged(scene: accuray.Scene, lamp: str, factor: float) -> accuray.Scene:
    """The lamp (a mesh or a rectangle) `factor` times as wide and long about its centre, with the same flux.

    Vertices of other meshes that lie on a corner of the lamp move with it, so a hole around it stays closed.
    """
    shapes = {name: dict(table) for name, table in scene.shapes.items()}
    before = corners(shapes[lamp])
    centre = before.mean(axis=0)
    after = centre + factor * (before - centre)
    for table in shapes.values():
        if table["type"] == "mesh":
            table["positions"] = moved(table["positions"], before, after)
    if shapes[lamp]["type"] == "rectangle":
        shapes[lamp]["corner"] = tuple(after[0])
        for edge in ("edge_u", "edge_v"):
            shapes[lamp][edge] = tuple(factor * np.array(shapes[lamp][edge]))
    material = dict(scene.materials[shapes[lamp]["material"]])
    material["emission"] = replace(material["emission"], scale=material["emission"].scale / factor**2)
    return replace(scene, shapes=shapes, materials=scene.materials | {shapes[lamp]["material"]: material})


def with_large_lantern(scene: accuray.Scene, lamp: str, lantern: str, factor: float = 2.0) -> accuray.Scene:
    """A lamp, and a spherical one, `factor` times as large, with the same flux."""
    changed = enlarged(scene, lamp, factor)
    ball, material = dict(changed.shapes[lantern]), dict(changed.materials[changed.shapes[lantern]["material"]])
    ball["radius"] *= factor
    material["emission"] = replace(material["emission"], scale=material["emission"].scale / factor**2)
    materials = changed.materials | {ball["material"]: material}
    return replace(changed, shapes=changed.shapes | {lantern: ball}, materials=materials)


def glowing(scene: accuray.Scene, material: str, radiance: float) -> accuray.Scene:
    """What is made of the material emits white light to both sides."""
    glow = Spectrum(role="emission", form="constant", value=radiance)
    table = scene.materials[material] | {"emission": glow, "emission_sides": "both"}
    return replace(scene, materials=scene.materials | {material: table})


def brightened(scene: accuray.Scene, light: str, factor: float) -> accuray.Scene:
    """An infinite light with `factor` times its radiance or irradiance."""
    table = scene.lights[light]
    key = next(key for key, value in table.items() if isinstance(value, Spectrum))
    brighter = replace(table[key], scale=table[key].scale * factor)
    return replace(scene, lights=scene.lights | {light: table | {key: brighter}})


def softened(scene: accuray.Scene, light: str, most: float) -> accuray.Scene:
    """An environment map whose texels are held at `most`."""
    table = scene.lights[light]
    return replace(scene, lights=scene.lights | {light: table | {"pixels": np.minimum(table["pixels"], most)}})


def with_large_sun(scene: accuray.Scene, light: str, diameter: float) -> accuray.Scene:
    """A sky whose sun has this angular diameter, degrees, and the same irradiance."""
    table = scene.lights[light] | {"angular_diameter": float(np.radians(diameter))}
    return replace(scene, lights=scene.lights | {light: table})


def glowing_under(scene: accuray.Scene, lamp: str, factor: float, material: str, radiance: float) -> accuray.Scene:
    """The lamp `enlarged`, and the material `glowing`."""
    return glowing(enlarged(scene, lamp, factor), material, radiance)


def widened(scene: accuray.Scene, outer: float) -> accuray.Scene:
    """Spot lights with cones of this half-angle in degrees, whose edges begin in the middle."""
    cone = {"outer_angle": math.radians(outer), "inner_angle": math.radians(0.1 * outer)}
    lights = {name: light | cone if light["type"] == "spot" else light for name, light in scene.lights.items()}
    return replace(scene, lights=lights)


def dimmed(scene: accuray.Scene, names: tuple[str, ...], factor: float) -> accuray.Scene:
    """The materials called so emit `factor` of their light."""
    changed = {name: dict(scene.materials[name]) for name in names}
    for material in changed.values():
        material["emission"] = replace(material["emission"], scale=material["emission"].scale * factor)
    return replace(scene, materials=scene.materials | changed)


def corners(table: Table) -> NDArray[np.float64]:
    """Vertices of a mesh or rectangle, (N, 3); a rectangle's first is its `corner`."""
    if table["type"] == "mesh":
        return np.asarray(table["positions"], dtype=np.float64)
    start, u, v = (np.array(table[key], dtype=np.float64) for key in ("corner", "edge_u", "edge_v"))
    return np.stack([start, start + u, start + u + v, start + v])


def moved(
    positions: NDArray[np.float32], before: NDArray[np.float64], after: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Positions (N, 3), those of `before` put where `after` says."""
    result = positions.copy()
    for old, new in zip(before, after, strict=True):
        result[np.abs(positions - old).max(axis=1) < 1e-6] = new
    return result


@dataclass(frozen=True)
class Fair:
    """How a scene is made fair, in words and in code."""

    how: str
    change: Callable[[accuray.Scene], accuray.Scene] = as_it_is


UNKNOWN = Fair("as it is")
FAIR = {
    "aliasing": Fair("as it is: its light comes from everywhere"),
    "area-and-point-light": Fair(
        "the lamp 3 times as wide and long, 1/9 as bright", partial(enlarged, lamp="lamp", factor=3)
    ),
    "chess": Fair("the sky 20 times as bright", partial(brightened, light="sky", factor=20)),
    "closed-box": Fair("as it is: it glows everywhere"),
    "coated": Fair("the lamp twice as wide and long, 1/4 as bright", partial(enlarged, lamp="lamp", factor=2.0)),
    "cornell-box": Fair("the lamp 4 times as wide and long, 1/16 as bright", partial(enlarged, lamp="lamp", factor=4)),
    "colour-bleeding": Fair(
        "the lamp 3 times as wide and long, 1/9 as bright, and what is white glows",
        partial(glowing_under, lamp="lamp", factor=3, material="white", radiance=2.0),
    ),
    "depth-of-field": Fair(
        "the lamps in the background a tenth as bright", partial(dimmed, names=("warm", "cool"), factor=0.1)
    ),
    "environment": Fair(
        "the map's sun held at the brightness of what is around it",
        partial(softened, light="evening", most=np.float16(4)),
    ),
    "furnace": Fair("as it is: its light comes from everywhere"),
    "glass-and-texture": Fair("the wall glows", partial(glowing, material="wall", radiance=1.0)),
    "ies": Fair("the moon 20 times as bright", partial(brightened, light="moon", factor=20)),
    "many-lights": Fair("the sky ten times as bright", partial(brightened, light="sky", factor=10.0)),
    "mirror-and-glass": Fair("as the Cornell box", partial(enlarged, lamp="lamp", factor=4)),
    "mipmaps": Fair("as it is: its light comes from everywhere"),
    "motion": Fair(
        "lamp and lantern twice as large, 1/4 as bright", partial(with_large_lantern, lamp="lamp", lantern="lantern")
    ),
    "openpbr": Fair("the lamp 3 times as wide and long, 1/9 as bright", partial(enlarged, lamp="lamp", factor=3.0)),
    "panes": Fair("the lamp twice as wide and long, 1/4 as bright", partial(enlarged, lamp="lamp", factor=2.0)),
    "rough-metals": Fair("the lamp twice as wide and long, 1/4 as bright", partial(enlarged, lamp="lamp", factor=2.0)),
    "specularity": Fair("the lamp twice as wide and long, 1/4 as bright", partial(enlarged, lamp="lamp", factor=2.0)),
    "sphere-cavity": Fair("as it is: `reference` sums its point light plainly"),
    "spheres": Fair(
        "the lamp 1.5 times as wide and long, 1/2.25 as bright", partial(enlarged, lamp="lamp", factor=1.5)
    ),
    "spot": Fair("cones of 70 degrees, so that every lamp lights most of the stage", partial(widened, outer=70.0)),
    "sunny": Fair(
        "the sun 60 times as wide, with the same irradiance", partial(with_large_sun, light="day", diameter=32.0)
    ),
    "tea-hill": Fair(
        "the sun 60 times as wide, with the same irradiance", partial(with_large_sun, light="day", diameter=32.0)
    ),
    "teapot": Fair("the lamp 1.5 times as wide and long, 1/2.25 as bright", partial(enlarged, lamp="lamp", factor=1.5)),
    "thin-film": Fair("the ground glows", partial(glowing, material="ground", radiance=0.2)),
    "torus-knot": Fair("the room glows", partial(glowing, material="plaster", radiance=1.0)),
    "textured": Fair(
        "the lamp 2.5 times as wide and long, 1/6.25 as bright", partial(enlarged, lamp="lamp", factor=2.5)
    ),
    "textured-light": Fair("the sky 20 times as bright", partial(brightened, light="night", factor=20)),
    "vertex-colours": Fair(
        "the lamp twice as wide and long, 1/4 as bright", partial(enlarged, lamp="lamp", factor=2.0)
    ),
    "zoo": Fair("as it is: its lamps are large"),
}


def shipped() -> list[str]:
    """Names of all shipped scenes."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def all_scenes() -> list[str]:
    """The shipped ones, and the one beside this file that holds what they lack: see there."""
    return [*shipped(), "zoo"]


def scene_file(name: str) -> Path:
    """Where one of `all_scenes` is described."""
    return (Path(__file__).parent if name == "zoo" else FOLDER) / f"{name}.toml"


def fair_scene(name: str, integrator: Table) -> accuray.Scene:
    """One of `all_scenes` in its fair form, with an integrator in place of its own."""
    small = {"film.width": SIZE, "film.height": SIZE, "film.filter": {"type": "box"}, "integrator": integrator}
    return FAIR.get(name, UNKNOWN).change(accuray.load(scene_file(name), overrides=small))
