"""Runs a Python program with a small AccuRay: every image 16 x 12 pixels of 4 samples, every ray 8 samples.

    python small.py PROGRAM.py

So the programs that people read need no switch for the tests.
"""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import accuray

SIZE = {"width": 16, "height": 12}
SPP = 4
RAY_SPP = 8

full_render, full_radiance, full_frames = accuray.render, accuray.radiance, accuray.render_frames


def render(scene: accuray.Scene, **options: Any) -> accuray.Image:
    """`accuray.render` of a small image; of a range of samples only the first ones are rendered."""
    if options.get("samples"):
        first = options["samples"][0]
        options["samples"] = (first, first + SPP)
    else:
        options["spp"] = SPP
    return full_render(replace(scene, film={**scene.film, **SIZE}), **options)


def render_frames(scene: accuray.Scene, frames: Any, **options: Any) -> Iterator[accuray.Frame]:
    """`accuray.render_frames` of a corner of the images."""
    return full_frames(scene, frames, **{**options, "spp": SPP, "crop": (0, 0, SIZE["width"], SIZE["height"])})


def radiance(scene: accuray.Scene, origins: Any, directions: Any, spp: int, **options: Any) -> accuray.Radiance:
    """`accuray.radiance` with few samples."""
    return full_radiance(scene, origins, directions, min(spp, RAY_SPP), **options)


if __name__ == "__main__":
    accuray.render, accuray.radiance = render, radiance  # type: ignore[assignment]
    accuray.render_frames = render_frames
    sys.argv = sys.argv[1:]
    runpy.run_path(sys.argv[0], run_name="__main__")
