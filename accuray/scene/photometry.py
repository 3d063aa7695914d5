"""Measured light distributions of luminaires: reads the files that lights name.

The readers belong to ``accuray.formats``, which registers them here when it is imported.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.scene.amounts import Amount, scaled_to
from accuray.scene.errors import Where
from accuray.scene.readers import Readers
from accuray.scene.schema import Schema

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ROLE = "photometry"
"""Role of a file parameter that names such a file, and key of what was read in the light's table."""


@dataclass(frozen=True)
class Photometry:
    """Luminous intensities of a luminaire over all directions.

    vertical: float64 (V,), degrees from the nadir, rising, at least 2. horizontal: float64 (H,), degrees, rising from
    0 to 360; a single one stands for all. candela: float64 (H, V), cd, with all factors of the file applied.
    lamp_lumens: flux of the bare lamps, lm; None for absolute photometry.
    """

    vertical: NDArray[np.float64]
    horizontal: NDArray[np.float64]
    candela: NDArray[np.float64]
    lamp_lumens: float | None


_readers: Readers[Photometry] = Readers()
register_photometry_reader = _readers.register


def read_photometries(lights: dict[str, dict[str, Any]], schema: Schema, where: Where) -> None:
    """Adds ``photometry`` to every light that names a file of it, and checks what goes with it. Raises SceneError."""
    for name, light in lights.items():
        for param in schema.family("light").types[light["type"]].params:
            if param.role == ROLE:
                light[ROLE] = _read(light[param.name], where.child(name, param.name))
                _check(light, where.child(name))


def _read(path: Path, where: Where) -> Photometry:
    found = _readers.read(path, where)
    for array in (found.vertical, found.horizontal, found.candela):
        array.flags.writeable = False
    return found


def _check(light: dict[str, Any], where: Where) -> None:
    photometry = light[ROLE]
    if light["lamp_lumens"] is not None and photometry.lamp_lumens is None:
        raise where.child("lamp_lumens").error(
            "needs the lumens of the lamps in the file, which has absolute photometry", allowed="flux or multiplier"
        )
    if not photometry.candela.any() and light["flux"] is not None:
        raise where.child("flux").error("cannot be scaled to: all candelas of the file are 0")
    scaled_to(light["spectrum"], Amount(1.0, luminous=True, flux=False), where.child("spectrum"))
