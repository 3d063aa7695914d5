"""Emissions that say how much light a whole emitter gives: spread over its directions or its surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray.devices.instancing import Instancing, scales
from accuray.scene import Spectrum
from accuray.scene.amounts import folded, lumens_per_y
from accuray.scene.motion import Motion, matrices_of
from accuray.scene.photometry import ROLE
from accuray.scene.spectrum import xyz

Values = dict[str, Any]
#: Name and table of a shape -> positions (N, 3) and faces (M, 3) of its triangles.
Meshed = Callable[[str, Values], Any]

SAME_AREA = 1e-4
"""Areas this close, relatively, are the same."""


class Lamp(NamedTuple):
    """A named light as the builder takes it: its spectrum, and the angles and candelas of a measured one."""

    emission: Spectrum
    photometry: tuple[NDArray[np.float64], ...] | None


def lamp(light: Values, numbers: Values, power: Callable[..., float]) -> Lamp:
    """A named light whose flux, if it gives one, is spread over its directions.

    Args:
        light: the light's resolved table.
        numbers: the builder's values of it; spectra may be missing.
        power: ``accuray._core.lower.lamp_power``.
    """
    emission: Spectrum = next(value for value in light.values() if isinstance(value, Spectrum))
    if ROLE in light:
        measured = light[ROLE]
        photometry = (measured.vertical, measured.horizontal, np.ascontiguousarray(measured.candela.ravel()))
        factor = light["multiplier"] / (lumens_per_y() * xyz(emission)[1])
        if light["flux"] is not None:
            factor *= light["flux"] / power(light["type"], numbers, photometry)
        elif light["lamp_lumens"] is not None:
            factor *= light["lamp_lumens"] / measured.lamp_lumens
        return Lamp(folded(emission, factor), photometry)
    if emission.flux:
        emission = replace(folded(emission, 1.0 / power(light["type"], numbers, None)), flux=False)
    return Lamp(emission, None)


def spread_emissions(
    materials: dict[str, Values], shapes: dict[str, Values], instancing: Instancing, meshed: Meshed
) -> dict[str, Values]:
    """The materials with radiances in place of fluxes, each of which is that of every shape that has the material.

    Raises ValueError(problem, key) for a material whose shapes differ in area.
    """
    result = dict(materials)
    for name, material in materials.items():
        emission = material["emission"]
        if not isinstance(emission, Spectrum) or not emission.flux:
            continue
        areas = _areas_with(name, shapes, instancing, meshed)
        least, most = areas.min(), areas.max()
        if most > (1.0 + SAME_AREA) * least:
            raise ValueError(
                f"is a flux for each of {len(areas)} surfaces, of {least:.6g} to {most:.6g} m^2: allowed "
                "are surfaces of one area, or a material for each",
                f"{name}.emission",
            )
        sides = 2.0 if material["emission_sides"] == "both" else 1.0
        radiance = replace(folded(emission, 1.0 / (pi * sides * float(areas[0]))), flux=False)
        result[name] = {**material, "emission": radiance}
    return result


def _areas_with(
    material: str, shapes: dict[str, Values], instancing: Instancing, meshed: Meshed
) -> NDArray[np.float64]:
    """Areas of all surfaces with a material, m^2: shapes and instances; 1 if there is none."""
    areas = [
        np.array([_area(name, shape, meshed)])
        for name, shape in shapes.items()
        if shape["type"] != "instance" and shape["material"] == material and not shape["prototype"]
    ]
    own: dict[str, float] = {}
    for name in instancing.shown():
        factor = _motion_factor(shapes[name]["transform"], material)
        for group, rows in instancing.copies(name):
            for member in group.members:
                if (group.material or shapes[member]["material"]) == material:
                    own[member] = own.get(member) or _area(member, shapes[member], meshed)
                    areas.append(own[member] * factor * scales(rows) ** 2)
    return np.concatenate(areas) if areas else np.ones(1)


def _motion_factor(transform: NDArray[np.float64] | Motion | None, material: str) -> float:
    """Factor of areas under a motion of instances; what stands still is in their rows."""
    return _area_scale(transform, material) if isinstance(transform, Motion) else 1.0


def _area_scale(transform: NDArray[np.float64] | Motion | None, material: str) -> float:
    """Factor of areas under a similarity. Raises ValueError(problem, key) for a motion that changes it."""
    if transform is None:
        return 1.0
    factors = [float(abs(np.linalg.det(m[:3, :3])) ** (2.0 / 3.0)) for m in matrices_of(transform)]
    if max(factors) > (1.0 + SAME_AREA) * min(factors):
        raise ValueError(
            "is a flux for a surface whose size changes while the shutter is open: allowed is a radiance",
            f"{material}.emission",
        )
    return factors[0]


def _area(name: str, shape: Values, meshed: Meshed) -> float:
    scale = _area_scale(shape["transform"], shape["material"])
    if shape["type"] == "sphere":
        return float(scale * 4.0 * pi * shape["radius"] ** 2)
    if shape["type"] == "disk":
        return float(scale * pi * shape["radius"] ** 2)
    if shape["type"] == "rectangle":
        return float(scale * np.linalg.norm(np.cross(shape["edge_u"], shape["edge_v"])))
    positions, faces = meshed(name, shape)[:2]
    corners = np.asarray(positions, dtype=np.float64)[np.asarray(faces)]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(scale * 0.5 * np.linalg.norm(cross, axis=1).sum())
