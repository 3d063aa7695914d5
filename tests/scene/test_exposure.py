"""Exposure by film speed, shutter and f-number: the saturation-based speed of ISO 12232, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import accuray
from accuray.scene.exposure import LUMINANCE, physical_exposure

CAMERA = {"type": "perspective", "focal_length": "50 mm", "film_size": "24 mm", "f_number": 2.8}


def scene(film: dict[str, Any], camera: dict[str, Any] | None = None) -> accuray.Scene:
    return accuray.Scene.from_dict({"film": film, "camera": CAMERA if camera is None else camera})


def test_a_grey_card_in_sunlight_by_the_sunny_16_rule() -> None:
    """At f/16, 1/100 s and ISO 100 (EV 15) white is 1.2 x 2^15 cd/m^2; a card of 18 % under 80 klx is grey."""
    exposure = physical_exposure(100.0, 0.01, 16.0)
    white = LUMINANCE / 2.0**exposure
    assert white == pytest.approx(1.2 * 16.0**2 / 0.01)
    card = 0.18 * 80_000 / np.pi
    assert 0.1 < card / white < 0.2


def test_each_setting_counts_in_stops() -> None:
    base = physical_exposure(100.0, 0.01, 4.0)
    assert physical_exposure(200.0, 0.01, 4.0) == pytest.approx(base + 1.0)
    assert physical_exposure(100.0, 0.04, 4.0) == pytest.approx(base + 2.0)
    assert physical_exposure(100.0, 0.01, 8.0) == pytest.approx(base - 2.0)


def test_the_png_shows_the_luminance_that_saturates_as_white() -> None:
    settings = {"iso": 400, "shutter": "8 ms", "width": 4, "height": 4}
    white = 78.0 * 2.8**2 / (0.65 * 0.008 * 400.0)
    sky = {"illuminant": "D65", "luminance": f"{0.2140411 * white!r} cd/m^2"}  # sRGB 127.5 of 255
    described = {"film": settings, "camera": CAMERA, "lights": {"sky": {"type": "constant", "radiance": sky}}}
    image = accuray.render(accuray.Scene.from_dict(described), spp=256)
    exposure = float(image.metadata["exposure"])
    assert exposure == pytest.approx(np.log2(LUMINANCE / white))
    shown = np.asarray(image)[..., 1].mean() * 2.0**exposure
    assert shown == pytest.approx(0.2140411, rel=0.01)


def test_it_is_display_only_and_moves_the_unit_as_an_exposure_in_ev_does() -> None:
    physical = scene({"iso": 100, "shutter": 0.01})
    in_stops = scene({"exposure": physical.film["exposure"]})
    assert physical.film["unit"] == in_stops.film["unit"]
    assert physical.identity == in_stops.identity
    assert scene({"iso": 100, "shutter": 0.01, "unit": 1e-9}).identity == scene({"unit": 1e-9}).identity


@pytest.mark.parametrize(
    ("film", "camera", "key", "message"),
    [
        ({"iso": 100, "shutter": 0.01, "exposure": 1}, CAMERA, "film.shutter", "exactly one of"),
        ({"iso": 100}, CAMERA, "film", "lacks `shutter`"),
        ({"iso": 0, "shutter": 1}, CAMERA, "film.iso", "out of range"),
        ({"iso": 100, "shutter": "1 m"}, CAMERA, "film.shutter", "wrong unit"),
        ({"iso": 100, "shutter": 1}, {"type": "perspective"}, "film.iso", "needs the camera's f-number"),
        ({"iso": 100, "shutter": 1}, {"type": "panorama"}, "film.iso", "needs the camera's f-number"),
        ({"iso": 1e9, "shutter": 1e9}, CAMERA, "film.iso", "-60 to 60 EV"),
    ],
)
def test_what_is_refused(film: dict[str, Any], camera: dict[str, Any], key: str, message: str) -> None:
    with pytest.raises(accuray.SceneError, match=message) as caught:
        scene(film, camera)
    assert caught.value.key == key
