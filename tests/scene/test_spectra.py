"""Spectra: every spelling, colorimetry against published values, scaling."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray import data
from accuray.scene import SceneError, Spectrum
from accuray.scene.errors import Document, Source, Where
from accuray.scene.paths import Confinement
from accuray.scene.schema import Param, current
from accuray.scene.scope import Scope
from accuray.scene.spectra import parse_spectrum
from accuray.scene.spectrum import interpolate, planck, xyz

PARAMS = {
    "reflectance": Param("reflectance", "spectrum", min=0.0, max=1.0, unit="1", role="reflectance"),
    "emission": Param("emission", "spectrum", min=0.0, unit="W/(m^2 sr nm)", role="emission"),
    "index": Param("ior", "spectrum", min=0.1, max=20.0, unit="1", role="index"),
}


def parse(role: str, value: Any, named: dict[str, Any] | None = None, folder: Path | None = None) -> Spectrum:
    """The spectrum that a value spells for a parameter of the role."""
    source = Source(folder=folder or Path.cwd())
    document = Document({"spectra": named or {}}, source)
    scope = Scope(document, current(), Confinement.around(source.folder))
    return parse_spectrum(PARAMS[role], value, Where(document, ("x",)), scope)


def test_numbers_and_colours() -> None:
    assert parse("reflectance", 0.25) == Spectrum("constant", "reflectance", value=0.25)
    assert parse("reflectance", {"value": 0.5, "scale": 0.5}) == parse("reflectance", 0.25)
    assert parse("reflectance", [0.1, 0.2, 0.3]) == Spectrum("rgb", "reflectance", rgb=(0.1, 0.2, 0.3))
    assert parse("reflectance", np.array([0.1, 0.2, 0.3])) == parse("reflectance", {"rgb": [0.1, 0.2, 0.3]})
    assert parse("emission", [1, 2, 3]) == Spectrum("rgb", "emission", rgb=(1.0, 2.0, 3.0), white="D65")
    assert parse("emission", {"rgb": [1, 2, 3], "scale": 2}) == parse("emission", [2, 4, 6])
    assert parse("emission", "2 W/(m^2 sr nm)") == parse("emission", 2)
    assert parse("emission", "E") == parse("emission", 1)


def test_names_by_role() -> None:
    named = {"x": {"value": 0.5}, "y": 0.25, "z": [0.1, 0.2, 0.3]}
    assert parse("reflectance", "x", named) == parse("reflectance", 0.5)
    assert parse("emission", "x", named) == parse("emission", 0.5)
    assert parse("reflectance", "y", named) == parse("reflectance", 0.25)
    assert parse("emission", "z", named) == parse("emission", [0.1, 0.2, 0.3])
    glass, illuminant = parse("index", "F2"), parse("emission", "F2")
    assert (glass.form, illuminant.form) == ("sellmeier", "table")
    assert parse("index", "F2", {"F2": {"value": 1.5}}) == parse("index", 1.5), "the scene's own names come first"


def test_blackbody_spellings_agree() -> None:
    expected = Spectrum("blackbody", "emission", kelvin=3000.0)
    for value in ("3000 K", {"blackbody": 3000}, {"blackbody": "3000 K"}, {"blackbody": "3e3 K", "scale": 1}):
        assert parse("emission", value) == expected


def test_tables_and_what_lies_outside_of_them() -> None:
    table = {"wavelengths": [500, 600], "values": [0.2, 0.4]}
    held, cut = parse("reflectance", table), parse("emission", table)
    assert (held.extrapolate, cut.extrapolate) == ("hold", "zero")
    assert [held.at(x) for x in (400, 500, 525, 600, 700)] == pytest.approx([0.2, 0.2, 0.25, 0.4, 0.4])
    assert [cut.at(x) for x in (499.9, 500, 550, 600, 600.1)] == pytest.approx([0, 0.2, 0.3, 0.4, 0])
    assert parse("emission", {**table, "extrapolate": "hold"}).at(400) == 0.2


def test_csv_column(tmp_path: Path) -> None:
    text = "\ufeff# a comment\r\nnm, a , b\r\n\r\n400, 0.1, 0.2\r\n # more\r\n500,0.3,4e-1\r\n"
    (tmp_path / "x.csv").write_text(text, encoding="utf-8", newline="")
    found = parse("reflectance", {"file": "x.csv", "column": "b"}, folder=tmp_path)
    assert found == Spectrum("table", "reflectance", wavelengths=(400.0, 500.0), values=(0.2, 0.4))


def test_measured_paint_and_lamp_come_with_the_renderer() -> None:
    white = parse("reflectance", {"file": "builtin:cornell_box_reflectance.csv", "column": "white"})
    assert len(white.wavelengths) == 76
    assert white.bounds() == (0.343, 0.777)
    lamp = parse("emission", {"file": "builtin:cornell_box_light.csv"})
    x, y, z = xyz(lamp)
    assert (x / (x + y + z), y / (x + y + z)) == pytest.approx((0.43637, 0.41755), abs=2e-5)  # physics.md C8


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [
        ("D65", 0.31273, 0.32902),
        ("A", 0.44756, 0.40743),
        ("E", 1 / 3, 1 / 3),
        ("F2", 0.3721, 0.3751),
        ("F11", 0.3805, 0.3769),
    ],
)
def test_chromaticity_of_illuminants(name: str, x: float, y: float) -> None:
    """CIE 015 values of the chromaticities; the fluorescent ones are 5 nm averages."""
    big_x, big_y, big_z = xyz(parse("emission", name))
    assert big_y == pytest.approx(1.0, abs=1e-11)
    total = big_x + big_y + big_z
    assert (big_x / total, big_y / total) == pytest.approx((x, y), abs=3e-4 if name.startswith("F") else 5e-5)


@pytest.mark.parametrize(
    ("kelvin", "x", "y"), [(2856, 0.44754, 0.40743), (3000, 0.43693, 0.40407), (6500, 0.31353, 0.32363)]
)
def test_planck(kelvin: float, x: float, y: float) -> None:
    big_x, big_y, big_z = xyz(parse("emission", f"{kelvin} K"))
    total = big_x + big_y + big_z
    assert (big_x / total, big_y / total) == pytest.approx((x, y), abs=2e-5)
    assert planck(560.0, 6500.0) == pytest.approx(42342.79, rel=1e-6)
    stefan_boltzmann = 5.670374419e-8 * kelvin**4 / math.pi
    metres = np.geomspace(1e2, 1e7, 20001)
    assert np.trapezoid([planck(nm, kelvin) for nm in metres], metres) == pytest.approx(stefan_boltzmann, rel=1e-4)


@pytest.mark.parametrize(
    "value", [{"value": 3}, {"rgb": [1, 2, 3]}, {"blackbody": 3000}, {"illuminant": "F11"},
              {"wavelengths": [550, 550.2, 550.4], "values": [0, 1, 0]}],
)  # fmt: skip
def test_normalize_and_luminance(value: dict[str, Any]) -> None:
    """Y = 1 and 1000 cd/m^2, also for a line much narrower than 1 nm; `scale` comes on top."""
    assert xyz(parse("emission", {**value, "normalize": True}))[1] == pytest.approx(1.0, rel=1e-11)
    assert xyz(parse("emission", {**value, "normalize": True, "scale": 3}))[1] == pytest.approx(3.0, rel=1e-11)
    y = xyz(parse("emission", {**value, "luminance": "1000 cd/m^2"}))[1]
    assert y * sum(data.observer().y) * 683.002 == pytest.approx(1000.0, rel=1e-11)


def test_folded_scale_has_twelve_digits() -> None:
    scale = parse("emission", {"blackbody": 3000, "normalize": True}).scale
    assert scale == float(f"{scale:.11e}")


@STEADY
@given(
    st.lists(
        st.tuples(st.floats(300, 900), st.floats(0, 100)), min_size=2, max_size=8, unique_by=lambda point: point[0]
    )
)
def test_colour_of_a_table_is_its_integral(points: list[tuple[float, float]]) -> None:
    """Against a fine midpoint sum, which shares no code with the piecewise rule."""
    points.sort()
    wavelengths, values = (tuple(column) for column in zip(*points, strict=True))
    if wavelengths[0] > 830 or wavelengths[-1] < 360:
        return
    observer = data.observer()
    fine = np.arange(360.0 + 0.005, 830.0, 0.01)
    ybar = np.interp(fine, observer.wavelengths, observer.y)
    for outside in ("hold", "zero"):
        left = right = 0.0 if outside == "zero" else None
        samples = np.interp(fine, wavelengths, values, left=left, right=right)
        spectrum = Spectrum("table", "emission", wavelengths=wavelengths, values=values, extrapolate=outside)
        assert xyz(spectrum)[1] == pytest.approx((samples * ybar).sum() / ybar.sum(), rel=2e-3, abs=2e-3)


def test_interpolation_at_its_ends() -> None:
    assert interpolate((400.0, 500.0), (1.0, 3.0), 500.0, "zero") == 3.0
    assert interpolate((400.0, 500.0), (1.0, 3.0), 400.0, "zero") == 1.0


@pytest.mark.parametrize(
    ("name", "n_d"), [("N-BK7", 1.5168), ("SF11", 1.78472), ("diamond", 2.41749), ("fused_silica", 1.45846)]
)
def test_glasses_have_the_catalogue_index(name: str, n_d: float) -> None:
    assert parse("index", name).at(587.5618) == pytest.approx(n_d, abs=2e-5)


def test_cauchy_and_sellmeier() -> None:
    assert parse("index", {"cauchy": [1.5, 0.004]}).at(500.0) == pytest.approx(1.516)
    bk7 = data.glasses()["N-BK7"]
    written = parse("index", {"sellmeier": {"B": list(bk7.B), "C": list(bk7.C)}})
    assert written == parse("index", "N-BK7")


@pytest.mark.parametrize("role", ["reflectance", "emission", "index"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 10**400, "nan", "1e999", None, True, {}, [], object()])
def test_no_form_takes_what_is_no_finite_number(role: str, bad: Any) -> None:
    forms: list[Any] = [
        bad, {"value": bad}, {"rgb": [0.1, bad, 0.1]}, [0.1, bad, 0.1], {"blackbody": bad},
        {"value": 0.2, "scale": bad},
        {"wavelengths": [400, bad], "values": [0.1, 0.2]}, {"wavelengths": [400, 500], "values": [0.1, bad]},
        {"value": 0.2, "luminance": bad}, {"cauchy": [1.5, bad]}, {"sellmeier": {"B": [bad], "C": [0.1]}},
    ]  # fmt: skip
    for form in forms:
        with pytest.raises(SceneError):
            parse(role, form)
