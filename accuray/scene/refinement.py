"""What subdivision and displacement ask of a shape, beyond the table of its type."""

from __future__ import annotations

from typing import Any

from accuray.scene.errors import Where
from accuray.scene.schema import Schema
from accuray.scene.textures import lack_of

Objects = dict[str, dict[str, Any]]

VERTICES = {"creases": 2, "corners": 1}
"""Arrays whose rows begin with so many numbers of vertices."""


def check_refinement(shapes: Objects, textures: Objects, schema: Schema, where: Where) -> None:
    """Raises SceneError for a shape whose parameters of refinement do not go together."""
    for name, shape in shapes.items():
        if "max_triangles" not in shape:
            continue
        _check_surface(shape, where.child(name))
        if shape["prototype"] and shape["edge_length_px"] is not None:
            raise where.child(name, "edge_length_px").error(
                "cannot hold for a prototype, whose instances stand anywhere", allowed="subdivision_levels"
            )
        if shape["displacement"] is not None:
            _check_displacement(shape, textures, schema, where.child(name))


def _check_surface(shape: dict[str, Any], where: Where) -> None:
    """Creases are those of a subdivision surface, between vertices that the scene numbers."""
    subdivision = shape.get("subdivision", "none")
    if subdivision != "none" and shape["subdivision_levels"] == 0:
        raise where.child("subdivision_levels").error("is out of range", value=0, allowed=f"1 to 12 with {subdivision}")
    for key, columns in VERTICES.items():
        rows = shape.get(key)
        if rows is None:
            continue
        if subdivision == "none" or shape["file"] is not None:
            needs = 'with `positions` and with subdivision = "catmull_clark" or "loop"'
            raise where.child(key).error("has no place here", allowed=needs)
        _check_vertices(rows[:, :columns], len(shape["positions"]), where.child(key))


def _check_vertices(rows: Any, count: int, where: Where) -> None:
    """Numbers of vertices that exist."""
    for index, row in enumerate(rows.tolist()):
        for column, number in enumerate(row):
            if not 0 <= number < count or not number.is_integer():
                value = int(number) if number.is_integer() else number
                allowed = f"0 to {count - 1}" if count else "none, for there are no vertices"
                raise where.child(index, column).error("is not a vertex", value=value, allowed=allowed)


def _check_displacement(shape: dict[str, Any], textures: Objects, schema: Schema, where: Where) -> None:
    """The texture finds at the vertices what it reads; vertex colours are none of that."""
    use = shape["displacement"]
    texture = schema.family("texture").types[textures[use.texture]["type"]]
    if texture.reads_colors:
        raise where.child("displacement").error(
            "cannot come from vertex colours", value=use.texture, allowed="a texture of another type"
        )
    lack = lack_of(texture, shape)
    if lack is None and shape["displacement_space"] == "tangent" and shape.get("uvs", ()) is None:
        lack = "texture coordinates", "a mesh with uvs, or another displacement_space"
    if lack is not None:
        raise where.error(f'has no {lack[0]}, which displacement by the texture "{use.texture}" needs', allowed=lack[1])
