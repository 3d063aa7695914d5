"""Pixel filters: every filter of the list is symmetric and stays within its radius; each known one has its density."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy.special import erf

import accuray
from accuray._core import probe, schema
from accuray.testing import parameter_sets, types_of
from tests.kernels.support import SEED, FloatArray, load

TABLES = {table["name"]: table for _, table in types_of(schema.tables(), "filter")}
#: Single-precision quantiles of the two tabulated filters, linear between 129 nodes, against the exact distribution.
TABLE_ERROR = 4e-3
#: Largest u below 1.
LAST = 1.0 - 2.0**-24


def sampler(values: dict[str, Any]) -> Callable[[FloatArray], FloatArray]:
    core = load({"film": {"filter": values}})
    return lambda u: np.asarray(probe.filter_sample(core, u.astype(np.float32)), dtype=np.float64)


def grid(count: int = 1 << 16) -> FloatArray:
    """Middles of equal steps of u: exact in single precision."""
    return np.asarray((np.arange(count) + 0.5) / count)


def cases() -> list[Any]:
    return [
        pytest.param({"type": name, **values}, id=f"{name}-{i}")
        for name, table in TABLES.items()
        for i, values in enumerate(parameter_sets(table, count=6, seed=SEED))
    ]


@pytest.mark.parametrize("values", cases())
def test_offsets_rise_from_minus_radius_to_radius_symmetrically(values: dict[str, Any]) -> None:
    sample = sampler(values)
    x = sample(grid())
    radius = values["radius"]
    assert np.isfinite(x).all()
    assert np.abs(x).max() <= radius * (1.0 + 1e-6)
    assert (np.diff(x) >= -1e-6 * radius).all(), "an inverted distribution never falls"
    assert np.abs(x + x[::-1]).max() <= 2e-6 * radius
    assert abs(x.mean()) <= 1e-6 * max(radius, 1e-6)
    ends = sample(np.array([0.0, LAST]))
    assert np.allclose(ends, [-radius, radius], rtol=1e-3, atol=0.0)


def box_cdf(x: FloatArray, radius: float) -> FloatArray:
    return np.asarray(0.5 + 0.5 * x / radius)


def tent_cdf(x: FloatArray, radius: float) -> FloatArray:
    t = x / radius
    return np.asarray(0.5 + t - 0.5 * np.sign(t) * t * t)


def gaussian_cdf(x: FloatArray, radius: float, sigma: float) -> FloatArray:
    return np.asarray(0.5 + 0.5 * erf(x / (sigma * np.sqrt(2.0))) / erf(radius / (sigma * np.sqrt(2.0))))


def blackman_harris_cdf(x: FloatArray, radius: float) -> FloatArray:
    """Harris 1978, the four-term window, integrated."""
    t = np.pi * x / radius
    a = 0.48829 * np.sin(t) + 0.14128 / 2 * np.sin(2 * t) + 0.01168 / 3 * np.sin(3 * t)
    return np.asarray(0.5 + 0.5 * (x / radius + a / (0.35875 * np.pi)))


DISTRIBUTIONS: list[tuple[dict[str, Any], Callable[[FloatArray], FloatArray], float]] = [
    ({"type": "box", "radius": 0.5}, partial(box_cdf, radius=0.5), 1e-6),
    ({"type": "box", "radius": 2.0}, partial(box_cdf, radius=2.0), 1e-6),
    ({"type": "tent", "radius": 1.0}, partial(tent_cdf, radius=1.0), 1e-6),
    ({"type": "gaussian", "sigma": 0.5, "radius": 2.0}, partial(gaussian_cdf, radius=2.0, sigma=0.5), TABLE_ERROR),
    ({"type": "gaussian", "sigma": 1.0, "radius": 1.5}, partial(gaussian_cdf, radius=1.5, sigma=1.0), TABLE_ERROR),
    ({"type": "blackman_harris", "radius": 1.5}, partial(blackman_harris_cdf, radius=1.5), TABLE_ERROR),
]


def test_every_filter_of_the_list_has_its_distribution_here() -> None:
    assert {values["type"] for values, _, _ in DISTRIBUTIONS} >= set(TABLES)


@pytest.mark.parametrize(("values", "cdf", "error"), DISTRIBUTIONS, ids=lambda v: str(v) if isinstance(v, dict) else "")
def test_the_share_of_samples_below_an_offset_is_the_filter_s_integral(
    values: dict[str, Any], cdf: Callable[[FloatArray], FloatArray], error: float
) -> None:
    u = grid()
    wrong = np.abs(cdf(sampler(values)(u)) - u)
    assert wrong.max() <= error
    assert wrong.mean() <= 0.1 * error + 1e-7


def coverage(filter_values: dict[str, Any], edge: float) -> FloatArray:
    """Luminance along a row of 8 pixels whose part left of `edge` (in pixels) is a wall of radiance 1."""
    half, distance = 4.0, 8.0  # eight pixels across, one metre each, seen from 8 m
    corner, width = -40.0, 40.0 - half + edge
    scene = accuray.Scene.from_dict(
        {
            "accuray": 1,
            "film": {"width": 8, "height": 8, "filter": filter_values},
            "camera": {
                "type": "perspective",
                "position": [0, 0, distance],
                "look_at": [0, 0, 0],
                "fov": float(np.degrees(2.0 * np.arctan(half / distance))),
            },
            "materials": {"wall": {"type": "diffuse", "reflectance": 0.0, "emission": 1.0}},
            "shapes": {
                "wall": {
                    "type": "rectangle",
                    "corner": [corner, -40, 0],
                    "edge_u": [width, 0, 0],
                    "edge_v": [0, 80, 0],
                    "material": "wall",
                }
            },
        }
    )
    film = accuray.render(scene, spp=1024, seed=SEED).film
    share = film.sums[..., 3].sum(axis=2) * film.step / 1024.0
    return np.asarray(share.mean(axis=0))


def test_an_edge_under_the_box_filter_gives_the_exact_coverage() -> None:
    assert np.allclose(coverage({"type": "box"}, 3.3), [1, 1, 1, 0.3, 0, 0, 0, 0], atol=1e-3)


def test_an_edge_under_the_tent_filter_gives_the_integral_of_the_tent() -> None:
    expected = 1.0 - tent_cdf(np.clip(np.arange(8) + 0.5 - 3.3, -1.0, 1.0), 1.0)
    assert np.allclose(coverage({"type": "tent"}, 3.3), expected, atol=1e-3)
