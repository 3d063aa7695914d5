"""A stand-in for the public API, so that the command line is tested for what it asks of the engine and how it answers.

`tests/cli/test_end_to_end.py` runs the real one.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest


class FakeSceneError(ValueError):
    """As accuray.SceneError."""


class FakeImageError(ValueError):
    """As accuray.ImageError."""


class FakeImage:
    """An image whose files hold its metadata as text."""

    def __init__(self, samples: tuple[int, int], dropped: int = 0) -> None:
        coverage = [SimpleNamespace(first=samples[0], end=samples[1], mask=None)]
        self.film = SimpleNamespace(
            coverage=coverage,
            dropped_total=dropped,
            width=200,
            height=100,
            window=(0, 0, 200, 100),
            replicates=4,
            step=2.0**-24,
            layers=(),
        )
        counts = SimpleNamespace(min=lambda: samples[1] - samples[0], max=lambda: samples[1] - samples[0])
        self.layers = {"samples": counts}
        self.relative_error = 0.018
        self.metadata: dict[str, Any] = {"seed": 7, "scene_hash": "cafe", "white_balance": [0.9, 1.0, 0.8]}

    def save(self, path: Path) -> None:
        """Writes the metadata where a real image writes pixels."""
        Path(path).write_text(json.dumps(self.metadata), encoding="utf-8")


class FakeEngine:
    """Records what the command line asks for; `on_render` is what a render does."""

    def __init__(self) -> None:
        self.loaded: list[tuple[Path, list[str]]] = []
        self.rendered: list[dict[str, Any]] = []
        self.images: dict[str, FakeImage] = {}
        self.on_render: Callable[[dict[str, Any]], None] = lambda _: None
        self.dropped = 0
        self.mesh_reports: dict[str, dict[str, int]] = {}
        self.finished = True

    def load(self, path: Path, overrides: list[str] | None = None) -> SimpleNamespace:
        """As accuray.load; a file named broken is one."""
        if Path(path).stem == "broken":
            raise FakeSceneError(f"{path}:3: film.width: -1 is out of range")
        self.loaded.append((path, overrides or []))
        return SimpleNamespace(
            film={"width": 200, "height": 100},
            render={"spp": 16, "seed": 0, "replicates": 4},
            camera={"type": "perspective"},
            integrator={"type": "path"},
            filter={"type": "gaussian"},
            shapes={"a": {"type": "mesh"}, "b": {"type": "sphere"}, "c": {"type": "mesh"}},
            materials={},
            lights={"sky": {"type": "constant"}},
            identity="feed",
            model_notes=(),
        )

    def render(self, _scene: object, **arguments: Any) -> FakeImage:
        """As accuray.render: reports progress twice, to whom wants it."""
        self.rendered.append(arguments)
        total = arguments["spp"] or 16
        try:
            for done in (total // 2, total):
                if arguments["progress"] is not None:
                    arguments["progress"](progress(done, total))
                self.on_render(arguments)
        except KeyboardInterrupt:
            if arguments["on_interrupt"] != "return":
                raise
        image = FakeImage(arguments["samples"] or (0, total), self.dropped)
        image.metadata["mesh_reports"] = self.mesh_reports
        if not self.finished:
            image.film.coverage.clear()
        return image

    def load_image(self, path: Path) -> FakeImage:
        """As accuray.Image.load, from the images the test has put in."""
        if str(path) not in self.images:
            raise FakeImageError(f"{path}: not an EXR written by AccuRay")
        return self.images[str(path)]


def progress(done: int, total: int, **others: Any) -> SimpleNamespace:
    """A state of progress as accuray.render reports it."""
    values: dict[str, Any] = {
        "done": done,
        "total": total,
        "elapsed": 12.4,
        "eta": 22.0,
        "rays": 5_200_000,
        "rays_per_second": 5.2e6,
        "samples_per_second": 1.5e6,
        "error": 0.018,
    }
    return SimpleNamespace(**values | others)


def probe_writable(path: Path) -> None:
    """As accuray.probe_writable."""
    if not Path(path).parent.is_dir():
        raise FakeImageError(f"{path}: cannot be written: there is no folder {Path(path).parent}")


def merge_images(images: list[FakeImage], *, mixed: bool = False) -> FakeImage:
    """As accuray.Image.merge: the images must follow each other."""
    a, b = (image.film.coverage[0] for image in images)
    if a.end != b.first:
        raise FakeImageError("both films hold the same samples")
    merged = FakeImage((a.first, b.end))
    merged.metadata["mixed"] = mixed
    return merged


def install(monkeypatch: pytest.MonkeyPatch) -> FakeEngine:
    """Puts a fake engine in the place of the public API for one test."""
    import accuray

    engine = FakeEngine()
    for name, value in {
        "load": engine.load,
        "render": engine.render,
        "Image": SimpleNamespace(load=engine.load_image, merge=merge_images),
        "SceneError": FakeSceneError,
        "ImageError": FakeImageError,
        "probe_writable": probe_writable,
    }.items():
        monkeypatch.setattr(accuray, name, value, raising=False)
    return engine
