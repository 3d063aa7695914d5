"""Materials that lie upon others: which do, what is allowed, and the order in which they can be made."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from accuray.scene.errors import Where
from accuray.scene.schema import Schema

Materials = dict[str, dict[str, Any]]

HEADER_OF_COAT = ("emission", "normal_map", "bump_map")


def bases_of(name: str, materials: Materials, schema: Schema) -> Iterator[tuple[str, str]]:
    """Parameters of a material that name another, and its name."""
    table = materials[name]
    for param in schema.family("bsdf").types[table["type"]].params:
        if param.kind == "reference" and param.role == "material" and table[param.name] is not None:
            yield param.name, table[param.name]


def check_bases(materials: Materials, schema: Schema, where: Where) -> None:
    """A material that others lie upon lies upon none itself, and is nothing but its BSDF. Raises SceneError."""
    for name in materials:
        for key, base in bases_of(name, materials, schema):
            at = where.child(name, key)
            if circle := _circle(name, materials, schema):
                raise at.error("leads back to itself: " + " -> ".join(circle), value=base, allowed="one layer")
            if next(bases_of(base, materials, schema), None) is not None:
                problem = f"is {materials[base]['type']} itself"
                raise at.error(problem, value=base, allowed="one layer: a material that lies upon no other")
            found = [part for part in HEADER_OF_COAT if materials[base][part] is not None]
            found += ["opacity"] if materials[base]["opacity"] != 1.0 else []
            if found:
                raise at.error(f"has `{found[0]}`", value=base, allowed="a material without; give it to the coat")


def _circle(name: str, materials: Materials, schema: Schema) -> list[str]:
    """The way from a material back to itself; empty if there is none."""
    ways = [[name]]
    while ways:
        way = ways.pop()
        for _, base in bases_of(way[-1], materials, schema):
            if base == name:
                return [*way, base]
            if base not in way:
                ways.append([*way, base])
    return []


def in_order(materials: Materials, schema: Schema) -> list[str]:
    """The names, each after those of the materials that it lies upon."""
    ordered: dict[str, None] = {}

    def add(name: str) -> None:
        for _, base in bases_of(name, materials, schema):
            add(base)
        ordered.setdefault(name)

    for name in materials:
        add(name)
    return list(ordered)
