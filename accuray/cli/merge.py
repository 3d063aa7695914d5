"""`accuray merge`: images that hold different samples of one scene become one image, exactly."""

from __future__ import annotations

import shlex
import sys
from argparse import Namespace
from pathlib import Path

from .output import add_output_flag, probe, save
from .parser import Parser, UsageError

SUMMARY = "Add up images that hold different samples of one scene; the result has the bits of a single render."
COMMAND = "accuray merge"


def configure(parser: Parser) -> None:
    """Adds the flags of `accuray merge`."""
    parser.add_argument("files", metavar="FILE.exr", type=Path, nargs="+", help="images written by AccuRay")
    add_output_flag(parser, required=True)
    parser.add_argument(
        "--mixed",
        action="store_true",
        help="allow images from different versions or kinds of processors; the result says so",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="print nothing but errors")


def run(options: Namespace) -> int:
    """Merges one file after the other, so that no more than two of them are in memory."""
    import accuray

    probe(options.output, COMMAND)
    first, *others = options.files
    path = first
    try:
        merged = accuray.Image.load(first)
        for path in others:
            merged = accuray.Image.merge([merged, accuray.Image.load(path)], mixed=options.mixed)
    except accuray.ImageError as error:
        place = "" if str(path) in str(error) else f"{path}: "
        raise UsageError(f"{place}{error}", COMMAND) from error
    merged.metadata["command"] = shlex.join(["accuray", *sys.argv[1:]])
    written = save(merged, options.output)
    if not options.quiet:
        print(*written, sep="\n")
    return 0
