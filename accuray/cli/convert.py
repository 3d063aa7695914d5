"""`accuray convert`: a model file becomes a scene that can be edited."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from .parser import Parser

SUMMARY = "Write a model (glTF, GLB, OBJ, PLY, STL) as a scene that can be edited."


def configure(parser: Parser) -> None:
    """Adds the arguments of `accuray convert`."""
    parser.add_argument("model", metavar="MODEL", type=Path, help="model file: .gltf, .glb, .obj, .ply or .stl")
    parser.add_argument(
        "scene",
        metavar="SCENE",
        type=Path,
        help="scene file to write, .toml; meshes and pictures go into the folder SCENE_files beside it",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="print nothing but errors")
    parser.add_argument("-v", "--verbose", action="count", default=0, help="show where an internal error comes from")


def run(options: Namespace) -> int:
    """Prints the name of the scene, and on standard error what could not be translated."""
    import accuray

    notes = accuray.convert(options.model, options.scene)
    if not options.quiet:
        for note in notes:
            print(f"accuray: not translated: {note}", file=sys.stderr)
        print(options.scene)
    return 0
