"""glTF materials: what each parameter and extension becomes, and how textures lie on surfaces."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from model_files import SQUARE_UVS, GltfFile

import accuray
from accuray.scene.spectrum import Spectrum
from accuray.scene.textures import TextureUse

PLAIN = {"metallicFactor": 0, "roughnessFactor": 1}
NO_GLOSS = {"KHR_materials_specular": {"specularFactor": 0}}


def loaded(material: dict[str, Any], **attributes: Any) -> tuple[dict[str, Any], accuray.Scene]:
    """The material m of a square, and the scene."""
    scene = accuray.load(GltfFile().square(material, **attributes).save(Path("a.glb")))
    return scene.materials["m"], scene


def rgb(spectrum: Any) -> tuple[float, ...]:
    assert isinstance(spectrum, Spectrum)
    return spectrum.rgb if spectrum.form == "rgb" else (spectrum.value,) * 3


def test_default_material_is_rough_white_metal() -> None:
    file = GltfFile()
    file.node(mesh=file.mesh())
    m = accuray.load(file.save(Path("a.glb"))).materials["default"]
    assert (m["type"], m["base_metalness"], m["specular_roughness"]) == ("openpbr", 1, 1)
    assert rgb(m["base_color"]) == (1, 1, 1)


def test_factors() -> None:
    pbr = {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0.25, "roughnessFactor": 0.5}
    m, _ = loaded({"pbrMetallicRoughness": pbr})
    assert rgb(m["base_color"]) == (0.1, 0.2, 0.3)
    assert (m["base_metalness"], m["specular_roughness"], m["specular_ior"]) == (0.25, 0.5, 1.5)


def test_transmission_volume_ior_and_dispersion() -> None:
    m, _ = loaded(
        {
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
            "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 0.75},
                "KHR_materials_volume": {
                    "thicknessFactor": 2,
                    "attenuationDistance": 0.5,
                    "attenuationColor": [0.9, 0.5, 0.1],
                },
                "KHR_materials_ior": {"ior": 1.7},
                "KHR_materials_dispersion": {"dispersion": 0.4},
            },
        }
    )
    assert (m["transmission_weight"], m["specular_ior"], m["transmission_depth"]) == (0.75, 1.7, 0.5)
    assert rgb(m["transmission_color"]) == (0.9, 0.5, 0.1)
    assert m["transmission_dispersion_abbe_number"] / m["transmission_dispersion_scale"] == pytest.approx(50)
    assert not m["geometry_thin_walled"]


@pytest.mark.parametrize("dispersion", [0.1, 0.22, 1.0, 2.2, 5.0])
def test_dispersion_of_any_strength(dispersion: float) -> None:
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1},
        "KHR_materials_dispersion": {"dispersion": dispersion},
    }
    m, _ = loaded({"pbrMetallicRoughness": PLAIN, "extensions": extensions})
    strongest = 20 / 9
    given = m["transmission_dispersion_scale"] * 20 / m["transmission_dispersion_abbe_number"]
    assert given == pytest.approx(min(dispersion, strongest))


def test_transmission_without_a_volume_is_a_thin_wall() -> None:
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    m, scene = loaded({"pbrMetallicRoughness": {**PLAIN, "baseColorFactor": [1, 0, 0, 1]}, "extensions": extensions})
    assert m["geometry_thin_walled"]
    assert rgb(m["transmission_color"]) == (1, 0, 0)
    assert not scene.model_notes


def test_the_base_colour_tints_beside_an_attenuation_no_more() -> None:
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2},
    }
    _, scene = loaded({"pbrMetallicRoughness": {**PLAIN, "baseColorFactor": [1, 0, 0, 1]}, "extensions": extensions})
    assert any("attenuationColor does" in note for note in scene.model_notes)


def test_clearcoat_sheen_specular_and_iridescence() -> None:
    m, scene = loaded(
        {
            "pbrMetallicRoughness": PLAIN,
            "extensions": {
                "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.1},
                "KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.4, 0.1], "sheenRoughnessFactor": 0.7},
                "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0]},
                "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.8},
            },
        }
    )
    assert (m["coat_weight"], m["coat_roughness"], m["coat_ior"]) == (0.5, 0.1, 1.5)
    assert (m["fuzz_weight"], m["fuzz_roughness"]) == (0.4, 0.7)
    assert rgb(m["fuzz_color"]) == (0.5, 1, 0.25)
    assert m["specular_weight"] == 0.5
    assert (m["thin_film_weight"], m["thin_film_ior"]) == (1, 1.8)
    assert m["thin_film_thickness"] == pytest.approx(400e-9)
    assert any("specularColorFactor was left out" in note for note in scene.model_notes)


def test_anisotropy_has_the_widths_of_the_extension() -> None:
    extensions = {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": 1}}
    m, scene = loaded({"pbrMetallicRoughness": {"roughnessFactor": 0.5}, "extensions": extensions})
    across = 0.5**2
    along = across + (1 - across) * 0.8**2
    r, a = m["specular_roughness"], m["specular_roughness_anisotropy"]
    our_along = r * r * math.sqrt(2 / (1 + (1 - a) ** 2))
    assert (our_along, our_along * (1 - a)) == pytest.approx((along, across))
    assert any("anisotropyRotation" in note for note in scene.model_notes)


def test_emission_is_luminance() -> None:
    strong = {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}
    _, scene = loaded({"pbrMetallicRoughness": PLAIN, "emissiveFactor": [1, 1, 1], "extensions": strong})
    assert not scene.lights, "what emits needs no other light"
    seen = accuray.radiance(scene, [[0.5, 0.5, 1]], [[0, 0, -1]], spp=4096, space="xyz").mean[0, 1]
    assert seen == pytest.approx(5, rel=5e-3)
    m, _ = loaded({"emissiveFactor": [1, 1, 1], "doubleSided": True})
    assert m["emission_sides"] == "both"


@pytest.mark.parametrize(
    ("material", "opacity"),
    [
        ({"alphaMode": "OPAQUE"}, 1.0),
        ({"alphaMode": "BLEND"}, 0.25),
        ({"alphaMode": "MASK"}, 0.0),
        ({"alphaMode": "MASK", "alphaCutoff": 0.2}, 1.0),
    ],
)
def test_alpha_modes_without_a_texture(material: dict[str, Any], opacity: float) -> None:
    m, _ = loaded({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}, **material})
    assert m["opacity"] == opacity


def test_double_sided_gloss_has_a_back() -> None:
    m, scene = loaded({"pbrMetallicRoughness": PLAIN, "doubleSided": True})
    assert (m["type"], m["front"], m["back"]) == ("two_sided", "m, one side", "m, one side")
    assert scene.materials["m, one side"]["type"] == "openpbr"
    front, back = (
        accuray.radiance(scene, [[0.5, 0.5, z]], [[0.3, 0, -z]], spp=4096, space="xyz").mean[0, 1] for z in (1, -1)
    )
    assert front == pytest.approx(back, rel=1e-2)


def test_layers_beyond_the_limit_are_left_out_and_noted() -> None:
    half = {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_volume": {"thicknessFactor": 1}}
    layers = {
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5},
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.5, 0.5]},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5},
        "KHR_materials_specular": {"specularFactor": 0.5},
    }
    for metal in (0.0, 0.5):
        pbr = {"metallicFactor": metal, "roughnessFactor": 0.3}
        _, scene = loaded({"pbrMetallicRoughness": pbr, "extensions": half | layers, "doubleSided": True})
        accuray.render(accuray.load("a.glb", overrides={"film.width": 4, "film.height": 4}), spp=4)
        assert any("too many layers" in note or "iridescence was left out" in note for note in scene.model_notes)


QUADRANTS = np.array([[[255, 0, 0, 255], [0, 255, 0, 128]], [[0, 0, 255, 64], [255, 255, 255, 0]]], dtype=np.uint8)
"""Red, green above blue, white; and alphas."""


def looked_up(scene: accuray.Scene, points: list[tuple[float, float]]) -> np.ndarray[Any, Any]:
    """Colours of a square seen from the front, lit evenly: what it reflects."""
    origins = [[x, y, 1.0] for x, y in points]
    return accuray.radiance(scene, origins, [[0, 0, -1]] * len(points), spp=2048).mean


def textured(sampler: dict[str, Any] | None = None, uvs: Any = SQUARE_UVS, **info: Any) -> accuray.Scene:
    file = GltfFile()
    picture = file.picture(QUADRANTS, magFilter=9728, **(sampler or {}))
    pbr = {**PLAIN, "baseColorTexture": {"index": picture, **info}}
    file.square({"pbrMetallicRoughness": pbr, "extensions": NO_GLOSS}, TEXCOORD_0=uvs)
    return accuray.load(file.save(Path("a.glb")))


RED, GREEN, BLUE, WHITE = (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)
CORNERS = [(0.25, 0.75), (0.75, 0.75), (0.25, 0.25), (0.75, 0.25)]


def expect_colors(seen: Any, expected: list[tuple[int, ...]]) -> None:
    """The colours, by their largest components: saturated ones become smooth spectra and are not reached quite."""
    assert [tuple(int(x > 0.5) for x in color) for color in seen] == expected, seen


def test_pictures_stand_upright() -> None:
    expect_colors(looked_up(textured(), CORNERS), [RED, GREEN, BLUE, WHITE])


@pytest.mark.parametrize(
    ("wrap", "expected"),
    [(10497, [RED, GREEN, RED, GREEN]), (33648, [RED, GREEN, GREEN, RED]), (33071, [RED, GREEN, GREEN, GREEN])],
)
def test_wrapping(wrap: int, expected: list[tuple[int, ...]]) -> None:
    scene = textured({"wrapS": wrap}, uvs=SQUARE_UVS * np.array([2, 1], "<f4"))
    expect_colors(looked_up(scene, [(x, 0.75) for x in (0.125, 0.375, 0.625, 0.875)]), expected)


def transformed(u: float, v: float, t: dict[str, Any]) -> tuple[float, float]:
    """KHR_texture_transform in glTF's own coordinates, as viewers apply it."""
    c, s = math.cos(t.get("rotation", 0)), math.sin(t.get("rotation", 0))
    (ox, oy), (sx, sy) = t.get("offset", (0, 0)), t.get("scale", (1, 1))
    return ox + c * sx * u + s * sy * v, oy - s * sx * u + c * sy * v


@pytest.mark.parametrize(
    "transform",
    [{"offset": [0.5, 0]}, {"offset": [0, 0.5]}, {"rotation": math.pi / 2}, {"scale": [2, 1]},
     {"offset": [0.1, 0.3], "rotation": 0.7, "scale": [1.3, 0.8]}],
)  # fmt: skip
def test_texture_transform(transform: dict[str, Any]) -> None:
    scene = textured(extensions={"KHR_texture_transform": transform})
    points = [(0.13 + 0.25 * i, 0.11 + 0.25 * j) for i in range(4) for j in range(4)]
    expected = []
    for x, y in points:
        u, v = transformed(x, 1 - y, transform)
        expected.append(tuple(int(channel > 0) for channel in QUADRANTS[int(v % 1 * 2), int(u % 1 * 2), :3]))
    expect_colors(looked_up(scene, points), expected)


@pytest.mark.parametrize("ior", [1.5, 1.8])
@pytest.mark.parametrize("pictured", [False, True])
def test_gloss_takes_nothing_from_the_base_colour_but_what_it_reflects(ior: float, pictured: bool) -> None:
    """Evenly lit and seen along the normal, a smooth plastic shows F + (1 - F) base colour (glTF 2.0, appendix B)."""
    base = 0.7
    pbr: dict[str, Any] = {"metallicFactor": 0, "roughnessFactor": 0, "baseColorFactor": [base] * 3 + [1]}
    file = GltfFile()
    if pictured:
        pbr["baseColorTexture"] = {"index": file.picture(np.full((2, 2, 3), 188, np.uint8))}
        base *= ((188 / 255 + 0.055) / 1.055) ** 2.4
    extensions = {"KHR_materials_ior": {"ior": ior}}
    file.square({"pbrMetallicRoughness": pbr, "extensions": extensions}, TEXCOORD_0=SQUARE_UVS)
    seen = looked_up(accuray.load(file.save(Path("a.glb"))), [(0.5, 0.5)])[0]
    fresnel = ((ior - 1) / (ior + 1)) ** 2
    assert seen == pytest.approx([fresnel + (1 - fresnel) * base] * 3, abs=0.012)


def test_a_coat_takes_nothing_from_the_base_colour_but_what_it_reflects() -> None:
    extensions = {**NO_GLOSS, "KHR_materials_clearcoat": {"clearcoatFactor": 1}}
    pbr = {**PLAIN, "baseColorFactor": [0.6, 0.6, 0.6, 1]}
    file = GltfFile().square({"pbrMetallicRoughness": pbr, "extensions": extensions})
    seen = looked_up(accuray.load(file.save(Path("a.glb"))), [(0.5, 0.5)])[0]
    assert seen == pytest.approx([0.04 + 0.96 * 0.6] * 3, abs=0.012)


def test_tinted_textures_are_multiplied() -> None:
    file = GltfFile()
    picture = file.picture(np.full((2, 2, 3), 188, np.uint8))  # 0.5 of linear light
    pbr = {**PLAIN, "baseColorFactor": [0.8, 0.4, 0.2, 1], "baseColorTexture": {"index": picture}}
    file.square({"pbrMetallicRoughness": pbr, "extensions": NO_GLOSS}, TEXCOORD_0=SQUARE_UVS)
    scene = accuray.load(file.save(Path("a.glb")))
    (texture,) = scene.textures.values()
    assert texture["pixels"].dtype == np.float16
    assert texture["pixels"][0, 0] == pytest.approx([0.4014, 0.2007, 0.1003], abs=2e-3)
    assert looked_up(scene, [(0.5, 0.5)])[0] == pytest.approx([0.4, 0.2, 0.1], abs=0.03)


def test_metal_and_roughness_read_their_channels() -> None:
    file = GltfFile()
    info = {"index": file.picture(QUADRANTS)}
    pbr = {"metallicRoughnessTexture": info, "roughnessFactor": 0.5}
    scene = accuray.load(file.square({"pbrMetallicRoughness": pbr}, TEXCOORD_0=SQUARE_UVS).save(Path("a.glb")))
    m = scene.materials["m"]
    (name,) = scene.textures
    assert m["base_metalness"] == TextureUse(name, 1.0, "blue")
    assert m["specular_roughness"] == TextureUse(name, 0.5, "green")
    assert scene.textures[name]["color_space"] == "data"


def test_alpha_of_textures() -> None:
    """Blended, the square lets its share of the light from behind pass; cut, it is there or not."""
    for mode, expected in (("BLEND", [1, 128 / 255, 64 / 255, 0]), ("MASK", [1, 1, 0, 0])):
        file = GltfFile()
        pixels = QUADRANTS.copy()
        pixels[..., :3] = 0
        pbr = {**PLAIN, "baseColorTexture": {"index": file.picture(pixels, magFilter=9728)}}
        file.square({"pbrMetallicRoughness": pbr, "extensions": NO_GLOSS, "alphaMode": mode}, TEXCOORD_0=SQUARE_UVS)
        scene = accuray.load(file.save(Path("a.glb")))
        assert 1 - looked_up(scene, CORNERS)[:, 1] == pytest.approx(expected, abs=0.05)


def test_vertex_colours_times_the_factor() -> None:
    colors = np.array([[65535, 0, 0], [65535, 0, 0], [65535, 0, 0], [65535, 0, 0]], "<u2")
    file = GltfFile()
    pbr = {**PLAIN, "baseColorFactor": [0.5, 1, 1, 1]}
    file.square({"pbrMetallicRoughness": pbr, "extensions": NO_GLOSS}, COLOR_0=colors)
    primitive = file.data["meshes"][0]["primitives"][0]
    file.data["accessors"][primitive["attributes"]["COLOR_0"]]["normalized"] = True
    scene = accuray.load(file.save(Path("a.glb")))
    (shape,) = scene.shapes.values()
    assert shape["colors"].tolist() == [[0.5, 0, 0, 1]] * 4
    assert scene.materials["m"]["base_color"].texture == "vertex colours"


def test_normal_maps_lean_to_the_right_and_upwards() -> None:
    """A normal that leans to +x reflects more of a light on that side; green means upwards."""
    for color, stronger, weaker in (
        ((218, 128, 218), [3, 0, 3], [-3, 0, 3]), ((128, 218, 218), [0, 3, 3], [0, -3, 3])
    ):  # fmt: skip
        file = GltfFile()
        picture = file.picture(np.full((1, 1, 3), color, np.uint8))
        material = {"pbrMetallicRoughness": PLAIN, "extensions": NO_GLOSS, "normalTexture": {"index": picture}}
        file.square(material, TEXCOORD_0=SQUARE_UVS).save(Path("a.glb"))
        seen = []
        for place in (stronger, weaker):
            lights = {"l": {"type": "point", "position": place, "intensity": 10}}
            scene = accuray.Scene.from_dict({"models": {"a": {"file": "a.glb"}}, "lights": lights})
            seen.append(looked_up(scene, [(0.5, 0.5)])[0, 1])
        assert seen[0] > 3 * seen[1]


def test_second_set_of_coordinates() -> None:
    file = GltfFile()
    info = {"index": file.picture(QUADRANTS, magFilter=9728), "texCoord": 1}
    material = {"pbrMetallicRoughness": {**PLAIN, "baseColorTexture": info}, "extensions": NO_GLOSS}
    material["normalTexture"] = {"index": 0}
    file.square(material, TEXCOORD_0=SQUARE_UVS, TEXCOORD_1=1 - SQUARE_UVS)
    scene = accuray.load(file.save(Path("a.glb")))
    expect_colors(looked_up(scene, CORNERS), [WHITE, BLUE, GREEN, RED])
    assert any("normalTexture was left out: a mesh has one set" in note for note in scene.model_notes)


def test_missing_coordinates_are_an_error_where_a_texture_needs_them() -> None:
    file = GltfFile()
    picture = file.picture(QUADRANTS)
    file.square({"pbrMetallicRoughness": {"baseColorTexture": {"index": picture}}})
    with pytest.raises(accuray.SceneError, match="has no texture coordinates"):
        accuray.load(file.save(Path("a.glb")))


def test_unknown_extensions() -> None:
    file = GltfFile().square({"extensions": {"KHR_materials_unlit": {}}})
    file.data["extensionsUsed"] = ["KHR_materials_unlit", "VENDOR_anything", "KHR_materials_ior"]
    notes = accuray.load(file.save(Path("a.glb"))).model_notes
    assert any("VENDOR_anything is not known" in note for note in notes)
    assert any("material m: KHR_materials_unlit was left out" in note for note in notes)
    assert not any("ior" in note for note in notes)
    file.data["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    with pytest.raises(accuray.SceneError, match=r"extensionsRequired\[0\].*is required and not supported"):
        accuray.load(file.save(Path("a.glb")))
