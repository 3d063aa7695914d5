"""OpenPBR Surface: each of its parts is the material that it stands for, and together they lose no light."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.scene.openpbr import dispersed, kept_inside, weighted_ior

Table = dict[str, Any]
SKY = {"sky": {"type": "constant", "radiance": 1}}
LAMPS = {"lamp": {"type": "point", "position": [1, 0.5, 3], "intensity": 2}, **SKY}
BALL = {"type": "sphere", "material": "m", "radius": 1.0}
RED = [0.6, 0.1, 0.05]
PBR = {"type": "openpbr", "specular_roughness": 0.0}


def scene(material: Table, lights: Table = SKY, **sections: Table) -> accuray.Scene:
    """A ball of the material."""
    described = {"materials": {"m": material, **sections.pop("materials", {})}, "shapes": {"ball": BALL}}
    return accuray.Scene.from_dict({**described, "lights": lights, **sections})


def radiance(of: accuray.Scene, spp: int = 1024) -> tuple[float, float]:
    """Radiance at 550 nm of a ball that is met at an angle, and its standard error."""
    result = accuray.radiance(of, [[0.3, 0.2, 4.0]], [[0.0, 0.0, -1.0]], spp, wavelengths=[550.0])
    return float(result.mean[0, 0]), float(result.error[0, 0])


@pytest.mark.parametrize(
    ("openpbr", "own", "parts"),
    [
        ({"base_metalness": 1, "base_color": RED, "specular_color": 0.7, "specular_roughness": 0.4},
         {"type": "conductor", "reflectance": RED, "edge_tint": 0.7, "roughness": 0.4}, {}),
        ({"base_metalness": 1, "base_weight": 0.5, "base_color": RED},
         {"type": "conductor", "reflectance": [c / 2 for c in RED]}, {}),
        ({"specular_weight": 0, "base_color": RED, "base_diffuse_roughness": 0.5},
         {"type": "diffuse", "reflectance": RED, "roughness": 0.5}, {}),
        ({"base_color": RED, "specular_roughness": 0.5, "specular_ior": 1.4},
         {"type": "coated", "base": "b", "roughness": 0.5, "ior": 1.4}, {"b": {"type": "diffuse", "reflectance": RED}}),
        ({"transmission_weight": 1, "specular_ior": 1.3, "specular_roughness": 0.5},
         {"type": "dielectric", "ior": 1.3, "roughness": 0.5}, {}),
        ({"transmission_weight": 1, "transmission_color": RED, "transmission_depth": 0.4},
         {"type": "dielectric", "transmission_color": RED, "transmission_depth": 0.4}, {}),
        ({"transmission_weight": 1, "thin_film_weight": 1, "thin_film_thickness": "0.3 um"},
         {"type": "dielectric", "film_thickness": "300 nm", "film_ior": 1.4}, {}),
        ({"transmission_weight": 1, "geometry_thin_walled": True}, {"type": "thin_dielectric"}, {}),
        ({"base_color": RED, "coat_weight": 1, "coat_roughness": 0.3, "coat_color": 0.25, "specular_roughness": 0.6},
         {"type": "coated", "base": "g", "roughness": 0.3, "ior": 1.6, "transmission_color": 0.5},
         {"b": {"type": "diffuse", "reflectance": RED}, "g": {"type": "coated", "base": "b", "roughness": 0.6}}),
        ({"base_color": RED, "coat_weight": 1, "specular_weight": 0},
         {"type": "coated", "base": "b", "ior": 1.6}, {"b": {"type": "diffuse", "reflectance": RED}}),
        ({"base_metalness": 1, "base_color": RED, "thin_film_weight": 1, "thin_film_thickness": 200},
         {"type": "conductor", "reflectance": RED, "film_thickness": 200, "film_ior": 1.4}, {}),
        ({"transmission_weight": 1, "transmission_color": RED}, {"type": "dielectric", "transmission_color": RED}, {}),
        ({"transmission_weight": 1, "geometry_thin_walled": True, "specular_roughness": 0.4, "transmission_color": RED},
         {"type": "coated", "base": "b", "roughness": 0.4, "transmission_color": RED},
         {"b": {"type": "thin_dielectric"}}),
        ({"base_metalness": 1, "coat_weight": 1, "base_color": RED},
         {"type": "coated", "base": "b", "ior": 1.6}, {"b": {"type": "conductor", "reflectance": RED}}),
    ],
)  # fmt: skip
def test_a_part_alone_is_the_material_that_it_stands_for(openpbr: Table, own: Table, parts: Table) -> None:
    """To the bit: the same values, the same random numbers."""
    assert radiance(scene({**PBR, **openpbr}, LAMPS), 64) == radiance(scene(own, LAMPS, materials=parts), 64)


WHITE = {"base_color": 1.0, "specular_color": 1.0}


@pytest.mark.parametrize(
    "weights",
    [
        {},
        {"coat_weight": 0.5, "base_metalness": 0.5, "transmission_weight": 0.5},
        {"coat_weight": 1.0, "coat_roughness": 0.6, "specular_roughness": 0.7},
        {"fuzz_weight": 0.7, "fuzz_roughness": 0.8, "base_metalness": 0.5},
        {"coat_weight": 1.0, "coat_ior": 1.3, "specular_ior": 2.0, "specular_roughness": 0.4, "coat_darkening": 0.4},
        {"transmission_weight": 1.0, "geometry_thin_walled": True, "specular_roughness": 0.6, "coat_weight": 0.5},
        {"base_metalness": 0.5, "thin_film_weight": 1.0},
        {"specular_weight": 0.3, "base_diffuse_roughness": 1.0, "transmission_weight": 0.3, "thin_film_weight": 0.5},
    ],
)
def test_what_absorbs_nothing_loses_nothing(weights: Table) -> None:
    mean, error = radiance(scene({**PBR, **WHITE, **weights}), 4096)
    assert abs(mean - 1.0) <= 5.0 * error + 2e-3, f"{mean} +- {error}"


def test_a_textured_weight_is_a_factor_of_the_colour() -> None:
    half = {"t": {"type": "image", "pixels": np.full((1, 1, 1), 0.5, dtype=np.float32)}}
    for metalness in (0.0, 1.0):
        material = {**PBR, "specular_weight": 1 - metalness, "base_metalness": metalness, "base_color": 0.8}
        textured = radiance(scene({**material, "base_weight": {"texture": "t"}}, textures=half), 4096)
        plain = [radiance(scene({**material, "base_weight": w}), 4096) for w in (0.0, 1.0)]
        expected, error = np.mean([p[0] for p in plain]), np.hypot(textured[1], 0.5 * plain[1][1])
        if metalness:
            expected, error = 0.5 * plain[1][0], textured[1]  # the black share has no edge
        assert abs(textured[0] - expected) <= 5.0 * error + 1e-6


def test_the_specular_weight_is_a_factor_of_the_reflectance() -> None:
    def normal(ior: float) -> float:
        return ((ior - 1.0) / (ior + 1.0)) ** 2

    for ior, weight in ((1.5, 0.25), (1.3, 0.9), (2.4, 0.0), (1.0, 0.5)):
        assert normal(weighted_ior(ior, weight)) == pytest.approx(weight * normal(ior), abs=1e-12)
    assert weighted_ior(1.5, 1.0) == 1.5


def test_the_dispersion_has_its_abbe_number() -> None:
    glass = dispersed(1.6, 0.5, 20.0)
    f, d, c = (glass.at(wavelength) for wavelength in (486.1327, 587.5618, 656.2725))
    assert d == pytest.approx(1.6)
    assert (d - 1.0) / (f - c) == pytest.approx(40.0)


def test_the_colour_of_a_coat_is_that_of_the_way_in_and_out() -> None:
    """A coat without index over a mirror, straight on."""
    mirror = {"type": "openpbr", "base_metalness": 1, "base_color": 1.0, "specular_roughness": 0.0}
    coated = scene({**mirror, "coat_weight": 1, "coat_ior": 1.0, "coat_color": 0.3})
    result = accuray.radiance(coated, [[0.0, 0.0, 4.0]], [[0.0, 0.0, -1.0]], 16, wavelengths=[550.0])
    assert float(result.mean[0, 0]) == pytest.approx(0.3, rel=1e-5)


def matte_albedo(**more: Any) -> float:
    """Share of even light that a flat grey surface under a smooth coat sends back, less what its interfaces mirror."""
    plate = {"type": "rectangle", "material": "m", "corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
    total = 0.0
    for colour, sign in ((0.5, 1.0), (0.0, -1.0)):
        material = {**PBR, "base_color": colour, **more}
        described = {"materials": {"m": material}, "shapes": {"plate": plate}, "lights": SKY}
        found = accuray.radiance(
            accuray.Scene.from_dict(described), [[0, 0, 2]], [[0, 0, -1]], 16384, wavelengths=[550.0]
        )
        total += sign * float(found.mean[0, 0])
    return total


def test_darkening_is_that_of_the_coat_or_none() -> None:
    """Without darkening the base shows as if the coat sent nothing back: its albedo without the coat, dimmed by what
    the coat mirrors on the way in. Nature's darkening is the closed form; between them it is a share.
    """
    bare = matte_albedo(specular_weight=0)
    coat: Table = {"specular_weight": 0, "coat_weight": 1, "coat_ior": 1.6}
    nature, half, none = (matte_albedo(**coat, coat_darkening=d) for d in (1.0, 0.5, 0.0))
    into = 1.0 - ((1.6 - 1.0) / (1.6 + 1.0)) ** 2
    inside = kept_inside(1.0, 1.6)
    assert bare == pytest.approx(0.5, rel=1e-3)
    assert nature == pytest.approx(into * 0.5 * (1.0 - inside) / (1.0 - 0.5 * inside), rel=0.02)
    assert none == pytest.approx(into * 0.5, rel=0.02)
    assert half == pytest.approx(0.5 * (nature + none), rel=0.02)


def test_the_emission_has_its_luminance() -> None:
    dark = {**PBR, "base_weight": 0.0, "specular_weight": 0.0}
    lamp = scene({**dark, "emission_luminance": 250.0, "emission_color": [1, 1, 1]}, {})
    same = scene({**dark, "emission": {"rgb": [1, 1, 1], "luminance": "250 cd/m^2"}}, {})
    assert radiance(lamp)[0] == pytest.approx(radiance(same)[0], rel=1e-5)


@pytest.mark.parametrize(
    ("openpbr", "key", "text"),
    [
        ({"specular_color": [1, 0.5, 0.5]}, "specular_color", "dielectric"),
        ({"coat_darkening": 1.5}, "coat_darkening", "0 to 1"),
        ({"coat_darkening": 0.5, "base_color": {"texture": "t"}}, "coat_darkening", "no texture"),
        ({"emission": 1.0, "emission_luminance": 5.0}, "emission_luminance", "one of them"),
        ({"subsurface_weight": 1.0}, "subsurface_weight", "not a known parameter of openpbr"),
    ],
)
def test_what_cannot_be_said(openpbr: Table, key: str, text: str) -> None:
    grey = {"t": {"type": "image", "pixels": np.full((1, 1, 3), 0.5, dtype=np.float32)}}
    with pytest.raises(accuray.SceneError) as caught:
        scene({**PBR, **openpbr}, textures=grey)
    assert caught.value.key == f"materials.m.{key}"
    assert text in str(caught.value)


def test_a_model_is_no_base_of_a_coat() -> None:
    with pytest.raises(accuray.SceneError, match=r"materials\.m\.base: .*openpbr"):
        scene({"type": "coated", "base": "b"}, materials={"b": PBR})
