"""How many straight segments a motion needs: keys at equal steps of time, between which matrices change linearly.

Embree takes 129 keys at most. A motion gets as many as keep every point of the body within a tenth of a pixel, or
within 1e-4 of the body's size if that is more, of where it really is.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray.scene.motion import Motion
from accuray.scene.transforms import sine_cosine

Values = dict[str, Any]
Array = NDArray[np.float64]

COUNTS = (
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    12,
    14,
    16,
    18,
    20,
    24,
    28,
    30,
    32,
    36,
    40,
    48,
    50,
    60,
    64,
    80,
    96,
    100,
    112,
    128,
)
"""Numbers of segments that are tried. The ends of many of them meet keys at even times."""

OF_SIZE = 1e-4
OF_PIXEL = 0.1
MOST_OF_SIZE = 1e-2
"""Error, over the size of the body, from which a motion of 128 segments is refused."""


MOST_DEGREES = 45.0
"""Turn of a segment, at most: beyond, the middle of one may be right by chance."""

PARTS = (0.5, 0.5 * (3.0 - math.sqrt(5.0)))
"""Where a segment is compared with the true motion: in the middle, where it errs most, and somewhere else."""


class Keys(NamedTuple):
    """``rows`` (K, 12): the upper three rows of each key. ``error``: 0, or what is too much of the body's size."""

    rows: Array
    error: float


class Eye:
    """The size of a pixel in the world, as a camera sees it.

    Args:
        camera: the resolved table.
        film: the resolved table of the film.
    """

    def __init__(self, camera: Values, film: Values) -> None:
        self._position = np.array([camera["position"]], dtype=np.float64)
        transform = camera["transform"]
        if transform is not None:
            shares = np.linspace(0.0, 1.0, 9) if isinstance(transform, Motion) else [0.0]
            matrices = [transform.at(float(s)) if isinstance(transform, Motion) else transform for s in shares]
            self._position = np.concatenate([moved(m[None], self._position)[0] for m in matrices])
        self._parallel = camera["height"] / film["height"] if camera["type"] == "orthographic" else 0.0
        self.angle = 0.0 if self._parallel else _pixel_angle(camera, film)

    def pixel_at(self, points: Array) -> float:
        """Size of a pixel, in metres, at the nearest part of a box around ``points`` (N, 3)."""
        if self._parallel:
            return float(self._parallel)
        nearest = np.clip(self._position, points.min(axis=0), points.max(axis=0))
        return self.angle * float(_lengths(nearest - self._position).min())


def _pixel_angle(camera: Values, film: Values) -> float:
    """Least angle between neighbouring pixels, about."""
    width, height = film["width"], film["height"]
    if camera["type"] == "panorama":
        return float(min(2.0 * math.pi / width, math.pi / height))
    if camera["type"] == "fisheye":
        return float(0.5 * camera["fov"] / math.hypot(width, height))
    if camera["type"] == "pinhole_intrinsics":
        across, down = (camera["image_width"] or width) / width, (camera["image_height"] or height) / height
        pixel = min(across / camera["fx"], down / (camera["fy"] or camera["fx"]))
    else:
        pixels = height if camera["fov_axis"] == "vertical" else width
        if camera["focal_length"] is None:
            sin, cos = sine_cosine(math.degrees(0.5 * camera["fov"]))
            pixel = 2.0 * sin / (cos * pixels)
        else:
            pixel = camera["film_size"] / (camera["focal_length"] * pixels)
    # A pixel of a flat film stands for less of the sphere towards the corners.
    reach = 0.5 * pixel * math.hypot(width, height)
    return float(pixel / (1.0 + reach * reach))


def camera_in_place(camera: Values) -> Values:
    """The camera with a transform that holds still in its own vectors; one that moves keeps them."""
    transform = camera["transform"]
    if transform is None or isinstance(transform, Motion):
        return camera
    points = np.array([camera["position"], camera["look_at"], camera["up"]], dtype=np.float64)
    position, look_at, up = moved(transform[None], points)[0]
    axes = {"position": position, "look_at": look_at, "up": up - transform[:3, 3]}
    return {**camera, **{name: tuple(map(float, vector)) for name, vector in axes.items()}}


def shape_box(shape: Values) -> Array:
    """Low and high corner (2, 3) of a box around a still shape that is no mesh."""
    if shape["type"] == "rectangle":
        corner, u, v = (np.array(shape[key], dtype=np.float64) for key in ("corner", "edge_u", "edge_v"))
        points = np.array([corner, corner + u, corner + v, corner + u + v])
    else:
        center = np.array(shape["center"], dtype=np.float64)
        points = np.array([center - shape["radius"], center + shape["radius"]])
    box = np.array([points.min(axis=0), points.max(axis=0)])
    return box if shape["transform"] is None else box_under(shape["transform"][:3].reshape(12), box)


def box_under(row: Array, box: Array) -> Array:
    """A box (2, 3) around a box under a transform, (12,): three rows of four."""
    points = moved(row.reshape(1, 3, 4), _corners(box))[0]
    return np.array([points.min(axis=0), points.max(axis=0)])


def _corners(box: Array) -> Array:
    """The eight corners (8, 3) of a box (2, 3)."""
    return np.array([[box[(c >> axis) & 1][axis] for axis in range(3)] for c in range(8)])


def check_error(keys: Keys) -> None:
    """Raises ValueError(problem, key) for keys that miss the motion by more than can be borne."""
    if keys.error > MOST_OF_SIZE:
        raise ValueError(
            f"turns so far while the shutter is open that {len(keys.rows) - 1} straight segments miss it by "
            f"{keys.error:.3g} of its size: allowed up to {MOST_OF_SIZE:g}",
            "transform",
        )


def body_keys(motion: Motion, box: Array, eye: Eye) -> Keys:
    """The keys of a body that fills a box (2, 3), low and high corner, before it is moved."""
    corners = _corners(box)
    ends = moved(np.array([motion.at(share) for share in np.linspace(0.0, 1.0, 9)]), corners)
    size = float(_lengths(ends[:, :1] - ends).max())
    allowed = max(OF_SIZE * size, OF_PIXEL * eye.pixel_at(ends.reshape(-1, 3)))

    def error(true: Array, straight: Array) -> float:
        return float(_lengths(moved(true, corners) - moved(straight, corners)).max())

    matrices, worst = _segmented(motion, error, allowed)
    return Keys(_rows(matrices), worst / size if worst > allowed and size > 0.0 else 0.0)


def camera_keys(motion: Motion, position: tuple[float, ...], eye: Eye) -> Keys:
    """The keys of a camera that stands at ``position`` before it is moved.

    It looks within a tenth of a pixel of where it should, and stands within 1e-4 of its way of it.
    """
    here = np.array([position], dtype=np.float64)
    ahead = here + np.concatenate([np.eye(3), -np.eye(3)])
    places = moved(np.array([motion.at(share) for share in np.linspace(0.0, 1.0, 65)]), here)[:, 0]
    way = float(_lengths(np.diff(places, axis=0)).sum())
    angle = eye.angle or 1e-3

    def error(true: Array, straight: Array) -> float:
        starts = moved(true, here), moved(straight, here)
        apart = float(_lengths(starts[0] - starts[1]).max())
        looks = [_directions(moved(m, ahead) - start) for m, start in zip((true, straight), starts, strict=True)]
        turned = float(_lengths(looks[0] - looks[1]).max())
        return max(apart / (OF_SIZE * way) if way > 0.0 else 0.0, turned / (OF_PIXEL * angle))

    matrices, worst = _segmented(motion, error, 1.0)
    return Keys(_rows(matrices), worst * OF_SIZE if worst > 1.0 else 0.0)


def _segmented(motion: Motion, error: Any, allowed: float) -> tuple[Array, float]:
    """The matrices (K, 4, 4) of the fewest segments whose error is allowed, else of the most, and the error."""
    floor = motion.degrees / MOST_DEGREES
    for count in COUNTS:
        if count < floor and count != COUNTS[-1]:
            continue
        keys = np.array([motion.at(k / count) for k in range(count + 1)])
        shares = [(k + part) / count for k in range(count) for part in PARTS] + list(motion.bends)
        true = np.array([motion.at(share) for share in shares])
        worst = error(true, between_keys(keys, np.array(shares)))
        if worst <= allowed:
            break
        # On a curve the error falls with the square of the number: no use in trying much smaller ones.
        floor = 0.5 * count * math.sqrt(worst / allowed) if allowed > 0.0 and not motion.bends else 0.0
    return keys, worst


def between_keys(keys: Array, shares: Array) -> Array:
    """What matrices (K, 4, 4) at equal steps are at shares (N,) of the interval, as the kernels take it."""
    scaled = shares * (len(keys) - 1)
    first = np.minimum(scaled.astype(np.int64), len(keys) - 2)
    f = (scaled - first)[:, None, None]
    return np.asarray((1.0 - f) * keys[first] + f * keys[first + 1])


def moved(matrices: Array, points: Array) -> Array:
    """Points (P, 3) under each of matrices (N, 3 or 4, 4): (N, P, 3). Without BLAS: the same bits on every machine."""
    m = matrices[:, None, :3, :]
    x, y, z = (points[None, :, axis, None] for axis in range(3))
    return np.asarray(m[..., 0] * x + m[..., 1] * y + m[..., 2] * z + m[..., 3])


def _rows(matrices: Array) -> Array:
    return np.ascontiguousarray(matrices[:, :3, :].reshape(-1, 12))


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors * vectors).sum(axis=-1)))


def _directions(vectors: Array) -> Array:
    return np.asarray(vectors / _lengths(vectors)[..., None])
