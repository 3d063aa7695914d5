"""`accuray schema`: what a scene file may say, for editors (JSON Schema) or for readers (Markdown)."""

from __future__ import annotations

import json
import sys
from argparse import Namespace

from .parser import Parser

SUMMARY = "Print the JSON Schema of scene files, or their reference in Markdown."


def configure(parser: Parser) -> None:
    """Adds the flags of `accuray schema`."""
    parser.add_argument("--reference", action="store_true", help="print the reference pages in Markdown instead")


def run(options: Namespace) -> int:
    """Prints the schema; both forms come from the parameter tables of the engine."""
    import accuray

    text = accuray.reference_markdown() if options.reference else json.dumps(accuray.json_schema(), indent=2) + "\n"
    sys.stdout.write(text)
    return 0
