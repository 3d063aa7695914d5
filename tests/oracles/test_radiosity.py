"""The oracle itself: form factors against closed forms and ray casting, conservation laws, convergence, probes."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.stats import qmc

from .cornell import DATA, WAVELENGTHS, cornell_box, cornell_spectra, reference, solve_cornell
from .enclosure import Enclosure, Piece, without
from .form_factors import Array, Patches, Prism, clip, factors, polygon_factor
from .radiosity import Solution, direct, form_factors, macro_elements, mesh, sum_of_bounces

SURFACES = ["floor", "ceiling", "back_wall", "right_wall", "left_wall", "short_block", "tall_block"]
FACES = [f"{block}/{k}" for block in ("short_block", "tall_block") for k in range(5)]
UNIT_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def inward_box(low: float, high: float, surface: str = "outer") -> list[Piece]:
    """The six faces of a cube, seen from inside, each of them a piece of its own."""
    pieces = []
    for axis in range(3):
        for level, turn in ((low, 1), (high, -1)):
            quad = np.insert(low + (high - low) * UNIT_SQUARE[::turn], 0, level, axis=1)
            pieces.append(Piece(surface, "grey", np.roll(quad, axis, axis=1)[None]))
    return pieces


def patches(*quads: Array) -> Patches:
    """Unoccluded targets in one plane."""
    corners = np.stack(quads)
    normal = np.cross(corners[0, 1] - corners[0, 0], corners[0, 2] - corners[0, 1])
    return Patches(corners.reshape(-1, 3), np.arange(len(corners) * 4).reshape(-1, 4), normal / np.linalg.norm(normal))


def ceiling(low: float, high: float, height: float = 1.0) -> Array:
    """A square parallel to the floor that faces down."""
    return np.insert(low + (high - low) * UNIT_SQUARE, 1, height, axis=1)


@pytest.fixture(scope="module")
def coarse() -> Solution:
    return solve_cornell(1)


@pytest.fixture(scope="module")
def finer() -> Solution:
    return solve_cornell(2)


@pytest.mark.parametrize(("low", "high", "expected"), [(0.0, 1.0, 0.13853161), (-1.0, 1.0, 0.55412642)])
def test_a_parallel_square_seen_from_a_point(low: float, high: float, expected: float) -> None:
    found = factors(np.zeros((1, 3)), np.array([0.0, 1.0, 0.0]), patches(ceiling(low, high)))
    assert found == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize(
    ("point", "normal", "expected"),
    [
        ((278.0, 0.0, 279.5), (0.0, 1.0, 0.0), 0.01420696),
        ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.00627818),
        ((400.0, 0.0, 100.0), (0.0, 1.0, 0.0), 0.01069818),
        ((0.0, 274.4, 279.6), (1.0, 0.0, 0.0), 0.01406317),
    ],
)
def test_the_cornell_lamp_without_blocks(
    point: tuple[float, float, float], normal: tuple[float, float, float], expected: float
) -> None:
    lamp = next(piece for piece in cornell_box().pieces if piece.surface == "light")
    found = factors(np.array([point]), np.array(normal), patches(*lamp.quads))
    assert found == pytest.approx(expected, abs=1e-8)


def test_a_polygon_is_cut_at_the_horizon() -> None:
    sideways = np.array([1.0, 0.0, 0.0])
    whole = factors(np.zeros((1, 3)), sideways, patches(ceiling(-1.0, 1.0)))
    half = ceiling(-1.0, 1.0)
    half[:, 0] = np.maximum(half[:, 0], 0.0)
    assert whole == pytest.approx(factors(np.zeros((1, 3)), sideways, patches(half)), rel=1e-12)
    assert factors(np.zeros((1, 3)), -np.array([0.0, 1.0, 0.0]), patches(ceiling(-1.0, 1.0))) == 0.0


def test_clipping_away_everything_leaves_nothing() -> None:
    square = ceiling(-1.0, 1.0)[None]
    down, up = np.array([[0.0, -1.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
    assert polygon_factor(clip(square, down), up) == 0.0
    assert polygon_factor(clip(square, up), up) == pytest.approx(polygon_factor(square, up), rel=1e-12)


def test_unit_squares_at_unit_distance_and_with_a_common_edge() -> None:
    scene = Enclosure(inward_box(0.0, 1.0), [])
    meshes = mesh(scene, macro_elements(scene, 0.125), 1)
    matrix, areas = form_factors(meshes, order=4), meshes[0].areas
    between = np.array([areas @ block.sum(axis=1) for block in np.split(matrix[: len(areas)], 6, axis=1)])
    np.testing.assert_allclose(between[1], 0.19982490, atol=2e-8)
    np.testing.assert_allclose(between[2:], 0.20004378, atol=1e-5)
    np.testing.assert_allclose(between.sum(), 1.0, atol=1e-13)


@pytest.mark.parametrize(("albedo", "expected"), [(0.5, 2.0), (0.8, 5.0), (0.9, 10.0)])
def test_a_closed_emitting_box(albedo: float, expected: float) -> None:
    scene = Enclosure(inward_box(0.0, 1.0), [])
    matrix = form_factors(mesh(scene, macro_elements(scene, 0.5), 1))
    ones = np.ones((len(matrix), 1))
    np.testing.assert_allclose(ones + sum_of_bounces(matrix, albedo * ones, ones), expected, rtol=1e-10)


def test_a_convex_body_receives_from_its_surroundings_in_proportion_to_its_area() -> None:
    block = Prism(0.3 + 0.4 * UNIT_SQUARE, 0.3, 0.7)
    faces = [Piece("inner", "grey", block.vertices[loop][None], 0) for loop in block.faces]
    scene = Enclosure(inward_box(0.0, 1.0) + faces, [block])
    meshes = mesh(scene, macro_elements(scene, 0.1), 1)
    matrix, areas = form_factors(meshes), np.concatenate([elements.areas for elements in meshes])
    outer = np.repeat([elements.piece.surface == "outer" for elements in meshes], [len(e.areas) for e in meshes])
    np.testing.assert_allclose(matrix[~outer][:, outer].sum(axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(matrix.sum(axis=1), 1.0, atol=1e-12)
    assert areas[outer] @ matrix[outer][:, ~outer].sum(axis=1) == pytest.approx(6 * 0.4**2, rel=1e-4)


def blocked(start: Array, end: Array, prism: Prism) -> Array:
    """Whether the segments between points (n, 3) meet the inside of a prism: the slabs of all faces, by brute force."""
    normals, offsets = prism.planes
    enter, leave = np.zeros(len(start)), np.ones(len(start))
    for normal, offset in zip(normals, offsets, strict=True):
        outside, slope = start @ normal - offset, (end - start) @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -outside / slope
        enter = np.where(slope < 0.0, np.maximum(enter, crossing), enter)
        leave = np.where(slope > 0.0, np.minimum(leave, crossing), leave)
        leave = np.where((slope == 0.0) & (outside > 0.0), -1.0, leave)
    return np.asarray(leave - enter > 1e-9)


@pytest.mark.parametrize(
    ("receiver", "target"),
    [("floor", "light"), ("left_wall", "floor"), ("back_wall", "opening"), ("right_wall", "back_wall"),
     ("ceiling", "tall_block/0"), ("right_wall", "short_block/0"), ("back_wall", "short_block/4"),
     ("left_wall", "tall_block/4"), ("short_block/1", "floor"), ("tall_block/3", "right_wall"),
     ("tall_block/4", "short_block/0"), ("short_block/4", "tall_block/4"), ("tall_block/4", "left_wall")],
)  # fmt: skip
def test_visibility_agrees_with_shadow_rays(receiver: str, target: str) -> None:
    scene = cornell_box()
    seeing, seen = (scene.pieces[scene.groups()[name][0]] for name in (receiver, target))
    macros = [piece.quads if piece is seen else piece.quads[:1] for piece in scene.pieces]
    shown = next(elements.patches for elements in mesh(scene, macros, 1) if elements.piece is seen)
    points = seeing.sample(qmc.Halton(3, seed=5).random(12))
    exact = factors(points, seeing.normal, shown, seeing.block).sum(axis=0)

    estimates = np.zeros((32, len(points)))
    for batch in range(len(estimates)):
        ends = seen.sample(qmc.Sobol(3, seed=batch).random_base2(9))
        for index, point in enumerate(points):
            away = ends - point
            squared = np.sum(away**2, axis=1)
            facing = np.maximum(away @ seeing.normal, 0.0) * np.maximum(-(away @ seen.normal), 0.0)
            kernel = seen.area * facing / (np.pi * squared**2)
            for number, prism in enumerate(scene.blocks):
                if number not in (seeing.block, seen.block):
                    kernel[blocked(np.broadcast_to(point, ends.shape), ends, prism)] = 0.0
            estimates[batch, index] = kernel.mean()
    mean, error = estimates.mean(axis=0), estimates.std(axis=0, ddof=1) / np.sqrt(len(estimates))
    assert np.all(np.abs(exact - mean) <= 5.0 * error + 1e-6 * mean.max())
    assert mean.max() > 0.0
    assert np.median(error) < 0.01 * mean.mean()


def test_the_lamp_loses_what_the_box_receives() -> None:
    scene = cornell_box()
    meshes = mesh(scene, macro_elements(scene, 40.0), 1)
    light = zip(direct(scene, meshes, "light"), meshes, strict=True)
    received = sum(e.areas @ np.sum(samples * e.quadrature(4)[1], axis=1) for samples, e in light)
    assert received == pytest.approx(130.0 * 105.0, rel=2e-5)


def test_every_point_of_the_box_sees_exactly_one_hemisphere(coarse: Solution, finer: Solution) -> None:
    assert coarse.closure < 1e-11
    assert finer.closure < 1e-11


def test_form_factors_are_nearly_reciprocal(coarse: Solution, finer: Solution) -> None:
    # The rest is the Gauss rule's error for neighbours at a common edge, of every size alike.
    assert coarse.reciprocity < 0.05
    assert finer.reciprocity < 0.05


def test_two_coarse_meshes_agree(coarse: Solution, finer: Solution) -> None:
    for name in SURFACES:
        np.testing.assert_allclose(coarse.averages[name], finer.averages[name], rtol=5e-3, err_msg=name)
    for name in FACES:
        np.testing.assert_allclose(coarse.averages[name], finer.averages[name], rtol=4e-2, err_msg=name)


def test_the_stored_solution_is_reproduced(coarse: Solution, finer: Solution) -> None:
    for solution, stored in zip((coarse, finer), reference()["levels"], strict=False):
        assert solution.elements == stored["elements"]
        for name, values in stored["averages"].items():
            np.testing.assert_allclose(solution.averages[name], values, rtol=1e-6, err_msg=name)


@pytest.mark.long
def test_the_stored_fine_solution_is_reproduced() -> None:
    stored = reference()["levels"][2]
    solution = solve_cornell(stored["refinement"])
    assert solution.elements == stored["elements"]
    for name, values in stored["averages"].items():
        np.testing.assert_allclose(solution.averages[name], values, rtol=1e-6, err_msg=name)


def test_the_stored_solution_has_converged() -> None:
    stored = reference()
    coarse, fine = stored["levels"][-2:]
    for name in SURFACES:
        np.testing.assert_allclose(coarse["averages"][name], fine["averages"][name], rtol=1e-3, err_msg=name)
        np.testing.assert_allclose(fine["averages"][name], stored["limit"][name], rtol=5e-4, err_msg=name)
    for name in FACES:
        np.testing.assert_allclose(fine["averages"][name], stored["limit"][name], rtol=1e-2, err_msg=name)


def test_the_stored_spectra_are_the_data_files() -> None:
    reflectance, lamp = cornell_spectra(WAVELENGTHS)
    assert reference()["wavelengths_nm"] == WAVELENGTHS
    assert reference()["lamp_radiance"] == pytest.approx(lamp)
    assert lamp == pytest.approx([4.0, 11.8, 17.0])
    for name, values in reference()["reflectance"].items():
        assert values == pytest.approx(reflectance[name])


def test_areas_are_those_of_the_data() -> None:
    scene = cornell_box()
    derived = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))["derived_areas_mm2"]
    area = {name: sum(scene.pieces[k].area for k in numbers) for name, numbers in scene.groups().items()}
    for name in ("light", "back_wall", "right_wall", "left_wall", "short_block", "tall_block"):
        assert area[name] == pytest.approx(derived[name], rel=1e-12)
    assert area["ceiling"] == pytest.approx(derived["ceiling_minus_hole"], rel=1e-12)
    covered = area["short_block/0"] + area["tall_block/0"]
    assert area["floor"] == pytest.approx(derived["floor"] - covered, rel=1e-12)


def test_cutting_a_hole_keeps_the_winding_and_the_area() -> None:
    square = ceiling(0.0, 1.0)
    for hole in (ceiling(0.25, 0.5), ceiling(0.25, 0.5)[::-1]):
        parts = without(square, hole)
        crosses = [np.sum(np.cross(part, np.roll(part, -1, axis=0)), axis=0) / 2.0 for part in parts]
        assert all(cross[1] < 0.0 for cross in crosses)
        assert sum(crosses)[1] == pytest.approx(-1.0 + 0.0625)
    assert sum(len(part) for part in without(square, ceiling(2.0, 3.0))) == 4


def first_hits(origins: Array, directions: Array) -> tuple[list[str], Array]:
    """Surface names and distances of the nearest listed triangle along rays, one triangle after the other.

    The intersection is that of Moeller and Trumbore (1997).
    """
    data = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))["surfaces"]
    names, nearest = np.full(len(origins), "nothing", dtype=object), np.full(len(origins), np.inf)
    for name, entry in data.items():
        for quad in np.array(entry["quads"], dtype=float):
            for a, b, c in (quad[[0, 1, 2]], quad[[0, 2, 3]]):
                across = np.cross(directions, c - a)
                with np.errstate(divide="ignore", invalid="ignore"):
                    scale = 1.0 / (across @ (b - a))
                    u = np.sum(across * (origins - a), axis=1) * scale
                    turned = np.cross(origins - a, b - a)
                    v, t = np.sum(turned * directions, axis=1) * scale, turned @ (c - a) * scale
                    closer = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < nearest)
                names[closer], nearest[closer] = name, t[closer]
    return list(names), nearest


@pytest.mark.parametrize("name", [*SURFACES, *FACES, "light"])
def test_probes_look_at_their_surface_uniformly(name: str) -> None:
    scene = cornell_box()
    origins, directions = scene.probes(name, 10, seed=3)
    names, distance = first_hits(origins, directions)
    # The ceiling is listed without the lamp's hole, so that the two coincide there.
    assert set(names) <= ({"light", "ceiling"} if name == "light" else {name.partition("/")[0]})
    np.testing.assert_allclose(distance, 0.1, rtol=1e-6)
    pieces = [scene.pieces[k] for k in scene.groups()[name]]
    grids = [piece.sample(qmc.Sobol(3, seed=1).random_base2(12)).mean(axis=0) for piece in pieces]
    centroid = np.average(grids, axis=0, weights=[piece.area for piece in pieces])
    np.testing.assert_allclose((origins + 0.1 * directions).mean(axis=0), centroid, atol=1.5)
