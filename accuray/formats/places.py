"""Lines of what the parsers of the standard library refuse without saying where."""

from __future__ import annotations

import re

from accuray.scene.errors import SceneError

MAX_DIGITS = 4300
"""Longest integer that Python reads (its own limit against quadratic run time)."""

_LONG_INTEGER = re.compile(rf"[0-9][0-9_]{{{MAX_DIGITS},}}")
_SHOWN_DEPTH = 100


def value_error(error: ValueError, text: str, name: str) -> SceneError:
    """A value that the parser refuses: an integer of thousands of digits, or what a hook of ours raised.

    The arguments of such an ``error`` are the problem and what is allowed.
    """
    found = _LONG_INTEGER.search(text)
    if found is None:
        problem, allowed = error.args if len(error.args) == 2 else (str(error), None)
        return SceneError(problem, file=name, allowed=allowed)
    line = text.count("\n", 0, found.start()) + 1
    return SceneError(
        "is too large an integer", file=name, line=line, allowed=f"up to {MAX_DIGITS} digits", shown=found.group()
    )


def depth_error(text: str, name: str) -> SceneError:
    """Lists or tables nested deeper than the parser follows; names the line where they get deep."""
    depth = line = 0
    for line, content in enumerate(text.split("\n"), start=1):
        depth += sum(content.count(bracket) for bracket in "[{") - sum(content.count(bracket) for bracket in "]}")
        if max(depth, content.count("["), content.count("{")) > _SHOWN_DEPTH:
            return SceneError(
                "is nested too deeply", file=name, line=line, allowed="a few levels of lists and tables", shown=content
            )
    return SceneError("is nested too deeply", file=name, allowed="a few levels of lists and tables")
