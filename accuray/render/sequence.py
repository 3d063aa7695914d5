"""Frame after frame of an animation: what is found finished is kept, the rest is rendered and saved."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from accuray.film import Image, ImageError, channels_with
from accuray.film.coverage import SampleRange
from accuray.render.frames import frame_path, parse_frames
from accuray.render.metadata import image_metadata
from accuray.render.session import Progress, render, sample_range, seed_of
from accuray.scene import Scene

SAME = {
    "scene_hash": "another scene",
    "seed": "another seed",
    "version": "another version of AccuRay",
    "exposure": "another exposure",
    "white_balance": "another white balance",
    "hide_environment": "another background",
}
"""Metadata that a finished frame shares with a new one, and what it has otherwise."""


class FoundFrame(NamedTuple):
    """What the file of a frame holds: its finished image, or ``problem``, which is "" if there is no file."""

    image: Image | None
    problem: str


@dataclass(frozen=True)
class Frame:
    """A frame of an animation: its number, scene and image.

    ``path`` is its EXR, None if it was not saved. ``skipped``: the file was there and finished. ``problem``: why a file
    that was there has been replaced, "" if there was none.
    """

    number: int
    scene: Scene
    image: Image
    path: Path | None = None
    skipped: bool = False
    problem: str = ""


def find_frame(
    path: str | os.PathLike[str],
    scene: Scene,
    *,
    spp: int | None = None,
    seed: int | None = None,
    samples: tuple[int, int] | None = None,
    crop: tuple[int, int, int, int] | None = None,
    layers: Sequence[str] | None = None,
) -> FoundFrame:
    """What ``path`` holds of the image that ``accuray.render`` with the same arguments makes.

    It is finished if it has the same scene, seed, samples, window, layers, and look, and comes from this version.
    """
    if not Path(path).exists():
        return FoundFrame(None, "")
    try:
        image = Image.load(path)
    except ImageError as error:
        return FoundFrame(None, error.reason)
    wanted = image_metadata(scene, seed=seed_of(scene, seed), seconds=0.0, rays=0, reports={})
    for key, other in SAME.items():
        if image.metadata.get(key) != wanted[key]:
            return FoundFrame(None, f"holds {other}")
    film = image.film
    window = crop or (0, 0, scene.film["width"], scene.film["height"])
    if film.window != window or film.channels != channels_with(scene.render["layers"] if layers is None else layers):
        return FoundFrame(None, "holds another part of the picture or other layers")
    if film.coverage != [SampleRange(*sample_range(scene, spp, samples))]:
        return FoundFrame(None, "holds other samples, or was interrupted")
    return FoundFrame(image, "")


def render_frames(
    scene: Scene,
    frames: str | Iterable[int],
    *,
    output: str | os.PathLike[str] | None = None,
    spp: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    samples: tuple[int, int] | None = None,
    crop: tuple[int, int, int, int] | None = None,
    layers: Sequence[str] | None = None,
    progress: Callable[[int, Progress], None] | None = None,
) -> Iterator[Frame]:
    """Renders frames of an animation one after the other, and yields each when it is done.

    Between frames the scene stays resident: only what changed is built anew. A frame has the same bits as if it were
    rendered alone.

    Args:
        scene: any frame of the animation, from ``accuray.load`` or ``accuray.Scene.from_dict``.
        frames: a list such as ``"1-100x2"`` (see ``accuray.parse_frames``), or numbers.
        output: name of the EXR files, as in ``"out/frame.####.exr"``; a PNG is put beside each. Frames whose file is
            finished are not rendered again. None saves nothing.
        spp: as for ``accuray.render``, like the arguments after it.
        seed: the same for all frames; give each its own by calling this for one frame at a time.
        threads: of each frame.
        samples: (first, end) of each frame.
        crop: (x0, y0, x1, y1) in pixels, half open.
        layers: what the images hold besides their colours.
        progress: is called now and then with the number of the frame.

    Raises:
        ValueError: a list of frames that is none, or an argument of ``accuray.render`` out of range.
        SceneError: a frame of the scene is wrong.
        ImageError: a file cannot be written.
        KeyboardInterrupt: at once; finished frames are saved.
    """
    numbers = parse_frames(frames) if isinstance(frames, str) else tuple(frames)
    options: dict[str, Any] = {"spp": spp, "seed": seed, "samples": samples, "crop": crop, "layers": layers}
    for number in numbers:
        frame = scene.at(number)
        path = None if output is None else frame_path(output, number)
        found = FoundFrame(None, "") if path is None else find_frame(path, frame, **options)
        image = found.image
        if image is None:
            image = render(frame, threads=threads, progress=_of_frame(progress, number), **options)
            if path is not None:
                image.save(path)
        if path is not None and (found.image is None or not path.with_suffix(".png").exists()):
            image.save(path.with_suffix(".png"))
        yield Frame(number, frame, image, path, found.image is not None, found.problem)


def _of_frame(progress: Callable[[int, Progress], None] | None, number: int) -> Callable[[Progress], None] | None:
    return None if progress is None else lambda state: progress(number, state)
