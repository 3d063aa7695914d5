"""Materials for the compiled builder: innermost parts first, models taken apart, maps handed down."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from accuray.scene import openpbr
from accuray.scene import schema as schemas
from accuray.scene.composition import MAPS, parts_of
from accuray.scene.objects import default_values

Values = dict[str, Any]
MODELS: dict[str, Callable[[Values], Values]] = {openpbr.NAME: openpbr.tree}
"""Types that are made of others: from all parameters to the nested table of what they are made of."""


class MaterialLowering:
    """Adds the materials of a scene to a builder, each once for every set of maps that it is shown with.

    Args:
        materials: the scene's, by name.
        builder: ``accuray._core.lower.SceneBuilder``.
        values_of: the builder's values of some parameters of a table.
        guard: runs an action; its errors then name the given key of the scene.
    """

    def __init__(
        self,
        materials: dict[str, Values],
        builder: Any,
        values_of: Callable[[tuple[schemas.Param, ...], Values], Values],
        guard: Callable[[str, Callable[[], int]], int],
    ) -> None:
        self._materials = materials
        self._builder = builder
        self._values_of = values_of
        self._guard = guard
        self._schema = schemas.current()
        self._numbers: dict[tuple[str, tuple[Any, ...]], int] = {}

    def numbers(self) -> dict[str, int]:
        """The builder's number of every material of the scene, by its name."""
        none = dict.fromkeys(MAPS)
        return {name: self._named(name, none) for name in self._materials}

    def _named(self, name: str, maps: Values) -> int:
        """A material of the scene; ``maps`` are those of what it is a part of."""
        material = self._materials[name]
        if material["normal_map"] is None and material["bump_map"] is None:
            material = {**material, **{key: value for key, value in maps.items() if value is not None}}
        key = (name, tuple(material[key] for key in MAPS))
        if key not in self._numbers:
            if material["type"] in MODELS:
                header = {param.name: material[param.name] for param in self._schema.family("material").common}
                material = self._whole(MODELS[material["type"]](material)) | header
            self._numbers[key] = self._guard(f"materials.{name}", partial(self._add, material))
        return self._numbers[key]

    def _whole(self, table: Values) -> Values:
        """A table of a model with the defaults of what it leaves out."""
        return default_values(self._schema.material_types[table["type"]], self._schema) | table

    def _add(self, table: Values) -> int:
        """A material with all its parameters; parts are names, or tables that leave out what is at its default."""
        maps = {key: table[key] for key in MAPS}
        parts = {
            param: self._named(part, maps) if isinstance(part, str) else self._add(self._whole(part) | maps)
            for param, part in parts_of(table, self._schema)
        }
        material = table | parts
        header = self._values_of(self._schema.family("material").common, material)
        emission = header.pop("emission", None)
        bsdf = self._schema.family("bsdf").types.get(material["type"])
        type_ = bsdf or self._schema.family("composition").types[material["type"]]
        add = self._builder.add_material if bsdf else self._builder.add_composition
        number: int = add(type_.name, self._values_of(type_.params, material), header, emission)
        return number
