"""Cameras: every one of the list gives unit directions around its axis; each known one has its projection and lens."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import accuray
from accuray._core import probe, schema
from accuray.testing import parameter_sets, types_of
from accuray.verify import cameras
from tests.kernels.support import SEED, FloatArray, load, single, uniform

TABLES = {table["name"]: table for _, table in types_of(schema.tables(), "camera")}
WIDTH, HEIGHT = 640, 400
MIDDLE = np.array([[0.5, 0.5]])
HERE = {"position": [0, 0, 0], "look_at": [0, 0, -1]}


class Rays:
    """Origins, directions and whether light arrives, for points of film and lens (N, 2)."""

    def __init__(self, camera: dict[str, Any], film: FloatArray, lens: FloatArray | None = None) -> None:
        core = load({"film": {"width": WIDTH, "height": HEIGHT}, "camera": {**HERE, **camera}})
        lens = np.full_like(film, 0.5) if lens is None else lens
        rays = probe.camera_ray(core, single(film), single(lens))
        self.origin = rays["origin"].astype(np.float64)
        self.direction = rays["direction"].astype(np.float64)
        self.seen = rays["seen"].astype(bool)


def unit(v: FloatArray) -> FloatArray:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


# Every camera of the list.


def cases() -> list[Any]:
    return [
        pytest.param({"type": name, **values}, id=f"{name}-{i}")
        for name, table in TABLES.items()
        for i, values in enumerate(parameter_sets(table, count=48, seed=SEED))
    ]


#: Parameters that random values of others may contradict: a focus inside the focal length, say.
CONTRADICTED = {f"camera.{name}" for name in ("f_number", "focus_distance", "focus_point", "blades", "fov")}


def refused(camera: dict[str, Any]) -> bool:
    """Whether two of its random values contradict each other."""
    try:
        Rays(camera, MIDDLE)
    except accuray.SceneError as error:
        if error.key not in CONTRADICTED:
            raise
        return True
    return False


@pytest.mark.parametrize("camera", cases())
def test_directions_are_finite_unit_vectors_for_every_film_and_lens_point(camera: dict[str, Any]) -> None:
    if refused(camera):
        return
    film, lens = 1.2 * uniform(500, 2, SEED) - 0.1, uniform(500, 2, SEED + 1)
    corners = np.array([[x, y] for x in (0.0, 0.5, 1.0) for y in (0.0, 0.5, 1.0)])
    rays = Rays(camera, np.concatenate([film, corners]), np.concatenate([lens, corners]))
    assert np.isfinite(rays.origin).all()
    assert np.abs(np.linalg.norm(rays.direction, axis=1) - 1.0).max() < 4e-7


def test_contradictions_are_the_exception() -> None:
    counts = {name: [0, 0] for name in TABLES}
    for case in cases():
        camera = case.values[0]
        counts[camera["type"]][refused(camera)] += 1
    for name, (right, wrong) in counts.items():
        assert right > 0, name
        assert wrong <= (2 * right if name == "perspective" else right), f"{name}: {wrong} of {right + wrong} refused"


@pytest.mark.parametrize("name", TABLES)
def test_the_middle_of_the_picture_looks_along_the_axis(name: str) -> None:
    needed = {p["name"]: 500.0 for p in TABLES[name]["params"] if p["required"]}
    pose = {"position": [1, 2, 3], "look_at": [4, 1, -2], "up": [0.1, 1, 0.2]}
    forward = np.array([3.0, -1.0, -5.0]) / np.sqrt(35.0)
    rays = Rays({"type": name, **needed, **pose}, np.array([[0.5, 0.5], [0.5, 0.45], [0.55, 0.5]]))
    assert rays.seen.all()
    assert np.allclose(rays.direction[0], forward, atol=3e-7)
    across = np.cross(forward, pose["up"])
    where = rays.origin + 10.0 * rays.direction
    assert (where[1] - where[0]) @ np.cross(across, forward) > 0.0, "up the picture is up"
    assert (where[2] - where[0]) @ across > 0.0, "to the right is to the right"


# Projections.


def square_grid(count: int = 21) -> FloatArray:
    x = np.linspace(0.0, 1.0, count)
    return np.asarray(np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2))


def test_perspective_is_central_projection_with_shift() -> None:
    film = square_grid()
    camera = {"type": "perspective", "fov": 50, "fov_axis": "horizontal", "shift_x": 0.25, "shift_y": -0.5}
    half = np.tan(np.radians(25.0))
    x = half * (2.0 * film[:, 0] - 1.0 + 0.5)
    y = half * HEIGHT / WIDTH * (1.0 - 2.0 * film[:, 1] - 1.0)
    expected = unit(np.stack([x, y, -np.ones_like(x)], axis=1))
    assert np.allclose(Rays(camera, film).direction, expected, atol=2e-7)


def test_orthographic_rays_are_parallel_and_start_on_a_plane() -> None:
    film = square_grid()
    rays = Rays({"type": "orthographic", "height": 3.0}, film)
    assert (rays.direction == [0.0, 0.0, -1.0]).all()
    expected = np.stack([1.5 * WIDTH / HEIGHT * (2.0 * film[:, 0] - 1.0), 1.5 * (1.0 - 2.0 * film[:, 1])], axis=1)
    assert np.allclose(rays.origin[:, :2], expected, atol=1e-6)
    assert (rays.origin[:, 2] == 0.0).all()


def test_panorama_maps_longitude_and_latitude() -> None:
    film = square_grid()
    longitude, latitude = 2.0 * np.pi * (film[:, 0] - 0.5), np.pi * (0.5 - film[:, 1])
    expected = np.stack(
        [np.cos(latitude) * np.sin(longitude), np.sin(latitude), -np.cos(latitude) * np.cos(longitude)], axis=1
    )
    assert np.allclose(Rays({"type": "panorama"}, film).direction, expected, atol=4e-7)


MAPPINGS = {
    "equidistant": (lambda t: t, 360.0),
    "equisolid": (lambda t: np.sin(0.5 * t), 340.0),
    "stereographic": (lambda t: np.tan(0.5 * t), 300.0),
    "orthographic": (np.sin, 180.0),
}


@pytest.mark.parametrize("axis", ["vertical", "horizontal", "diagonal"])
@pytest.mark.parametrize("mapping", MAPPINGS)
def test_fisheye_angles_follow_the_mapping(mapping: str, axis: str) -> None:
    """The angle to the axis of each direction, put into the mapping's formula, is the distance from the middle."""
    radius, fov = MAPPINGS[mapping]
    film = square_grid(41)
    rays = Rays({"type": "fisheye", "mapping": mapping, "fov": fov, "fov_axis": axis}, film)
    diameter = {"vertical": HEIGHT, "horizontal": WIDTH, "diagonal": np.hypot(WIDTH, HEIGHT)}[axis]
    x, y = (2.0 * film[:, 0] - 1.0) * WIDTH / diameter, (1.0 - 2.0 * film[:, 1]) * HEIGHT / diameter
    distance = np.hypot(x, y)
    assert rays.seen[distance < 0.999999].all()
    assert not rays.seen[distance > 1.000001].any()
    inside = (distance < 0.999) & (distance > 0.0)
    d = rays.direction[inside]
    angle = np.arctan2(np.hypot(d[:, 0], d[:, 1]), -d[:, 2])
    assert np.allclose(radius(angle), distance[inside] * radius(np.radians(0.5 * fov)), rtol=3e-6, atol=1e-6)
    assert np.allclose(np.arctan2(d[:, 1], d[:, 0]), np.arctan2(y, x)[inside], atol=1e-5)


def test_what_no_light_reaches_is_black_with_alpha_0() -> None:
    scene = accuray.Scene.from_dict(
        {
            "film": {"width": 40, "height": 20, "filter": {"type": "box"}},
            "camera": {"type": "fisheye"},
            "lights": {"sky": {"type": "constant", "radiance": "D65"}},
        }
    )
    image = accuray.render(scene, spp=16, seed=SEED)
    assert image.film.dropped.sum() == 0
    share = image.film.sums[..., 3].sum() * image.film.step / 16.0 / 800.0
    assert share == pytest.approx(np.pi / 8.0, rel=1e-3)
    pixels = np.asarray(image)
    assert (pixels[:, :9] == 0.0).all()
    assert (pixels[5:15, 15:25] > 0.7).all()


# Intrinsics and distortion.

CALIBRATIONS: dict[str, dict[str, float]] = {
    "barrel": {"k1": -0.28, "k2": 0.07, "p1": 2e-4, "p2": 1e-5},
    "pincushion": {"k1": 0.3, "k2": 0.1},
    "rational": {"k1": 3.2, "k2": 1.1, "k3": 0.05, "k4": 3.5, "k5": 2.1, "k6": 0.3, "p1": 1e-3, "p2": -2e-3},
    "tangential": {"p1": 0.02, "p2": -0.03},
    "moustache": {"k1": -0.15, "k2": 0.25, "k3": -0.05},
}
K = {"fx": 520.0, "fy": 500.0, "cx": 310.0, "cy": 195.0}


def opencv_pixels(points: FloatArray, k: dict[str, float], c: dict[str, float]) -> FloatArray:
    """Pixels (N, 2) of points (N, 3) in OpenCV's axes: x right, y down, z ahead. From the formulas of its manual."""
    k1, k2, k3, k4, k5, k6, p1, p2 = (c.get(n, 0.0) for n in ("k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"))
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r2 = x**2 + y**2
    radial = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
    xx = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2)
    yy = y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y
    return np.stack([k["fx"] * xx + k["cx"], k["fy"] * yy + k["cy"]], axis=1)


@pytest.mark.parametrize("reach", [0.6, 1.2])
@pytest.mark.parametrize("name", CALIBRATIONS)
def test_a_point_is_seen_at_the_pixel_where_opencv_projects_it(name: str, reach: float) -> None:
    """Within the picture, and far beyond it, up to 60 degrees off the axis."""
    points = np.concatenate([reach * (2.0 * uniform(2000, 2, SEED) - 1.0), np.ones((2000, 1))], axis=1)
    pixels = opencv_pixels(points, K, CALIBRATIONS[name])
    film = (pixels + 0.5) / [WIDTH, HEIGHT]  # the middle of pixel 0 is at u = 0
    rays = Rays({"type": "pinhole_intrinsics", **K, **CALIBRATIONS[name]}, film)
    assert rays.seen.all()
    expected = unit(points * [1.0, -1.0, -1.0])
    # 1e-5 rad is 0.005 pixels here.
    assert np.abs(rays.direction - expected).max() < 1e-5


def test_undistorted_intrinsics_are_a_perspective_camera() -> None:
    film = square_grid()
    fov = 2.0 * np.degrees(np.arctan(0.5 * HEIGHT / 500.0))
    expected = Rays({"type": "perspective", "fov": fov}, film).direction
    assert np.allclose(Rays({"type": "pinhole_intrinsics", "fx": 500.0}, film).direction, expected, atol=2e-7)


def test_intrinsics_belong_to_the_resolution_that_they_were_calibrated_at() -> None:
    film = square_grid()
    half = {"fx": 260.0, "fy": 250.0, "cx": 154.75, "cy": 97.25, "image_width": WIDTH / 2, "image_height": HEIGHT / 2}
    ours = {"type": "pinhole_intrinsics", **CALIBRATIONS["barrel"]}
    assert np.allclose(Rays({**ours, **K}, film).direction, Rays({**ours, **half}, film).direction, atol=3e-7)


def test_beyond_the_fold_of_a_distortion_there_is_nothing_to_see() -> None:
    """With k1 = -1 no point appears farther out than r (1 - r^2) at r = 1/sqrt(3): 0.3849."""
    film = np.stack([np.linspace(0.5, 1.0, 400), np.full(400, 0.5)], axis=1)
    rays = Rays({"type": "pinhole_intrinsics", "fx": 640.0, "k1": -1.0}, film)
    radius = film[:, 0] - 0.5
    assert rays.seen[radius < 0.384].all()
    assert not rays.seen[radius > 0.386].any()
    angle = np.arctan2(rays.direction[:, 0], -rays.direction[:, 2])[rays.seen]
    assert (np.diff(angle) > 0.0).all()
    assert np.tan(angle.max()) == pytest.approx(1.0 / np.sqrt(3.0), rel=0.05)


# The lens.

LENS = {"type": "perspective", "focal_length": "50 mm", "film_size": "24 mm", "f_number": 2, "focus_distance": 2.0}


def test_the_rays_of_a_film_point_meet_in_the_plane_in_focus_and_fill_the_opening() -> None:
    lens = uniform(4096, 2, SEED)
    for point in ([0.5, 0.5], [0.1, 0.9]):
        rays = Rays({**LENS}, np.tile(point, (4096, 1)), lens)
        meet = rays.origin - rays.direction * (2.0 + rays.origin[:, 2:]) / rays.direction[:, 2:]
        half_height = 0.012 * 2.0 / cameras.image_distance(2.0)
        x, y = (2.0 * point[0] - 1.0) * half_height * WIDTH / HEIGHT, (1.0 - 2.0 * point[1]) * half_height
        assert np.allclose(meet, [x, y, -2.0], atol=1e-6)
        radius = np.hypot(rays.origin[:, 0], rays.origin[:, 1])
        assert radius.max() <= 0.0125 * (1 + 1e-6)
        assert np.mean(radius**2) == pytest.approx(0.0125**2 / 2.0, rel=0.03)
        assert (rays.origin[:, 2] == 0.0).all()


@pytest.mark.parametrize("blades", [3, 5, 8, 64])
def test_blades_make_a_regular_polygon_filled_evenly(blades: int) -> None:
    camera = {**HERE, "type": "perspective", "aperture_radius": 1.0, "blades": blades, "blade_rotation": 25}
    rays = Rays(camera, np.tile(MIDDLE, (20000, 1)), uniform(20000, 2, SEED))
    x, y = rays.origin[:, 0], rays.origin[:, 1]
    turned = np.mod(np.arctan2(y, x) - np.radians(25.0), 2.0 * np.pi / blades) - np.pi / blades
    apothem = np.cos(np.pi / blades)
    assert (np.hypot(x, y) * np.cos(turned)).max() <= apothem * (1.0 + 1e-5)
    second, _ = cameras.polygon_moments(blades, 1.0)
    assert np.mean(x**2 + y**2) == pytest.approx(second, rel=0.02)
    assert np.mean(x**2) == pytest.approx(second / 2.0, rel=0.04)
    per_blade = np.bincount((np.mod(np.arctan2(y, x) - np.radians(25.0), 2 * np.pi) * blades / (2 * np.pi)).astype(int))
    assert np.abs(per_blade / (20000 / blades) - 1.0).max() < 6.0 * np.sqrt(blades / 20000)


def test_focus_point_and_focus_distance_and_look_at_agree() -> None:
    film, lens = square_grid(5), uniform(25, 2, SEED)
    pose = {"type": "perspective", "aperture_radius": 0.1, "look_at": [0, 0, -3]}
    by_default = Rays(pose, film, lens)
    for focus in ({"focus_distance": 3.0}, {"focus_point": [0.7, -0.2, -3.0]}, {"focus_distance": "300 cm"}):
        assert (Rays({**pose, **focus}, film, lens).direction == by_default.direction).all()
    other = Rays({**pose, "focus_distance": 2.0}, film, lens)
    assert not np.allclose(other.direction, by_default.direction)


def test_no_aperture_is_the_pinhole_bit_for_bit() -> None:
    scene = {
        "film": {"width": 16, "height": 16},
        "lights": {"sky": {"type": "constant", "radiance": 1.0}},
        "materials": {"m": {"type": "diffuse"}},
        "shapes": {"ball": {"type": "sphere", "material": "m"}},
    }
    lensless, opened = (
        accuray.render(accuray.Scene.from_dict({**scene, "camera": {"type": "perspective", **lens}}), spp=4)
        for lens in ({}, {"aperture_radius": 0, "blades": 6, "focus_distance": 1})
    )
    assert (lensless.film.sums == opened.film.sums).all()


def test_f_number_is_the_focal_length_over_the_diameter() -> None:
    film, lens = square_grid(5), uniform(25, 2, SEED)
    by_radius = {key: value for key, value in LENS.items() if key != "f_number"} | {"aperture_radius": "12.5 mm"}
    assert (Rays(LENS, film, lens).direction == Rays(by_radius, film, lens).direction).all()


# Bad values.


@pytest.mark.parametrize(
    ("camera", "key", "message"),
    [
        ({"look_at": [0, 0, 0]}, "look_at", "where the camera stands"),
        ({"up": [0, 0, 2]}, "up", "across the view"),
        ({"up": [0, 0, 0]}, "up", "across the view"),
        ({"f_number": 2}, "f_number", "focal_length and film_size in place of fov"),
        ({**LENS, "focus_distance": "40 mm"}, "focus_distance", "0.04 m is not beyond the focal length"),
        ({**LENS, "focus_distance": "50 mm"}, "focus_distance", "allowed more than 0.05 m"),
        ({"aperture_radius": 1, "focus_point": [0, 0, 1]}, "focus_point", "behind the camera"),
        ({"aperture_radius": 1, "blades": 2}, "blades", "allowed 0, or 3 to 64"),
        ({"type": "fisheye", "mapping": "orthographic", "fov": 181}, "fov", "up to 180 deg"),
        ({"type": "fisheye", "mapping": "stereographic", "fov": 360}, "fov", "up to 359 deg"),
        ({"focus_distance": 1, "focus_point": [0, 0, -1]}, "focus_point", "at most one of"),
        ({"aperture_radius": 1, "f_number": 2}, "f_number", "exactly one of"),
        ({"type": "pinhole_intrinsics"}, "", "lacks `fx`"),
    ],
)
def test_contradictory_values_are_refused_by_name(camera: dict[str, Any], key: str, message: str) -> None:
    with pytest.raises(accuray.SceneError, match=message) as caught:
        Rays({"type": "perspective", **camera}, MIDDLE)
    assert caught.value.key == ".".join(filter(None, ["camera", key]))
