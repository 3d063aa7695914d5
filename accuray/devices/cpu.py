"""The processor of this machine: a lowered scene with its acceleration structure, and passes over it."""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.devices.lowering import MeshReport, lower
from accuray.film import Film
from accuray.scene import Scene


@dataclass(frozen=True)
class LoadedScene:
    """A scene ready for passes. ``reports`` says, by shape, what was left out of its mesh."""

    core: Any
    reports: dict[str, MeshReport]

    def render_pass(self, film: Film, tiles: list[int], first: int, count: int, *, seed: int, threads: int) -> Any:
        """Starts adding samples first .. first + count - 1 of some 16x16 tiles of the film's window.

        The pass (``wait(seconds)``, ``stop()``, ``done``, ``rays``, ``finished``) adds whole tiles only; what
        ``finished`` marks is for the caller to enter in the film's coverage.
        """
        from accuray._core import engine

        x0, y0, _, _ = film.window
        return engine.render_pass(
            self.core, film.sums, film.dropped, x0, y0, film.width, film.height, tiles, first, count, seed,
            film.replicates, threads,
        )  # fmt: skip

    def ray_pass(
        self,
        film: Film,
        origins: NDArray[np.float32],
        directions: NDArray[np.float32],
        count: int,
        *,
        seed: int,
        threads: int,
        wavelengths: list[float],
    ) -> Any:
        """Starts samples 0 .. count - 1 along every ray; the film has one row with a column for each ray."""
        from accuray._core import engine

        return engine.ray_pass(
            self.core,
            film.sums,
            film.dropped,
            origins,
            directions,
            0,
            count,
            seed,
            film.replicates,
            threads,
            wavelengths,
        )


_loaded: dict[int, LoadedScene] = {}
"""Scenes that were rendered and still live, by ``id``: rendering again, or probing, builds nothing."""


def load(scene: Scene) -> LoadedScene:
    """Lowers a scene and builds its acceleration structure; the same scene gives the same object. Raises SceneError."""
    from accuray._core import engine

    key = id(scene)
    if key not in _loaded:
        block, reports = lower(scene)
        _loaded[key] = LoadedScene(engine.LoadedScene(block), reports)
        weakref.finalize(scene, _loaded.pop, key, None)
    return _loaded[key]


@cache
def build_info() -> dict[str, str]:
    """What the bits of a picture depend on besides the scene: instruction set, processor's maker, Embree's version."""
    from accuray._core import engine

    return {"isa": engine.ISA, "cpu_vendor": _cpu_vendor(), "embree": engine.EMBREE_VERSION}


def _cpu_vendor() -> str:
    """The processor's maker as it names itself; "unknown" where the system does not tell."""
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8") as lines:
            return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("vendor_id")), "unknown")
    except OSError:
        return "unknown"
