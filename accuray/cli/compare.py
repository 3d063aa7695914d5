"""`accuray compare`: how much two pictures differ, by the report's measure, relMSE, PSNR, FLIP and noise."""

from __future__ import annotations

import json
from argparse import ArgumentTypeError, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from .parser import Parser, UsageError

if TYPE_CHECKING:
    import accuray

SUMMARY = "Say how much two pictures differ; the second one is the reference."
COMMAND = "accuray compare"
EXCEEDED = 1


def configure(parser: Parser) -> None:
    """Adds the arguments of `accuray compare`."""
    parser.add_argument("image", metavar="A", type=Path, help="an EXR or PNG file")
    parser.add_argument("reference", metavar="B", type=Path, help="what A is judged by, of the same size")
    parser.add_argument("--diff", metavar="PNG", type=Path, help="write a heat map of the difference")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument(
        "--tolerance",
        metavar="PERCENT",
        type=percent,
        help="exit with 1 if the accuracy is below 100 %% less this",
    )
    parser.add_argument(
        "--exposure",
        metavar="EV",
        type=float,
        help="exposure of EXR files for the display values (default: that of B, else of A, else 0)",
    )
    parser.add_argument(
        "--ppd",
        metavar="PIXELS",
        type=pixels_per_degree,
        help="pixels per degree of the visual field, for FLIP (default: 67, a 4K screen 0.7 m wide at 0.7 m)",
    )


def percent(text: str) -> float:
    """An argument type: 0 to 100, with or without a percent sign."""
    return _number(text.removesuffix("%").strip(), text, 0.0, 100.0)


def pixels_per_degree(text: str) -> float:
    """An argument type: 1 to 1000."""
    return _number(text, text, 1.0, 1000.0)


def run(options: Namespace) -> int:
    """Prints the figures; the status is 1 if the tolerance is exceeded."""
    import accuray

    if options.diff is not None and options.diff.suffix.lower() != ".png":
        raise UsageError(f"{options.diff}: the heat map is a PNG, so its name must end in .png", COMMAND)
    settings = {"exposure": options.exposure} | ({"pixels_per_degree": options.ppd} if options.ppd else {})
    try:
        if options.diff is not None:
            accuray.probe_writable(options.diff)
        comparison = accuray.compare(options.image, options.reference, **settings)
    except accuray.ImageError as error:
        raise UsageError(str(error), COMMAND) from error
    exceeded = options.tolerance is not None and comparison.accuracy < 100.0 - options.tolerance
    limit = None if options.diff is None else comparison.save_heat_map(options.diff)
    if options.json:
        more = {} if limit is None else {"diff": str(options.diff), "diff_white": limit}
        if options.tolerance is not None:
            more |= {"tolerance": options.tolerance, "exceeded": exceeded}
        print(json.dumps(comparison.to_dict() | more, indent=2))
    else:
        print(f"{comparison.name} against {comparison.reference}")
        facts = in_words(comparison)
        if limit is not None:
            facts.append(("heat map", f"{options.diff}, white where display values differ by {limit:g}"))
        if options.tolerance is not None:
            facts.append(("tolerance", f"{options.tolerance:g} %: {'exceeded' if exceeded else 'kept'}"))
        for name, text in facts:
            print(f"  {name:<10} {text}")
    return EXCEEDED if exceeded else 0


def in_words(c: accuray.Comparison) -> list[tuple[str, str]]:
    """One fact per line: its name and what to say."""
    red, green, blue = c.difference
    facts = [
        ("size", f"{c.width} x {c.height} pixels, exposure {c.exposure:g} EV"),
        ("accuracy", f"{c.accuracy:.3f} %: display values differ by {red:.5f} (R), {green:.5f} (G), {blue:.5f} (B)"),
        ("largest", f"{c.largest:.4f}"),
        ("relMSE", f"{c.relative_mse:.4g}"),
        ("PSNR", f"{c.psnr:.2f} dB"),
        ("FLIP", f"{c.flip:.4f} at {c.pixels_per_degree:.0f} pixels per degree"),
    ]
    if c.identical:
        facts.append(("noise", "every value is the same"))
    elif c.noise is None:
        facts.append(("noise", f"not judged: {c.note}"))
    else:
        verdict = "explains the difference" if c.noise else "does not explain the difference"
        facts.append(("noise", f"{verdict}: {c.noise.reason}"))
        if c.note:
            facts.append(("", c.note))
    return facts


def _number(text: str, given: str, low: float, high: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise ArgumentTypeError(f"{given!r} is not a number from {low:g} to {high:g}")
    return value
