"""`accuray info`: what an image that AccuRay wrote contains, or what a scene file describes, in words."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .parser import Parser, UsageError

if TYPE_CHECKING:
    import accuray

SUMMARY = "Say what an image or a scene file contains."

SCENES = (".toml", ".json", ".gltf", ".glb", ".obj", ".ply", ".stl")

Facts = list[tuple[str, str]]


def configure(parser: Parser) -> None:
    """Adds the arguments of `accuray info`."""
    parser.add_argument("file", metavar="FILE", type=Path, help="an EXR written by AccuRay, a scene or a model")


def run(options: Namespace) -> int:
    """Prints one fact per line, its name in front."""
    import accuray

    if options.file.suffix.lower() in SCENES:
        facts = scene_facts(accuray.load(options.file))
    else:
        try:
            facts = image_facts(accuray.Image.load(options.file))
        except accuray.ImageError as error:
            raise UsageError(str(error), "accuray info") from error
    print(options.file)
    for name, text in facts:
        print(f"  {name:<12} {text}")
    return 0


def image_facts(image: accuray.Image) -> Facts:
    """The ledger of an image: which samples of which scene it holds, how good it is, and how it was made."""
    film, metadata = image.film, image.metadata
    x0, y0, x1, y1 = film.window
    size = f"{film.width} x {film.height} pixels"
    if (x0, y0, x1, y1) != (0, 0, film.width, film.height):
        size += f", of which x {x0}:{x1}, y {y0}:{y1}"
    counts = image.layers["samples"]
    facts: Facts = [
        ("image", size),
        ("samples", sample_ranges(image)),
        ("per pixel", number_range(int(counts.min()), int(counts.max()))),
        ("layers", ", ".join(("colours", *film.layers))),
        ("replicates", f"{film.replicates}, samples of one number modulo {film.replicates} share one"),
        ("error", percentage(image.relative_error)),
        ("dropped", f"{film.dropped_total} samples that were not finite" if film.dropped_total else "no sample"),
        ("unit", f"sums are whole multiples of {film.step:g}"),
    ]
    known = (
        ("scene", "scene_hash"),
        ("seed", "seed"),
        ("exposure, EV", "exposure"),
        ("white", "white_balance"),
        ("version", "version"),
        ("isa", "isa"),
        ("processor", "cpu_vendor"),
        ("command", "command"),
    )
    facts += [(name, in_words(metadata[key])) for name, key in known if metadata.get(key) is not None]
    if metadata.get("render_seconds") is not None:
        facts.append(("render time", f"{metadata['render_seconds']:.2f} s"))
    if metadata.get("mixed"):
        facts.append(("mixed", "parts come from different builds or processors: the bits cannot be repeated"))
    return facts


def scene_facts(scene: accuray.Scene) -> Facts:
    """What a scene describes, one line per family."""
    film, render = scene.film, scene.render
    return [
        ("image", f"{film['width']} x {film['height']} pixels"),
        ("samples", f"{render['spp']} per pixel, seed {render['seed']}, {render['replicates']} replicates"),
        ("camera", str(scene.camera["type"])),
        ("integrator", str(scene.integrator["type"])),
        ("filter", str(scene.filter["type"])),
        ("shapes", by_type(scene.shapes.values())),
        ("materials", by_type(scene.materials.values())),
        ("lights", by_type(scene.lights.values())),
        ("identity", scene.identity),
    ]


def by_type(objects: Iterable[dict[str, Any]]) -> str:
    """`3: 2 mesh, 1 sphere`."""
    counts = Counter(str(each["type"]) for each in objects)
    if not counts:
        return "none"
    return f"{counts.total()}: " + ", ".join(f"{count} {name}" for name, count in counts.most_common())


def sample_ranges(image: accuray.Image) -> str:
    """`0:16, 32:64`, with a word where only a part of the pixels holds a range."""
    texts = [f"{r.first}:{r.end}" + ("" if r.mask is None else " (in part)") for r in image.film.coverage]
    return ", ".join(texts) or "none"


def number_range(low: int, high: int) -> str:
    """`64`, or `16 to 64`."""
    return str(low) if low == high else f"{low} to {high}"


def percentage(share: float) -> str:
    """`1.8 %`; a share that is not finite is not known."""
    return f"{100 * share:.2g} %" if share < float("inf") else "unknown: it takes two replicates with samples"


def in_words(value: Any) -> str:
    """A metadata value as text."""
    return " ".join(f"{number:g}" for number in value) if isinstance(value, list) else str(value)
