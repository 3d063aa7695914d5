"""A map of the surroundings as a smooth function of direction, sampled where each renderer has its texels.

AccuRay and Cycles have the middles of a map's rows between the poles, Mitsuba has the first and the last row on them.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks import settings

Floats = NDArray[np.float32]
FILE, POLES_FILE = "sky.exr", "sky-poles.exr"

ZENITH, HORIZON, GROUND = ((0.16, 0.3, 0.75), (0.7, 0.8, 0.95), (0.22, 0.19, 0.15))
"""Radiance as linear Rec.709; the ground is darker than the haze above it."""

SUNS: dict[str, tuple[tuple[float, float, float, float, tuple[float, float, float]], ...]] = {
    "overcast": (),
    "sunny": (
        (38.0, 40.0, 1.2, 6.0, (1.0, 0.86, 0.66)),
        (38.0, 40.0, 12.0, 0.6, (1.0, 0.9, 0.75)),
        (18.0, -75.0, 5.0, 0.5, (0.9, 0.95, 1.0)),
    ),
}
"""Peaks of each sky: elevation, azimuth from -Z towards +X, width (standard deviation), all in degrees; irradiance
that it sends to a plane facing it, and its colour."""


def radiance(elevation: NDArray[np.float64], azimuth: NDArray[np.float64], suns: str) -> NDArray[np.float64]:
    """Linear Rec.709 (..., 3) of directions, angles in radians."""
    height = np.sin(elevation)[..., None]
    above = np.array(HORIZON) + (np.array(ZENITH) - np.array(HORIZON)) * np.clip(height, 0.0, 1.0) ** 0.6
    day = 0.5 + 0.5 * np.tanh(40.0 * height)
    found = np.array(GROUND) + (above - np.array(GROUND)) * day
    for up, around, width, irradiance, colour in SUNS[suns]:
        cosine = np.sin(elevation) * np.sin(np.radians(up)) + np.cos(elevation) * np.cos(np.radians(up)) * np.cos(
            azimuth - np.radians(around)
        )
        sharpness = 1.0 / np.radians(width) ** 2
        peak = irradiance * sharpness / (2.0 * np.pi) * np.exp(sharpness * (cosine - 1.0))
        found = found + peak[..., None] * np.array(colour)
    return np.asarray(found)


def pixels(suns: str, poles: bool) -> Floats:
    """The map (H, W, 3), or (H + 1, W, 3) with the first and last row on the poles: the middle is -Z, then +X."""
    height, width = settings.SKY_HEIGHT, 2 * settings.SKY_HEIGHT
    rows = np.arange(height + 1) / height if poles else (np.arange(height) + 0.5) / height
    elevation = np.pi * (0.5 - rows)
    azimuth = 2.0 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    return radiance(*np.meshgrid(elevation, azimuth, indexing="ij"), suns).astype(np.float32)


def write(suns: str, folder: Path) -> None:
    """Both maps, as OpenEXR of 32 bits."""
    import OpenImageIO as oiio  # noqa: N813

    for name, poles in ((FILE, False), (POLES_FILE, True)):
        found = pixels(suns, poles)
        out = oiio.ImageOutput.create(str(folder / name))
        if not out or not out.open(str(folder / name), oiio.ImageSpec(found.shape[1], found.shape[0], 3, "float")):
            raise OSError(f"{folder / name}: {oiio.geterror()}")
        out.write_image(found)
        out.close()
