"""Lights beyond everything: what sample() draws has the density that pdf() says, and the light that it should carry."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import accuray
from accuray._core import probe
from accuray.devices.lowering import lower
from accuray.testing import Plane, chi2_test
from tests.kernels.support import SEED, WAVELENGTHS, FloatArray, load, single, uniform, unit
from tests.oracles import hosek_wilkie

Description = dict[str, Any]
ORIGIN = [0.0, 0.0, 0.0]


def noise(height: int, width: int, channels: int = 3) -> FloatArray:
    """A map of great contrast."""
    return np.random.default_rng(5).random((height, width, channels)) ** 6


def one_texel(row: int, column: int, height: int = 16, width: int = 32) -> FloatArray:
    pixels = np.zeros((height, width))
    pixels[row, column] = 1.0
    return pixels


def environment(pixels: Any, **more: Any) -> Description:
    return {"type": "environment", "pixels": pixels, **more}


TURN = {"rotate": {"axis": [1, 2, -0.5], "angle": 40}}
MIRROR = {"matrix": [-2, 0, 0, 5, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}


@dataclass(frozen=True)
class Case:
    """A light of `kind`, number `number` of a scene that has this one description."""

    name: str
    kind: str
    light: Description
    number: int = 0
    axes: FloatArray | None = None
    """Columns: the axes of the light's map in the world."""

    @property
    def core(self) -> Any:
        return load({"lights": {"sky": self.light}})


def about_up(degrees: float) -> FloatArray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def about(axis: FloatArray, degrees: float) -> FloatArray:
    x, y, z = axis
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(c * np.eye(3) + s * cross + (1 - c) * np.outer(axis, axis))


CASES = [
    Case("map", "environment", environment(noise(8, 16))),
    Case("odd-map", "environment", environment(noise(5, 3))),
    Case("row", "environment", environment(noise(1, 4))),
    Case("column", "environment", environment(noise(4, 1))),
    Case("grey-texel", "environment", environment([[2.0]])),
    Case("one-texel", "environment", environment(one_texel(5, 20))),
    Case("pole", "environment", environment(one_texel(0, 3))),
    Case("integers", "environment", environment((255 * noise(8, 16)).astype(np.uint8))),
    Case("alpha", "environment", environment(noise(8, 16, 4))),
    Case("turned", "environment", environment(noise(8, 16), rotation=70), axes=about_up(70)),
    Case(
        "moved",
        "environment",
        environment(noise(8, 16), rotation=-20, transform=TURN, scale=3),
        axes=about(unit(1, 2, -0.5), 40) @ about_up(-20),
    ),
    Case("mirrored", "environment", environment(noise(8, 16), transform=MIRROR), axes=np.diag([-1.0, 1.0, 1.0])),
    Case("sun", "sun", {"type": "sun", "elevation": 30, "azimuth": 100, "irradiance": 2}),
    Case("low-sun", "sun", {"type": "sun", "towards": [3, -0.1, 1], "radiance": 5, "angular_diameter": 8}),
    Case("half-sky", "sun", {"type": "sun", "elevation": 90, "angular_diameter": 180}),
    Case("sky", "sky", {"type": "sky", "elevation": 40, "azimuth": 30}),
    Case("haze", "sky", {"type": "sky", "turbidity": 10, "elevation": 5, "ground_albedo": [0.1, 0.6, 0.2]}),
    Case("noon", "sky", {"type": "sky", "turbidity": 1, "elevation": 90, "scale": 7}),
    Case("disc", "sun", {"type": "sky", "elevation": 40, "azimuth": 30}, number=1),
    Case("large-disc", "sun", {"type": "sky", "elevation": 10, "azimuth": -30, "angular_diameter": 6}, number=1),
]
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)


COLOURED = {case.name for case in CASES if case.kind == "environment" and np.ndim(case.light["pixels"]) == 3}
"""Luminance says little about single wavelengths of these."""


def draw(case: Case, core: Any, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    s = probe.light_sample(core, case.number, ORIGIN, single(u))
    wi, pdf, scale = (np.asarray(s[key], dtype=np.float64) for key in ("wi", "pdf", "scale"))
    return wi, pdf, scale


def density(case: Case, core: Any, wi: FloatArray) -> FloatArray:
    return np.asarray(probe.light_pdf(core, case.number, ORIGIN, single(wi)), dtype=np.float64)


def radiance(case: Case, core: Any, wi: FloatArray) -> FloatArray:
    return np.asarray(probe.light_radiance(core, case.number, WAVELENGTHS, single(wi)), dtype=np.float64)


def to_map(directions: FloatArray) -> FloatArray:
    """Places (x right, y down) of a map whose middle is -Z, whose right half is towards +X and whose top is +Y."""
    x, y, z = directions.T
    return np.stack([0.5 + np.arctan2(x, -z) / (2 * np.pi), np.arctan2(np.hypot(x, z), y) / np.pi], axis=1)


def from_map(places: FloatArray) -> FloatArray:
    longitude, polar = (places[:, 0] - 0.5) * 2 * np.pi, places[:, 1] * np.pi
    around = np.sin(polar)
    return np.stack([around * np.sin(longitude), np.cos(polar), -around * np.cos(longitude)], axis=1)


def grid(height: int, width: int) -> tuple[FloatArray, FloatArray]:
    """Directions all over the sphere and the solid angle that each stands for."""
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    edges = np.cos(np.linspace(0.0, np.pi, height + 1))
    weights = np.repeat((edges[:-1] - edges[1:]) * 2 * np.pi / width, width)
    return from_map(np.stack([x.ravel(), y.ravel()], axis=1)), weights


@each_case
def test_it_becomes_the_light_it_should(case: Case) -> None:
    assert probe.light_names(case.core)[case.number] == case.kind


@each_case
def test_a_ray_finds_the_very_density_of_the_sample(case: Case) -> None:
    core = case.core
    wi, pdf, scale = draw(case, core, uniform(20_000, 2, SEED))
    assert np.isfinite(wi).all()
    assert np.isfinite(pdf).all()
    assert np.abs(np.linalg.norm(wi, axis=1) - 1.0).max() < 1e-6
    assert (pdf > 0.0).mean() > 0.999
    assert ((pdf > 0.0) == (scale == 1.0)).all()
    found = density(case, core, wi)
    if case.kind == "sun":  # rounding moves a few over the edge
        assert (found != pdf).mean() < 1e-3
    else:
        assert (found == pdf).all()


@each_case
def test_directions_follow_the_density(case: Case) -> None:
    """Chi-square over the map, or over the disc, where the density is bounded."""
    core = case.core
    if case.kind == "sun":
        sampler, pdf, domain = disc_test(case, core)
    else:
        axes = np.eye(3) if case.axes is None else case.axes
        domain = Plane((0.0, 1.0), (0.0, 1.0))

        def sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
            wi, found, _ = draw(case, core, u)
            return to_map(wi @ axes), (found > 0.0).astype(np.float64)

        def pdf(places: FloatArray) -> FloatArray:
            wi = from_map(places)
            return density(case, core, wi @ axes.T) * 2 * np.pi**2 * np.hypot(wi[:, 0], wi[:, 2])

    result = chi2_test(
        sampler, pdf, domain=domain, samples=100_000, resolution=(32, 32), tests=len(CASES), seed=SEED, tolerance=5e-3
    )
    assert result, f"seed {SEED}: {result.reason}"


def disc_test(case: Case, core: Any) -> tuple[Any, Any, Plane]:
    """Sampler and density on the square that a disc is mapped to, preserving solid angle."""
    towards = sun_towards(case.light)
    height = 1.0 - math.cos(math.radians(case.light.get("angular_diameter", 0.533)) / 2)
    x = unit(*np.cross(towards, unit(0.3, 0.5, -0.8)))
    y = np.cross(towards, x)

    def sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        wi, found, _ = draw(case, core, u)
        square = ((wi - towards) ** 2).sum(axis=1) / (2 * height)
        angle = np.arctan2(wi @ y, wi @ x) / (2 * np.pi) % 1.0
        return np.stack([np.minimum(square, 1.0), angle], axis=1), (found > 0.0).astype(np.float64)

    def pdf(square: FloatArray) -> FloatArray:
        drop, phi = 0.9999 * height * square[:, :1], 2 * np.pi * square[:, 1:]
        wi = np.sqrt(drop * (2 - drop)) * (np.cos(phi) * x + np.sin(phi) * y) + (1 - drop) * towards
        return density(case, core, wi) * 2 * np.pi * height

    return sampler, pdf, Plane((0.0, 1.0), (0.0, 1.0))


def sun_towards(light: Description) -> FloatArray:
    if "towards" in light:
        return unit(*light["towards"])
    e, a = (math.radians(light.get(key, default)) for key, default in (("elevation", 45), ("azimuth", 0)))
    return np.array([math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)])


@each_case
def test_the_light_of_all_directions_is_what_samples_say(case: Case) -> None:
    """Mean of radiance / pdf against the integral, and the choice of a light by the power that it announces."""
    core = case.core
    wi, pdf, _ = draw(case, core, uniform(100_000, 2, SEED + 1))
    ok = pdf > 0.0
    values = np.zeros((len(wi), 4))
    values[ok] = radiance(case, core, wi[ok]) / pdf[ok, None]
    if case.kind == "sun":
        towards = sun_towards(case.light)
        drops = (np.arange(20_000) + 0.5) / 20_000
        height = 1.0 - math.cos(math.radians(case.light.get("angular_diameter", 0.533)) / 2)
        aside = unit(*np.cross(towards, unit(0.3, 0.5, -0.8)))
        drop = (0.99999 * height * drops)[:, None]
        rays = np.sqrt(drop * (2 - drop)) * aside + (1 - drop) * towards
        expected = radiance(case, core, rays).mean(axis=0) * 2 * np.pi * height
    else:
        rays, weights = grid(512, 1024)
        expected = weights @ radiance(case, core, rays)
    error = 4.5 * values.std(axis=0, ddof=1) / math.sqrt(len(values)) + 1e-3 * expected
    assert (np.abs(values.mean(axis=0) - expected) < error).all(), (values.mean(axis=0), expected, error)


@each_case
def test_importance_sampling_pays(case: Case) -> None:
    """The brighter a map is somewhere, the more samples go there: little noise in white light."""
    core = case.core
    wi, pdf, _ = draw(case, core, uniform(20_000, 2, SEED + 2))
    ok = pdf > 0.0
    values = radiance(case, core, wi[ok]).mean(axis=1) / pdf[ok]
    assert values.std() / values.mean() < (0.6 if case.name in COLOURED else 0.3)


def test_no_direction_that_is_lit_has_no_density() -> None:
    """Beside a texel of 1e9 the others keep a share that single precision can tell."""
    pixels = np.full((64, 512), 1e-3)
    pixels[20, 100] = 1e9
    case = Case("dominated", "environment", environment(pixels))
    rays, _ = grid(64, 512)
    assert (density(case, case.core, rays) > 0.0).all()


def test_a_black_map_gives_no_samples() -> None:
    case = Case("black", "environment", environment(np.zeros((4, 8))))
    _, pdf, scale = draw(case, case.core, uniform(100, 2, SEED))
    assert (pdf == 0.0).all()
    assert (scale == 0.0).all()


@pytest.mark.parametrize(
    ("column", "direction"),
    [(7.5, [0, 0, -1]), (11.5, [1, 0, 0]), (3.5, [-1, 0, 0]), (15.5, [0, 0, 1])],
)
def test_where_the_parts_of_a_map_lie(column: float, direction: list[float]) -> None:
    """The middle at -Z, the right half towards +X: at the middle of four texels their mean is seen."""
    pixels = np.zeros((8, 16))
    for x in (math.floor(column), math.ceil(column) % 16):
        pixels[3:5, x] = 1.0
    case = Case("place", "environment", environment(pixels))
    seen = radiance(case, case.core, np.array([direction, [-d for d in direction]], dtype=np.float64))
    assert seen[0].min() > 0.5
    assert seen[1].max() == 0.0
    pixels = np.zeros((8, 16))
    pixels[0] = 1.0
    up = radiance(case, Case("top", "environment", environment(pixels)).core, np.array([[0, 1.0, 0], [0, -1.0, 0]]))
    assert up[0].min() > 0.5
    assert up[1].max() == 0.0


@pytest.mark.parametrize("name", ["turned", "moved", "mirrored"])
def test_a_turned_map_is_the_map_seen_from_turned_axes(name: str) -> None:
    case = next(case for case in CASES if case.name == name)
    plain = Case("plain", "environment", environment(case.light["pixels"], scale=case.light.get("scale", 1.0)))
    assert case.axes is not None
    rays = uniform(1000, 3, SEED) - 0.5
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    turned = rays @ case.axes.T
    assert np.allclose(radiance(case, case.core, turned), radiance(plain, plain.core, rays), rtol=1e-3, atol=1e-4)


def test_a_turn_by_a_quarter_shifts_the_columns() -> None:
    pixels = noise(8, 16)
    turned = Case("turned", "environment", environment(pixels, rotation=90))
    shifted = Case("shifted", "environment", environment(np.roll(pixels, -4, axis=1)))
    rays, _ = grid(20, 44)
    found, expected = (radiance(case, case.core, rays) for case in (turned, shifted))
    assert np.allclose(found, expected, rtol=1e-3, atol=1e-5)


def sky_rays(elevation: float, zenith: float, gamma: float) -> FloatArray:
    """A direction at this zenith angle and angle from a sun over -Z; degrees."""
    e, z, g = map(math.radians, (elevation, zenith, gamma))
    turn = math.acos((math.cos(g) - math.cos(z) * math.sin(e)) / (math.sin(z) * math.cos(e)))
    return np.array([[math.sin(z) * math.sin(turn), math.cos(z), -math.sin(z) * math.cos(turn)]])


@pytest.mark.parametrize(
    ("wavelength", "turbidity", "albedo", "elevation", "zenith", "gamma", "value"),
    [(560, 3, 0.3, 45, 45, 60, 0.0488011851), (440, 2.5, 0.1, 20, 10, 75, 0.0462402417)],
)
def test_the_published_values_of_the_sky(
    wavelength: float, turbidity: float, albedo: float, elevation: float, zenith: float, gamma: float, value: float
) -> None:
    light = {"type": "sky", "turbidity": turbidity, "ground_albedo": albedo, "elevation": elevation}
    core = Case("sky", "sky", light).core
    seen = probe.light_radiance(core, 0, [wavelength] * 4, single(sky_rays(elevation, zenith, gamma)))
    assert np.allclose(seen, value, rtol=2e-6)


@pytest.mark.parametrize(
    ("wavelength", "values", "value"),
    [
        (560, (3, 0.3, 45, 45, 60), 0.0488011851),
        (440, (2.5, 0.1, 20, 10, 75), 0.0462402417),
        (640, (8, 0, 70, 80, 30), 0.496841679),
    ],
)
def test_the_oracle_has_the_published_values(wavelength: float, values: tuple[float, ...], value: float) -> None:
    turbidity, albedo, elevation, zenith, gamma = values
    angles = np.radians([elevation, zenith, gamma])
    found = hosek_wilkie.radiance(wavelength, turbidity, albedo, angles[0], angles[1:2], angles[2:3])
    assert np.allclose(found, value, rtol=1e-8)


@pytest.mark.parametrize(("turbidity", "elevation"), [(1.0, 0.0), (1.7, 3.0), (4.5, 33.0), (10.0, 90.0)])
def test_the_sky_is_the_model_everywhere(turbidity: float, elevation: float) -> None:
    light = {"type": "sky", "turbidity": turbidity, "ground_albedo": 0.35, "elevation": elevation, "azimuth": 77}
    case = Case("sky", "sky", light)
    rays = uniform(300, 3, SEED) - 0.5
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    rays[:, 1] = np.abs(rays[:, 1])
    gamma = np.arccos(np.clip(rays @ sun_towards(light), -1, 1))
    seen = radiance(case, case.core, rays)
    for lane, wavelength in enumerate(WAVELENGTHS):
        expected = hosek_wilkie.radiance(
            wavelength, turbidity, 0.35, math.radians(elevation), np.arccos(rays[:, 1]), gamma
        )
        assert np.allclose(seen[:, lane], np.maximum(expected, 0.0), rtol=2e-4)
    assert (radiance(case, case.core, rays * [1, -1, 1]) == 0.0).all(), "nothing below the horizon"


@pytest.mark.parametrize("diameter", [0.533, 4.0])
def test_the_suns_disc_has_the_irradiance_of_the_model(diameter: float) -> None:
    light = {"type": "sky", "turbidity": 2.5, "elevation": 50, "angular_diameter": diameter}
    case = Case("disc", "sun", light, number=1)
    wi, pdf, _ = draw(case, case.core, uniform(100_000, 2, SEED))
    seen = np.asarray(probe.light_radiance(case.core, 1, [560.0] * 4, single(wi)), dtype=np.float64)[:, 0]
    values = np.where(pdf > 0, seen * (wi @ sun_towards(light)) / np.maximum(pdf, 1e-30), 0.0)
    expected = hosek_wilkie.sun_irradiance(6, 2.5, math.radians(50), math.radians(0.533 / 2))
    assert values.mean() == pytest.approx(expected, abs=4.5 * values.std() / math.sqrt(len(values)) + 1e-4 * expected)


def test_a_sky_without_its_sun_is_one_light() -> None:
    assert probe.light_names(load({"lights": {"sky": {"type": "sky", "sun": False}}})) == ["sky"]
    assert probe.light_names(load({"lights": {"sky": {"type": "sky"}}})) == ["sky", "sun"]


def test_lights_that_show_one_picture_share_it_and_its_table() -> None:
    def size(count: int) -> int:
        lights = {f"l{i}": environment(noise(64, 128), rotation=i) for i in range(count)}
        return int(lower(accuray.Scene.from_dict({"lights": lights}))[0].bytes)

    one, two, three = size(1), size(2), size(3)
    assert max(three - two, two - one) < 2000
