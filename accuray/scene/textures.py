"""Textures: how a parameter refers to one, and what all uses of a texture must fulfil together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from accuray.scene.amounts import lumens_per_y
from accuray.scene.composition import all_parts
from accuray.scene.errors import Where
from accuray.scene.plain import choice, quantity
from accuray.scene.schema import Param, Schema, Type
from accuray.scene.scope import Scope
from accuray.scene.shapes import shown_by

CHANNELS = ("red", "green", "blue", "alpha")
MAP = "map"
"""Channel of normal and bump maps, which are read as numbers."""

Objects = dict[str, dict[str, Any]]
_SCALE = Param("scale", "float", default=1.0, min=0.0)
_LUMINANCE = Param("scale", "float", unit="cd/m^2", min=0.0)
_CHANNEL = Param("channel", "enum", default="red", choices=CHANNELS)


@dataclass(frozen=True)
class TextureUse:
    """A parameter's value that a texture gives, times ``scale``: its colour, or for a number or index a channel.

    ``scale`` is in the renderer's unit where the number has one (metres of a thickness), and that of an emission is the
    Y of white. ``channel`` is "" for a
    colour, "map" for a normal or bump map.
    """

    texture: str
    scale: float = 1.0
    channel: str = ""


def names_texture(value: Any) -> bool:
    """Does a value of a scene refer to a texture?"""
    return isinstance(value, TextureUse) or (isinstance(value, dict) and "texture" in value)


def parse_use(param: Param, value: Any, where: Where, scope: Scope) -> TextureUse:
    """The reference ``{ texture = "NAME", scale = 1, channel = "red" }``. Raises SceneError."""
    if not param.texturable:
        reason = f": {param.untextured}" if param.untextured else f", only a {param.kind}"
        raise where.error(f"takes no texture{reason}", value=value)
    unit = param.unit if param.kind == "float" else ""
    if isinstance(value, TextureUse):
        unit = ""
        value = {key: item for key, item in vars(value).items() if item not in ("", MAP)}
    elif not isinstance(value, dict):
        value = {"texture": value}
    number = param.kind == "float" or param.role == "index"
    keys = ("texture", "scale", "channel") if number else ("texture", "scale")
    for key in value:
        if key not in keys:
            raise where.child(key).unknown(key, "key of a textured parameter", keys)
    name, known = value["texture"], scope.names("textures")
    if not isinstance(name, str) or name not in known:
        raise where.child("texture").unknown(name, "texture", known)
    given = value.get("scale", _SCALE.default)
    if param.role == "emission" and isinstance(given, str):
        scale = quantity(_LUMINANCE, given, where.child("scale")) / lumens_per_y()
    else:
        scale = quantity(replace(_SCALE, unit=unit), given, where.child("scale"))
    if not number:
        return TextureUse(name, scale, MAP if param.kind == "reference" else "")
    return TextureUse(name, scale, choice(_CHANNEL, value.get("channel", _CHANNEL.default), where.child("channel")))


def uses_of(table: dict[str, Any]) -> Iterator[tuple[str, TextureUse]]:
    """Parameters of an object that a texture gives."""
    return ((key, value) for key, value in table.items() if isinstance(value, TextureUse))


def settle_colour_spaces(textures: Objects, materials: Objects, shapes: Objects, where: Where) -> None:
    """Puts what ``color_space = "auto"`` means in its place: it follows from the stored texels and from the uses.

    Integers are sRGB where they give spectra and data where they give numbers; floats are linear. Raises SceneError
    if a texture gives both.
    """
    for name, texture in textures.items():
        if texture.get("color_space") != "auto":
            continue
        if texture["pixels"].dtype.kind == "f":
            texture["color_space"] = "linear"
            continue
        found = [
            ((section, user, key), use)
            for section, objects in (("materials", materials), ("shapes", shapes))
            for user, table in objects.items()
            for key, use in uses_of(table)
            if use.texture == name
        ]
        numbers = [place for place, use in found if use.channel]
        colours = [place for place, use in found if not use.channel]
        if numbers and colours:
            raise where.child(name, "color_space").error(
                f"is auto, but {'.'.join(colours[0])} takes colours from the texture and "
                f"{'.'.join(numbers[0])} numbers",
                allowed='"srgb", "linear" or "data"; or two textures, which share one file',
            )
        texture["color_space"] = "data" if numbers else "srgb"


def check_opacity(materials: Objects, where: Where) -> None:
    """A surface that lets light through cannot emit: its lights are sampled whole. Raises SceneError."""
    for name, material in materials.items():
        if material["emission"] is not None and material["opacity"] != 1.0:
            raise where.child("materials", name, "opacity").error(
                "cannot go with `emission`", allowed="opacity = 1 for a surface that emits"
            )


def check_vertices(textures: Objects, materials: Objects, shapes: Objects, schema: Schema, where: Where) -> None:
    """Shapes have at their vertices what the textures of their materials read there. Raises SceneError."""
    types = schema.family("texture").types
    uses = {
        name: [(part, *use) for part in all_parts(materials, name, schema) for use in uses_of(materials[part])]
        for name in materials
    }
    for name, seen in shown_by(shapes).items():
        for member, material in sorted(seen):
            for part, key, use in uses[material]:
                lack = lack_of(types[textures[use.texture]["type"]], shapes[member])
                if lack is not None:
                    via = f' (shown by "{name}")' if member != name else ""
                    user = f'the texture "{use.texture}" of materials.{part}.{key}'
                    raise where.child("shapes", member).error(
                        f"has no {lack[0]}{via}, which {user} needs", allowed=lack[1]
                    )


def lack_of(texture: Type, shape: dict[str, Any]) -> tuple[str, str] | None:
    """What the shape lacks that the texture reads, and what has it."""
    if texture.reads_uv and shape["type"] == "mesh" and shape["uvs"] is None:
        return "texture coordinates", "a mesh with uvs (`vt` in OBJ, `s` and `t` or `u` and `v` in PLY)"
    if texture.reads_colors and shape.get("colors") is None:
        return "vertex colours", "a mesh with colors (`v x y z r g b` in OBJ, `red`, `green` and `blue` in PLY)"
    return None


def check_bumps(textures: Objects, materials: Objects, schema: Schema, where: Where) -> None:
    """Vertex colours make no heights: their slope would be one for each triangle. Raises SceneError."""
    types = schema.family("texture").types
    for name, material in materials.items():
        use = material["bump_map"]
        if use is not None and types[textures[use.texture]["type"]].reads_colors:
            raise where.child("materials", name, "bump_map").error(
                "cannot come from vertex colours", value=use.texture, allowed="a texture of another type"
            )
