#!/usr/bin/env python3
"""Renders the pictures of docs/gallery.md into docs/pictures: all of them, or those that are named.

python tools/make_gallery.py
python tools/make_gallery.py colour-bleeding aliasing
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray.film.colour import srgb8
from accuray.film.png import encode_codes

REPOSITORY = Path(__file__).resolve().parents[1]
PICTURES = REPOSITORY / "docs" / "pictures"
ZOOM = 5
Overrides = dict[str, Any]


@dataclass(frozen=True)
class Shot:
    """A picture and how it is made: a scene of `scenes/`, changed by overrides and exposed by `exposure` in EV."""

    scene: str
    overrides: Overrides = field(default_factory=dict)
    layer: str = "rgb"
    exposure: float | None = None

    def image(self) -> accuray.Image:
        """The render, with the layer that is shown."""
        scene = accuray.load(REPOSITORY / "scenes" / f"{self.scene}.toml", overrides=self.overrides)
        return accuray.render(scene, layers=() if self.layer == "rgb" else (self.layer,))


SHOTS = {
    "teapot": Shot("teapot"),
    "area-and-point-light": Shot("area-and-point-light"),
    "colour-bleeding": Shot("colour-bleeding"),
    "colour-bleeding-indirect": Shot("colour-bleeding", layer="indirect", exposure=1.7),
    "torus-knot": Shot("torus-knot"),
    "motion": Shot("motion"),
    "rough-metals": Shot("rough-metals"),
    "textured": Shot("textured"),
    "textured-close-up": Shot(
        "textured",
        {
            "camera.position": [1.0, 0.8, 1.9],
            "camera.look_at": [0.1, 0.62, -1.0],
            "camera.fov": 30,
            "film.width": 420,
            "film.height": 300,
            "render.spp": 128,
        },
    ),
    "textured-light": Shot("textured-light"),
    "vertex-colours": Shot("vertex-colours"),
    "mipmaps": Shot("mipmaps"),
    "panes": Shot("panes"),
    "specularity": Shot("specularity"),
    "coated": Shot("coated"),
    "thin-film": Shot("thin-film"),
    "openpbr": Shot("openpbr"),
    "depth-of-field": Shot("depth-of-field"),
    "environment": Shot("environment"),
    "sunny": Shot("sunny"),
    "glass-and-texture": Shot("glass-and-texture"),
    "cornell-box": Shot("cornell-box"),
    "mirror-and-glass": Shot("mirror-and-glass"),
    "spheres": Shot("spheres"),
}

ALIASED: Overrides = {"film.filter": {"type": "box", "radius": 0}}
DETAILS = ((146, 96, 44, 28), (250, 134, 44, 28))
"""Parts of the scene `aliasing` that are magnified: left, top, width and height in pixels."""


def codes(shot: Shot) -> NDArray[np.uint8]:
    """The pixels of a shot as a PNG has them."""
    image = shot.image()
    exposure = float(image.metadata["exposure"]) if shot.exposure is None else shot.exposure
    return srgb8(image.layers[shot.layer] * 2.0**exposure)


def aliasing() -> NDArray[np.uint8]:
    """Left all samples in the middle of the pixel, right the whole filter; each detail `ZOOM` times as large."""
    columns = []
    for overrides in (ALIASED, {}):
        shown = codes(Shot("aliasing", overrides))
        details = [magnified(shown[y : y + h, x : x + w]) for x, y, w, h in DETAILS]
        columns.append(np.concatenate(list(spaced(details, axis=0)), axis=0))
    return np.concatenate(list(spaced(columns, axis=1)), axis=1)


def magnified(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Each pixel as a square of `ZOOM` x `ZOOM`."""
    return pixels.repeat(ZOOM, axis=0).repeat(ZOOM, axis=1)


def spaced(parts: list[NDArray[np.uint8]], axis: int) -> Iterator[NDArray[np.uint8]]:
    """The parts with white between them."""
    for number, part in enumerate(parts):
        if number:
            shape = list(part.shape)
            shape[axis] = 2 * ZOOM
            yield np.full(shape, 255, dtype=np.uint8)
        yield part


MAKERS: dict[str, Callable[[], NDArray[np.uint8]]] = {
    "aliasing": aliasing,
    **{name: partial(codes, shot) for name, shot in SHOTS.items()},
}


def main() -> None:
    """Renders what is asked for."""
    parser = argparse.ArgumentParser(description="Renders the pictures of docs/gallery.md.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of: {', '.join(sorted(MAKERS))}; default: all")
    names = parser.parse_args().names or list(MAKERS)
    if unknown := sorted(set(names) - set(MAKERS)):
        parser.error(f"there is no picture {unknown[0]}")
    for name in names:
        path = PICTURES / f"{name}.png"
        path.write_bytes(encode_codes(MAKERS[name]()))
        print(f"{path.relative_to(REPOSITORY)}: {path.stat().st_size // 1024} KiB")


if __name__ == "__main__":
    main()
