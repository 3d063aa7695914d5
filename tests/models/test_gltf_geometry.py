"""glTF: accessors, primitives, the node hierarchy, cameras and lights, against values known beforehand."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from model_files import SQUARE, SQUARE_UVS, TWO_TRIANGLES, GltfFile, every_feature

import accuray


def load(file: GltfFile, name: str = "a.glb") -> accuray.Scene:
    return accuray.load(file.save(Path(name)))


def only(scene: accuray.Scene) -> dict[str, Any]:
    (shape,) = scene.shapes.values()
    return shape


@pytest.mark.parametrize("name", ["a.glb", "a.gltf"])
def test_a_square(name: str) -> None:
    file = GltfFile()
    file.node(mesh=file.mesh(TEXCOORD_0=SQUARE_UVS))
    shape = only(load(file, name))
    assert np.array_equal(shape["positions"], SQUARE)
    assert shape["faces"].tolist() == [[0, 1, 2], [0, 2, 3]]
    assert shape["normals"] is None
    assert shape["uvs"].tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]], "v runs upwards here"
    assert shape["transform"] is None


def test_buffers_beside_the_file() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh())
    Path("the data.bin").write_bytes(bytes(file.blob) + b"more")
    Path("a.gltf").write_text(file.text("the%20data.bin"))
    assert np.array_equal(only(accuray.load("a.gltf"))["positions"], SQUARE)


@pytest.mark.parametrize(
    ("mode", "indices", "expected"),
    [
        (4, [0, 1, 2, 0, 2, 3, 1], [[0, 1, 2], [0, 2, 3]]),
        (5, [0, 1, 3, 2], [[0, 1, 3], [3, 1, 2]]),
        (6, [0, 1, 2, 3], [[0, 1, 2], [0, 2, 3]]),
        (6, None, [[0, 1, 2], [0, 2, 3]]),
    ],
)
def test_primitive_modes(mode: int, indices: list[int] | None, expected: list[list[int]]) -> None:
    file = GltfFile()
    mesh = file.mesh(indices=None if indices is None else np.array(indices, "u1"))
    file.data["meshes"][mesh]["primitives"][0]["mode"] = mode
    file.node(mesh=mesh)
    assert only(load(file))["faces"].tolist() == expected


def test_quantized_positions_and_normals() -> None:
    file = GltfFile()
    raw = np.array([[0, 0, 0], [65535, 0, 0], [65535, 65535, 0], [0, 65535, 0]], "<u2")
    mesh = file.mesh(POSITION=raw, NORMAL=np.array([[0, 0, 127], [0, 0, -128], [0, 127, 0], [0, 0, 127]], "i1"))
    for accessor in file.data["accessors"][:2]:
        accessor["normalized"] = True
    file.data["extensionsRequired"] = file.data["extensionsUsed"] = ["KHR_mesh_quantization"]
    file.node(mesh=mesh)
    shape = only(load(file))
    assert np.array_equal(shape["positions"], SQUARE)
    assert shape["normals"].tolist() == [[0, 0, 1], [0, 0, -1], [0, 1, 0], [0, 0, 1]]


def test_whole_numbers_that_stand_for_themselves() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh(POSITION=np.array([[0, 0, 0], [300, 0, 0], [0, -7, 0]], "<i2"), indices=None))
    assert only(load(file))["positions"].tolist() == [[0, 0, 0], [300, 0, 0], [0, -7, 0]]


def test_interleaved_attributes() -> None:
    file = GltfFile()
    rows = np.concatenate([SQUARE, SQUARE_UVS], axis=1).astype("<f4")
    mesh = file.mesh(TEXCOORD_0=SQUARE_UVS)
    view = file.view(rows.tobytes(), byteStride=20)
    attributes = file.data["meshes"][mesh]["primitives"][0]["attributes"]
    for key, offset in (("POSITION", 0), ("TEXCOORD_0", 12)):
        file.data["accessors"][attributes[key]] |= {"bufferView": view, "byteOffset": offset}
    file.node(mesh=mesh)
    shape = only(load(file))
    assert np.array_equal(shape["positions"], SQUARE)
    assert np.array_equal(shape["uvs"][:, 1], 1 - SQUARE_UVS[:, 1])


def test_sparse_accessors_with_and_without_a_base() -> None:
    for base in (True, False):
        file = GltfFile()
        mesh = file.mesh()
        accessor = file.data["accessors"][0]
        if not base:
            del accessor["bufferView"]
        values = np.array([[2, 0, 0], [5, 5, 0], [0, 3, 0]], "<f4")
        accessor["sparse"] = {
            "count": 3,
            "indices": {"bufferView": file.view(np.array([1, 2, 3], "u1").tobytes()), "componentType": 5121},
            "values": {"bufferView": file.view(values.tobytes())},
        }
        file.node(mesh=mesh)
        expected = (SQUARE if base else np.zeros_like(SQUARE)).copy()
        expected[[1, 2, 3]] = values
        shape = only(load(file))
        assert np.array_equal(shape["positions"], expected)


def test_triangles_that_cannot_be_rendered_are_noted() -> None:
    file = GltfFile()
    positions = SQUARE.copy()
    positions[3, 1] = math.nan
    file.node(mesh=file.mesh(POSITION=positions))
    scene = load(file)
    assert len(only(scene)["faces"]) == 1
    assert any("1 nonfinite triangles were left out" in note for note in scene.model_notes)


def placed(scene: accuray.Scene, name: str) -> np.ndarray[Any, Any]:
    """The vertices of a shape in the world."""
    shape = scene.shapes[name]
    source = scene.shapes[shape["of"][0]] if shape["type"] == "instance" else shape
    matrix = np.eye(4) if shape["transform"] is None else shape["transform"]
    points = np.concatenate([source["positions"], np.ones((4, 1))], axis=1)
    return (points @ matrix.T)[:, :3]


def test_hierarchy_of_nodes() -> None:
    file = GltfFile()
    mesh = file.mesh()
    leaf = file.node(root=False, name="leaf", mesh=mesh, translation=[0, 1, 0])
    half_turn = [0, math.sin(math.pi / 4), 0, math.cos(math.pi / 4)]
    file.node(name="root", mesh=mesh, translation=[5, 0, 0], rotation=half_turn, scale=[2, 2, 2], children=[leaf])
    scene = load(file)
    assert scene.shapes["root"]["type"] == scene.shapes["leaf"]["type"] == "instance"
    assert scene.shapes["root"]["of"] == scene.shapes["leaf"]["of"]
    # A quarter turn about y takes x to -z.
    assert placed(scene, "root")[1] == pytest.approx([5, 0, -2], abs=1e-12)
    assert placed(scene, "leaf")[1] == pytest.approx([5, 2, -2], abs=1e-12)


def test_stretched_copies_are_meshes_of_their_own() -> None:
    file = GltfFile()
    mesh = file.mesh()
    for name, scale in (("plain", [1, 1, 1]), ("stretched", [1, 3, 1]), ("mirrored", [-1, 1, 1]), ("copy", [2, 2, 2])):
        file.node(name=name, mesh=mesh, scale=scale)
    scene = load(file)
    kinds = {name: shape["type"] for name, shape in scene.shapes.items()}
    assert kinds == {
        "mesh 0": "mesh", "plain": "instance", "stretched": "mesh", "mirrored": "instance", "copy": "instance",
    }  # fmt: skip
    assert placed(scene, "stretched")[2].tolist() == [1, 3, 0]


def test_flattened_nodes_are_noted() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh(), scale=[1, 0, 1])
    scene = load(file)
    assert not scene.shapes
    assert "transform flattens" in scene.model_notes[0]


def test_names_are_kept_and_made_unique() -> None:
    file = GltfFile()
    file.node(name="Stuhl\n№ 1", mesh=file.mesh())
    file.node(name="Stuhl\n№ 1", mesh=file.mesh())
    assert list(load(file).shapes) == ["Stuhl_№ 1", "Stuhl_№ 1.2"]


def test_camera_and_film() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh())
    file.add("cameras", {"name": "wide", "type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 1.5}})
    file.add("cameras", {"name": "flat", "type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2}})
    quarter = [math.sin(-math.pi / 4), 0, 0, math.cos(math.pi / 4)]
    file.node(camera=0, translation=[1, 2, 3], rotation=quarter)
    file.node(camera=1, translation=[0, 0, 7])
    scene = load(file)
    assert (scene.film["width"], scene.film["height"]) == (768, 512)
    assert scene.camera["fov"] == pytest.approx(1.0, abs=1e-12)
    assert scene.camera["position"] == (1, 2, 3)
    assert scene.camera["look_at"] == pytest.approx((1, 1, 3))  # -z turned to -y
    assert scene.camera["up"] == pytest.approx((0, 0, -1))


def test_default_camera_sees_all_of_the_model() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh(POSITION=SQUARE * 50 + np.float32(20)))
    size = {"film.width": 64, "film.height": 64, "film.hide_environment": True}
    scene = accuray.load(file.save(Path("a.glb")), overrides=size)
    assert scene.lights["daylight"]["type"] == "constant"
    seen = np.asarray(accuray.render(scene, spp=4)).max(axis=2) > 0
    assert not seen[[0, -1]].any()
    assert not seen[:, [0, -1]].any()
    assert seen[32, 32]
    assert 0.2 < seen.mean() < 0.7


def test_scene_of_the_file_by_number_and_name() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh(), name="first")
    file.node(root=False, mesh=file.mesh(), name="second")
    file.data["scenes"].append({"name": "other", "nodes": [1]})
    assert list(load(file).shapes) == ["first"]
    file.data["scene"] = 1
    assert list(load(file).shapes) == ["second"]
    for wanted, expected in (("0", "m/first"), ("other", "m/second")):
        scene = accuray.Scene.from_dict({"models": {"m": {"file": "a.glb", "scene": wanted}}})
        assert list(scene.shapes) == [expected]
    with pytest.raises(accuray.SceneError, match=r'models\.m\.scene: "no" is not a known scene'):
        accuray.Scene.from_dict({"models": {"m": {"file": "a.glb", "scene": "no"}}})


def test_illuminance_of_a_point_light() -> None:
    """I cd at the distance d give a white matte square the luminance I / (pi d^2)."""
    file = GltfFile()
    # At a thin wall of index 1 nothing is reflected: white, without gloss.
    white = {"metallicFactor": 0, "roughnessFactor": 1}
    gone = {"KHR_materials_specular": {"specularFactor": 0}}
    file.node(
        mesh=file.mesh(file.material(pbrMetallicRoughness=white, extensions=gone), POSITION=SQUARE - np.float32(0.5))
    )
    file.data["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 90}]}}
    file.node(translation=[0, 0, 2.5], extensions={"KHR_lights_punctual": {"light": 0}})
    path = file.save(Path("a.glb"))
    expected = 90 / (math.pi * 9)  # the square lies at z = -0.5
    for white_luminance, scale in (("1 cd/m^2", 1.0), ("10 cd/m^2", 0.1), ("72983 cd/m^2", 1 / 72983)):
        scene = accuray.Scene.from_dict(
            {"models": {"m": {"file": str(path), "white_luminance": white_luminance}}, "camera": {"type": "panorama"}}
        )
        seen = accuray.radiance(scene, [[0, 0, 2.0]], [[0, 0, -1]], spp=4096, space="xyz").mean[0, 1]
        assert seen == pytest.approx(expected * scale, rel=3e-3)


def test_lights_that_the_renderer_lacks_are_noted_and_can_be_left_out() -> None:
    every_feature().save(Path("a.glb"))
    scene = accuray.load("a.glb")
    kinds = {light["type"] for light in scene.lights.values()}
    missing = any("no light of the type spot" in note for note in scene.model_notes)
    assert ("spot" in kinds) != missing
    dark = accuray.Scene.from_dict({"models": {"m": {"file": "a.glb", "lights": False}}})
    assert not dark.lights


def test_spot_and_directional_light_tables() -> None:
    from accuray.formats.gltf.item import Item
    from accuray.formats.gltf.views import light_table
    from accuray.scene.errors import Document, Source, Where

    def table(light: dict[str, Any]) -> dict[str, Any]:
        return light_table(Item(light, Where(Document({}, Source()))), np.eye(4), 2.0)

    spot = table({"type": "spot", "intensity": 6, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.6}})
    assert spot["intensity"] == {"rgb": [1, 1, 1], "scale": 3}
    assert spot["direction"] == [0, 0, -1]
    assert (spot["inner_angle"], spot["outer_angle"]) == pytest.approx((math.degrees(0.2), math.degrees(0.6)))
    sun = table({"type": "directional", "color": [1, 0.5, 0], "intensity": 4})
    assert sun["irradiance"] == {"rgb": [1, 0.5, 0], "scale": 2}


def test_nothing_is_read_twice_or_lost_in_a_file_of_every_feature() -> None:
    path = every_feature().save(Path("a.glb"))
    scene = accuray.load(path, overrides={"film.width": 24, "film.height": 16})
    assert sorted(scene.shapes) == ["drop", "far", "leaf", "near", "panel"]
    assert len(scene.shapes["panel"]["faces"]) == len(TWO_TRIANGLES) // 3
    assert np.asarray(accuray.render(scene, spp=4)).max() > 0
