"""Cases in the manner of `accuray verify`, for bugs that none of its own cases would see."""

from __future__ import annotations

import math

from accuray import data
from accuray.verify import Case, all_cases, optics
from accuray.verify.probes import RayProbe, across_parallelogram
from accuray.verify.scenes import PATH, assemble, lamp, slab, square

UP = (0.0, 1.0, 0.0)


def dispersed_fan() -> Case:
    """A thin fan of rays at 45 degrees through a thick slab of SF11, whose colours leave at different places.

    The fan would meet the lamp's plane from -width/2 to width/2 were there no slab; with it each wavelength arrives
    `moved` back. The lamp, a half-plane, begins where half of the fan is met at 550 nm. Two refractions only.
    """
    theta, thickness, width = math.radians(45.0), 1.0, 0.04
    height, floor = 0.5, -1.5
    wavelengths = (450.0, 550.0, 650.0)
    glass = data.glasses()["SF11"]
    indices = [optics.sellmeier(w, glass.A0, glass.B, glass.C) for w in wavelengths]
    moved = [optics.lateral_shift(thickness, theta, n) / math.cos(theta) for n in indices]
    edge = -moved[1]
    shares = [0.5 - (edge + m) / width for m in moved]
    assert all(0.05 < share < 0.95 for share in shares)
    expected = tuple((1.0 - optics.fresnel(theta, n)) ** 2 * share for n, share in zip(indices, shares, strict=True))

    run = (height - floor) * math.tan(theta)
    fan = across_parallelogram((-0.5 * width - run, height, 0.0), (width, 0, 0), (0, 0, 1e-3), (1, -1, 0))
    half_plane = square((edge + 5.0, floor, 0.0), UP, 10.0, lamp())
    scene = assemble([*slab("SF11", thickness, size=20.0), half_plane], (), PATH | {"max_depth": 2})
    probe = RayProbe(scene, fan, wavelengths=wavelengths, spp=16, start=64, group=1024)
    labels = tuple(f"{w:.0f} nm" for w in wavelengths)
    return Case(
        "X.dispersed-fan", "Colours of a fan of rays part in SF11.", "Snell, Sellmeier", expected, probe, labels
    )


def cases() -> list[Case]:
    """All cases that a planted bug may name."""
    return [*all_cases(), dispersed_fan()]
