"""Textures against independent formulas: formats, wrap modes and filters of pictures, and the procedural patterns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.kernels.support import FloatArray, load, single

FORMATS = ("uint8", "uint16", "float16", "float32")
WRAPS = ("repeat", "mirror", "clamp", "black")
OUTSIDE = np.array([-3.0, -1.25, -1.0, -0.51, -0.5, -0.05, 0.0, 0.01, 0.24, 0.5, 0.77, 0.99, 1.0, 1.02, 1.5, 2.0, 2.9])


def values(texture: dict[str, Any], uv: FloatArray, points: FloatArray | None = None) -> FloatArray:
    """What a texture gives, (N, 4), at texture coordinates (N, 2) and points (N, 3)."""
    from accuray._core import probe

    core = load({"textures": {"t": texture}})
    at = np.zeros((len(uv), 3)) if points is None else points
    return np.asarray(probe.texture_values(core, 0, single(uv), single(at)), dtype=np.float64)


def picture(kind: str, height: int = 5, width: int = 7, channels: int = 3) -> NDArray[Any]:
    """Random texels of a type."""
    rng = np.random.default_rng(7)
    if kind.startswith("uint"):
        return rng.integers(0, np.iinfo(kind).max, (height, width, channels), dtype=kind, endpoint=True)
    return rng.uniform(-0.5, 3.0, (height, width, channels)).astype(kind)


def numbers(pixels: NDArray[Any]) -> FloatArray:
    """Texels as numbers: integers from 0 to 1."""
    most = np.iinfo(pixels.dtype).max if pixels.dtype.kind == "u" else 1.0
    return pixels.astype(np.float64) / most


def from_srgb(x: FloatArray) -> FloatArray:
    """IEC 61966-2-1."""
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def fetch(texels: FloatArray, row: int, column: int, wrap_u: str, wrap_v: str) -> FloatArray:
    """A texel by its number on an endless grid."""
    index = []
    for i, n, wrap in ((row, texels.shape[0], wrap_v), (column, texels.shape[1], wrap_u)):
        if wrap == "repeat":
            index.append(i % n)
        elif wrap == "mirror":
            index.append(min(i % (2 * n), 2 * n - 1 - i % (2 * n)))
        elif wrap == "clamp":
            index.append(min(max(i, 0), n - 1))
        elif 0 <= i < n:
            index.append(i)
        else:
            return np.zeros(texels.shape[2])
    return texels[index[0], index[1]]


def bilinear(texels: FloatArray, u: float, v: float, wrap_u: str, wrap_v: str) -> FloatArray:
    """The endless grid, interpolated between the centres of its texels; v runs upwards."""
    x, y = u * texels.shape[1] - 0.5, (1.0 - v) * texels.shape[0] - 0.5
    column, row = int(np.floor(x)), int(np.floor(y))
    fx, fy = x - column, y - row
    corners = [[fetch(texels, row + j, column + i, wrap_u, wrap_v) for i in (0, 1)] for j in (0, 1)]
    upper, lower = (a * (1.0 - fx) + b * fx for a, b in corners)
    return np.asarray(upper * (1.0 - fy) + lower * fy)


@pytest.mark.parametrize("wrap", WRAPS)
@pytest.mark.parametrize("kind", FORMATS)
def test_pictures_are_interpolated_between_texel_centres(kind: str, wrap: str) -> None:
    """Inside, on the edges and beyond them, with another mode on the other axis."""
    pixels, other = picture(kind), WRAPS[(WRAPS.index(wrap) + 1) % 4]
    table = {"type": "image", "pixels": pixels, "color_space": "data", "wrap_u": wrap, "wrap_v": other}
    uv = np.stack(np.meshgrid(OUTSIDE, OUTSIDE), axis=-1).reshape(-1, 2)
    uv = np.concatenate([uv, np.random.default_rng(3).uniform(-2.0, 3.0, (500, 2))]).astype(np.float32)
    expected = [bilinear(numbers(pixels), u, v, wrap, other) for u, v in uv.astype(np.float64)]
    assert np.abs(values(table, uv)[:, :3] - expected).max() < 2e-5


@pytest.mark.parametrize("kind", FORMATS)
def test_texel_centres_are_exact(kind: str) -> None:
    pixels = picture(kind, 4, 8)
    rows, columns = np.mgrid[0:4, 0:8]
    uv = np.stack([(columns + 0.5) / 8, 1.0 - (rows + 0.5) / 4], axis=-1).reshape(-1, 2)
    for chosen in ("bilinear", "nearest"):
        table = {"type": "image", "pixels": pixels, "color_space": "data", "filter": chosen}
        assert np.array_equal(values(table, uv)[:, :3], numbers(pixels).astype(np.float32).reshape(-1, 3)), chosen


def test_the_nearest_texel_is_that_whose_square_it_is() -> None:
    pixels = picture("float32", 3, 5, 1)
    uv = np.random.default_rng(5).uniform(0.0, 1.0, (400, 2)).astype(np.float32)
    rows, columns = np.floor((1.0 - uv[:, 1]) * 3).astype(int), np.floor(uv[:, 0] * 5).astype(int)
    found = values({"type": "image", "pixels": pixels, "filter": "nearest"}, uv)
    assert np.array_equal(found[:, 0], pixels[rows.clip(0, 2), columns.clip(0, 4), 0])


@pytest.mark.parametrize(("kind", "count"), [("uint8", 256), ("uint16", 65536)])
def test_srgb_is_decoded(kind: str, count: int) -> None:
    stored = np.arange(count, dtype=kind).reshape(-1, 1)
    uv = np.stack([np.full(count, 0.5), 1.0 - (np.arange(count) + 0.5) / count], axis=-1)
    found = values({"type": "image", "pixels": stored, "color_space": "srgb", "filter": "nearest"}, uv)[:, 0]
    assert np.allclose(found, from_srgb(stored[:, 0] / (count - 1.0)), rtol=1e-6, atol=0.0)


def test_alpha_is_never_decoded_and_missing_channels_are_filled() -> None:
    pixels, middle = picture("uint8", 1, 1, 4), np.array([[0.5, 0.5]])
    stored = numbers(pixels)[0, 0]
    colour = from_srgb(stored)
    for channels, expected in {
        1: [colour[0], colour[0], colour[0], 1.0],
        2: [colour[0], colour[0], colour[0], stored[1]],
        3: [*colour[:3], 1.0],
        4: [*colour[:3], stored[3]],
    }.items():
        table = {"type": "image", "pixels": pixels[..., :channels], "color_space": "srgb"}
        assert np.allclose(values(table, middle)[0], expected, rtol=1e-6), channels


def test_coordinates_are_scaled_then_rotated_then_moved() -> None:
    pixels = picture("float32", 9, 9)
    uv = np.random.default_rng(11).uniform(0.0, 1.0, (300, 2))
    turn, scale, move = np.radians(30.0), np.array([2.0, 0.5]), np.array([0.1, -0.2])
    c, s = np.cos(turn), np.sin(turn)
    moved = (uv * scale) @ np.array([[c, -s], [s, c]]).T + move
    table = {"type": "image", "pixels": pixels}
    map_ = {"uv_scale": scale.tolist(), "uv_rotate": 30, "uv_translate": move.tolist()}
    assert np.abs(values({**table, **map_}, uv) - values(table, moved)).max() < 1e-4


@pytest.mark.parametrize("wrap", WRAPS)
def test_no_coordinate_breaks_a_lookup(wrap: str) -> None:
    strange = np.array([np.nan, np.inf, -np.inf, 3e38, -3e38, 1e9, -1e-45, 1e-45, np.nextafter(np.float32(1.0), 0.0)])
    uv = np.stack(np.meshgrid(strange, strange), axis=-1).reshape(-1, 2)
    for size in ((1, 1), (1, 4), (3, 2)):
        for chosen in ("bilinear", "nearest"):
            pixels = picture("uint8", *size)
            table = {"type": "image", "pixels": pixels, "wrap_u": wrap, "wrap_v": wrap, "filter": chosen}
            found = values(table, uv)
            assert np.isfinite(found).all()
            assert found.min() >= 0.0
            assert found.max() <= 1.0


def test_checkers_alternate() -> None:
    uv = np.random.default_rng(13).uniform(-2.0, 2.0, (1000, 2)).astype(np.float32).astype(np.float64)
    table = {"type": "checker", "first": [1, 0.5, 0], "second": [0, 0.25, 1]}
    even = (np.floor(2.0 * uv[:, 0]) + np.floor(2.0 * uv[:, 1])) % 2 == 0
    assert np.array_equal(values(table, uv)[:, 0], even.astype(float))
    assert np.array_equal(values(table, uv)[:, 1], np.where(even, 0.5, 0.25))


def test_gradients_run_from_one_colour_to_the_other() -> None:
    uv = np.random.default_rng(17).uniform(-0.5, 1.5, (500, 2))
    colours = {"first": [0, 0, 0.25], "second": [1, 1, 0.75]}
    linear = values({"type": "gradient", **colours}, uv)
    radial = values({"type": "gradient", "course": "radial", **colours}, uv)
    along, from_centre = uv[:, 0].clip(0, 1), (2.0 * np.hypot(*(uv - 0.5).T)).clip(0, 1)
    assert np.allclose(linear[:, 0], along, atol=1e-6)
    assert np.allclose(linear[:, 2], 0.25 + 0.5 * along, atol=1e-6)
    assert np.allclose(radial[:, 0], from_centre, atol=1e-6)


SOLID = ("noise", "wood", "marble")


@pytest.mark.parametrize("name", SOLID)
def test_solid_textures_vary_in_space_and_not_with_coordinates(name: str) -> None:
    """Continuous, within their colours, of the size that is asked for, and the same at the same point."""
    rng = np.random.default_rng(19)
    points, uv = rng.uniform(-5.0, 5.0, (4000, 3)), rng.uniform(0.0, 1.0, (4000, 2))
    table = {"type": name, "first": [0, 0, 0], "second": [1, 1, 1]}
    share = values(table, uv, points)[:, 0]
    assert np.array_equal(share, values(table, uv[::-1], points)[:, 0])
    assert share.min() >= 0.0
    assert share.max() <= 1.0
    assert share.std() > 0.05
    near = values(table, uv, points + 1e-3)[:, 0]
    assert np.median(np.abs(near - share)) < 0.02
    assert np.allclose(values({**table, "size": 2.0}, uv, 2.0 * points)[:, 0], share, atol=2e-3)


def test_noise_has_no_value_of_its_own_at_the_lattice() -> None:
    """Gradient noise is 0 at whole numbers, whatever the octave, and its mean is 0."""
    points = np.random.default_rng(23).integers(-50, 50, (500, 3)).astype(np.float64)
    uv = np.zeros((500, 2))
    table = {"type": "noise", "first": [0, 0, 0], "second": [1, 1, 1]}
    assert np.array_equal(values(table, uv, points)[:, 0], np.full(500, 0.5))
    anywhere = np.random.default_rng(29).uniform(-1e3, 1e3, (20_000, 3))
    found = values({**table, "octaves": 1}, np.zeros((20_000, 2)), anywhere)[:, 0]
    assert abs(found.mean() - 0.5) < 5.0 * found.std() / np.sqrt(20_000)


@pytest.mark.parametrize("name", SOLID)
def test_no_point_breaks_a_solid_texture(name: str) -> None:
    strange = np.array([np.nan, np.inf, -np.inf, 3e38, -1e20, 1e-40, 0.0])
    points = np.stack(np.meshgrid(strange, strange, strange), axis=-1).reshape(-1, 3)
    found = values({"type": name}, np.zeros((len(points), 2)), points)
    assert np.isfinite(found).all()
