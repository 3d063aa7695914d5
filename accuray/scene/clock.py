"""The moment that a picture shows: the time of its frame, and the interval in which the shutter is open."""

from __future__ import annotations

from typing import Any, NamedTuple

from accuray.scene.errors import Where

USUAL_SHUTTER = 0.5
"""Share of a frame that the shutter is open, around the frame's time, where the scene does not say."""

Nodes = tuple[tuple[float, float], ...]


class Clock(NamedTuple):
    """Times in seconds since frame 0: of the frame itself, and of the shutter's opening and closing.

    ``shutter`` says what it lets through: lines between nodes, each a share of the interval, rising from 0 to 1, and a
    transmission; none: all of the light all the time.
    """

    time: float
    open: float
    close: float
    shutter: Nodes = ()

    @classmethod
    def of(cls, animation: dict[str, Any], where: Where) -> Clock:
        """The clock of a resolved ``[animation]`` table. Raises SceneError."""
        time, half = animation["frame"] / animation["fps"], 0.5 * USUAL_SHUTTER / animation["fps"]
        start, end = animation["shutter_open"], animation["shutter_close"]
        clock = cls(time, time + (-half if start is None else start), time + (half if end is None else end))
        if clock.close < clock.open:
            raise where.child("shutter_close").error(
                "closes the shutter before it opens", value=end, allowed="shutter_open or later"
            )
        return clock._replace(shutter=_shutter(animation, where))


def _shutter(animation: dict[str, Any], where: Where) -> Nodes:
    if animation["shutter_curve"] is not None:
        return _curve(animation["shutter_curve"], where.child("shutter_curve"))
    shape, ramp = animation["shutter_shape"], animation["shutter_ramp"]
    if shape == "triangle" or (shape == "trapezoid" and ramp == 0.5):
        return (0.0, 0.0), (0.5, 1.0), (1.0, 0.0)
    if shape == "trapezoid" and ramp > 0.0:
        return (0.0, 0.0), (ramp, 1.0), (1.0 - ramp, 1.0), (1.0, 0.0)
    return ()


def _curve(rows: Any, where: Where) -> Nodes:
    """The nodes of a curve that the scene gives; equal transmissions are no shape. Raises SceneError."""
    nodes = tuple((float(row[0]), float(row[1])) for row in rows)
    times = [time for time, _ in nodes]
    if len(nodes) < 2 or times[0] != 0.0 or times[-1] != 1.0:
        raise where.error("does not span the interval", value=times, allowed="a first point at 0 and a last one at 1")
    for index in range(1, len(times)):
        if not times[index] > times[index - 1]:
            raise where.child(index, 0).error(
                "is not later than the one before", value=times[index], allowed="rising times"
            )
    if not 0.0 < max(share for _, share in nodes) < float("inf"):
        raise where.error("lets no light through", allowed="a transmission above 0")
    return () if len({share for _, share in nodes}) == 1 else nodes


STILL = Clock(0.0, 0.0, 0.0)
"""Of a scene in which time does not matter."""
