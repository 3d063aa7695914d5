"""Displacement: ways in closed form, no cracks, normals of what came out, fineness in pixels, memory bounded."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from refined_shapes import CUBE, CUBE_FACES, mesh_of, open_edges, scene_of, surface

import accuray

SQUARE = {"type": "rectangle", "corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, -1]}
RAMP = {"ramp": {"type": "gradient"}}
FULL = {"full": {"type": "gradient", "first": [1, 1, 1]}}
CLOUDS = {"clouds": {"type": "noise", "size": 0.4, "second": [1, 0.5, 2]}}
SOLIDS = [
    {"type": "cube"},
    {"type": "cylinder"},
    {"type": "torus", "tube_radius": 0.3, "segments": 24, "tube_segments": 12},
    {"type": "torus_knot", "segments": 90, "tube_segments": 8},
]


def test_a_ramp_on_a_plane_is_a_tilted_plane() -> None:
    # u runs over 2 m, so 0.5 m per unit of u is a slope of 1/4; the mid-level 0.4 stays at u = 0.4.
    keys = {"displacement": "ramp", "displacement_scale": "50 cm", "displacement_offset": 0.4, "subdivision_levels": 4}
    mesh = mesh_of({**SQUARE, **keys}, textures=RAMP)
    assert len(mesh.faces) == 2 * 4**4
    x, y, z = mesh.positions.T
    assert np.allclose(y, 0.25 * x - 0.2, atol=1e-6)
    assert (x.min(), x.max(), z.min(), z.max()) == (0, 2, -1, 0)
    assert mesh.normals is not None
    assert np.allclose(mesh.normals, np.array([-0.25, 1, 0]) / np.hypot(0.25, 1), atol=1e-6)


def test_vectors_move_in_the_space_that_is_named() -> None:
    vector = {"v": {"type": "gradient", "first": [1, 2, 3], "second": [1, 2, 3]}}
    flat = mesh_of({**SQUARE, "subdivision_levels": 2})
    moves = {"normal": [0, 1, 0], "object": [1, 2, 3], "tangent": [1, 3, -2]}
    for space, move in moves.items():
        keys = {"displacement": "v", "displacement_space": space, "displacement_scale": 0.1, "subdivision_levels": 2}
        mesh = mesh_of({**SQUARE, **keys}, textures=vector)
        assert np.allclose(mesh.positions, flat.positions + 0.1 * np.array(move), atol=1e-6)
    # A transform acts afterwards: it is the builder's.
    turned = {"transform": [{"scale": 3}], **SQUARE, **keys}
    assert np.array_equal(mesh_of(turned, textures=vector).positions, mesh.positions)


def test_a_constant_makes_a_sphere_larger() -> None:
    ball = sphere(4)
    mesh = mesh_of({**ball, "displacement": "full", "displacement_scale": 0.25}, textures=FULL)
    assert np.allclose(np.linalg.norm(mesh.positions, axis=1), 1.25, atol=1e-6)
    assert mesh.normals is not None
    assert np.einsum("ij,ij->i", mesh.normals, mesh.positions).min() > 1.25 * 0.999


def sphere(levels: int) -> dict[str, Any]:
    """The unit sphere as a mesh of 8 * 4^levels triangles."""
    octahedron = {"type": "mesh", "positions": np.vstack([np.eye(3), -np.eye(3)])}
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    mesh = mesh_of({**octahedron, "faces": faces, "subdivision_levels": levels})
    points = mesh.positions / np.linalg.norm(mesh.positions, axis=1)[:, None]
    return {"type": "mesh", "positions": points, "normals": points, "uvs": points[:, :2], "faces": mesh.faces}


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda solid: solid["type"])
@pytest.mark.parametrize("space", ["normal", "object", "tangent"])
def test_closed_solids_stay_closed(solid: dict[str, Any], space: str) -> None:
    # Hard edges have two normals and seams two uvs: without the mean over each place both would open.
    image = np.random.default_rng(1).random((5, 7, 3)).astype(np.float32)
    textures: dict[str, Any] = {**CLOUDS, "noisy": {"type": "image", "pixels": image, "wrap_u": "clamp"}}
    for texture, fineness in (("clouds", {"subdivision_levels": 2}), ("noisy", {"edge_length_px": 6})):
        keys = {"displacement": texture, "displacement_space": space, "displacement_scale": 0.1, **fineness}
        camera = {"type": "perspective", "position": [1, 2, 3]}
        film = {"width": 100, "height": 80}
        mesh = mesh_of({**solid, **keys}, textures=textures, camera=camera, film=film)
        assert open_edges(mesh) == 0
        assert len(mesh.faces) > len(mesh_of(solid).faces)


def test_subdivision_surfaces_are_displaced_from_their_limit() -> None:
    keys = {"displacement": "full", "displacement_scale": 0.125, "uvs": CUBE[:, :2]}
    plain = surface(CUBE, CUBE_FACES, 3, uvs=CUBE[:, :2])
    moved = surface_with(keys)
    assert plain.normals is not None
    assert np.allclose(moved.positions, plain.positions + 0.125 * plain.normals, atol=1e-6)
    assert open_edges(moved) == 0


def surface_with(keys: dict[str, Any]) -> accuray.Triangles:
    shape = {"type": "mesh", "positions": CUBE, "faces": CUBE_FACES, "subdivision": "catmull_clark", **keys}
    return mesh_of(shape, textures=FULL)


CAMERAS = [
    {"type": "perspective", "position": [3, 1, 4], "look_at": [0.5, 0, 0], "fov": 30},
    {"type": "orthographic", "position": [3, 1, 4], "look_at": [0.5, 0, 0], "height": 1.5},
    {"type": "pinhole_intrinsics", "position": [3, 1, 4], "look_at": [0.5, 0, 0], "fx": 300, "cx": 100, "cy": 50},
]
FILM = {"width": 160, "height": 120}


def in_picture(camera: dict[str, Any], points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pixel coordinates (N, 2) of points, and which lie in the picture; by the conventions, not by the code."""
    eye, target = np.array(camera["position"], float), np.array(camera["look_at"], float)
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross([0, 1, 0], back) / np.linalg.norm(np.cross([0, 1, 0], back))
    x, y, z = ((points.astype(float) - eye) @ np.column_stack([right, np.cross(back, right), back])).T
    width, height = FILM["width"], FILM["height"]
    if camera["type"] == "orthographic":
        scale = height / camera["height"]
        u, v = 0.5 * width + scale * x, 0.5 * height - scale * y
    elif camera["type"] == "perspective":
        scale = 0.5 * height / np.tan(np.radians(camera["fov"]) / 2)
        u, v = 0.5 * width + scale * x / -z, 0.5 * height + scale * y / z
    else:
        u = camera["cx"] + 0.5 + camera["fx"] * x / -z
        v = camera["cy"] + 0.5 - camera["fx"] * y / -z
    seen = (z < 0) & (u > 0) & (u < width) & (v > 0) & (v < height)
    return np.column_stack([u, v]), seen


def longest_edge(camera: dict[str, Any], mesh: accuray.Triangles) -> tuple[float, float]:
    """The longest edge in the picture, px, and the share of the triangles that are there."""
    pixels, seen = in_picture(camera, mesh.positions)
    ends = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    ends = ends[seen[ends].all(axis=1)]
    length = np.linalg.norm(pixels[ends[:, 0]] - pixels[ends[:, 1]], axis=1)
    return float(length.max()), float(seen[mesh.faces].all(axis=1).mean())


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda camera: camera["type"])
def test_no_edge_is_longer_than_the_bound(camera: dict[str, Any]) -> None:
    field = {"type": "rectangle", "corner": [-10, 0, 10], "edge_u": [20, 0, 0], "edge_v": [0, 0, -20]}
    displaced = {"displacement": "clouds", "displacement_scale": 0.3}
    control = {"type": "mesh", "subdivision": "catmull_clark", "positions": CUBE, "faces": CUBE_FACES}
    for shape in ({**field, **displaced}, {**field}, control, {**control, **displaced}):
        mesh = mesh_of({**shape, "edge_length_px": 5}, textures=CLOUDS, camera=camera, film=FILM)
        longest, _ = longest_edge(camera, mesh)
        assert 2 < longest <= 5 * (1 + 1e-5)
        assert open_edges(mesh) == 0 or shape["type"] == "rectangle"
    # The field is mostly out of view, and its triangles are mostly in it.
    assert longest_edge(camera, mesh_of({**field, "edge_length_px": 5}, camera=camera, film=FILM))[1] > 0.2


def test_angles_count_for_panoramas() -> None:
    camera = {"type": "panorama", "position": [0, 0, 0], "look_at": [0, 0, -1]}
    wall = {"type": "rectangle", "corner": [-1, -1, -1], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
    mesh = mesh_of({**wall, "edge_length_px": 4}, camera=camera, film={"width": 360, "height": 180})
    way = mesh.positions / np.linalg.norm(mesh.positions, axis=1)[:, None]
    edges = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    angles = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", *way[edges.T].astype(float)), -1, 1)))
    assert 2 < angles.max() < 4.001


def test_a_jump_of_the_texture_ends_the_halving() -> None:
    keys = {"displacement": "steps", "displacement_scale": 0.5, "edge_length_px": 8}
    mesh = mesh_of({**SQUARE, **keys}, textures={"steps": {"type": "checker"}}, camera=CAMERAS[0], film=FILM)
    assert 500 < len(mesh.faces) < 200_000


def test_a_camera_on_the_surface_ends_the_halving() -> None:
    camera = {"type": "perspective", "position": [1, 0, -0.5], "look_at": [1.3, -0.1, -0.6]}
    mesh = mesh_of({**SQUARE, "edge_length_px": 20}, camera=camera, film=FILM)
    assert len(mesh.faces) < 200_000


def test_too_many_triangles_are_refused_before_they_are_made() -> None:
    start = time.process_time()
    for keys, words in (
        ({"edge_length_px": 0.05}, "edge_length_px: .* at least [0-9]+ triangles, about [0-9]+ MB, .* is 20000"),
        ({"subdivision_levels": 12}, "subdivision_levels: .* 33554432 triangles, about 13422 MB"),
    ):
        with pytest.raises(accuray.SceneError, match=words):
            mesh_of({**SQUARE, **keys, "max_triangles": 20000}, camera=CAMERAS[0], film=FILM)
    assert time.process_time() - start < 20


def test_images_of_integers_are_numbers_here() -> None:
    keys = {"displacement": "map", "subdivision_levels": 1}
    texture = {"map": {"type": "image", "pixels": np.full((2, 2, 3), 51, dtype=np.uint8)}}
    assert np.allclose(mesh_of({**SQUARE, **keys}, textures=texture).positions[:, 1], 0.2, atol=1e-6)


def test_instances_show_their_displaced_prototype() -> None:
    image = accuray.render(
        accuray.Scene.from_dict(
            {
                "film": {"width": 16, "height": 16, "hide_environment": True},
                "camera": {"type": "orthographic", "position": [0, 0, 5], "look_at": [0, 0, 0], "height": 4},
                "materials": {"grey": {"type": "diffuse"}},
                "lights": {"sky": {"type": "constant"}},
                "textures": FULL,
                "shapes": {
                    "ball": {
                        **sphere(3),
                        "material": "grey",
                        "prototype": True,
                        "displacement": "full",
                        "displacement_scale": 2,
                    },
                    "copy": {"type": "instance", "of": "ball"},
                },
            }
        ),
        spp=4,
        threads=1,
    )
    assert image.film.coverage
    assert image.metadata["mesh_reports"]["ball"]["tessellated_triangles"] == 8 * 4**3
    assert float(np.asarray(image.layers["alpha"]).min()) == 1


@pytest.mark.parametrize(
    ("keys", "textures", "words"),
    [
        ({"displacement": "none"}, RAMP, "none"),
        ({"displacement": "ramp", "displacement_scale": 1e300}, RAMP, "is not finite at .* of 4 vertices"),
        ({"displacement": "full", "displacement_scale": 1e25}, FULL, "beyond 1e18 m"),
        ({"displacement": "ramp", "displacement_space": "world"}, RAMP, "normal"),
        ({"displacement": "c"}, {"c": {"type": "vertex_color"}}, "cannot come from vertex colours"),
        ({"edge_length_px": 3, "prototype": True}, {}, "prototype"),
        ({"edge_length_px": 0}, {}, "0.05"),
        ({"subdivision": "loop"}, {}, "not a known parameter of rectangle"),
    ],
)
def test_what_does_not_fit_is_refused(keys: dict[str, Any], textures: dict[str, Any], words: str) -> None:
    with pytest.raises(accuray.SceneError, match=words):
        mesh_of({**SQUARE, **keys}, textures=textures)


def test_textures_need_coordinates_of_a_mesh() -> None:
    mesh = {"type": "mesh", "positions": CUBE, "faces": CUBE_FACES}
    with pytest.raises(accuray.SceneError, match='texture coordinates, which displacement by the texture "ramp"'):
        scene_of({**mesh, "displacement": "ramp"}, textures=RAMP)
    with pytest.raises(accuray.SceneError, match="another displacement_space"):
        scene_of({**mesh, "displacement": "clouds", "displacement_space": "tangent"}, textures=CLOUDS)
