"""`accuray render`: a scene file becomes an EXR and, beside it, a PNG."""

from __future__ import annotations

import json
import math
import shlex
import sys
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from .interrupts import Interrupts
from .output import add_output_flag, probe, save
from .parser import (
    Parser,
    UsageError,
    fractions_of_image,
    frame_list,
    names,
    override,
    pixel_bounds,
    sample_range,
    whole_number,
)
from .progress import choose_display
from .threads import thread_count

if TYPE_CHECKING:
    import accuray

SUMMARY = "Render a scene to an EXR and a PNG."
COMMAND = "accuray render"

# What a mesh may lose, by its name in the image's metadata.
LOSSES = {
    "nonfinite_triangles": "triangles with a vertex that is not finite",
    "degenerate_triangles": "triangles without area",
}


def configure(parser: Parser) -> None:
    """Adds the flags of `accuray render`."""
    add = parser.add_argument
    add(
        "scene",
        metavar="SCENE",
        type=Path,
        help="scene file, .toml or .json; or a model: .gltf, .glb, .obj, .ply, .stl",
    )
    add_output_flag(parser, required=False)
    what = parser.add_argument_group("what to render")
    what.add_argument("--spp", metavar="N", type=whole_number(1), help="samples per pixel (default: the scene's)")
    what.add_argument(
        "--samples",
        metavar="A:B",
        type=sample_range,
        help="render only the samples A to B-1 of each pixel; `accuray merge` adds the parts up, exactly",
    )
    what.add_argument("--seed", metavar="N", type=whole_number(0), help="seed of all random numbers")
    what.add_argument("-w", "--width", metavar="W", type=whole_number(1), help="width of the image in pixels")
    what.add_argument("--height", metavar="H", type=whole_number(1), help="height of the image in pixels")
    part = what.add_mutually_exclusive_group()
    crop_help = "render only this part, in fractions of the image from its upper left corner"
    part.add_argument("--crop", metavar="x0,x1,y0,y1", type=fractions_of_image, help=crop_help)
    part.add_argument("--pixel-bounds", metavar="x0,x1,y0,y1", type=pixel_bounds, help="the same in pixels")
    what.add_argument(
        "--layers",
        metavar="NAME,...",
        type=names,
        help="further layers of the image, of: indirect (light scattered more than once on its way to the camera)",
    )
    what.add_argument(
        "--frames",
        metavar="LIST",
        type=frame_list,
        help="frames of an animation, as in 5, 1-100, 1-100x2 (every second one) or 1-3,7; --frames=-5--1 from -5 to "
        "-1. Each #### in OUT.exr becomes the number; frames that are finished are skipped",
    )
    what.add_argument(
        "-D",
        dest="overrides",
        metavar="key=value",
        type=override,
        action="append",
        default=[],
        help="set a value of the scene, as in film.exposure=1 (may be repeated)",
    )
    how = parser.add_argument_group("how to render and report")
    how.add_argument(
        "-t",
        "--threads",
        metavar="N",
        type=whole_number(1),
        help="number of threads (default: ACCURAY_THREADS, else all processors this process may use)",
    )
    how.add_argument("-q", "--quiet", action="store_true", help="print nothing but errors")
    how.add_argument("-v", "--verbose", action="count", default=0, help="say what is done and how long it takes")
    how.add_argument(
        "--progress", choices=("auto", "json"), default="auto", help="json: one object per line on standard error"
    )


def run(options: Namespace) -> int:
    """Renders and writes; SIGINT and SIGTERM end the render early, and the image so far is written."""
    import accuray

    if options.frames is not None:
        from .frames import run_frames

        return run_frames(options)
    exr = Path(options.output or f"{options.scene.stem}.exr")
    arguments = render_arguments(options)
    probe(exr, COMMAND)
    with Interrupts() as interrupts:
        started = perf_counter()
        try:
            with interrupts.interruptible():
                scene = accuray.load(options.scene, overrides=overrides(options))
            loaded = perf_counter()
            note(options, f"loaded {options.scene} in {loaded - started:.2f} s, identity {scene.identity}")
            for text in () if options.quiet else scene.model_notes:
                warn(options, f"not translated: {text}")
            note(options, f"rendering with {arguments['threads']} threads")
            image = render(scene, options, arguments, interrupts)
            rendered = perf_counter()
            if not image.film.coverage:
                raise KeyboardInterrupt  # it came before any pixel had a sample
            image.metadata["command"] = shlex.join(["accuray", *sys.argv[1:]])
            written = save(image, exr)
        except KeyboardInterrupt:
            warn(options, "interrupted before there was an image")
            return interrupts.status
    note(options, f"rendered in {rendered - loaded:.2f} s, written in {perf_counter() - rendered:.2f} s")
    for text in tessellations(image):
        note(options, text)
    for text in defects(image):
        warn(options, text)
    if interrupts.status:
        warn(options, "interrupted; the image so far has been written")
    if not options.quiet:
        print(*written, sep="\n")
    return interrupts.status


def render(
    scene: accuray.Scene,
    options: Namespace,
    arguments: dict[str, Any],
    interrupts: Interrupts,
    frame: int | None = None,
) -> accuray.Image:
    """Runs the engine under a progress display; an interrupted engine returns what it has."""
    import accuray

    crop = crop_window(options, scene.film["width"], scene.film["height"])
    display = choose_display(options.progress, options.quiet, sys.stderr, frame)
    try:
        with interrupts.interruptible():
            return accuray.render(scene, **arguments, crop=crop, progress=display, on_interrupt="return")
    finally:
        if display is not None:
            display.close()


def render_arguments(options: Namespace) -> dict[str, Any]:
    """The keyword arguments of `accuray.render` that can be told before the scene is loaded.

    Raises:
        UsageError: `--samples` leaves `--spp`, or a variable of the environment is wrong.
    """
    samples, spp = options.samples, options.spp
    if samples and spp and samples[1] > spp:
        raise UsageError(f"--samples {samples[0]}:{samples[1]} asks for more than the {spp} of --spp", COMMAND)
    return {
        "spp": None if samples else spp,
        "samples": samples,
        "seed": options.seed,
        "threads": thread_count(options.threads),
    }


def overrides(options: Namespace) -> list[str]:
    """The scene values that the command line sets, as `key=value`; flags with a name of their own win over -D."""
    named = (("film.width", options.width), ("film.height", options.height))
    layers = [] if options.layers is None else [f"render.layers={json.dumps(options.layers)}"]
    return [*options.overrides, *(f"{key}={value}" for key, value in named if value is not None), *layers]


def crop_window(options: Namespace, width: int, height: int) -> tuple[int, int, int, int] | None:
    """The part to render as (x0, y0, x1, y1) in pixels, or None for the whole image.

    A fraction is rounded to the nearest pixel edge, so crops that share an edge neither overlap nor leave a gap.

    Raises:
        UsageError: the part holds no pixel or leaves the image.
    """
    if options.pixel_bounds:
        x0, x1, y0, y1 = options.pixel_bounds
        flag = "--pixel-bounds"
    elif options.crop:
        x0, x1, y0, y1 = (
            math.floor(f * n + 0.5) for f, n in zip(options.crop, (width, width, height, height), strict=True)
        )
        flag = "--crop"
    else:
        return None
    if x0 >= x1 or y0 >= y1 or x1 > width or y1 > height:
        window = f"the pixels x {x0}:{x1}, y {y0}:{y1}"
        raise UsageError(f"{flag} asks for {window} of an image of {width}x{height}", COMMAND)
    return x0, y0, x1, y1


def tessellations(image: accuray.Image) -> Iterator[str]:
    """Says how many triangles were made of shapes that are subdivided or displaced."""
    for shape, report in image.metadata.get("mesh_reports", {}).items():
        if "tessellated_triangles" in report:
            yield f"shapes.{shape}: cut into {report['tessellated_triangles']} triangles"


def defects(image: accuray.Image) -> Iterator[str]:
    """Says what was left out of the image although the rest of it is fine."""
    reports: dict[str, dict[str, Any]] = image.metadata.get("mesh_reports", {})
    for shape, report in reports.items():
        losses = [f"{report[key]} {what}" for key, what in LOSSES.items() if report.get(key)]
        if losses:
            yield f"shapes.{shape}: left out {', '.join(losses)}"
        if "motion_error" in report:
            yield f"shapes.{shape}: moves so far that its blur is up to {report['motion_error']:.2g} of its size off"
    if image.film.dropped_total:
        yield f"{image.film.dropped_total} samples were not finite and were left out"


def warn(options: Namespace, text: str) -> None:
    """Prints a warning to standard error, as an object of its own where programs read JSON there."""
    print(json.dumps({"warning": text}) if options.progress == "json" else f"accuray: warning: {text}", file=sys.stderr)


def note(options: Namespace, text: str) -> None:
    """Prints to standard error what only -v asks for."""
    if options.verbose:
        print(f"accuray: {text}", file=sys.stderr)
