"""Parameter sets are made from tables alone, respect ranges and groups, and cover the ends."""

from __future__ import annotations

from typing import Any

from accuray.testing import alternatives, parameter_sets, types_of


def param(name: str, kind: str, **more: Any) -> dict[str, Any]:
    base = {"default": None, "required": False, "min": None, "max": None, "choices": [], "role": "", "group": ""}
    return {"name": name, "kind": kind} | base | more


GLASS = {"name": "glass", "params": [param("ior", "spectrum", default=1.5, min=0.1, max=20, role="index")]}
METAL = {
    "name": "metal",
    "params": [
        param("metal", "text", group="index:metal"),
        param("eta", "spectrum", min=0, role="index", group="index:eta_k"),
        param("k", "spectrum", min=0, role="index", group="index:eta_k"),
        param("rough", "float", default=0.1, min=0.0, max=1.0),
    ],
}
MESH = {
    "name": "mesh",
    "params": [param("file", "file", group="geometry:file"), param("positions", "array", group="geometry:arrays")],
}
MIXED = {
    "name": "mixed",
    "params": [
        param("on", "bool", default=True),
        param("n", "int", default=3, min=1, max=9),
        param("mode", "enum", default="a", choices=["a", "b", "c"]),
        param("axis", "vec"),
        param("map", "file"),
    ],
}
TABLES = {"families": {"bsdf": {"types": [GLASS, METAL]}, "shape": {"types": [MESH]}, "test": {"types": [MIXED]}}}


def test_types_of_every_list() -> None:
    assert [t["name"] for _, t in types_of(TABLES)] == ["glass", "metal", "mesh", "mixed"]
    assert [t["name"] for _, t in types_of(TABLES, "bsdf")] == ["glass", "metal"]


def test_exactly_one_of() -> None:
    assert set(alternatives(METAL)) == {frozenset({"metal", "rough"}), frozenset({"eta", "k", "rough"})}


def test_groups_ranges_and_ends() -> None:
    for values in parameter_sets(METAL):
        assert "metal" not in values, "no metal is known by name here"
        assert {"eta", "k", "rough"} <= set(values)
        assert 0.0 <= values["rough"] <= 1.0
    named = parameter_sets(METAL, texts={"metal": ("Au", "Ag")})
    assert {v.get("metal") for v in named} == {None, "Au", "Ag"}
    iors = [v["ior"] for v in parameter_sets(GLASS)]
    assert iors[:3] == [1.5, 0.1, 20.0]
    assert len(iors) == 24


def test_what_cannot_be_invented_is_left_out() -> None:
    assert parameter_sets(MESH) == []
    sets = parameter_sets(MIXED)
    assert all("map" not in v for v in sets)
    assert {v["mode"] for v in sets} == {"a", "b", "c"}
    assert all(isinstance(v["n"], int) and 1 <= v["n"] <= 9 for v in sets)


def test_sets_are_reproducible() -> None:
    assert parameter_sets(MIXED, seed=4) == parameter_sets(MIXED, seed=4)
    assert parameter_sets(MIXED, seed=4) != parameter_sets(MIXED, seed=5)
