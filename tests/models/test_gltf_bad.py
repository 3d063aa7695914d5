"""glTF and GLB files that are wrong or hostile: an error with file and place, soon, and never anything else."""

from __future__ import annotations

import copy
import json
import random
import struct
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from model_files import SQUARE_UVS, GltfFile, every_feature, png

import accuray

MUTANTS = 150


def square() -> GltfFile:
    file = GltfFile()
    file.node(mesh=file.mesh(file.material(name="m")))
    return file


def change(*path: Any) -> Callable[[Any, dict[str, Any]], None]:
    """Sets the value (the last of ``path``) at a key path of the file."""

    def apply(_: Any, data: dict[str, Any]) -> None:
        node: Any = data
        for key in path[:-2]:
            node = node.setdefault(key, {}) if isinstance(node, dict) else node[key]
        node[path[-2]] = path[-1]

    return apply


BAD = {
    "version": (change("asset", "version", "1.0"), r"asset\.version: \"1\.0\" is not a version"),
    "no-asset": (lambda _, data: data.pop("asset"), r"asset\.version"),
    "asset-list": (change("asset", []), r"asset: \[\] is not an object"),
    "count-lie": (change("accessors", 0, "count", 2**32 - 2), r"accessors\[0\].*needs \d+ bytes of its bufferView"),
    "count-huge": (change("accessors", 0, "count", 2**64), r"accessors\[0\]\.count: \d+ is not such a whole number"),
    "count-zero": (change("accessors", 0, "count", 0), r"accessors\[0\]\.count"),
    "count-fraction": (change("accessors", 0, "count", 1.5), r"accessors\[0\]\.count"),
    "count-text": (change("accessors", 0, "count", "4"), r"accessors\[0\]\.count"),
    "offset-negative": (change("accessors", 0, "byteOffset", -4), r"accessors\[0\]\.byteOffset"),
    "offset-far": (change("accessors", 0, "byteOffset", 2**40), r"accessors\[0\].*bufferView"),
    "stride-small": (change("bufferViews", 0, "byteStride", 8), r"elements of 12 bytes, 8 bytes apart"),
    "component": (change("accessors", 0, "componentType", 5124), r"componentType: 5124 is not a type of components"),
    "type": (change("accessors", 0, "type", "MAT4"), r"type: \"MAT4\" is not right for POSITION"),
    "type-list": (change("accessors", 0, "type", ["VEC3"]), r"accessors\[0\]\.type"),
    "view-length": (change("bufferViews", 0, "byteLength", 2**33), r"bufferViews\[0\].*ends at byte"),
    "view-offset": (change("bufferViews", 0, "byteOffset", 10**9), r"bufferViews\[0\].*ends at byte"),
    "view-buffer": (change("bufferViews", 0, "buffer", 3), r"bufferViews\[0\]\.buffer: 3"),
    "no-view": (change("accessors", 0, "bufferView", 99), r"accessors\[0\]\.bufferView: 99"),
    "index-range": (change("accessors", 0, "count", 3), r"names the vertex 3"),
    "index-type": (change("accessors", 1, "componentType", 5122), r"is no type of indices"),
    "zeros": (lambda _, data: data["accessors"][0].update(count=2**31) or data["accessors"][0].pop("bufferView"),
              "too many elements without data"),
    "sparse-index": (change("accessors", 0, "sparse", {"count": 4, "indices": {"bufferView": 1, "componentType": 5125},
                     "values": {"bufferView": 0}}), r"accessors\[0\]\.sparse\.indices"),
    "sparse-count": (change("accessors", 0, "sparse", {"count": 2**31}), r"accessors\[0\]\.sparse\.count"),
    "mesh": (change("nodes", 0, "mesh", 7), r"nodes\[0\]\.mesh: 7 is not such a whole number: allowed 0 to 0"),
    "mesh-bool": (change("nodes", 0, "mesh", True), r"nodes\[0\]\.mesh: true"),
    "mesh-list": (change("nodes", 0, "mesh", [0]), r"nodes\[0\]\.mesh"),
    "child": (change("nodes", 0, "children", [5]), r"nodes\[0\]\.children\[0\]: 5 is not a node"),
    "children": (change("nodes", 0, "children", 5), r"nodes\[0\]\.children: 5 is not a list"),
    "own-child": (change("nodes", 0, "children", [0]), r"nodes\[0\]: is its own ancestor or has two parents"),
    "root-twice": (change("scenes", 0, "nodes", [0, 0]), r"nodes\[0\]: is its own ancestor or has two parents"),
    "matrix": (change("nodes", 0, "matrix", [1] * 15), r"nodes\[0\]\.matrix: .* has 15 numbers"),
    "matrix-row": (change("nodes", 0, "matrix", [1] * 16), r"has another last row"),
    "rotation": (change("nodes", 0, "rotation", [0, 0, 0, 0]), r"is no rotation"),
    "scale-huge": (change("nodes", 0, "scale", [1e301, 1, 1]), r"nodes\[0\]\.scale\[0\].*not a finite number"),
    "mode": (change("meshes", 0, "primitives", 0, "mode", 9), r"primitives\[0\]\.mode: 9"),
    "material": (change("meshes", 0, "primitives", 0, "material", 4), r"primitives\[0\]\.material: 4"),
    "uv-count": (change("meshes", 0, "primitives", 0, "attributes", "NORMAL", 1), r"is not right for NORMAL"),
    "factor": (change("materials", 0, "pbrMetallicRoughness", {"baseColorFactor": [1, 1, 1]}), r"has 3 numbers"),
    "texture": (change("materials", 0, "normalTexture", {"index": 0}), r"normalTexture\.index: 0 refers to nothing"),
    "alpha-mode": (change("materials", 0, "alphaMode", "GLOW"), r"alphaMode: \"GLOW\" is no such mode"),
    "scene": (change("scene", 3), r"scene: 3"),
    "light": (change("nodes", 0, "extensions", {"KHR_lights_punctual": {"light": 0}}), r"light: 0 refers to nothing"),
    "camera": (change("nodes", 0, "camera", 0), r"camera: 0 refers to nothing"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_error_names_the_place(name: str, suffix: str) -> None:
    damage, message = BAD[name]
    file = square()
    damage(file, file.data)
    path = file.save(Path("a" + suffix))
    start = time.process_time()
    with pytest.raises(accuray.SceneError, match=message) as caught:
        accuray.load(path)
    assert str(caught.value).startswith("a" + suffix)
    assert time.process_time() - start < 2
    if suffix == ".gltf" and name not in ("no-asset",):
        assert caught.value.line is not None


def test_long_and_deep_graphs() -> None:
    """A loop over many nodes is found, a chain of many is refused, a long one is not."""
    for count, message in ((500, None), (5000, "nested too deeply")):
        file = square()
        for i in range(count):
            file.node(root=False, children=[i + 2])
        file.node(root=False, mesh=0)
        file.data["nodes"][0]["children"] = [1]
        path = file.save(Path("a.glb"))
        if message is None:
            assert len(accuray.load(path).shapes) == 3
        else:
            with pytest.raises(accuray.SceneError, match=message):
                accuray.load(path)
        file.data["nodes"][-1]["children"] = [0]
        with pytest.raises(accuray.SceneError, match=r"its own ancestor|nested too deeply"):
            accuray.load(file.save(Path("a.glb")))


def test_more_shapes_than_a_model_may_have_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("accuray.formats.gltf.graph.MOST_SHAPES", 1000)
    file = square()
    file.data["meshes"][0]["primitives"] *= 50
    file.data["nodes"] = [{"mesh": 0, "scale": [1, 2, 1]} for _ in range(1 << 12)]
    file.data["scenes"] = [{"nodes": list(range(1 << 12))}]
    with pytest.raises(accuray.SceneError, match="makes more than 1000 shapes"):
        accuray.load(file.save(Path("a.glb")))


@pytest.mark.parametrize(
    "uri",
    ["../secret.bin", "/etc/passwd", "%2e%2e/secret.bin", "..%2fsecret.bin", "file:///etc/passwd", "file:secret.bin",
     "FILE:secret.bin", "http://localhost/x.bin", "https://localhost/x.bin", "link.bin", "folder/../../secret.bin",
     "a\\..\\..\\secret.bin", "~/secret.bin", "builtin:newell_teapot.json", "%00", "", "folder", "absent.bin", "data:x",
     "data:;base64,@@@", "fifo"],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["buffer", "image"])
def test_uris_cannot_leave_the_folder(uri: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import os

    inner = tmp_path / "inner"
    (inner / "folder").mkdir(parents=True)
    (tmp_path / "secret.bin").write_bytes(png(np.zeros((2, 2, 3), np.uint8)) + bytes(100))
    (inner / "link.bin").symlink_to(tmp_path / "secret.bin")
    os.mkfifo(inner / "fifo")
    monkeypatch.chdir(inner)
    file = GltfFile()
    if kind == "image":
        texture = file.add("textures", {"source": file.add("images", {"uri": uri})})
        file.square({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}, TEXCOORD_0=SQUARE_UVS)
        Path("a.gltf").write_text(file.text())
    else:
        file.node(mesh=file.mesh())
        Path("a.gltf").write_text(
            file.text().replace(json.loads(file.text())["buffers"][0]["uri"], uri.replace("\\", "\\\\"))
        )
    with pytest.raises(accuray.SceneError, match=r"uri|buffers|images|textures"):
        accuray.load("a.gltf")


def test_scenes_cannot_name_models_outside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    square().save(tmp_path / "a.glb")
    (tmp_path / "inner").mkdir()
    monkeypatch.chdir(tmp_path / "inner")
    for name in ("../a.glb", str(tmp_path / "a.glb"), "file://a.glb"):
        with pytest.raises(accuray.SceneError, match=r"models\.m\.file"):
            accuray.Scene.from_dict({"models": {"m": {"file": name}}})


@pytest.mark.parametrize(
    ("change_bytes", "message"),
    [
        (lambda b: b[:11], "the file has 11 bytes"),
        (lambda b: b[:4] + struct.pack("<I", 1) + b[8:], "version 1 of the container"),
        (lambda b: b[:8] + struct.pack("<I", len(b) + 1) + b[12:], "is more than the"),
        (lambda b: b[:12] + struct.pack("<I", 2**32 - 1) + b[16:], "goes beyond the file"),
        (lambda b: b[:16] + b"NOPE" + b[20:], "the first chunk is not JSON"),
        (lambda b: b[:20] + b"\xff" + b[21:], "is not UTF-8"),
        (lambda b: b"gltf" + b[4:], "JSON"),
    ],
)
def test_containers(change_bytes: Callable[[bytes], bytes], message: str) -> None:
    Path("a.glb").write_bytes(change_bytes(square().glb()))
    with pytest.raises(accuray.SceneError, match=message):
        accuray.load("a.glb")


def test_small_files_with_large_claims() -> None:
    """200 bytes that claim 2^32 vertices, or as many bytes."""
    accuray.load(square().save(Path("good.gltf")))
    for accessor in ({"bufferView": 0, "count": 2**32 - 2}, {"count": 2**32 - 2}):
        data = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": 2**32, "uri": "data:;base64,AAAA"}],
            "bufferViews": [{"buffer": 0, "byteLength": 2**32}],
            "accessors": [{"type": "VEC3", "componentType": 5126, **accessor}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "nodes": [{"mesh": 0}],
        }
        Path("a.gltf").write_text(json.dumps(data))
        start = time.process_time()
        with pytest.raises(accuray.SceneError):
            accuray.load("a.gltf")
        assert time.process_time() - start < 0.1


def load_or_refuse(content: bytes, name: str) -> bool:
    """Loads a file; False if it is refused with a fair message. Anything else is a failure of the test."""
    Path(name).write_bytes(content)
    try:
        accuray.load(name)
    except accuray.SceneError as error:
        if len(str(error)) >= 2000:
            raise AssertionError("the message is too long") from error
        return False
    return True


def mutated_json(data: dict[str, Any], random_: random.Random) -> dict[str, Any]:
    """The document with one to three of its values replaced, removed or repeated."""
    values = [None, True, -1, 0, 1, 2, 3.5, 1e308, 2**31, 2**63, "", "VEC2", [], [0], {}, [[[]]], "data:;base64,AAAA"]
    data = copy.deepcopy(data)
    for _ in range(random_.randint(1, 3)):
        node: Any = data
        while isinstance(node, (dict, list)) and node:
            key = random_.choice(list(node) if isinstance(node, dict) else range(len(node)))
            if not isinstance(node[key], (dict, list)) or not node[key] or random_.random() < 0.15:
                action = random_.random()
                if action < 0.15:
                    node.pop(key)
                elif action < 0.25 and isinstance(node, list):
                    node.insert(key, copy.deepcopy(node[key]))
                else:
                    node[key] = random_.choice(values)
                break
            node = node[key]
    return data


def test_mutated_documents() -> None:
    file = every_feature()
    original = json.loads(file.text())
    random_ = random.Random(7)
    good = sum(
        load_or_refuse(json.dumps(mutated_json(original, random_)).encode(), "a.gltf") for _ in range(2 * MUTANTS)
    )
    assert 10 < good < 2 * MUTANTS - 100


def test_mutated_bytes() -> None:
    content = every_feature().glb()
    random_ = random.Random(8)
    good = 0
    for _ in range(MUTANTS):
        changed = bytearray(content)
        for _ in range(random_.randint(1, 2)):
            at, size = random_.randrange(len(changed)), random_.randrange(1, 9)
            action = random_.choice([0, 0, 0, 1, 2, 3])
            if action == 0:
                changed[at] = random_.randrange(256)
            elif action == 1:
                del changed[at : at + size]
            elif action == 2:
                changed[at:at] = changed[at : at + 4 * size]
            else:
                changed[at : at + size] = random_.choice([b"\xff" * size, b"9" * size, b'"]}', b"\0" * size])
        good += load_or_refuse(bytes(changed), "a.glb")
    assert 0 < good < MUTANTS - 50


def test_every_truncation_and_byte_of_a_small_file() -> None:
    content = square().glb()
    for size in range(0, len(content), 7):
        assert not load_or_refuse(content[:size], "a.glb")
    for at in range(0, len(content), 3):
        load_or_refuse(content[:at] + bytes([content[at] ^ (1 << at % 8)]) + content[at + 1 :], "a.glb")
