"""Textures in the scene: who may use them, what `auto` means, texture coordinates, and identity."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from accuray.devices.lowering import lower
from accuray.formats import Scene
from accuray.scene import SceneError
from accuray.scene.textures import TextureUse

Table = dict[str, Any]
TRIANGLE: Table = {
    "type": "mesh",
    "material": "m",
    "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
    "faces": [[0, 1, 2]],
}
UVS: Table = {"uvs": [[0, 0], [1, 0], [0, 1]]}
GREY = np.full((2, 2), 128, dtype=np.uint8)


def described(material: Table, texture: Table | None = None, **sections: Table) -> Table:
    return {
        "textures": {"t": texture or {"type": "image", "pixels": GREY}},
        "materials": {"m": {"type": "diffuse", **material}},
        **sections,
    }


COLOURED: Table = {"reflectance": {"texture": "t"}}
NUMERIC: Table = {"opacity": {"texture": "t"}}


def test_a_parameter_holds_what_it_takes_from_the_texture() -> None:
    made = Scene.from_dict(
        described(
            {
                "reflectance": {"texture": "t", "scale": 0.5},
                "opacity": {"texture": "t", "channel": "alpha"},
                "normal_map": "t",
            },
            {"type": "image", "pixels": GREY, "color_space": "data"},
        )
    ).materials["m"]
    assert made["reflectance"] == TextureUse("t", 0.5)
    assert made["opacity"] == TextureUse("t", 1.0, "alpha")
    assert made["normal_map"] == TextureUse("t", 1.0, "map")


@pytest.mark.parametrize(
    ("material", "key", "complaint"),
    [
        ({"emission_sides": {"texture": "t"}}, "materials.m.emission_sides", "takes no texture"),
        (
            {"type": "dielectric", "transmission_color": {"texture": "t"}},
            "materials.m.transmission_color",
            "colour of the body's inside",
        ),
        ({"type": "dielectric", "ior": {"texture": "t", "channel": "x"}}, "materials.m.ior.channel", "red"),
        ({"reflectance": {"texture": "T"}}, "materials.m.reflectance.texture", 'did you mean "t"'),
        ({"reflectance": {"texture": 3}}, "materials.m.reflectance.texture", "is not a known texture"),
        ({"reflectance": {"texture": "t", "scale": -1}}, "materials.m.reflectance.scale", "out of range"),
        ({"reflectance": {"texture": "t", "scale": "x"}}, "materials.m.reflectance.scale", '"x"'),
        ({"reflectance": {"texture": "t", "channel": "red"}}, "materials.m.reflectance.channel", "not a known key"),
        ({"opacity": {"texture": "t", "channel": "reed"}}, "materials.m.opacity.channel", 'did you mean "red"'),
        ({"opacity": {"texture": "t", "factor": 1}}, "materials.m.opacity.factor", "scale"),
        ({"opacity": {"texture": "t"}, "emission": 1}, "materials.m.opacity", "cannot go with `emission`"),
        ({"opacity": 0.5, "emission": 1}, "materials.m.opacity", "cannot go with `emission`"),
        ({"normal_map": "m"}, "materials.m.normal_map.texture", "is not a known texture"),
        ({"bump_map": {"texture": "t", "channel": "red"}}, "materials.m.bump_map.channel", "not a known key"),
        ({"normal_map": ["t"]}, "materials.m.normal_map.texture", "is not a known texture"),
        ({"normal_map": "t", "normal_map_convention": "vulkan"}, "materials.m.normal_map_convention", "opengl"),
    ],
)
def test_a_wrong_use_is_named(material: Table, key: str, complaint: str) -> None:
    with pytest.raises(SceneError, match=complaint) as caught:
        Scene.from_dict(described(material))
    assert caught.value.key == key


def test_a_body_that_others_meet_needs_an_index_inside() -> None:
    glass = {"type": "dielectric", "ior": {"texture": "t"}, "priority": 1}
    with pytest.raises(SceneError, match="none inside: allowed is a texture only with priority = 0") as caught:
        lower(Scene.from_dict(described(glass)))
    assert caught.value.key == "materials.m.ior"
    lower(Scene.from_dict(described({**glass, "priority": 0})))


@pytest.mark.parametrize(
    ("texture", "key", "complaint"),
    [
        ({"type": "image"}, "textures.t", "lacks its source"),
        ({"type": "image", "pixels": [[1, 2], [3]]}, "textures.t.pixels", "is not a picture"),
        ({"type": "image", "pixels": "a.png"}, "textures.t.pixels", "is not a picture"),
        ({"type": "image", "pixels": np.zeros((2, 2, 5))}, "textures.t.pixels", "1 to 4 channels"),
        ({"type": "image", "pixels": np.zeros((0, 2))}, "textures.t.pixels", "at least 1 x 1"),
        ({"type": "image", "pixels": np.zeros((2, 2), dtype=np.int64)}, "textures.t.pixels", "uint8, uint16"),
        ({"type": "image", "pixels": np.zeros((2, 2), dtype=complex)}, "textures.t.pixels", "uint8, uint16"),
        ({"type": "image", "pixels": [[np.inf]]}, "textures.t.pixels", "not a finite number"),
        ({"type": "image", "pixels": np.broadcast_to(np.uint8(0), (1 << 16, 1 << 15))}, "textures.t.pixels", "claims"),
        ({"type": "image", "pixels": GREY, "wrap_u": "mirrored"}, "textures.t.wrap_u", 'did you mean "mirror"'),
        ({"type": "image", "pixels": GREY, "uv_scale": [1, 1, 1]}, "textures.t.uv_scale", "a list of 2 numbers"),
        ({"type": "checkers"}, "textures.t.type", 'did you mean "checker"'),
        ({"type": "checker", "first": 0.5}, "textures.t.first", "is not a vector"),
        ({"type": "checker", "first": [-0.5, 0, 0]}, "textures.t.first", "out of range"),
    ],
)
def test_a_wrong_texture_is_named(texture: Table, key: str, complaint: str) -> None:
    with pytest.raises(SceneError, match=complaint) as caught:
        Scene.from_dict({"textures": {"t": texture}})
    assert caught.value.key.startswith(key)


@pytest.mark.parametrize(
    ("pixels", "material", "expected"),
    [
        (GREY, COLOURED, "srgb"),
        (GREY, NUMERIC, "data"),
        (GREY, {"normal_map": "t"}, "data"),
        (GREY, {"bump_map": {"texture": "t", "scale": 2}}, "data"),
        (GREY, {}, "srgb"),
        (GREY.astype(np.uint16), COLOURED, "srgb"),
        (GREY / 255.0, COLOURED, "linear"),
        (GREY / 255.0, NUMERIC, "linear"),
    ],
)
def test_auto_follows_from_the_texels_and_the_use(pixels: Any, material: Table, expected: str) -> None:
    made = Scene.from_dict(described(material, {"type": "image", "pixels": pixels}))
    assert made.textures["t"]["color_space"] == expected


def test_auto_cannot_mean_two_things() -> None:
    with pytest.raises(SceneError, match=r"colours .* and materials.m.opacity numbers") as caught:
        Scene.from_dict(described({**COLOURED, **NUMERIC}))
    assert caught.value.key == "textures.t.color_space"
    Scene.from_dict(described({**COLOURED, **NUMERIC}, {"type": "image", "pixels": GREY, "color_space": "srgb"}))


def test_a_mesh_without_coordinates_is_named_with_its_material() -> None:
    with pytest.raises(SceneError, match=r'no texture coordinates, .* "t" of materials.m.reflectance') as caught:
        Scene.from_dict(described(COLOURED, shapes={"leaf": TRIANGLE}))
    assert caught.value.key == "shapes.leaf"
    Scene.from_dict(described(COLOURED, shapes={"leaf": {**TRIANGLE, **UVS}}))
    Scene.from_dict(described(COLOURED, {"type": "marble"}, shapes={"leaf": TRIANGLE}))
    Scene.from_dict(described({}, shapes={"leaf": TRIANGLE}))


def test_an_instance_brings_its_material_to_meshes_without_coordinates() -> None:
    materials = {"m": {"type": "diffuse", **COLOURED}, "plain": {"type": "diffuse"}}
    leaf = {**TRIANGLE, "material": "plain", "prototype": True}
    shapes = {"leaf": leaf, "copy": {"type": "instance", "of": "leaf", "material": "m"}}
    with pytest.raises(SceneError, match=r'no texture coordinates \(shown by "copy"\)'):
        Scene.from_dict({**described(COLOURED), "materials": materials, "shapes": shapes})
    Scene.from_dict({**described(COLOURED), "materials": materials, "shapes": {"leaf": leaf}})


# --- Identity -------------------------------------------------------------------------------------------------------


def identity(scene: Table) -> str:
    return Scene.from_dict(scene).identity


def test_identity_depends_on_texels_and_parameters() -> None:
    base = described(COLOURED)
    other_texel = GREY.copy()
    other_texel[1, 0] += 1
    changed = [
        described(COLOURED, {"type": "image", "pixels": other_texel}),
        described(COLOURED, {"type": "image", "pixels": GREY.astype(np.uint16)}),
        described(COLOURED, {"type": "image", "pixels": GREY.reshape(1, 4)}),
        described(COLOURED, {"type": "image", "pixels": GREY, "wrap_u": "clamp"}),
        described(COLOURED, {"type": "image", "pixels": GREY, "uv_scale": [2, 1]}),
        described(COLOURED, {"type": "image", "pixels": GREY, "color_space": "data"}),
        described({"reflectance": {"texture": "t", "scale": 0.5}}),
        described({**COLOURED, "opacity": 0.5}),
    ]
    assert len({identity(base), *(identity(scene) for scene in changed)}) == len(changed) + 1
    assert identity(base) == identity(copy.deepcopy(base))
    explicit = described(COLOURED, {"type": "image", "pixels": GREY, "color_space": "srgb"})
    assert identity(explicit) == identity(base)


def test_an_array_that_changes_later_changes_nothing() -> None:
    pixels = GREY.copy()
    made = Scene.from_dict(described(COLOURED, {"type": "image", "pixels": pixels}))
    pixels[:] = 0
    assert made.textures["t"]["pixels"].max() == 128


def test_equal_pictures_are_kept_once() -> None:
    large = np.zeros((256, 256, 3), dtype=np.uint8)
    one: Table = {"type": "image", "pixels": large}
    textures = {"a": one, "b": {**one, "pixels": large.copy(), "wrap_u": "clamp"}, "c": {**one, "pixels": large + 1}}
    sizes = [lower(Scene.from_dict({"textures": some}))[0].bytes for some in ({"a": one}, textures)]
    assert large.nbytes <= sizes[1] - sizes[0] < 1.1 * large.nbytes
