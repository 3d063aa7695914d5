"""Exposure as a photographer sets it: film speed, time and f-number as stops of the displayed picture."""

from __future__ import annotations

import math
from typing import Any

from accuray.scene.errors import Where

LUMINANCE = 683.002 * 106.856895
"""cd/m^2 of a radiance with Y = 1: 683.002 lm/W (CODATA 2018) times the integral of ybar, in nm (CIE 1931)."""

SATURATION = 78.0
"""The exposure that saturates a sensor of speed S is 78/S lx s (ISO 12232:2019, saturation-based speed)."""

LENS = 0.65
"""Exposure behind a lens over (luminance x time / f-number^2): pi/4 times a usual lens's losses (ISO 12232:2019)."""

LARGEST = 60
"""Limit of ``film.exposure``, in EV, both ways."""


def physical_exposure(iso: float, shutter: float, f_number: float) -> float:
    """The exposure in EV that shows as white, 1, the luminance that saturates the sensor.

    A luminance L gives the sensor H = 0.65 L t / N^2 and saturates it at H = 78 / S, so white is at
    L = 120 N^2 / (t S) cd/m^2 (ISO 12232:2019; Lagarde and de Rousiers 2014). ``shutter`` is in seconds. Like an
    exposure in EV it scales what is displayed and no sample, and it knows neither the extension of a close focus nor
    the area that blades cut from the opening.
    """
    white = SATURATION * f_number**2 / (LENS * shutter * iso)
    return math.log2(LUMINANCE / white)


def resolve_exposure(film: dict[str, Any], camera: dict[str, Any], where: Where) -> float:
    """The film's exposure in EV: as given, or by ``iso``, ``shutter`` and the camera's f-number. Raises SceneError."""
    if film["iso"] is None:
        return float(film["exposure"])
    f_number = camera.get("f_number")
    if f_number is None:
        raise where.child("iso").error(
            "needs the camera's f-number", allowed="a perspective camera with f_number, or exposure in EV instead"
        )
    exposure = physical_exposure(film["iso"], film["shutter"], f_number)
    if abs(exposure) > LARGEST:
        raise where.child("iso").error(
            f"makes an exposure of {exposure:.0f} EV with the shutter and the f-number",
            value=film["iso"],
            allowed=f"{-LARGEST} to {LARGEST} EV",
        )
    return exposure
