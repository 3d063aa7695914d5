"""Subdivision surfaces against closed forms: limit masks, B-splines, box splines, creases; levels change nothing."""

from __future__ import annotations

from itertools import permutations, product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from refined_shapes import CUBE, CUBE_FACES, LOWER_LOOP, cut, grid, mesh_of, missing, open_edges, scene_of, surface

import accuray

ROUNDING = 3e-7
RNG = np.random.default_rng(7)
WARPED = CUBE + RNG.normal(0.0, 0.15, CUBE.shape)


def test_the_cube_ends_where_the_limit_mask_says() -> None:
    # Halstead et al. 1993 with n = 3: (9 v + 4 (e1 + e2 + e3) + f1 + f2 + f3) / 24 = (4 + 2) / 24 in each coordinate.
    for levels in (1, 2, 4):
        mesh = surface(CUBE, CUBE_FACES, levels)
        corner = np.flatnonzero(np.abs(mesh.positions - 0.25).max(axis=1) < ROUNDING)
        assert len(corner) == 1
        assert mesh.normals is not None
        assert np.allclose(mesh.normals[corner[0]], -1 / np.sqrt(3), atol=ROUNDING)
        assert len(mesh.faces) == 12 * 4**levels
        assert open_edges(mesh) == 0


def test_the_cube_keeps_its_symmetries() -> None:
    mesh = surface(CUBE, CUBE_FACES, 3)
    middle = mesh.positions.astype(np.float64) - 0.5
    for axes, signs in product(permutations(range(3)), product((-1, 1), repeat=3)):
        assert missing(middle[:, axes] * signs + 0.5, mesh) < ROUNDING


def cubic(index: float, values: np.ndarray) -> np.ndarray:
    """A uniform cubic B-spline at a parameter that counts control points."""
    i = int(np.floor(index))
    t = index - i
    weights = np.array([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6
    return np.tensordot(weights, values[np.arange(i - 1, i + 3) % len(values)], axes=1)


def test_a_regular_grid_is_the_bicubic_b_spline() -> None:
    n = 7
    control = RNG.normal(size=(n, n, 3))
    places = np.array([[i, j] for i in range(n) for j in range(n)], dtype=np.float64)
    mesh = surface(control.reshape(-1, 3), grid(n, n), 3, uvs=places)
    assert mesh.uvs is not None
    inner = [k for k, uv in enumerate(mesh.uvs) if uv.min() >= 1 and uv.max() < n - 2]
    assert len(inner) > 500
    for k in inner:
        u, v = (float(x) for x in mesh.uvs[k])
        expected = cubic(v, np.array([cubic(u, control[:, j]) for j in range(n)]))
        assert np.allclose(mesh.positions[k], expected, atol=2e-6)


def lattice(n: int) -> tuple[np.ndarray, list[list[int]]]:
    """Vertices (n * n, 2) of equilateral triangles with edges of length 1."""
    steps = np.array([[1.0, 0.0], [0.5, np.sqrt(0.75)]])
    places = np.array([[i, j] for i in range(n) for j in range(n)], dtype=np.float64) - n // 2
    faces = [[a, a + n, a + 1] for a in range(n * n) if a % n < n - 1 and a < n * (n - 1)]
    faces += [[a + 1, a + n, a + n + 1] for a in range(n * n) if a % n < n - 1 and a < n * (n - 1)]
    return places @ steps, faces


def test_a_regular_lattice_is_the_quartic_box_spline() -> None:
    # The box spline is a density with the covariance of six segments of length 1, two along each direction of edges:
    # 1/4 in every direction. It takes cubics to cubics: x^2 to x^2 + 1/4, x^3 to x^3 + 3 x / 4.
    places, faces = lattice(11)
    x = places[:, 0]
    for heights, expected in ((x**2, lambda x: x**2 + 0.25), (x**3 / 9, lambda x: (x**3 + 0.75 * x) / 9)):
        mesh = surface(np.column_stack([places, heights]), faces, 3, "loop")
        inner = np.abs(mesh.positions[:, :2]).max(axis=1) < 2
        assert np.count_nonzero(inner) > 500
        height = expected(mesh.positions[inner, 0].astype(np.float64))
        assert np.allclose(mesh.positions[inner, 2], height, atol=2e-6)
    # Its own values at the lattice: 1/2 in the middle, 1/12 around.
    peak = surface(np.column_stack([places, np.all(places == 0, axis=1)]), faces, 1, "loop")
    at = lambda point: peak.positions[np.argmin(np.abs(peak.positions[:, :2] - point).max(axis=1)), 2]  # noqa: E731
    assert at((0, 0)) == pytest.approx(1 / 2, abs=1e-7)
    assert at((1, 0)) == pytest.approx(1 / 12, abs=1e-7)
    assert at((0.5, np.sqrt(0.75))) == pytest.approx(1 / 12, abs=1e-7)


def test_a_crease_for_ever_is_a_cubic_b_spline() -> None:
    levels = 3
    for scheme, faces in (("catmull_clark", CUBE_FACES), ("loop", cut(CUBE_FACES))):
        mesh = surface(WARPED, faces, levels, scheme, creases=LOWER_LOOP)
        curve = np.array([cubic(k / 2**levels, WARPED[[0, 1, 5, 4]]) for k in range(4 * 2**levels)])
        assert missing(curve, mesh) < ROUNDING
        # Both sides have their own normals there.
        places, count = np.unique(mesh.positions, axis=0, return_counts=True)
        assert np.count_nonzero(count == 2) == 4 * 2**levels == len(mesh.positions) - len(places)


def test_a_corner_stays() -> None:
    mesh = surface(WARPED, CUBE_FACES, 3, corners=[[2, 10]])
    assert missing(WARPED[[2]], mesh) < ROUNDING
    assert missing(WARPED[[3]], mesh) > 0.05
    # So does the corner of an open mesh, but no other vertex of its rim.
    rim = surface([[i, j, 0] for i in range(3) for j in range(3)], grid(3, 3), 3)
    assert missing(np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0]]), rim) == 0
    assert rim.normals is not None
    assert np.allclose(rim.normals, [0, 0, 1])


def test_a_fraction_of_sharpness_is_between_its_neighbours() -> None:
    def at(sharpness: float) -> np.ndarray:
        edges = [[a, b, sharpness] for a, b, _ in LOWER_LOOP]
        return surface(WARPED, CUBE_FACES, 3, creases=edges).positions.astype(np.float64)

    assert np.allclose(at(0.25), 0.75 * at(0) + 0.25 * at(1), atol=ROUNDING)
    assert np.allclose(at(1.5), 0.5 * at(1) + 0.5 * at(2), atol=ROUNDING)
    assert not np.allclose(at(1), at(2), atol=1e-3)


SEVEN = [[np.cos(k * np.pi / 3.5), np.sin(k * np.pi / 3.5), 0.0] for k in range(7)] + [[0.1, 0.2, 1.0]]
PYRAMID = [[6, 5, 4, 3, 2, 1, 0], *([k, (k + 1) % 7, 7] for k in range(7))]
CASES: list[tuple[Any, Any, str, dict[str, Any]]] = [
    (WARPED, CUBE_FACES, "catmull_clark", {}),
    (WARPED, CUBE_FACES, "catmull_clark", {"creases": LOWER_LOOP}),
    (WARPED, CUBE_FACES, "catmull_clark", {"creases": LOWER_LOOP[:1]}),
    (WARPED, CUBE_FACES, "catmull_clark", {"creases": [[a, b, 1.7] for a, b, _ in LOWER_LOOP]}),
    (WARPED, CUBE_FACES, "catmull_clark", {"corners": [[0, 10], [6, 1.2]]}),
    (WARPED, CUBE_FACES[:4], "catmull_clark", {}),
    (SEVEN, PYRAMID, "catmull_clark", {"creases": [[0, 7, 10]]}),
    (WARPED, cut(CUBE_FACES), "loop", {}),
    (WARPED, cut(CUBE_FACES), "loop", {"creases": LOWER_LOOP[:2]}),
    (WARPED, cut(CUBE_FACES[:5]), "loop", {}),
]


@pytest.mark.parametrize(("positions", "faces", "scheme", "keys"), CASES)
def test_levels_change_no_point_and_no_normal(positions: Any, faces: Any, scheme: str, keys: dict[str, Any]) -> None:
    uvs = np.asarray(positions)[:, :2] * 0.5
    coarse = surface(positions, faces, 2, scheme, uvs=uvs, **keys)
    fine = surface(positions, faces, 4, scheme, uvs=uvs, **keys)
    assert coarse.normals is not None
    assert fine.normals is not None
    assert coarse.uvs is not None
    assert fine.uvs is not None
    for point, normal, uv in zip(coarse.positions, coarse.normals, coarse.uvs, strict=True):
        same = np.flatnonzero(np.abs(fine.positions - point).max(axis=1) < ROUNDING)
        assert len(same) > 0
        assert np.abs(fine.uvs[same] - uv).max(axis=1).min() < ROUNDING
        # Corners between several faces, and the ends of creases, have normals by their neighbours.
        assert np.abs(fine.normals[same] - normal).max(axis=1).min() < 0.02


def test_normals_are_those_of_the_surface() -> None:
    mesh = surface(WARPED, CUBE_FACES, 5, creases=LOWER_LOOP)
    assert mesh.normals is not None
    corners = mesh.positions.astype(np.float64)[mesh.faces]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facets /= np.linalg.norm(facets, axis=1)[:, None]
    assert np.einsum("fi,fki->fk", facets, mesh.normals[mesh.faces]).min() > 0.99


def test_the_surface_moves_with_its_control_mesh() -> None:
    turn = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
    for scheme, faces in (("catmull_clark", CUBE_FACES), ("loop", cut(CUBE_FACES))):
        before = surface(WARPED, faces, 3, scheme, creases=LOWER_LOOP[:1], corners=[[7, 0.5]])
        after = surface(3 * WARPED @ turn + [5, -3, 1], faces, 3, scheme, creases=LOWER_LOOP[:1], corners=[[7, 0.5]])
        assert np.allclose(after.positions, 3 * before.positions @ turn + [5, -3, 1], atol=3e-6)


def test_seams_of_the_uvs_stay_closed_and_keep_their_corners() -> None:
    positions = np.array([CUBE[v] for face in CUBE_FACES for v in face])
    faces = [[4 * k + i for i in range(4)] for k in range(6)]
    uvs = [[k + x, y] for k in range(6) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    whole = surface(CUBE, CUBE_FACES, 3)
    for way in ("smooth", "linear"):
        mesh = surface(positions, faces, 3, uvs=uvs, uv_subdivision=way)
        assert open_edges(mesh) == 0
        assert missing(whole.positions.astype(np.float64), mesh) == 0
        assert mesh.uvs is not None
        for x in range(7):
            assert np.abs(mesh.uvs - [x, 1]).max(axis=1).min() == 0
    # Linear uvs lie on the grid of the halvings.
    assert np.allclose(mesh.uvs * 8, np.round(mesh.uvs * 8), atol=1e-6)


def test_edges_that_bend_become_creases() -> None:
    sharp = surface(CUBE, CUBE_FACES, 2, crease_angle=60)
    smooth = surface(CUBE, CUBE_FACES, 2, crease_angle=120)
    assert missing(CUBE, sharp) == 0
    assert missing(CUBE, smooth) > 0.2


QUADS_OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in CUBE) + "".join(
    "f " + " ".join(str(v + 1) for v in face) + "\n" for face in CUBE_FACES
)
QUADS_PLY = (
    "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
    + "".join(f"{x} {y} {z}\n" for x, y, z in CUBE)
    + "".join("4 " + " ".join(map(str, face)) + "\n" for face in CUBE_FACES)
)


@pytest.mark.parametrize(("name", "text"), [("cube.obj", QUADS_OBJ), ("cube.ply", QUADS_PLY)])
def test_polygons_of_files_are_kept(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    shape = {"type": "mesh", "file": name, "subdivision": "catmull_clark", "subdivision_levels": 3, "material": "m"}
    scene = accuray.Scene.from_dict({"materials": {"m": {"type": "diffuse"}}, "shapes": {"it": shape}}, folder=tmp_path)
    mesh = accuray.triangles(scene, "it")
    assert len(mesh.faces) == 12 * 4**3
    assert missing(surface(CUBE, CUBE_FACES, 3).positions.astype(np.float64), mesh) < ROUNDING


def test_polygons_are_part_of_the_identity() -> None:
    shape = {"type": "mesh", "positions": CUBE, "subdivision": "catmull_clark"}
    quads, triangles = (scene_of({**shape, "faces": faces}) for faces in (CUBE_FACES, cut(CUBE_FACES)))
    assert quads.identity != triangles.identity
    assert quads.identity == scene_of({**shape, "faces": np.array(CUBE_FACES)}).identity


def test_meshes_that_are_no_surfaces_have_a_rule() -> None:
    # Three sheets on one edge, two cones at one point, a triangle that disagrees about the front, a vertex twice.
    fan = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]]
    sheets = surface(fan, [[0, 1, 2], [0, 1, 3], [0, 1, 4]], 3)
    assert missing(np.array([[0.0, 0, 0], [0, 0, 1]]), sheets) < 0.2
    cones = [[0, 0, 0], *([x, y, z] for z in (1, -1) for x, y in ((1, 0), (-0.5, 0.8), (-0.5, -0.8)))]
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1], [0, 5, 4], [0, 6, 5], [0, 4, 6], [4, 5, 6]]
    for scheme in ("catmull_clark", "loop"):
        pinched = surface(cones, faces, 3, scheme)
        assert missing(np.zeros((1, 3)), pinched) == 0
        assert open_edges(pinched) == 0
    assert len(surface(fan, [[0, 1, 2], [0, 1, 3]], 2).faces) == 48
    assert len(surface(fan, [[0, 1, 1], [0, 1, 3]], 2).faces) == 24


def test_any_soup_of_polygons_gives_finite_surfaces() -> None:
    for seed in range(40):
        rng = np.random.default_rng(seed)
        points = rng.normal(size=(9, 3)).round(1 if seed % 2 else 3)
        points[0] = np.nan if seed % 5 == 0 else points[1]
        faces = [rng.permutation(9)[: rng.integers(3, 7)].tolist() for _ in range(12)]
        for scheme in ("catmull_clark", "loop"):
            mesh = surface(points, faces, 2, scheme, crease_angle=90, corners=[[3, 0.5]], uvs=np.ones((9, 2)))
            assert len(mesh.faces) > 0
            assert np.isfinite(mesh.positions).all()
            assert mesh.normals is not None
            assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"subdivision": "loop", "creases": [[0, 9, 2]]}, r"creases\[0\]\[1\]: 9 is not a vertex: allowed 0 to 7"),
        ({"subdivision": "loop", "creases": [[0, 1, 2], [0, 1.5, 2]]}, r"creases\[1\]\[1\]: 1.5 is not a vertex"),
        (
            {"subdivision": "catmull_clark", "creases": [[0, 3, 2]]},
            "creases: names vertices 0 and 3, which have no edge",
        ),
        ({"subdivision": "loop", "corners": [[1e30, 1]]}, r"corners\[0\]\[0\]"),
        ({"creases": LOWER_LOOP}, "creases: has no place here"),
        ({"subdivision": "loop", "subdivision_levels": 0}, "1 to 12 with loop"),
        ({"subdivision": "loop", "subdivision_levels": 2, "edge_length_px": 2}, "at once"),
        ({"subdivision": "loop", "subdivision_levels": 13}, "0 to 12"),
        ({"subdivision": "catmull_clark", "subdivision_levels": 12}, "201326592 triangles, about .* MB"),
        ({"subdivision": "bilinear"}, "none"),
    ],
)
def test_what_does_not_fit_is_refused(keys: dict[str, Any], words: str) -> None:
    with pytest.raises(accuray.SceneError, match=words):
        mesh_of({"type": "mesh", "positions": CUBE, "faces": CUBE_FACES, **keys})
