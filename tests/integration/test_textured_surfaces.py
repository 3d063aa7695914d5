"""Textured scenes against closed forms: colours, opacity on paths and shadow rays, normal maps and their energy."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray

Table = dict[str, Any]
DOWN = [[0.0, 0.0, -1.0]]
ABOVE = [[0.3, 0.2, 5.0]]
#: The plane z = 0, its front towards +z; u runs along x and v along y.
PLANE = {"type": "rectangle", "material": "m", "corner": [-20, -20, 0], "edge_u": [40, 0, 0], "edge_v": [0, 40, 0]}


def scene(material: Table, textures: Table | None = None, **sections: Table) -> accuray.Scene:
    """The plane of one material under a sky of radiance 1, or under the lights that are given."""
    lights = {"lights": {"sky": {"type": "constant", "radiance": 1}}}
    described = {"materials": {"m": material}, "shapes": {"plane": PLANE}, "textures": textures or {}}
    return accuray.Scene.from_dict({**described, **lights, **sections})


def radiance(of: accuray.Scene, direction: Any = DOWN, spp: int = 4096) -> tuple[float, float]:
    """Radiance at 550 nm from above, and its standard error."""
    result = accuray.radiance(of, ABOVE, np.array(direction, dtype=float), spp, wavelengths=[550.0])
    return float(result.mean[0, 0]), float(result.error[0, 0])


def close(found: tuple[float, float], expected: float) -> bool:
    return abs(found[0] - expected) <= 5.0 * found[1] + 1e-6


# --- Colours --------------------------------------------------------------------------------------------------------

COLOUR = [0.7, 0.3, 0.1]


@pytest.mark.parametrize(
    "texture",
    [
        {"type": "image", "pixels": np.array([[COLOUR]], dtype=np.float32)},
        {"type": "image", "pixels": np.array([[COLOUR]] * 3), "filter": "nearest", "uv_rotate": 45},
        {"type": "checker", "first": COLOUR, "second": COLOUR},
        {"type": "gradient", "first": COLOUR, "second": COLOUR},
        {"type": "noise", "first": COLOUR, "second": COLOUR},
    ],
    ids=lambda texture: texture["type"],
)
def test_a_texture_of_one_colour_is_that_colour(texture: Table) -> None:
    """To the bit: the same spectrum, the same frame, the same random numbers."""
    small = {"film": {"width": 8, "height": 8}, "camera": {"type": "perspective", "position": [0, 0, 3]}}
    plain = scene({"type": "diffuse", "reflectance": COLOUR}, **small)
    textured = scene({"type": "diffuse", "reflectance": {"texture": "t"}}, {"t": texture}, **small)
    sums = [accuray.render(one, spp=8).film.sums for one in (plain, textured)]
    assert sums[0].any()
    assert np.array_equal(*sums)


@pytest.mark.parametrize(
    "material",
    [
        {"type": "diffuse", "roughness": 0.5},
        {"type": "conductor", "metal": "Cu", "roughness": 0.5},
        {"type": "conductor", "metal": "Cu", "roughness": 0.75, "anisotropy": 0.5},
        {"type": "dielectric", "roughness": 0.5},
        {"type": "dielectric", "ior": 1.7, "roughness": 0.5},
        {"type": "thin_dielectric", "ior": 1.4},
        {"type": "conductor", "eta": 0.25, "k": 3.5, "roughness": 0.5},
        {"type": "conductor", "eta": 0.25, "k": 3.5},
    ],
    ids=lambda m: "-".join(m),
)
def test_a_texture_of_one_number_is_that_number(material: Table) -> None:
    """Roughness, anisotropy and indices from a map, to the bit."""
    small = {"film": {"width": 8, "height": 8}, "camera": {"type": "perspective", "position": [0, 2, 3]}}
    maps = {key: value for key, value in material.items() if isinstance(value, float)}
    textures = {key: {"type": "image", "pixels": np.full((2, 2), value, np.float32)} for key, value in maps.items()}
    textured = scene(material | {key: {"texture": key} for key in maps}, textures, **small)
    sums = [accuray.render(one, spp=8).film.sums for one in (scene(material, **small), textured)]
    assert sums[0].any()
    assert np.array_equal(*sums)


def test_an_index_from_a_texture_stays_within_what_the_parameter_allows() -> None:
    """A texture of 100, once halved and once taken from green, is the largest index, 20; one of 0 is the smallest."""
    texture = {"t": {"type": "checker", "first": [0, 100, 0], "second": [0, 100, 0]}}
    for use, ior in (
        ({"channel": "green"}, 20),
        ({"channel": "green", "scale": 0.5}, 20),
        ({"channel": "green", "scale": 0.02}, 2),
        ({}, 0.05),
    ):
        plain = scene({"type": "thin_dielectric", "ior": ior})
        textured = scene({"type": "thin_dielectric", "ior": {"texture": "t", **use}}, texture)
        assert radiance(textured, [[0.3, 0.1, -1.0]], 64) == radiance(plain, [[0.3, 0.1, -1.0]], 64), use


def test_a_textured_index_changes_the_mirror_image_from_point_to_point() -> None:
    """A pane of index 1 on the left and 2 on the right before black: 2R/(1+R) of the sky, R = 1/9, along the normal."""
    texture = {"t": {"type": "image", "pixels": [[1.0, 2.0]], "filter": "nearest"}}
    black = {"type": "diffuse", "reflectance": 0}
    pane = {**PLANE, "material": "pane", "corner": [-20, -20, 1]}
    materials = {"m": black, "pane": {"type": "thin_dielectric", "ior": {"texture": "t"}}}
    of = scene({}, texture, materials=materials, shapes={"plane": PLANE, "pane": pane})
    found = accuray.radiance(of, [[-5, 0, 2], [5, 0, 2]], DOWN * 2, 4096, wavelengths=[550.0])
    assert found.mean[0, 0] == 0.0
    assert abs(found.mean[1, 0] - 0.2) < 5.0 * found.error[1, 0] + 1e-3


def test_the_scale_multiplies_and_reflectances_stay_below_one() -> None:
    texture = {"t": {"type": "checker", "first": [0.8] * 3, "second": [0.8] * 3}}
    for scale, expected in ((0.5, 0.4), (1.0, 0.8), (3.0, 1.0)):
        found = scene({"type": "diffuse", "reflectance": {"texture": "t", "scale": scale}}, texture)
        assert close(radiance(found), expected), scale


def test_each_point_has_its_own_colour() -> None:
    """Four texels, seen from straight above; rows run from the top, u along x, v along y."""
    pixels = np.array([[0.1, 0.2], [0.4, 0.8]])
    textures = {"t": {"type": "image", "pixels": pixels, "filter": "nearest"}}
    of = scene({"type": "diffuse", "reflectance": {"texture": "t"}}, textures)
    origins = [[-10, 10, 1], [10, 10, 1], [-10, -10, 1], [10, -10, 1]]
    found = accuray.radiance(of, origins, DOWN * 4, 1024, wavelengths=[550.0])
    assert (np.abs(found.mean[:, 0] - pixels.ravel()) <= 5.0 * found.error[:, 0]).all()


def test_spheres_and_instances_carry_their_coordinates_along() -> None:
    """A sphere whose lower half is dark, seen from below, plain and as a scaled and mirrored instance."""
    textures = {"t": {"type": "image", "pixels": [[0.9], [0.1]], "filter": "nearest"}}
    ball = {"type": "sphere", "material": "m", "radius": 1}
    copy = {"type": "instance", "of": "ball", "transform": {"scale": -2}}
    material = {"type": "diffuse", "reflectance": {"texture": "t"}}
    up = [[0.0, 1.0, 0.0]]
    for shapes, expected in (({"ball": ball}, 0.1), ({"ball": {**ball, "prototype": True}, "copy": copy}, 0.9)):
        of = scene(material, textures, shapes=shapes)
        found = accuray.radiance(of, [[0.1, -9, 0.1]], up, 1024, wavelengths=[550.0])
        assert abs(found.mean[0, 0] - expected) <= 5.0 * found.error[0, 0]


# --- Opacity --------------------------------------------------------------------------------------------------------


def layers(count: int) -> Table:
    """Squares between the viewer and the plane, all of the material `veil`."""
    at = {"type": "rectangle", "material": "veil", "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}
    return {f"layer-{i}": {**at, "corner": [-2, -2, 1 + 0.5 * i]} for i in range(count)}


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("name", ["path", "reference"])
def test_light_passes_several_layers_by_the_product_of_their_transparencies(name: str, count: int) -> None:
    """Black layers before a plane that emits 1."""
    materials = {
        "veil": {"type": "diffuse", "reflectance": 0, "opacity": 0.3},
        "m": {"type": "diffuse", "reflectance": 0, "emission": 1},
    }
    of = scene({}, materials=materials, shapes={"plane": PLANE, **layers(count)}, integrator={"type": name}, lights={})
    assert close(radiance(of, spp=16384), 0.7**count)


def test_a_ray_that_meets_one_sphere_twice_decides_twice() -> None:
    materials = {"m": {"type": "diffuse", "reflectance": 0, "opacity": 0.5}}
    ball = {"type": "sphere", "material": "m", "center": [0, 0, 1]}
    of = scene({}, materials=materials, shapes={"ball": ball})
    assert close(radiance(of, spp=16384), 0.25)


@pytest.mark.parametrize(
    "light", [{"type": "point", "position": [0.3, 0.2, 9], "intensity": 100}, {"type": "constant"}]
)
def test_shadow_rays_respect_opacity(light: Table) -> None:
    """A white plane below black layers, lit through them; the viewer looks from beneath them."""
    materials = {
        "veil": {"type": "diffuse", "reflectance": 0, "opacity": 0.4},
        "m": {"type": "diffuse", "reflectance": 1},
    }
    wide = {
        name: {**layer, "corner": [-5000, -5000, layer["corner"][2]], "edge_u": [10000, 0, 0], "edge_v": [0, 10000, 0]}
        for name, layer in layers(2).items()
    }
    found = []
    for shapes in ({"plane": PLANE}, {"plane": PLANE, **wide}):
        of = scene({}, materials=materials, shapes=shapes, lights={"light": light}, integrator={"type": "direct"})
        found.append(accuray.radiance(of, [[0.3, 0.2, 0.5]], DOWN, 65536, wavelengths=[550.0]))
    ratio = found[1].mean[0, 0] / found[0].mean[0, 0]
    error = np.hypot(found[0].error[0, 0], found[1].error[0, 0]) / found[0].mean[0, 0]
    assert abs(ratio - 0.36) < 5.0 * error + 1e-3


def test_opacity_can_come_from_the_alpha_of_a_picture() -> None:
    pixels = np.zeros((1, 2, 4), dtype=np.uint8)
    pixels[0, :, 3] = [255, 51]
    textures = {"t": {"type": "image", "pixels": pixels, "filter": "nearest"}}
    opacity = {"texture": "t", "channel": "alpha"}
    of = scene({"type": "diffuse", "reflectance": 0, "opacity": opacity}, textures)
    found = accuray.radiance(of, [[-5, 0, 1], [5, 0, 1]], DOWN * 2, 16384, wavelengths=[550.0])
    assert found.mean[0, 0] == 0.0
    assert abs(found.mean[1, 0] - 0.8) < 5.0 * found.error[1, 0]


def test_a_cut_out_leaves_the_background_transparent() -> None:
    small = {"film": {"width": 4, "height": 4}, "camera": {"type": "perspective", "position": [0, 0, 3]}}
    of = scene({"type": "diffuse", "opacity": 0}, lights={}, **small)
    assert not accuray.render(of, spp=4).film.sums[..., 3].any()


# --- Normal maps ----------------------------------------------------------------------------------------------------


def coded(normal: Any) -> list[list[list[float]]]:
    """A picture of one texel that holds a unit normal as colours."""
    n = np.array(normal, dtype=float)
    return [[(0.5 + 0.5 * n / np.linalg.norm(n)).tolist()]]


def tilted(azimuth: float, tilt: float) -> np.ndarray[Any, Any]:
    """Unit vector at `tilt` degrees from +z towards `azimuth` degrees from +x."""
    a, t = np.radians([azimuth, tilt])
    return np.array([np.cos(a) * np.sin(t), np.sin(a) * np.sin(t), np.cos(t)])


def mapped(normal: Any, bsdf: Table, texture: Table | None = None, **material: Any) -> accuray.Scene:
    textures = {"n": {"type": "image", "pixels": coded(normal), **(texture or {})}}
    return scene({**bsdf, "normal_map": "n", **material}, textures)


def accuray_core(of: accuray.Scene) -> Any:
    """The lowered scene, as the probe takes it."""
    from accuray import devices

    return devices.load(of).core


LAMP = {"lamp": {"type": "point", "position": [60, 40, 60], "intensity": 1e4}}


def lit(of: accuray.Scene) -> float:
    """Radiance of the plane under the lamp, straight from above."""
    lamps = scene({"type": "diffuse"}, lights=LAMP).lights
    return radiance(replace(of, lights=lamps, integrator={**of.integrator, "max_depth": 1}), spp=16)[0]


def expected_under_lamp(normal: Any) -> float:
    to_lamp = np.array([60.0, 40.0, 60.0]) - [0.3, 0.2, 0.0]
    squared = float(to_lamp @ to_lamp)
    return 1e4 / np.pi / squared * float(np.asarray(normal) @ to_lamp) / squared**0.5


WHITE = {"type": "diffuse", "reflectance": 1}


@pytest.mark.parametrize(
    ("texture", "material", "turn"),
    [
        ({}, {}, lambda n: n),
        ({}, {"normal_map_convention": "directx"}, lambda n: n * [1, -1, 1]),
        ({"uv_rotate": 90}, {}, lambda n: np.array([n[1], -n[0], n[2]])),
        ({"uv_scale": [-1, 1]}, {}, lambda n: n * [-1, 1, 1]),
        ({"uv_scale": [3, 7]}, {}, lambda n: n),
    ],
    ids=["opengl", "directx", "turned", "mirrored", "repeated"],
)
def test_a_normal_map_turns_the_surface_to_the_light(texture: Table, material: Table, turn: Any) -> None:
    """Red leans along u, green along v, whichever way the texture lies."""
    for azimuth in (0.0, 70.0, 200.0):
        normal = tilted(azimuth, 25.0)
        of = mapped(normal, WHITE, texture, **material)
        assert lit(of) == pytest.approx(expected_under_lamp(turn(normal)), rel=2e-5), azimuth


def test_the_scale_of_a_normal_map_multiplies_slopes() -> None:
    normal = tilted(30.0, 20.0)
    of = mapped(normal, WHITE, normal_map={"texture": "n", "scale": 0.5})
    half = normal * [0.5, 0.5, 1.0]
    assert lit(of) == pytest.approx(expected_under_lamp(half / np.linalg.norm(half)), rel=2e-5)


RAMP = {"type": "image", "pixels": np.arange(64.0).reshape(1, 64) / 64.0, "wrap_u": "clamp"}


@pytest.mark.parametrize(
    ("texture", "slope"),
    [
        ({"type": "gradient"}, [20 / 40, 0.0]),
        ({"type": "gradient", "uv_rotate": 90, "uv_translate": [1, 0]}, [0.0, -20 / 40]),
        ({"type": "gradient", "uv_scale": [1, 1.6], "uv_rotate": -90, "uv_translate": [-0.3, 0]}, [0.0, 1.6 * 20 / 40]),
        ({**RAMP, "uv_translate": [0.003, 0]}, [20 / 40, 0.0]),
    ],
    ids=["gradient", "turned", "scaled", "image"],
)
def test_a_bump_map_leans_the_surface_by_its_slope(texture: Table, slope: list[float]) -> None:
    """Heights rise by 20 m from one end of the texture to the other; the plane is 40 m wide."""
    bump = {"texture": "t", "scale": 2}
    of = scene({**WHITE, "bump_map": bump, "bump_height": 10}, {"t": texture})
    normal = np.array([-slope[0], -slope[1], 1.0])
    assert lit(of) == pytest.approx(expected_under_lamp(normal / np.linalg.norm(normal)), rel=1e-3)


def test_bumps_keep_their_height_on_a_scaled_instance() -> None:
    """Twice as wide, half the slope; mirrored through the origin and turned to its front, the same along x."""
    for scale, slope in ((2.0, 0.25), (-1.0, 0.5)):
        shapes = {
            "plane": {**PLANE, "prototype": True},
            "copy": {
                "type": "instance", "of": "plane",
                "transform": [{"scale": scale}, {"rotate": {"axis": [0, 1, 0], "angle": 180 if scale < 0 else 0}}],
            },
        }  # fmt: skip
        of = scene({**WHITE, "bump_map": "t", "bump_height": 20}, {"t": {"type": "gradient"}}, shapes=shapes)
        normal = np.array([-slope, 0.0, 1.0])
        assert lit(of) == pytest.approx(expected_under_lamp(normal / np.linalg.norm(normal)), rel=1e-3), scale


@pytest.mark.parametrize("name", ["noise", "wood", "marble"])
def test_solid_textures_make_bumps(name: str) -> None:
    """The radiance under a lamp follows from the slopes of the texture's own values."""
    from accuray._core import probe

    texture = {"type": name, "size": 0.7, "first": [0, 0, 0], "second": [1, 1, 1]}
    of = scene({**WHITE, "bump_map": "t", "bump_height": 0.2}, {"t": texture})
    core, at, d = accuray_core(of), np.array([0.3, 0.2, 0.0]), 0.7 / 256
    points = (at + d * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])).astype(np.float32)
    h = 0.2 * probe.texture_values(core, 0, np.zeros((4, 2), dtype=np.float32), points)[:, 0].astype(float)
    normal = np.array([-(h[0] - h[1]) / (2 * d), -(h[2] - h[3]) / (2 * d), 1.0])
    assert lit(of) == pytest.approx(expected_under_lamp(normal / np.linalg.norm(normal)), rel=2e-3)


@pytest.mark.parametrize("tilt", [0.0, 20.0, 45.0, 60.0])
def test_a_leaning_normal_loses_the_light_from_below_the_surface_and_no_more(tilt: float) -> None:
    """White furnace, viewed along the normal: the cosine lobe keeps the share (1 + cos tilt) / 2 above the plane."""
    of = mapped(tilted(130.0, tilt), WHITE)
    # The mirror direction of the viewer stays above the surface, so the normal is used as it is.
    view = -tilted(130.0, 0.5 * tilt)
    assert close(radiance(of, [view], spp=16384), 0.5 * (1.0 + np.cos(np.radians(tilt))))


VIEWS = [tilted(azimuth, angle) for angle in (0.0, 40.0, 80.0, 89.0, 89.99) for azimuth in (0.0, 90.0, 180.0, 250.0)]


@pytest.mark.parametrize("tilt", [10.0, 50.0, 85.0])
def test_a_perfect_mirror_loses_nothing_from_any_view(tilt: float) -> None:
    """No mirror direction of a mapped normal points below the surface, however far the normal leans away."""
    of = mapped(tilted(0.0, tilt), {"type": "conductor", "metal": "perfect"})
    near = [0.001 * v for v in VIEWS]
    found = accuray.radiance(of, near, [-v for v in VIEWS], 4, wavelengths=[550.0])
    assert np.allclose(found.mean, 1.0, atol=1e-5)


@pytest.mark.parametrize("tilt", [30.0, 60.0, 85.0])
def test_there_are_no_black_patches_at_grazing_angles(tilt: float) -> None:
    """White furnace: never more than 1, and never less than the half that a normal at the horizon would keep."""
    of = mapped(tilted(0.0, tilt), WHITE)
    near = [0.001 * v for v in VIEWS]
    found = accuray.radiance(of, near, [-v for v in VIEWS], 4096, wavelengths=[550.0])
    assert (found.mean <= 1.0 + 5.0 * found.error + 1e-6).all()
    assert (found.mean >= 0.5 - 5.0 * found.error).all(), found.mean.ravel()


def test_interpolated_normals_make_no_black_rims_either() -> None:
    """Normals of a flat square that lean outwards by 60 degrees, seen at 80 degrees from all sides."""
    square = {
        "type": "mesh", "material": "m", "positions": [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]],
        "normals": [[-1.2, -1.2, 1], [1.2, -1.2, 1], [1.2, 1.2, 1], [-1.2, 1.2, 1]], "faces": [[0, 1, 2, 3]],
    }  # fmt: skip
    of = scene(WHITE, shapes={"square": square})
    rng = np.random.default_rng(1)
    targets = np.concatenate([rng.uniform(-8.0, 8.0, (64, 2)), np.zeros((64, 1))], axis=1)
    views = np.stack([tilted(a, 80.0) for a in rng.uniform(0.0, 360.0, 64)])
    found = accuray.radiance(of, targets + 0.1 * views, -views, 1024, wavelengths=[550.0])
    assert (found.mean >= 0.5 - 5.0 * found.error).all()
    assert (found.mean <= 1.0 + 5.0 * found.error + 1e-6).all()
