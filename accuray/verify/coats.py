"""C4, coats: a layer on matte, metallic and transparent bases, with all reflections between its surface and the base.

The layer's surface reflects unpolarised light as (Rs + Rp) / 2, as every interface does here, so that what goes to and
fro is a geometric series.
"""

from __future__ import annotations

import math

from accuray.verify import optics
from accuray.verify.case import Case
from accuray.verify.probes import RayProbe, meeting_origin
from accuray.verify.scenes import PATH, Table, assemble, coat, diffuse, disk, environment, glass, lamp

INDEX = 1.5
DEGREES = (0.0, 60.0)
COMPENSATED = 0.005
"""What a rough coat's compensation may be off by: its tables are interpolated."""


def plastic_albedo(theta: float, albedo: float, index: float) -> float:
    """Light that a smooth coat on Lambert's law returns (Saunderson 1942), absorbed by the base alone."""
    outside, inside = optics.fresnel(theta, index), optics.diffuse_reflectance_inside(index)
    return outside + (1.0 - outside) * (1.0 - inside) * albedo / (1.0 - albedo * inside)


def stack(first: float, second: float, share: float = 1.0) -> tuple[float, float]:
    """Reflectance and transmittance of two interfaces and the layer between, which lets `share` through each time."""
    series = 1.0 / (1.0 - first * second * share**2)
    return first + (1.0 - first) ** 2 * share**2 * second * series, (1.0 - first) * (1.0 - second) * share * series


def inside(theta: float, index: float) -> float:
    """Angle of the refracted ray (Snell)."""
    return math.asin(math.sin(theta) / index)


def _case(name: str, sentence: str, source: str, expected: float, plate: Table, theta: float, floor: float) -> Case:
    """A coated plate in a sky of radiance 1; `floor` is the radiance of what is seen through it."""
    solids = [disk((0, 0, 0), (0, 1, 0), 10.0, plate), disk((0, -0.1, 0), (0, 1, 0), 1e4, lamp(floor))]
    scene = assemble(solids, [environment()], PATH | {"max_depth": 1})
    probe = RayProbe(scene, meeting_origin(theta), spp=4096)
    tolerance = COMPENSATED if "rough" in name else 0.0
    return Case(f"C4.coat-{name}", sentence, source, (expected,), probe, tolerance=tolerance)


def _matte() -> list[Case]:
    rows = []
    for degrees in DEGREES:
        theta = math.radians(degrees)
        for albedo in (0.5, 1.0):
            expected = plastic_albedo(theta, albedo, INDEX)
            sentence = f"Plastic of albedo {albedo} at {degrees:g} degrees: all light that it returns"
            plate = coat(diffuse(albedo), ior=INDEX)
            name = f"plastic-{albedo}-{degrees:g}"
            rows.append(_case(name, sentence, "Saunderson 1942", expected, plate, theta, 0.0))
    sentence = "White under a rough clear coat at 60 degrees"
    plate = coat(diffuse(1.0), ior=INDEX, roughness=0.5)
    rows.append(_case("rough-white", sentence, "white furnace", 1.0, plate, math.radians(60.0), 0.0))
    return rows


def _metals() -> list[Case]:
    eta, k, layer = 0.4, 2.5, 1.5
    rows = []
    for degrees in DEGREES:
        theta = math.radians(degrees)
        below = inside(theta, layer)
        second = optics.fresnel(below, complex(eta, k) / layer)
        for share in (1.0, 0.5):
            expected = stack(optics.fresnel(theta, layer), second, share ** (1.0 / math.cos(below)))[0]
            colour = "clear" if share == 1.0 else "absorbing"
            sentence = f"Metal (n = {eta} + {k} i) under a {colour} coat at {degrees:g} degrees"
            plate = coat({"type": "conductor", "eta": eta, "k": k}, ior=layer, transmission_color=share)
            name = f"metal-{colour}-{degrees:g}"
            rows.append(_case(name, sentence, "Stokes 1862", expected, plate, theta, 0.0))
    return rows


def _glasses() -> list[Case]:
    """Glass of index n, coated: reflection of the sky, and transmission of a floor of radiance n^2."""
    rows = []
    for layer, body in ((1.33, 1.8), (1.5, 1.0)):
        for degrees in DEGREES:
            theta = math.radians(degrees)
            first, second = optics.fresnel(theta, layer), optics.fresnel(inside(theta, layer), body / layer)
            share = 0.5 ** (1.0 / math.cos(inside(theta, layer)))
            reflected, transmitted = stack(first, second, share)
            what = f"Glass of index {body} under an absorbing layer of index {layer} at {degrees:g} degrees: R + T"
            plate = coat(glass(body), ior=layer, transmission_color=0.5)
            name, floor = f"glass-{layer}-{degrees:g}", body**2
            rows.append(_case(name, what, "Stokes 1862", reflected + transmitted, plate, theta, floor))
    return rows


def cases() -> list[Case]:
    """The coated part of this chapter."""
    return [*_matte(), *_metals(), *_glasses()]
