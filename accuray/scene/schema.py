"""The parameter tables that the kernels' headers define, as Python objects.

Every type (BSDF, light, shape, camera, ...) describes its parameters in its C++ header; the compiled module
returns them as plain dicts. Validation, documentation and the JSON Schema read only these tables, so a type
that is added in C++ needs no line of Python.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any


@dataclass(frozen=True)
class Param:
    """One parameter. ``min``, ``max`` and ``default`` are in the documented ``unit``.

    ``untextured`` says why it takes no texture where one might be expected; ``takes_flux``: the flux of the whole
    emitter may stand for an emission.
    """

    name: str
    kind: str
    default: Any = None
    required: bool = False
    min: float | None = None
    max: float | None = None
    unit: str = ""
    choices: tuple[str, ...] = ()
    role: str = ""
    group: str = ""
    texturable: bool = False
    untextured: str = ""
    takes_flux: bool = False
    animatable: bool = False
    doc: str = ""

    @property
    def set_name(self) -> str:
        """Name of the "exactly one of" set, "" if the parameter stands alone; with a "?" where none may be given."""
        return self.group.partition(":")[0]

    @property
    def alternative(self) -> str:
        """Name of the alternative inside the set."""
        return self.group.partition(":")[2]


@dataclass(frozen=True)
class Type:
    """A type of a family: ``params`` hold its own parameters and the common ones of its family.

    ``reads_uv``: a texture that needs shapes with texture coordinates; ``reads_colors``: one that needs meshes with
    vertex colours. ``rigid``: a shape that no transform may shear or stretch.
    """

    name: str
    doc: str
    params: tuple[Param, ...]
    keeps: tuple[str, ...] = ()
    reads_uv: bool = False
    reads_colors: bool = False
    rigid: bool = False

    def sets(self) -> dict[str, dict[str, list[Param]]]:
        """The "exactly one of" sets: set name -> alternative -> its parameters."""
        found: dict[str, dict[str, list[Param]]] = {}
        for param in self.params:
            if param.group:
                found.setdefault(param.set_name, {}).setdefault(param.alternative, []).append(param)
        return found


@dataclass(frozen=True)
class Family:
    """A family of types. One without types (film, render) is a single table of common parameters."""

    name: str
    common: tuple[Param, ...]
    types: dict[str, Type]
    default: str

    @property
    def header(self) -> Type:
        """The common parameters as a type of their own."""
        return Type(self.name, "", self.common)


@dataclass(frozen=True)
class Schema:
    """All families; ``sampling_version`` changes whenever the same scene gives other samples."""

    sampling_version: int
    families: dict[str, Family]

    def family(self, name: str) -> Family:
        """A family by name; an unknown one is a bug of ours."""
        return self.families[name]

    @cached_property
    def material_types(self) -> dict[str, Type]:
        """BSDFs, compositions and models with the header that all materials share."""
        header = self.family("material").common
        types = {k: v for family in ("bsdf", "composition", "model") for k, v in self.family(family).types.items()}
        return {name: Type(name, type_.doc, (*type_.params, *header), type_.keeps) for name, type_ in types.items()}


def parse(tables: dict[str, Any]) -> Schema:
    """Schema objects from the plain tables."""
    families = {name: _family(name, family) for name, family in tables["families"].items()}
    return Schema(int(tables["sampling_version"]), families)


def _family(name: str, family: dict[str, Any]) -> Family:
    common = tuple(_param(entry) for entry in family.get("common", ()))
    types = {
        entry["name"]: Type(
            entry["name"],
            entry.get("doc", ""),
            (*(_param(param) for param in entry["params"]), *common),
            tuple(entry.get("keeps", ())),
            bool(entry.get("reads_uv", False)),
            bool(entry.get("reads_colors", False)),
            bool(entry.get("rigid", False)),
        )
        for entry in family.get("types", ())
    }
    return Family(name, common, types, family.get("default") or next(iter(types), ""))


def _param(entry: dict[str, Any]) -> Param:
    known = {field.name for field in fields(Param)}
    values = {key: value for key, value in entry.items() if key in known}
    values["choices"] = tuple(entry.get("choices") or ())
    return Param(**values)


def load_tables() -> dict[str, Any]:
    """The plain tables of the compiled module."""
    from accuray._core import schema

    tables: dict[str, Any] = schema.tables()
    return tables


_current: Schema | None = None


def current() -> Schema:
    """The schema in use: that of the compiled module unless ``use`` replaced it."""
    global _current
    if _current is None:
        _current = parse(load_tables())
    return _current


def use(tables: dict[str, Any] | None) -> None:
    """Replace the schema by these plain tables; None goes back to the compiled module's."""
    global _current
    _current = None if tables is None else parse(tables)
