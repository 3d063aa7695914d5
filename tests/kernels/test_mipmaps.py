"""Mipmaps: their levels against box filters, the level that a footprint asks for, and the footprints of cameras."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import accuray
from tests.kernels.support import FloatArray, load, single
from tests.kernels.test_textures import FORMATS, bilinear, from_srgb, numbers, picture, values

Table = dict[str, Any]


def halved(texels: FloatArray, axis: int) -> FloatArray:
    """Each of half as many cells the mean of what it covers: by cells cut so finely that none is shared."""
    n = texels.shape[axis]
    m = max(n // 2, 1)
    fine = np.repeat(texels, m, axis=axis)
    shape = [*fine.shape[:axis], m, n, *fine.shape[axis + 1 :]]
    return np.asarray(fine.reshape(shape).mean(axis=axis + 1))


def levels(texels: FloatArray) -> list[FloatArray]:
    """A picture and all its mipmaps."""
    found = [texels]
    while max(found[-1].shape[:2]) > 1:
        found.append(halved(halved(found[-1], 0), 1))
    return found


def read(texture: Table, uv: FloatArray, footprint: float) -> FloatArray:
    """A texture at coordinates (N, 2) whose unit is 1 m, over a diameter in metres."""
    from accuray._core import probe

    core = load({"textures": {"t": texture}})
    return np.asarray(probe.texture_values(core, 0, single(uv), single(np.zeros((len(uv), 3))), footprint), dtype=float)


def mipmapped(pixels: NDArray[Any], **more: Any) -> Table:
    return {"type": "image", "pixels": pixels, "color_space": "data", "filter": "mipmap", **more}


UV = np.random.default_rng(2).uniform(-1.5, 2.5, (200, 2)).astype(np.float32).astype(np.float64)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(("height", "width", "channels"), [(8, 16, 3), (5, 7, 1), (1, 9, 4), (13, 2, 2)])
def test_levels_are_box_filtered_and_interpolated(kind: str, height: int, width: int, channels: int) -> None:
    """Trilinear: at level k + f the share f of level k + 1; beyond the last level its one texel."""
    pixels = picture(kind, height, width, channels)
    pyramid = levels(numbers(pixels))
    for level in (0.0, 0.4, 1.0, 2.75, len(pyramid) - 1.0, 20.0):
        footprint = 2.0**level / math.sqrt(height * width)
        found = read(mipmapped(pixels, wrap_u="mirror", wrap_v="clamp"), UV, footprint)[
            :, [0, -1] if channels == 2 else slice(channels)
        ]
        held = min(level, len(pyramid) - 1.0)
        fine, share = int(held), held - int(held)
        coarse = min(fine + 1, len(pyramid) - 1)
        at = [[bilinear(pyramid[k], u, v, "mirror", "clamp") for u, v in UV] for k in (fine, coarse)]
        assert np.abs(found - ((1 - share) * np.array(at[0]) + share * np.array(at[1]))).max() < 1e-4, level


@pytest.mark.parametrize(("height", "width"), [(64, 64), (63, 17), (1, 100), (33, 2)])
def test_the_last_level_is_the_mean_of_the_picture(height: int, width: int) -> None:
    pixels = picture("float32", height, width)
    found = read(mipmapped(pixels), UV[:1], 1e9)[0, :3]
    assert np.allclose(found, pixels.mean(axis=(0, 1), dtype=float), rtol=1e-6)


@pytest.mark.parametrize("kind", FORMATS)
def test_a_picture_of_one_colour_is_the_same_at_all_levels(kind: str) -> None:
    pixels = np.broadcast_to(picture(kind, 1, 1), (12, 20, 3)).copy()
    for space in ("data", "srgb"):
        table = mipmapped(pixels) | {"color_space": space}
        expected = values({**table, "filter": "bilinear"}, UV)
        for level in (0.3, 1.0, 2.5, 9.0):
            assert np.allclose(read(table, UV, 2.0**level / math.sqrt(240)), expected, rtol=1e-6, atol=0.0)


def test_colours_are_averaged_in_linear_light_and_alpha_as_it_is() -> None:
    pixels = np.array([[[0, 50, 100, 0], [255, 150, 200, 255]]], dtype=np.uint8)
    found = read(mipmapped(pixels) | {"color_space": "srgb"}, UV[:1], 1e3)[0]
    stored = numbers(pixels)[0]
    assert np.allclose(found, [*from_srgb(stored[:, :3]).mean(axis=0), 0.5], rtol=1e-6)


def test_the_level_is_the_logarithm_of_the_footprint_in_texels() -> None:
    """Scaled and turned coordinates have more texels to the metre: a checker of single texels loses its contrast."""
    checker = np.indices((64, 64)).sum(axis=0)[..., np.newaxis] % 2 * 1.0
    centres = (np.stack(np.meshgrid(np.arange(8), np.arange(8)), axis=-1).reshape(-1, 2) + 0.5) / 64.0
    table = mipmapped(checker.astype(np.float32), uv_scale=[2, 8], uv_rotate=90, uv_translate=[1, 0])
    texels = 64.0 * math.sqrt(2 * 8)
    uv = np.stack([centres[:, 1] / 2, (1.0 - centres[:, 0]) / 8], axis=-1)
    assert set(read(table, uv, 0.0)[:, 0].round(5)) == {0.0, 1.0}
    for level in (0.0, 0.2, 0.5, 0.9, 1.0, 3.0):
        contrast = np.ptp(read(table, uv, 2.0**level / texels)[:, 0])
        assert contrast == pytest.approx(max(0.0, 1.0 - level), abs=1e-4)


def test_points_and_the_other_filters_read_the_picture_itself() -> None:
    pixels = picture("uint8", 9, 9)
    sharp = values({"type": "image", "pixels": pixels, "color_space": "data"}, UV)
    assert np.array_equal(read(mipmapped(pixels), UV, 0.0), sharp)
    assert np.array_equal(read(mipmapped(pixels) | {"filter": "bilinear"}, UV, 10.0), sharp)
    nearest = values({"type": "image", "pixels": pixels, "color_space": "data", "filter": "nearest"}, UV)
    assert np.array_equal(read(mipmapped(pixels) | {"filter": "nearest"}, UV, 10.0), nearest)


# --- Footprints -----------------------------------------------------------------------------------------------------

PLANE = {"type": "rectangle", "material": "m", "corner": [-50, -50, 0], "edge_u": [100, 0, 0], "edge_v": [0, 100, 0]}


def scene(camera: Table, filter_: str = "mipmap", pixels: Any = None, **sections: Table) -> Table:
    """The plane z = 0 under a sky of radiance 1, with a picture of 64 x 64 texels to the metre."""
    pixels = np.indices((64, 64)).sum(axis=0) % 2 * 0.5 + 0.25 if pixels is None else pixels
    texture = {"type": "image", "pixels": pixels.astype(np.float32), "filter": filter_, "uv_scale": [100, 100]}
    return {
        "camera": camera,
        "textures": {"t": texture},
        "materials": {"m": {"type": "diffuse", "reflectance": {"texture": "t"}}},
        "shapes": {"plane": PLANE},
        "lights": {"sky": {"type": "constant", "radiance": 1}},
        **sections,
    }


SIZE = 400


def footprints(camera: Table, *pixels: tuple[int, int]) -> list[float]:
    from accuray._core import probe

    core = load(scene(camera))
    return list(probe.footprints(core, SIZE, SIZE, np.array(pixels, dtype=np.uint32)))


MIDDLE = (SIZE // 2, SIZE // 2)
ABOVE: Table = {"position": [0, 0, 8], "look_at": [0, 0, 0], "up": [0, 1, 0]}


def test_the_footprint_of_a_perspective_camera() -> None:
    """Straight ahead 2 d tan(fov / 2) / height; farther away it grows with the distance and with 1 / cos."""
    for distance in (0.5, 8.0):
        camera = {**ABOVE, "type": "perspective", "position": [0, 0, distance], "fov": 40}
        expected = 2 * distance * math.tan(math.radians(20)) / SIZE
        assert footprints(camera, MIDDLE)[0] == pytest.approx(expected, rel=2e-3)
    slanted = {"type": "perspective", "position": [0, -8, 8], "look_at": [0, 0, 0], "fov": 4}
    expected = 2 * math.hypot(8, 8) * math.tan(math.radians(2)) / SIZE / math.cos(math.radians(45))
    assert footprints(slanted, MIDDLE)[0] == pytest.approx(expected, rel=2e-3)


def test_the_footprints_of_the_other_cameras() -> None:
    """All of them by the geometry of the pixel in the middle, and at the rim where rays on one side see nothing."""
    cases: list[tuple[Table, float]] = [
        ({"type": "orthographic", "height": 6}, 6 / SIZE),
        ({"type": "fisheye", "fov": 120}, 8 * math.radians(120) / SIZE),
        ({"type": "panorama"}, 8 * 1.5 * math.pi / SIZE),
        ({"type": "perspective", "fov": 40, "aperture_radius": 0.01}, 16 * math.tan(math.radians(20)) / SIZE),
    ]
    for camera, expected in cases:
        assert footprints({**ABOVE, **camera}, MIDDLE)[0] == pytest.approx(expected, rel=1e-2), camera
    # At an angle t to the axis a pixel is as high as in the middle, but sin(t) / t as wide.
    angle = math.radians(59.5)
    diameter = 8 / math.cos(angle) * math.radians(120) / SIZE * 0.5 * (1 + math.sin(angle) / angle)
    rim = footprints({**ABOVE, "type": "fisheye", "fov": 120}, (1, SIZE // 2))[0]
    assert rim == pytest.approx(diameter / math.cos(angle), rel=0.05)


# --- Pictures -------------------------------------------------------------------------------------------------------


def rendered(described: Table, spp: int = 1) -> FloatArray:
    described = {**described, "film": {"width": 16, "height": 16}, "integrator": {"type": "path", "strategy": "bsdf"}}
    return (
        accuray.render(accuray.Scene.from_dict(described), spp=spp, seed=3).film.sums[..., 1].sum(axis=2).astype(float)
    )


FAR: Table = {**ABOVE, "type": "perspective", "fov": 40}


def test_a_checker_from_afar_is_its_mean_at_one_sample() -> None:
    """Over the same scene of one colour, sample by sample: as many texels as 23 to a pixel leave no contrast."""
    grey = rendered(scene(FAR, pixels=np.full((64, 64), 0.5)))
    far, sharp = (rendered(scene(FAR, kind)) / grey for kind in ("mipmap", "bilinear"))
    assert np.abs(far - 1.0).max() < 1e-4
    assert sharp.std() > 0.1


CEILING = {"type": "rectangle", "material": "ceiling", "corner": [50, -50, 0.5], "edge_u": [-100, 0, 0]}


def ratio_in(ceiling: Table) -> FloatArray:
    """The plane of the checker, over the same plane in grey, as a ceiling close above it shows it."""
    found = []
    for pixels in (None, np.full((64, 64), 0.5)):
        described = scene({**FAR, "fov": 1, "position": [0, 0, 0.4], "look_at": [0, 0, 1]}, pixels=pixels)
        described["materials"]["ceiling"] = ceiling
        described["shapes"]["ceiling"] = {**CEILING, "edge_v": [0, 100, 0]}
        described["materials"]["m"]["emission"] = 0.5
        found.append(rendered(described, 4))
    return np.asarray(found[0] / found[1])


def test_cones_widen_where_matter_scatters_and_not_in_mirrors() -> None:
    """A pixel stands for a tenth of a texel in a mirror, and for many texels by way of a matte ceiling."""
    assert ratio_in({"type": "conductor", "metal": "perfect"}).std() > 0.02
    assert np.abs(ratio_in({"type": "diffuse", "reflectance": 1}) - 1.0).max() < 2e-3
