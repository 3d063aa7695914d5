"""`accuray render --frames`: an animation becomes an EXR and a PNG for each frame."""

from __future__ import annotations

import json
import shlex
import sys
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from .interrupts import Interrupts
from .output import probe, save
from .render import COMMAND, crop_window, defects, note, overrides, render, render_arguments, warn

if TYPE_CHECKING:
    import accuray


@dataclass
class Tally:
    """How many frames there are, have been rendered, and were found finished."""

    frames: int
    rendered: int = 0
    skipped: int = 0

    def __str__(self) -> str:
        left = self.frames - self.rendered - self.skipped
        text = f"{self.frames} frames: {self.rendered} rendered, {self.skipped} finished before"
        return f"{text}, {left} left" if left else text


def run_frames(options: Namespace) -> int:
    """Renders the frames that are not finished yet, one after the other.

    SIGINT and SIGTERM end the frame that is rendered early, as they end a single picture: it is written, and the next
    call with the same arguments renders it anew.
    """
    import accuray

    pattern = Path(options.output or f"{options.scene.stem}.exr")
    arguments = render_arguments(options)
    paths = {frame: accuray.frame_path(pattern, frame) for frame in options.frames}
    for path in paths.values():
        probe(path, COMMAND)
    tally = Tally(len(paths))
    with Interrupts() as interrupts:
        try:
            with interrupts.interruptible():
                scene = accuray.load(options.scene, overrides=overrides(options), frame=options.frames[0])
            for text in () if options.quiet else scene.model_notes:
                warn(options, f"not translated: {text}")
            for frame, path in paths.items():
                with interrupts.interruptible():
                    scene = scene.at(frame)
                _one_frame(scene, frame, path, options, arguments, interrupts, tally)
                if interrupts.status:
                    warn(options, f"interrupted; frame {frame} so far has been written")
                    break
        except KeyboardInterrupt:
            warn(options, "interrupted")
    _summarise(tally, options)
    return interrupts.status


def _one_frame(
    scene: accuray.Scene,
    frame: int,
    path: Path,
    options: Namespace,
    arguments: dict[str, Any],
    interrupts: Interrupts,
    tally: Tally,
) -> None:
    """Renders and writes a frame unless its file is finished. Raises KeyboardInterrupt before there is an image."""
    import accuray

    asked = {key: value for key, value in arguments.items() if key != "threads"}
    with interrupts.interruptible():
        crop = crop_window(options, scene.film["width"], scene.film["height"])
        found = accuray.find_frame(path, scene, crop=crop, **asked)
    if found.image is not None:
        tally.skipped += 1
        note(options, f"frame {frame}: {path} is finished")
        if not path.with_suffix(".png").exists():
            save(found.image, path)
        return
    if found.problem:
        warn(options, f"frame {frame}: {path} {found.problem}, and is replaced")
    started = perf_counter()
    image = render(scene, options, arguments, interrupts, frame)
    if not image.film.coverage:
        raise KeyboardInterrupt
    image.metadata["command"] = shlex.join(["accuray", *sys.argv[1:]])
    written = save(image, path)
    tally.rendered += not image.metadata.get("interrupted", False)
    note(options, f"frame {frame}: identity {scene.identity}, {perf_counter() - started:.2f} s")
    for text in defects(image):
        warn(options, f"frame {frame}: {text}")
    if not options.quiet:
        print(*written, sep="\n", flush=True)


def _summarise(tally: Tally, options: Namespace) -> None:
    """Says on standard error what became of the frames."""
    if options.progress == "json":
        print(json.dumps(vars(tally)), file=sys.stderr)
    elif not options.quiet:
        print(f"accuray: {tally}", file=sys.stderr)
