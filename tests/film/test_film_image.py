"""Images: the array protocol, layers, metadata, PNG and NPY files."""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from accuray.film import Film, Image, ImageError
from accuray.film.colour import srgb8
from accuray.film.png import encode_png, shrink

FilmMaker = Callable[..., Film]


def uniform(value: float, size: tuple[int, int] = (8, 6), alpha: float = 1.0) -> Film:
    """A film whose samples are all XYZ of a grey D65 light of luminance `value`."""
    film = Film.empty(*size)
    xyz = np.array([0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290]) * value
    film.sums[..., :3] = np.rint(xyz / film.step)
    film.sums[..., 3] = round(alpha / film.step)
    film.cover(0, 4)
    return film


def decode(png: bytes) -> np.ndarray:
    return np.asarray(PIL.Image.open(io.BytesIO(png)))


def test_array_is_linear_rec709(make_film: FilmMaker) -> None:
    array = np.asarray(Image(uniform(0.25)))
    assert array.shape == Image(uniform(0.25)).shape == (6, 8, 3)
    assert array.dtype == np.float32
    assert np.allclose(array, 0.25, rtol=1e-6)


def test_array_honours_dtype_and_copy(make_film: FilmMaker) -> None:
    image = Image(make_film(0, 4))
    array = np.asarray(image)
    array[...] = -1
    assert (np.asarray(image) != -1).all()
    assert np.asarray(image, dtype=np.float64).dtype == np.float64
    view = image.__array__(copy=False)
    assert not view.flags.writeable
    with pytest.raises(ValueError, match="a copy is needed"):
        image.__array__(np.float64, copy=False)
    assert float(np.mean(image)) == pytest.approx(float(view.mean()), rel=1e-6)


def test_white_balance_is_in_the_pixels_and_exposure_is_not(make_film: FilmMaker) -> None:
    film = uniform(0.5)
    film.sums[..., 0] = np.rint(0.5 * 1.1 / film.step)
    film.sums[..., 2] = np.rint(0.5 * 0.35 / film.step)
    balanced = np.asarray(Image(film, {"white_balance": (1.1, 1.0, 0.35), "exposure": 3.0}))
    assert np.allclose(balanced, 0.5, rtol=1e-6)
    assert not np.allclose(np.asarray(Image(film)), 0.5, rtol=0.1)
    with pytest.raises(ImageError, match=r"metadata\.white_balance"):
        _ = Image(film, {"white_balance": (1.0, 0.0, 1.0)}).colour_matrix


def test_layers(image: Image) -> None:
    layers = image.layers
    assert list(layers) == ["rgb", "alpha", "error", "xyz", "samples", "dropped"]
    assert len(layers) == 6
    assert layers["xyz"].dtype == np.float64
    assert np.array_equal(layers["xyz"], image.film.mean()[..., :3])
    assert np.array_equal(layers["samples"], image.film.samples())
    assert layers["dropped"].sum() == image.film.dropped_total
    assert layers["rgb"] is layers["rgb"]
    assert not any(layer.flags.writeable for layer in layers.values())
    with pytest.raises(KeyError, match="allowed are rgb, alpha"):
        layers["depth"]


def test_region_spaces(image: Image) -> None:
    xyz = image.region(1, 9, 2, 8, space="xyz")
    assert np.allclose(xyz.mean, image.layers["xyz"][2:8, 1:9].mean(axis=(0, 1)))
    rgb = image.region(1, 9, 2, 8)
    assert np.allclose(rgb.mean, np.asarray(image)[2:8, 1:9].mean(axis=(0, 1)), rtol=1e-6)
    with pytest.raises(ImageError, match="'lab' is unknown: allowed are rgb, xyz"):
        image.region(0, 1, 0, 1, space="lab")


def test_metadata_must_be_storable() -> None:
    film = uniform(0.1)
    with pytest.raises(ImageError, match=r"metadata\.a\[1\]: nan is not a finite number"):
        Image(film, {"a": [1, float("nan")]})
    with pytest.raises(ImageError, match=r"metadata\.b: a set cannot be stored"):
        Image(film, {"b": {1}})
    assert Image(film, {"t": (1, np.float32(0.5)), "n": np.arange(2)}).metadata == {"t": [1, 0.5], "n": [0, 1]}


def test_pixels_equal_compares_bits(make_film: FilmMaker) -> None:
    image = Image(make_film(0, 3))  # three samples of four replicates: the errors are infinite
    assert image.pixels_equal(Image(make_film(0, 3), {"seed": 9}))
    assert not image.pixels_equal(Image(make_film(0, 3), {"white_balance": [1.0, 1.0, 1.0]}))
    assert not image.pixels_equal(Image(make_film(0, 3, window=(0, 0, 37, 20))))


def test_png_is_srgb_with_the_metadata_exposure(tmp_path: Path) -> None:
    image = Image(uniform(0.1), {"exposure": 1.0})
    image.save(tmp_path / "a.png")
    image.save(tmp_path / "b.PNG", exposure=-2.0)
    opened = PIL.Image.open(tmp_path / "a.png")
    assert (opened.mode, opened.size) == ("RGB", (8, 6))
    assert "srgb" in opened.info
    assert (np.asarray(opened) == srgb8(np.float32([0.2]))[0]).all()
    assert (decode((tmp_path / "b.PNG").read_bytes()) == srgb8(np.float32([0.025]))[0]).all()


def test_png_without_environment_has_straight_alpha() -> None:
    image = Image(uniform(0.1, alpha=0.25), {"hide_environment": True})
    pixels = decode(image._png())
    assert pixels.shape == (6, 8, 4)
    assert (pixels[..., 3] == 64).all()
    assert (pixels[..., :3] == srgb8(np.float32([0.4]))[0]).all()
    assert decode(Image(uniform(0.1, alpha=0.0), {"hide_environment": True})._png()).max() == 0


def test_png_survives_any_value() -> None:
    rgb = np.float32([[[np.nan, np.inf, -np.inf], [-1.0, 3e38, 0.5]]])
    assert decode(encode_png(rgb, exposure=60.0)).tolist() == [[[0, 255, 0], [0, 255, 255]]]
    assert decode(encode_png(rgb, np.float32([[np.nan, 2.0]]))).tolist()[0][1] == [0, 255, 188, 255]


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (7, 1), (40, 31), (300, 1000)])
@pytest.mark.parametrize("transparent", [False, True])
def test_png_pixels_survive_every_filter(shape: tuple[int, int], transparent: bool) -> None:
    """Noise, ramps along both axes and flat parts: each filter of PNG is the best one for some row."""
    generator = np.random.default_rng(7)
    y, x = np.indices(shape)
    ramps = np.stack([x / max(shape[1], 1), y / max(shape[0], 1), (x + y) / sum(shape)], axis=2)
    noisy = np.where((y % 4 == 0)[:, :, None], generator.random((*shape, 3)), ramps).astype(np.float32)
    alpha = np.where(y % 3 == 0, np.float32(1.0), np.float32(0.5)) if transparent else None
    pixels = decode(encode_png(noisy, alpha))
    assert pixels.shape == (*shape, 4 if transparent else 3)
    straight = noisy if alpha is None else noisy / alpha[:, :, None]
    assert np.array_equal(pixels[:, :, :3], srgb8(straight))


def test_png_bytes_are_repeatable(image: Image, tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        Image(image.film, image.metadata).save(tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_bad_exposure_is_refused_and_leaves_no_file(image: Image, tmp_path: Path) -> None:
    with pytest.raises(ImageError, match="exposure 99 EV is out of range"):
        image.save(tmp_path / "a.png", exposure=99)
    assert not list(tmp_path.iterdir())


def test_npy_holds_the_array(image: Image, tmp_path: Path) -> None:
    image.save(tmp_path / "a.npy")
    assert np.array_equal(np.load(tmp_path / "a.npy"), np.asarray(image))


def test_other_extensions_are_refused_with_the_allowed_ones(image: Image, tmp_path: Path) -> None:
    for name in ("a.jpg", "a"):
        with pytest.raises(ImageError, match=r"unknown image extension .*allowed are \.exr, \.png, \.npy"):
            image.save(tmp_path / name)


def test_notebooks_get_at_most_960_pixels() -> None:
    assert decode(Image(uniform(0.2, (30, 7)))._repr_png_()).shape == (7, 30, 3)
    assert decode(Image(uniform(0.2, (2500, 10)))._repr_png_()).shape == (4, 834, 3)


def test_shrinking_averages_blocks() -> None:
    values = np.float32(np.random.default_rng(2).random((5, 7, 1)))
    small = shrink(values, 3)
    assert small.shape == (2, 3, 1)
    assert small[0, 0, 0] == pytest.approx(values[:3, :3].mean(), rel=1e-6)
    assert small[1, 2, 0] == pytest.approx(values[3:, 6:].mean(), rel=1e-6)
    assert shrink(values, 7) is values


def test_repr_says_what_it_holds(make_film: FilmMaker) -> None:
    assert repr(Image(make_film(2, 6, window=(0, 0, 5, 4)))) == "<accuray.Image 5x4 of 37x21, samples 2:6>"


def test_importing_images_leaves_the_encoders_for_later() -> None:
    code = "import sys, accuray.film; print([m for m in ('OpenEXR', 'PIL', 'statistics') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
