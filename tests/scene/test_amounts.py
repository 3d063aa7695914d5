"""Amounts of light, lm, cd, lx, nit and W, in place of spectral quantities: by hand from 683 lm/W and ybar."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from accuray import data
from accuray.formats import Scene
from accuray.scene import SceneError, Spectrum
from accuray.scene.spectrum import planck, xyz

LUMENS = 683.002 * math.fsum(data.observer().y)
"""lm of a spectrum that is 1 W/nm at all wavelengths."""
NANOMETRES = 470.0

LIGHTS = {
    "point": "intensity",
    "spot": "intensity",
    "directional": "irradiance",
    "constant": "radiance",
}


def emission(kind: str, value: Any) -> Spectrum:
    """The resolved emission of a light, or of a material."""
    if kind == "material":
        scene = Scene.from_dict({"materials": {"m": {"type": "diffuse", "emission": value}}})
        found = scene.materials["m"]["emission"]
    else:
        found = Scene.from_dict({"lights": {"l": {"type": kind, LIGHTS[kind]: value}}}).lights["l"][LIGHTS[kind]]
    assert isinstance(found, Spectrum)
    return found


@pytest.mark.parametrize(
    ("kind", "text", "expected"),
    [
        ("point", "100 cd", 100.0 / LUMENS),
        ("point", "100 lm/sr", 100.0 / LUMENS),
        ("point", "10 W/sr", 10.0 / NANOMETRES),
        ("point", "250 mW/sr", 0.25 / NANOMETRES),
        ("point", "2 W/(sr nm)", 2.0),
        ("point", "2 W/sr/um", 0.002),
        ("spot", "5000 cd", 5000.0 / LUMENS),
        ("directional", "500 lx", 500.0 / LUMENS),
        ("directional", "500 lux", 500.0 / LUMENS),
        ("directional", "1 lm/ft^2", 1.0 / 0.3048**2 / LUMENS),
        ("directional", "1000 W/m^2", 1000.0 / NANOMETRES),
        ("directional", "0.1 W/cm^2", 1000.0 / NANOMETRES),
        ("directional", "1.5 W/(m^2 nm)", 1.5),
        ("constant", "300 nit", 300.0 / LUMENS),
        ("constant", "300 cd/m^2", 300.0 / LUMENS),
        ("constant", "0.03 cd/cm^2", 300.0 / LUMENS),
        ("constant", "8 W/(m^2 sr)", 8.0 / NANOMETRES),
        ("material", "300 nit", 300.0 / LUMENS),
        ("material", "8 W/m^2/sr", 8.0 / NANOMETRES),
    ],
)
def test_a_quantity_is_white_light_of_that_amount(kind: str, text: str, expected: float) -> None:
    found = emission(kind, text)
    assert found.form == "constant"
    assert found.value == pytest.approx(expected, rel=1e-7)
    assert not found.flux


@pytest.mark.parametrize(
    "shape", [{"value": 3.0}, {"blackbody": "2700 K"}, {"illuminant": "F11"}, {"rgb": [1, 0.6, 0.2]}]
)
@pytest.mark.parametrize(
    ("kind", "key", "text"),
    [
        ("point", "intensity", "100 cd"),
        ("point", "intensity", 100),
        ("spot", "intensity", "100 lm/sr"),
        ("directional", "illuminance", "100 lx"),
        ("directional", "illuminance", 100),
        ("constant", "luminance", "100 nit"),
        ("material", "luminance", 100),
    ],
)
def test_a_spectrum_keeps_its_shape_and_gets_the_luminous_amount(
    shape: dict[str, Any], kind: str, key: str, text: Any
) -> None:
    found, plain = emission(kind, {**shape, key: text}), emission(kind, shape)
    assert xyz(found)[1] * LUMENS == pytest.approx(100.0, rel=1e-7)
    ratio = xyz(found)[1] / xyz(plain)[1]
    assert xyz(found) == pytest.approx([ratio * value for value in xyz(plain)], rel=1e-9)


@pytest.mark.parametrize(
    ("kind", "key", "text"),
    [
        ("point", "intensity", "12 W/sr"),
        ("directional", "irradiance", "12 W/m^2"),
        ("constant", "radiance", 12),
        ("material", "radiance", "12 W/(m^2 sr)"),
    ],
)
def test_watts_count_the_light_from_360_to_830_nm(kind: str, key: str, text: Any) -> None:
    """Planck's law by the midpoint rule; a table by trapezoids, which its corners make exact."""
    found = emission(kind, {"blackbody": "3000 K", key: text})
    total = math.fsum(planck(360.05 + 0.1 * i, 3000.0) for i in range(4700)) * 0.1 * found.scale
    assert total == pytest.approx(12.0, rel=1e-6)
    table = emission(kind, {"wavelengths": [300, 500, 600, 900], "values": [0, 2, 1, 1], key: text})
    area = 0.5 * (0.6 + 2.0) * 140.0 + 1.5 * 100.0 + 230.0
    assert area * table.scale == pytest.approx(12.0, rel=1e-9)


def test_a_scale_comes_after_the_amount() -> None:
    doubled = emission("point", {"illuminant": "A", "intensity": "50 cd", "scale": 2})
    assert doubled.scale == pytest.approx(emission("point", {"illuminant": "A", "intensity": "100 cd"}).scale)


@pytest.mark.parametrize(
    ("text", "expected"), [("800 lm", 800.0 / LUMENS), ("9 W", 9.0 / NANOMETRES), ("9 kW", 9000.0 / NANOMETRES)]
)
@pytest.mark.parametrize("kind", ["point", "spot", "material"])
def test_a_flux_is_that_of_the_whole_emitter(kind: str, text: str, expected: float) -> None:
    found = emission(kind, text)
    assert found.flux
    assert found.value == pytest.approx(expected, rel=1e-7)
    assert emission(kind, {"value": 1, "flux": text}) == found
    assert emission(kind, {"value": 1, "flux": text}).times(2.0).flux


@pytest.mark.parametrize(
    ("kind", "value", "complaint"),
    [
        ("constant", "800 lm", "has the wrong unit"),
        ("directional", "800 lm", "has the wrong unit"),
        ("directional", "10 W", "has the wrong unit"),
        ("directional", "100 cd", r"has the wrong unit: allowed .*W/\(m\^2 nm\), lx, W/m\^2"),
        ("point", "100 lx", r"has the wrong unit: allowed .*W/\(sr nm\), cd, W/sr, lm, W\)"),
        ("point", "100 nit", "has the wrong unit"),
        ("material", "100 cd", "has the wrong unit"),
        ("material", "100 lx", "has the wrong unit"),
        ("point", "-5 cd", "is out of range"),
        ("point", "1e400 cd", "too large"),
        ("point", {"value": 1, "flux": "-5 lm"}, "is out of range"),
        ("point", {"value": 1, "flux": "5 m"}, "has the wrong unit"),
        ("point", {"value": 1, "intensity": "5 W"}, "has the wrong unit"),
        ("point", {"value": 1, "illuminance": 5}, "does not fit this parameter: allowed intensity or flux or scale"),
        ("constant", {"value": 1, "flux": 5}, "does not fit this parameter: allowed luminance or radiance or scale"),
        ("directional", {"value": 1, "flux": 5}, "allowed illuminance or irradiance or scale"),
        ("point", {"value": 1, "intensity": 5, "flux": 5}, "cannot go with `flux`"),
        ("point", {"value": 1, "intensity": 5, "normalize": True}, "cannot go with `normalize`"),
        ("point", {"value": 0, "flux": 5}, "has no visible light"),
        ("point", {"wavelengths": [360, 361, 362], "values": [0, 0, 0], "flux": "5 W"}, "has no light between"),
        ("point", {"rgb": [1, 1, 1], "flux": "5 W"}, "is an RGB colour, whose power is known in lm but not in W"),
    ],
)  # fmt: skip
def test_an_amount_that_does_not_fit_is_refused(kind: str, value: Any, complaint: str) -> None:
    with pytest.raises(SceneError, match=complaint) as caught:
        emission(kind, value)
    assert caught.value.key.startswith(("lights.l.", "materials.m.emission"))


def test_an_amount_is_for_emissions_only() -> None:
    with pytest.raises(SceneError, match="is for emissions, and this is a reflectance"):
        Scene.from_dict({"materials": {"m": {"type": "diffuse", "reflectance": {"value": 0.5, "luminance": 5}}}})


@pytest.mark.parametrize("key", ["luminance", "radiance", "intensity", "illuminance", "irradiance", "flux"])
def test_a_named_spectrum_may_have_an_amount(key: str) -> None:
    used = {"luminance": "constant", "radiance": "constant", "intensity": "point", "flux": "spot"}
    kind = used.get(key, "directional")
    table = {"type": kind, LIGHTS[kind]: "warm"}
    description = {"spectra": {"warm": {"blackbody": "2700 K", key: 5}}, "lights": {"l": table}}
    assert Scene.from_dict(description).lights["l"][LIGHTS[kind]].form == "blackbody"
    Scene.from_dict({"spectra": description["spectra"]})


@pytest.mark.parametrize("kind", LIGHTS)
def test_colour_temperatures_and_illuminants_are_for_every_light(kind: str) -> None:
    assert emission(kind, "2700 K").kelvin == 2700.0
    assert xyz(emission(kind, "D65"))[1] == pytest.approx(1.0)
    assert emission(kind, [1, 0.5, 0.2]).white == "D65"


def test_a_textured_emission_takes_the_luminance_of_white(tmp_path: Path) -> None:
    def scale(value: Any) -> float:
        materials = {"m": {"type": "diffuse", "emission": {"texture": "t", "scale": value}}}
        textures = {"t": {"type": "checker"}}
        return float(Scene.from_dict({"textures": textures, "materials": materials}).materials["m"]["emission"].scale)

    assert scale("300 nit") == pytest.approx(300.0 / LUMENS, rel=1e-7)
    assert scale(300) == 300.0
    with pytest.raises(SceneError, match="has the wrong unit"):
        scale("300 lm")


def test_equal_spellings_are_the_same_scene_and_a_flux_is_another() -> None:
    def identity(value: Any) -> str:
        return Scene.from_dict({"lights": {"l": {"type": "point", "intensity": value}}}).identity

    assert identity("100 cd") == identity("100 lm/sr")
    assert identity({"illuminant": "A", "flux": "100 lm"}) != identity({"illuminant": "A", "intensity": "100 cd"})
