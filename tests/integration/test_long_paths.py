"""Paths of a hundred thousand bounces, and renders that are interrupted."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from fair import FOLDER, Table

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.film.coverage import pixel_mask

DEPTH = 100_000
ENDLESS = 10**7
"""Samples per pixel that no test waits for."""
AT_ONCE = 1.0
"""Seconds of CPU time, of all threads together, that a render may still take after an interrupt: its work, whatever
else the machine is busy with."""


def mirror_room(depth: int = DEPTH, size: int = 2, **film: int) -> accuray.Scene:
    """A closed box of perfect mirrors that glow with radiance 1: each bounce adds 1 to what the camera sees."""
    corners = [[x, y, z] for z in (0.0, 1.5) for y in (0.0, 1.2) for x in (0.0, 2.0)]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    mirror: Table = {"type": "conductor", "metal": "perfect", "emission": 1, "emission_sides": "both"}
    return accuray.Scene.from_dict(
        {
            "film": {"width": size, "height": size, "filter": {"type": "box"}, "unit": 2.0**-20, **film},
            "camera": {"type": "perspective", "position": [0.6, 0.5, 0.7], "look_at": [1.7, 0.8, 1.3], "fov": 70},
            "integrator": {"type": "path", "max_depth": depth, "roulette_depth": 1_000_000},
            "materials": {"mirror": mirror},
            "shapes": {"room": {"type": "mesh", "positions": corners, "faces": faces, "material": "mirror"}},
        }
    )


@pytest.mark.parametrize("depth", [1, 1000, DEPTH])
def test_mirror_room(depth: int) -> None:
    """No bounce is lost at an edge, no counter wraps, no stack grows: the sum is exact."""
    origins = np.tile([0.6, 0.5, 0.7], (16, 1))
    directions = np.random.default_rng(3).normal(size=(16, 3))
    found = accuray.radiance(mirror_room(depth), origins, directions, 1, wavelengths=[550.0]).mean
    assert found == pytest.approx(depth + 1.0, rel=1e-6)


def test_mirror_room_in_an_image() -> None:
    luminance = accuray.render(mirror_room(), spp=4).film.mean()[:, :, 1]
    assert luminance.mean() == pytest.approx(DEPTH + 1.0, rel=0.2)  # the four wavelengths of a sample are noisy


def test_roulette_alone_ends_paths_in_glass_shells() -> None:
    """Ten nested interfaces, no largest depth, roulette from the first bounce on: no bias in a white furnace."""
    shells = {f"shell{i}": {"type": "sphere", "radius": 1 - 0.05 * i, "material": "glass"} for i in range(10)}
    scene = accuray.Scene.from_dict(
        {
            "film": {"width": 16, "height": 16},
            "integrator": {"type": "path", "roulette_depth": 1},
            "materials": {"glass": {"type": "dielectric", "ior": 1.5}},
            "shapes": shells,
            "lights": {"sky": {"type": "constant"}},
        }
    )
    image = accuray.render(scene, spp=64)
    assert image.film.dropped_total == 0
    assert image.film.mean()[:, :, 1].mean() == pytest.approx(1.0, rel=0.02)


@pytest.fixture
def interrupt_after() -> Iterator[Callable[[float], dict[str, float]]]:
    """Sends SIGINT to this process after some seconds; the dictionary tells how much CPU time it had used by then."""
    timers: list[threading.Timer] = []

    def start(seconds: float) -> dict[str, float]:
        sent: dict[str, float] = {}

        def send() -> None:
            sent["at"] = time.process_time()
            signal.raise_signal(signal.SIGINT)

        timers.append(threading.Timer(seconds, send))
        timers[-1].start()
        return sent

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield start
    for timer in timers:
        timer.cancel()
        timer.join()
    signal.signal(signal.SIGINT, before)


def small(name: str, **overrides: object) -> accuray.Scene:
    return accuray.load(FOLDER / f"{name}.toml", overrides={"film.width": 80, "film.height": 56, **overrides})


SCENES: dict[str, Callable[[], accuray.Scene]] = {
    "cornell-box": lambda: small("cornell-box"),
    "closed-box": lambda: small("closed-box"),
    "large image": lambda: small("spheres", **{"film.width": 1920, "film.height": 1080}),
    "mirror room": lambda: mirror_room(size=64),
}


@pytest.mark.parametrize("name", SCENES)
def test_interrupt_ends_a_render_at_once(name: str, interrupt_after: Callable[[float], dict[str, float]]) -> None:
    scene = SCENES[name]()
    sent = interrupt_after(0.4)
    with pytest.raises(KeyboardInterrupt):
        accuray.render(scene, spp=ENDLESS)
    assert time.process_time() - sent["at"] < AT_ONCE


def test_interrupt_within_a_pixel(interrupt_after: Callable[[float], dict[str, float]]) -> None:
    """One pixel whose samples are long paths, when passes have grown to 64 samples: a sample is the longest wait."""
    sent: list[dict[str, float]] = []

    def interrupt_in_the_largest_pass(progress: accuray.Progress) -> None:
        if progress.done >= 60 and not sent:
            sent.append(interrupt_after(0.05))  # time enough to return from here

    with pytest.raises(KeyboardInterrupt):
        accuray.render(mirror_room(size=1), spp=ENDLESS, progress=interrupt_in_the_largest_pass)
    assert time.process_time() - sent[0]["at"] < AT_ONCE


def test_interrupt_ends_a_probe_at_once(interrupt_after: Callable[[float], dict[str, float]]) -> None:
    scene = small("cornell-box")
    origins = np.tile([0.278, 0.273, 0.1], (1000, 1))
    sent = interrupt_after(0.4)
    with pytest.raises(KeyboardInterrupt):
        accuray.radiance(scene, origins, np.tile([0.0, 0.0, 1.0], (1000, 1)), ENDLESS)
    assert time.process_time() - sent["at"] < AT_ONCE


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("name", ["cornell-box", "closed-box"])
def test_interrupted_image_holds_whole_blocks(
    name: str, threads: int, interrupt_after: Callable[[float], dict[str, float]]
) -> None:
    """Each 16x16 block has the bits of a render that stops at the block's own number of samples."""
    scene = small(name)
    interrupt_after(0.5)
    image = accuray.render(scene, spp=ENDLESS, threads=threads, on_interrupt="return")
    assert image.metadata["interrupted"] is True
    counts = image.layers["samples"]
    assert 4 <= counts.min() <= counts.max() < ENDLESS
    assert np.isfinite(np.asarray(image)).all()
    for spp in np.unique(counts):
        whole = accuray.render(scene, spp=int(spp))
        held = counts == spp
        assert np.array_equal(image.film.sums[held], whole.film.sums[held])
        assert np.array_equal(np.asarray(image)[held], np.asarray(whole)[held])


def test_interrupted_image_can_be_completed(interrupt_after: Callable[[float], dict[str, float]]) -> None:
    """What every pixel has, and the samples after it, merge to the bits of one render."""
    scene = small("cornell-box")
    interrupt_after(0.5)
    image = accuray.render(scene, spp=ENDLESS, on_interrupt="return")
    film = image.film
    full = max((r.end for r in film.coverage if r.mask is None), default=0)
    partial = [r for r in film.coverage if r.mask is not None]
    assert all(r.first >= full for r in partial)
    end = max(r.end for r in film.coverage)
    for mask_range in partial:
        missing = ~pixel_mask(mask_range.mask, film.shape)
        for y in range(0, film.shape[0], 16):
            for x in range(0, film.shape[1], 16):
                if missing[y, x]:
                    window = (x, y, min(x + 16, film.shape[1]), min(y + 16, film.shape[0]))
                    part = accuray.render(scene, samples=(mask_range.first, mask_range.end), crop=window)
                    image = accuray.Image.merge([image, part])
    assert image.film.identical(accuray.render(scene, spp=end).film)
