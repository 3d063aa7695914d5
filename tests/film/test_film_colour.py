"""Colour: matrices against exact arithmetic and published values, white balance, and the sRGB encoding."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from accuray.film.colour import (
    RGB_TO_XYZ,
    XYZ_TO_RGB,
    apply,
    bradford,
    exposure_scale,
    multiply,
    srgb8,
    srgb_decode,
    srgb_encode,
    white_balance_matrix,
    xyz_to_balanced_rgb,
)


def exact_rgb_to_xyz() -> list[list[Fraction]]:
    """The normalised primary matrix of BT.709 in rational arithmetic."""
    primaries = [
        (Fraction(64, 100), Fraction(33, 100)),
        (Fraction(3, 10), Fraction(6, 10)),
        (Fraction(15, 100), Fraction(6, 100)),
    ]
    columns = [(x / y, Fraction(1), (1 - x - y) / y) for x, y in primaries]
    x, y = Fraction(3127, 10000), Fraction(3290, 10000)
    white = (x / y, Fraction(1), (1 - x - y) / y)

    def determinant(a, b, c):  # type: ignore[no-untyped-def]
        return (
            a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1])
        )

    whole = determinant(*columns)
    scale = [determinant(*(white if i == j else columns[j] for j in range(3))) / whole for i in range(3)]
    return [[columns[j][i] * scale[j] for j in range(3)] for i in range(3)]


def test_rec709_matrix_is_exact_to_double_precision() -> None:
    exact = np.array([[float(v) for v in row] for row in exact_rgb_to_xyz()])
    assert np.allclose(RGB_TO_XYZ, exact, rtol=2e-15, atol=0)
    assert np.allclose(multiply(XYZ_TO_RGB, RGB_TO_XYZ), np.eye(3), atol=1e-15)


def test_rec709_matrix_has_the_published_digits() -> None:
    assert np.allclose(RGB_TO_XYZ[1], (0.212639005872, 0.715168678768, 0.072192315361), atol=1e-12)
    assert np.allclose(XYZ_TO_RGB[0], (3.240969941905, -1.537383177570, -0.498610760293), atol=1e-12)


def test_bradford_has_the_published_digits() -> None:
    """D65 to the ACES white, as derived from ST 2065-1's chromaticity."""
    d65 = (0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290)
    aces = (0.32168 / 0.33767, 1.0, (1 - 0.32168 - 0.33767) / 0.33767)
    published = (
        (1.01303491465, 0.006105257823, -0.014970943627),
        (0.007698230125, 0.998163352118, -0.005032038535),
        (-0.002841317432, 0.004685156723, 0.924506137458),
    )
    assert np.allclose(bradford(d65, aces), published, atol=1e-11)


@pytest.mark.parametrize("white", [(1.0985, 1.0, 0.3558), (2.0, 2.0, 0.5), (0.95, 1.0, 1.2), (0.6, 0.5, 0.1)])
def test_white_balance_makes_its_white_neutral_at_unchanged_luminance(white: tuple[float, float, float]) -> None:
    assert np.allclose(apply(xyz_to_balanced_rgb(white), white), [white[1]] * 3, rtol=1e-13)


def test_no_white_balance_changes_nothing() -> None:
    assert white_balance_matrix(None) == ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    assert xyz_to_balanced_rgb(None) == XYZ_TO_RGB


@pytest.mark.parametrize("white", [(1.0, 0.0, 1.0), (1.0, -1.0, 1.0), (float("nan"), 1.0, 1.0), (0.0, 1.0, 12.0)])
def test_what_is_no_white_is_refused(white: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="white balance"):
        white_balance_matrix(white)


def test_srgb_encoding_inverts_its_decoding() -> None:
    codes = np.linspace(0, 1, 1001)
    linear = np.array([srgb_decode(v) for v in codes])
    # The standard's two branches meet only to about 1e-7.
    assert np.allclose(srgb_encode(linear), codes, atol=1e-7)
    assert srgb_encode(np.array([np.nan, -1.0, 2.0, np.inf])) == pytest.approx([0.0, 0.0, 1.0, 1.0])


def test_srgb8_is_the_nearest_code_for_every_kind_of_value() -> None:
    rng = np.random.default_rng(3)
    values = np.concatenate([rng.random(200_000), rng.random(50_000) * 0.01, 10.0 ** rng.uniform(-45, 38, 20_000)])
    values = np.float32(values)
    exact = srgb_encode(values) * 255
    assert np.abs(srgb8(values) - exact).max() <= 0.5 + 1e-4
    edges = np.float32([srgb_decode((k + 0.5) / 255) for k in range(255)])
    assert srgb8(edges).tolist() == list(range(1, 256))
    assert srgb8(np.nextafter(edges, np.float32(0))).tolist() == list(range(255))
    special = np.float32([np.nan, np.inf, -np.inf, -0.0, 0.0, 1.0, 1e-45, -3.0])
    assert srgb8(special).tolist() == [0, 255, 0, 0, 0, 255, 0, 0]


def test_exposure_is_in_stops() -> None:
    assert [exposure_scale(ev) for ev in (-1, 0, 3)] == [0.5, 1.0, 8.0]
    for ev in (float("nan"), float("inf"), 65):
        with pytest.raises(ValueError, match="exposure"):
            exposure_scale(ev)
