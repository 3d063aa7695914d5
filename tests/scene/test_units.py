"""Quantities: exact conversion, wrong dimensions, unreadable texts."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray.scene import units


@pytest.mark.parametrize(
    ("value", "unit", "length_unit", "documented", "internal"),
    [
        ("35 mm", "m", "m", 0.035, 0.035),
        (35, "m", "mm", 0.035, 0.035),
        (35.0, "m", "mm", 0.035, 0.035),
        ("3.5cm", "m", "km", 0.035, 0.035),
        ("1 ft", "m", "m", 0.3048, 0.3048),
        ("12 in", "m", "m", 0.3048, 0.3048),
        ("1e3 um", "m", "m", 1e-3, 1e-3),
        ("35 mm", "mm", "m", 35.0, 0.035),
        (35, "mm", "m", 35.0, 0.035),
        ("180 deg", "deg", "m", 180.0, math.pi),
        (90, "deg", "m", 90.0, math.pi / 2),
        ("90 °", "deg", "m", 90.0, math.pi / 2),
        (f"{math.pi} rad", "deg", "m", 180.0, math.pi),
        ("6500 K", "K", "m", 6500.0, 6500.0),
        ("1000 cd/m^2", "cd/m^2", "m", 1000.0, 1000.0),
        ("1000 nit", "cd/m^2", "m", 1000.0, 1000.0),
        ("2 lm/sr/m²", "cd/m^2", "m", 2.0, 2.0),
        ("10 W/(m^2 sr nm)", "W/(m^2 sr nm)", "m", 10.0, 10.0),
        ("10 W m^-2 sr^-1 nm^-1", "W/(m^2 sr nm)", "m", 10.0, 10.0),
        ("10 W/m^2/sr/um", "W/(m^2 sr nm)", "m", 0.01, 0.01),
        ("2 mW/(sr nm)", "W/(sr nm)", "m", 0.002, 0.002),
        ("-1.5 EV", "EV", "m", -1.5, -1.5),
        ("40 ms", "s", "m", 0.04, 0.04),
        (7, "", "mm", 7.0, 7.0),
        (7, "1", "mm", 7.0, 7.0),
    ],
)
def test_resolve(value: int | float | str, unit: str, length_unit: str, documented: float, internal: float) -> None:
    assert units.resolve(value, unit, length_unit) == (documented, internal)


@pytest.mark.parametrize(
    ("value", "unit"),
    [
        ("35 mm", "deg"), ("35", "m"), ("", "m"), ("mm", "m"), ("1 parsec", "m"), ("nan m", "m"), ("inf m", "m"),
        ("1e999 m", "m"), ("0x10 m", "m"), ("1_000 m", "m"), ("1 m m", "m"), ("3 m^99", "m"), ("3 /m", "m"),
        ("3 W/(m^2", "m"), ("3 W)", "W"), ("3 (m)(", "m"), ("3 m^", "m"), ("3 ^2", "m"), ("3 W/", "W"), ("1,5 m", "m"),
        ("10 W/sr", "W/(sr nm)"), ("800 lm", "W/(sr nm)"), ("500 lux", "W/(m^2 sr nm)"), ("3 m", ""), ("9" * 200, "m"),
        (math.nan, "m"), (math.inf, ""), (10**400, "m"),
    ],
)  # fmt: skip
def test_unreadable_or_wrong_dimension(value: int | float | str, unit: str) -> None:
    with pytest.raises(units.UnitError):
        units.resolve(value, unit)


@STEADY
@given(
    st.decimals(min_value="-1e6", max_value="1e6", places=6, allow_nan=False),
    st.sampled_from([("mm", 3), ("cm", 2), ("um", 6), ("m", 0), ("km", -3)]),
)
def test_every_spelling_of_a_length_is_the_same_correctly_rounded_float(number: object, unit: tuple[str, int]) -> None:
    exact = Fraction(str(number)) / Fraction(10) ** unit[1]
    metres = float(exact)
    assert units.resolve(f"{number} {unit[0]}", "m")[1] == metres
    assert units.resolve(f"{number}{unit[0]}", "m", "ft")[1] == metres
    assert units.resolve(float(str(number)), "m", unit[0])[1] == metres


@STEADY
@given(st.text(max_size=40))
def test_any_text_is_a_number_or_a_unit_error(text: str) -> None:
    try:
        value, _ = units.resolve(text, "m")
    except units.UnitError:
        return
    assert math.isfinite(value)


def test_every_documented_unit_describes_itself() -> None:
    for unit in ("m", "deg", "K", "cd/m^2", "", "1", "EV", "W/(sr nm)"):
        units.parse_unit(unit)
        assert units.describe(unit)
