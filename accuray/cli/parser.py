"""Command-line parsing: argparse that takes flags in any order and names the nearest known one to a wrong one."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from typing import NoReturn, TypeVar

_NUMBER = re.compile(r"-\.?\d")
Number = TypeVar("Number", int, float)


class UsageError(Exception):
    """The command line is wrong. `command` is the command whose help would explain it."""

    def __init__(self, message: str, command: str) -> None:
        super().__init__(message)
        self.command = command


class Parser(argparse.ArgumentParser):
    """A parser for one verb. `parse` raises UsageError; no flag may be shortened, none is ever ignored."""

    def __init__(self, prog: str, description: str) -> None:
        super().__init__(
            prog=prog,
            description=description,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )

    def parse(self, arguments: Sequence[str]) -> argparse.Namespace:
        """Parses the arguments after the verb; flags and other arguments may be mixed."""
        self._refuse_unknown_flags(arguments)
        return self.parse_intermixed_args(arguments)

    def error(self, message: str) -> NoReturn:
        """Called by argparse for every mistake it finds."""
        raise UsageError(message, self.prog)

    def _refuse_unknown_flags(self, arguments: Sequence[str]) -> None:
        """Looks at the flags before argparse does, which would report what it misses because of them instead."""
        known = self._option_string_actions
        for argument in arguments:
            if argument == "--":
                return
            if not argument.startswith("-") or argument == "-" or _NUMBER.match(argument):
                continue
            flag = argument.partition("=")[0] if argument.startswith("--") else argument[:2]
            if flag not in known:
                wrong = argument.partition("=")[0]
                raise UsageError(f"unknown flag {wrong}; the nearest one is {nearest(wrong, known)}", self.prog)


def nearest(word: str, known: Iterable[str]) -> str:
    """The known word that resembles `word` most; dashes in front and case do not count."""
    from difflib import SequenceMatcher

    def likeness(candidate: str) -> float:
        return SequenceMatcher(None, word.lstrip("-").lower(), candidate.lstrip("-").lower()).ratio()

    return max(known, key=likeness)


def whole_number(least: int) -> Callable[[str], int]:
    """An argument type: an integer of at least `least`."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least {least}")
        return value

    return parse


def sample_range(text: str) -> tuple[int, int]:
    """An argument type: `A:B`, the sample numbers A to B - 1 of every pixel."""
    first, colon, end = text.partition(":")
    if not (colon and first.isdecimal() and end.isdecimal() and int(first) < int(end)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a range A:B of sample numbers with 0 <= A < B")
    return int(first), int(end)


def frame_list(text: str) -> tuple[int, ...]:
    """An argument type: frames of an animation, as `accuray.parse_frames` reads them."""
    import accuray

    try:
        return accuray.parse_frames(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def fractions_of_image(text: str) -> tuple[float, float, float, float]:
    """An argument type: `x0,x1,y0,y1`, fractions of the width and height from the upper left corner."""
    x0, x1, y0, y1 = _four(text, float, "four numbers x0,x1,y0,y1")
    if not (0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1):
        raise argparse.ArgumentTypeError(f"{text!r} is no part of the image: 0 <= x0 < x1 <= 1, 0 <= y0 < y1 <= 1")
    return x0, x1, y0, y1


def pixel_bounds(text: str) -> tuple[int, int, int, int]:
    """An argument type: `x0,x1,y0,y1` in pixels from the upper left corner, x1 and y1 excluded."""
    x0, x1, y0, y1 = _four(text, int, "four whole numbers x0,x1,y0,y1")
    if not (0 <= x0 < x1 and 0 <= y0 < y1):
        raise argparse.ArgumentTypeError(f"{text!r} holds no pixel: 0 <= x0 < x1, 0 <= y0 < y1")
    return x0, x1, y0, y1


def names(text: str) -> list[str]:
    """An argument type: names separated by commas; an empty text is none."""
    return [name.strip() for name in text.split(",")] if text else []


def override(text: str) -> str:
    """An argument type: `key=value`, the key a dotted path into the scene."""
    key, equals, _ = text.partition("=")
    if not (key.strip() and equals):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form key=value, as in film.width=640")
    return text


def _four(text: str, kind: Callable[[str], Number], expected: str) -> tuple[Number, Number, Number, Number]:
    parts = text.split(",")
    try:
        a, b, c, d = (kind(part) for part in parts)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form {expected}") from None
    return a, b, c, d
