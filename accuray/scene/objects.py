"""One object of a scene (a shape, a material, the camera, ...) against the table of its type."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from accuray.scene.arrays import check_together
from accuray.scene.errors import Document, Source, Where
from accuray.scene.images import read_pixels
from accuray.scene.kinds import resolve_value, vocabulary
from accuray.scene.meshes import fill_from_file, keep_polygons
from accuray.scene.paths import Confinement
from accuray.scene.schema import Param, Schema, Type
from accuray.scene.scope import Scope
from accuray.scene.spectra import metal_spectra

BUILT_IN = Source(name="built-in default", length_unit="m")


def resolve_object(types: Mapping[str, Type], value: Any, where: Where, scope: Scope) -> dict[str, Any]:
    """A table with a ``type`` as {"type": name, parameter: canonical value, ...}. Raises SceneError."""
    table = expect_table(value, where)
    name = table.get("type")
    if name is None:
        raise where.error("has no `type`", allowed=", ".join(types))
    if not isinstance(name, str) or name not in types:
        raise where.child("type").unknown(name, "type", types)
    given = {key: item for key, item in table.items() if key != "type"}
    return {"type": name, **resolve_params(types[name], given, where, scope)}


def resolve_params(
    type_: Type, given: dict[str, Any], where: Where, scope: Scope, other_keys: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Every parameter of a type: given values resolved, defaults applied, None where there is neither.

    ``other_keys`` may stand in the same table and are left to the caller.
    """
    known = [*(param.name for param in type_.params), *other_keys]
    for key in given:
        if key not in known:
            raise where.child(key).unknown(key, f"parameter of {type_.name}", known)
    values: dict[str, Any] = dict.fromkeys(param.name for param in type_.params)
    for param in type_.params:
        if param.name in given:
            values[param.name] = resolve_value(param, given[param.name], where.child(param.name), scope)
    chosen = _choose_alternatives(type_, given, where)
    for param in type_.params:
        applies = not param.group or chosen[param.set_name] == param.alternative
        if applies and param.name not in given:
            values[param.name] = _default(param, scope)
        if applies and values[param.name] is None and (param.group or param.required):
            raise where.error(f"lacks `{param.name}`", allowed=f"{param.kind}: {param.doc}")
    keep_polygons(values, given)
    _expand_shorthands(type_, values, where, scope)
    check_together(type_, values, where)
    return values


def expect_table(value: Any, where: Where) -> dict[str, Any]:
    """The value as a table with text keys."""
    if not isinstance(value, dict) or not all(isinstance(key, str) for key in value):
        raise where.error("is not a table", value=value, allowed="a table of `key = value`")
    return value


def _choose_alternatives(type_: Type, given: dict[str, Any], where: Where) -> dict[str, str]:
    """Which alternative of each set holds: the one given, else the one that has a default, else ("") none."""
    chosen: dict[str, str] = {}
    for set_name, alternatives in type_.sets().items():
        optional = set_name.endswith("?")
        count = "at most" if optional else "exactly"
        text = f"{count} one of " + " | ".join(" with ".join(p.name for p in group) for group in alternatives.values())
        used = [name for name, group in alternatives.items() if any(param.name in given for param in group)]
        if len(used) > 1:
            names = [param.name for name in used for param in alternatives[name] if param.name in given]
            raise where.child(names[-1]).error(f"has `{names[0]}` and `{names[-1]}` at once", allowed=text)
        if not used:
            used = [name for name, group in alternatives.items() if all(param.default is not None for param in group)]
        if not used and not optional:
            raise where.error("lacks its " + set_name, allowed=text)
        chosen[set_name] = used[0] if used else ""
    _check_companions(type_, given, chosen, where)
    return chosen


def _check_companions(type_: Type, given: dict[str, Any], chosen: dict[str, str], where: Where) -> None:
    """Ungrouped arrays that share rows with a grouped one (normals with positions) need it to be given."""
    for param in type_.params:
        if param.kind != "array" or param.group or param.name not in given:
            continue
        partner = next((p for p in type_.params if p.kind == "array" and p.group and p.role[0] == param.role[0]), None)
        if partner is not None and chosen[partner.set_name] != partner.alternative:
            raise where.child(param.name).error(f"is only allowed together with `{partner.name}`")


def _default(param: Param, scope: Scope) -> Any:
    """The canonical default of a parameter, resolved once per scene; bare lengths in it are metres."""
    if param.default is None:
        return None
    if id(param) not in scope.defaults:
        where = Where(Document({}, BUILT_IN), (param.name,))
        default = [param.default] if param.kind == "reference" and param.role == "shape" else param.default
        scope.defaults[id(param)] = resolve_value(param, default, where, scope)
    return scope.defaults[id(param)]


def default_values(type_: Type, schema: Schema) -> dict[str, Any]:
    """Every parameter of a type at its canonical default; None where there is none, and for alternatives of a set."""
    scope = Scope(Document({}, BUILT_IN), schema, Confinement.around(Path(), ()))
    return {param.name: None if param.group else _default(param, scope) for param in type_.params}


def _expand_shorthands(type_: Type, values: dict[str, Any], where: Where, scope: Scope) -> None:
    """A file fills the arrays that it stands for, a metal's name its refractive index."""
    for param in type_.params:
        value = values[param.name]
        if value is None or not param.group:
            continue
        if vocabulary(param) is not None:
            values.update({key: item for key, item in metal_spectra(value).items() if key in values})
        elif param.role == "image":
            values["pixels"] = read_pixels(value, where.child(param.name), scope)
        elif param.kind == "file":
            scope.mesh_reports[str(where.path[-1])] = fill_from_file(
                type_, values, value, where.child(param.name), scope
            )
