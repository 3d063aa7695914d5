"""C4: reflection and refraction at smooth interfaces, slabs and metals.

The renderer is unpolarised: every interface reflects (Rs + Rp) / 2. The expected values of slabs are those of this
model; at 60 degrees nature transmits 1.4 % more through a glass slab, because it keeps s and p light apart.
"""

from __future__ import annotations

import math

import numpy as np

from accuray import data
from accuray.verify import coats, films, optics
from accuray.verify.case import Case
from accuray.verify.probes import GREEN, RayProbe, Rays, across_parallelogram, cosine_about, meeting_origin
from accuray.verify.scenes import (
    PATH,
    Solid,
    Table,
    assemble,
    black,
    environment,
    glass,
    lamp,
    metal,
    slab,
    square,
    with_strategy,
)

INDEX = 1.5
UP = (0.0, 1.0, 0.0)
DOWN = (0.0, -1.0, 0.0)
WIDE = 20.0


def _case(
    name: str,
    sentence: str,
    source: str,
    expected: float,
    scene: Table,
    rays: Rays,
    wavelengths: tuple[float, ...] = GREEN,
    spp: int = 4096,
) -> Case:
    probe = RayProbe(scene, rays, wavelengths=wavelengths, spp=spp)
    return Case(f"C4.{name}", sentence, source, (expected,), probe)


def _interface(ior: object = INDEX) -> Solid:
    """A horizontal interface through the origin, glass below."""
    return square((0, 0, 0), UP, WIDE, glass(ior))


def _lid(height: float, normal: tuple[float, float, float], material: Table) -> Solid:
    """A wide horizontal sheet."""
    return square((0, height, 0), normal, 4.0 * WIDE, material)


def _reflectances() -> list[Case]:
    """A sky of radiance 1 seen in the interface; what is refracted ends in a black sheet."""
    outside = assemble([_interface(), _lid(-0.01, UP, black())], [environment()])
    inside = assemble([_interface(), _lid(0.01, DOWN, black())], [environment()])
    brewster = math.atan(INDEX)
    rows = []
    for degrees in (0.0, 45.0, 60.0, math.degrees(brewster), 85.0):
        theta = math.radians(degrees)
        sentence = f"Reflectance of glass (n = 1.5) at {degrees:.4g} degrees"
        expected = optics.fresnel(theta, INDEX)
        rows.append(_case(f"reflect-{degrees:.0f}", sentence, "Fresnel 1823", expected, outside, meeting_origin(theta)))
    for degrees in (0.0, 30.0, 41.0, 41.9, 60.0):
        theta = math.radians(degrees)
        total = ": total reflection" if math.sin(theta) > 1.0 / INDEX else ""
        sentence = f"Reflectance from inside the glass at {degrees:.4g} degrees{total}"
        expected = optics.fresnel(theta, 1.0 / INDEX)
        rays = meeting_origin(theta, below=True)
        rows.append(_case(f"inside-{degrees:.4g}", sentence, "Fresnel 1823", expected, inside, rays))
    mean = optics.diffuse_reflectance(INDEX)
    rays = cosine_about((0, 0.1, 0), DOWN)
    probe = RayProbe(outside, rays, spp=16, start=64, group=1024)
    rows.append(Case("C4.diffuse-outside", "Reflectance of glass for diffuse light", "Walsh 1926", (mean,), probe))
    mean = optics.diffuse_reflectance_inside(INDEX)
    probe = RayProbe(inside, cosine_about((0, -0.1, 0), UP), spp=16, start=64, group=1024)
    sentence = "Reflectance of glass for diffuse light from inside: 1 - (1 - F) / n^2"
    rows.append(Case("C4.diffuse-inside", sentence, "Duntley 1942", (mean,), probe))
    return rows


def _radiance_scaling() -> list[Case]:
    """Radiance changes with the square of the index across an interface (basic radiance L / n^2)."""
    rows = []
    above = assemble([_interface(), _lid(1.0, DOWN, lamp())])
    below = assemble([_interface(), _lid(-1.0, UP, lamp())])
    for degrees in (0.0, 30.0):
        theta = math.radians(degrees)
        expected = INDEX**2 * (1.0 - optics.fresnel(theta, 1.0 / INDEX))
        sentence = f"An eye inside the glass sees a lamp outside at {degrees:g} degrees as n^2 (1 - R)"
        rays = meeting_origin(theta, below=True)
        rows.append(_case(f"into-glass-{degrees:g}", sentence, "Nicodemus 1963", expected, above, rays))
        expected = (1.0 - optics.fresnel(theta, INDEX)) / INDEX**2
        sentence = f"An eye in air sees a lamp in the glass at {degrees:g} degrees as (1 - R) / n^2"
        rows.append(
            _case(f"out-of-glass-{degrees:g}", sentence, "Nicodemus 1963", expected, below, meeting_origin(theta))
        )
    return rows


def _slabs() -> list[Case]:
    plate = slab(INDEX, 1e-3)
    behind = assemble([*plate, _lid(-0.05, UP, lamp())])
    before = assemble([*plate, _lid(0.1, DOWN, lamp())])
    rows = []
    for degrees in (0.0, 45.0, 60.0, 75.0):
        theta = math.radians(degrees)
        expected = optics.slab_transmittance(optics.fresnel(theta, INDEX))
        sentence = f"A slab of glass at {degrees:g} degrees transmits, all internal reflections"
        series = "Stokes 1862, unpolarised interfaces"
        rows.append(_case(f"slab-T-{degrees:g}", sentence, series, expected, behind, meeting_origin(theta)))
        sentence = f"A slab of glass at {degrees:g} degrees reflects"
        rows.append(_case(f"slab-R-{degrees:g}", sentence, series, 1.0 - expected, before, meeting_origin(theta)))
    reference = assemble([*plate, _lid(-0.05, UP, lamp())], (), with_strategy("reference"))
    expected = optics.slab_transmittance(optics.fresnel(math.radians(60), INDEX))
    sentence = "The slab at 60 degrees by the reference integrator"
    rows.append(_case("slab-T-60/reference", sentence, series, expected, reference, meeting_origin(math.radians(60))))
    for plates in (2, 5):
        pile = [face for i in range(plates) for face in slab(INDEX, 1e-3, top=-2e-3 * i)]
        scene = assemble([*pile, _lid(-0.05, UP, lamp())])
        expected = optics.plates_transmittance(optics.fresnel(0.0, INDEX), plates)
        sentence = f"A pile of {plates} glass plates at normal incidence"
        rows.append(_case(f"plates-{plates}", sentence, "Stokes 1862", expected, scene, meeting_origin(0.0)))
    return rows


def _absorbing_slabs() -> list[Case]:
    """Dyed glass of optical depth 1/2 straight through: Beer's law on every passage between the interfaces."""
    thickness = 1e-3
    plate = slab(INDEX, thickness, transmission_color=math.exp(-0.5), transmission_depth=thickness)
    behind = assemble([*plate, _lid(-0.05, UP, lamp())])
    before = assemble([*plate, _lid(0.1, DOWN, lamp())])
    rows = []
    for degrees in (0.0, 45.0):
        theta = math.radians(degrees)
        way = 1.0 / math.sqrt(1.0 - (math.sin(theta) / INDEX) ** 2)
        transmitted, reflected = optics.absorbing_slab(optics.fresnel(theta, INDEX), math.exp(-0.5 * way))
        source = "Beer 1852 and Stokes 1862, unpolarised interfaces"
        rays = meeting_origin(theta)
        sentence = f"Dyed glass at {degrees:g} degrees transmits"
        rows.append(_case(f"dyed-slab-T-{degrees:g}", sentence, source, transmitted, behind, rays))
        sentence = f"Dyed glass at {degrees:g} degrees reflects"
        rows.append(_case(f"dyed-slab-R-{degrees:g}", sentence, source, reflected, before, rays))
    return rows


def _shift() -> list[Case]:
    """A thick slab moves an oblique beam sideways: the share of a fan of rays that still meets a half-plane lamp.

    Rays at 45 degrees start on a unit segment along x. Without the slab they would meet the lamp's plane between
    x = -1/2 and 1/2, with it `moved` further back; the lamp fills x > -0.3. Two refractions only: ghosts are left out.
    """
    theta, thickness, edge = math.radians(45.0), 1.0, -0.3
    moved = optics.lateral_shift(thickness, theta, INDEX) / math.cos(theta)
    share = 0.5 - moved - edge
    transmitted = (1.0 - optics.fresnel(theta, INDEX)) ** 2
    height, floor = 0.5, -1.5
    run = (height - floor) * math.tan(theta)
    fan = across_parallelogram((-0.5 - run, height, 0.0), (1, 0, 0), (0, 0, 1e-3), (1, -1, 0))
    half = square((edge + 5.0, floor, 0.0), UP, 10.0, lamp())
    scene = assemble([*slab(INDEX, thickness, size=WIDE), half], (), PATH | {"max_depth": 2})
    probe = RayProbe(scene, fan, spp=4, start=64, group=1024)
    sentence = "Sideways shift of rays at 45 degrees by a slab 1 m thick (0.3291 m), seen as a shadow's edge"
    return [Case("C4.lateral-shift", sentence, "Snell, slab geometry", (transmitted * share,), probe)]


def _glasses() -> list[Case]:
    rows = []
    for name in ("N-BK7", "SF11"):
        entry = data.glasses()[name]
        scene = assemble([*slab(name, 1e-3), _lid(-0.05, UP, lamp())])
        for wavelength in (486.1327, 587.5618, 656.2725):
            index = optics.sellmeier(wavelength, entry.A0, entry.B, entry.C)
            expected = optics.slab_transmittance(optics.fresnel(0.0, index))
            sentence = f"A slab of {name} at {wavelength:.1f} nm (n = {index:.5f})"
            rays = meeting_origin(0.0)
            case_id = f"glass-{name}-{wavelength:.0f}"
            rows.append(_case(case_id, sentence, "Sellmeier, Stokes 1862", expected, scene, rays, (wavelength,)))
    return rows


def _metals() -> list[Case]:
    """A sky of radiance 1 in a metal mirror, three wavelengths at once."""
    wavelengths = (450.0, 550.0, 650.0)
    labels = tuple(f"{w:.0f} nm" for w in wavelengths)
    rows = []
    for name in ("Au", "Ag", "Cu", "Al"):
        entry = data.metals()[name]
        indices = [complex(*(np.interp(w, entry.wavelengths, c) for c in (entry.n, entry.k))) for w in wavelengths]
        scene = assemble([square((0, 0, 0), UP, 1.0, metal(name))], [environment()])
        for degrees in (0, 60):
            theta = math.radians(degrees)
            probe = RayProbe(scene, meeting_origin(theta), wavelengths=wavelengths, spp=64)
            expected = tuple(optics.fresnel(theta, index) for index in indices)
            sentence = f"Reflectance of {name} at {degrees} degrees"
            rows.append(Case(f"C4.metal-{name}-{degrees}", sentence, "Fresnel 1823", expected, probe, labels))
    return rows


def cases() -> list[Case]:
    """All cases of this chapter."""
    groups = (_reflectances, _radiance_scaling, _slabs, _absorbing_slabs, _shift, _glasses, _metals)
    return [*(case for group in groups for case in group()), *films.cases(), *coats.cases()]
