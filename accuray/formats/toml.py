"""Scene files in TOML 1.0."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from accuray.formats.places import depth_error, value_error
from accuray.scene.errors import SceneError

_PLACE = re.compile(r" \(at line (\d+), column (\d+)\)$")


def parse(text: str, name: str) -> dict[str, Any]:
    """The tables of a TOML text; SceneError with ``name``, line and column for a syntax error."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        place = _PLACE.search(message)
        lines = text.split("\n")
        line = int(place[1]) if place else len(lines)
        column = f"column {place[2]}: " if place else ""
        raise SceneError(
            f"{column}TOML syntax error: {_PLACE.sub('', message)}", file=name, line=line, shown=lines[line - 1]
        ) from None
    except RecursionError:
        raise depth_error(text, name) from None
    except ValueError as error:
        raise value_error(error, text, name) from None
