"""The moment that a picture shows: the time of its frame, and the interval in which the shutter is open."""

from __future__ import annotations

from typing import Any, NamedTuple

USUAL_SHUTTER = 0.5
"""Share of a frame that the shutter is open, around the frame's time, where the scene does not say."""


class Clock(NamedTuple):
    """Times in seconds since frame 0: of the frame itself, and of the shutter's opening and closing."""

    time: float
    open: float
    close: float

    @classmethod
    def of(cls, animation: dict[str, Any]) -> Clock:
        """The clock of a resolved ``[animation]`` table."""
        time, half = animation["frame"] / animation["fps"], 0.5 * USUAL_SHUTTER / animation["fps"]
        start, end = animation["shutter_open"], animation["shutter_close"]
        return cls(time, time + (-half if start is None else start), time + (half if end is None else end))


STILL = Clock(0.0, 0.0, 0.0)
"""Of a scene in which time does not matter."""
