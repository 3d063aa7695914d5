"""C9: the sky and the sun. Published values of the model, irradiance by quadrature, and discs of closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from accuray.verify.case import Case, FloatArray, mean_and_error
from accuray.verify.probes import RayProbe, fixed, looking_at
from accuray.verify.scenes import assemble, diffuse, direct_only, disk

ALBEDO = 0.5
UP = (0.0, 1.0, 0.0)
MODEL = "Hosek and Wilkie 2012"
#: (wavelength, turbidity, albedo, elevation of the sun, zenith angle, angle from the sun), nm and degrees -> radiance
SEEN = {
    (560, 3.0, 0.3, 45, 45, 60): 0.0488011851,
    (440, 2.5, 0.1, 20, 10, 75): 0.0462402417,
    (640, 8.0, 0.0, 70, 60, 50): 0.0859342526,
}
#: (wavelength, turbidity, albedo, elevation of the sun) -> irradiance of level ground without the sun's disc
ON_THE_GROUND = {(560, 3.0, 0.2, 45): 0.213975478, (440, 6.0, 0.5, 10): 0.189839942}
#: the same with the disc
UNDER_THE_SUN = {(560, 3.0, 0.2, 45): 1.01507578, (680, 1.0, 0.2, 5): 0.102095914}


def sky(turbidity: float, albedo: float, elevation: float, **more: Any) -> dict[str, Any]:
    """A sky whose sun stands over -Z."""
    return {"type": "sky", "turbidity": turbidity, "ground_albedo": albedo, "elevation": elevation, **more}


def _view(elevation: float, zenith: float, gamma: float) -> tuple[float, float, float]:
    """A direction at a zenith angle and an angle from a sun over -Z, degrees."""
    e, z, g = map(math.radians, (elevation, zenith, gamma))
    turn = math.acos((math.cos(g) - math.cos(z) * math.sin(e)) / (math.sin(z) * math.cos(e)))
    return math.sin(z) * math.sin(turn), math.cos(z), -math.sin(z) * math.cos(turn)


def _floor(light: dict[str, Any], normal: tuple[float, float, float], strategy: str, wavelength: float) -> RayProbe:
    """Irradiance on a diffuse disc."""
    scene = assemble([disk((0, 0, 0), normal, 1.0, diffuse(ALBEDO))], [light], direct_only(strategy))
    return RayProbe(scene, looking_at((0, 0, 0), normal), math.pi / ALBEDO, (wavelength,))


def _sky() -> list[Case]:
    rows = []
    for (wavelength, turbidity, albedo, elevation, zenith, gamma), value in SEEN.items():
        rows.append(
            Case(
                f"C9.sky-{wavelength}nm",
                f"The sky at {wavelength} nm, {zenith} degrees from the zenith and {gamma} from the sun",
                MODEL,
                (value,),
                RayProbe(
                    assemble([], [sky(turbidity, albedo, elevation)]),
                    fixed((0, 0, 0), _view(elevation, zenith, gamma)),
                    wavelengths=(float(wavelength),),
                ),
            )
        )
    for sun, table in ((False, ON_THE_GROUND), (True, UNDER_THE_SUN)):
        for (wavelength, turbidity, albedo, elevation), value in table.items():
            rows.extend(
                Case(
                    f"C9.ground-{wavelength}nm{'-sun' if sun else ''}/{strategy}",
                    f"Irradiance on level ground at {wavelength} nm of the sky {'with' if sun else 'without'} its sun, "
                    f"{elevation} degrees up",
                    "quadrature over the dome and the darkened disc" if sun else "quadrature over the dome",
                    (value,),
                    _floor(sky(turbidity, albedo, elevation, sun=sun), UP, strategy, wavelength),
                )
                for strategy in (("mis", "light") if sun else ("mis", "light", "reference"))
            )
    return rows


def _luminance(batches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Y of XYZ."""
    return mean_and_error(batches[:, 1:2])


def _suns() -> list[Case]:
    rows = []
    for tilt, factor in ((0.0, 1.0), (60.0, 0.5)):
        angle = math.radians(tilt)
        normal = (math.sin(angle), math.cos(angle), 0.0)
        for strategy in ("mis", "light"):
            sun = {"type": "sun", "elevation": 90, "irradiance": 2.0}
            rows.append(
                Case(
                    f"C9.sun-{tilt:.0f}/{strategy}",
                    f"A sun of irradiance 2 on a plane turned away by {tilt:.0f} degrees",
                    "irradiance times the cosine",
                    (2.0 * factor,),
                    _floor(sun, normal, strategy, 550.0),
                )
            )
    radius = math.radians(0.533 / 2)
    rows.append(
        Case(
            "C9.sun-seen",
            "The radiance of the sun's disc is its irradiance over pi sin^2 of its radius",
            "integral of the cosine over a disc",
            (2.0 / (math.pi * math.sin(radius) ** 2),),
            RayProbe(assemble([], [{"type": "sun", "elevation": 90, "irradiance": 2.0}]), fixed((0, 0, 0), UP)),
        )
    )
    return rows


def _maps() -> list[Case]:
    """A map with one bright texel: a tent of the bilinear surface, 2 cells wide on both axes."""
    height, width, row = 16, 32, 5
    pixels = np.zeros((height, width))
    pixels[row, 3] = 1000.0
    d = math.pi / height
    middle = (row + 0.5) * d
    tent = 0.5 * math.sin(2.0 * middle) * (1.0 - math.cos(2.0 * d)) / (2.0 * d)
    return [
        Case(
            f"C9.texel/{strategy}",
            "Irradiance of one bright texel of an environment map, Y of white light",
            "integral of the bilinear tent",
            (1000.0 * 2.0 * math.pi / width * tent,),
            RayProbe(
                assemble(
                    [disk((0, 0, 0), UP, 1.0, diffuse(ALBEDO))],
                    [{"type": "environment", "pixels": pixels.tolist()}],
                    direct_only(strategy),
                ),
                looking_at((0, 0, 0), UP),
                math.pi / ALBEDO,
                space="xyz",
            ),
            summary=_luminance,
        )
        for strategy in ("mis", "light")
    ]


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [*_sky(), *_suns(), *_maps()]
