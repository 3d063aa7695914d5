"""Image textures and normal maps against Mitsuba 3, an independent renderer, pixel by pixel in linear XYZ.

Both are compared as ratios to a white square under the same light, so neither sensors nor lamps matter.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks import peers

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import OpenImageIO as oiio  # noqa: N813

import accuray
from accuray.film.estimates import pixel_estimates

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("mitsuba_textures.py")
PICTURES = Path(__file__).resolve().parents[2] / "scenes" / "textures"
SIZE, SPP = 24, 16384
INSIDE = slice(6, 18)
"""Rows and columns of pixels that show nothing but the square."""
MEAN_TOLERANCE = 2e-3
"""Of the mean: the two renderers' tables of RGB spectra differ by up to this."""
MEAN_SIGMAS = 3.0
SIGMAS, FLOOR = 5.0, 1e-2

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("mitsuba")), reason=f"Mitsuba: {peers.missing('mitsuba')}"),
]

Ratios = tuple[NDArray[np.float64], NDArray[np.float64]]


def picture(name: str) -> NDArray[Any]:
    """A coarse part of a shipped picture, (40, 56, 3) of 8 bits."""
    pixels: NDArray[Any] = oiio.ImageBuf(str(PICTURES / name)).get_pixels("uint8")
    return np.ascontiguousarray(pixels[::4, ::4][:40, :56])


@pytest.fixture(scope="module")
def theirs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, NDArray[np.float64]]:
    folder = tmp_path_factory.mktemp("mitsuba")
    np.save(folder / "colours.npy", picture("bricks.png"))
    np.save(folder / "normals.npy", (picture("bricks-normal.png") / 255.0).astype(np.float32))
    files = [str(folder / name) for name in ("colours.npy", "normals.npy", "out.npz")]
    command = [str(peers.python_of("mitsuba")), str(SCRIPT), *files]
    subprocess.run(command, check=True, env=peers.environment("mitsuba"), timeout=1800)
    with np.load(files[2]) as found:
        return {name: found[name].astype(np.float64) for name in found}


def ours(material: dict[str, Any], light: dict[str, Any], textures: dict[str, Any]) -> Ratios:
    film = {"width": SIZE, "height": SIZE, "filter": {"type": "box"}}
    camera = {"type": "perspective", "position": [0.5, -1, 3.5], "look_at": [0, 0, 0], "fov": 30}
    square = {"type": "rectangle", "material": "m", "corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
    scene = accuray.Scene.from_dict(
        {
            "film": film, "camera": camera, "integrator": {"type": "direct"}, "lights": {"light": light},
            "textures": textures, "materials": {"m": material}, "shapes": {"square": square},
        }
    )  # fmt: skip
    return pixel_estimates(accuray.render(scene, spp=SPP, seed=SEED).film)


def compare(name: str, found: Ratios, white: Ratios, stack: NDArray[np.float64], plain: NDArray[np.float64]) -> None:
    """Ratios to white, inside the square: every pixel within the noise and a hundredth, the mean more closely."""
    ours_white, their_white = white[0][INSIDE, INSIDE], plain[:, INSIDE, INSIDE].mean(axis=0)
    ratio, error = (values[INSIDE, INSIDE] / ours_white for values in found)
    images = stack[:, INSIDE, INSIDE] / their_white
    other, noise = images.mean(axis=0), images.std(axis=0, ddof=1) / np.sqrt(len(images))
    mean, its_noise = inner_ratio(stack, plain)
    mean = found[0][INSIDE, INSIDE].mean(axis=(0, 1)) / ours_white.mean(axis=(0, 1)) / mean - 1.0
    largest = np.abs(ratio / other - 1.0).max()
    print(f"{name}: mean {mean}, noise of theirs {its_noise}, largest difference {largest:.3%}")
    assert (np.abs(ratio - other) <= SIGMAS * np.hypot(error, noise) + FLOOR * other).all()
    assert (np.abs(mean) <= MEAN_TOLERANCE + MEAN_SIGMAS * its_noise).all()


def inner_ratio(stack: NDArray[np.float64], white: NDArray[np.float64]) -> Ratios:
    """Mean of the textured square over that of the white one, of all images, and its relative standard error."""
    textured, plain = (images[:, INSIDE, INSIDE].mean(axis=(1, 2)) for images in (stack, white))
    errors = [means.std(axis=0, ddof=1) / means.mean(axis=0) / np.sqrt(len(means)) for means in (textured, plain)]
    return textured.mean(axis=0) / plain.mean(axis=0), np.hypot(*errors)


WHITE = {"type": "diffuse", "reflectance": 1}


def test_an_image_texture_agrees_with_mitsuba(theirs: dict[str, NDArray[np.float64]]) -> None:
    sky = {"type": "constant", "radiance": "D65"}
    textures = {"t": {"type": "image", "pixels": picture("bricks.png"), "uv_scale": [2, 3]}}
    found = ours({"type": "diffuse", "reflectance": {"texture": "t"}}, sky, textures)
    compare("image", found, ours(WHITE, sky, {}), theirs["coloured"], theirs["white_sky"])


def test_a_normal_map_agrees_with_mitsuba(theirs: dict[str, NDArray[np.float64]]) -> None:
    lamp = {"type": "point", "position": [1.5, 1, 1], "intensity": 10}
    textures = {"n": {"type": "image", "pixels": picture("bricks-normal.png"), "uv_scale": [2, 3]}}
    found = ours({**WHITE, "normal_map": "n"}, lamp, textures)
    compare("normal map", found, ours(WHITE, lamp, {}), theirs["mapped"], theirs["white_lamp"])
