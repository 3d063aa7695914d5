"""Materials made of others: `mix` and `two_sided` against closed forms, and what cannot be a part."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray._core import probe

Table = dict[str, Any]
SKY = {"sky": {"type": "constant", "radiance": 1}}
#: The plane z = 0, its front towards +z; u runs along x and v along y.
PLANE = {"type": "rectangle", "material": "m", "corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}
GREY = {name: {"type": "diffuse", "reflectance": value} for name, value in (("a", 0.1), ("b", 0.3), ("c", 0.9))}


def scene(materials: Table, **sections: Table) -> accuray.Scene:
    """The plane of material `m` under a sky of radiance 1, or what is given instead."""
    whole = {"lights": SKY, "shapes": {"plane": PLANE}, **sections}
    return accuray.Scene.from_dict({"materials": {**GREY, **materials}, **whole})


def radiance(of: accuray.Scene, origin: Any = (0.3, 0.2, 1.0), direction: Any = (0, 0, -1.0)) -> tuple[float, float]:
    """Radiance at 550 nm along a ray, and its standard error."""
    result = accuray.radiance(of, np.array([origin]), np.array([direction]), 4096, wavelengths=[550.0])
    return float(result.mean[0, 0]), float(result.error[0, 0])


def assert_close(found: tuple[float, float], expected: float) -> None:
    assert abs(found[0] - expected) <= 5.0 * found[1] + 1e-6, f"{found[0]} +- {found[1]}, not {expected}"


@pytest.mark.parametrize("weight", [0.0, 0.25, 0.6, 1.0])
def test_a_mix_reflects_its_weighted_mean(weight: float) -> None:
    mixed = scene({"m": {"type": "mix", "first": "a", "second": "c", "weight": weight}})
    assert_close(radiance(mixed), (1 - weight) * 0.1 + weight * 0.9)


def test_a_mix_of_mixes_is_the_product_of_the_weights() -> None:
    inner = {"type": "mix", "first": "a", "second": "b", "weight": 0.3}
    outer = {"type": "mix", "first": "inner", "second": "c", "weight": 0.4}
    assert_close(radiance(scene({"inner": inner, "m": outer})), 0.6 * (0.7 * 0.1 + 0.3 * 0.3) + 0.4 * 0.9)


def test_a_texture_says_which_material_shows_where() -> None:
    """Black texels show the first material, white ones the second; rays go to the middle of each."""
    columns = np.array([[[0.0], [1.0]]], dtype=np.float32)
    textures = {"t": {"type": "image", "pixels": columns, "filter": "nearest"}}
    split = scene({"m": {"type": "mix", "first": "a", "second": "c", "weight": {"texture": "t"}}}, textures=textures)
    assert_close(radiance(split, (-1.0, 0.3, 1.0)), 0.1)
    assert_close(radiance(split, (1.0, 0.3, 1.0)), 0.9)


def test_each_side_of_a_surface_has_its_material() -> None:
    sides = scene({"m": {"type": "two_sided", "front": "b", "back": "c"}})
    assert_close(radiance(sides), 0.3)
    assert_close(radiance(sides, (0.3, 0.2, -1.0), (0, 0, 1.0)), 0.9)


def test_the_back_is_like_the_front_unless_it_is_given() -> None:
    sides = scene({"m": {"type": "two_sided", "front": "b"}})
    assert_close(radiance(sides, (0.3, 0.2, -1.0), (0, 0, 1.0)), 0.3)


def test_two_sided_within_a_mix_keeps_its_sides() -> None:
    sides = {"type": "two_sided", "front": "b", "back": "c"}
    mixed = scene({"sides": sides, "m": {"type": "mix", "first": "a", "second": "sides", "weight": 0.5}})
    assert_close(radiance(mixed), 0.5 * 0.1 + 0.5 * 0.3)
    assert_close(radiance(mixed, (0.3, 0.2, -1.0), (0, 0, 1.0)), 0.5 * 0.1 + 0.5 * 0.9)


def test_a_mixed_surface_emits_as_a_whole() -> None:
    """To the front only, and on both sides of a two-sided one that says so."""
    dark = {"lights": {}}
    lamp = {"type": "two_sided", "front": "b", "back": "c", "emission": 2.0}
    front = scene({"m": lamp}, **dark)
    assert_close(radiance(front), 2.0)
    assert_close(radiance(front, (0.3, 0.2, -1.0), (0, 0, 1.0)), 0.0)
    both = scene({"m": {**lamp, "emission_sides": "both"}}, **dark)
    assert_close(radiance(both, (0.3, 0.2, -1.0), (0, 0, 1.0)), 2.0)


@pytest.mark.parametrize("integrator", [{"type": "path", "strategy": s} for s in ("mis", "light", "bsdf")], ids=str)
def test_lamps_light_a_mix_as_they_light_its_parts(integrator: Table) -> None:
    """Direct light under a lamp is linear in the BSDF: half of what each part reflects alone."""
    lamp = {"type": "rectangle", "material": "lamp", "corner": [-1, 1, 1.5], "edge_u": [0, -2, 0], "edge_v": [2, 0, 0]}
    materials = {
        "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1.0},
        "metal": {"type": "conductor", "reflectance": 0.8, "roughness": 0.5},
        "m": {"type": "mix", "first": "metal", "second": "c", "weight": 0.5},
    }
    shapes = {"plane": PLANE, "lamp": lamp}

    def lit(material: str) -> tuple[float, float]:
        plane = {**PLANE, "material": material}
        direct = {"type": "path", "max_depth": 1, "strategy": integrator["strategy"]}
        one = scene(materials, shapes={**shapes, "plane": plane}, lights={}, integrator=direct)
        return radiance(one, (0.0, -1.0, 1.0), (0.0, 0.6, -0.8))

    parts = [lit("metal"), lit("c")]
    mixed = lit("m")
    error = np.sqrt(mixed[1] ** 2 + sum((0.5 * part[1]) ** 2 for part in parts))
    assert abs(mixed[0] - 0.5 * (parts[0][0] + parts[1][0])) <= 5.0 * error


def test_no_light_is_lost_where_glass_and_mirrors_mix() -> None:
    """A ball of both, in a furnace: what goes in through glass may be held back by mirrors for long."""
    materials = {
        "glass": {"type": "dielectric", "ior": 1.5},
        "mirror": {"type": "conductor", "metal": "perfect"},
        "m": {"type": "mix", "first": "glass", "second": "mirror", "weight": 0.5},
    }
    ball = {"ball": {"type": "sphere", "material": "m", "radius": 1.0}}
    assert_close(radiance(scene(materials, shapes=ball), (0.3, 0.2, 3.0)), 1.0)


def test_parts_without_maps_take_those_of_the_whole() -> None:
    """To the bit what the part with the map itself shows."""
    slope = np.tile(np.array([[[0.7, 0.5, 0.9]]], dtype=np.float32), (2, 2, 1))
    textures = {"n": {"type": "image", "pixels": slope, "color_space": "data"}}
    bent = {**GREY["b"], "normal_map": {"texture": "n"}}
    lights = {"lamp": {"type": "point", "position": [1, 0, 2], "intensity": 1}}
    whole = {"type": "two_sided", "front": "b", "normal_map": {"texture": "n"}}
    plain, through = (scene({"m": m}, textures=textures, lights=lights) for m in (bent, whole))
    assert radiance(plain) == radiance(through)
    flat = scene({"m": {"type": "two_sided", "front": "b"}}, lights=lights)
    assert radiance(flat) != radiance(through)


@pytest.mark.parametrize("angle", [0.0, 60.0, 80.0])
def test_fibres_take_their_albedo_from_the_base(angle: float) -> None:
    """White ones give it back, black ones do not; half a weight is half of each."""
    cosine = float(np.cos(np.radians(angle)))
    share = 0.5 * probe.sheen_albedo(cosine, 0.6)
    away = np.array([np.sin(np.radians(angle)), 0.0, -cosine])
    origin = np.array([0.1, 0.2, 0.0]) - away
    for colour in (0.0, 1.0):
        fibres = {"type": "sheen", "color": colour, "roughness": 0.6}
        fuzzy = scene({"fibres": fibres, "m": {"type": "fuzz", "base": "b", "fibres": "fibres", "weight": 0.5}})
        found = radiance(fuzzy, origin, away)
        expected = (1 - share) * 0.3 + share * colour
        assert abs(found[0] - expected) <= 5.0 * found[1] + 2e-3, (found, expected)


def bad(materials: Table, *texts: str) -> None:
    with pytest.raises(accuray.SceneError) as caught:
        accuray.render(scene(materials, film={"width": 2, "height": 2}), spp=1)
    message = str(caught.value)
    assert all(text in message for text in texts), message


def test_what_cannot_be_a_part() -> None:
    mix = {"type": "mix", "first": "a", "second": "b"}
    bad({"m": {**mix, "first": "m"}}, "materials.m.first", "m -> m")
    bad({"m": {**mix, "first": "n"}, "n": {**mix, "second": "m"}}, "part of itself", "m -> n -> m")
    bad({"m": {**mix, "first": "plane"}}, "materials.m.first", '"plane"')
    bad({"m": {"type": "mix", "first": "a"}}, "materials.m", "second")
    lamp = {"type": "diffuse", "emission": 1.0}
    bad({"lamp": lamp, "m": {**mix, "first": "lamp"}}, "materials.lamp.emission", 'emission of "m"')
    veil = {"type": "diffuse", "opacity": 0.5}
    bad({"veil": veil, "m": {**mix, "second": "veil"}}, "materials.veil.opacity", '"m"')
    glass = {"glass": {"type": "dielectric"}, "some": {**mix, "second": "glass"}}
    bad({**glass, "m": {"type": "two_sided", "front": "some"}}, "materials.m.front", "body")
    bad({"m": {"type": "fuzz", "base": "a", "fibres": "b"}}, "materials.m.fibres", "type sheen")
    chain = {f"m{i}": {"type": "two_sided", "front": f"m{i + 1}" if i < 9 else "a"} for i in range(10)}
    bad({**chain, "m": mix}, "too deeply", "at most 8")
    tree = {f"t{i}": {**mix, "first": f"t{i + 1}", "second": f"t{i + 1}"} for i in range(4)}
    bad({**tree, "t4": GREY["a"], "m": mix}, "materials.t0", "16 materials", "at most 8")


def test_shapes_need_the_coordinates_that_parts_read() -> None:
    mesh = {"type": "mesh", "material": "m", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}
    checked = {"type": "diffuse", "reflectance": {"texture": "t"}}
    materials = {"checked": checked, "m": {"type": "mix", "first": "checked", "second": "a"}}
    with pytest.raises(accuray.SceneError, match=r"texture coordinates.*materials\.checked\.reflectance"):
        scene(materials, shapes={"mesh": mesh}, textures={"t": {"type": "checker"}})
