"""C4, thin films: soap, coatings and oxides by Airy's formula, three wavelengths at once."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from accuray import data
from accuray.verify import optics
from accuray.verify.case import Case
from accuray.verify.probes import RayProbe, meeting_origin
from accuray.verify.scenes import PATH, Table, assemble, black, disk, environment, glass, lamp, square

WAVELENGTHS = (450.0, 550.0, 650.0)
LABELS = tuple(f"{w:.0f} nm" for w in WAVELENGTHS)
UP, DOWN = (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)
SOURCE = "Airy 1833; Born and Wolf 1999"
COMPENSATED = 0.01
"""What compensation of rough filmed facets may be off by: it knows a film by what it does to diffuse light."""


def _seen(name: str, sentence: str, surface: Table, film: float, behind: Any, thickness: float, degrees: float) -> Case:
    """A sky of radiance 1 in a filmed surface; what passes ends in a black sheet. `behind`: index by wavelength."""
    theta = math.radians(degrees)
    filmed = surface | {"film_thickness": thickness, "film_ior": film}
    scene = assemble(
        [square((0, 0, 0), UP, 20.0, filmed), square((0, -0.01, 0), UP, 80.0, black())], [environment()], PATH
    )
    expected = tuple(optics.film_reflectance(theta, film, behind(w), thickness, w) for w in WAVELENGTHS)
    probe = RayProbe(scene, meeting_origin(theta), wavelengths=WAVELENGTHS, spp=4096)
    return Case(f"C4.film-{name}-{degrees:g}", f"{sentence} at {degrees:g} degrees", SOURCE, expected, probe, LABELS)


def _reflectances() -> list[Case]:
    entry = data.metals()["Ti"]

    def titanium(w: float) -> complex:
        return complex(*(float(np.interp(w, entry.wavelengths, c)) for c in (entry.n, entry.k)))

    rows = []
    for degrees in (0.0, 60.0):
        sentence = "Reflectance of a soap film (n = 1.33) of 300 nm"
        rows.append(_seen("soap", sentence, glass(1.0), 1.33, lambda w: 1.0, 300.0, degrees))
        sentence = "Reflectance of glass (n = 1.5) under 120 nm of n = 1.38"
        rows.append(_seen("coating", sentence, glass(1.5), 1.38, lambda w: 1.5, 120.0, degrees))
        sentence = "Reflectance of titanium under 45 nm of oxide (n = 2.4)"
        metal = {"type": "conductor", "metal": "Ti"}
        rows.append(_seen("oxide", sentence, metal, 2.4, titanium, 45.0, degrees))
    sentence = "Reflectance of glass (n = 1.5) under 20 um of n = 2.2"
    rows.append(_seen("thick", sentence, glass(1.5), 2.2, lambda w: 1.5, 20_000.0, 30.0))
    return rows


def _inside() -> list[Case]:
    """A lamp in the sky seen from inside the coated glass: radiance grows by n^2, and shrinks by what is reflected."""
    theta, film, thickness = math.radians(30.0), 1.38, 120.0
    coated = glass(1.5, film_thickness=thickness, film_ior=film)
    scene = assemble([square((0, 0, 0), UP, 20.0, coated), square((0, 1, 0), DOWN, 80.0, lamp())])
    passed = (1.0 - optics.film_reflectance(theta, film, 1.0, thickness, w, before=1.5) for w in WAVELENGTHS)
    probe = RayProbe(scene, meeting_origin(theta, below=True), wavelengths=WAVELENGTHS, spp=4096)
    sentence = "An eye in coated glass (n = 1.5) sees a lamp outside at 30 degrees as n^2 (1 - R)"
    return [Case("C4.film-inside", sentence, SOURCE, tuple(1.5**2 * t for t in passed), probe, LABELS)]


def _rough() -> list[Case]:
    """Reflection and transmission of frosted coated glass together, as in the bare one's furnace."""
    rows = []
    for alpha in (0.1, 0.3):
        frosted = glass(1.5, roughness=math.sqrt(alpha), film_thickness=120, film_ior=1.38)
        floor = disk((0, -0.1, 0), UP, 1e4, lamp(1.5**2))
        scene = assemble([disk((0, 0, 0), UP, 10.0, frosted), floor], [environment()], PATH | {"max_depth": 1})
        probe = RayProbe(scene, meeting_origin(math.radians(45.0)), wavelengths=WAVELENGTHS, spp=2048, start=64)
        sentence = f"Coated glass of alpha {alpha} at 45 degrees: R + T, compensated"
        source = "white furnace: nothing absorbs"
        case_id = f"C4.film-rough-{alpha}"
        rows.append(Case(case_id, sentence, source, (1.0,) * 3, probe, LABELS, tolerance=COMPENSATED))
    return rows


def cases() -> list[Case]:
    """The films of this chapter."""
    return [*_reflectances(), *_inside(), *_rough()]
