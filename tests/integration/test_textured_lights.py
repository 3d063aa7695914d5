"""Surfaces whose emission is a texture: colours, irradiance against quadrature, and strategies against each other."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.devices.lowering import colour_arrays

Table = dict[str, Any]
NM = 550.0
WHITE = float(colour_arrays()[1][int(NM) - 360])
"""What the colour [1, 1, 1] emits at 550 nm, W/(m^2 sr nm)."""
REFLECTANCE = 0.6
CENTRE = np.array([0.2, 0.0, -0.1])
FLOOR = {"type": "rectangle", "material": "floor", "corner": [-9, 0, 9], "edge_u": [18, 0, 0], "edge_v": [0, 0, -18]}
#: Its front looks down to the floor.
PANEL = {"type": "rectangle", "material": "lamp", "corner": [-1, 1, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}
HALF = {"type": "image", "pixels": [[1.0, 0.0]], "filter": "nearest"}
CHECKER = {"type": "checker", "first": [3.0, 3.0, 3.0], "second": [0.5, 0.5, 0.5], "uv_scale": [2, 1]}


def scene(texture: Table, shapes: Table, integrator: Table | None = None, **emission: Any) -> accuray.Scene:
    """A floor under shapes of the material `lamp`, which emits a texture and reflects nothing."""
    materials = {
        "floor": {"type": "diffuse", "reflectance": REFLECTANCE},
        "lamp": {"type": "diffuse", "reflectance": 0, "emission": {"texture": "t", **emission}},
    }
    described = {"textures": {"t": texture}, "materials": materials, "shapes": {"floor": FLOOR, **shapes}}
    return accuray.Scene.from_dict({**described, "integrator": integrator or {"type": "path"}})


def plain_emission(rgb: list[float], scale: float) -> Any:
    """An emission of one colour, as scenes describe it."""
    material = {"type": "diffuse", "emission": {"rgb": rgb, "scale": scale}}
    return accuray.Scene.from_dict({"materials": {"m": material}}).materials["m"]["emission"]


def floor_radiance(of: accuray.Scene, spp: int, seed: int = 0) -> tuple[float, float]:
    """Radiance of the floor at CENTRE and its standard error."""
    view = np.array([0.3, -1.0, 0.4])
    origin = CENTRE - 0.01 * view / np.linalg.norm(view)
    found = accuray.radiance(of, [origin], [view], spp, wavelengths=[NM], seed=seed)
    return float(found.mean[0, 0]), float(found.error[0, 0])


def panel_radiance(value: Any, n: int = 400) -> float:
    """Radiance of the floor under PANEL whose emission is value(u, v) times white, by the midpoint rule."""
    u, v = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n)
    d = np.stack([-1 + 2 * u, np.ones_like(u), -1 + 2 * v], axis=-1) - CENTRE
    squared = (d * d).sum(axis=-1)
    irradiance = (value(u, v) * d[..., 1] ** 2 / squared**2).mean() * 4.0
    return float(REFLECTANCE / math.pi * irradiance * WHITE)


def checker(u: Any, v: Any) -> Any:
    return np.where((np.floor(4 * u) % 2 == 0) == (np.floor(2 * v) % 2 == 0), 3.0, 0.5)


STRATEGIES = [{"type": "path", "strategy": s} for s in ("mis", "light", "bsdf")] + [{"type": "reference"}]


# --- What is emitted ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["rectangle", "sphere", "disk"])
def test_a_texture_of_one_grey_is_that_emission_to_the_bit(kind: str) -> None:
    shape = {
        "rectangle": PANEL,
        "sphere": {"type": "sphere", "material": "lamp", "center": [0, 1, 0], "radius": 0.5},
        "disk": {"type": "disk", "material": "lamp", "center": [0, 1, 0], "normal": [0, -1, 0]},
    }[kind]
    of = scene({"type": "checker", "first": [0.7] * 3, "second": [0.7] * 3}, {"lamp": shape}, scale=2)
    plain = scene(CHECKER, {"lamp": shape})
    plain.materials["lamp"]["emission"] = plain_emission([0.7] * 3, 2)
    assert floor_radiance(of, 64) == floor_radiance(plain, 64)


@pytest.mark.parametrize("colour", [[4.0, 1.0, 0.2], [0.02, 0.3, 0.7], [0.0, 0.0, 5.0]])
def test_a_colour_is_the_spectrum_of_that_rgb_emission(colour: list[float]) -> None:
    """At single wavelengths, seen straight on; texels above 1 too."""
    wavelengths = [430.0, 500.0, 550.0, 610.0, 690.0]
    image = {"type": "image", "pixels": np.array([[colour]], dtype=np.float32)}
    plain = scene(CHECKER, {"lamp": PANEL})
    plain.materials["lamp"]["emission"] = plain_emission(colour, 1)
    found, expected = (
        accuray.radiance(of, [[0, 0.5, 0]], [[0.1, 1, 0.2]], 4, wavelengths=wavelengths).mean
        for of in (scene(image, {"lamp": PANEL}), plain)
    )
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-7)


def test_each_point_of_a_panel_shows_its_texel() -> None:
    pixels = np.array([[0.1, 0.2], [0.4, 0.8]], dtype=np.float32)
    of = scene({"type": "image", "pixels": pixels, "filter": "nearest"}, {"lamp": PANEL}, scale=3)
    origins = [[x, 0.5, z] for z in (0.5, -0.5) for x in (-0.5, 0.5)]
    found = accuray.radiance(of, origins, [[0, 1, 0]] * 4, 1, wavelengths=[NM]).mean[:, 0]
    assert np.allclose(found, 3 * WHITE * pixels.ravel(), rtol=1e-5)


# --- What arrives ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", STRATEGIES, ids=lambda i: "-".join(i.values()))
@pytest.mark.parametrize(
    ("texture", "value"), [(HALF, lambda u, v: u < 0.5), (CHECKER, checker)], ids=["half", "checker"]
)
def test_irradiance_under_a_panel_is_that_of_quadrature(texture: Table, value: Any, integrator: Table) -> None:
    mean, error = floor_radiance(scene(texture, {"lamp": PANEL}, integrator), 1 << 16)
    expected = panel_radiance(value)
    assert error < 0.005 * expected
    assert abs(mean - expected) < 4.5 * error + 1e-4 * expected


def grid_mesh(n: int = 5, shear: float = 0.0, **more: Any) -> Table:
    """PANEL as n x n parallelograms, rectangles without shear, with its texture coordinates."""
    at = [(i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
    positions = [[-1 + 2 * u + shear * v, 1, -1 + 2 * v] for u, v in at]
    faces = [
        [(j + b) * (n + 1) + i + a for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))] for j in range(n) for i in range(n)
    ]
    return {"type": "mesh", "material": "lamp", "positions": positions, "faces": faces, "uvs": at, **more}


def test_many_triangles_give_the_light_of_their_panel() -> None:
    for shear in (0.0, 0.7):
        mesh = grid_mesh(4, shear)
        sheared = {**PANEL, "edge_v": [shear, 0, 2]}
        found = [
            floor_radiance(scene(CHECKER, {"lamp": lamp}), 1 << 15, seed) for seed, lamp in enumerate((mesh, sheared))
        ]
        assert abs(found[0][0] - found[1][0]) < 4.5 * math.hypot(found[0][1], found[1][1])


TURNED = [{"rotate": {"axis": [1, 2, 0.5], "angle": 33}}, {"scale": -0.5}, {"translate": [0.1, 0.9, 0.2]}]
BALL = {"type": "sphere", "material": "lamp", "center": [0, 1, 0], "radius": 0.4}
DISK = {"type": "disk", "material": "lamp", "center": [0.3, 1, 0], "normal": [0.2, -1, 0.1], "radius": 0.8}
RING = {"type": "torus", "material": "lamp", "center": [0, 1, 0], "segments": 8, "tube_segments": 5}
WOOD = {"type": "wood", "size": 0.2, "first": [4, 1, 0], "second": [0, 0, 0.3], "turbulence": 0}
POLES = {"type": "image", "pixels": [[0.2], [3.0]], "filter": "nearest"}


def instance(of: Table) -> Table:
    """A shape about the origin shown turned, mirrored and scaled."""
    return {"proto": {**of, "prototype": True}, "copy": {"type": "instance", "of": "proto", "transform": TURNED}}


@pytest.mark.parametrize(
    ("texture", "shapes"),
    [
        (POLES, {"ball": BALL}),
        (CHECKER, {"disk": DISK}),
        (WOOD, {"panel": PANEL}),
        (CHECKER, {"ring": RING}),
        (POLES, instance({**BALL, "center": [0, 0, 0]})),
        (CHECKER, instance({**DISK, "center": [0, 0, 0]})),
        (CHECKER, instance(grid_mesh(2, 0.3, transform={"translate": [0, -1, 0]}))),
        (HALF, {"bent": {**grid_mesh(1), "uvs": [[0.6, 0.9], [0.9, 0.6], [0.9, 0.9], [0, 0]]}}),
        (HALF, {"panel": PANEL, **instance({**BALL, "center": [0, 0, 0]})}),
    ],
    ids=["sphere", "disk", "solid", "torus", "copied-sphere", "copied-disk", "copied-mesh", "bent", "two"],
)  # fmt: skip
def test_points_chosen_on_a_lamp_emit_what_paths_meet_there(texture: Table, shapes: Table) -> None:
    """The strategy that chooses points against the one that never does; mixing both must not matter either.

    The mirrored copies of flat shapes turn their backs to the floor, which they light only if both sides emit.
    """
    for material in ({}, {"emission_sides": "both"}):
        results = []
        for seed, strategy in enumerate(("bsdf", "light", "mis")):
            of = scene(texture, shapes, {"type": "direct", "strategy": strategy})
            of.materials["lamp"].update(material)
            results.append(floor_radiance(of, 1 << 15, seed))
        truth, error = results[0]
        assert error < 0.03 * truth or (truth == 0.0 and not material)
        for mean, other in results[1:]:
            assert abs(mean - truth) <= 4.5 * math.hypot(error, other), (material, results)


def test_light_that_the_choice_of_lamps_does_not_expect_is_found_all_the_same() -> None:
    """One bright texel of 65536 beside a plain bright lamp: no point that estimates its power lies on it."""
    pixels = np.zeros((256, 256), dtype=np.float32)
    pixels[100, 77] = 3e4
    texture = {"type": "image", "pixels": pixels, "filter": "nearest"}
    tiles = grid_mesh(16, 0.001)
    mean, error = floor_radiance(scene(texture, {"tiles": tiles}, {"type": "direct", "strategy": "light"}), 1 << 19)
    at = np.array([-1 + 2 * (77 + 0.5) / 256, 1.0, -1 + 2 * (1 - (100 + 0.5) / 256)])
    d = at - CENTRE
    expected = REFLECTANCE / math.pi * WHITE * 3e4 * (2 / 256) ** 2 * d[1] ** 2 / (d @ d) ** 2
    assert error < 0.1 * expected
    assert abs(mean - expected) < 4.5 * error


@functools.cache
def lamps(share: float) -> accuray.Scene:
    """Two lamps of one material, far apart, that show the left and the right half of a picture."""
    pixels = np.array([[1.0, share]], dtype=np.float32)
    near, far = (
        {**grid_mesh(1), "uvs": [[u, v] for u, v in ((a, 0), (b, 0), (b, 1), (a, 1))]} for a, b in ((0, 0.5), (0.5, 1))
    )
    far = {**far, "transform": {"translate": [5, 0, 0]}}
    return scene({"type": "image", "pixels": pixels, "filter": "nearest"}, {"near": near, "far": far})


def test_dark_lamps_are_asked_less() -> None:
    """A lamp that is a hundred times darker gets few samples: the error under the bright one hardly grows."""
    alone = floor_radiance(scene({"type": "image", "pixels": [[1.0]]}, {"lamp": PANEL}), 1 << 12)
    assert floor_radiance(lamps(0.01), 1 << 12)[1] < 1.6 * alone[1]


# --- What a scene says ----------------------------------------------------------------------------------------------


def test_a_lamp_without_light_is_none() -> None:
    of = scene(CHECKER, {"lamp": PANEL}, scale=0)
    assert floor_radiance(of, 16) == (0.0, 0.0)


def test_a_mesh_without_coordinates_cannot_show_an_emission() -> None:
    mesh = grid_mesh(1)
    del mesh["uvs"]
    with pytest.raises(accuray.SceneError, match=r"no texture coordinates.*materials\.lamp\.emission"):
        scene(CHECKER, {"lamp": mesh})


def test_integers_of_an_emission_are_srgb() -> None:
    image = {"type": "image", "pixels": np.full((1, 1, 3), 128, dtype=np.uint8)}
    of = scene(image, {"lamp": PANEL})
    assert of.textures["t"]["color_space"] == "srgb"
    found = accuray.radiance(of, [[0, 0.5, 0]], [[0, 1, 0]], 1, wavelengths=[NM]).mean[0, 0]
    assert found == pytest.approx(((128 / 255 + 0.055) / 1.055) ** 2.4 * WHITE, rel=1e-5)
