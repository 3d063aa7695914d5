"""What the shapes of a scene must fulfil together, beyond the table of each type."""

from __future__ import annotations

from typing import Any

from accuray.scene.errors import Where
from accuray.scene.motion import Motion, matrices_of
from accuray.scene.schema import Param, Schema, Type
from accuray.scene.transforms import check_rigid

Shapes = dict[str, dict[str, Any]]


def check_shapes(shapes: Shapes, schema: Schema, where: Where) -> None:
    """Every shape has a material or is made of other shapes; those are prototypes, and one level deep.

    Shapes that would be others if they were stretched are not. Raises SceneError.
    """
    types = schema.family("shape").types
    for name, shape in shapes.items():
        if types[shape["type"]].rigid and shape["transform"] is not None:
            noun, place = f"a shape of the type {shape['type']}", where.child(name, "transform")
            for matrix in matrices_of(shape["transform"]):
                check_rigid(matrix, noun, place, "; or a mesh, rectangle or solid, which take any")
        if shape["prototype"] and isinstance(shape["transform"], Motion):
            problem = "moves a prototype, which is no place in the scene"
            raise where.child(name, "transform").error(problem, allowed="the keys in the transforms of its instances")
        links = _links(types[shape["type"]])
        if shape["material"] is None and not links:
            raise where.child(name).error("has no material", allowed='material = "NAME" of a table in [materials]')
        for param in links:
            for target in shape[param.name] or ():
                _check_target(target, shapes[target], types, where.child(name, param.name))


def _links(type_: Type) -> list[Param]:
    """Parameters that refer to other shapes."""
    return [param for param in type_.params if param.kind == "reference" and param.role == "shape"]


def _check_target(name: str, target: dict[str, Any], types: dict[str, Type], where: Where) -> None:
    if _links(types[target["type"]]):
        raise where.error(
            f"has the type {target['type']}, which is made of other shapes itself",
            value=name,
            allowed="one level: shapes of other types",
        )
    if not target["prototype"]:
        raise where.error("is not a prototype", value=name, allowed="shapes with `prototype = true`")
