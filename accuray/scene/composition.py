"""Materials that are made of others: what their parts may be, and in which order they are built."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from accuray.scene.errors import Where
from accuray.scene.schema import Schema

MOST_PARTS = 8
"""Materials that one composed material may end in, as the kernels allow."""

MAPS = ("normal_map", "normal_map_convention", "bump_map", "bump_height")
"""What a composed material gives to those of its parts that have no maps of their own."""

WHOLE = (("emission", None), ("opacity", 1.0))
"""What only a whole material may have, and what it is otherwise."""

MAPPED = (("normal_map", None), ("bump_map", None))
"""The same of a material under a layer, whose maps bend both."""

MATTE = "diffuse"
"""What two layers may lie upon."""

Objects = dict[str, dict[str, Any]]


def parts_of(material: dict[str, Any], schema: Schema) -> Iterator[tuple[str, str]]:
    """The materials that one refers to, by the parameter that does."""
    for param in schema.material_types[material["type"]].params:
        if param.kind == "reference" and param.role == "material" and material[param.name] is not None:
            yield param.name, material[param.name]


def all_parts(materials: Objects, name: str, schema: Schema) -> Iterator[str]:
    """The material and all that it is made of, the innermost first; one that is used twice comes twice."""
    for _, part in parts_of(materials[name], schema):
        yield from all_parts(materials, part, schema)
    yield name


def check_parts(materials: Objects, schema: Schema, where: Where) -> None:
    """Raises SceneError for a material that contains itself, one of too many parts, and parts that cannot be such."""
    for name in materials:
        _count(materials, name, (), schema, where)
    for name, material in materials.items():
        layered = material["type"] in schema.family("bsdf").types
        for key, part in parts_of(material, schema):
            if layered:
                _check_base(materials, part, schema, where.child(name, key))
            for header, neutral in WHOLE + (MAPPED if layered else ()):
                if materials[part][header] != neutral:
                    raise where.child(part, header).error(
                        f'cannot be given to a part of "{name}" ({key})', allowed=f'{header} of "{name}" as a whole'
                    )


def _check_base(materials: Objects, part: str, schema: Schema, where: Where) -> None:
    """Under a layer lies what has no parts, or a layer upon what is matte."""
    type_ = materials[part]["type"]
    under = [materials[name]["type"] for _, name in parts_of(materials[part], schema)]
    if type_ in schema.family("bsdf").types and under in ([], [MATTE]):
        return
    problem = f"is {type_} over {under[0]}" if type_ in schema.family("bsdf").types else f"is {type_}"
    raise where.error(
        f"{problem}, which is made of others itself",
        value=part,
        allowed=f"a material without parts, or a coated one whose base is {MATTE}",
    )


def _count(materials: Objects, name: str, above: tuple[str, ...], schema: Schema, where: Where) -> int:
    """Materials without parts that a material ends in."""
    count = 0
    for key, part in parts_of(materials[name], schema):
        if part == name or part in above:
            chain = " -> ".join((*above, name, part))
            raise where.child(name, key).error(f"makes the material a part of itself: {chain}")
        if len(above) + 1 >= MOST_PARTS:
            raise where.child(name, key).error("nests materials too deeply", allowed=f"at most {MOST_PARTS} levels")
        count += _count(materials, part, (*above, name), schema, where)
    if count > MOST_PARTS:
        raise where.child(name).error(f"is made of {count} materials", allowed=f"at most {MOST_PARTS}")
    return max(count, 1)
