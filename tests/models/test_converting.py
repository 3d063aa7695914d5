"""`accuray convert`: the scene that it writes is the model, sample by sample; and models inside of scenes."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from model_files import SQUARE, SQUARE_UVS, GltfFile, every_feature, png

import accuray
from accuray.cli import main
from accuray.formats.toml_writing import write_toml

SMALL = {"film.width": 24, "film.height": 16}


def write_obj() -> Path:
    Path("a picture.png").write_bytes(png(np.arange(48, dtype=np.uint8).reshape(4, 4, 3) * 5))
    Path("a.mtl").write_text('newmtl red "1"\nKd 0.8 0.1 0.1\nKs 0.3 0.3 0.3\nNs 50\nnewmtl b\nmap_Kd a picture.png\n')
    square = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 1 2 3\n"
    faces = 'usemtl red "1"\nf 1/1/1 2/2/1 3/3/1\nusemtl b\nf 1/1 3/3 4/4\n'
    Path("a.obj").write_text("mtllib a.mtl\n" + square + faces)
    return Path("a.obj")


def write_stl() -> Path:
    rows = "".join(f"vertex {x} {y} {z}\n" for x, y, z in SQUARE[:3].tolist())
    Path("a.stl").write_text(f"solid a\nfacet normal 0 0 1\nouter loop\n{rows}endloop\nendfacet\nendsolid a\n")
    return Path("a.stl")


def write_ply() -> Path:
    head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    head += "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    Path("a.ply").write_text(head + "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 10 20 30\n3 0 1 2\n")
    return Path("a.ply")


def write_glb() -> Path:
    return every_feature().save(Path("a.glb"))


def write_gltf() -> Path:
    file = GltfFile()
    Path("wood.png").write_bytes(png(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)))
    texture = file.add("textures", {"source": file.add("images", {"uri": "wood.png"})})
    info = {"index": texture, "extensions": {"KHR_texture_transform": {"rotation": 0.123, "offset": [1 / 3, 0]}}}
    file.square({"pbrMetallicRoughness": {"baseColorTexture": info}}, TEXCOORD_0=SQUARE_UVS)
    file.node(mesh=0, scale=[1, 2.7, 1], rotation=[0.1, 0.2, 0.3, 0.9])
    return file.save(Path("a.gltf"))


@pytest.mark.parametrize("write", [write_glb, write_gltf, write_obj, write_ply, write_stl])
def test_converted_scenes_are_the_models(write: object, tmp_path: Path) -> None:
    path = write()  # type: ignore[operator]
    out = tmp_path / "out"
    out.mkdir()
    notes = accuray.convert(path, out / "scene.toml")
    model = accuray.load(path, overrides=SMALL)
    scene = accuray.load(out / "scene.toml", overrides=SMALL)
    assert scene.identity == model.identity
    assert accuray.render(scene, spp=4).pixels_equal(accuray.render(model, spp=4))
    text = (out / "scene.toml").read_text()
    assert [f"{note}" for note in notes] == list(model.model_notes)
    assert all(f"#   {note}" in text for note in notes)
    assert not list(out.glob("*.part"))


def test_commands(capsys: pytest.CaptureFixture[str]) -> None:
    file = every_feature()
    file.data["extensionsUsed"] = [*file.data.get("extensionsUsed", []), "EXT_unheard_of"]
    file.save(Path("a.glb"))
    assert main(["convert", "a.glb", "b.toml"]) == 0
    said = capsys.readouterr()
    notes = accuray.load("a.glb").model_notes
    assert notes
    assert said.out == "b.toml\n"
    assert said.err.splitlines() == [f"accuray: not translated: {note}" for note in notes]
    assert main(["info", "a.glb"]) == 0
    assert "3 mesh" in capsys.readouterr().out
    assert main(["render", "a.glb", "--spp", "4", "-w", "24", "--height", "16"]) == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == ["a.exr", "a.png"]
    assert all(note in said.err for note in notes)


def test_wrong_names_are_errors() -> None:
    write_stl()
    for model, scene in (("a.stl", "b.json"), ("b.stl", "b.toml"), ("a.toml", "b.toml"), ("a.stl", "")):
        with pytest.raises(accuray.SceneError):
            accuray.convert(model, scene)
    with pytest.raises(OSError, match="no/such"):
        accuray.convert("a.stl", "no/such/folder.toml")


def test_toml_of_odd_texts() -> None:
    import tomllib

    data = {"accuray": 1, "a": {'k"\\ .ü\x7f': {"x": [1e-7, True, "\t\n€\x7f", {"y": -1.5e300}]}}, "b": {"c": 0.1}}
    assert tomllib.loads(write_toml(data, ["a comment"])) == data


def test_models_stand_below_the_scene() -> None:
    """Names get the model's name before them; the scene's own tables win, key by key."""
    file = GltfFile()
    file.square({"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "roughnessFactor": 0.25}})
    file.add("cameras", {"name": "front", "type": "perspective", "perspective": {"yfov": 0.5}})
    file.node(camera=0, translation=[0, 0, 9])
    Path("sub").mkdir()
    file.save(Path("sub/a.glb"))
    description = {
        "models": {
            "left": {"file": "sub/a.glb"},
            "right": {"file": "sub/a.glb", "transform": {"translate": [2, 0, 0]}},
        },
        "materials": {"left/m": {"specular_roughness": 0.75}},
    }
    scene = accuray.Scene.from_dict(description)
    assert sorted(scene.shapes) == ["left/mesh 0", "right/mesh 0"] or sorted(scene.shapes) == [
        "left/node 0",
        "right/node 0",
    ]
    assert [scene.materials[f"{side}/m"]["specular_roughness"] for side in ("left", "right")] == [0.75, 0.25]
    assert scene.camera["position"] == (0, 0, 5), "not the model's unless it is asked for"
    description["models"]["right"]["camera"] = "front"  # type: ignore[index]
    assert accuray.Scene.from_dict(description).camera["position"] == (2, 0, 9)
    assert accuray.Scene.from_dict({**description, "camera": {"type": "panorama"}}).camera["type"] == "panorama"


def test_one_material_for_all_of_a_model() -> None:
    write_glb()
    description = {"models": {"a": {"file": "a.glb", "material": "clay"}}, "materials": {"clay": {"type": "diffuse"}}}
    scene = accuray.Scene.from_dict(description)
    assert {shape["material"] for shape in scene.shapes.values()} == {"clay", None}
    assert not scene.textures
    with pytest.raises(accuray.SceneError, match=r"models\.a\.material"):
        accuray.Scene.from_dict({"models": {"a": {"file": "a.glb", "material": "glay"}}})


def test_models_in_included_files_and_overrides() -> None:
    write_stl()
    Path("part.toml").write_text('accuray = 1\n[models.part]\nfile = "a.stl"\n')
    Path("a.toml").write_text('accuray = 1\ninclude = ["part.toml"]\n[models.part]\ntransform = { scale = 2 }\n')
    shape = accuray.load("a.toml", overrides=["models.part.transform={scale=3}"]).shapes["part/a"]
    assert shape["transform"][0, 0] == 3


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("file = 'a.toml'", "models.m.file"),
        ("file = 'a.stl'\nlight = true", "did you mean"),
        ("", "models.m: lacks `file`"),
        ("file = 'a.stl'\ncrease_angle = 200", "models.m.crease_angle: 200 is out of range"),
        ("file = 'bad.stl'", 'models.m: "bad.stl" cannot be read: bad.stl: the file is too short'),
    ],
)
def test_errors_in_tables_of_models(table: str, message: str) -> None:
    write_stl()
    Path("bad.stl").write_text("x")
    Path("a.toml").write_text(f"accuray = 1\n[models.m]\n{table}\n")
    with pytest.raises(accuray.SceneError) as caught:
        accuray.load("a.toml")
    assert message in str(caught.value)
    assert str(caught.value).startswith("a.toml:")


def test_stl_as_a_mesh_of_a_scene() -> None:
    write_stl()
    shapes = {"a": {"type": "mesh", "file": "a.stl", "material": "m", "crease_angle": 20}}
    scene = accuray.Scene.from_dict({"materials": {"m": {"type": "diffuse"}}, "shapes": shapes})
    mesh = accuray.triangles(scene, "a")
    assert np.array_equal(mesh.positions, SQUARE[:3])
    assert mesh.normals is not None
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3


@pytest.mark.parametrize("kind", ["sphere", "disk", "instance"])
def test_what_cannot_be_stretched_is_an_error(kind: str) -> None:
    table = {"type": kind, "material": "m", "transform": [{"scale": [1, 2, 1]}]}
    if kind == "instance":
        table["of"] = "p"
    prototype = {"type": "cube", "material": "m", "prototype": True}
    description = {"materials": {"m": {"type": "diffuse"}}, "shapes": {"x": table, "p": prototype}}
    with pytest.raises(
        accuray.SceneError, match=rf"shapes\.x\.transform: shears or stretches a shape of the type {kind}"
    ):
        accuray.Scene.from_dict(description)


def test_stl_that_claims_billions_of_triangles() -> None:
    Path("a.stl").write_bytes(bytes(80) + b"\xff\xff\xff\xff" + bytes(116))
    start = time.process_time()
    with pytest.raises(accuray.SceneError, match="number of triangles '4294967295' is not that of the file's size"):
        accuray.load("a.stl")
    assert time.process_time() - start < 0.1
