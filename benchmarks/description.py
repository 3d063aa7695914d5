"""What a benchmark scene is made of, and the colours that they share.

``benchmarks.scenes`` writes it for every renderer. Colours are mixtures of the Cornell box's measured paints, so that
their spectra are tables and their linear Rec.709 colours the same mixtures.
"""

import csv
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.geometry import Mesh

DATA = Path(__file__).parents[1] / "accuray" / "data"
VISIBLE = (360.0, 830.0)

RGB = {
    "white": (0.738376, 0.735961, 0.738503),
    "green": (0.068429, 0.398447, 0.086546),
    "red": (0.493966, 0.048867, 0.051152),
    "lamp": (0.78, 0.78, 0.78),
    "emission": (20.720144, 10.854298, 2.770084),
}
"""Linear Rec.709, CIE 1931 observer: reflectances under D65; the lamp's radiance with Y = integral(L ybar) /
integral(ybar), the lamp being dark outside 400-700 nm."""


@dataclass(frozen=True)
class Spectrum:
    """Samples at wavelengths in nm, linear between them, and the RGB that stands for it in RGB renderers."""

    wavelengths: tuple[float, ...]
    values: tuple[float, ...]
    rgb: tuple[float, float, float]


@dataclass(frozen=True)
class Material:
    """What a surface is made of: ``kind`` is diffuse, conductor or dielectric.

    A diffuse one has a reflectance or the name of a picture in sRGB that is repeated over the surface; the others have
    ``eta`` and ``k``, the same for all wavelengths, and GGX facets of this perceived roughness (alpha is its square),
    which lose what they scatter more than once: the one model that all renderers have.
    """

    kind: str = "diffuse"
    reflectance: Spectrum | None = None
    picture: str = ""
    eta: float = 1.0
    k: float = 0.0
    roughness: float = 0.0


@dataclass(frozen=True)
class Scene:
    """Meshes in metres and what they are made of. Reflectances cover 360-830 nm; emission ends with its table.

    The surfaces of the material ``emitter`` emit from their fronts; ``lamp_backs`` says that their backs can be seen.
    ``sky`` gives the map of the surroundings its suns: ``benchmarks.sky``. A mesh in ``copies`` is shown only by its
    transforms, (N, 3, 4) of rotations and even scales.
    """

    name: str
    meshes: tuple[Mesh, ...]
    materials: dict[str, Material]
    camera: dict[str, Any]
    emission: Spectrum | None = None
    emitter: str = ""
    lamp_backs: bool = False
    sky: str = ""
    copies: dict[str, NDArray[np.float64]] = field(default_factory=dict)


def grey(value: float) -> Spectrum:
    """The same at all visible wavelengths."""
    return Spectrum(VISIBLE, (value, value), (value, value, value))


def paints() -> dict[str, Spectrum]:
    """The measured reflectances white, red and green."""
    columns = read_columns(DATA / "cornell_box_reflectance.csv")
    return {paint: _hold(Spectrum(columns["wavelength_nm"], columns[paint], RGB[paint])) for paint in PAINTS}


PAINTS = ("white", "red", "green")


def mixed(white: float, red: float, green: float) -> Spectrum:
    """So much of each measured paint, spectrum and colour alike."""
    parts = list(zip((white, red, green), paints().values(), strict=True))
    values = sum(share * np.array(paint.values) for share, paint in parts)
    rgb = sum(share * np.array(paint.rgb) for share, paint in parts)
    return Spectrum(parts[0][1].wavelengths, tuple(np.asarray(values).tolist()), _triple(rgb))


def _triple(values: Any) -> tuple[float, float, float]:
    r, g, b = np.asarray(values).tolist()
    return r, g, b


def daylight(scale: float) -> Spectrum:
    """D65 with Y = ``scale``: white in Rec.709."""
    cie = read_columns(DATA / "cie1931_2deg_1nm.csv")
    light = read_columns(DATA / "cie_illuminants_300_830_5nm.csv")
    nm, power = (np.array(light[key]) for key in ("wavelength_nm", "D65"))
    y_bar = np.array(cie["ybar"])
    y = y_bar @ np.interp(cie["wavelength_nm"], nm, power) / y_bar.sum()
    seen = nm >= VISIBLE[0]
    return Spectrum(tuple(nm[seen].tolist()), tuple((scale / y * power[seen]).tolist()), (scale, scale, scale))


def cornell_lamp() -> Spectrum:
    """The radiance of the Cornell box's lamp, as measured."""
    light = read_columns(DATA / "cornell_box_light.csv")
    return Spectrum(light["wavelength_nm"], light["relative_radiance"], RGB["emission"])


def cornell_geometry() -> dict[str, Any]:
    """The measured box, in millimetres."""
    page: dict[str, Any] = json.loads((DATA / "cornell_box_geometry.json").read_text())
    return page


def _hold(spectrum: Spectrum) -> Spectrum:
    """Continue a table of even steps with its end values over the visible range, in the same steps.

    Every renderer then sees the same reflectance there, and Mitsuba its faster, evenly spaced kind of table.
    """
    first, last = spectrum.wavelengths[0], spectrum.wavelengths[-1]
    step = spectrum.wavelengths[1] - first
    before, after = math.ceil((first - VISIBLE[0]) / step), math.ceil((VISIBLE[1] - last) / step)
    wavelengths = tuple(first + step * k for k in range(-before, len(spectrum.values) + after))
    values = (spectrum.values[0],) * before + spectrum.values + (spectrum.values[-1],) * after
    return Spectrum(wavelengths, values, spectrum.rgb)


def read_columns(path: Path) -> dict[str, tuple[float, ...]]:
    """Columns of a CSV file whose lines starting with ``#`` are remarks and whose first other line names them."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: tuple(float(row[name]) for row in rows) for name in rows[0]}


def camera(position: Sequence[float], look_at: Sequence[float], fov: float) -> dict[str, Any]:
    """Eye, point looked at, up, and the full field of view of the square film in degrees."""
    return {"position": list(position), "look_at": list(look_at), "up": [0.0, 1.0, 0.0], "fov": fov}
