"""What one frame of an animation leaves for the next: parts of the lowered scene, found by what they were made of."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

import numpy as np

from accuray.scene import Scene, Spectrum
from accuray.scene import schema as schemas
from accuray.scene.identity import DISPLAY_ONLY
from accuray.scene.photometry import Photometry
from accuray.scene.placements import Transforms
from accuray.scene.textures import TextureUse

PICTURE = ("width", "height")
PLAIN = (bool, int, float, str, bytes, Path, Spectrum, TextureUse)
"""Types whose values are the same if they compare equal."""


class Kept:
    """Parts by their keys: those of this scene, taken from the scene before where that had the same.

    ``built`` and ``kept`` count the parts that were made and found, by their kind.
    """

    def __init__(self, before: Kept | None = None) -> None:
        self._before = {} if before is None else before._parts
        self._parts: dict[tuple[str, tuple[int, ...], Hashable], tuple[Any, Any]] = {}
        self.built: dict[str, int] = {}
        self.kept: dict[str, int] = {}

    def part(self, kind: str, sources: tuple[Any, ...], options: Hashable, make: Callable[[], Any]) -> Any:
        """The part of a kind made from these objects, which count by identity, and options, which count by value."""
        key = (kind, tuple(map(id, sources)), options)
        found = self._parts.get(key) or self._before.get(key)
        self.count(kind, found is None)
        self._parts[key] = found or (sources, make())
        return self._parts[key][1]

    def count(self, kind: str, is_built: bool) -> None:
        """Enters one part."""
        counts = self.built if is_built else self.kept
        counts[kind] = counts.get(kind, 0) + 1

    def keep_all(self) -> None:
        """Takes over all that the scene before had, with its tables and its structure."""
        self._parts = self._before
        for kind, *_ in self._parts:
            self.count(kind, is_built=False)
        for kind in ("tables", "structure"):
            self.count(kind, is_built=False)
        self.release()

    def release(self) -> None:
        """Lets go of the scene before."""
        self._before = {}


def lowered_tables(scene: Scene) -> dict[str, Any]:
    """What the lowered scene depends on, by sections; the camera, with the size of its picture, by itself."""
    film, render = (
        {key: value for key, value in table.items() if key not in (*DISPLAY_ONLY[name], *PICTURE)}
        for name, table in (("film", scene.film), ("render", scene.render))
    )
    return {
        "camera": [scene.camera, *(scene.film[key] for key in PICTURE)],
        "film": film,
        "render": render,
        "filter": scene.filter,
        "integrator": scene.integrator,
        "textures": scene.textures,
        "materials": scene.materials,
        "lights": scene.lights,
        "shapes": scene.shapes,
    }


def shapes_alone(tables: dict[str, Any]) -> dict[str, Any]:
    """The shapes without their materials, which no acceleration structure knows."""
    return {
        name: {key: value for key, value in table.items() if key != "material"}
        for name, table in tables["shapes"].items()
    }


def stands_alone(table: dict[str, Any]) -> bool:
    """Are the triangles of a shape its own affair? Not if it reads a texture, or is measured in the camera's pixels."""
    params = schemas.current().family("shape").types[table["type"]].params
    in_pixels = any(param.unit == "px" and table[param.name] is not None for param in params)
    return not in_pixels and not any(isinstance(value, TextureUse) for value in table.values())


def same(a: Any, b: Any) -> bool:
    """Are two resolved values the same? Objects of types that are not known here are so only by identity."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, PLAIN):
        return bool(a == b)
    if isinstance(a, dict):
        return list(a) == list(b) and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, Photometry):
        return same(vars(a), vars(b))
    if isinstance(a, Transforms):
        return same((a.count, a.sha256), (b.count, b.sha256))
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and bool(np.array_equal(a, b))
    return False
