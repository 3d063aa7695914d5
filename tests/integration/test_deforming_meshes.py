"""Deforming meshes in pictures: their blur has the closed form of what moves alike, whatever traces it."""

from __future__ import annotations

import numpy as np
import pytest

import accuray
from accuray.testing import image_z_test

SHUTTER = {"shutter_open": 0.0, "shutter_close": 1.0}
DISTANCE = 10.0
HALF = 1.0


def bar(left: float, width: float = 0.2) -> list[list[float]]:
    """Corners of an upright bar across the whole view."""
    return [[left, -5, 0], [left + width, -5, 0], [left + width, 5, 0], [left, 5, 0]]


def picture(shapes, spp=512, width=64, threads=2, **more):
    """A row of pixels across x in [-1, 1] of what emits nothing before a sky of radiance 1."""
    scene = {
        "animation": SHUTTER,
        "film": {"width": width, "height": 1, "filter": {"type": "box"}},
        "camera": {
            "type": "orthographic",
            "position": [0, 0, DISTANCE],
            "look_at": [0, 0, 0],
            "height": 2 * HALF / width,
        },
        "materials": {"black": {"type": "diffuse", "reflectance": 0.0}},
        "lights": {"sky": {"type": "constant", "radiance": 1.0}},
        "shapes": shapes,
        **more,
    }
    return accuray.render(accuray.Scene.from_dict(scene), spp=spp, threads=threads)


def moving(before, after, **shape):
    keys = {"keys": [{"time": 0, "value": before}, {"time": 1, "value": after}]}
    return {"type": "mesh", "positions": keys, "faces": [[0, 1, 2, 3]], "material": "black", **shape}


def shadow(image) -> np.ndarray:
    """The share of the shutter's time in which each pixel is covered."""
    white = np.asarray(picture({}, spp=4096))[0, :, 1].mean()
    return 1.0 - np.asarray(image)[0, :, 1] / white


def trapezoid(x: np.ndarray, width: float, way: float, left: float) -> np.ndarray:
    """Share of the time in which a bar that moves from ``left`` by ``way`` covers a point."""
    return np.clip(np.minimum((x - left) / way, 1.0) - np.maximum((x - left - width) / way, 0.0), 0.0, None)


def test_a_bar_that_deforms_blurs_to_a_trapezoid():
    seen = shadow(picture({"bar": moving(bar(-0.6), bar(0.4))}, spp=4096))
    x = np.linspace(-HALF, HALF, 64 * 16, endpoint=False) + HALF / (64 * 16)
    expected = trapezoid(x, 0.2, 1.0, -0.6).reshape(64, 16).mean(axis=1)
    assert expected.max() == pytest.approx(0.2)
    np.testing.assert_allclose(seen, expected, atol=6e-3)
    plateau = expected > 0.2 - 1e-9
    assert plateau.sum() >= 20
    assert seen[plateau].mean() == pytest.approx(0.2, rel=5e-3)
    assert seen.sum() * 2 * HALF / 64 == pytest.approx(0.2, rel=5e-3)


def test_a_bar_that_only_widens_covers_its_mean():
    seen = shadow(picture({"bar": moving(bar(-0.5, 0.0001), bar(-0.5, 1.0))}, spp=4096))
    x = np.linspace(-HALF, HALF, 64, endpoint=False) + HALF / 64
    expected = np.where((x > -0.5) & (x < 0.5), 0.5 - x, 0.0)
    np.testing.assert_allclose(seen, expected, atol=5e-3)


def test_packed_and_embree_scenes_agree():
    """A deforming mesh beside one of many triangles: both are traced by Embree; without the latter so too."""
    rng = np.random.default_rng(1)
    away = (50.0 + rng.random((300, 3))).astype(np.float32)
    crowd = {"type": "mesh", "positions": away, "faces": np.arange(300).reshape(-1, 3), "material": "black"}
    alone = picture({"bar": moving(bar(-0.6), bar(0.4))})
    beside = picture({"bar": moving(bar(-0.6), bar(0.4)), "crowd": crowd})
    np.testing.assert_array_equal(np.asarray(alone), np.asarray(beside))


def test_threads_do_not_matter():
    shapes = {"bar": moving(bar(-0.6), bar(0.4))}
    one, three = (picture(shapes, spp=16, threads=threads) for threads in (1, 3))
    np.testing.assert_array_equal(np.asarray(one), np.asarray(three))


def bent(lift: float) -> tuple[np.ndarray, np.ndarray]:
    """A curved sheet and its faces; ``lift`` bends it."""
    n = 9
    u, v = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
    points = np.stack([u, v, lift * np.cos(u) * np.cos(v)], axis=-1).reshape(-1, 3)
    i = np.arange(n * n).reshape(n, n)
    quads = np.stack([i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]], axis=-1).reshape(-1, 4)
    return points.astype(np.float32), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


@pytest.mark.parametrize("shading", ["flat", "smooth"])
def test_many_stills_add_up_to_the_blur(shading):
    """The mean over stills at evenly spread times; lit from the side, so that normals count.

    Normals are interpolated between keys and renormalised, which follows a bend only from key to near-by key.
    """
    sheet = {"type": "mesh", "faces": bent(0.0)[1], "material": "grey", "shading": shading}
    lamp = {"type": "directional", "direction": [-1, 0.2, -1], "irradiance": 3.0}
    more = {"materials": {"grey": {"type": "diffuse", "reflectance": 0.7}}, "lights": {"lamp": lamp}}
    keys = {"keys": [{"time": key / 8, "value": bent(1.5 * key / 8)[0]} for key in range(9)]}
    blurred = picture({"sheet": {**sheet, "positions": keys}}, spp=2048, width=16, **more)
    times = (np.arange(64) + 0.5) / 64
    stills = [picture({"sheet": {**sheet, "positions": bent(1.5 * t)[0]}}, spp=64, width=16, **more) for t in times]
    mean = np.mean([np.asarray(still) for still in stills], axis=0)
    np.testing.assert_allclose(np.asarray(blurred), mean, rtol=0.02, atol=2e-3)


def test_path_and_reference_agree():
    sheet = {"type": "mesh", "faces": bent(0.0)[1], "material": "grey", "shading": "smooth"}
    keys = {"keys": [{"time": 0, "value": bent(0.0)[0]}, {"time": 1, "value": bent(1.5)[0]}]}
    more = {"materials": {"grey": {"type": "diffuse", "reflectance": 0.7}}}
    shapes = {"sheet": {**sheet, "positions": keys}}
    results = [picture(shapes, spp=1024, width=16, integrator={"type": name}, **more) for name in ("path", "reference")]
    (mean, error), (other, other_error) = ((np.asarray(r), r.layers["error"]) for r in results)
    assert image_z_test(mean, error, other, other_error, dof=3)


def test_the_shape_of_the_shutter_counts():
    """A bar that jumps from left to right in straight lines, seen mostly around half time."""
    ramp = {**SHUTTER, "shutter_shape": "triangle"}
    shapes = {"bar": moving(bar(-0.6), bar(0.4))}
    seen = shadow(picture(shapes, spp=4096, animation=ramp))
    assert seen[31:33].mean() > 1.5 * seen[20:23].mean()
    assert seen.sum() * 2 * HALF / 64 == pytest.approx(0.2, rel=5e-3)
