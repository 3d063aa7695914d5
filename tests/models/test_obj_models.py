"""OBJ with MTL: what materials become, where their files may lie, and files that are wrong."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from model_files import png

import accuray
from accuray.formats.models.mtl import parse
from accuray.scene.textures import TextureUse

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
FACE = "f 1/1 2/2 3/3 4/4\n"


def obj(mtl: str, faces: str = f"usemtl m\n{FACE}") -> accuray.Scene:
    """The scene of a square whose MTL file says this."""
    Path("a.mtl").write_text(mtl)
    Path("a.obj").write_text(f"mtllib a.mtl\n{SQUARE}{faces}")
    return accuray.load("a.obj")


def material(mtl: str) -> tuple[dict[str, Any], accuray.Scene]:
    """The material m."""
    scene = obj("newmtl m\n" + mtl)
    return scene.materials["m"], scene


def picture(name: str = "a.png", value: int = 128, channels: int = 3) -> None:
    Path(name).write_bytes(png(np.full((2, 2, channels), value, np.uint8)))


def test_one_shape_for_each_material() -> None:
    faces = f"{FACE}usemtl red\n{FACE}usemtl blue paint\n{FACE}usemtl red\nf 1 2 3\n"
    scene = obj("newmtl red\nKd 1 0 0\nnewmtl blue paint\nKd 0 0 1\nnewmtl unused\n", faces)
    found = {name: (shape["material"], len(shape["faces"])) for name, shape in scene.shapes.items()}
    assert found == {"a": ("surface", 2), "red": ("red", 3), "blue paint": ("blue paint", 2)}
    assert scene.materials["red"]["base_color"].rgb == (1, 0, 0)
    assert "unused" not in scene.materials
    assert len(scene.shapes["blue paint"]["positions"]) == 4


def test_materials_that_are_nowhere_are_noted() -> None:
    scene = obj("newmtl other\n")
    assert scene.shapes["m"]["material"] == "surface"
    assert any("material m: is in none of the files" in note for note in scene.model_notes)
    Path("a.obj").write_text(f"mtllib gone.mtl\n{SQUARE}usemtl m\n{FACE}")
    assert any("mtllib gone.mtl: does not exist" in note for note in accuray.load("a.obj").model_notes)


def test_matte_and_glossy() -> None:
    matte, _ = material("Kd 0.2 0.4 0.6\nKs 1 1 1\nillum 1\n")
    assert (matte["type"], matte["specular_weight"]) == ("openpbr", 0)
    assert matte["base_color"].rgb == (0.2, 0.4, 0.6)
    glossy, _ = material("Kd 0.5\nKs 0.5 0.5 0.5\nNs 98\nNi 1.6\nillum 2\n")
    assert glossy["specular_roughness"] ** 2 == pytest.approx((2 / 100) ** 0.5)
    assert glossy["specular_ior"] == 1.6


def test_glass_mirror_and_transparency() -> None:
    glass, _ = material("Kd 0 0 0\nd 0.1\nNi 1.45\nNs 1000\nillum 7\n")
    assert (glass["type"], glass["ior"].value, glass["opacity"]) == ("dielectric", 1.45, 1)
    mirror, _ = material("Ks 0.9 0.8 0.7\nNs 1000\nillum 3\n")
    assert (mirror["type"], mirror["reflectance"].rgb, mirror["roughness"]) == ("conductor", (0.9, 0.8, 0.7), 0)
    assert material("d 0.25\n")[0]["opacity"] == material("Tr 0.75\n")[0]["opacity"] == 0.25


def test_physically_based_statements() -> None:
    m, _ = material("Pr 0.4\nPm 0.9\nPc 0.5\nPcr 0.1\nPs 0.3\naniso 0.2\nKe 0.5 1 1\n")
    assert (m["specular_roughness"], m["base_metalness"]) == (0.4, 0.9)
    assert (m["coat_weight"], m["coat_roughness"], m["fuzz_weight"]) == (0.5, 0.1, 0.3)
    assert m["specular_roughness_anisotropy"] == 0.2
    assert m["emission"].rgb == (0.5, 1, 1)


def test_maps() -> None:
    picture()
    picture("b c.png", channels=1)
    m, scene = material(
        "Kd 0.5 0.5 0.5\nPr 1\nmap_Kd -s 2 3 1 -o 0.5 0 0 -clamp on a.png\nmap_Pr -imfchan g a.png\n"
        "map_d b c.png\nnorm a.png\nmap_Bump -bm 0.3 b c.png\nmap_Ke a.png\n"
    )
    color = scene.textures[m["base_color"].texture]
    assert m["base_color"].scale == 0.5
    assert (color["uv_scale"], color["uv_translate"], color["wrap_u"]) == ((2, 3), (0.5, 0), "clamp")
    assert color["color_space"] == "srgb"
    assert m["specular_roughness"].channel == "green"
    assert scene.textures[m["opacity"].texture]["color_space"] == "data"
    assert m["normal_map"].texture != m["base_color"].texture
    assert m["bump_map"] == TextureUse(m["opacity"].texture, 0.3, "map")
    assert any("Ke of the material m was left out" in note for note in scene.model_notes)


def test_textures_show_upright() -> None:
    pixels = np.zeros((2, 1, 3), np.uint8)
    pixels[0] = 255  # white above black
    Path("a.png").write_bytes(png(pixels))
    _, scene = material("map_Kd a.png\nillum 1\n")
    seen = accuray.radiance(scene, [[0.5, 0.75, 1], [0.5, 0.25, 1]], [[0, 0, -1]] * 2, spp=256).mean[:, 1]
    assert seen[0] > 0.7 > 0.3 > seen[1]


def test_what_has_no_meaning_is_noted() -> None:
    picture()
    _, scene = material(
        "Ka 1 1 1\nTf 0.5 1 1\nmap_Ks a.png\nsharpness 60\nKd spectral x.rfl\nfoo 1\nmap_Kd -mm 0 2 a.png\n"
    )
    text = "\n".join(scene.model_notes)
    for word in ("Tf", "map_Ks", "sharpness", "Kd spectral", "foo", "-mm"):
        assert word in text
    assert "Ka of" not in text


def test_missing_coordinates_are_an_error_only_where_a_texture_needs_them() -> None:
    picture()
    assert obj("newmtl m\nKd 1 1 1\n", "usemtl m\nf 1 2 3\n").shapes["m"]["uvs"] is None
    with pytest.raises(accuray.SceneError, match=r"shapes\.m.*has no texture coordinates"):
        obj("newmtl m\nmap_Kd a.png\n", "usemtl m\nf 1 2 3\n")


def test_crease_angle_and_smoothing_groups() -> None:
    bent = SQUARE + "v 2 0 -1\nv 2 1 -1\n"
    faces = "f 1 2 3 4\nf 2 5 6 3\n"
    Path("a.obj").write_text(bent + faces)
    for angle, vertices in ((30, 8), (60, 6)):
        scene = accuray.Scene.from_dict({"models": {"m": {"file": "a.obj", "crease_angle": angle}}})
        mesh = accuray.triangles(scene, "m/a")
        assert len(mesh.positions) == vertices
        assert mesh.normals is not None
    Path("a.obj").write_text(bent + "s 1\n" + faces)
    assert len(accuray.load("a.obj").shapes["a"]["normals"]) == 6


def test_mirrored_and_stretched_normals_stay_normal() -> None:
    """A plane that leans by 45 degrees, stretched: its normals follow the inverse transposed."""
    positions = [[0, 0, 0], [1, 0, -1], [1, 1, -1], [0, 1, 0]]
    table = {
        "type": "mesh", "material": "m", "positions": positions, "faces": [[0, 1, 2, 3]], "shading": "smooth",
    }  # fmt: skip
    for scale in ([1, 1, 3], [1, 1, -3], [-2, 1, 1]):
        shapes = {"a": {**table, "transform": {"scale": scale}}}
        light = {"type": "point", "position": [scale[0] * 0.5, 0.5, 9], "intensity": 100}
        flat = {"a": {**shapes["a"], "shading": "flat"}}
        seen = []
        for kind in (shapes, flat):
            scene = accuray.Scene.from_dict(
                {"materials": {"m": {"type": "diffuse"}}, "shapes": kind, "lights": {"l": light}}
            )
            seen.append(accuray.radiance(scene, [[scale[0] * 0.5, 0.5, 9]], [[0, 0, -1]], spp=64).mean[0, 1])
        assert seen[0] > 0
        assert seen[0] == pytest.approx(seen[1], rel=1e-5)


def test_models_in_other_units_and_places() -> None:
    Path("a.obj").write_text(SQUARE + FACE)
    Path("a.toml").write_text(
        'accuray = 1\nlength_unit = "mm"\n[models.m]\nfile = "a.obj"\n'
        "transform = [{ scale = [2, 1, 1] }, { translate = [500, 0, 0] }]\n"
    )
    shape = accuray.load("a.toml").shapes["m/a"]
    assert shape["positions"].max() == np.float32(0.001)
    assert (shape["transform"] @ [*shape["positions"][2], 1])[:3] == pytest.approx([0.502, 0.001, 0])


@pytest.mark.parametrize("name", ["../out.mtl", "/tmp", "link.mtl", "http://x/a.mtl", "file:a.mtl", "folder"])
def test_libraries_cannot_lie_outside(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "out.mtl").write_text("newmtl m\n")
    inner = tmp_path / "inner"
    (inner / "folder").mkdir(parents=True)
    (inner / "link.mtl").symlink_to(tmp_path / "out.mtl")
    monkeypatch.chdir(inner)
    Path("a.obj").write_text(f"mtllib {name}\n{SQUARE}usemtl m\n{FACE}")
    try:
        notes = accuray.load("a.obj").model_notes
    except accuray.SceneError as error:
        assert "mtllib" in str(error)  # noqa: PT017
    else:
        assert any("does not exist" in note for note in notes)


@pytest.mark.parametrize("name", ["../out.png", "/etc/passwd", "link.png", "http://x/a.png", "gone.png", "..\\out.png"])
def test_pictures_cannot_lie_outside(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    picture(str(tmp_path / "out.png"))
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "link.png").symlink_to(tmp_path / "out.png")
    monkeypatch.chdir(inner)
    with pytest.raises(accuray.SceneError, match=r"a\.mtl:2.*map_Kd"):
        material(f"map_Kd {name}\n")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Kd 1 1 1\n", "a.mtl:1: 'Kd' comes before any material: allowed newmtl NAME"),
        ("newmtl m\nKd 1 1\n", "a.mtl:2: a colour has 2 numbers: allowed 1 or 3 numbers"),
        ("newmtl m\nKd 1 1 x\n", "a.mtl:2: 'x' is not a finite number"),
        ("newmtl m\nKd 1 1 nan\n", "a.mtl:2: 'nan' is not a finite number"),
        ("newmtl m\n\nNs\n", "a.mtl:3: Ns has 0 numbers: allowed one number"),
        ("newmtl m\nillum 2.5\n", "a.mtl:2: illum is not a model of illumination"),
        ("newmtl m\nillum 11\n", "a.mtl:2: illum is not a model of illumination"),
        ("newmtl m\nmap_Kd\n", "a.mtl:2: names no file"),
        ("newmtl m\nmap_Kd -s 1 1 1\n", "a.mtl:2: -s is not followed by its values and a file"),
    ],
)
def test_errors_of_mtl_files(text: str, message: str) -> None:
    with pytest.raises(accuray.SceneError) as caught:
        parse(text, "a.mtl")
    assert message in str(caught.value)


MTL = (
    "# a comment\nnewmtl m\nKd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nKe 0 0 0\nNs 96.5\nNi 1.45\nd 0.9\nillum 2\n"
    "map_Kd -s 2 2 -clamp on a.png\nmap_Bump -bm 0.5 a.png\nPr 0.3\nPm 0.1\nnewmtl n\nTr 0.5\n"
)


def load_or_refuse(mtl: bytes) -> bool:
    Path("a.mtl").write_bytes(mtl)
    try:
        accuray.load("a.obj")
    except accuray.SceneError:
        return False
    return True


def test_mutated_mtl_files() -> None:
    picture()
    Path("a.obj").write_text(f"mtllib a.mtl\n{SQUARE}usemtl m\n{FACE}usemtl n\n{FACE}")
    random_ = random.Random(9)
    tokens = [b"nan", b"-1", b"1e999", b"\n", b" ", b"newmtl m", b"map_Kd ", b"-s ", b"\xff", b"\0", b"illum 7\n", b"#"]
    good = 0
    for _ in range(250):
        changed = bytearray(MTL.encode())
        for _ in range(random_.randint(1, 4)):
            at, size = random_.randrange(len(changed)), random_.randrange(1, 9)
            if random_.random() < 0.5:
                changed[at : at + size] = random_.choice(tokens)
            else:
                changed[at] = random_.randrange(256)
        good += load_or_refuse(bytes(changed))
    assert 30 < good < 220


def test_every_truncation_and_byte_of_an_mtl_file() -> None:
    picture()
    Path("a.obj").write_text(f"mtllib a.mtl\n{SQUARE}usemtl m\nf 1 2 3\n")
    content = MTL.encode()
    for size in range(0, len(content), 3):
        parse_or_refuse(content[:size])
    for at in range(len(content)):
        parse_or_refuse(content[:at] + bytes([content[at] ^ 16]) + content[at + 1 :])


def parse_or_refuse(content: bytes) -> None:
    try:
        parse(content.decode("utf-8", errors="replace"), "a.mtl")
    except accuray.SceneError as error:
        assert error.line is not None  # noqa: PT017
