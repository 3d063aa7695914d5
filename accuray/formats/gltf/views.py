"""Cameras and punctual lights at the places of their nodes. Both look along -z, as the renderer's cameras do."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.formats.gltf.item import Item
from accuray.formats.models.model import Model, Table

LIGHTS = {"point": "point", "spot": "spot", "directional": "directional"}
"""KHR_lights_punctual's types, and ours."""

NARROWEST = 0.01
"""Least half-angle of a spot, degrees."""


def camera_table(camera: Item, matrix: NDArray[np.float64], model: Model) -> Table:
    """A camera of the scene; ``aspect``, width over height, is for the film."""
    kind = camera.text("type")
    if kind not in ("perspective", "orthographic"):
        raise camera.child("type").error("is not a type of cameras", "perspective, orthographic")
    given = camera.table(kind)
    place = _placed(matrix)
    if kind == "orthographic":
        width, height = (abs(given.number(key)) for key in ("xmag", "ymag"))
        height = min(max(2.0 * height, 1e-9), 1e9)
        aspect = 2.0 * width / height
        return {"type": kind, "height": height, **place, **({"aspect": aspect} if 0.0 < aspect < 1e6 else {})}
    fov = math.degrees(given.number("yfov", low=1e-6))
    if not 1e-4 <= fov <= 179.99:
        model.note(camera.where.key, f"the field of view of {fov:g} degrees was cut off")
    table: Table = {"type": kind, "fov": min(max(fov, 1e-4), 179.99), **place}
    if given.has("aspectRatio"):
        table["aspect"] = given.number("aspectRatio", low=1e-6, high=1e6)
    return table


def light_table(light: Item, matrix: NDArray[np.float64], white: float) -> Table:
    """A light of the scene. ``white`` is the luminance in cd/m^2 that has Y = 1."""
    kind = light.text("type")
    if kind not in LIGHTS:
        raise light.child("type").error("is not a type of lights", ", ".join(LIGHTS))
    color = [max(0.0, value) for value in light.vector("color", (1.0, 1.0, 1.0))]
    emission = {"rgb": color, "scale": light.number("intensity", 1.0, 0.0) / white}
    position, direction = _vector(matrix[:3, 3]), _vector(-matrix[:3, 2])
    if kind == "point":
        return {"type": LIGHTS[kind], "position": position, "intensity": emission}
    if kind == "directional":
        return {"type": LIGHTS[kind], "direction": direction, "irradiance": emission}
    spot = light.table("spot")
    outer = spot.number("outerConeAngle", math.pi / 4, 0.0, math.pi / 2)
    inner = spot.number("innerConeAngle", 0.0, 0.0, math.pi / 2)
    return {
        "type": LIGHTS[kind],
        "position": position,
        "direction": direction,
        "intensity": emission,
        "inner_angle": math.degrees(min(inner, outer)),
        "outer_angle": max(math.degrees(outer), NARROWEST),
        "falloff": "square",
    }


def _placed(matrix: NDArray[np.float64]) -> Table:
    """Eye, a point ahead of it, and the direction that is up."""
    eye, ahead = matrix[:3, 3], -matrix[:3, 2]
    ahead = ahead / math.sqrt(sum(float(x) * float(x) for x in ahead))
    return {"position": _vector(eye), "look_at": _vector(eye + ahead), "up": _vector(matrix[:3, 1])}


def _vector(values: Any) -> list[float]:
    return [float(value) + 0.0 for value in values]
