"""Environment maps: what their pictures must fulfil."""

from __future__ import annotations

from typing import Any

from accuray.scene.errors import Where
from accuray.scene.transforms import check_rigid

MOST = 1e30
"""Largest texel: sums over a map stay finite."""


def check_environments(lights: dict[str, dict[str, Any]], where: Where) -> None:
    """Puts what ``color_space = "auto"`` means in its place; radiance is never negative. Raises SceneError."""
    for name, light in lights.items():
        pixels = light.get("pixels")
        if pixels is None:
            continue
        if light["transform"] is not None:
            check_rigid(light["transform"], "an environment", where.child(name, "transform"))
        stored_as_float = pixels.dtype.kind == "f"
        if light["color_space"] == "auto":
            light["color_space"] = "linear" if stored_as_float else "srgb"
        if stored_as_float:
            _check_radiance(pixels, where.child(name, "pixels" if light["file"] is None else "file"))


def _check_radiance(pixels: Any, where: Where) -> None:
    import numpy as np

    colours = pixels[..., : 3 if pixels.shape[2] >= 3 else 1]
    if float(colours.min()) < 0.0 or float(colours.max()) > MOST:
        row, column, channel = (int(index) for index in np.argwhere((colours < 0) | (colours > np.float32(MOST)))[0])
        raise where.error(
            f"has a texel of the radiance {float(colours[row, column, channel]):g}: row {row}, column {column}, "
            f"channel {channel}",
            allowed=f"0 to {MOST:g}",
        )
