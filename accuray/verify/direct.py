"""C1: direct light on a Lambertian point, in closed form, by every way of sampling it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from accuray.verify import form_factors, lamps
from accuray.verify.case import Case, FloatArray
from accuray.verify.probes import RayProbe, from_all_sides, looking_at
from accuray.verify.receiver import ALBEDO, ALL, SAMPLED, UP, receiver, rows_of
from accuray.verify.scenes import (
    Solid,
    Table,
    assemble,
    black,
    diffuse,
    direct_only,
    disk,
    environment,
    lamp,
    point_light,
    polygon,
    rectangle,
    sphere,
    square,
)

DOWN = (0.0, -1.0, 0.0)

#: Cornell's lamp, four receivers (point, normal), lengths in millimetres (Cornell box data, 1998).
CORNELL_LAMP = ((343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0))
CORNELL_POINTS = {
    "floor-centre": ((278.0, 0.0, 279.5), UP),
    "floor-corner": ((0.0, 0.0, 0.0), UP),
    "floor-side": ((400.0, 0.0, 100.0), UP),
    "green-wall": ((0.0, 274.4, 279.6), (1.0, 0.0, 0.0)),
}


def _disks() -> list[Case]:
    overhead = disk((0, 2, 0), DOWN, 1.0, lamp())
    shadow = rectangle((0, 1, -5), (5, 0, 0), (0, 0, 10), black())
    rows = rows_of(
        "disk-on-axis",
        "A disk lamp straight above, F = R^2 / (R^2 + h^2)",
        "rings of cos cos / (pi d^2)",
        form_factors.disk_on_axis(1.0, 2.0),
        [overhead],
        (*ALL, "direct"),
    )
    rows += rows_of(
        "disk-off-axis",
        "A disk lamp shifted by 1.5 radii",
        "Howell B-13",
        form_factors.disk_off_axis(1.0, 1.0, 1.5),
        [disk((1.5, 1, 0), DOWN, 1.0, lamp())],
        ALL,
    )
    rows += rows_of(
        "penumbra",
        "A disk lamp half covered by a blocker whose edge crosses the axis: half the light",
        "symmetry",
        0.5 * form_factors.disk_on_axis(1.0, 2.0),
        [overhead, shadow],
        ALL,
    )
    rows += rows_of(
        "disk-behind",
        "The back of a one-sided lamp is dark",
        "definition of emission_sides",
        0.0,
        [disk((0, 2, 0), UP, 1.0, lamp())],
        ALL,
    )
    rows += rows_of(
        "disk-two-sided",
        "A two-sided lamp seen from its back shines as from its front",
        "definition of emission_sides",
        form_factors.disk_on_axis(1.0, 2.0),
        [disk((0, 2, 0), UP, 1.0, lamp(sides="both"))],
        SAMPLED,
    )
    return rows


def _rectangles() -> list[Case]:
    corner = form_factors.rectangle_above_corner(1.0, 1.0, 1.0)
    centre = 4.0 * corner
    near = 4.0 * form_factors.rectangle_above_corner(0.5, 0.5, 0.1)
    unit = square((0, 0, 0), DOWN, 1.0, lamp())
    moved: Solid = (
        {**unit[0], "transform": [{"rotate": {"axis": [0, 1, 0], "angle": "90 deg"}, "scale": 2.0}, _lift(1.0)]},
        unit[1],
    )
    rows = rows_of(
        "rectangle-corner",
        "A square lamp with one corner straight above",
        "Howell B-5",
        corner,
        [rectangle((0, 1, 0), (1, 0, 0), (0, 0, 1), lamp())],
        ALL,
    )
    rows += rows_of(
        "rectangle-centre", "A square lamp of 2 x 2 at height 1", "Howell B-5", centre, [_overhead(2.0, 1.0)], ALL
    )
    rows += rows_of(
        "rectangle-scaled",
        "The same lamp as a unit square scaled by 2: emitted flux follows the scaled area",
        "Howell B-5",
        centre,
        [moved],
        (*SAMPLED, "reference"),
    )
    rows += rows_of(
        "rectangle-near",
        "A square lamp at a tenth of its width: no blow-up of 1/d^2",
        "Howell B-5",
        near,
        [_overhead(1.0, 0.1)],
        ("mis", "light", "bsdf"),
    )
    return rows


def _overhead(size: float, height: float) -> Solid:
    return square((0, height, 0), DOWN, size, lamp())


def _lift(height: float) -> Table:
    return {"translate": [0.0, height, 0.0]}


def _triangles() -> list[Case]:
    octant = [(1, 0, 0), (0, 0, 1), (0, 1, 0)]
    normal = np.ones(3) / math.sqrt(3.0)
    rows = rows_of(
        "octant-triangle",
        "A triangle that fills an octant of directions, F = sqrt(3) / 4",
        "Lambert 1760",
        form_factors.polygon(octant, (0, 0, 0), normal),
        [polygon(octant, lamp())],
        ALL,
        normal=normal,
    )
    pentagon = [(1.2, 1.0, 0.1), (0.4, 1.4, -0.9), (-1.1, 1.6, -0.6), (-0.9, 1.2, 0.9), (0.5, 0.9, 1.1)]
    flat = _flattened(pentagon)
    rows += rows_of(
        "pentagon",
        "A slanted pentagon, split into triangles",
        "Lambert 1760",
        form_factors.polygon(flat, (0, 0, 0), UP),
        [polygon(flat, lamp(sides="both"))],
        SAMPLED,
    )
    return rows


def _flattened(points: ArrayLike) -> FloatArray:
    """The points moved vertically onto their least-squares plane y = a + b x + c z."""
    p = np.asarray(points, dtype=np.float64)
    design = np.stack([np.ones(len(p)), p[:, 0], p[:, 2]], axis=1)
    p[:, 1] = design @ np.linalg.lstsq(design, p[:, 1], rcond=None)[0]
    return p


def _cornell() -> list[Case]:
    """The measured box's lamp over its bare walls; lengths in millimetres test the unit of the scene file."""
    light = polygon(CORNELL_LAMP, lamp())
    light[0]["faces"] = [[0, 1, 2, 3]]
    rows = []
    for name, (point, normal) in CORNELL_POINTS.items():
        factor = form_factors.polygon(CORNELL_LAMP, point, normal)
        for strategy in SAMPLED:
            solids = [receiver(point, normal, 1.0), light]
            scene = assemble(solids, (), direct_only(strategy), length_unit="mm")
            view = looking_at(1e-3 * np.asarray(point), normal, 1e-4)
            probe = RayProbe(scene, view)
            sentence = f"Cornell's lamp on the {name.replace('-', ' ')}, blocks removed"
            rows.append(Case(f"C1.cornell-{name}/{strategy}", sentence, "Lambert 1760", (ALBEDO * factor,), probe))
    return rows


def _spheres() -> list[Case]:
    rows = []
    for degrees in (0, 45, 80, 100):
        theta = math.radians(degrees)
        center = (2.0 * math.sin(theta), 2.0 * math.cos(theta), 0.0)
        strategies = ALL if degrees < 80 else (*SAMPLED, "reference")
        cut = ", cut by the horizon" if degrees >= 80 else ""
        rows += rows_of(
            f"sphere-{degrees}",
            f"A sphere lamp at {degrees} degrees from the normal{cut}",
            "Howell B-46",
            form_factors.sphere(1.0, 2.0, theta),
            [sphere(center, 1.0, lamp())],
            strategies,
        )
    rows += rows_of(
        "sphere-tiny",
        "A sphere lamp of a milliradian: its solid angle survives single precision",
        "Howell B-46",
        form_factors.sphere(1e-3, 1.0, math.radians(30)),
        [sphere((0.5, math.sqrt(0.75), 0), 1e-3, lamp())],
        SAMPLED,
    )
    return rows


def _delta_and_environment() -> list[Case]:
    """Irradiances become factors on division by pi."""
    position = (2.0 * math.sin(math.pi / 3), 1.0, 0.0)
    bright, dim = point_light(position, 10.0), point_light((0, 2, 0), 0.4)
    irradiance = 10.0 * 0.5 / 4.0
    rows = rows_of(
        "point",
        "A point light at 60 degrees, E = I cos / d^2",
        "inverse square law",
        irradiance / math.pi,
        [],
        (*SAMPLED, "reference", "direct"),
        [bright],
    )
    rows += rows_of(
        "two-points",
        "Two point lights of unequal power: the choice of a light is paid back",
        "inverse square law",
        (irradiance + 0.1) / math.pi,
        [],
        (*SAMPLED, "reference"),
        [bright, dim],
    )
    sources = [disk((0, 2, 0), DOWN, 1.0, lamp()), sphere((-1.5, 1.5, 0), 0.5, lamp(3.0))]
    total = form_factors.disk_on_axis(1.0, 2.0) + irradiance / math.pi
    total += 3.0 * form_factors.sphere(0.5, math.hypot(1.5, 1.5), math.pi / 4)
    rows += rows_of(
        "three-kinds",
        "A disk, a sphere and a point light together: light adds up",
        "sum of the closed forms",
        total,
        sources,
        (*SAMPLED, "reference"),
        [bright],
    )
    for strategy in ALL:
        scene = assemble([sphere((0, 0, 0), 1.0, diffuse(ALBEDO))], [environment()], direct_only(strategy))
        rows.append(
            Case(
                f"C1.environment/{strategy}",
                "A convex Lambertian body in a constant environment shows rho L everywhere",
                "integral of the cosine",
                (ALBEDO,),
                RayProbe(scene, from_all_sides(3.0)),
            )
        )
    return rows


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [
        *_disks(),
        *_rectangles(),
        *_triangles(),
        *_cornell(),
        *_spheres(),
        *_delta_and_environment(),
        *lamps.cases(),
    ]
