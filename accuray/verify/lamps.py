"""C1, lamps as they are sold: cones, parallel light, measured luminaires, amounts in lm, cd and lx."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from accuray import data
from accuray.verify.case import Case
from accuray.verify.probes import RayProbe, every_way, from_all_sides
from accuray.verify.receiver import ALBEDO, SAMPLED, rows_of
from accuray.verify.scenes import Solid, Table, assemble, diffuse, direct_only, disk, environment, lamp, sphere

DELTA = (*SAMPLED, "reference")
DOWN = (0.0, -1.0, 0.0)
#: lm of 1 W/nm at all wavelengths: 683.002 lm/W times the integral of ybar (CIE 1931).
LUMENS = data.LUMINOUS_EFFICACY * sum(data.observer().y)
INNER, OUTER = math.radians(40.0), math.radians(60.0)
#: Flux over intensity of a spot light with a smooth edge between these angles, sr.
SPOT_STERADIANS = 2.0 * math.pi * ((1.0 - math.cos(INNER)) + 0.5 * (math.cos(INNER) - math.cos(OUTER)))


def spot_light(intensity: Any, **more: Any) -> Table:
    """A spot light with a smooth edge between `INNER` and `OUTER`."""
    return {"type": "spot", "inner_angle": 40, "outer_angle": 60, "intensity": intensity, **more}


def _delta(name: str, sentence: str, source: str, irradiance: float, light: Table) -> list[Case]:
    """One light that no path can meet; irradiances become factors on division by pi."""
    rows = rows_of(name, sentence, source, irradiance / math.pi, [], DELTA, [light])
    return [replace(case, quick=True) for case in rows]


def _spots() -> list[Case]:
    above = {"position": [0.0, 2.0, 0.0]}
    half = math.acos(0.5 * (math.cos(INNER) + math.cos(OUTER)))
    slanted = [math.sin(half), -math.cos(half), 0.0]
    rows = _delta("spot", "A spot light on its axis, E = I / d^2", "inverse square law", 2.5, spot_light(10.0, **above))
    rows += _delta(
        "spot-edge",
        "A spot light halfway between its angles, by the cosine: half of that",
        "definition of the falloff",
        1.25,
        spot_light(10.0, direction=slanted, **above),
    )
    rows += _delta(
        "spot-outside",
        "Beyond its outer angle a spot light is dark",
        "definition of the falloff",
        0.0,
        spot_light(10.0, direction=[1.0, -0.4, 0.0], **above),
    )
    for strategy in DELTA:
        ball = assemble([sphere((0, 0, 0), 1.0, diffuse(ALBEDO))], [spot_light(10.0)], direct_only(strategy))
        rows.append(
            Case(
                f"C1.spot-power/{strategy}",
                "All light of a spot in the middle of a unit sphere: 2 pi I ((1 - cos a) + (cos a - cos b) / 2)",
                "integral of the falloff",
                (ALBEDO / math.pi * 10.0 * SPOT_STERADIANS / (4.0 * math.pi),),
                RayProbe(ball, every_way((0.0, 0.0, 0.0)), group=256, spp=16),
            )
        )
    return rows


def _parallel() -> list[Case]:
    slanted = [math.sin(math.pi / 3.0), -0.5, 0.0]
    return _delta(
        "directional",
        "Parallel light at 60 degrees, half of its irradiance",
        "cosine law",
        0.5 * 3.0,
        {"type": "directional", "direction": slanted, "irradiance": 3.0},
    )


def _amounts() -> list[Case]:
    """In lux, as spectral irradiances of white light."""
    lux = 1.0 / LUMENS
    position = [2.0 * math.sin(math.pi / 3.0), 1.0, 0.0]
    rows = _delta(
        "candela",
        "A point light of 1000 cd at 2 m and 60 degrees: 125 lx",
        "inverse square law, 683.002 lm/W",
        125.0 * lux,
        {"type": "point", "position": position, "intensity": "1000 cd"},
    )
    rows += _delta(
        "lumen-point",
        "The same point by its flux, 4 pi 1000 lm",
        "inverse square law, 683.002 lm/W",
        125.0 * lux,
        {"type": "point", "position": position, "intensity": f"{4000.0 * math.pi!r} lm"},
    )
    rows += _delta(
        "lumen-spot",
        "A spot light of 800 lm at 2 m on its axis",
        "integral of the falloff, 683.002 lm/W",
        800.0 / SPOT_STERADIANS / 4.0 * lux,
        spot_light("800 lm", position=[0.0, 2.0, 0.0]),
    )
    rows += _delta(
        "lux",
        "Parallel light of 500 lx straight down",
        "definition of the lux",
        500.0 * lux,
        {"type": "directional", "irradiance": "500 lx"},
    )
    rows += _delta(
        "luminaire",
        "A measured luminaire with 1014 cd at 30 degrees of its file, 2 m away and 60 degrees off the normal",
        "inverse square law, the file's candela",
        1014.0 * 0.5 / 4.0 * lux,
        {
            "type": "ies",
            "file": "builtin:wall_washer.ies",
            "position": position,
            "direction": [-math.cos(math.pi / 3.0), -math.sin(math.pi / 3.0), 0.0],
            "c0": [-math.sin(math.pi / 3.0), math.cos(math.pi / 3.0), 0.0],
        },
    )
    bulb: Solid = sphere((1.0, math.sqrt(3.0), 0.0), 0.2, lamp("800 lm"))
    rows += rows_of(
        "lumen-sphere",
        "A ball lamp of 800 lm at 2 m and 30 degrees: E = flux cos / (4 pi d^2)",
        "Howell B-46",
        800.0 * math.cos(math.pi / 6.0) / (16.0 * math.pi**2) * lux,
        [bulb],
        SAMPLED,
    )
    rows += rows_of(
        "lumen-disk",
        "A disk lamp of 800 lm and radius 1 at height 2: E = flux / (pi (R^2 + h^2))",
        "rings of cos cos / (pi d^2)",
        800.0 / (5.0 * math.pi**2) * lux,
        [disk((0, 2, 0), DOWN, 1.0, lamp("800 lm"))],
        DELTA,
    )
    return rows


def _convex() -> list[Case]:
    cube: Solid = ({"type": "cube", "size": [1.0, 1.0, 1.0]}, diffuse(ALBEDO))
    return [
        Case(
            f"C1.environment-cube/{strategy}",
            "A cube in a constant environment shows rho L everywhere, as every convex Lambertian body",
            "integral of the cosine",
            (ALBEDO,),
            RayProbe(assemble([cube], [environment()], direct_only(strategy)), from_all_sides(3.0)),
        )
        for strategy in DELTA
    ]


def cases() -> list[Case]:
    """These cases of the chapter on direct light."""
    return [*_spots(), *_parallel(), *_amounts(), *_convex()]
