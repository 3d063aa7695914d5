"""Measured and standardised data that come with the renderer, read from the CSV and JSON files beside this file.

Sources and licences are in README.md here and in the first line of each file. Wavelengths are nanometres.
Every function reads its file on first use and remembers the result; nothing is read on import.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

FOLDER = Path(__file__).resolve().parent

LUMINOUS_EFFICACY = 683.002
"""K_m, lm/W, for the CIE 1931 ybar used here."""

Numbers = tuple[float, ...]


class ColourMatching(NamedTuple):
    """CIE 1931 2-degree observer: wavelengths 360 to 830 nm in steps of 1 nm, and the three functions."""

    wavelengths: Numbers
    x: Numbers
    y: Numbers
    z: Numbers


class Metal(NamedTuple):
    """Complex refractive index n + ik at the published wavelengths; linear between them."""

    wavelengths: Numbers
    n: Numbers
    k: Numbers


class Glass(NamedTuple):
    """Sellmeier coefficients: n^2 = 1 + A0 + sum B L^2 / (L^2 - C), L in micrometres, C in um^2."""

    A0: float
    B: Numbers
    C: Numbers


class Sky(NamedTuple):
    """Coefficients of the spectral sky and sun of Hosek and Wilkie (2012, 2013), flat, the last index fastest.

    sky: band, albedo 0 and 1, turbidity 1 to 10, point of a Bezier curve over the sun's elevation, nine terms.
    radiance: the same without the terms. sun: band, turbidity, piece of elevations, power from the highest.
    limb: band, power of the cosine from the lowest. The eleven bands are at 320, 360, ... 720 nm.
    """

    sky: Numbers
    radiance: Numbers
    sun: Numbers
    limb: Numbers


def files() -> list[str]:
    """Names of the data files, sorted."""
    return sorted(path.name for path in FOLDER.iterdir() if path.suffix in (".csv", ".ies", ".json"))


@cache
def observer() -> ColourMatching:
    """The colour matching functions."""
    columns = _columns("cie1931_2deg_1nm.csv")
    return ColourMatching(columns["wavelength_nm"], columns["xbar"], columns["ybar"], columns["zbar"])


@cache
def illuminants() -> dict[str, tuple[Numbers, Numbers]]:
    """CIE illuminants: name -> (wavelengths, relative spectral power). Linear between the points."""
    found: dict[str, tuple[Numbers, Numbers]] = {}
    for file in ("cie_illuminants_300_830_5nm.csv", "cie_fluorescent_380_780_5nm.csv"):
        columns = _columns(file)
        wavelengths = columns.pop("wavelength_nm")
        found.update({name: (wavelengths, values) for name, values in columns.items()})
    return found


@cache
def metals() -> dict[str, Metal]:
    """Metals by name."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for line in _lines("metals_nk_native.csv")[1:]:
        name, wavelength, n, k = line.split(",")
        rows.setdefault(name, []).append((float(wavelength), float(n), float(k)))
    return {name: Metal(*zip(*points, strict=True)) for name, points in rows.items()}


@cache
def glasses() -> dict[str, Glass]:
    """Dielectrics with Sellmeier coefficients by name. Most are relative to air, water to vacuum (README)."""
    entries = _json("dielectrics_sellmeier.json").items()
    return {
        name: Glass(float(entry["A0"]), tuple(map(float, entry["B"])), tuple(map(float, entry["C_um2"])))
        for name, entry in entries
        if isinstance(entry, dict) and "B" in entry
    }


@cache
def colour_spaces() -> dict[str, Any]:
    """The parsed rgb_colourspaces.json: RGB spaces with matrices to and from XYZ, Bradford matrices."""
    return _json("rgb_colourspaces.json")


@cache
def teapot() -> tuple[tuple[float, float, float], ...]:
    """Newell's teapot: the control points of 32 Bezier patches, 16 after 16, +Z up (README)."""
    content = _json("newell_teapot.json")
    points = [(float(x), float(y), float(z)) for x, y, z in content["vertices"]]
    return tuple(points[index] for patch in content["patches"] for index in patch)


@cache
def sky() -> Sky:
    """The model of the sky and the sun; radiances come out in W m^-2 sr^-1 nm^-1."""
    content = _json("hosek_wilkie_spectral.json")
    return Sky(*(tuple(_flat(content[key])) for key in ("sky", "sky_radiance", "sun", "limb_darkening")))


def _flat(nested: Any) -> Iterator[float]:
    if isinstance(nested, list):
        for item in nested:
            yield from _flat(item)
    else:
        yield float(nested)


def _lines(file: str) -> list[str]:
    """Header and rows of a CSV file without comments."""
    text = (FOLDER / file).read_text(encoding="utf-8")
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def _columns(file: str) -> dict[str, Numbers]:
    header, *rows = (line.split(",") for line in _lines(file))
    return {name: tuple(map(float, column)) for name, column in zip(header, zip(*rows, strict=True), strict=True)}


def _json(file: str) -> dict[str, Any]:
    import json

    content: dict[str, Any] = json.loads((FOLDER / file).read_text(encoding="utf-8"))
    return content
