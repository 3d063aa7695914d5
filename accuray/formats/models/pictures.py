"""Pictures that a model means but does not hold: those that a texture times a colour, or a cut through alpha, gives."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def linear(pixels: NDArray[Any]) -> NDArray[np.float32]:
    """The texels as linear numbers; integers have the sRGB curve (IEC 61966-2-1), alpha does not."""
    if pixels.dtype.kind == "f":
        return pixels.astype(np.float32)
    values = pixels.astype(np.float64) / np.iinfo(pixels.dtype).max
    colors = slice(0, color_channels(pixels))
    encoded = values[..., colors]
    values[..., colors] = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return values.astype(np.float32)


def tinted(pixels: NDArray[Any], tint: tuple[float, ...], kept: float = 0.0) -> NDArray[np.float16]:
    """The picture times a linear colour; grey pictures get three channels. ``kept`` as in `under_gloss`."""
    values = linear(pixels)
    count = color_channels(pixels)
    colors = under_gloss(values[..., :count] * np.array(tint, dtype=np.float32), kept)
    return np.concatenate([colors, values[..., count:]], axis=2).astype(np.float16)


def under_gloss(reflectance: Any, kept: float) -> Any:
    """What reflects so much below an interface as ``reflectance`` does without it, an array or a number.

    The interface lets all light in and sends the share ``kept`` of diffuse light back: (1 - k) b / (1 - k b) = r.
    """
    return reflectance / (1.0 - kept + kept * reflectance)


def alpha_mask(pixels: NDArray[Any], factor: float, cutoff: float) -> NDArray[np.uint8]:
    """One channel: 255 where alpha times ``factor`` is at least ``cutoff``, else 0."""
    return np.where(alpha(pixels) * factor >= cutoff, 255, 0).astype(np.uint8)[..., np.newaxis]


def alpha(pixels: NDArray[Any]) -> NDArray[np.float64]:
    """Alpha from 0 to 1; 1 where the picture has none."""
    if color_channels(pixels) == pixels.shape[2]:
        return np.ones(pixels.shape[:2])
    values: NDArray[np.float64] = pixels[..., -1].astype(np.float64)
    return values if pixels.dtype.kind == "f" else values / float(np.iinfo(pixels.dtype).max)


def color_channels(pixels: NDArray[Any]) -> int:
    """Channels that are no alpha."""
    count: int = pixels.shape[2]
    return count - 1 if count in (2, 4) else count
