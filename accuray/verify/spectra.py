"""C8: spectra and colour. Lamps seen directly and paints under them, against exact integrals over the observer."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray import data
from accuray.verify import colorimetry
from accuray.verify.case import Case, chromaticity_and_error, mean_and_error
from accuray.verify.probes import RayProbe, Rays, fixed, meeting_origin, parallel_beam
from accuray.verify.scenes import assemble, diffuse, environment, glass, lamp, sphere, square

OBSERVER = "integral over the CIE 1931 observer"
XYZ = ("X", "Y", "Z")
RGB = ("R", "G", "B")
BRIGHT = (430.0, 560.0, 690.0)

FloatArray = NDArray[np.float64]


def _lamp_view(emission: Any, **probe: Any) -> RayProbe:
    """A lamp seen directly."""
    scene = assemble([square((0, 0, 0), (0, 1, 0), 1.0, lamp(emission))])
    return RayProbe(scene, meeting_origin(0.0), **probe)


def _sky_view(reflectance: Any, emission: Any, **probe: Any) -> RayProbe:
    """A paint under a uniform sky: it shows reflectance times radiance."""
    scene = assemble([sphere((0, 0, 0), 1.0, diffuse(reflectance))], [environment(emission)])
    return RayProbe(scene, fixed((0.3, 3.0, 0.1), (0, -1, 0)), **probe)


def _floats(values: Any) -> tuple[float, ...]:
    return tuple(float(v) for v in values)


def _illuminants() -> list[Case]:
    lights: dict[str, tuple[Any, colorimetry.Spectrum]] = {
        name: (name, colorimetry.illuminant(name)) for name in ("D65", "A", "E", "D50")
    }
    lights |= {f"{t}K": (f"{t} K", colorimetry.blackbody(t)) for t in (2856, 3000, 6500)}
    rows = []
    for name, (emission, spectrum) in lights.items():
        exact = colorimetry.xyz(spectrum)
        rows.append(
            Case(
                f"C8.xy-{name}",
                f"Chromaticity of {name}",
                OBSERVER,
                colorimetry.chromaticity(exact),
                _lamp_view(emission, space="xyz"),
                ("x", "y"),
                chromaticity_and_error,
            )
        )
        absolute = "a black body, absolute" if name.endswith("K") else "an illuminant, scaled to 1"
        probe = _lamp_view(emission, space="xyz")
        rows.append(
            Case(
                f"C8.Y-{name}",
                f"Luminance of {name}: {absolute}",
                OBSERVER,
                (float(exact[1]),),
                probe,
                summary=_second,
            )
        )
    return rows


def _second(batches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The middle column, Y of XYZ, alone."""
    return mean_and_error(batches[:, 1:2])


def _planck() -> list[Case]:
    rows = []
    for kelvin in (3000, 6500):
        expected = _floats(colorimetry.blackbody(kelvin)(np.array(BRIGHT)))
        rows.append(
            Case(
                f"C8.planck-{kelvin}",
                f"Spectral radiance of a black body of {kelvin} K, W m^-2 sr^-1 nm^-1",
                "Planck 1901",
                expected,
                _lamp_view(f"{kelvin} K", wavelengths=BRIGHT, spp=64),
                tuple(f"{w:.0f} nm" for w in BRIGHT),
            )
        )
    return rows


def _white() -> list[Case]:
    exact = colorimetry.xyz(colorimetry.illuminant("D65"))
    equal = colorimetry.xyz(np.ones_like)
    ball = assemble([sphere((0, 0, 0), 1.0, glass("SF11"))], [environment(1.0)])
    beam: Rays = parallel_beam((0.3, -1.0, 0.2), 1.0)
    return [
        Case(
            "C8.white-D65",
            "A white Lambertian surface under D65 is the white of the picture",
            OBSERVER,
            _floats(colorimetry.rec709(exact)),
            _sky_view(1.0, "D65", space="rgb"),
            RGB,
        ),
        Case(
            "C8.white-E",
            "A spectrum of 1 has Y = 1",
            OBSERVER,
            _floats(equal),
            _lamp_view(1.0, space="xyz"),
            XYZ,
        ),
        Case(
            "C8.dispersion",
            "Dispersion by a ball of SF11 loses no colour: hero wavelengths alone or in company give one answer",
            "white furnace",
            _floats(equal),
            RayProbe(ball, beam, space="xyz", spp=256, start=64, group=64),
            XYZ,
        ),
        Case(
            "C8.line",
            "A lamp of one triangular line 4 nm wide at 532 nm",
            OBSERVER,
            _floats(colorimetry.xyz(colorimetry.table((530, 532, 534), (0.0, 1.0, 0.0), "zero"))),
            _lamp_view({"wavelengths": [530, 532, 534], "values": [0.0, 1.0, 0.0]}, space="xyz"),
            XYZ,
        ),
        Case(
            "C8.grey-rgb",
            "An RGB grey of 0.5 reflects half at every wavelength",
            "Jakob and Hanika 2019, equal components",
            (0.5, 0.5, 0.5),
            _sky_view([0.5, 0.5, 0.5], 1.0, wavelengths=BRIGHT, spp=256),
            tuple(f"{w:.0f} nm" for w in BRIGHT),
        ),
    ]


def _columns(file: str) -> dict[str, tuple[float, ...]]:
    """Columns of one of the data tables, by name."""
    with (data.FOLDER / file).open(encoding="utf-8") as lines:
        header, *rows = (line.strip().split(",") for line in lines if not line.startswith("#"))
    return {name: _floats(column) for name, column in zip(header, zip(*rows, strict=True), strict=True)}


def _paints() -> list[Case]:
    """Paints under D65 in XYZ and RGB, and under the box's own lamp in units of the lamp's Y."""
    paints = _columns("cornell_box_reflectance.csv")
    wavelengths = paints["wavelength_nm"]
    lamp_wavelengths, lamp_values = _columns("cornell_box_light.csv").values()
    # Nothing was measured beyond 700 nm: the lamp ends within one nanometre, not with a jump that has no given side.
    lamp_wavelengths, lamp_values = (*lamp_wavelengths, 701.0), (*lamp_values, 0.0)
    warm = colorimetry.table(lamp_wavelengths, lamp_values, "zero")
    warm_xyz = colorimetry.xyz(warm)
    emission = {"wavelengths": list(lamp_wavelengths), "values": list(lamp_values), "scale": 1.0 / float(warm_xyz[1])}
    daylight = colorimetry.illuminant("D65")
    rows = [
        Case(
            "C8.cornell-lamp-xy",
            "Chromaticity of Cornell's lamp",
            OBSERVER,
            colorimetry.chromaticity(warm_xyz),
            _lamp_view(emission, space="xyz"),
            ("x", "y"),
            chromaticity_and_error,
        ),
        Case(
            "C8.cornell-lamp-rgb",
            "Cornell's lamp in linear Rec.709 per unit of Y",
            OBSERVER,
            _floats(colorimetry.rec709(warm_xyz / warm_xyz[1])),
            _lamp_view(emission, space="rgb"),
            RGB,
        ),
    ]
    for name in ("white", "green", "red"):
        reflectance = {"wavelengths": list(wavelengths), "values": list(paints[name])}
        paint = colorimetry.table(wavelengths, paints[name])
        day = colorimetry.xyz(colorimetry.product(paint, daylight))
        evening = colorimetry.xyz(colorimetry.product(paint, warm)) / warm_xyz[1]
        views: list[tuple[str, str, Any, FloatArray, tuple[str, ...]]] = [
            ("d65-xyz", "under D65", "D65", day, XYZ),
            ("d65-rgb", "under D65, linear Rec.709", "D65", colorimetry.rec709(day), RGB),
            ("lamp-xyz", "under Cornell's lamp", emission, evening, XYZ),
        ]
        for key, where, light, exact, labels in views:
            probe = _sky_view(reflectance, light, space=key[-3:])
            sentence = f"Cornell's {name} paint {where}"
            rows.append(Case(f"C8.{name}-{key}", sentence, OBSERVER, _floats(exact), probe, labels))
    return rows


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [*_illuminants(), *_planck(), *_white(), *_paints()]
