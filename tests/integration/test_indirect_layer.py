"""The layer `indirect`: what was scattered more than once, beside pixels that know nothing of it."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from fair import fair_scene, scene_file
from numpy.typing import NDArray

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.cli import main
from accuray.film import Image, ImageError
from accuray.film.estimates import pixel_estimates
from accuray.testing import blocks

LAYERS = ("indirect",)
SPP, SEED = 32, 11
SMALL = {"film.width": 40, "film.height": 24}
SCENES = ("cornell-box", "mirror-and-glass", "zoo", "depth-of-field", "textured")


@functools.cache
def scene(name: str) -> accuray.Scene:
    return accuray.load(scene_file(name), overrides=SMALL)


@functools.cache
def whole(name: str) -> Image:
    """All samples with the layer, by one thread."""
    return accuray.render(scene(name), spp=SPP, seed=SEED, layers=LAYERS, threads=1)


# --- What it shows


def box(reflectance: float, max_depth: int = -1) -> accuray.Scene:
    """The closed box, which glows with the radiance 1 everywhere."""
    overrides = {"film.width": 24, "film.height": 24, "integrator.max_depth": max_depth}
    return accuray.load(scene_file("closed-box"), overrides=overrides | {"materials.glowing.reflectance": reflectance})


@pytest.mark.parametrize("reflectance", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("max_depth", [-1, 0, 1, 2, 3])
def test_a_closed_box_shows_its_series_from_the_second_reflection_on(reflectance: float, max_depth: int) -> None:
    """Radiance 1 and reflectance r everywhere: 1 + r + r^2 + ..., of which r^2 + ... is indirect."""
    image = accuray.render(box(reflectance, max_depth), spp=64, seed=SEED, layers=LAYERS)
    mean, error = pixel_estimates(image.film, layer="indirect")
    bounces = 200 if max_depth < 0 else max_depth
    expected = sum(reflectance**k for k in range(2, bounces + 1))
    pixels = mean.shape[0] * mean.shape[1]
    noise = np.sqrt((error[..., 1] ** 2).sum()) / pixels
    assert abs(mean[..., 1].mean() - expected) <= 4 * noise + 1e-5 * expected


def lamp_seen_through(material: dict[str, Any], twice: bool = False) -> tuple[float, float]:
    """Luminance of a glowing wall behind one or two black-framed panes: all of it, and the indirect part."""
    pane = {"type": "rectangle", "material": "pane", "corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}
    shapes = {
        "wall": {**pane, "material": "lamp", "corner": [-1, -1, -1]},
        "pane": pane,
    }
    if twice:
        shapes["second"] = {**pane, "corner": [-1, -1, 0.5]}
    described = {
        "film": {"width": 8, "height": 8},
        "camera": {"type": "perspective", "position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 10},
        "materials": {"pane": material, "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1}},
        "shapes": shapes,
    }
    image = accuray.render(accuray.Scene.from_dict(described), spp=256, seed=SEED, layers=LAYERS)
    picture, indirect = (pixel_estimates(image.film, layer=layer)[0][..., 1].mean() for layer in ("", "indirect"))
    return float(picture), float(indirect)


def test_passing_a_pane_is_one_scattering_event() -> None:
    picture, indirect = lamp_seen_through({"type": "thin_dielectric", "ior": 1.5})
    assert picture == pytest.approx(24 / 26, rel=0.02)  # 2 n / (n^2 + 1): Stokes 1862
    assert indirect == 0.0
    picture, indirect = lamp_seen_through({"type": "thin_dielectric", "ior": 1.5}, twice=True)
    assert indirect == pytest.approx(picture, rel=1e-6)


def test_passing_a_hole_is_none() -> None:
    picture, indirect = lamp_seen_through({"type": "diffuse", "reflectance": 0, "opacity": 0.25}, twice=True)
    assert picture == pytest.approx(0.75**2, rel=0.05)
    assert indirect == 0.0


@pytest.mark.parametrize(
    ("name", "which"), [("cornell-box", "path"), ("cornell-box", "reference"), ("mirror-and-glass", "path")]
)
def test_it_is_the_picture_less_its_direct_light(name: str, which: str) -> None:
    """Against the difference of two other renders, with and without light beyond the first event."""

    def render(integrator: str, seed: int, **more: Any) -> Image:
        return accuray.render(fair_scene(name, {"type": integrator}), spp=256, seed=seed, **more)

    mean, error = pixel_estimates(render(which, 1, layers=LAYERS).film, layer="indirect")
    everything, its_error = pixel_estimates(render("path", 2).film)
    direct, their_error = pixel_estimates(render("direct", 3).film)
    for channel in range(3):
        result = blocks(
            mean[..., channel],
            error[..., channel],
            (everything - direct)[..., channel],
            np.hypot(its_error, their_error)[..., channel],
            alpha=1e-4,
            power=0.2,
            dof=3,
        )
        assert result, f"{name}, {'XYZ'[channel]}: {result.reason}"


@pytest.mark.parametrize("which", ["path", "reference", "direct"])
@pytest.mark.parametrize("name", SCENES)
def test_with_equal_numbers_it_is_that_to_the_last_step(name: str, which: str) -> None:
    """One path gives the picture, the direct light and the layer, so their sums differ by the rounding alone."""

    def sums(integrator: dict[str, Any], **more: Any) -> NDArray[np.int64]:
        overrides = SMALL | {"integrator": integrator}
        found = accuray.load(scene_file(name), overrides=overrides)
        return accuray.render(found, spp=8, seed=SEED, **more).film.sums

    first = {"type": "direct"} if which == "path" else {"type": which, "max_depth": 1}
    first = {"type": "direct"} if which == "direct" else first
    both = sums({"type": which}, layers=LAYERS)
    direct = sums(first)
    left = both[..., :3] - both[..., 4:] - direct[..., :3]
    rounding = 8 / 4 * 3 + 1e-6 * np.abs(both[..., :3])  # of each sample three values, and floats of 24 bits
    assert (np.abs(left) <= rounding).all()
    assert (both[..., 4:] >= 0).all()
    assert (which == "direct") == (not both[..., 4:].any())


# --- What it leaves as it was


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_has_the_same_bits_with_and_without(name: str) -> None:
    plain = accuray.render(scene(name), spp=SPP, seed=SEED)
    assert np.array_equal(plain.film.sums, whole(name).film.sums[..., :4])
    assert np.array_equal(plain.film.dropped, whole(name).film.dropped)
    for layer in plain.layers:
        assert np.array_equal(plain.layers[layer], whole(name).layers[layer])
    assert plain.film.channels == ("X", "Y", "Z", "A")
    assert scene(name).identity == accuray.load(scene_file(name), overrides={**SMALL, "render.layers": []}).identity


@pytest.mark.parametrize("name", SCENES)
def test_threads_ranges_and_crops_give_the_same_bits(name: str) -> None:
    def part(**arguments: Any) -> Image:
        return accuray.render(scene(name), seed=SEED, layers=LAYERS, **arguments)

    assert part(spp=SPP, threads=3).film.identical(whole(name).film)
    assert Image.merge([part(samples=(9, SPP)), part(samples=(0, 9))]).film.identical(whole(name).film)
    crops = ((0, 0, 17, 11), (0, 11, 17, 24), (17, 0, 40, 24))
    merged = Image.merge([part(spp=SPP, crop=crop) for crop in crops])
    assert merged.film.identical(whole(name).film)
    assert merged.pixels_equal(whole(name))


def test_images_with_and_without_do_not_merge() -> None:
    with pytest.raises(ImageError, match="different channels"):
        Image.merge([whole("zoo"), accuray.render(scene("zoo"), samples=(SPP, SPP + 4), seed=SEED)])


# --- Where it is asked for, and where it goes


def test_a_scene_asks_for_it_by_name() -> None:
    asking = accuray.load(scene_file("zoo"), overrides={**SMALL, "render.layers": ["indirect"]})
    assert asking.identity == scene("zoo").identity
    image = accuray.render(asking, spp=SPP, seed=SEED)
    assert image.film.identical(whole("zoo").film)
    for wrong, problem in (("indirect", "is not a list"), (["direkt"], "direkt"), (["indirect"] * 2, "twice")):
        with pytest.raises(accuray.SceneError, match=problem):
            accuray.load(scene_file("zoo"), overrides={"render.layers": wrong})
    with pytest.raises(ImageError, match="'albedo' is unknown: allowed are indirect"):
        accuray.render(scene("zoo"), spp=1, layers=["albedo"])


def test_files_hold_it(tmp_path: Path) -> None:
    image = whole("cornell-box")
    image.save(tmp_path / "a.exr")
    part = next(p for p in OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True).parts)
    for index, colour in enumerate("RGB"):
        assert np.array_equal(part.channels[f"indirect.{colour}"].pixels, image.layers["indirect"][..., index])
        assert np.array_equal(
            part.channels[f"error.indirect.{colour}"].pixels, image.layers["error.indirect"][..., index]
        )
        assert np.array_equal(part.channels[colour].pixels, np.asarray(image)[..., index])
    loaded = Image.load(tmp_path / "a.exr")
    assert loaded.film.identical(image.film)
    assert loaded.pixels_equal(image)
    assert not loaded.pixels_equal(accuray.render(scene("cornell-box"), spp=SPP, seed=SEED))
    image.save(tmp_path / "a.npy", layer="indirect")
    assert np.array_equal(np.load(tmp_path / "a.npy"), image.layers["indirect"])
    with pytest.raises(ImageError, match="allowed are rgb, indirect"):
        image.save(tmp_path / "a.png", layer="direct")


def test_the_command_line_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out.exr"
    arguments = ["render", str(scene_file("cornell-box")), "-w", "16", "--height", "16", "--spp", "4", "-o", str(out)]
    assert main([*arguments, "-q"]) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.exr", "out.png"]
    assert main([*arguments, "--layers", "indirect"]) == 0
    names = ["out.exr", "out.png", "out.indirect.png"]
    assert capsys.readouterr().out.splitlines() == [str(tmp_path / name) for name in names]
    assert (tmp_path / "out.png").read_bytes() != (tmp_path / "out.indirect.png").read_bytes()
    assert main([*arguments, "--layers", "indirekt"]) == 2
