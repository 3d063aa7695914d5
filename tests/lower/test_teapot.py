"""Newell's teapot: on its Bezier patches, tight between them, with finite normals at its poles."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")
from test_solids import area, crosses, mesh_of, scene_of

import accuray
from accuray import data

Floats = NDArray[np.float64]
HEIGHT = 3.15
LID, BOTTOM = range(20, 24), range(28, 32)
"""Patches with a pole: the first row of their control points is one point."""


def patches() -> Floats:
    """Control points (32, 4, 4, 3), +Y up and of height 1."""
    points = np.array(data.teapot()).reshape(32, 4, 4, 3)
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1) / HEIGHT


def weights(t: Floats) -> tuple[Floats, Floats]:
    """Bernstein polynomials of degree 3 and their derivatives, (n, 4), by de Casteljau's other form."""
    s = 1 - t
    values = np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=1)
    slopes = np.stack([-3 * s**2, 3 * s**2 - 6 * s * t, 6 * s * t - 3 * t**2, 3 * t**2], axis=1)
    return values, slopes


def surface(n: int) -> tuple[Floats, Floats]:
    """Points and unit normals of the patches, (32, n + 1, n + 1, 3), rows along v; without meaning at a pole."""
    value, slope = weights(np.linspace(0, 1, n + 1))
    points = np.einsum("vi,uj,kijc->kvuc", value, value, patches())
    du = np.einsum("vi,uj,kijc->kvuc", value, slope, patches())
    dv = np.einsum("vi,uj,kijc->kvuc", slope, value, patches())
    normals = np.cross(du, dv)
    with np.errstate(invalid="ignore"):
        return points, normals / np.linalg.norm(normals, axis=-1, keepdims=True)


@pytest.mark.parametrize("n", [2, 3, 16])
def test_vertices_and_normals_are_those_of_the_patches(n: int) -> None:
    mesh = mesh_of(type="teapot", segments=n)
    points, normals = surface(n)
    assert mesh.normals is not None
    assert np.abs(mesh.positions.reshape(points.shape) - points).max() < 1e-6
    made = mesh.normals.reshape(points.shape)
    assert np.isfinite(made).all()
    regular = np.ones(points.shape[:3], dtype=bool)
    regular[[*LID, *BOTTOM], 0] = False
    assert np.abs(made[regular] - normals[regular]).max() < 1e-6
    assert np.abs(np.linalg.norm(made.astype(np.float64), axis=-1) - 1).max() < 2e-7
    for pole, up in ((LID, 1.0), (BOTTOM, -1.0)):
        assert np.abs(made[pole, 0] - [0, up, 0]).max() < 1e-6


def test_the_normals_at_the_poles_are_limits() -> None:
    mesh = mesh_of(type="teapot", segments=256)
    assert mesh.normals is not None
    made = mesh.normals.reshape(32, 257, 257, 3)
    for pole in (LID, BOTTOM):
        assert np.abs(made[pole, 0] - made[pole, 1]).max() < 0.06
        assert np.abs(made[pole, 0] - made[pole, 1]).max() < 1.5 * np.abs(made[pole, 1] - made[pole, 2]).max()


def test_faces_look_outwards_and_none_is_lost() -> None:
    n = 8
    mesh = mesh_of(type="teapot", segments=n)
    assert len(mesh.faces) == 32 * 2 * n * n - 8 * n
    _, faces = crosses(mesh)
    assert mesh.normals is not None
    assert ((mesh.normals[mesh.faces].mean(axis=1) * faces).sum(axis=1) > 0).all()
    body = faces[np.isin(mesh.faces[:, 0] // (n + 1) ** 2, range(4, 12))]
    middle = mesh.positions[mesh.faces].mean(axis=1)[np.isin(mesh.faces[:, 0] // (n + 1) ** 2, range(4, 12))]
    assert ((body * (middle - [0, 0.4, 0])).sum(axis=1) > 0).all()


def test_neighbouring_patches_share_their_edges_to_the_bit() -> None:
    """Only the true borders are open: lid, rim, the ends of handle and spout, and the bottom's edge is shared."""
    n = 12
    mesh = mesh_of(type="teapot", segments=n)
    place = np.unique(mesh.positions, axis=0, return_inverse=True)[1].ravel()[mesh.faces]
    edges = np.sort(np.concatenate([place[:, [0, 1]], place[:, [1, 2]], place[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    # Lid's brim and rim's inside: 4 edges of patches each; both ends of the handle and of the spout: 2 each.
    assert np.count_nonzero(counts == 1) == (4 + 4 + 2 + 2 + 2 + 2) * n
    assert set(counts.tolist()) == {1, 2}


def test_size_and_place() -> None:
    mesh = mesh_of(type="teapot", height="63 cm", center=[1, 2, 3], segments=32)
    scale = 0.63 / HEIGHT
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    assert low == pytest.approx([1 - 3 * scale, 2, 3 - 2 * scale], abs=1e-6)
    assert high == pytest.approx([1 + 3.434 * scale, 2.63, 3 + 2 * scale], abs=1e-3)
    flat = mesh_of(type="teapot", shading="flat")
    assert flat.normals is None
    assert mesh.uvs is not None
    assert (mesh.uvs.min(), mesh.uvs.max()) == (0, 1)


def test_area_converges_in_second_order() -> None:
    areas = [area(mesh_of(type="teapot", segments=n)) for n in (8, 16, 32)]
    coarse, fine = areas[1] - areas[0], areas[2] - areas[1]
    assert coarse / fine == pytest.approx(4, rel=0.1)


def test_far_from_the_origin_the_normals_stay() -> None:
    near, far = mesh_of(type="teapot"), mesh_of(type="teapot", center=[1000, -500, 2000])
    assert np.array_equal(near.normals, far.normals)  # type: ignore[arg-type]


def test_a_teapot_renders_with_either_shading() -> None:
    for shading in ("flat", "smooth"):
        scene = scene_of(type="teapot", shading=shading, segments=4)
        image = accuray.render(scene, spp=4, crop=(220, 200, 300, 280))
        assert image.film.dropped_total == 0
