"""A camera and a light for models that have none."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from accuray.formats.models.model import Model, Table, matrix_of

FOV = 35.0
SINE_OF_HALF_FOV = 0.30070579950427306
DIRECTION = (0.5, 0.4, 1.0)
"""From the middle of the model to the camera: from the front, a little to the right and from above."""

LEAST_RADIUS = 1e-6


def default_camera(model: Model) -> Table | None:
    """A camera that the sphere around the model's box just fits into; None for a model without shapes."""
    bounds = model_bounds(model)
    if bounds is None:
        return None
    low, high = bounds
    middle = 0.5 * (low + high)
    radius = max(0.5 * math.sqrt(sum(float(x) ** 2 for x in high - low)), LEAST_RADIUS)
    length = math.sqrt(sum(x * x for x in DIRECTION))
    eye = middle + radius / SINE_OF_HALF_FOV / length * np.array(DIRECTION)
    return {"type": "perspective", "position": eye.tolist(), "look_at": middle.tolist(), "fov": FOV}


def default_lights(model: Model) -> dict[str, Table]:
    """Daylight from everywhere, unless something of the model shines."""
    if model.lights or any("emission" in material for material in model.materials.values()):
        return {}
    return {"daylight": {"type": "constant", "radiance": "D65"}}


def model_bounds(model: Model) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """The least and the greatest coordinates of all shapes that are shown; None if there are none."""
    own = {name: shape["positions"] for name, shape in model.shapes.items() if shape["type"] == "mesh"}
    boxes = []
    for name, shape in model.shapes.items():
        if shape.get("prototype"):
            continue
        matrix = matrix_of(shape)
        for member in shape.get("of", [name]):
            points = own[member].astype(np.float64)
            moved = sum(points[:, axis, None] * matrix[:3, axis] for axis in range(3)) + matrix[:3, 3]
            if len(points):
                boxes.append((moved.min(axis=0), moved.max(axis=0)))
    if not boxes:
        return None
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)
