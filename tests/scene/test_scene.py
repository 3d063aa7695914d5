"""The resolved scene: defaults, sets of alternatives, order, film unit, identity."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import pytest

from accuray.scene import Scene, SceneError, Spectrum
from accuray.scene import schema as schemas
from accuray.scene.scene import film_unit


def triangle(**more: Any) -> dict[str, Any]:
    """A mesh of one triangle."""
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    return {"type": "mesh", "material": "grey", "positions": positions, "faces": [[0, 1, 2]], **more}


def description() -> dict[str, Any]:
    """A scene with something in every section."""
    return {
        "accuray": 1,
        "film": {"width": 32, "height": 16, "exposure": 1.0, "filter": {"type": "box"}},
        "camera": {"type": "perspective", "fov": 30},
        "integrator": {"type": "direct"},
        "render": {"spp": 16, "seed": 7, "replicates": 2},
        "spectra": {"warm": {"blackbody": 3000, "normalize": True}},
        "materials": {"grey": {"type": "diffuse", "emission": "warm"}, "gold": {"type": "conductor", "metal": "Au"}},
        "lights": {"lamp": {"type": "point", "position": [0, 2, 0], "intensity": 3}},
        "shapes": {"b": triangle(), "a": {"type": "sphere", "material": "gold", "radius": 0.25}},
    }


def changed(path: str, value: Any) -> dict[str, Any]:
    """The scene with one value changed; the path is dotted."""
    scene = description()
    *sections, key = path.split(".")
    table = scene
    for section in sections:
        table = table.setdefault(section, {})
    table[key] = value
    return scene


def test_an_empty_scene_has_every_default() -> None:
    scene = Scene.from_dict({})
    assert (scene.camera["type"], scene.integrator["type"], scene.filter["type"]) == ("perspective", "path", "gaussian")
    assert scene.camera["fov"] == math.radians(40)
    assert scene.camera["focal_length"] is None
    assert scene.film["unit"] == 2.0**-24
    assert (scene.materials, scene.lights, scene.shapes, scene.path) == ({}, {}, {}, None)


def test_every_parameter_of_every_type_is_there() -> None:
    scene, schema = Scene.from_dict(description()), schemas.current()
    for shape in scene.shapes.values():
        assert list(shape) == ["type", *(param.name for param in schema.family("shape").types[shape["type"]].params)]
    for material in scene.materials.values():
        assert list(material) == ["type", *(param.name for param in schema.material_types[material["type"]].params)]


def test_objects_are_in_the_order_of_their_names() -> None:
    scene = Scene.from_dict(description())
    assert list(scene.shapes) == ["a", "b"]
    assert list(scene.materials) == ["gold", "grey"]


def test_an_alternative_switches_the_default_of_the_others_off() -> None:
    camera = Scene.from_dict(
        changed("camera", {"type": "perspective", "focal_length": 0.05, "film_size": "36 mm"})
    ).camera
    assert (camera["fov"], camera["focal_length"], camera["film_size"]) == (None, 0.05, 0.036)


def test_defaults_are_metres_whatever_the_length_unit_is() -> None:
    scene = Scene.from_dict({**description(), "length_unit": "mm"})
    assert scene.camera["position"] == (0.0, 0.0, 5.0)
    assert scene.shapes["a"]["radius"] == 0.00025
    assert scene.lights["lamp"]["position"] == (0.0, 0.002, 0.0)


def test_metals_become_indices() -> None:
    gold = Scene.from_dict(description()).materials["gold"]
    assert gold["metal"] == "Au"
    assert (gold["eta"].at(587.5), gold["k"].at(587.5)) == pytest.approx((0.277, 2.927), abs=2e-3)
    mirror = Scene.from_dict(changed("materials.gold.metal", "perfect")).materials["gold"]
    assert mirror["eta"] == Spectrum("constant", "index", value=0.0)


def test_numpy_arrays_and_scalars() -> None:
    mesh = triangle(positions=np.eye(3), faces=np.array([[0, 1, 2]]), normals=np.eye(3), uvs=np.zeros((3, 2)),
                    transform=np.diag([2.0, 2.0, 2.0, 1.0]))  # fmt: skip
    scene = Scene.from_dict(changed("shapes.b", mesh))
    assert np.array_equal(scene.shapes["b"]["transform"], np.diag([2.0, 2.0, 2.0, 1.0]))
    assert Scene.from_dict(changed("film.width", np.int64(5))).film["width"] == 5
    assert Scene.from_dict(changed("camera.position", np.array([1, 2, 3]))).camera["position"] == (1.0, 2.0, 3.0)
    assert Scene.from_dict(changed("film.exposure", np.float32(0.5))).film["exposure"] == 0.5
    spectrum = Spectrum("constant", "reflectance", value=0.25)
    assert Scene.from_dict(changed("materials.grey.reflectance", spectrum)).materials["grey"]["reflectance"] == spectrum


def test_instances() -> None:
    scene = description()
    scene["shapes"]["b"]["prototype"] = True
    scene["shapes"]["one"] = {"type": "instance", "of": "b", "transform": {"translate": [1, 0, 0]}}
    scene["shapes"]["two"] = {"type": "instance", "of": ["b"], "material": "gold"}
    shapes = Scene.from_dict(scene).shapes
    assert (shapes["one"]["of"], shapes["two"]["of"]) == (["b"], ["b"])
    assert (shapes["one"]["material"], shapes["two"]["material"]) == (None, "gold")


def test_include_belongs_to_files() -> None:
    with pytest.raises(SceneError, match="include: is only allowed in scene files"):
        Scene.from_dict({"include": ["x.toml"]})


@pytest.mark.parametrize(
    ("unit", "exposure", "expected"),
    [
        (None, 0, -24),
        (None, 1, -25),
        (None, -2.4, -22),
        (None, 60, -84),
        (1e-3, 5, -10),
        (0.75, 0, 0),
        (0.7, 0, -1),
        (1, 9, 0),
    ],
)
def test_film_unit_is_a_power_of_two(unit: float | None, exposure: float, expected: int) -> None:
    assert film_unit(unit, exposure) == 2.0**expected


def identity(scene: dict[str, Any]) -> str:
    return Scene.from_dict(scene).identity


def test_identity_is_a_hash_that_stays() -> None:
    """The literal changes only together with the sampling version, or with a new parameter of a type used here."""
    found = identity(description())
    assert len(found) == 64
    assert int(found, 16) > 0
    assert found == identity(copy.deepcopy(description()))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("render.spp", 1), ("render.seed", 1), ("film.white_balance", "D65"), ("camera.fov", "30 deg"),
        ("camera.fov_axis", "vertical"), ("lights.lamp.position", ["0 m", "200 cm", 0.0]), ("shapes.a.radius", "25 cm"),
        ("shapes.b.prototype", False), ("materials.grey.reflectance", {"value": 0.5}),
        ("materials.grey.emission", {"blackbody": "3000 K", "normalize": True}), ("spectra.unused", 3),
        ("shapes.b.positions", np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])), ("length_unit", "m"),
        ("lights.lamp.intensity", {"value": 1.5, "scale": 2}), ("film.hide_environment", False),
    ],
)  # fmt: skip
def test_identity_does_not_depend_on(path: str, value: Any) -> None:
    assert identity(changed(path, value)) == identity(description())


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("film.width", 33), ("film.exposure", 2.0), ("film.unit", 2.0**-30), ("film.hide_environment", True),
        ("film.filter.radius", 0.75), ("film.filter.type", "tent"), ("render.replicates", 4), ("camera.fov", 30.000001),
        ("camera.up", [0, 1, 1e-9]), ("integrator.type", "path"), ("materials.grey.reflectance", 0.5000001),
        ("materials.gold.metal", "Ag"), ("spectra.warm", 3), ("lights.lamp.position", [0, 2, 1e-12]),
        ("shapes.a.radius", 0.26), ("shapes.b.positions", [[0, 0, 0], [1, 0, 0], [0, 1, 1e-6]]),
        ("shapes.b.faces", [[0, 2, 1]]), ("shapes.b.transform", {"scale": 2}), ("shapes.b.shading", "flat"),
        ("shapes.b.normals", [[0, 0, 1]] * 3), ("length_unit", "mm"), ("shapes.c", triangle()),
        ("materials.grey.emission_sides", "both"), ("film.exposure", 1.6),
    ],
)  # fmt: skip
def test_identity_depends_on(path: str, value: Any) -> None:
    assert identity(changed(path, value)) != identity(description())


def test_identity_follows_the_exposure_only_through_the_film_unit() -> None:
    assert identity(changed("film.exposure", 1.2)) == identity(description())
    pinned = changed("film.unit", 2.0**-24)
    brighter = copy.deepcopy(pinned)
    brighter["film"]["exposure"] = 9
    assert identity(pinned) == identity(brighter)


def test_identity_does_not_depend_on_the_order_of_keys() -> None:
    def backwards(value: Any) -> Any:
        return {key: backwards(value[key]) for key in reversed(value)} if isinstance(value, dict) else value

    assert identity(backwards(description())) == identity(description())


def test_identity_of_a_metal_is_that_of_its_index() -> None:
    gold = Scene.from_dict(description()).materials["gold"]
    written = {"type": "conductor"} | {
        key: {"wavelengths": list(gold[key].wavelengths), "values": list(gold[key].values)} for key in ("eta", "k")
    }
    assert identity(changed("materials.gold", written)) == identity(description())
