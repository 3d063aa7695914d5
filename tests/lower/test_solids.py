"""Cubes, cylinders, tori and torus knots: closed, outward, as large as their formulas say, with exact normals."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray

Floats = NDArray[np.float64]
AXES = [(0, 1, 0), (0, -1, 0), (1, 0, 0), (0, 0, -2), (1, 2, -3)]


def scene_of(**shape: Any) -> accuray.Scene:
    shape.setdefault("material", "grey")
    grey = {"type": "diffuse", "reflectance": 0.5}
    return accuray.Scene.from_dict({"materials": {"grey": grey}, "shapes": {"it": shape}})


def mesh_of(**shape: Any) -> accuray.Triangles:
    return accuray.triangles(scene_of(**shape), "it")


def crosses(mesh: accuray.Triangles) -> tuple[Floats, Floats]:
    """Corners (M, 3, 3), and normals of twice the area (M, 3)."""
    corners = mesh.positions.astype(np.float64)[mesh.faces]
    return corners, np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def area(mesh: accuray.Triangles) -> float:
    return float(np.linalg.norm(crosses(mesh)[1], axis=1).sum() / 2)


def volume(mesh: accuray.Triangles) -> float:
    """Positive if the triangles face outwards (divergence theorem)."""
    corners, normals = crosses(mesh)
    return float((corners[:, 0] * normals).sum() / 6)


def is_closed(mesh: accuray.Triangles) -> bool:
    """Every edge runs once each way, vertices at one place taken as one."""
    place = np.unique(mesh.positions, axis=0, return_inverse=True)[1].ravel()[mesh.faces]
    edges = np.concatenate([place[:, [0, 1]], place[:, [1, 2]], place[:, [2, 0]]])
    there = {(int(a), int(b)) for a, b in edges}
    return len(there) == len(edges) and all((b, a) in there for a, b in there)


SHAPES: dict[str, dict[str, Any]] = {
    "cube": {"type": "cube", "center": [1, -2, 0.5], "size": [0.5, 2, 3]},
    "cylinder": {"type": "cylinder", "segments": 7},
    "slanted cylinder": {"type": "cylinder", "start": [1, 2, 3], "end": [-1, 1, 4], "radius": 0.3},
    "torus": {"type": "torus"},
    "coarse torus": {"type": "torus", "segments": 3, "tube_segments": 3, "axis": [1, 0, 1], "center": [5, 6, 7]},
    "trefoil": {"type": "torus_knot"},
    "knot 5, 2": {"type": "torus_knot", "p": 5, "q": 2, "tube_radius": 0.1, "axis": [1, 2, 3]},
    "ring as a knot": {"type": "torus_knot", "p": 1, "q": 1, "tube_radius": 0.1},
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_closed_outward_with_texture_coordinates(shape: dict[str, Any]) -> None:
    mesh = mesh_of(**shape)
    assert is_closed(mesh)
    assert volume(mesh) > 0
    assert mesh.uvs is not None
    assert mesh.uvs.min() == 0.0
    assert mesh.uvs.max() == 1.0
    # dp/du x dp/dv points outside where the coordinates keep the triangles' sense.
    uv = mesh.uvs[mesh.faces].astype(np.float64)
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all()


@pytest.mark.parametrize("shape", [s for s in SHAPES.values() if s["type"] != "cube"], ids=[*SHAPES][1:])
def test_normals_are_unit_and_face_outwards_and_flat_has_none(shape: dict[str, Any]) -> None:
    mesh = mesh_of(**shape)
    assert mesh.normals is not None
    assert np.abs(np.linalg.norm(mesh.normals.astype(np.float64), axis=1) - 1).max() < 2e-7
    _, faces = crosses(mesh)
    if shape.get("segments", 9) > 3:
        assert ((mesh.normals[mesh.faces] * faces[:, None, :]).sum(axis=2) > 0).all()
    flat = mesh_of(**shape, shading="flat")
    assert flat.normals is None
    assert np.array_equal(flat.positions, mesh.positions)
    assert np.array_equal(flat.faces, mesh.faces)


def test_a_cube_is_exact() -> None:
    mesh = mesh_of(**SHAPES["cube"])
    assert len(mesh.faces) == 12
    assert area(mesh) == 2 * (0.5 * 2 + 2 * 3 + 3 * 0.5)
    assert volume(mesh) == 0.5 * 2 * 3
    assert mesh.positions.min(axis=0).tolist() == [0.75, -3.0, -1.0]
    assert mesh.positions.max(axis=0).tolist() == [1.25, -1.0, 2.0]
    assert mesh.normals is None


def knot_length(p: int, q: int, radius: float, winding: float) -> float:
    """Of the centre line: the trapezoidal rule converges exponentially over a period."""
    t = np.arange(4096) * (2 * math.pi / 4096)
    return float(np.hypot(p * (radius + winding * np.cos(q * t)), q * winding).mean() * 2 * math.pi)


LENGTH = knot_length(2, 3, 1.0, 0.4)
# Area and volume by elementary geometry; those of a tube about a closed curve by Pappus's theorem for tubes.
FORMULAS: dict[str, tuple[dict[str, Any], float, float]] = {
    "cylinder": ({"type": "cylinder", "radius": 0.5}, math.pi * (2 * 0.25 + 1), math.pi * 0.25),
    "torus": ({"type": "torus", "radius": 1, "tube_radius": 0.25}, math.pi**2, math.pi**2 / 8),
    "torus_knot": ({"type": "torus_knot"}, 2 * math.pi * 0.2 * LENGTH, math.pi * 0.04 * LENGTH),
}


@pytest.mark.parametrize("name", FORMULAS)
def test_area_and_volume_converge_in_second_order(name: str) -> None:
    shape, true_area, true_volume = FORMULAS[name]
    errors = []
    for n in (32, 64, 128):
        finer = {"segments": 8 * n if name == "torus_knot" else n}
        mesh = mesh_of(**shape, **finer, **({} if name == "cylinder" else {"tube_segments": n}))
        errors.append((abs(area(mesh) / true_area - 1), abs(volume(mesh) / true_volume - 1)))
    assert max(errors[-1]) < 2e-3
    for coarse, fine in itertools.pairwise(errors):
        assert fine == pytest.approx([e / 4 for e in coarse], rel=0.1)


@pytest.mark.parametrize("axis", AXES)
def test_torus_has_the_normals_of_its_equation(axis: tuple[float, ...]) -> None:
    """(rho - R)^2 + h^2 = r^2, with h along the axis and rho from it; the gradient is the normal."""
    centre = np.array([0.5, -1.0, 2.0])
    mesh = mesh_of(type="torus", center=centre.tolist(), axis=list(axis), radius=2, tube_radius=0.5)
    along = np.array(axis) / np.linalg.norm(axis)
    p = mesh.positions.astype(np.float64) - centre
    height = p @ along
    across = p - height[:, None] * along
    rho = np.linalg.norm(across, axis=1)
    assert np.abs(np.hypot(rho - 2, height) - 0.5).max() < 1e-6
    gradient = across * ((rho - 2) / rho)[:, None] + height[:, None] * along
    assert mesh.normals is not None
    assert np.abs(gradient / 0.5 - mesh.normals).max() < 2e-6


@pytest.mark.parametrize("axis", AXES)
def test_cylinder_has_the_normals_of_its_equation(axis: tuple[float, ...]) -> None:
    start = np.array([0.5, -1.0, 2.0])
    along = np.array(axis) / np.linalg.norm(axis)
    mesh = mesh_of(type="cylinder", start=start.tolist(), end=(start + axis).tolist(), radius=0.7, caps=False)
    p = mesh.positions.astype(np.float64) - start
    across = p - (p @ along)[:, None] * along
    assert mesh.normals is not None
    assert np.abs(across / 0.7 - mesh.normals).max() < 2e-6
    assert mesh.uvs is not None
    assert np.abs(p @ along / np.linalg.norm(axis) - mesh.uvs[:, 1]).max() < 1e-6
    capped = mesh_of(type="cylinder", start=start.tolist(), end=(start + axis).tolist(), radius=0.7)
    assert capped.normals is not None
    sides = capped.normals[len(mesh.normals) :] @ along
    assert np.abs(np.abs(sides) - 1).max() < 1e-6
    assert not is_closed(mesh)
    assert is_closed(capped)


@pytest.mark.parametrize(("p", "q"), [(2, 3), (3, 2), (5, 7), (1, 4)])
def test_knot_is_a_tube_about_its_curve(p: int, q: int) -> None:
    """A vertex less the radius times its normal lies on the curve, and the normal is across the curve there."""
    n, m, tube = 720, 12, 0.03
    radii = {"radius": 1.5, "winding_radius": 0.6, "tube_radius": tube}
    mesh = mesh_of(type="torus_knot", p=p, q=q, **radii, segments=n, tube_segments=m)
    t = np.tile(np.arange(n + 1), m + 1) * (2 * math.pi / n)
    reach, turn = 1.5 + 0.6 * np.cos(q * t), np.stack([np.cos(p * t), 0 * t, -np.sin(p * t)], axis=1)
    across = np.stack([-np.sin(p * t), 0 * t, -np.cos(p * t)], axis=1)
    up = np.array([0.0, 1.0, 0.0])
    curve = reach[:, None] * turn + 0.6 * np.sin(q * t)[:, None] * up
    tangent = p * reach[:, None] * across + q * 0.6 * (np.cos(q * t)[:, None] * up - np.sin(q * t)[:, None] * turn)
    assert mesh.normals is not None
    assert np.abs(mesh.positions - tube * mesh.normals - curve).max() < 1e-6
    assert np.abs((mesh.normals * tangent).sum(axis=1)).max() < 1e-5


def test_opposite_points_are_exactly_opposite() -> None:
    """Angles are reduced without rounding, so shapes that should touch or line up do."""
    mesh = mesh_of(type="cylinder", segments=8, radius=1, caps=False)
    first = mesh.positions[:9, [0, 2]]
    assert first[[0, 2, 4, 6, 8]].tolist() == [[1, 0], [0, -1], [-1, 0], [0, 1], [1, 0]]
    assert np.array_equal(first[1], -first[5])
    assert abs(first[1, 0]) == abs(first[1, 1])


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        ({"type": "cube", "size": [1, 0, 1]}, "size"),
        ({"type": "cube", "size": 2}, "a list of 3 numbers"),
        ({"type": "cylinder", "start": [1, 2, 3], "end": [1, 2, 3]}, "start and end are the same point"),
        ({"type": "cylinder", "segments": 2}, "segments"),
        ({"type": "cylinder", "radius": -1}, "radius"),
        ({"type": "torus", "radius": 1, "tube_radius": 1}, "tube_radius must be less than radius"),
        ({"type": "torus", "axis": [0, 0, 0]}, "axis has no direction"),
        (
            {"type": "torus", "segments": 65536, "tube_segments": 65536},
            "8589934592 triangles: allowed are up to 10000000",
        ),
        ({"type": "torus", "segments": 1e9}, "segments"),
        ({"type": "torus_knot", "p": 4, "q": 6}, "common factor"),
        ({"type": "torus_knot", "winding_radius": 2}, "winding_radius must be less than radius"),
        ({"type": "torus_knot", "tube_radius": 0.9}, "tightest bend"),
        ({"type": "torus_knot", "segments": 65536, "tube_segments": 4096}, "10000000"),
        ({"type": "teapot", "segments": 65536}, "10000000"),
        ({"type": "teapot", "height": 0}, "height"),
        ({"type": "cube", "center": [1e30, 0, 0]}, "exceed 1e18 m"),
        ({"type": "torus", "center": [1e6, 1e6, 1e6], "radius": 1e-6, "tube_radius": 1e-7}, "lost in the rounding"),
        ({"type": "torus", "shading": "phong"}, "flat"),
    ],
    ids=str,
)
def test_bad_parameters_are_scene_errors(shape: dict[str, Any], message: str) -> None:
    with pytest.raises(accuray.SceneError, match=r"shapes\.it") as caught:
        mesh_of(**shape)
    assert message in str(caught.value)
    with pytest.raises(accuray.SceneError):
        accuray.render(scene_of(**shape), spp=1)


def test_triangles_are_of_shapes_that_have_some() -> None:
    pyramid = {
        "type": "mesh",
        "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        "faces": [[0, 2, 1], [0, 1, 3]],
    }
    mesh = mesh_of(**pyramid)
    assert mesh.faces.tolist() == pyramid["faces"]
    with pytest.raises(ValueError, match="is a sphere"):
        mesh_of(type="sphere")
    with pytest.raises(ValueError, match="no shape 'that': it has it"):
        accuray.triangles(scene_of(type="cube"), "that")


LIT = [name for name in SHAPES if name not in ("ring as a knot", "coarse torus")]


def glowing(shape: dict[str, Any], sides: str, reflectance: float) -> accuray.Scene:
    material = {"type": "diffuse", "reflectance": reflectance, "emission": 1, "emission_sides": sides}
    return accuray.Scene.from_dict({"materials": {"glow": material}, "shapes": {"it": shape | {"material": "glow"}}})


def places(shape: dict[str, Any]) -> tuple[Floats, Floats]:
    """Middles and outward normals of some triangles."""
    corners, normals = crosses(mesh_of(**shape))
    some = np.random.default_rng(7).integers(len(corners), size=24)
    return corners[some].mean(axis=1), normals[some] / np.linalg.norm(normals[some], axis=1)[:, None]


@pytest.mark.parametrize("name", LIT)
def test_the_outside_emits_and_the_inside_does_not(name: str) -> None:
    middles, outward = places(SHAPES[name])
    scene = glowing(SHAPES[name], "front", 0)
    for side, expected in ((1, 1.0), (-1, 0.0)):
        origins = middles + side * 1e-3 * outward
        seen = accuray.radiance(scene, origins, -side * outward, 8, wavelengths=[550.0])
        assert seen.mean.ravel().tolist() == pytest.approx([expected] * len(origins), abs=1e-5)


@pytest.mark.parametrize("name", LIT)
def test_the_inside_of_a_glowing_cavity_is_even(name: str) -> None:
    """Walls that emit 1 and reflect half show 1 / (1 - 1/2) = 2 everywhere; what leaks out of a seam is missing."""
    middles, outward = places(SHAPES[name])
    flat = {} if SHAPES[name]["type"] == "cube" else {"shading": "flat"}
    scene = glowing(SHAPES[name] | flat, "both", 0.5)
    seen = accuray.radiance(scene, middles - 1e-3 * outward, outward, 256, wavelengths=[550.0])
    pooled = float(np.sqrt(np.square(seen.error).mean() / seen.error.size))
    assert pooled < 0.005
    assert abs(float(seen.mean.mean()) - 2) < 4 * pooled


def test_prototypes_and_transforms_work() -> None:
    description = {
        "materials": {"glow": {"type": "diffuse", "reflectance": 0, "emission": 1}},
        "shapes": {
            "it": {"type": "torus", "material": "glow", "prototype": True},
            "there": {"type": "instance", "of": "it", "transform": {"scale": 2, "translate": [0, 0, -5]}},
            "mirrored": {"type": "cube", "material": "glow", "transform": {"scale": -1, "translate": [9, 0, 0]}},
        },
    }
    scene = accuray.Scene.from_dict(description)
    origins = [[0, 0, 0], [2, 0, 0], [9, 0, 3]]
    seen = accuray.radiance(scene, origins, [[0, 0, -1]] * 3, 8, wavelengths=[550.0])
    assert seen.mean.ravel().tolist() == pytest.approx([1, 1, 1], abs=1e-5)
    hole = accuray.radiance(scene, [[0, 9, -5]], [[0, -1, 0]], 8, wavelengths=[550.0])
    assert hole.mean.item() == 0
