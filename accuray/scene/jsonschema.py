"""JSON Schema (draft 2020-12) of scene files, for editors, made from the parameter tables."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from accuray import data
from accuray.scene import schema as schemas
from accuray.scene.amounts import NAMES
from accuray.scene.keys import INTERPOLATION, MAX_KEYS, takes_keys
from accuray.scene.kinds import vector_length, vocabulary
from accuray.scene.models import MODEL
from accuray.scene.scene import FORMAT_VERSION
from accuray.scene.schema import Family, Param, Type
from accuray.scene.spectra import ROLES_OF_FORM
from accuray.scene.textures import CHANNELS
from accuray.scene.units import LENGTH_UNITS, describe

Node = dict[str, Any]

_NUMBER: Node = {"type": "number"}
_NUMBERS: Node = {"type": "array", "items": _NUMBER}
_QUANTITY: Node = {"type": ["number", "string"]}
_VECTOR: Node = {"type": "array", "items": _QUANTITY, "minItems": 3, "maxItems": 3}


def json_schema() -> Node:
    """The schema of a whole scene file, as plain dicts and lists."""
    schema = schemas.current()
    sections: Node = {
        "accuray": {"const": FORMAT_VERSION, "description": "Version of the scene format."},
        "length_unit": {
            "enum": list(LENGTH_UNITS),
            "default": "m",
            "description": "Unit of bare lengths in this file.",
        },
        "include": {"type": "array", "items": {"type": "string"}, "description": "Files merged below this one."},
        "render": _table(schema.family("render").header),
        "animation": _table(schema.family("animation").header),
        "film": _film(schema.family("film"), schema.family("filter")),
        "camera": _one_of(schema.family("camera").types),
        "integrator": _one_of(schema.family("integrator").types),
        "models": _named(_table(MODEL)),
        "spectra": _named({"anyOf": [{"$ref": "#/$defs/spectrum"}, {"$ref": "#/$defs/keyed"}]}),
        "textures": _named(_one_of(schema.family("texture").types)),
        "materials": _named(_one_of(schema.material_types)),
        "lights": _named(_one_of(schema.family("light").types)),
        "shapes": _named(_one_of(schema.family("shape").types)),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "AccuRay scene",
        "type": "object",
        "properties": sections,
        "required": ["accuray"],
        "additionalProperties": False,
        "$defs": {"spectrum": _spectrum(), "transform": _transform(), "textured": _textured(), "keyed": _keyed()},
    }


def _named(item: Node) -> Node:
    return {"type": "object", "additionalProperties": item}


def _film(film: Family, filters: Family) -> Node:
    node = _table(film.header)
    node["properties"]["filter"] = _one_of(filters.types)
    return node


def _one_of(types: dict[str, Type]) -> Node:
    return {"type": "object", "required": ["type"], "oneOf": [_table(type_, tagged=True) for type_ in types.values()]}


def _table(type_: Type, *, tagged: bool = False) -> Node:
    properties: Node = {"type": {"const": type_.name}} if tagged else {}
    properties.update({param.name: _param(param) for param in type_.params})
    node: Node = {"type": "object", "properties": properties, "additionalProperties": False}
    if type_.doc:
        node["description"] = type_.doc
    required = ["type"] if tagged else []
    required += [param.name for param in type_.params if param.required]
    if required:
        node["required"] = required
    sets = [_one_alternative(name, alternatives) for name, alternatives in type_.sets().items()]
    if sets:
        node["allOf"] = sets
    return node


def _one_alternative(set_name: str, alternatives: dict[str, list[Param]]) -> Node:
    """One alternative of a set is given whole and the others not at all; none, if one of them has defaults or may."""
    names = {name: [param.name for param in group] for name, group in alternatives.items()}
    options: list[Node] = []
    if set_name.endswith("?"):
        options.append({"not": {"anyOf": [{"required": [name]} for members in names.values() for name in members]}})
    for name, group in alternatives.items():
        others = [other for key, members in names.items() if key != name for other in members]
        needed = [param.name for param in group if param.default is None]
        option: Node = {"not": {"anyOf": [{"required": [other]} for other in others]}}
        if needed:
            option["required"] = needed
        options.append(option)
    return {"anyOf": options}


def _param(param: Param) -> Node:
    node = dict(_KINDS[param.kind](param))
    forms = [{"$ref": "#/$defs/textured"}] if param.texturable else []
    if takes_keys(param):
        forms.append({"$ref": "#/$defs/keyed"})
    if forms:
        node = {"anyOf": [node, *forms]}
    description = param.doc
    if param.unit and param.unit != "1":
        description += f" In {param.unit}." if param.unit != "m" else " A length."
    node["description"] = description
    if param.default is not None:
        node["default"] = list(param.default) if isinstance(param.default, tuple) else param.default
    return node


def _ranged(param: Param, node: Node) -> Node:
    """Adds the limits, which hold for bare numbers in the documented unit (not for lengths: see length_unit)."""
    if param.unit != "m":
        if param.min is not None:
            node["minimum"] = param.min
        if param.max is not None:
            node["maximum"] = param.max
    return node


def _float(param: Param) -> Node:
    if param.unit in ("", "1"):
        return _ranged(param, {"type": "number"})
    return _ranged(
        param, {"type": ["number", "string"], "markdownDescription": f"{param.doc} Takes {describe(param.unit)}."}
    )


def _text(param: Param) -> Node:
    names = vocabulary(param)
    return {"enum": names()} if names is not None else {"type": "string"}


def _vec(param: Param) -> Node:
    length = vector_length(param)
    return {"type": "array", "items": _QUANTITY, "minItems": length, "maxItems": length}


def _array(param: Param) -> Node:
    if param.choices:
        return {"type": "string"}
    if param.role == "faces":
        indices = {"type": "array", "items": {"type": "integer", "minimum": 0}, "minItems": 3}
        return {"type": "array", "items": indices}
    return {"type": "array", "items": _NUMBERS}


def _reference(param: Param) -> Node:
    name: Node = {"type": "string"}
    return {"anyOf": [name, {"type": "array", "items": name, "minItems": 1}]} if param.role == "shape" else name


_KINDS: dict[str, Callable[[Param], Node]] = {
    "bool": lambda _: {"type": "boolean"},
    "int": lambda param: _ranged(param, {"type": "integer"}),
    "float": _float,
    "vec": _vec,
    "enum": lambda param: {"enum": list(param.choices)},
    "text": _text,
    "words": lambda param: {"type": "array", "items": {"enum": list(param.choices)}, "uniqueItems": True},
    "file": lambda _: {"type": "string"},
    "transform": lambda _: {"$ref": "#/$defs/transform"},
    "array": _array,
    "reference": _reference,
    "spectrum": lambda _: {"$ref": "#/$defs/spectrum"},
}


def _spectrum() -> Node:
    forms: Node = {
        "value": _NUMBER,
        "rgb": {"type": "array", "items": _NUMBER, "minItems": 3, "maxItems": 3},
        "file": {"type": "string", "description": "CSV file: wavelengths in nm, then columns of values."},
        "wavelengths": {**_NUMBERS, "minItems": 2, "description": "In nm, rising."},
        "blackbody": {**_QUANTITY, "description": "Temperature in K."},
        "illuminant": {"enum": list(data.illuminants())},
        "sellmeier": {
            "type": "object",
            "properties": {"A0": _NUMBER, "B": _NUMBERS, "C": _NUMBERS},
            "required": ["B", "C"],
            "additionalProperties": False,
        },
        "cauchy": {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2},
    }
    modifiers: Node = {
        "column": {"type": "string"},
        "values": _NUMBERS,
        "scale": {"type": "number", "minimum": 0},
        "extrapolate": {"enum": ["hold", "zero"]},
        "normalize": {"type": "boolean", "description": "Scale to Y = 1 (emission)."},
        **{name: {**_QUANTITY, "description": _amount(name, choices)} for name, choices in NAMES.items()},
    }
    table = {
        "type": "object",
        "properties": {**forms, **modifiers},
        "additionalProperties": False,
        "oneOf": [{"required": [form]} for form in ROLES_OF_FORM],
        "dependentRequired": {"column": ["file"], "values": ["wavelengths"], "wavelengths": ["values"]},
    }
    names = {"type": "string", "description": "A name in [spectra], an illuminant, a glass, or a temperature."}
    return {"anyOf": [_NUMBER, forms["rgb"], names, table]}


def _amount(name: str, choices: tuple[str, ...]) -> str:
    return f"Scale to this {name}, {' or '.join(choices)} (emission)."


def _textured() -> Node:
    return {
        "type": "object",
        "description": "Given by a texture.",
        "properties": {
            "texture": {"type": "string"},
            "scale": {"type": "number", "minimum": 0},
            "channel": {"enum": list(CHANNELS), "description": "Of the texture, for a number."},
        },
        "required": ["texture"],
        "additionalProperties": False,
    }


def _keyed() -> Node:
    key = {
        "type": "object",
        "properties": {
            "time": {**_QUANTITY, "description": "In s, since frame 0."},
            "value": {"description": "As without keys."},
        },
        "required": ["time", "value"],
        "additionalProperties": False,
    }
    return {
        "type": "object",
        "description": "A value that changes with time.",
        "properties": {
            "keys": {"type": "array", "items": key, "minItems": 1, "maxItems": MAX_KEYS},
            "interpolation": {"enum": list(INTERPOLATION.choices), "default": INTERPOLATION.default},
        },
        "required": ["keys"],
        "additionalProperties": False,
    }


def _transform() -> Node:
    rotation = {
        "type": "object",
        "properties": {"axis": _VECTOR, "angle": _QUANTITY, "turns": _NUMBER},
        "required": ["axis"],
        "oneOf": [{"required": ["angle"]}, {"required": ["turns"]}],
        "additionalProperties": False,
    }
    look_at = {
        "type": "object",
        "properties": {"origin": _VECTOR, "target": _VECTOR, "up": _VECTOR},
        "required": ["origin", "target"],
        "additionalProperties": False,
    }
    scale = {"anyOf": [_NUMBER, {**_NUMBERS, "minItems": 3, "maxItems": 3}]}
    parts: Node = {
        "translate": _VECTOR,
        "rotate": rotation,
        "scale": scale,
        "matrix": {"type": "array"},
        "look_at": look_at,
    }
    step = {"type": "object", "properties": parts, "additionalProperties": False}
    steps = {"type": "array", "items": step, "minItems": 1}
    key = {
        "type": "object",
        "properties": {"time": _QUANTITY, **parts, "steps": steps},
        "required": ["time"],
        "additionalProperties": False,
    }
    keyed = {
        "type": "object",
        "properties": {"keys": {"type": "array", "items": key, "minItems": 1}},
        "required": ["keys"],
        "additionalProperties": False,
    }
    return {"anyOf": [step, steps, keyed]}
