"""A Lambertian point that lamps shine on, by every way of sampling them."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from accuray.verify.case import Case
from accuray.verify.probes import RayProbe, looking_at
from accuray.verify.scenes import Solid, Table, assemble, diffuse, direct_only, square

ALBEDO = 0.5
UP = (0.0, 1.0, 0.0)
ALL = ("mis", "light", "bsdf", "reference")
SAMPLED = ("mis", "light")
#: Lamps of a smaller configuration factor are met by too few of the BSDF's samples for the short run.
SELDOM_MET = 0.08


def receiver(point: ArrayLike = (0.0, 0.0, 0.0), normal: ArrayLike = UP, size: float = 0.2) -> Solid:
    """A small Lambertian square."""
    return square(point, normal, size, diffuse(ALBEDO))


def rows_of(
    name: str,
    sentence: str,
    source: str,
    factor: float,
    solids: Sequence[Solid],
    strategies: Sequence[str],
    lights: Sequence[Table] = (),
    normal: ArrayLike = UP,
) -> list[Case]:
    """One case per strategy: the receiver at the origin shows albedo times the configuration factor."""
    everything = [receiver(normal=normal), *solids]
    return [
        Case(
            id=f"C1.{name}/{strategy}",
            sentence=sentence,
            source=source,
            expected=(ALBEDO * factor,),
            probe=RayProbe(assemble(everything, lights, direct_only(strategy)), looking_at((0, 0, 0), normal)),
            quick=factor == 0.0 or factor >= SELDOM_MET or strategy in SAMPLED,
        )
        for strategy in strategies
    ]
