"""C3: energy. In a white furnace, an environment of radiance 1, whatever absorbs nothing is invisible."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.verify import colorimetry, optics, roughness
from accuray.verify.case import Case
from accuray.verify.probes import ImageProbe, RayProbe, Rays, meeting_origin, parallel_beam
from accuray.verify.scenes import (
    PATH,
    Solid,
    Table,
    assemble,
    box,
    diffuse,
    environment,
    glass,
    lamp,
    mirror,
    slab,
    sphere,
    with_strategy,
)

FURNACE = "white furnace: nothing absorbs"
ORIGIN = (0.0, 0.0, 0.0)
TILTED = (0.3, -1.0, 0.2)


def _furnace(
    name: str,
    sentence: str,
    solids: list[Solid],
    expected: float = 1.0,
    source: str = FURNACE,
    integrator: Table = PATH,
    rays: Rays | None = None,
) -> Case:
    view = rays or parallel_beam(TILTED, 1.0)
    probe = RayProbe(assemble(solids, [environment()], integrator), view, spp=16, start=64, group=256)
    return Case(f"C3.{name}", sentence, source, (expected,), probe)


def _furnaces() -> list[Case]:
    white = diffuse(1.0)
    pair = [sphere((-0.7, 0, 0), 0.7, white), sphere((0.7, 0, 0), 0.7, white)]
    bubble = [sphere(ORIGIN, 1.0, glass(1.5)), sphere((0.1, 0.2, 0), 0.5, glass(1.0 / 1.5))]
    watery = [sphere(ORIGIN, 1.0, glass(1.5)), sphere((0.1, 0.2, 0), 0.5, glass(1.33 / 1.5))]
    rows = [
        _furnace("glass-sphere", "A glass sphere, n = 1.5", [sphere(ORIGIN, 1.0, glass(1.5))]),
        _furnace("diamond-sphere", "A sphere of n = 2.417", [sphere(ORIGIN, 1.0, glass(2.417))]),
        _furnace("air-bubble", "A sphere of n = 0.75: a bubble under water", [sphere(ORIGIN, 1.0, glass(0.75))]),
        _furnace("hollow-glass", "A glass sphere with a hollow in it", bubble),
        _furnace("water-in-glass", "A glass sphere with water in it", watery),
        _furnace("mirror-sphere", "A perfect mirror ball", [sphere(ORIGIN, 1.0, mirror())]),
        _furnace(
            "pane-sphere", "A ball of a thin pane", [sphere(ORIGIN, 1.0, {"type": "thin_dielectric", "ior": 1.5})]
        ),
        _furnace("soap-bubble", "A soap bubble, 400 nm thick", [sphere(ORIGIN, 1.0, glass(1.0, film_thickness=400))]),
        _furnace("dispersive-sphere", "A sphere of SF11 glass", [sphere(ORIGIN, 1.0, glass("SF11"))]),
    ]
    rows += [
        _furnace(
            f"white-sphere/{strategy}",
            "A Lambertian sphere of albedo 1",
            [sphere(ORIGIN, 1.0, white)],
            integrator=with_strategy(strategy),
        )
        for strategy in ("mis", "light", "bsdf", "reference")
    ]
    rows += [
        _furnace(
            f"white-pair/{strategy}",
            "Two touching Lambertian spheres of albedo 1 light each other",
            pair,
            integrator=with_strategy(strategy),
            rays=parallel_beam(TILTED, 1.2),
        )
        for strategy in ("mis", "light", "reference")
    ]
    for degrees in (0, 60, 85):
        sentence = f"A glass slab at {degrees} degrees: what it does not transmit it reflects"
        rays = meeting_origin(math.radians(degrees))
        rows.append(_furnace(f"slab-{degrees}", sentence, slab(1.5, 1e-3), rays=rays))
    dielectric_metal = {"type": "conductor", "eta": 1.5, "k": 0.0}
    rows.append(
        _furnace(
            "conductor-without-k",
            "A ball of a metal with n = 1.5, k = 0 reflects what a glass surface does",
            [sphere(ORIGIN, 1.0, dielectric_metal)],
            optics.diffuse_reflectance(1.5),
            "Walsh 1926",
        )
    )
    return rows


def _average(image: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(image[:, :, :3].mean(axis=(0, 1)))


def _film(size: int) -> Table:
    return {"width": size, "height": size, "filter": {"type": "box"}}


def _images() -> list[Case]:
    """The same through the camera and the film: D65 is the white of the picture."""
    white = tuple(float(c) for c in colorimetry.rec709(colorimetry.xyz(colorimetry.illuminant("D65"))))
    objects = [
        sphere((-1.1, 0, 0), 1.0, glass(1.5)),
        sphere((1.1, 0, 0), 1.0, mirror()),
        sphere((0, 1.8, 0), 0.9, diffuse(1.0)),
    ]
    camera: dict[str, Any] = {"type": "perspective", "position": [0, 0.5, 8], "look_at": [0, 0.5, 0], "fov": 35.0}
    furnace = assemble(objects, [environment("D65")], film=_film(16), camera=camera)
    inside = {"type": "perspective", "position": [0.1, -0.2, 0.3], "look_at": [0, 0, -0.5], "fov": 90.0}
    room = assemble(box(diffuse(0.8, "D65")), film=_film(8), camera=inside)
    distance, field = 4.0, math.radians(40.0)
    ahead = {"type": "perspective", "position": [0, 0, distance], "look_at": [0, 0, 0], "fov": 40.0}
    ball = assemble([sphere(ORIGIN, 1.0, lamp("D65"))], film=_film(32), camera=ahead)
    tangent = math.tan(math.asin(1.0 / distance)) / (2.0 * math.tan(0.5 * field))
    area = math.pi * tangent**2
    rgb = ("R", "G", "B")
    return [
        Case(
            "C3.image-furnace",
            "Image of glass, mirror and white balls under D65: white everywhere",
            FURNACE,
            white,
            ImageProbe(furnace, _average),
            rgb,
        ),
        Case(
            "C3.image-box",
            "Image from inside a glowing box of albedo 0.8",
            "L = Le + rho L",
            tuple(5.0 * c for c in white),
            ImageProbe(room, _average),
            rgb,
        ),
        Case(
            "C3.image-area",
            "Area of a glowing ball in the image: pi tan^2(asin(r / d)) of the focal length squared",
            "central projection of a sphere",
            (area,),
            ImageProbe(ball, lambda image: colorimetry.luminance(_average(image))),
        ),
    ]


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [*_furnaces(), *_images(), *roughness.cases()]
