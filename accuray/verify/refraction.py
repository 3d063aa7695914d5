"""C5: where prisms and balls of glass send the light, and at which wavelength.

A beam through a prism is bent to the edge of a lamp that stands where Snell's law says: as much of it arrives as the
edge lets by. The ball's figures are integrals over the beam of Fresnel's and Snell's laws.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from accuray import data
from accuray.verify import optics
from accuray.verify.case import Case, FloatArray
from accuray.verify.probes import RayProbe, across_parallelogram, parallel_beam
from accuray.verify.scenes import PATH, assemble, disk, environment, glass, lamp, rectangle, sphere

APEX = math.radians(60.0)
LINES = {"C": 656.2725, "d": 587.5618, "F": 486.1327, "g": 435.8343}
"""Fraunhofer's lines, nm."""
DISTANCE, BEAM = 20.0, 0.1
"""From the prism to the lamp, and the beam's width: a thousandth of it is 0.0003 degrees."""
SHARE = 0.4
BALL = 1.5


def minimum_deviation(index: float, apex: float = APEX) -> float:
    """Least deviation by a prism, radians; the ray crosses it symmetrically."""
    return 2.0 * math.asin(index * math.sin(0.5 * apex)) - apex


def deviation(incidence: float, index: float, apex: float = APEX) -> float:
    """Deviation of a ray that meets a prism's first face at `incidence`, radians."""
    sine = math.sin(incidence)
    return incidence + math.asin(math.sin(apex) * math.sqrt(index**2 - sine**2) - math.cos(apex) * sine) - apex


def _prism(name: str, sentence: str, material: str, line: str, incidence: float, quick: bool) -> Case:
    """The apex is the origin, the prism below it, the first face on the left.

    The beam's middle meets that face at the distance 1 from the apex and leaves the other at cos r1 / cos r2.
    """
    entry = data.glasses()[material]
    index = optics.sellmeier(LINES[line], entry.A0, entry.B, entry.C)
    bent = deviation(incidence, index)
    inside = math.asin(math.sin(incidence) / index), APEX - math.asin(math.sin(incidence) / index)
    leaving = incidence, bent + APEX - incidence
    down = math.sin(0.5 * APEX), math.cos(0.5 * APEX)
    ahead = 0.5 * APEX - incidence
    before = np.array([math.cos(ahead), -math.sin(ahead), 0.0])
    after = np.array([math.cos(ahead + bent), -math.sin(ahead + bent), 0.0])
    across = np.array([-before[1], before[0], 0.0])
    entrance = np.array([-down[0], -down[1], 0.0])
    exit_ = math.cos(inside[0]) / math.cos(inside[1]) * np.array([down[0], -down[1], 0.0])
    width = BEAM * math.cos(inside[0]) / math.cos(leaving[0]) * math.cos(leaving[1]) / math.cos(inside[1])
    sideways = np.array([-after[1], after[0], 0.0])
    edge = exit_ + DISTANCE * after + (0.5 - SHARE) * width * sideways
    faces = [
        rectangle((0.0, 0.0, -1.0), (-2.0 * down[0], -2.0 * down[1], 0.0), (0, 0, 2), glass(material)),
        rectangle((0.0, 0.0, -1.0), (0, 0, 2), (2.0 * down[0], -2.0 * down[1], 0.0), glass(material)),
    ]
    wall = rectangle((edge - [0, 0, 1]).tolist(), (4.0 * sideways).tolist(), (0, 0, 2), lamp(sides="both"))
    start = entrance - before - 0.5 * BEAM * across
    beam = across_parallelogram(start, BEAM * across, (0, 0, 1e-3), before)
    probe = RayProbe(
        assemble([*faces, wall], (), PATH | {"max_depth": 2}),
        beam,
        wavelengths=(LINES[line],),
        spp=4,
        start=64,
        group=1024,
    )
    passed = (1.0 - optics.fresnel(incidence, index)) * (1.0 - optics.fresnel(leaving[1], index))
    sentence = f"{sentence}: bent by {math.degrees(bent):.5f} degrees"
    return Case(f"C5.prism-{name}", sentence, "Snell's law", (SHARE * passed,), probe, quick=quick)


def _prisms() -> list[Case]:
    rows = []
    for material in ("N-BK7", "SF11"):
        entry = data.glasses()[material]
        of_d = 0.5 * (minimum_deviation(optics.sellmeier(LINES["d"], entry.A0, entry.B, entry.C)) + APEX)
        for line, wavelength in LINES.items():
            index = optics.sellmeier(wavelength, entry.A0, entry.B, entry.C)
            least = 0.5 * (minimum_deviation(index) + APEX)
            sentence = f"Line {line} in a 60 degree prism of {material} at least deviation"
            rows.append(_prism(f"{material}-{line}", sentence, material, line, least, line == "d"))
        for line in ("C", "F"):
            sentence = f"Line {line} in a prism of {material} at the incidence for line d"
            rows.append(_prism(f"{material}-{line}-of-d", sentence, material, line, of_d, material == "SF11"))
    return rows


@cache
def _through_ball(index: float, steps: int = 200_000) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of rays evenly over a ball's cross section: angles outside and inside, and reflectance, (N,) each."""
    sine = np.sqrt((np.arange(steps) + 0.5) / steps)
    outside, inside = np.arcsin(sine), np.arcsin(sine / index)
    cos_o, cos_i = np.cos(outside), np.cos(inside)
    s = ((cos_o - index * cos_i) / (cos_o + index * cos_i)) ** 2
    p = ((index * cos_o - cos_i) / (index * cos_o + cos_i)) ** 2
    return outside, inside, 0.5 * (s + p)


def ball_order(order: int, index: float = BALL) -> float:
    """Share of a beam over a ball's cross section that leaves after `order` passages through it; 0: reflected."""
    _, _, reflected = _through_ball(index)
    if order == 0:
        return float(reflected.mean())
    return float(((1.0 - reflected) ** 2 * reflected ** (order - 1)).mean())


def ball_flux(z: float, radius: float, index: float = BALL) -> float:
    """Share of the beam that crosses the plane `z` behind a unit ball within `radius`, after two refractions."""
    outside, inside, reflected = _through_ball(index)
    turned = 2.0 * inside - outside
    height = np.sin(turned) - (z - np.cos(turned)) * np.tan(2.0 * (outside - inside))
    return float(((1.0 - reflected) ** 2 * (np.abs(height) < radius)).mean())


def _balls() -> list[Case]:
    """A beam over the cross section of a glass ball: in even light up to a depth, and the caustic behind it."""
    beam = parallel_beam((0, 0, 1), 1.0)
    ball = sphere((0, 0, 0), 1.0, glass(BALL))
    rows = []
    total = 0.0
    for order, words in enumerate(("reflected", "and straight through", "and after one reflection inside")):
        total += ball_order(order)
        scene = assemble([ball], [environment()], PATH | {"max_depth": order + 1})
        probe = RayProbe(scene, beam, spp=4, start=64, group=1024)
        sentence = f"Light off a glass ball (n = 1.5): {words}"
        rows.append(Case(f"C5.ball-order-{order}", sentence, "Fresnel 1823", (total,), probe))
    for z, radius in (
        (1.25, 0.05),
        (1.25, 0.1),
        (1.25, 0.25),
        (1.5, 0.05),
        (1.5, 0.1),
        (1.5, 0.25),
        (2.0, 0.1),
        (2.0, 0.25),
    ):
        scene = assemble([ball, disk((0, 0, z), (0, 0, -1), radius, lamp())], (), PATH | {"max_depth": 2})
        probe = RayProbe(scene, beam, spp=4, start=64, group=1024)
        sentence = f"Light within {radius} of the axis at {z} behind a ball's middle, after two refractions"
        quick = radius == 0.25
        rows.append(
            Case(
                f"C5.caustic-{z}-{radius}",
                sentence,
                "Snell's and Fresnel's laws",
                (ball_flux(z, radius),),
                probe,
                quick=quick,
            )
        )
    return rows


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [*_prisms(), *_balls()]
