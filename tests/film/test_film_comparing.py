"""Comparing pictures: measures against closed forms, FLIP against its authors' program, noise, and wrong input."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray

import accuray
from accuray.film import Film, Image, ImageError
from accuray.film.colour import srgb_decode, srgb_encode
from accuray.film.flip import flip
from accuray.film.heat import heat_map, heat_range
from accuray.film.png import encode_codes

FilmMaker = Callable[..., Film]
Pixels = NDArray[np.float64]
decode = np.vectorize(srgb_decode, otypes=[np.float64])


def png(path: Path, codes: NDArray[np.integer] | list[object]) -> Path:
    path.write_bytes(encode_codes(np.asarray(codes, dtype=np.uint8)))
    return path


def exr(path: Path, channels: dict[str, NDArray[np.float32]], **header: object) -> Path:
    """An EXR file as another program would write it."""
    whole = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    OpenEXR.File(whole, channels).write(str(path))
    return path


def test_a_constant_offset(tmp_path: Path) -> None:
    codes = np.random.default_rng(1).integers(0, 200, (24, 32, 3))
    b = png(tmp_path / "b.png", codes)
    a = png(tmp_path / "a.png", codes + np.array([10, 20, 0]))
    c = accuray.compare(a, b)
    assert c.difference == pytest.approx((10 / 255, 20 / 255, 0), abs=1e-12)
    assert c.accuracy == pytest.approx(100 * (1 - 30 / 255 / 3))
    assert c.largest == pytest.approx(20 / 255)
    assert c.psnr == pytest.approx(-10 * math.log10((100 + 400) / 3 / 255**2))
    assert (c.width, c.height, c.identical, c.noise) == (32, 24, False, None)
    assert c.note == "not both have error estimates"
    assert c.difference_map == pytest.approx(np.full((24, 32), 10 / 255))


def test_the_accuracy_of_the_original_report() -> None:
    """Its Cornell box: mean differences of 0.033, 0.018 and 0.029 are an accuracy of 97.3 %."""
    b = decode(np.full((8, 8, 3), 0.5))
    a = decode(np.full((8, 8, 3), 0.5) + np.array([0.033, -0.018, 0.029]))
    assert accuray.compare(a, b).accuracy == pytest.approx(97.3, abs=0.05)


def test_one_changed_pixel(tmp_path: Path) -> None:
    codes = np.full((10, 20, 3), 100)
    changed = codes.copy()
    changed[3, 7] = [151, 100, 100]
    a, b = png(tmp_path / "a.png", changed), png(tmp_path / "b.png", codes)
    c = accuray.compare(a, b)
    assert c.difference == pytest.approx((0.2 / 200, 0, 0))
    assert c.psnr == pytest.approx(-10 * math.log10(0.04 / 600))
    linear = srgb_decode(100 / 255)
    expected = (srgb_decode(151 / 255) - linear) ** 2 / (1.01 * linear**2) / 600
    assert c.relative_mse == pytest.approx(expected)
    assert np.argwhere(c.difference_map).tolist() == [[3, 7]]
    assert c.difference_map[3, 7] == pytest.approx(0.2 / 3)


def test_equal_pictures() -> None:
    rgb = np.random.default_rng(2).random((9, 9, 3)) * 3
    c = accuray.compare(rgb, rgb.copy())
    assert c.identical
    assert (c.accuracy, c.relative_mse, c.psnr, c.flip, c.largest) == (100, 0, math.inf, 0, 0)
    assert c.to_dict()["psnr"] is None
    json.dumps(c.to_dict(), allow_nan=False)


def test_relative_mse_is_linear_unclamped_and_blind_to_exposure() -> None:
    rng = np.random.default_rng(3)
    b = rng.random((16, 16, 3)) * 20
    a = b + rng.normal(size=b.shape)
    m = b.mean()
    expected = np.mean((a - b) ** 2 / (b**2 + 0.01 * m**2))
    for ev in (-3.0, 0.0, 7.5):
        assert accuray.compare(a, b, exposure=ev).relative_mse == pytest.approx(expected)
    black = np.zeros_like(b)
    assert accuray.compare(a, black).relative_mse == math.inf
    assert accuray.compare(black, black).relative_mse == 0


def test_relative_error_of_an_image_estimates_relative_mse(make_film: FilmMaker) -> None:
    few, many = Image(make_film(0, 256, seed=1)), Image(make_film(0, 1024, seed=2))
    expected = few.relative_error**2 + many.relative_error**2
    assert accuray.compare(few, many).relative_mse == pytest.approx(expected, rel=0.1)


# Means and values at (20, 30) of the maps by NVIDIA's flip-evaluator 1.7 (BSD-3-Clause), run on `flip_pairs`.
FLIP = {
    ("offset", 67.0206): (0.2484172, 0.2483008),
    ("offset", 30.0): (0.2411424, 0.2544158),
    ("offset", 120.0): (0.2552256, 0.2379583),
    ("pixel", 67.0206): (0.0046283, 0.3471606),
    ("pixel", 30.0): (0.0036587, 0.8800588),
    ("pixel", 120.0): (0.0049079, 0.1489752),
    ("bump", 67.0206): (0.0369865, 0.0066892),
    ("bump", 30.0): (0.0335273, 0.0015529),
    ("bump", 120.0): (0.0430627, 0.0233350),
    ("checker", 67.0206): (0.0060611, 0.0018393),
    ("checker", 30.0): (0.3871159, 0.4180566),
    ("checker", 120.0): (0.0086229, 0.0012276),
    ("green and blue", 67.0206): (1.0, 1.0),
    ("black and white", 67.0206): (0.9673917, 0.9673855),
}


def flip_pairs() -> dict[str, tuple[Pixels, Pixels]]:
    """Reference and test, sRGB-encoded, (48, 48, 3)."""
    n = 48
    y, x = np.mgrid[0:n, 0:n] / (n - 1)
    smooth = np.stack([x, y, 0.5 + 0.5 * np.sin(9 * x + 5 * y) * np.cos(7 * y)], axis=-1)
    dot = smooth.copy()
    dot[20, 30] = [1, 0, 1]
    bump = np.exp(-((x - 0.4) ** 2 + (y - 0.6) ** 2) / 0.01)[..., None] * [0.3, -0.15, 0.06]
    checker = np.indices((n, n)).sum(axis=0)[..., None] % 2 * np.ones(3)
    plain = np.ones((n, n, 3))
    return {
        "offset": (smooth * 0.8 + 0.05, smooth * 0.8 + 0.1),
        "pixel": (smooth, dot),
        "bump": (smooth, np.clip(smooth + bump, 0, 1)),
        "checker": (plain * 0.7354, checker),
        "green and blue": (plain * [0, 1, 0], plain * [0, 0, 1]),
        "black and white": (plain * 0, plain),
    }


@pytest.mark.parametrize(("name", "ppd"), FLIP)
def test_flip_is_that_of_its_authors(name: str, ppd: float) -> None:
    reference, test = flip_pairs()[name]
    error = flip(decode(reference), decode(test), ppd)
    assert (float(error.mean()), float(error[20, 30])) == pytest.approx(FLIP[name, ppd], abs=3e-5)
    assert error.dtype == np.float32
    whole = accuray.compare(decode(test), decode(reference), pixels_per_degree=ppd)
    assert whole.flip == pytest.approx(float(error.mean()), abs=1e-6)


def test_flip_is_symmetric_where_it_should_be_and_bounded() -> None:
    rng = np.random.default_rng(5)
    a, b = rng.random((2, 20, 30, 3))
    assert np.abs(flip(a, b) - flip(b, a)).max() < 1e-6
    assert flip(a, b).min() >= 0
    assert flip(a, b).max() <= 1
    with pytest.raises(ValueError, match="allowed 1 to 1000"):
        flip(a, b, 0.5)


def scaled(film: Film, factor: int) -> Film:
    """The film of a scene that is `factor` / 256 times as bright in the lower half."""
    half = film.shape[0] // 2
    film.sums[half:, :, :, :3] = film.sums[half:, :, :, :3] * factor // 256
    return film


def test_noise_explains_other_seeds_but_not_another_brightness(make_film: FilmMaker) -> None:
    a, b = Image(make_film(0, 64, seed=1)), Image(make_film(0, 64, seed=2))
    same = accuray.compare(a, b)
    assert same.noise is not None
    assert same.noise, same.noise.reason
    assert not same.identical
    darker = accuray.compare(Image(scaled(make_film(0, 64, seed=1), 230)), b)
    assert darker.noise is not None
    assert darker.noise.verdict == "fail"
    assert darker.to_dict()["noise"]["verdict"] == "fail"


def test_noise_does_not_depend_on_exposure(make_film: FilmMaker) -> None:
    a, b = Image(make_film(0, 64, seed=1)), Image(make_film(0, 64, seed=2))
    results = [accuray.compare(a, b, exposure=ev).noise for ev in (0.0, 6.0)]
    assert results[0] is not None
    assert results[1] is not None
    assert results[0].worst == pytest.approx(results[1].worst)


def test_noise_is_not_judged_without_error_bars(make_film: FilmMaker) -> None:
    a, b = Image(make_film(0, 64)), Image(make_film(0, 2, seed=2))
    assert accuray.compare(a, b).noise is None
    assert "too few samples" in accuray.compare(a, b).note


def test_shared_samples_are_noted(make_film: FilmMaker) -> None:
    def image(first: int, end: int, seed: int) -> Image:
        return Image(make_film(first, end, seed=seed), {"seed": seed})

    assert "share noise" in accuray.compare(image(0, 32, 1), image(16, 48, 1)).note
    assert accuray.compare(image(0, 16, 1), image(16, 48, 1)).note == ""
    assert accuray.compare(image(0, 32, 1), image(0, 32, 2)).note == ""


def test_files_give_what_images_give(make_film: FilmMaker, tmp_path: Path) -> None:
    a = Image(make_film(0, 16, seed=1), {"exposure": -1.5})
    b = Image(make_film(0, 32, seed=2), {"exposure": -2.0})
    a.save(tmp_path / "a.exr")
    b.save(tmp_path / "b.exr")
    images, files = accuray.compare(a, b), accuray.compare(tmp_path / "a.exr", str(tmp_path / "b.exr"))
    assert images.exposure == -2.0
    assert files.to_dict() == images.to_dict() | {"name": str(tmp_path / "a.exr"), "reference": str(tmp_path / "b.exr")}
    assert accuray.compare(a, b, exposure=0.0).exposure == 0
    assert accuray.compare(b, np.asarray(a)).exposure == -2.0


def test_a_picture_and_its_png_differ_by_rounding(make_film: FilmMaker, tmp_path: Path) -> None:
    """Exposure is in the PNG already, and is applied to the EXR."""
    image = Image(make_film(0, 16), {"exposure": -1.5})
    image.save(tmp_path / "a.png")
    for pair in ((image, tmp_path / "a.png"), (tmp_path / "a.png", image)):
        c = accuray.compare(*pair)
        assert c.exposure == -1.5
        assert c.largest <= 0.5 / 255 + 1e-6
        assert c.largest > 0.2 / 255


def test_alpha_multiplies_the_colours_of_a_png(tmp_path: Path) -> None:
    rgba = np.full((4, 4, 4), 255)
    rgba[..., 3] = 51
    a = png(tmp_path / "a.png", rgba)
    assert accuray.compare(a, np.full((4, 4, 3), 0.2)).largest < 1e-12


def test_exr_files_of_other_programs(tmp_path: Path) -> None:
    rgb = np.random.default_rng(4).random((6, 5, 3)).astype(np.float32)
    planes = {c: np.ascontiguousarray(rgb[..., i]) for i, c in enumerate("RGB")}
    plain = exr(tmp_path / "plain.exr", {**planes, "A": np.ones((6, 5), np.float32)})
    assert accuray.compare(plain, rgb).identical
    half = exr(tmp_path / "half.exr", {k: v.astype(np.float16) for k, v in planes.items()})
    assert accuray.compare(half, rgb).largest < 1e-3
    layer = exr(tmp_path / "layer.exr", {f"View.Combined.{k}": v for k, v in planes.items()})
    assert accuray.compare(layer, rgb).identical
    rec709 = exr(tmp_path / "709.exr", planes, chromaticities=(0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329))
    assert accuray.compare(rec709, rgb).identical
    joined = {"RGB": np.ascontiguousarray(rgb)}
    assert accuray.compare(exr(tmp_path / "joined.exr", joined), rgb).identical


def write(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def test_wrong_files_are_named(tmp_path: Path, make_film: FilmMaker) -> None:
    plane = np.zeros((4, 4), np.float32)
    Image(make_film(0, 4)).save(tmp_path / "ours.exr")
    ours = (tmp_path / "ours.exr").read_bytes()
    foreign = exr(tmp_path / "ok.exr", dict.fromkeys("RGB", plane)).read_bytes()
    box = foreign.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    huge = foreign[:box] + struct.pack("<4i", 0, 0, 2**20, 2**20) + foreign[box + 16 :]
    cases = {
        tmp_path / "none.exr": "cannot be read",
        tmp_path / "none.png": "cannot be read",
        tmp_path / "a.jpg": "allowed are .exr, .png",
        write(tmp_path / "empty.exr", b""): "is empty",
        write(tmp_path / "text.exr", b"hello there"): "is not an EXR",
        write(tmp_path / "cut.exr", ours[:400]): "truncated or damaged",
        write(tmp_path / "cut in the state.exr", ours[:-40]): "damaged",
        write(tmp_path / "cut picture.exr", foreign[:-30]): "truncated or damaged",
        write(tmp_path / "huge.exr", huge): "declares",
        exr(tmp_path / "grey.exr", {"Y": plane}): "no channels R, G and B of one size: it has Y",
        exr(tmp_path / "aces.exr", dict.fromkeys("RGB", plane), chromaticities=(0.713, 0.293, 0.165, 0.83, 0.128, 0.044,
            0.32168, 0.33767)): "other primaries than Rec.709",
        exr(tmp_path / "nan.exr", dict.fromkeys("RGB", plane + np.float32(np.nan))): "16 pixels are not finite",
    }  # fmt: skip
    for path, message in cases.items():
        with pytest.raises(ImageError) as caught:
            accuray.compare(path, np.zeros((4, 4, 3)))
        assert str(path) in str(caught.value)
        assert message in str(caught.value), path


def test_mutants_of_exr_files_give_a_comparison_or_an_error(tmp_path: Path) -> None:
    rng = np.random.default_rng(9)
    planes = {c: rng.random((8, 8), dtype=np.float32) for c in "RGB"}
    seed = exr(tmp_path / "seed.exr", planes).read_bytes()
    errors = 0
    for _ in range(150):
        data = bytearray(seed)
        for _ in range(int(rng.integers(1, 4))):
            data[int(rng.integers(0, len(data)))] = int(rng.integers(0, 256))
        path = write(tmp_path / "mutant.exr", bytes(data[: int(rng.integers(8, len(data) + 200))]))
        try:
            accuray.compare(path, np.zeros((8, 8, 3)))
        except ImageError:
            errors += 1
    assert errors > 50


def test_sizes_that_differ_are_explained(tmp_path: Path) -> None:
    a, b = np.zeros((8, 16, 3)), np.zeros((16, 32, 3))
    with pytest.raises(ImageError, match="image has 16 x 8 pixels, reference 32 x 16; render both at one size"):
        accuray.compare(a, b)
    with pytest.raises(ImageError, match="is one of them a crop"):
        accuray.compare(a, b[:, :9])
    with pytest.raises(ImageError, match=r"its shape is \(8, 16\)"):
        accuray.compare(a[:, :, 0], b)


def test_crops_of_different_places_are_refused(make_film: FilmMaker) -> None:
    a, b = (Image(make_film(0, 4, window=w)) for w in ((0, 0, 8, 8), (8, 0, 16, 8)))
    with pytest.raises(ImageError, match="x 0:8, y 0:8 and x 8:16, y 0:8"):
        accuray.compare(a, b)
    assert accuray.compare(a, np.asarray(b)).noise is None


def test_heat_maps(tmp_path: Path) -> None:
    a, b = np.zeros((50, 60, 3)), np.zeros((50, 60, 3))
    a[10:20, 30:40] = srgb_decode(0.12)
    a[10, 30] = 1
    c = accuray.compare(a, b)
    assert c.save_heat_map(tmp_path / "d.png") == 0.2
    import PIL.Image

    picture = np.asarray(PIL.Image.open(tmp_path / "d.png"))
    assert picture.shape == (50, 60, 3)
    assert picture[0, 0].tolist() == [0, 0, 0]
    assert picture[10, 30].tolist() == [255, 255, 255]
    assert np.array_equal(picture, heat_map(c.difference_map, 0.2))
    assert c.save_heat_map(tmp_path / "d.png", 0.5) == 0.5
    with pytest.raises(ImageError, match="no folder"):
        c.save_heat_map(tmp_path / "nowhere" / "d.png")


def test_false_colours_grow_steadily_in_luma() -> None:
    """Green 2011 keeps perceived intensity, Y' of the NTSC weights, equal to the value."""
    ramp = heat_map(np.linspace(0, 1, 101)[None, :], 1.0)[0].astype(float)
    luma = ramp @ [0.30, 0.59, 0.11]
    assert np.abs(luma / 255 - np.linspace(0, 1, 101)).max() < 0.02
    assert (np.diff(luma) > 0).all()


@pytest.mark.parametrize(
    ("top", "limit"), [(0, 1), (0.0009, 0.001), (0.001, 0.001), (0.0011, 0.002), (0.3, 0.5), (0.7, 1), (1, 1)]
)
def test_the_white_of_a_heat_map_is_a_round_number(top: float, limit: float) -> None:
    assert heat_range(np.full((9, 9), top)) == pytest.approx(limit)


def test_display_values_are_the_curve_of_the_png() -> None:
    assert srgb_encode(np.array([srgb_decode(0.3), -1.0, 9.0])).tolist() == pytest.approx([0.3, 0, 1])
