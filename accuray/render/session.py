"""Rendering an image: passes over all tiles until the samples asked for are in the film."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray import devices
from accuray.film import Film, Image, channels_with
from accuray.render.metadata import image_metadata
from accuray.scene import Scene

POLL_SECONDS = 0.02
LARGEST_PASS = 64
ERROR_INTERVAL = 0.5


@dataclass(frozen=True)
class Progress:
    """How far a render is. ``done`` and ``total`` in samples per pixel; times in seconds; ``error`` is the estimated
    relative error of the picture, None until there is an estimate; ``eta`` is the time left, None at the start.
    """

    done: int
    total: int
    elapsed: float
    eta: float | None
    rays: int
    samples_per_second: float
    rays_per_second: float
    error: float | None


def render(
    scene: Scene,
    *,
    spp: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    samples: tuple[int, int] | None = None,
    crop: tuple[int, int, int, int] | None = None,
    layers: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    on_interrupt: str = "raise",
) -> Image:
    """Renders a scene.

    The pixels depend on the scene, the seed and the sample numbers alone, bit for bit: not on threads or passes.

    Args:
        scene: from ``accuray.load`` or ``accuray.Scene.from_dict``.
        spp: samples per pixel; default: the scene's.
        seed: 0 to 2^32 - 1; default: the scene's.
        threads: default: all processors that this process may use.
        samples: (first, end), renders these sample numbers in place of 0 to spp.
        crop: (x0, y0, x1, y1) in pixels, half open.
        layers: what the image holds besides its colours, of "indirect"; default: the scene's. The colours have the same
            bits with and without.
        progress: is called now and then.
        on_interrupt: "raise" lets KeyboardInterrupt through at once; "return" gives the image so far, whose
            metadata then say ``interrupted``.

    Raises:
        SceneError: what only lowering can find wrong with the scene.
        ValueError: an argument out of range.
        OverflowError: a pixel's sum left 64 bits.
        KeyboardInterrupt: see ``on_interrupt``.
    """
    if on_interrupt not in ("raise", "return"):
        raise ValueError(f"on_interrupt is {on_interrupt!r}: allowed are 'raise' and 'return'")
    first, end = sample_range(scene, spp, samples)
    seed = seed_of(scene, seed)
    channels = channels_with(scene.render["layers"] if layers is None else layers)
    session = _Session(scene, (first, end), seed, crop, channels, thread_count(threads), progress)
    interrupted = False
    try:
        session.run()
    except KeyboardInterrupt:
        if on_interrupt == "raise":
            raise
        interrupted = True
    metadata = image_metadata(scene, seed=seed, seconds=session.elapsed(), rays=session.rays, reports=session.reports)
    if interrupted:
        metadata["interrupted"] = True
    return Image(session.film, metadata)


def thread_count(threads: int | None) -> int:
    """The number given, at least 1; by default the processors that this process may use."""
    if threads is not None:
        if threads < 1:
            raise ValueError(f"threads is {threads}: it must be at least 1")
        return threads
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def sample_range(scene: Scene, spp: int | None, samples: tuple[int, int] | None) -> tuple[int, int]:
    """The sample numbers (first, end) of every pixel: those asked for, else 0 to the scene's ``spp``."""
    first, end = samples or (0, scene.render["spp"] if spp is None else spp)
    if not 0 <= first < end < 2**32:
        raise ValueError(f"samples {first}:{end} are not a range within 0 to {2**32 - 1}")
    return first, end


def seed_of(scene: Scene, seed: int | None) -> int:
    """The seed asked for, else the scene's."""
    chosen: int = scene.render["seed"] if seed is None else seed
    if not 0 <= chosen < 2**32:
        raise ValueError(f"seed is {chosen}: allowed are 0 to {2**32 - 1}")
    return chosen


class _Session:
    """One render: its film, and the passes that fill it."""

    def __init__(
        self,
        scene: Scene,
        samples: tuple[int, int],
        seed: int,
        crop: tuple[int, int, int, int] | None,
        channels: tuple[str, ...],
        threads: int,
        progress: Callable[[Progress], None] | None,
    ) -> None:
        loaded = devices.load(scene)
        self.scene, self.loaded, self.reports = scene, loaded, loaded.reports
        self.first, self.end = samples
        self.seed, self.threads, self.progress = seed, threads, progress
        self.film = Film.empty(
            scene.film["width"],
            scene.film["height"],
            window=crop,
            replicates=scene.render["replicates"],
            step=scene.film["unit"],
            channels=channels,
        )
        height, width = self.film.shape
        self.blocks = (-(-height // 16), -(-width // 16))
        self.rays = 0
        self._started = perf_counter()
        self._error: float | None = None
        self._error_due = 0.0

    def elapsed(self) -> float:
        """Seconds since rendering began."""
        return perf_counter() - self._started

    def run(self) -> None:
        """Passes of growing size, each a multiple of the replicates, until the end."""
        first, size = self.first, self.film.replicates
        while first < self.end:
            count = min(size, self.end - first)
            self._pass(first, count)
            first += count
            size = min(2 * size, LARGEST_PASS)

    def _pass(self, first: int, count: int) -> None:
        tiles = self.blocks[0] * self.blocks[1]
        core = self.loaded.render_pass(
            self.film, list(range(tiles)), first, count, seed=self.seed, threads=self.threads
        )
        try:
            while not core.wait(POLL_SECONDS):
                self._report(first - self.first + count * core.done / tiles, core.rays)
        except BaseException:
            core.stop()
            while not core.wait(POLL_SECONDS):
                pass
            self._cover_finished(first, count, core.finished)
            raise
        self.rays += core.rays
        self.film.cover(first, first + count)
        self._report(first - self.first + count, 0, at_end=True)

    def _cover_finished(self, first: int, count: int, finished: NDArray[np.uint8]) -> None:
        """Enters the tiles that an interrupted pass had completed."""
        mask = finished.astype(bool).reshape(self.blocks)
        if mask.any():
            self.film.cover(first, first + count, None if mask.all() else mask)

    def _report(self, done: float, rays_now: int, *, at_end: bool = False) -> None:
        if self.progress is None:
            return
        elapsed = self.elapsed()
        total = self.end - self.first
        rays = self.rays + rays_now
        if at_end and (elapsed >= self._error_due or done >= total):
            self._error = self._estimate()
            self._error_due = self.elapsed() + ERROR_INTERVAL
        height, width = self.film.shape
        self.progress(
            Progress(
                done=int(done),
                total=total,
                elapsed=elapsed,
                eta=elapsed * (total - done) / done if done > 0 else None,
                rays=rays,
                samples_per_second=done * height * width / elapsed,
                rays_per_second=rays / elapsed,
                error=self._error,
            )
        )

    def _estimate(self) -> float | None:
        error = Image(self.film, self._colour_metadata()).relative_error
        return error if np.isfinite(error) else None

    def _colour_metadata(self) -> dict[str, Any]:
        return image_metadata(self.scene, seed=self.seed, seconds=0.0, rays=0, reports={})
