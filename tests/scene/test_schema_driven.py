"""Validation, JSON Schema and reference page follow the parameter tables: a new type needs no Python."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Iterator
from typing import Any

import pytest

from accuray.scene import Scene, SceneError, schema
from accuray.scene.jsonschema import json_schema
from accuray.scene.reference import reference_markdown
from accuray.scene.schema import Param, Type

NOT_NUMBERS = [math.nan, math.inf, -math.inf, 1e400, 10**400, "nan", "1e999 m", None, True, [], {}, [[1]], "x" * 10_000]
SECTION_OF = {
    "filter": "filter", "camera": "camera", "integrator": "integrator", "texture": "textures", "light": "lights",
    "shape": "shapes",
}  # fmt: skip


NEEDED: dict[str, dict[str, Any]] = {"conductor": {"metal": "Au"}, "image": {"pixels": [[0.5]]}}
"""What a type cannot do without, besides the parameter in question."""


def with_velvet(tables: dict[str, Any]) -> dict[str, Any]:
    """The tables and one more BSDF, as a new header in the kernels would add it."""
    common = {"required": False, "role": "", "group": "", "texturable": False, "animatable": True, "choices": []}
    params = [
        {**common, "name": "colour", "kind": "spectrum", "default": [0.5, 0.1, 0.1], "min": 0, "max": 1, "unit": "1",
         "role": "reflectance", "doc": "Colour of the fibres."},
        {**common, "name": "length", "kind": "float", "default": 0.002, "min": 0, "max": 0.1, "unit": "m",
         "doc": "Length of the fibres."},
        {**common, "name": "tilt", "kind": "float", "default": 5, "min": -60, "max": 60, "unit": "deg", "doc": "Tilt."},
    ]  # fmt: skip
    changed = copy.deepcopy(tables)
    changed["families"]["bsdf"]["types"].append(
        {"name": "velvet", "doc": "Fibres that stand on a cloth.", "keeps": ["reciprocal"], "params": params}
    )
    return changed


def test_a_new_bsdf_needs_no_python() -> None:
    schema.use(with_velvet(schema.load_tables()))
    described = {"materials": {"sofa": {"type": "velvet", "length": "3 mm", "tilt": "0.1 rad", "emission": 2}}}
    sofa = Scene.from_dict(described).materials["sofa"]
    assert (sofa["length"], sofa["tilt"]) == pytest.approx((0.003, 0.1))
    assert sofa["colour"].rgb == (0.5, 0.1, 0.1)
    with pytest.raises(SceneError, match=r"materials.sofa.length: \"1 ft\" is out of range: allowed 0 to 0.1 m"):
        Scene.from_dict({"materials": {"sofa": {"type": "velvet", "length": "1 ft"}}})
    with pytest.raises(SceneError, match=r"did you mean \"velvet\""):
        Scene.from_dict({"materials": {"sofa": {"type": "velvett"}}})
    tagged = json_schema()["properties"]["materials"]["additionalProperties"]["oneOf"]
    assert "velvet" in [node["properties"]["type"]["const"] for node in tagged]
    assert '### `type = "velvet"`' in reference_markdown()
    assert "| `tilt` | float | deg | -60 to 60 deg | `5` | Tilt. |" in reference_markdown()


def test_absolute_lengths_ignore_the_length_unit() -> None:
    tables = copy.deepcopy(schema.load_tables())
    for param in tables["families"]["camera"]["types"][0]["params"]:
        if param["name"] in ("focal_length", "film_size"):
            param["role"] = "absolute"
    schema.use(tables)
    camera = {"type": "perspective", "focal_length": 0.035, "film_size": "25 mm", "position": [0, 0, 1]}
    resolved = Scene.from_dict({"length_unit": "km", "camera": camera}).camera
    assert (resolved["focal_length"], resolved["film_size"], resolved["position"]) == (0.035, 0.025, (0.0, 0.0, 1000.0))


def all_types() -> Iterator[tuple[str, Type]]:
    """Every type with the section that it stands in."""
    found = schema.parse(schema.load_tables())
    for family, section in SECTION_OF.items():
        yield from ((section, type_) for type_ in found.family(family).types.values())
    yield from (("materials", type_) for type_ in found.material_types.values())
    yield "film", found.family("film").header
    yield "render", found.family("render").header


def numeric_fields() -> list[Any]:
    """Every parameter that takes numbers, of every type."""
    kinds = ("int", "float", "vec", "spectrum")
    return [
        pytest.param(section, type_, param, id=f"{section}-{type_.name}-{param.name}")
        for section, type_ in all_types()
        for param in type_.params
        if param.kind in kinds
    ]


#: One alternative of the sets that have no default.
TRIANGLE = {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}
NEEDED: dict[str, dict[str, Any]] = {
    "conductor": {"eta": 1.0, "k": 1.0},
    "environment": {"pixels": [[0.5]]},
    "ies": {"file": "builtin:wall_washer.ies"},
    "mesh": TRIANGLE,
}


def scene_with(section: str, type_: Type, param: Param, value: Any) -> dict[str, Any]:
    """A scene whose only fault can be the value of that parameter."""
    if section in ("film", "render"):
        return {section: {param.name: value}}
    needed = {} if param.group else NEEDED.get(type_.name, {})
    needed |= {p.name: 1000.0 for p in type_.params if p.required and p.kind == "float"}
    parts = {p.name: "part" for p in type_.params if p.required and p.kind == "reference" and section == "materials"}
    table = {"type": type_.name, **needed, **parts, param.name: value}
    if section == "filter":
        return {"film": {"filter": table}}
    if section in ("camera", "integrator"):
        return {section: table}
    if section == "shapes":
        table["material"] = "m"
        return {"materials": {"m": {"type": "diffuse"}}, section: {"x": table}}
    return {section: {"x": table, **({"part": {"type": "diffuse"}} if parts else {})}}


@pytest.mark.parametrize(("section", "type_", "param"), numeric_fields())
def test_no_numeric_field_takes_what_is_no_finite_number(section: str, type_: Type, param: Param) -> None:
    for bad in NOT_NUMBERS:
        values = [bad, [bad] * 3, [0.1, bad, 0.1]] if param.kind in ("vec", "spectrum") else [bad]
        for value in values:
            with pytest.raises(SceneError) as caught:
                Scene.from_dict(scene_with(section, type_, param, value))
            assert param.name in caught.value.key, str(caught.value)[:300]
            assert len(str(caught.value)) < 2000


@pytest.mark.parametrize(("section", "type_", "param"), numeric_fields())
def test_limits_are_allowed_and_what_lies_beyond_is_not(section: str, type_: Type, param: Param) -> None:
    if param.kind not in ("int", "float") or param.group:
        return
    for limit, sign in ((param.min, -1), (param.max, 1)):
        if limit is None:
            continue
        exact = int(limit) if param.kind == "int" else limit
        beyond = exact + sign if param.kind == "int" else limit + sign * max(1e-6, abs(limit) * 1e-6)
        Scene.from_dict(scene_with(section, type_, param, exact))
        with pytest.raises(SceneError, match="is out of range"):
            Scene.from_dict(scene_with(section, type_, param, beyond))


def test_defaults_of_every_type_are_valid() -> None:
    for section, type_ in all_types():
        needed = any(param.required for param in type_.params) or any(
            not any(all(p.default is not None for p in group) for group in alternatives.values())
            for name, alternatives in type_.sets().items()
            if not name.endswith("?")
        )
        if not needed:
            dummy = Param(type_.params[0].name, "int") if type_.params else None
            scene = scene_with(section, type_, dummy or Param("x", "int"), None)
            table = scene["film"]["filter"] if section == "filter" else scene[section]
            table = table["x"] if section in ("textures", "materials", "lights", "shapes") else table
            table.pop(dummy.name if dummy else "x")
            Scene.from_dict(scene)


def test_tables_say_all_that_validation_needs() -> None:
    for _, type_ in all_types():
        for param in type_.params:
            assert param.doc, f"{type_.name}.{param.name} has no sentence"
            assert param.kind != "spectrum" or param.role in ("reflectance", "emission", "index")
            assert param.kind != "enum" or param.choices
            assert param.kind != "array" or param.role in (
                "Nx2",
                "Nx3",
                "Nx3 or Nx4",
                "faces",
                "pixels",
                "file or Nx3x4",
                "file or N",
            )


def test_json_schema_is_plain_and_complete() -> None:
    node = json.loads(json.dumps(json_schema()))
    assert set(node["properties"]) == {
        "accuray", "length_unit", "include", "render", "film", "camera", "integrator", "models", "spectra", "textures",
        "materials", "lights", "shapes",
    }  # fmt: skip
    for section, type_ in all_types():
        if section in ("film", "render"):
            assert set(node["properties"][section]["properties"]) >= {param.name for param in type_.params}
    assert node["properties"]["film"]["properties"]["width"]["maximum"] == 65536


def test_reference_page_names_every_type_and_parameter() -> None:
    page = reference_markdown()
    for _, type_ in all_types():
        for param in type_.params:
            assert f"| `{param.name}` |" in page
    rows = [line.count("|") - line.count("\\|") for line in page.splitlines() if line.startswith("|")]
    assert set(rows) <= {3, 4, 7}, "a cell holds a bar"
