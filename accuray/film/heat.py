"""False colours for maps of one quantity."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

_START, _ROTATIONS, _HUE = 0.5, -1.5, 1.0
"""Green's standard scheme: starts at blue-violet, one and a half turns against the rainbow, full saturation."""
_TO_RGB = ((-0.14861, 1.78277), (-0.29227, -0.90649), (1.97294, 0.0))
"""Deviations from grey of equal perceived intensity, for the cosine and the sine of the hue's angle."""
_SHARE = 0.999


def heat_map(values: NDArray[np.floating], limit: float) -> NDArray[np.uint8]:
    """8-bit sRGB (height, width, 3) of values (height, width): black at 0, white at `limit` and above.

    The colours are the cubehelix of Green 2011, whose perceived intensity grows steadily from end to end.
    """
    x = np.clip(np.asarray(values, dtype=np.float64) / limit, 0.0, 1.0)
    angle = 2.0 * math.pi * (_START / 3.0 + 1.0 + _ROTATIONS * x)
    amplitude = _HUE * x * (1.0 - x) / 2.0
    channels = [x + amplitude * (p * np.cos(angle) + q * np.sin(angle)) for p, q in _TO_RGB]
    return np.rint(255.0 * np.clip(np.stack(channels, axis=2), 0.0, 1.0)).astype(np.uint8)


def heat_range(values: NDArray[np.floating]) -> float:
    """The least of 1, 0.5, 0.2, 0.1, 0.05, ... above all but one in a thousand of the values; 1 if they are zero."""
    top = float(np.quantile(values, _SHARE)) or float(values.max())
    if not top > 0.0:
        return 1.0
    decade = 10.0 ** math.floor(math.log10(top))
    return min(1.0, next(step * decade for step in (1, 2, 5, 10, 20) if step * decade >= top))
