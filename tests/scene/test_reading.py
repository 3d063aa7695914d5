"""Scene files: TOML and JSON alike, includes, merging, overrides, mesh files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from accuray.formats import load
from accuray.scene import Scene, SceneError
from accuray.scene.meshes import register_reader


def write(folder: Path, **files: str) -> Path:
    """Write NAME.toml files; returns the folder."""
    for name, text in files.items():
        path = folder / (name.replace("__", "/") + ".toml")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("accuray = 1\n" + text, encoding="utf-8")
    return folder


def test_toml_and_json_and_python_are_the_same_scene(tmp_path: Path) -> None:
    write(tmp_path, s='[film]\nwidth = 8\n[materials.m]\ntype = "diffuse"\nreflectance = [0.1, 0.2, 0.3]\n')
    plain = {
        "accuray": 1,
        "film": {"width": 8},
        "materials": {"m": {"type": "diffuse", "reflectance": [0.1, 0.2, 0.3]}},
    }
    (tmp_path / "s.json").write_text(json.dumps(plain), encoding="utf-8")
    toml, loaded, built = load(tmp_path / "s.toml"), load(tmp_path / "s.json"), Scene.from_dict(plain)
    assert toml.materials == loaded.materials == built.materials
    assert toml.identity == loaded.identity == built.identity
    assert toml.path == tmp_path / "s.toml"


@pytest.mark.parametrize(
    "name", ["", ".", "/", "nowhere/s.toml", "s.toml\0", "x" * 5000 + ".toml", "/dev/zero", "s.txt"]
)
def test_scene_path_that_is_no_scene_file(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.txt").write_text("accuray = 1\n", encoding="utf-8")
    with pytest.raises(SceneError):
        load(name)


def test_byte_order_mark_and_windows_line_ends(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_bytes(b"\xef\xbb\xbfaccuray = 1\r\n[film]\r\nwidth = 9\r\n")
    assert load(tmp_path / "s.toml").film["width"] == 9


def test_including_file_wins_key_by_key(tmp_path: Path) -> None:
    write(
        tmp_path,
        top='include = ["parts/a.toml", "parts/b.toml"]\n[film]\nwidth = 1\n[materials.m]\nemission = 2\n',
        parts__a='[film]\nwidth = 2\nheight = 2\n[materials.m]\ntype = "diffuse"\nreflectance = 0.2\n',
        parts__b='[film]\nheight = 3\n[materials.n]\ntype = "diffuse"\n',
    )
    scene = load(tmp_path / "top.toml")
    assert (scene.film["width"], scene.film["height"]) == (1, 3)
    assert (scene.materials["m"]["reflectance"].value, scene.materials["m"]["emission"].value) == (0.2, 2.0)
    assert list(scene.materials) == ["m", "n"]


def test_another_type_starts_afresh(tmp_path: Path) -> None:
    write(
        tmp_path,
        top='include = ["a.toml"]\n[integrator]\ntype = "direct"\n',
        a='[integrator]\ntype = "path"\nroulette_depth = 9\n',
    )
    assert load(tmp_path / "top.toml").integrator["type"] == "direct"
    assert load(tmp_path / "a.toml", overrides=["integrator.type=direct"]).integrator["type"] == "direct"
    assert load(tmp_path / "a.toml", overrides=["integrator.type=path"]).integrator["roulette_depth"] == 9


def test_values_are_replaced_whole(tmp_path: Path) -> None:
    write(
        tmp_path,
        top='include = ["a.toml"]\n[materials.m]\nreflectance = { rgb = [0.1, 0.2, 0.3] }\n[spectra.s]\nvalue = 1\n',
        a='[materials.m]\ntype = "diffuse"\nreflectance = { value = 0.5 }\n[spectra.s]\nblackbody = 3000\n',
    )
    assert load(tmp_path / "top.toml").materials["m"]["reflectance"].form == "rgb"


def test_each_file_has_its_own_length_unit_and_folder(tmp_path: Path) -> None:
    write(
        tmp_path,
        top='include = ["parts/a.toml"]\nlength_unit = "cm"\n[shapes.s]\nradius = 7\n',
        parts__a='length_unit = "mm"\n[materials.m]\ntype = "diffuse"\nreflectance = { file = "p.csv" }\n'
        '[shapes.s]\ntype = "sphere"\nmaterial = "m"\ncenter = [1, 2, "3 m"]\n',
    )
    (tmp_path / "parts" / "p.csv").write_text("nm,r\n400,0.5\n500,0.5\n", encoding="utf-8")
    scene = load(tmp_path / "top.toml")
    assert scene.shapes["s"]["center"] == (0.001, 0.002, 3.0)
    assert scene.shapes["s"]["radius"] == 0.07


def test_errors_name_the_file_that_wrote_the_value(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write(
        tmp_path,
        top='include = ["parts/a.toml"]\n[shapes.s]\nradius = 7\n',
        parts__a='[materials.m]\ntype = "diffuse"\n[shapes.s]\ntype = "sphere"\nmaterial = "m"\ncenter = "x"\n',
    )
    with pytest.raises(SceneError) as caught:
        load("top.toml")
    assert (caught.value.file, caught.value.line, caught.value.key) == ("parts/a.toml", 7, "shapes.s.center")
    write(
        tmp_path, parts__a='[shapes.s]\ntype = "sphere"\n', top='include = ["parts/a.toml"]\n[shapes.s]\nradius = -7\n'
    )
    with pytest.raises(SceneError) as caught:
        load("top.toml")
    assert (caught.value.file, caught.value.line, caught.value.value) == ("top.toml", 4, -7)


def test_a_file_may_be_included_twice(tmp_path: Path) -> None:
    write(tmp_path, top='include = ["a.toml", "b.toml"]\n', a='include = ["c.toml"]\n', b='include = ["c.toml"]\n',
          c="[film]\nwidth = 5\n")  # fmt: skip
    assert load(tmp_path / "top.toml").film["width"] == 5


@pytest.mark.parametrize(
    ("override", "section", "key", "expected"),
    [
        ("film.width=256", "film", "width", 256),
        (" film.width = 0x10 ", "film", "width", 16),
        ("film.hide_environment=true", "film", "hide_environment", True),
        ("camera.position=[1, '2 cm', 3]", "camera", "position", (1.0, 0.02, 3.0)),
        ('camera.fov="60 deg"', "camera", "fov", 60 * (np.pi / 180)),
        ("camera.fov=60 deg", "camera", "fov", 60 * (np.pi / 180)),
        ("camera.fov_axis=horizontal", "camera", "fov_axis", "horizontal"),
        ("render.spp=3", "render", "spp", 3),
    ],
)
def test_overrides(tmp_path: Path, override: str, section: str, key: str, expected: Any) -> None:
    write(tmp_path, s='[camera]\ntype = "perspective"\n')
    assert getattr(load(tmp_path / "s.toml", overrides=[override]), section)[key] == expected


def test_overrides_reach_into_objects_and_values(tmp_path: Path) -> None:
    write(tmp_path, s='[materials."a.b"]\ntype = "diffuse"\nreflectance = { value = 0.5, scale = 1 }\n')
    scene = load(tmp_path / "s.toml", overrides=['materials."a.b".reflectance.scale=0.5', "film.filter.type=box"])
    assert scene.materials["a.b"]["reflectance"].value == 0.25
    assert scene.filter["type"] == "box"
    scene = load(tmp_path / "s.toml", overrides={'materials."a.b".reflectance': 0.125})
    assert scene.materials["a.b"]["reflectance"].value == 0.125


def test_override_beats_an_included_file(tmp_path: Path) -> None:
    write(tmp_path, top='include = ["a.toml"]\n', a='[materials.m]\ntype = "diffuse"\nreflectance = 0.2\n')
    with pytest.raises(SceneError, match=r"^-D materials.m.reflectance=2: materials.m.reflectance: 2 is out of range"):
        load(tmp_path / "top.toml", overrides=["materials.m.reflectance=2"])


def test_mesh_file_fills_the_arrays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a reader of its own, so that it needs no compiled module."""
    monkeypatch.setattr("accuray.scene.meshes._readers._readers", {})
    positions = np.array([[0, 0, 0], [500, 0, 0], [0, 500, 0]], dtype=np.float32)
    arrays = {"positions": positions, "faces": np.array([[0, 1, 2]], dtype=np.uint32), "normals": None, "uvs": None}
    register_reader(".obj", lambda _path: {**arrays, "report": {"degenerate_triangles": 3}})
    write(tmp_path, s='length_unit = "mm"\n[materials.m]\ntype = "diffuse"\n'
          '[shapes.s]\ntype = "mesh"\nmaterial = "m"\nfile = "a.obj"\n')  # fmt: skip
    (tmp_path / "a.obj").write_text("# any content\n", encoding="utf-8")
    scene = load(tmp_path / "s.toml")
    mesh = scene.shapes["s"]
    assert mesh["file"] == tmp_path / "a.obj"
    assert mesh["positions"].tolist() == [[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]]
    assert scene.mesh_reports == {"s": {"degenerate_triangles": 3}}
    inline = {"type": "mesh", "material": "m", "positions": mesh["positions"], "faces": mesh["faces"]}
    same = Scene.from_dict({"materials": {"m": {"type": "diffuse"}}, "shapes": {"s": inline}})
    assert scene.identity == same.identity, "what a mesh holds counts, not where it came from"


def test_mesh_file_through_the_compiled_reader(tmp_path: Path) -> None:
    write(tmp_path, s='[materials.m]\ntype = "diffuse"\n[shapes.s]\ntype = "mesh"\nmaterial = "m"\nfile = "a.obj"\n')
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", encoding="utf-8")
    mesh = load(tmp_path / "s.toml").shapes["s"]
    assert mesh["positions"].shape == (4, 3)
    assert mesh["faces"].tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (mesh["positions"].dtype, mesh["faces"].dtype, mesh["normals"]) == (np.float32, np.uint32, None)
