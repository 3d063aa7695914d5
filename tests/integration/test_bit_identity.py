"""The same bits whatever the number of threads, the order and grouping of the work, and the number of processes.

On every shipped scene and the zoo, small and of an odd size, with their own filters: what an EXR holds for viewers is
compared bit by bit, and the film's sums behind it. Only another seed, or another sample, may change them.
"""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from fair import all_scenes, scene_file
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray import devices
from accuray.cli import main
from accuray.film import Film, Image, channels_with

SPP = 64
WIDTH, HEIGHT = 40, 24
TILES = 6
"""16x16 tiles of such an image, the last ones of each row and column cut off."""
SEED = 5
OVERRIDES = (f"film.width={WIDTH}", f"film.height={HEIGHT}", f"render.spp={SPP}", f"render.seed={SEED}")

every_scene = pytest.mark.parametrize("name", all_scenes())


@functools.cache
def scene(name: str) -> accuray.Scene:
    return accuray.load(scene_file(name), overrides=OVERRIDES)


@functools.cache
def whole(name: str) -> Image:
    """The image that all others are compared with: one thread, all samples."""
    return accuray.render(scene(name), threads=1)


def command(name: str, *more: str) -> list[str]:
    """Arguments of `accuray` that render the same image."""
    settings = [word for text in OVERRIDES for word in ("-D", text)]
    return ["render", "-q", str(scene_file(name)), *settings, *more]


def pixel_bits(path: Path) -> dict[str, NDArray[np.uint32]]:
    """Channels of the part of an EXR that viewers show, as raw bits."""
    part = next(p for p in OpenEXR.File(str(path), separate_channels=True).parts if p.header["name"] == "rgba")
    return {name: channel.pixels.view(np.uint32) for name, channel in part.channels.items()}


def assert_same_bits(mine: Path, theirs: Path) -> None:
    a, b = pixel_bits(mine), pixel_bits(theirs)
    assert set(a) == set(b) >= {"R", "G", "B", "A", "samples", "error.R"}
    assert [name for name in a if not np.array_equal(a[name], b[name])] == []


def empty_film(name: str) -> Film:
    """A film of no samples, with the layers that the scene asks for."""
    render = scene(name).render
    channels = channels_with(render["layers"])
    return Film.empty(WIDTH, HEIGHT, replicates=render["replicates"], step=scene(name).film["unit"], channels=channels)


def rendered_by(passes: list[tuple[list[int], int, int]], name: str, threads: int = 2) -> Film:
    """The film after the passes (tiles, first sample, count), one after the other, on the bare engine."""
    loaded = devices.load(scene(name))
    film = empty_film(name)
    for tiles, first, count in passes:
        core = loaded.render_pass(film, tiles, first, count, seed=SEED, threads=threads)
        while not core.wait(1.0):
            pass
    film.cover(0, SPP)
    return film


@every_scene
@pytest.mark.parametrize("threads", [2, 3, 8])
def test_threads(name: str, threads: int) -> None:
    image = accuray.render(scene(name), threads=threads)
    assert image.film.identical(whole(name).film)
    assert image.pixels_equal(whole(name))


EVERY = list(range(TILES))
WORK: dict[str, list[tuple[list[int], int, int]]] = {
    "one pass": [(EVERY, 0, SPP)],
    "last tile first": [(EVERY[::-1], 0, SPP)],
    "single tiles": [([tile], 0, SPP) for tile in (3, 0, 5, 1, 4, 2)],
    "sample by sample": [(EVERY, i, 1) for i in range(SPP)],
    "uneven chunks backwards": [(EVERY, 47, 17), (EVERY, 46, 1), (EVERY, 3, 43), (EVERY, 0, 3)],
    "halves crossed": [(EVERY[::2], 0, 31), (EVERY[1::2], 31, 33), (EVERY[1::2], 0, 31), (EVERY[::2], 31, 33)],
}


@every_scene
@pytest.mark.parametrize("work", WORK)
def test_grouping_of_the_work(name: str, work: str) -> None:
    assert rendered_by(WORK[work], name).identical(whole(name).film)


@every_scene
def test_passes_side_by_side(name: str) -> None:
    """Two passes over one loaded scene at once, each with threads of its own, into one film."""
    loaded = devices.load(scene(name))
    film = empty_film(name)
    running = [loaded.render_pass(film, EVERY[k::2], 0, SPP, seed=SEED, threads=2) for k in (0, 1)]
    while not all(core.wait(0.01) for core in running):
        pass
    film.cover(0, SPP)
    assert film.identical(whole(name).film)


CROPS = {
    "tiles of 16": [(x, y, min(x + 16, WIDTH), min(y + 16, HEIGHT)) for x in (0, 16, 32) for y in (0, 16)],
    "tiles of 13 by 7": [
        (x, y, min(x + 13, WIDTH), min(y + 7, HEIGHT)) for x in range(0, WIDTH, 13) for y in range(0, HEIGHT, 7)
    ],
    "rows": [(0, y, WIDTH, y + 1) for y in range(HEIGHT)],
    "one pixel apart": [(0, 0, 17, 11), (0, 11, 17, HEIGHT), (17, 0, 18, HEIGHT), (18, 0, WIDTH, HEIGHT)],
}


@every_scene
@pytest.mark.parametrize("crops", CROPS)
def test_tiles_of_any_size(name: str, crops: str) -> None:
    """Each crop equals its part of the whole image, and all of them merge to it."""
    parts = [accuray.render(scene(name), crop=crop) for crop in CROPS[crops]]
    for part, (x0, y0, x1, y1) in zip(parts, CROPS[crops], strict=True):
        assert part.film.window == (x0, y0, x1, y1)
        assert np.array_equal(part.film.sums, whole(name).film.sums[y0:y1, x0:x1])
        assert np.array_equal(np.asarray(part), np.asarray(whole(name))[y0:y1, x0:x1])
    merged = Image.merge(parts)
    assert merged.film.identical(whole(name).film)
    assert merged.pixels_equal(whole(name))


@every_scene
def test_sample_ranges_merge_to_the_whole(name: str, tmp_path: Path) -> None:
    parts = [accuray.render(scene(name), samples=(a, b), threads=t) for a, b, t in ((16, 64, 3), (0, 16, 2))]
    merged = Image.merge(parts)
    assert merged.film.identical(whole(name).film)
    merged.save(tmp_path / "merged.exr")
    whole(name).save(tmp_path / "whole.exr")
    assert_same_bits(tmp_path / "merged.exr", tmp_path / "whole.exr")


def in_process(arguments: list[str]) -> None:
    assert main(arguments) == 0


def as_process(arguments: list[str]) -> None:
    subprocess.run([sys.executable, "-m", "accuray", *arguments], check=True, timeout=300)


def check_command_line(name: str, folder: Path, run: Callable[[list[str]], None]) -> None:
    files = {key: folder / f"{key}.exr" for key in ("one", "first", "rest", "merged", "whole")}
    run(command(name, "-t", "3", "-o", str(files["one"])))
    run(command(name, "-t", "1", "--samples", "0:16", "-o", str(files["first"])))
    run(command(name, "-t", "8", "--samples", "16:64", "-o", str(files["rest"])))
    run(["merge", "-q", str(files["rest"]), str(files["first"]), "-o", str(files["merged"])])
    whole(name).save(files["whole"])
    assert_same_bits(files["merged"], files["one"])
    assert_same_bits(files["whole"], files["one"])


@every_scene
def test_command_line(name: str, tmp_path: Path) -> None:
    check_command_line(name, tmp_path, in_process)


def test_processes(tmp_path: Path) -> None:
    """The same by processes of their own: nothing that a process inherits or finds at random gets in."""
    check_command_line("mirror-and-glass", tmp_path, as_process)


@every_scene
def test_repeated_files_are_equal(name: str, tmp_path: Path) -> None:
    for file, threads in (("a.exr", 1), ("b.exr", 2)):
        accuray.render(scene(name), threads=threads).save(tmp_path / file, omit_time=True)
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


@every_scene
def test_a_file_gives_back_every_bit(name: str, tmp_path: Path) -> None:
    whole(name).save(tmp_path / "whole.exr")
    loaded = Image.load(tmp_path / "whole.exr")
    assert loaded.film.identical(whole(name).film)
    assert loaded.pixels_equal(whole(name))


@every_scene
def test_seeds_and_samples_differ(name: str) -> None:
    """Other seeds and other samples give other images, pixel by pixel, of scenes that have noise."""
    first = whole(name).film.sums
    others = (
        accuray.render(scene(name), seed=SEED + 1).film.sums,
        accuray.render(scene(name), samples=(SPP, 2 * SPP)).film.sums,
    )
    for other in others:
        assert (first != other).any(axis=(2, 3)).mean() > 0.5
