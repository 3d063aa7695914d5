"""Frames of an animation by number: lists such as ``1-100x2``, and file names such as ``out.####.exr``."""

from __future__ import annotations

import os
import re
from pathlib import Path

LARGEST = 10**9
"""Largest frame number, both ways."""

MOST = 1_000_000
"""Most frames in one list."""

DIGITS = 4
"""Digits of a frame's number in a name that does not say how many."""

ALLOWED = 'numbers and ranges such as "5", "1-100", "1-100x2" (every second one), "-5--1", joined by commas'

_PART = re.compile(r"\s*(-?\d{1,18})(?:\s*-\s*(-?\d{1,18})(?:\s*x\s*(\d{1,18}))?)?\s*")


def parse_frames(text: str) -> tuple[int, ...]:
    """The frames that a list names, each once, in the order of the list.

    Parts are joined by commas: ``5``; ``1-100``, both ends included; ``1-100x2``, every second one from the first on;
    with negative numbers ``-5--1``, from -5 to -1.

    Raises:
        ValueError: the text is no such list, a range runs backwards, or there are too many frames.
    """
    frames: dict[int, None] = {}
    for part in text.split(","):
        chosen = _range(part)
        if len(frames) + len(chosen) > MOST:
            raise ValueError(f"frames {text!r}: more than {MOST} frames")
        frames.update(dict.fromkeys(chosen))
    return tuple(frames)


def _range(part: str) -> range:
    match = _PART.fullmatch(part)
    if match is None:
        raise ValueError(f"frames {part.strip()!r}: allowed are {ALLOWED}")
    first = int(match[1])
    last, step = (int(match[2]), int(match[3] or 1)) if match[2] else (first, 1)
    if max(abs(first), abs(last)) > LARGEST:
        raise ValueError(f"frames {part.strip()!r}: allowed are numbers from {-LARGEST} to {LARGEST}")
    if last < first:
        raise ValueError(f"frames {part.strip()!r} run backwards: write {last}-{first}")
    if step == 0:
        raise ValueError(f"frames {part.strip()!r}: a step of 0 leads nowhere, allowed is 1 or more")
    return range(first, last + 1, step)


def frame_path(pattern: str | os.PathLike[str], frame: int) -> Path:
    """The file of a frame: every run of ``#`` in the pattern becomes its number with at least so many digits.

    ``out/frame.####.exr`` gives ``out/frame.0012.exr``, and ``out/frame.-0012.exr`` for frame -12. Where there is no
    ``#`` the number stands before the ending, with four digits: ``out.exr`` gives ``out.0012.exr``.
    """
    path = Path(pattern)
    text = os.fspath(path)
    if "#" not in text:
        text = os.fspath(path.with_name(f"{path.stem}.{'#' * DIGITS}{path.suffix}"))
    return Path(re.sub("#+", lambda run: _number(frame, len(run[0])), text))


def _number(frame: int, digits: int) -> str:
    return f"{'-' if frame < 0 else ''}{abs(frame):0{digits}d}"
