"""Scene descriptions for the cases, as the dictionaries that `accuray.Scene.from_dict` takes.

A shape comes with its material: `assemble` names both. Everything radiates grey unless a case says otherwise, so a
radiance of 1 is 1 at every wavelength.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Table = dict[str, Any]
#: A shape and its material.
Solid = tuple[Table, Table]

PATH: Table = {"type": "path"}


def direct_only(strategy: str) -> Table:
    """The integrator that gathers emission and direct light, by one way of sampling it.

    `strategy` is "mis", "light" or "bsdf" of the path tracer, or "direct" or "reference", which are integrators.
    """
    if strategy == "direct":
        return {"type": "direct"}
    return with_strategy(strategy, max_depth=1)


def with_strategy(strategy: str, **more: Any) -> Table:
    """The path tracer by one strategy, or the naive reference tracer."""
    if strategy == "reference":
        return {"type": "reference", **more}
    return {"type": "path", "strategy": strategy, **more}


def diffuse(reflectance: Any, emission: Any = None, sides: str = "front") -> Table:
    """A Lambertian material, emitting or not."""
    material: Table = {"type": "diffuse", "reflectance": reflectance}
    if emission is not None:
        material |= {"emission": emission, "emission_sides": sides}
    return material


def lamp(emission: Any = 1.0, sides: str = "front") -> Table:
    """A black surface that emits."""
    return diffuse(0.0, emission, sides)


def black() -> Table:
    """A surface that only absorbs."""
    return diffuse(0.0)


def mirror() -> Table:
    """A perfect mirror: reflectance 1 at every angle and wavelength."""
    return {"type": "conductor", "metal": "perfect"}


def metal(name: str) -> Table:
    """A named metal."""
    return {"type": "conductor", "metal": name}


def glass(ior: Any, **more: Any) -> Table:
    """A smooth dielectric; `ior` is the index inside relative to outside."""
    return {"type": "dielectric", "ior": ior, **more}


def coat(base: Table, **layer: Any) -> Table:
    """A layer over a material, which `assemble` gives a name of its own."""
    return {"type": "coated", "base": base, **layer}


def sphere(center: Sequence[float], radius: float, material: Table) -> Solid:
    """A sphere; its front is outside."""
    return {"type": "sphere", "center": list(map(float, center)), "radius": float(radius)}, material


def disk(center: Sequence[float], normal: Sequence[float], radius: float, material: Table) -> Solid:
    """A disk whose front is where `normal` points."""
    shape = {
        "type": "disk",
        "center": list(map(float, center)),
        "normal": list(map(float, normal)),
        "radius": float(radius),
    }
    return shape, material


def rectangle(corner: Sequence[float], edge_u: Sequence[float], edge_v: Sequence[float], material: Table) -> Solid:
    """A rectangle; its front is where edge_u x edge_v points."""
    edges = {"edge_u": list(map(float, edge_u)), "edge_v": list(map(float, edge_v))}
    return {"type": "rectangle", "corner": list(map(float, corner)), **edges}, material


def square(center: ArrayLike, normal: ArrayLike, size: float, material: Table) -> Solid:
    """A square of edge `size` about `center`, front where `normal` points."""
    n = np.asarray(normal, dtype=np.float64)
    n = n / np.linalg.norm(n)
    u = np.cross(np.eye(3)[int(np.argmin(np.abs(n)))], n)
    u *= size / float(np.linalg.norm(u))
    v = np.cross(n, u)
    corner = np.asarray(center, dtype=np.float64) - 0.5 * (u + v)
    return rectangle(corner.tolist(), u.tolist(), v.tolist(), material)


def polygon(vertices: ArrayLike, material: Table) -> Solid:
    """A planar polygon, front where its corners run counter-clockwise."""
    positions = np.asarray(vertices, dtype=np.float64)
    return {"type": "mesh", "positions": positions.tolist(), "faces": [list(range(len(positions)))]}, material


def box(materials: Mapping[str, Table] | Table, size: float = 1.0) -> list[Solid]:
    """Six squares about the origin that face inward: one material for all, or one per side "-x" ... "+z"."""
    sides: list[Solid] = []
    for axis, name in enumerate("xyz"):
        for sign, prefix in ((-1.0, "-"), (1.0, "+")):
            outward = sign * np.eye(3)[axis]
            material = materials if "type" in materials else materials[prefix + name]
            sides.append(square(0.5 * size * outward, -outward, size, dict(material)))
    return sides


def slab(ior: Any, thickness: float, top: float = 0.0, size: float = 10.0, **more: Any) -> list[Solid]:
    """A horizontal plate: two interfaces whose fronts are outside, the upper one at the height `top`."""
    return [
        square((0.0, top, 0.0), (0.0, 1.0, 0.0), size, glass(ior, **more)),
        square((0.0, top - thickness, 0.0), (0.0, -1.0, 0.0), size, glass(ior, **more)),
    ]


def point_light(position: Sequence[float], intensity: Any) -> Table:
    """A point light of spectral radiant intensity `intensity`."""
    return {"type": "point", "position": list(map(float, position)), "intensity": intensity}


def environment(radiance: Any = 1.0) -> Table:
    """A constant environment."""
    return {"type": "constant", "radiance": radiance}


def assemble(
    solids: Sequence[Solid], lights: Sequence[Table] = (), integrator: Table = PATH, **more: Table | str
) -> Table:
    """The scene dictionary of solids and lights; `more` adds or replaces top-level entries (film, length_unit...)."""
    scene: Table = {
        "accuray": 1,
        "film": {"width": 8, "height": 8, "filter": {"type": "box"}},
        "camera": {"type": "perspective"},
        "integrator": dict(integrator),
        "materials": {k: v for i, (_, material) in enumerate(solids) for k, v in _named(f"m{i}", material).items()},
        "shapes": {f"s{i}": {**shape, "material": f"m{i}"} for i, (shape, _) in enumerate(solids)},
        "lights": {f"l{i}": dict(light) for i, light in enumerate(lights)},
    }
    return scene | more


def _named(name: str, material: Table) -> dict[str, Table]:
    """The tables that a material is made of: itself, and what it lies upon."""
    if not isinstance(material.get("base"), dict):
        return {name: dict(material)}
    return {name: material | {"base": f"{name}-base"}, f"{name}-base": dict(material["base"])}
