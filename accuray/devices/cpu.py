"""The processor of this machine: a lowered scene with its acceleration structure, and passes over it."""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.devices.kept import Kept, lowered_tables, same, shapes_alone, stands_alone
from accuray.devices.lowering import lower, with_camera
from accuray.devices.shapes import MeshReport
from accuray.film import Film
from accuray.scene import Scene


@dataclass(frozen=True)
class LoadedScene:
    """A scene ready for passes. ``reports`` says, by shape, what was left out of its mesh.

    ``tables`` and ``block`` are what it was lowered from and to; ``parts`` counts what was built for it and what was
    kept of an earlier frame: each "mesh", the "structure" over all shapes, and the "tables" of everything else.
    """

    core: Any
    reports: dict[str, MeshReport]
    tables: dict[str, Any]
    block: Any
    parts: Kept

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
    """Lowers a scene and builds its acceleration structure; the same scene gives the same object. Raises SceneError.

    What another frame of the same animation has left (``scene.resident``) is used as far as it is the same.
    """
    key = id(scene)
    if key not in _loaded:
        loaded = _load_after(scene, scene.resident.loaded)
        scene.resident.loaded = _loaded[key] = loaded
        weakref.finalize(scene, _loaded.pop, key, None)
    return _loaded[key]


def _load_after(scene: Scene, before: LoadedScene | None) -> LoadedScene:
    from accuray._core import engine

    tables = lowered_tables(scene)
    parts = Kept(None if before is None else before.parts)
    alone = all(map(stands_alone, scene.shapes.values()))
    others = [name for name in tables if name != "camera"]
    if before is not None and alone and all(same(tables[name], before.tables[name]) for name in others):
        block = before.block if same(tables["camera"], before.tables["camera"]) else with_camera(scene, before.block)
        if block is not None:
            parts.keep_all()
            return LoadedScene(engine.LoadedScene(block, before.core, True), before.reports, tables, block, parts)
    block, reports = lower(scene, parts)
    parts.release()
    parts.count("tables", is_built=True)
    is_same = before is not None and alone and same(shapes_alone(tables), shapes_alone(before.tables))
    parts.count("structure", is_built=not is_same)
    core = engine.LoadedScene(block, None if before is None else before.core, is_same)
    return LoadedScene(core, reports, tables, block, parts)


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
