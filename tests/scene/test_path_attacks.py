"""Every place of a scene that names a file, against every kind of name that would lead out of its folder or into a
file that is none. The file outside is a good one of its kind, so a name that got there would be read without an error.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from ies_files import ies_text

import accuray
from accuray.formats.image import write

MATERIALS = {"m": {"type": "diffuse"}}
SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"

Scene = dict[str, Any]


def spectrum(name: str) -> Scene:
    return {"materials": {"m": {"type": "diffuse", "reflectance": {"file": name}}}}


def mesh(name: str) -> Scene:
    return {"materials": MATERIALS, "shapes": {"s": {"type": "mesh", "file": name, "material": "m"}}}


def instances(name: str) -> Scene:
    ball = {"type": "sphere", "material": "m", "prototype": True}
    return {
        "materials": MATERIALS,
        "shapes": {"ball": ball, "s": {"type": "instance", "of": "ball", "instances": name}},
    }


#: Place -> (ending of its files, the scene that names one).
PLACES: dict[str, tuple[str, Any]] = {
    "include toml": (".toml", lambda name: {"include": [name]}),
    "include json": (".json", lambda name: {"include": [name]}),
    "mesh obj": (".obj", mesh),
    "mesh ply": (".ply", mesh),
    "mesh stl": (".stl", mesh),
    "model obj": (".obj", lambda name: {"models": {"m": {"file": name}}}),
    "model gltf": (".gltf", lambda name: {"models": {"m": {"file": name}}}),
    "texture": (".png", lambda name: {"textures": {"t": {"type": "image", "file": name}}}),
    "reflectance": (".csv", spectrum),
    "radiance": (".csv", lambda name: {"lights": {"sky": {"type": "constant", "radiance": {"file": name}}}}),
    "environment": (".exr", lambda name: {"lights": {"sky": {"type": "environment", "file": name}}}),
    "instances": (".npy", instances),
    "luminaire": (".ies", lambda name: {"lights": {"lamp": {"type": "ies", "file": name}}}),
}

NAMES = [
    "../secret{s}", "{root}/secret{s}", "inner/../../secret{s}", "link{s}", "up/secret{s}", "%2e%2e/secret{s}",
    "..%2fsecret{s}", "..\\secret{s}", "C:\\secret{s}", "C:/secret{s}", "\\\\?\\secret{s}", "//localhost/secret{s}",
    "~/secret{s}", "~root/secret{s}", "file:../secret{s}", "file:///{root}/secret{s}", "FILE:../secret{s}",
    "http://localhost/secret{s}", "https://localhost/secret{s}", "good{s}\0", "good\0{s}", "\0", "", ".", "..", "/",
    "folder{s}", "pipe{s}", "/dev/zero", "/dev/stdin", "/proc/self/environ", "/etc/passwd", "builtin:../secret{s}",
    "builtin:/etc/passwd", "x" * 300 + "{s}", "x/" * 600 + "x{s}", "missing{s}", "loop{s}", "good{s}/../../secret{s}",
    "$HOME/secret{s}", "${{HOME}}{s}", "good{s}\n", "data:,x",
]  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene's folder with a good file of every kind, and the same files outside under the name secret."""
    monkeypatch.delenv("ACCURAY_PATH", raising=False)
    inner = tmp_path / "scene"
    (inner / "inner").mkdir(parents=True)
    (inner / "up").symlink_to(tmp_path)
    for suffix, content in contents(tmp_path).items():
        (tmp_path / f"secret{suffix}").write_bytes(content)
        (inner / f"good{suffix}").write_bytes(content)
        (inner / f"link{suffix}").symlink_to(tmp_path / f"secret{suffix}")
        (inner / f"loop{suffix}").symlink_to(f"loop{suffix}")
        (inner / f"folder{suffix}").mkdir()
        os.mkfifo(inner / f"pipe{suffix}")
    return inner


def contents(scratch: Path) -> dict[str, bytes]:
    """A good file of every kind."""
    for suffix, kind in ((".png", np.uint8), (".exr", np.float32)):
        write(scratch / f"a{suffix}", np.ones((2, 4, 3), kind))
    face = f"{SQUARE}f 1/1 2/2 3/3\n"
    stl = (
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
    )
    ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    ply += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    text = {
        ".toml": "accuray = 1\n",
        ".json": '{"accuray": 1}',
        ".obj": face,
        ".ply": ply,
        ".stl": stl,
        ".gltf": '{"asset": {"version": "2.0"}}',
        ".csv": "nm,a\n400,0.1\n700,0.2\n",
        ".ies": ies_text([0.0, 90.0], [0.0], lambda a, _: 1.0 + a),
    }
    np.save(scratch / "a.npy", np.eye(4)[None, :3])
    pictures = {suffix: (scratch / f"a{suffix}").read_bytes() for suffix in (".png", ".exr", ".npy")}
    return {suffix: content.encode() for suffix, content in text.items()} | pictures


def load(folder: Path, scene: Scene) -> accuray.Scene:
    (folder / "scene.json").write_text(json.dumps({"accuray": 1, **scene}))
    return accuray.load(folder / "scene.json")


@pytest.mark.parametrize("place", PLACES)
def test_no_name_leads_outside(place: str, folder: Path) -> None:
    suffix, scene = PLACES[place]
    load(folder, scene(f"good{suffix}"))
    load(folder, scene(f"inner/../good{suffix}"))
    for pattern in NAMES:
        name = pattern.format(s=suffix, root=folder.parent)
        with pytest.raises(accuray.SceneError) as caught:
            load(folder, scene(name))
        assert len(str(caught.value)) < 2500, name


@pytest.mark.parametrize("key", ["map_Kd", "map_Ke", "map_d", "map_Pr", "norm", "bump"])
def test_no_picture_of_a_material_lies_outside(key: str, folder: Path) -> None:
    (folder / "a.obj").write_text(f"mtllib a.mtl\n{SQUARE}usemtl m\nf 1/1 2/2 3/3\n")
    (folder / "a.mtl").write_text(f"newmtl m\nKe 1 1 1\n{key} good.png\n")
    accuray.load(folder / "a.obj")
    for pattern in NAMES:
        name = pattern.format(s=".png", root=folder.parent)
        if not name.strip() or name.split() != [name] or name == ".":
            continue  # MTL has no such name: it ends at the line's end
        (folder / "a.mtl").write_text(f"newmtl m\nKe 1 1 1\n{key} {name}\n")
        with pytest.raises(accuray.SceneError, match=r"a\.mtl"):
            accuray.load(folder / "a.obj")


def test_includes_go_round_in_no_circle(folder: Path) -> None:
    """A file that includes itself by another name, three that include each other, and a chain that is too long."""
    (folder / "again.json").symlink_to("self.json")
    (folder / "self.json").write_text('{"accuray": 1, "include": ["again.json"]}')
    for number in range(3):
        (folder / f"round{number}.json").write_text(f'{{"accuray": 1, "include": ["round{(number + 1) % 3}.json"]}}')
    for number in range(40):
        (folder / f"chain{number}.json").write_text(f'{{"accuray": 1, "include": ["chain{number + 1}.json"]}}')
    (folder / "chain40.json").write_text('{"accuray": 1}')
    for name, problem in (("self", "includes itself"), ("round0", "includes itself"), ("chain0", "too deeply")):
        with pytest.raises(accuray.SceneError, match=problem):
            accuray.load(folder / f"{name}.json")
    accuray.load(folder / "chain20.json")


def test_includes_that_double_are_refused(folder: Path) -> None:
    """Each of 24 files includes the next one twice: 2^24 files to read."""
    for number in range(24):
        names = [f"d{number + 1}.json"] * 2
        (folder / f"d{number}.json").write_text(json.dumps({"accuray": 1, "include": names}))
    (folder / "d24.json").write_text('{"accuray": 1}')
    with pytest.raises(accuray.SceneError, match="one file too many"):
        accuray.load(folder / "d0.json")
