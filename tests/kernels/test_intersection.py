"""Rays and surfaces: Embree against the exhaustive intersector, watertight meshes, and no surface that meets itself."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import accuray
from accuray._core import probe
from accuray.testing import random_directions
from tests.kernels.light_cases import motion
from tests.kernels.support import SEED, FloatArray, load, rows, single

GREY = {"grey": {"type": "diffuse", "reflectance": 0.5}}
NONE = 0xFFFFFFFF
Mesh = tuple[FloatArray, NDArray[np.int64]]
Hits = dict[str, Any]


def closest(core: Any, origins: FloatArray, directions: FloatArray, exhaustive: bool = False) -> Hits:
    return dict(probe.closest(core, single(origins), single(directions), exhaustive))


def icosphere(levels: int) -> Mesh:
    """A closed mesh of 20 * 4^levels triangles on the unit sphere, wound counter-clockwise from outside."""
    g = (1.0 + 5.0**0.5) / 2.0
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    corners += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6)]
    faces += [(7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10)]
    faces += [(8, 6, 7), (9, 8, 1)]
    vertices, triangles = np.array(corners, dtype=np.float64), np.array(faces)
    for _ in range(levels):
        edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
        unique, number = np.unique(edges, axis=0, return_inverse=True)
        middles = len(vertices) + number.reshape(3, -1)
        vertices = np.concatenate([vertices, vertices[unique].sum(axis=1)])
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
        a, b, c = triangles.T
        ab, bc, ca = middles
        triangles = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles


def bumpy(levels: int, seed: int) -> Mesh:
    """A closed star-shaped mesh whose vertices lie at random distances: slanted triangles, sharp edges."""
    vertices, triangles = icosphere(levels)
    return vertices * np.random.default_rng(seed).uniform(0.7, 1.3, (len(vertices), 1)), triangles


def mesh_shape(mesh: Mesh) -> dict[str, Any]:
    vertices, triangles = mesh
    return {"type": "mesh", "positions": vertices.astype(np.float32), "faces": triangles.tolist(), "material": "grey"}


# --- Embree against the exhaustive intersector --------------------------------------------------------------------


def random_scene(seed: int, small: bool) -> dict[str, Any]:
    """Meshes, spheres and disks in a cube of half width 3; unless `small`, so many, and instances of a group besides.

    A small scene has no acceleration structure in the engine either, but an intersector of its own.
    """
    rng = np.random.default_rng(seed)

    def vec(scale: float) -> list[float]:
        return [float(x) for x in rng.uniform(-scale, scale, 3)]

    shapes: dict[str, Any] = {"near": mesh_shape(bumpy(0 if small else 1, seed))}
    for i in range(2 if small else 6):
        ball = {"type": "sphere", "center": vec(3), "radius": float(rng.uniform(0.3, 1.2)), "material": "grey"}
        disk = {
            "type": "disk",
            "center": vec(3),
            "normal": vec(1),
            "radius": float(rng.uniform(0.5, 2)),
            "material": "grey",
        }
        quad = {"type": "rectangle", "corner": vec(3), "edge_u": vec(3), "edge_v": vec(3), "material": "grey"}
        shapes |= {f"ball{i}": ball, f"disk{i}": disk, f"quad{i}": quad}
    if not small:
        shapes["part"] = {**mesh_shape(bumpy(0, seed + 1)), "prototype": True}
        shapes["stone"] = {
            "type": "sphere",
            "center": [1.2, 0, 0],
            "radius": 0.4,
            "material": "grey",
            "prototype": True,
        }
        shapes["lid"] = {"type": "disk", "center": [0, 1.3, 0], "radius": 0.5, "material": "grey", "prototype": True}
        for i, scale in enumerate((0.7, -0.5, 1.3)):
            matrix = motion(scale)
            matrix[:3, 3] = rng.uniform(-3, 3, 3)
            transform = {"matrix": [float(x) for x in matrix.ravel()]}
            shapes[f"copy{i}"] = {"type": "instance", "of": ["part", "stone", "lid"], "transform": transform}
    return {"materials": GREY, "shapes": shapes}


def toward_the_middle(count: int, seed: int, width: float) -> tuple[FloatArray, FloatArray]:
    """Rays from a cube of half width 4 to points of one of half width `width`."""
    rng = np.random.default_rng((seed, 1))
    origins = single(rng.uniform(-4, 4, (count, 3))).astype(np.float64)
    directions = rng.uniform(-width, width, (count, 3)) - origins
    return origins, np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))


@pytest.mark.parametrize("seed", range(SEED * 3, SEED * 3 + 3))
@pytest.mark.parametrize("small", [False, True], ids=["large", "small"])
def test_the_engine_finds_what_the_exhaustive_search_finds(seed: int, small: bool) -> None:
    core = load(random_scene(seed, small))
    origins, directions = toward_the_middle(20_000, seed, 2.0)
    fast, slow = closest(core, origins, directions), closest(core, origins, directions, exhaustive=True)
    hit_fast, hit_slow = fast["geometry"] != NONE, slow["geometry"] != NONE
    assert 0.2 < hit_slow.mean() < 0.95, "the scene tests nothing"
    assert np.count_nonzero(hit_fast != hit_slow) <= 1, "beyond rounding at a rim"
    both = hit_fast & hit_slow
    t, t_slow = fast["t"][both], slow["t"][both]
    same = np.abs(t - t_slow) <= 2e-6 * (4.0 + t_slow) / np.maximum(0.02, cosines(slow, directions)[both])
    assert np.count_nonzero(~same) <= 2
    for key in ("geometry", "instance", "primitive"):
        assert np.count_nonzero(fast[key][both][same] != slow[key][both][same]) <= 2, key
    assert np.median(np.linalg.norm(fast["point"] - slow["point"], axis=1)[both][same]) < 1e-6
    assert np.linalg.norm(fast["point"] - slow["point"], axis=1)[both][same].max() < 1e-3
    # A shadow ray meets something exactly where the nearest hit is not beyond it.
    free = probe.escapes(core, single(origins), single(np.zeros_like(origins)), single(directions), single(directions))
    assert np.count_nonzero((free == 1) != ~hit_fast) == 0


def cosines(hits: Hits, directions: FloatArray) -> FloatArray:
    return np.asarray(np.abs((hits["normal"] * directions).sum(axis=1)))


def test_instances_and_moved_shapes_are_met_alike() -> None:
    """The same bodies, once under a transform of their own and once as an instance of a group."""
    for scale in (1.7, -0.6):
        transform = {"matrix": [float(x) for x in motion(scale).ravel()]}
        ball = {"type": "sphere", "center": [0.2, 0.1, 0], "radius": 0.8, "material": "grey"}
        disk = {"type": "disk", "center": [0, 1.4, 0], "normal": [1, 2, 1], "radius": 0.9, "material": "grey"}
        parts = {"a": mesh_shape(bumpy(1, 5)), "b": ball, "c": disk}
        moved = load(
            {"materials": GREY, "shapes": {name: {**part, "transform": transform} for name, part in parts.items()}}
        )
        group = {name: {**part, "prototype": True} for name, part in parts.items()}
        copy = {"type": "instance", "of": list(parts), "transform": transform}
        instanced = load({"materials": GREY, "shapes": {**group, "copy": copy}})
        center = motion(scale)[:3, 3]
        origins = center + 5.0 * random_directions(5000, SEED)
        directions = center + np.random.default_rng(SEED).uniform(-0.7, 0.7, (5000, 3)) - origins
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        a, b = closest(moved, origins, directions), closest(instanced, origins, directions)
        met = (a["geometry"] != NONE) & (b["geometry"] != NONE)
        assert met.mean() > 0.5
        assert np.count_nonzero((a["geometry"] != NONE) != (b["geometry"] != NONE)) <= 2
        near = np.abs(a["t"][met] - b["t"][met]) < 1e-4 / np.maximum(0.02, cosines(a, directions)[met])
        assert np.count_nonzero(~near) <= 2
        alike = (a["normal"] * b["normal"]).sum(axis=1)[met][near] > 0.999
        assert np.count_nonzero(~alike) <= 2, "front sides stay front sides"


# --- Watertight meshes --------------------------------------------------------------------------------------------


def through_edges(mesh: Mesh, origin: FloatArray, seed: int) -> FloatArray:
    """Directions from the origin to points of every edge, and to anywhere."""
    vertices, triangles = single(mesh[0]).astype(np.float64), mesh[1]
    rng = np.random.default_rng(seed)
    edges = np.unique(np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]]), axis=1), axis=0)
    share = rng.uniform(1e-3, 1.0 - 1e-3, (8, len(edges), 1))
    on_edges = (vertices[edges[:, 0]] * share + vertices[edges[:, 1]] * (1.0 - share)).reshape(-1, 3)
    middles = 0.5 * (vertices[edges[:, 0]] + vertices[edges[:, 1]])
    targets = np.concatenate([middles, on_edges]) - origin
    anywhere = random_directions(ANYWHERE, seed)
    return np.concatenate([targets / np.linalg.norm(targets, axis=1, keepdims=True), anywhere])


#: Rays of `through_edges` to anywhere.
ANYWHERE = 100_000
#: Share of the rays aimed at an edge, to the last bit of their direction, that Embree may let pass: one can be on a
#: triangle's side by rounding, while it is outside of that triangle's box in truth.
EDGE_MISSES = 2e-6
#: Share of the rays aimed at a vertex, to the last bit of their direction, that may pass it by: see below.
VERTEX_MISSES = 0.04
each_search = pytest.mark.parametrize("search", ["embree", "packed", "exhaustive"])


def closed_mesh(search: str) -> tuple[Mesh, Any]:
    """A bumpy mesh of a size that the intersector is for."""
    mesh = bumpy({"embree": 5, "packed": 0, "exhaustive": 2}[search], SEED)
    return mesh, load({"materials": GREY, "shapes": {"rock": mesh_shape(mesh)}})


@each_search
def test_no_ray_leaves_a_closed_mesh(search: str) -> None:
    """0 misses of some 10^5 rays at the edges and anywhere; Embree may miss EDGE_MISSES of those at the edges."""
    mesh, core = closed_mesh(search)
    for origin in (np.zeros(3), np.array([0.25, -0.3, 0.2])):
        directions = through_edges(mesh, origin, SEED)[:: 8 if search == "exhaustive" else 1]
        hits = closest(core, rows(origin, len(directions)), directions, search == "exhaustive")
        missed = hits["geometry"] == NONE
        assert np.count_nonzero(missed) <= (2 if search == "embree" else 0)
        assert np.count_nonzero(missed[-ANYWHERE // 8 :]) == 0


@each_search
def test_only_rays_at_the_last_bit_of_a_vertex_pass_it_by(search: str) -> None:
    """Triangles that share a vertex each round it their own way: a ray within 10^-7 of it may be outside of them all.
    That is one ray in 10^14 for each vertex; 10^-5 beside it there is none.
    """
    mesh, core = closed_mesh(search)
    vertices = single(mesh[0]).astype(np.float64)
    spread = np.random.default_rng(SEED).normal(size=(4, len(vertices), 3))
    for distance, allowed in ((0.0, VERTEX_MISSES), (1e-5, 0.0), (1e-3, 0.0)):
        targets = (vertices + distance * spread).reshape(-1, 3)
        directions = targets / np.linalg.norm(targets, axis=1, keepdims=True)
        hits = closest(core, rows(np.zeros(3), len(directions)), directions, search == "exhaustive")
        assert np.count_nonzero(hits["geometry"] == NONE) <= allowed * len(directions), distance


@each_search
def test_no_ray_passes_between_the_triangles_of_a_grid(search: str) -> None:
    """Rays straight at the vertices and edges of a plane of triangles, where the edge functions are exactly zero."""
    n = 5 if search == "packed" else 12
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros((n + 1) ** 2)], axis=1)
    cell = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.concatenate(
        [np.stack([cell, cell + n + 1, cell + n + 2], 1), np.stack([cell, cell + n + 2, cell + 1], 1)]
    )
    core = load({"materials": GREY, "shapes": {"grid": mesh_shape((vertices, triangles))}})
    i, j = np.meshgrid(np.arange(1, 4 * n) / 4.0, np.arange(1, 4 * n) / 4.0, indexing="ij")
    origins = np.stack([i.ravel(), j.ravel(), np.full(i.size, 3.0)], axis=1)
    for direction in ([0, 0, -1], [0.25, 0, -1], [0.25, 0.25, -1], [-0.5, 0.125, -1]):
        hits = closest(core, origins, rows(np.array(direction, dtype=float), len(origins)), search == "exhaustive")
        at = origins + 3.0 * np.array(direction)
        inside = (at[:, :2] > 0.0).all(axis=1) & (at[:, :2] < n).all(axis=1)
        assert np.count_nonzero(hits["geometry"][inside] == NONE) == 0, direction


def test_a_mesh_far_from_the_origin_is_nearly_watertight() -> None:
    """At 1.5e5 radii the vertices themselves are rounded; two misses in 10^5 are allowed."""
    vertices, triangles = bumpy(4, SEED)
    offset = np.array([1.5e5, -1.5e5, 1.5e5])
    mesh = (single(vertices + offset).astype(np.float64), triangles)
    core = load({"materials": GREY, "shapes": {"rock": mesh_shape(mesh)}})
    directions = through_edges(mesh, offset, SEED)
    hits = closest(core, rows(offset, len(directions)), directions)
    assert np.count_nonzero(hits["geometry"] == NONE) <= 2e-5 * len(directions)


# --- No surface meets itself --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Body:
    """A convex body of size 1 around the origin; `closed` if it has an inside."""

    name: str
    closed: bool

    def shape(self, scale: float, center: FloatArray) -> dict[str, Any]:
        if self.name == "sphere":
            return {"type": "sphere", "center": list(center), "radius": scale, "material": "grey"}
        if self.name == "disk":
            return {"type": "disk", "center": list(center), "normal": [1, 2, -2], "radius": scale, "material": "grey"}
        mesh = icosphere(1) if self.name == "icosphere" else (BOX * [1.0, 0.6, 0.8] @ motion(1.0)[:3, :3].T, BOX_FACES)
        return mesh_shape((mesh[0] * scale + center, mesh[1]))


BOX = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
BOX_FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
BODIES = [Body("sphere", True), Body("icosphere", True), Body("box", True), Body("disk", False)]
SCALES = [1e-4, 1e-2, 1.0, 1e3, 1e6]
OFFSETS = [0.0, 1.0, 30.0, 1e3, 1e6]


def facing(normals: FloatArray, seed: int, grazing: bool) -> FloatArray:
    """Directions above each surface, every other one within a thousandth of a radian of it if `grazing`.

    The lowest are 10^-6 above it: single precision does not tell the sides of lower ones.
    """
    d = random_directions(len(normals), seed)
    flat = d - (d * normals).sum(axis=1, keepdims=True) * normals
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    height = np.abs((d * normals).sum(axis=1, keepdims=True))
    if grazing:
        height[::2] *= 1e-3
    height = np.maximum(height, 1e-6)
    return np.asarray(np.sqrt(np.maximum(0.0, 1.0 - height * height)) * flat + height * normals)


@dataclass
class SelfMeetings:
    """Shadow rays off a body: how many left it, how many of these met it again, and how many came through it."""

    tried: int = 0
    acne: int = 0
    leaks: int = 0


def self_meetings(body: Body, instanced: bool, scale: float, offset: float, count: int, seed: int) -> SelfMeetings:
    """Of `count` rays aimed at the body, those that hit it, each followed by rays to its outside and its inside."""
    center = single(offset * scale * np.array([0.6, -0.48, 0.64])).astype(np.float64)
    shapes = {"body": body.shape(scale, center)}
    if instanced:
        moved = [{"scale": scale}, {"translate": list(center)}]
        shapes = {
            "part": {**body.shape(1.0, np.zeros(3)), "prototype": True},
            "copy": {"type": "instance", "of": "part", "transform": moved},
        }
    core = load({"materials": GREY, "shapes": shapes})
    start = center + 3.0 * scale * random_directions(count, seed)
    toward = center + scale * np.random.default_rng(seed).uniform(-0.5, 0.5, (count, 3)) - start
    hits = closest(core, start, toward / np.linalg.norm(toward, axis=1, keepdims=True))
    met = hits["geometry"] != NONE
    points, errors, normals = (np.ascontiguousarray(hits[key][met]) for key in ("point", "error", "normal"))
    n = normals.astype(np.float64)
    found = SelfMeetings()
    outward = facing(n, seed + 2, grazing=True)
    for directions in [outward] if body.closed else [outward, -outward]:
        free = probe.escapes(core, points, errors, normals, single(directions))
        found.tried += len(points)
        found.acne += int(np.count_nonzero(free == 0))
    if body.closed:
        inward = -facing(n, seed + 3, grazing=False)
        found.leaks = int(np.count_nonzero(probe.escapes(core, points, errors, normals, single(inward))))
    return found


@pytest.mark.parametrize("instanced", [False, True], ids=["plain", "instanced"])
@pytest.mark.parametrize("body", BODIES, ids=lambda b: b.name)
def test_no_surface_shadows_itself_and_none_leaks(body: Body, instanced: bool) -> None:
    """Rays off a convex body to its outside leave the scene; those to its inside do not. Scales and places as B5.31."""
    found = {(s, o): self_meetings(body, instanced, s, o, 12_000, SEED) for s in SCALES for o in OFFSETS}
    assert sum(one.tried for one in found.values()) > 100_000
    assert not {at: one.acne for at, one in found.items() if one.acne}, "shadows itself"
    assert not {at: one.leaks for at, one in found.items() if one.leaks}, "lets light in"


ROOMS = [(1e-4, 0.0), (1.0, 0.0), (1.0, 1e3), (1e6, 0.0), (1.0, 1e5), (1e-4, 30.0)]


@pytest.mark.parametrize(("scale", "offset"), ROOMS)
@pytest.mark.parametrize(
    "body", [Body("box", True), Body("sphere", True), Body("icosphere", True)], ids=lambda b: b.name
)
def test_a_closed_room_in_the_light_is_black_inside(body: Body, scale: float, offset: float) -> None:
    """Not nearly: not one sample of any ray gathers anything, though the walls reflect and the sky is bright."""
    center = single(offset * scale * np.array([0.6, -0.48, 0.64])).astype(np.float64)
    scene = accuray.Scene.from_dict(
        {
            "accuray": 1,
            "materials": {"grey": {"type": "diffuse", "reflectance": 0.8}},
            "shapes": {"room": body.shape(scale, center)},
            "lights": {
                "sky": {"type": "constant", "radiance": 1000.0},
                "lamp": {"type": "point", "position": list(center + 2.0 * scale), "intensity": 1000.0 * scale**2},
            },
        }
    )
    count = 1500
    directions = random_directions(count, SEED)
    inside = accuray.radiance(scene, rows(center, count), directions, 16, seed=SEED)
    assert inside.mean.max() == 0.0
    outside = accuray.radiance(scene, center - 3.0 * scale * directions, directions, 1, seed=SEED)
    assert outside.mean.min() > 0.0


# --- The same hit every time --------------------------------------------------------------------------------------


def coincident_scene() -> dict[str, Any]:
    """The same bumpy mesh three times over, its triangles in three orders, and disks that lie in one plane."""
    vertices, triangles = bumpy(3, 11)
    shapes: dict[str, Any] = {}
    for i in range(3):
        order = np.random.default_rng(i).permutation(len(triangles))
        shapes[f"rock{i}"] = {**mesh_shape((vertices, triangles[order])), "material": f"paint{i}"}
        shapes[f"lid{i}"] = {"type": "disk", "center": [0, 1.5, 0], "radius": 2.0 - 0.3 * i, "material": f"paint{i}"}
    materials = {f"paint{i}": {"type": "diffuse", "reflectance": 0.2 + 0.3 * i} for i in range(3)}
    return {"materials": materials, "shapes": shapes, "lights": {"sky": {"type": "constant"}}}


def fingerprint() -> str:
    """Of all hits of some rays with the coincident scene, loaded anew."""
    core = load(coincident_scene())
    directions = random_directions(20_000, 3)
    hits = closest(core, 4.0 * random_directions(20_000, 4), -directions)
    inner = closest(core, rows(np.zeros(3), 20_000), directions)
    digest = hashlib.sha256()
    for found in (hits, inner):
        for key in ("t", "geometry", "primitive", "point"):
            digest.update(found[key].tobytes())
    return digest.hexdigest()


def test_coincident_triangles_are_met_alike_in_every_run_and_thread() -> None:
    """The acceleration structure must not depend on how many threads built it, nor the hit on who asks."""
    first = fingerprint()
    assert fingerprint() == first
    program = (
        "import os, sys; os.sched_setaffinity(0, [min(os.sched_getaffinity(0))]); sys.path[:0] = sys.argv[1:];"
        "from tests.kernels.test_intersection import fingerprint; print(fingerprint())"
    )
    paths = [str(Path(accuray.__file__).parents[1]), str(Path(__file__).parents[2])]
    alone = subprocess.run(
        [sys.executable, "-c", program, *paths], capture_output=True, text=True, check=False, env=dict(os.environ)
    )
    assert alone.stdout.strip() == first, alone.stderr


def test_pictures_of_coincident_surfaces_do_not_depend_on_the_threads() -> None:
    scene = accuray.Scene.from_dict({"accuray": 1, "film": {"width": 48, "height": 48}, **coincident_scene()})
    sums = [accuray.render(scene, spp=4, threads=threads).film.sums for threads in (1, 2, 5)]
    assert all(np.array_equal(sums[0], other) for other in sums[1:])
    assert sums[0].any()
