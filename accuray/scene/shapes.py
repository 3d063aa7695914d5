"""What the shapes of a scene must fulfil together, beyond the table of each type."""

from __future__ import annotations

from graphlib import CycleError, TopologicalSorter
from typing import Any

from accuray.scene.errors import Where
from accuray.scene.motion import Motion, matrices_of
from accuray.scene.schema import Param, Schema, Type
from accuray.scene.transforms import check_rigid

Shapes = dict[str, dict[str, Any]]


def check_shapes(shapes: Shapes, schema: Schema, where: Where) -> None:
    """Every shape has a material or is made of other shapes; those are prototypes, and none is made of itself.

    Shapes that would be others if they were stretched are not. Ids that came with the transforms of instances are
    put where ids belong. Raises SceneError.
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
                if not shapes[target]["prototype"]:
                    raise where.child(name, param.name).error(
                        "is not a prototype", value=target, allowed="shapes with `prototype = true`"
                    )
        if shape["type"] == "instance":
            _settle_ids(shape, where.child(name))
    try:
        from_the_leaves(shapes)
    except CycleError as error:
        loop: list[str] = error.args[1]
        raise where.child(loop[1], "of").error("is made of itself: " + " -> ".join(loop[::-1])) from None


def from_the_leaves(shapes: Shapes) -> list[str]:
    """Names of all shapes, each after those that it is made of. Raises graphlib.CycleError."""
    return list(TopologicalSorter({name: shape.get("of") or () for name, shape in shapes.items()}).static_order())


def shown_by(shapes: Shapes) -> dict[str, set[tuple[str, str]]]:
    """For every shape what it is made of at last: names of shapes that are no instances, and of their materials.

    An instance that has a material gives it to all that it shows.
    """
    shown: dict[str, set[tuple[str, str]]] = {}
    for name in from_the_leaves(shapes):
        shape = shapes[name]
        if shape["type"] != "instance":
            shown[name] = {(name, shape["material"])}
            continue
        members = set().union(*(shown[member] for member in shape["of"]))
        shown[name] = {(leaf, shape["material"] or material) for leaf, material in members}
    return shown


def _links(type_: Type) -> list[Param]:
    """Parameters that refer to other shapes."""
    return [param for param in type_.params if param.kind == "reference" and param.role == "shape"]


def _settle_ids(shape: dict[str, Any], where: Where) -> None:
    """One id for each transform, and a member of `of` for each id."""
    transforms, ids = shape["instances"], shape["ids"]
    if transforms is None:
        if ids is not None:
            raise where.child("ids").error("are of no use without `instances`", allowed="both, or neither")
        return
    if transforms.ids is not None:
        if ids is not None:
            raise where.child("ids").error("are given twice", allowed="ids, or a thirteenth column of `instances`")
        ids = shape["ids"] = transforms.ids
    if ids is None:
        return
    if len(ids) != transforms.count:
        raise where.child("ids").error(f"has {len(ids)} rows", allowed=f"{transforms.count}, as many as instances")
    most = len(shape["of"]) - 1
    if len(ids) and int(ids.max()) > most:
        row = int(ids.argmax())
        raise where.child("ids", row).error("is not an id", value=int(ids[row]), allowed=f"0 to {most}, as `of` counts")
