"""IES files for tests: written from angles and candelas, whole or with any of their numbers replaced."""

from __future__ import annotations

from collections.abc import Callable, Iterable

Distribution = Callable[[float, float], float]
"""(vertical, horizontal) in degrees -> candelas."""


def ies_text(
    vertical: Iterable[float],
    horizontal: Iterable[float],
    candela: Distribution,
    *,
    first: str = "IESNA:LM-63-2002",
    tilt: str = "TILT=NONE",
    lamps: str = "1 1000",
    multiplier: float = 1.0,
    kind: str = "1 2",
    factors: str = "1 1 10",
) -> str:
    """An IES file. ``lamps``: number and lumens; ``kind``: photometry and unit; ``factors``: of ballasts, and watts."""
    v, h = [float(a) for a in vertical], [float(b) for b in horizontal]
    lines = [first] if first else []
    lines += ["[TEST] made up", tilt, f"{lamps} {multiplier!r} {len(v)} {len(h)} {kind} 0 0 0", factors]
    lines += [" ".join(map(repr, v)), " ".join(map(repr, h))]
    lines += [" ".join(repr(float(candela(a, b))) for a in v) for b in h]
    return "\n".join(lines) + "\n"
