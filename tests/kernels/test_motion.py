"""What moves: where rays meet it at each moment, that it never meets itself, and its lights' samples and densities."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import accuray
from accuray import devices
from accuray._core import probe
from accuray.devices.motion import Eye, between_keys, body_keys, camera_keys, moved
from accuray.scene.motion import Motion
from accuray.testing import blocks, random_directions
from tests.kernels.light_cases import Polygon
from tests.kernels.support import SEED, FloatArray, load, single, uniform
from tests.kernels.test_intersection import GREY, NONE, bumpy, icosphere, mesh_shape

OPEN = {"shutter_open": 0, "shutter_close": 1}
TIMES = (0.0, 0.137, 0.5, 0.731, 1.0)


def keyed(*keys: dict[str, Any]) -> dict[str, Any]:
    return {"keys": [{"time": index / (len(keys) - 1), **key} for index, key in enumerate(keys)]}


#: Moves, turns about a skew axis, and grows.
TUMBLING = keyed(
    {"translate": [-0.5, 0, 0.2], "rotate": {"axis": [1, 2, 3], "angle": 0}, "scale": 0.8},
    {"translate": [0.5, 0.3, 0], "rotate": {"axis": [1, 2, 3], "angle": 200}, "scale": 1.2},
)


def lowered(shapes: dict[str, Any], materials: Any = None, **more: Any) -> Any:
    return load({"materials": materials or GREY, "shapes": shapes, "animation": OPEN, **more})


def met(core: Any, origins: FloatArray, directions: FloatArray, time: float, exhaustive: bool = False) -> Any:
    return dict(probe.closest(core, single(origins), single(directions), exhaustive, time))


def motion(transform: dict[str, Any]) -> Motion:
    shape = {"type": "cube", "material": "grey", "transform": transform}
    scene = accuray.Scene.from_dict({"materials": GREY, "shapes": {"body": shape}, "animation": OPEN})
    found = scene.shapes["body"]["transform"]
    assert isinstance(found, Motion)
    return found


def parts() -> dict[str, Any]:
    """A mesh, a sphere and a disk, as prototypes, and two instances of them, one of which moves."""
    return {
        "rock": {**mesh_shape(bumpy(1, SEED)), "prototype": True},
        "ball": {"type": "sphere", "center": [1.3, 0, 0], "radius": 0.5, "material": "grey", "prototype": True},
        "lid": {"type": "disk", "center": [0, 1.4, 0], "radius": 0.6, "material": "grey", "prototype": True},
        "group": {"type": "instance", "of": ["rock", "ball", "lid"], "transform": TUMBLING},
        "still": {"type": "instance", "of": ["ball"], "transform": {"translate": [0, -2, 0]}},
        "alone": {
            "type": "cube",
            "material": "grey",
            "transform": keyed({"scale": [0.5, 1, 2]}, {"translate": [0, 2, 0]}),
        },
    }


@pytest.mark.parametrize("time", TIMES)
def test_the_engine_finds_what_the_exhaustive_search_finds(time: float) -> None:
    core = lowered(parts())
    rng = np.random.default_rng(SEED)
    origins = rng.uniform(-4, 4, (4000, 3))
    directions = rng.uniform(-1.5, 1.5, (4000, 3)) - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    fast, slow = met(core, origins, directions, time), met(core, origins, directions, time, exhaustive=True)
    hit = slow["geometry"] != NONE
    assert 0.3 < hit.mean() < 0.95
    assert np.count_nonzero((fast["geometry"] != NONE) != hit) <= 1
    both = hit & (fast["geometry"] != NONE)
    cosine = np.abs((slow["normal"] * directions).sum(axis=1))[both]
    near = np.abs(fast["t"] - slow["t"])[both] <= 2e-5 / np.maximum(0.02, cosine)
    assert np.count_nonzero(~near) <= 1
    for key in ("geometry", "instance", "primitive"):
        assert np.count_nonzero(fast[key][both][near] != slow[key][both][near]) <= 1, key
    # Points are where the rays meet them, whatever the body did meanwhile.
    there = origins + fast["t"][:, None] * directions
    assert np.linalg.norm(there - fast["point"], axis=1)[both].max() < 1e-4
    toward = (fast["normal"] * directions).sum(axis=1)[both]
    inside = np.linalg.norm(origins, axis=1)[both] < 3.5
    assert (toward < 0.0)[~inside].mean() > 0.9, "front sides stay front sides"


@pytest.mark.parametrize("time", TIMES)
def test_a_moving_body_never_meets_itself(time: float) -> None:
    """Rays that leave a convex body outwards: none of 20 000 may meet it again, near the origin and far from it."""
    for far, shape in [(f, s) for f in (0.0, 50.0) for s in ("mesh", "sphere")]:
        body = mesh_shape(icosphere(3)) if shape == "mesh" else {"type": "sphere", "material": "grey"}
        first, last = TUMBLING["keys"]
        way = {"keys": [{**key, "translate": [key["translate"][0] + far, 1, far]} for key in (first, last)]}
        core = lowered({"body": {**body, "transform": way}})
        outward = random_directions(20_000, SEED)
        center = motion(way).at(time)[:3, 3]
        hits = met(core, center + 5.0 * outward, -outward, time)
        assert (hits["geometry"] != NONE).all()
        leaving = random_directions(20_000, SEED + 1)
        leaving *= np.sign((leaving * hits["normal"]).sum(axis=1, keepdims=True))
        arguments = (single(hits[key]) for key in ("point", "error", "normal"))
        free = probe.escapes(core, *arguments, single(leaving), time)
        assert np.count_nonzero(free == 0) == 0, f"{shape} at {far}"
        assert np.linalg.norm(hits["error"], axis=1).max() < 1e-5 * (1.0 + far), "the bound is of no use"


@pytest.mark.parametrize("time", TIMES)
def test_no_ray_leaves_a_moving_closed_mesh(time: float) -> None:
    core = lowered({"rock": {**mesh_shape(bumpy(3, SEED)), "transform": TUMBLING}})
    inside = np.broadcast_to(motion(TUMBLING).at(time)[:3, 3], (50_000, 3))
    assert (met(core, inside, random_directions(50_000, SEED), time)["geometry"] != NONE).all()


@pytest.mark.parametrize("turns", [0.1, 0.5, 2.0])
def test_keys_follow_the_motion_as_closely_as_promised(turns: float) -> None:
    """The body is within 1e-4 of its size of where it should be, or within a tenth of a pixel, or the keys say not."""
    box = np.array([[-1.0, -0.2, -0.1], [1.0, 0.2, 0.1]])
    spinning = motion(
        keyed({"rotate": {"axis": [0, 0, 1], "turns": 0}}, {"rotate": {"axis": [0, 0, 1], "turns": turns}})
    )
    shares = np.linspace(0.0, 1.0, 3001)
    true = np.array([spinning.at(float(share)) for share in shares])
    corners = np.array([[x, y, z] for x in box[:, 0] for y in box[:, 1] for z in box[:, 2]])
    counts = []
    for pixels in (64, 100_000):
        camera = {"type": "orthographic", "height": 3.0, "position": (0, 0, 5), "transform": None}
        keys = body_keys(spinning, box, Eye(camera, {"width": pixels, "height": pixels}))
        counts.append(len(keys.rows))
        matrices = np.zeros((len(keys.rows), 4, 4))
        matrices[:, :3] = keys.rows.reshape(-1, 3, 4)
        matrices[:, 3, 3] = 1.0
        apart = moved(true, corners) - moved(between_keys(matrices, shares), corners)
        worst = np.linalg.norm(apart, axis=2).max()
        size = np.linalg.norm(box[1] - box[0])
        allowed = max(1e-4 * size, 0.1 * 3.0 / pixels)
        assert worst <= 1.01 * max(allowed, keys.error * size)
        assert (keys.error > 0.0) == (worst > allowed)
    assert counts[0] < counts[1] <= 129


def test_a_straight_motion_takes_two_keys_and_one_that_bends_a_key_there() -> None:
    eye = Eye(
        {"type": "orthographic", "height": 3.0, "position": (0, 0, 5), "transform": None}, {"width": 9, "height": 9}
    )
    box = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    assert len(body_keys(motion(keyed({}, {"translate": [1, 2, 3], "scale": 2})), box, eye).rows) == 2
    bent = motion({"keys": [{"time": 0}, {"time": 0.3, "translate": [30, 0, 0]}, {"time": 1}]})
    assert len(body_keys(bent, box, eye).rows) == 11


def test_a_turn_that_no_keys_can_follow_is_refused_and_a_close_one_reported() -> None:
    def drawn(turns: float, size: int) -> Any:
        keys = keyed({"rotate": {"axis": [0, 1, 0], "turns": 0}}, {"rotate": {"axis": [0, 1, 0], "turns": turns}})
        shape = {"type": "cube", "material": "grey", "transform": keys}
        film = {"width": size, "height": size}
        return accuray.Scene.from_dict({"materials": GREY, "shapes": {"body": shape}, "animation": OPEN, "film": film})

    assert devices.load(drawn(2.0, 64)).reports == {}
    assert 0.0 < devices.load(drawn(2.0, 4096)).reports["body"]["motion_error"] < 1e-2
    for turns in (128.0, 256.0, 500.0):
        with pytest.raises(accuray.SceneError, match="straight segments") as caught:
            devices.load(drawn(turns, 64))
        assert caught.value.key == "shapes.body.transform"


# --- Lights -------------------------------------------------------------------------------------------------------

LAMP = {"lamp": {"type": "diffuse", "reflectance": 0, "emission": 1.0, "emission_sides": "both"}}
SQUARE = np.array([[-1.0, -0.5, 0.0], [1.0, -0.5, 0.0], [1.0, 0.5, 0.0], [-1.0, 0.5, 0.0]])
LIGHTS: dict[str, dict[str, Any]] = {
    "quad": {"type": "rectangle", "corner": [-1, -0.5, 0], "edge_u": [2, 0, 0], "edge_v": [0, 1, 0]},
    "triangle": {"type": "mesh", "positions": SQUARE[:3].astype(np.float32), "faces": [[0, 1, 2]]},
    "sphere": {"type": "sphere", "radius": 0.7},
    "disk": {"type": "disk", "normal": [0, 0, 1], "radius": 0.7},
}


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("kind", LIGHTS)
def test_samples_of_a_moving_light_have_the_density_of_the_light_met(kind: str, time: float) -> None:
    core = lowered({"lamp": {**LIGHTS[kind], "material": "lamp", "transform": TUMBLING}}, LAMP)
    assert probe.light_names(core) == [kind]
    for distance in (0.3, 2.0, 20.0):
        reference = motion(TUMBLING).at(time)[:3, 3] + distance * np.array([0.48, -0.6, 0.64])
        s = probe.light_sample(core, 0, reference.tolist(), single(uniform(2048, 2, SEED)), time)
        # A sphere that is sampled by area hides its own far side.
        near = met(core, np.broadcast_to(reference, s["wi"].shape), s["wi"], time)
        seen = (s["pdf"] > 0) & (np.abs(near["t"] - s["distance"]) < 1e-3 * s["distance"])
        assert seen.mean() > (0.05 if kind == "sphere" else 0.98)
        assert np.linalg.norm(s["point"] - reference, axis=1) == pytest.approx(s["distance"], rel=1e-4)
        pdf = probe.light_pdf(core, 0, reference.tolist(), single(s["wi"]), time)
        assert pdf[seen] == pytest.approx(s["pdf"][seen], rel=2e-3)


@pytest.mark.parametrize("kind", ["quad", "triangle"])
def test_the_densities_of_a_moving_light_sum_to_its_solid_angle(kind: str) -> None:
    """Even where the placement is no rotation: halfway between keys that are far apart."""
    corners = SQUARE if kind == "quad" else SQUARE[:3]
    turning = keyed({"rotate": {"axis": [0, 1, 0], "angle": 0}}, {"rotate": {"axis": [0, 1, 0], "angle": 40}})
    film = {"width": 1, "height": 1}  # so coarse that one segment will do
    camera = {"type": "orthographic", "height": 1000}
    shapes = {"lamp": {**LIGHTS[kind], "material": "lamp", "transform": turning}}
    core = lowered(shapes, LAMP, film=film, camera=camera)
    halfway = 0.5 * (motion(turning).at(0.0) + motion(turning).at(1.0))
    assert np.linalg.det(halfway) < 0.95
    polygon = Polygon(moved(halfway[None], corners)[0])
    for distance in (0.5, 3.0, 30.0):
        reference = distance * np.array([0.48, -0.36, 0.8])
        s = probe.light_sample(core, 0, reference.tolist(), single(uniform(1 << 16, 2, SEED)), 0.5)
        inverse = 1.0 / s["pdf"].astype(np.float64)
        error = inverse.std() / math.sqrt(len(inverse))
        truth = polygon.solid_angle(reference)
        assert abs(inverse.mean() - truth) < 4.0 * error + 1e-4 * truth
        assert polygon.off(s["point"].astype(np.float64), reference).max() < 1e-5 * (1.0 + distance)


def test_a_moving_lamp_may_be_chosen_wherever_it_ever_is() -> None:
    """Conservative bounds: no time at which a lamp shines on a point may have the probability 0."""
    shapes = {
        "turning": {**LIGHTS["disk"], "material": "lamp", "transform": TUMBLING},
        "flying": {**LIGHTS["quad"], "material": "lamp", "transform": keyed({}, {"translate": [0, 0, 9]})},
        "still": {**LIGHTS["sphere"], "material": "lamp", "transform": {"translate": [3, 0, 0]}},
    }
    material = {"lamp": {**LAMP["lamp"], "emission_sides": "front"}}
    core = lowered(shapes, material)
    points = np.random.default_rng(SEED).uniform(-6, 12, (300, 3))
    normals = random_directions(300, SEED)
    chosen = probe.choice_probabilities(core, single(points), single(normals))
    assert chosen.sum(axis=1) == pytest.approx(np.ones(300), abs=1e-5)
    for light in range(3):
        for point, normal, probability in zip(points, normals, chosen[:, light], strict=True):
            for time in (0.0, 0.5, 1.0):
                s = probe.light_sample(core, light, point.tolist(), single(uniform(8, 2, SEED)), time)
                arrives = (s["scale"] > 0) & (s["wi"] @ normal > 0) & (s["pdf"] > 0)
                assert probability > 0.0 or not arrives.any()


# --- Cameras ------------------------------------------------------------------------------------------------------

FRAME = {"width": 24, "height": 24, "filter": {"type": "box"}}


def picture(body: dict[str, Any], camera: dict[str, Any], **more: Any) -> Any:
    shapes = {"body": {**mesh_shape(bumpy(1, 3)), "material": "glow", **body}}
    scene = {
        "materials": {"glow": {"type": "diffuse", "reflectance": 0.5, "emission": 1.0}},
        "shapes": shapes,
        "film": FRAME,
        "animation": {**OPEN, **more},
        "camera": {"type": "perspective", "position": [0, 0, 6], "look_at": [0, 0, 0], **camera},
        "integrator": {"type": "path", "max_depth": 1},
    }
    image = accuray.render(accuray.Scene.from_dict({"accuray": 1, **scene}), spp=256, seed=SEED + len(camera))
    return np.asarray(image, dtype=np.float64)[:, :, 1], np.asarray(image.error, dtype=np.float64)[:, :, 1]


@pytest.mark.parametrize("shape", ["box", "triangle"])
def test_a_body_that_moves_is_a_camera_that_moves_the_other_way(shape: str) -> None:
    there = keyed({"translate": [-1, 0, 0]}, {"translate": [1, 0.5, 0]})
    back = keyed({"translate": [1, 0, 0]}, {"translate": [-1, -0.5, 0]})
    a, b = picture({"transform": there}, {}, shutter_shape=shape), picture({}, {"transform": back}, shutter_shape=shape)
    result = blocks(*a, *b, size=4, power=0.02)
    assert result, result.reason
    still = picture({}, {}, shutter_shape=shape)
    assert blocks(*a, *still, size=4, power=0.02).verdict == "fail", "the comparison sees no motion"


def test_a_body_that_turns_is_a_camera_that_circles_it() -> None:
    first, last = ({"rotate": {"axis": [0, 1, 0], "angle": angle}} for angle in (-35, 35))
    a, b = picture({"transform": keyed(first, last)}, {}), picture({}, {"transform": keyed(last, first)})
    result = blocks(*a, *b, size=4, power=0.02)
    assert result, result.reason


def test_a_still_transform_places_any_camera_where_it_says() -> None:
    """As position, look_at and up would; and the same as a look_at step."""
    film, lens = single(uniform(64, 2, SEED)), single(uniform(64, 2, SEED + 1))
    for kind in ({"type": "perspective", "aperture_radius": 0.2, "focus_distance": 3}, {"type": "panorama"}):
        said = {**kind, "position": [1, 2, 3], "look_at": [0, 0.5, -1], "up": [0, 1, 0]}
        step = {"look_at": {"origin": [1, 2, 3], "target": [0, 0.5, -1]}}
        rays = [
            probe.camera_ray(lowered({}, camera=camera), film, lens, 0.3)
            for camera in (said, {**kind, "transform": step}, {**kind, "transform": keyed(step, step)})
        ]
        for other in rays[1:]:
            for key in ("origin", "direction"):
                assert other[key] == pytest.approx(rays[0][key], abs=1e-6)


def test_a_camera_between_two_look_at_keys() -> None:
    keys = keyed(
        {"look_at": {"origin": [0, 0, 5], "target": [0, 0, 0]}}, {"look_at": {"origin": [5, 0, 0], "target": [0, 0, 0]}}
    )
    core = lowered({}, camera={"type": "perspective", "transform": keys})
    middle = single(np.array([[0.5, 0.5]]))
    for time, angle in ((0.0, 0.0), (0.5, 45.0), (1.0, 90.0)):
        ray = probe.camera_ray(core, middle, middle, time)
        toward = [-math.sin(math.radians(angle)), 0.0, -math.cos(math.radians(angle))]
        assert ray["direction"][0] == pytest.approx(toward, abs=1e-4)
        assert ray["origin"][0] == pytest.approx([5 * time, 0, 5 * (1 - time)], abs=1e-2)
    orbit = motion(
        keyed({"look_at": {"origin": [0, 0, 5], "target": [0, 0, 0]}}, {"rotate": {"axis": [0, 1, 0], "angle": 90}})
    )
    eye = Eye({"type": "panorama", "position": (0.0, 0.0, 0.0), "transform": orbit}, {"width": 2000, "height": 1000})
    assert 2 < len(camera_keys(orbit, (0.0, 0.0, 0.0), eye).rows) <= 129
