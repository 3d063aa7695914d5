"""One resolver per parameter kind: from what the scene says to the canonical value.

Canonical values: bool, int, float (metres, radians, ...), tuple of floats (vec), str (enum, text, reference),
list of str (references to shapes), tuple of str (words), float64 4x4 array (transform; Motion if it changes while the
shutter is open), float32 and uint32 arrays, Transforms (of instances), Spectrum, Path; pictures (height, width,
channels); TextureUse for what a texture gives.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from accuray.scene.arrays import parse_array
from accuray.scene.deformation import keyed_files, resolve_moving
from accuray.scene.errors import Where
from accuray.scene.images import parse_pixels
from accuray.scene.keys import is_keyed, resolve_keyed
from accuray.scene.motion import KEYS, parse_motion
from accuray.scene.placements import IDS, TRANSFORMS, parse_filed
from accuray.scene.plain import choice, in_range, quantity, range_text, text_value
from accuray.scene.schema import Param
from accuray.scene.scope import SECTION_OF, Scope
from accuray.scene.spectra import metal_names, parse_spectrum
from accuray.scene.textures import TextureUse, names_texture, parse_use
from accuray.scene.transforms import parse_transform

VOCABULARIES: dict[str, Callable[[], list[str]]] = {"metal": metal_names}
"""Text parameters whose role (or name) stands here take a name out of the data that come with the renderer."""

KEYED_ELSEWHERE = ("spectrum", "transform")
"""Kinds whose own parsers know keys: spectra have names, which keys may stand behind."""

ABSOLUTE = "absolute"
"""Role of a length whose bare numbers are metres whatever the file's length_unit says (a lens in a model in km)."""


def resolve_value(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    """The canonical value of a parameter that the scene gives. Raises SceneError."""
    if names_texture(value):
        return parse_use(param, value, where, scope)
    if is_keyed(value) and param.kind not in KEYED_ELSEWHERE:
        return resolve_keyed(param, value, where, scope, partial(_plain, param, scope))
    return _RESOLVERS[param.kind](param, value, where, scope)


def _plain(param: Param, scope: Scope, value: Any, where: Where) -> Any:
    return _RESOLVERS[param.kind](param, value, where, scope)


def vocabulary(param: Param) -> Callable[[], list[str]] | None:
    """The names that a text parameter may take, None if it is free text."""
    return VOCABULARIES.get(param.role or param.name) if param.kind == "text" else None


def vector_length(param: Param) -> int:
    """Components of a vec parameter: those of its default, else 3."""
    return len(param.default) if param.default is not None else 3


def _bool(_param: Param, value: Any, where: Where, _scope: Scope) -> bool:
    if not isinstance(value, bool):
        raise where.error("is not a truth value", value=value, allowed="true or false")
    return value


def _int(param: Param, value: Any, where: Where, _scope: Scope) -> int:
    allowed = range_text(param) or "a whole number"
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise where.error("is not a whole number", value=value, allowed=allowed)
    number = value.__index__()
    if not in_range(param, number):
        raise where.error("is out of range", value=number, allowed=allowed)
    return int(number)


def _float(param: Param, value: Any, where: Where, _scope: Scope) -> float:
    return quantity(param, value, where, length_unit="m" if param.role == ABSOLUTE else None)


def _vec(param: Param, value: Any, where: Where, _scope: Scope) -> tuple[float, ...]:
    length = vector_length(param)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if not isinstance(value, (list, tuple)) or len(value) != length:
        raise where.error("is not a vector", value=value, allowed=f"a list of {length} numbers")
    return tuple(quantity(param, item, where.child(index)) for index, item in enumerate(value))


def _enum(param: Param, value: Any, where: Where, _scope: Scope) -> str:
    return choice(param, value, where)


def _words(param: Param, value: Any, where: Where, _scope: Scope) -> tuple[str, ...]:
    if not isinstance(value, (list, tuple)):
        raise where.error("is not a list", value=value, allowed=f"a list of {' | '.join(param.choices)}")
    words = tuple(choice(param, item, where.child(index)) for index, item in enumerate(value))
    if len(set(words)) < len(words):
        raise where.error("names one twice", value=value, allowed=f"each of {', '.join(param.choices)} once")
    return words


def _text(param: Param, value: Any, where: Where, _scope: Scope) -> str:
    text = text_value(value, where)
    names = vocabulary(param)
    if names is not None and text not in names():
        raise where.unknown(text, param.role or param.name, names())
    return text


def _file(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    def resolve(name: Any, place: Where) -> Path:
        return scope.files.resolve(name, place, param.choices)

    if is_keyed(value) and param.animatable:
        return keyed_files(value, where, resolve)
    return resolve(value, where)


def _transform(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    if not (isinstance(value, dict) and KEYS in value):
        return parse_transform(value, where)
    if not param.animatable:
        raise where.child(KEYS).error("move what stands still", allowed="a transform without keys")
    return parse_motion(value, where, scope.clock)


def _array(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    if is_keyed(value) and param.animatable:
        return resolve_moving(value, where, scope, partial(parse_array, param))
    if where.path not in scope.arrays:
        scope.arrays[where.path] = _plain_array(param, value, where, scope)
    return scope.arrays[where.path]


def _plain_array(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    if param.role in (TRANSFORMS, IDS):
        return parse_filed(param, value, where, scope)
    return parse_pixels(value, where) if param.role == "pixels" else parse_array(param, value, where)


def _reference(param: Param, value: Any, where: Where, scope: Scope) -> str | list[str] | TextureUse:
    if param.role == "texture":
        return parse_use(param, value, where, scope)
    if param.role != "shape":
        return _referred(param, value, where, scope)
    names = value if isinstance(value, (list, tuple)) else [value]
    if not names:
        raise where.error("names nothing", value=value, allowed="at least one shape")
    if isinstance(value, str):
        return [_referred(param, value, where, scope)]
    return [_referred(param, name, where.child(index), scope) for index, name in enumerate(names)]


def _referred(param: Param, name: Any, where: Where, scope: Scope) -> str:
    """A name that exists in the section of the parameter's family; says so if another family has it."""
    if not isinstance(name, str):
        raise where.error("is not a name", value=name, allowed=f"the name of a {param.role}")
    section = SECTION_OF[param.role]
    if scope.defines(section, name):
        return name
    known = scope.names(section)
    for family, other in SECTION_OF.items():
        if family != param.role and scope.defines(other, name):
            raise where.error(f"is a {family}, not a {param.role}", value=name, allowed=", ".join(known) or "none")
    raise where.unknown(name, param.role, known)


def _spectrum(param: Param, value: Any, where: Where, scope: Scope) -> Any:
    return parse_spectrum(param, value, where, scope)


_RESOLVERS: dict[str, Callable[[Param, Any, Where, Scope], Any]] = {
    "bool": _bool,
    "int": _int,
    "float": _float,
    "vec": _vec,
    "enum": _enum,
    "text": _text,
    "words": _words,
    "file": _file,
    "transform": _transform,
    "array": _array,
    "reference": _reference,
    "spectrum": _spectrum,
}
