"""Every light that a scene can name, by iteration; and by hand where the light of spots and luminaires goes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ies_files import ies_text
from numpy.typing import ArrayLike

import accuray
from accuray import devices
from accuray._core import probe
from accuray.scene import schema
from accuray.testing import chi2_test
from tests.kernels.support import SEED, FloatArray, load, single, uniform, unit
from tests.kernels.test_infinite_lights import CASES

Description = dict[str, Any]

#: What a light cannot do without, and forms of it that differ in how it is sampled or how much it gives.
FORMS: dict[str, list[Description]] = {
    "spot": [
        {"outer_angle": 50, "inner_angle": 20, "direction": [1, -2, 0.5], "position": [0.5, 1, -2]},
        {"outer_angle": 40, "inner_angle": 40, "target": [3, 0, 1]},
        {"outer_angle": 70, "inner_angle": 10, "falloff": "square"},
        {"outer_angle": 120, "inner_angle": 30, "falloff": "linear"},
    ],
    "directional": [{}, {"direction": [1, -3, 2]}],
    "ies": [{"file": "builtin:wall_washer.ies", "direction": [0.3, -1, 0.2], "position": [1, 2, 3]}],
}
BEYOND = ("environment", "sun", "sky")
"""Their radiance differs from direction to direction: test_infinite_lights.py."""
EVERY = [
    pytest.param({"type": name, **form}, id=f"{name}-{i}")
    for name in schema.current().family("light").types
    if name not in BEYOND
    for i, form in enumerate(FORMS.get(name, [{}]))
]


def directions(rows: int, columns: int) -> FloatArray:
    """Midpoints of cells of equal solid angle that cover the sphere."""
    z = 1.0 - 2.0 * (np.arange(rows) + 0.5) / rows
    phi = 2.0 * np.pi * (np.arange(columns) + 0.5) / columns
    r = np.sqrt(1.0 - z * z)[:, None]
    flat = [r * np.cos(phi), r * np.sin(phi), np.broadcast_to(z[:, None], (rows, columns))]
    return np.stack([x.ravel() for x in flat], axis=1)


def sampled(core: Any, reference: ArrayLike, numbers: FloatArray) -> dict[str, FloatArray]:
    s = probe.light_sample(core, 0, [float(x) for x in np.asarray(reference)], single(numbers))
    return {key: np.asarray(value, dtype=np.float64) for key, value in s.items()}


def intensity(core: Any, position: ArrayLike, ways: FloatArray, distance: float = 1.0) -> FloatArray:
    """Share of its emission that the light at a position sends along each way."""
    p, one = np.asarray(position, dtype=np.float64), np.full((1, 2), 0.5)
    return np.array([sampled(core, p + distance * way, one)["scale"][0] * distance**2 for way in ways])


def share(table: Description, angle: FloatArray) -> FloatArray:
    """What a spot light leaves of its intensity at angles from its axis, degrees."""
    inner, outer = table["inner_angle"], table["outer_angle"]
    if table.get("falloff") == "linear":
        return np.clip((outer - angle) / (outer - inner), 0.0, 1.0)
    a, b, c = (np.cos(np.radians(x)) for x in (inner, outer, angle))
    t = np.clip((c - b) / (a - b), 0.0, 1.0)
    return np.asarray(t * t if table.get("falloff") == "square" else t * t * (3.0 - 2.0 * t))


@pytest.mark.parametrize("light", EVERY)
def test_samples_have_the_density_that_the_light_says(light: Description) -> None:
    core = load({"lights": {"lamp": light}})
    drawn = sampled(core, [1.0, -2.0, 0.5], uniform(4096, 2, SEED))
    assert np.abs(np.linalg.norm(drawn["wi"], axis=1) - 1.0).max() < 1e-6
    assert (drawn["pdf"] > 0.0).all()
    ways = single(directions(20, 40))
    if np.asarray(probe.light_pdf(core, 0, [1.0, -2.0, 0.5], ways)).max() == 0.0:
        assert (drawn["pdf"] == 1.0).all(), "a light that no path can meet is asked with certainty"
        assert np.ptp(drawn["wi"], axis=0).max() == 0.0
        return
    result = chi2_test(
        lambda u: (sampled(core, [1.0, -2.0, 0.5], u)["wi"], np.ones(len(u))),
        lambda wi: np.asarray(probe.light_pdf(core, 0, [1.0, -2.0, 0.5], single(wi)), dtype=np.float64),
        samples=300_000,
        resolution=(30, 60),
        seed=SEED,
    )
    assert result, result.reason


@pytest.mark.parametrize("light", EVERY)
def test_power_is_the_integral_of_what_is_emitted(light: Description) -> None:
    core = load({"lights": {"lamp": light}})
    drawn = sampled(core, np.zeros(3), uniform(20_000, 2, SEED))
    if np.isinf(drawn["distance"]).all():
        radius = 3.0
        irradiances = (drawn["scale"] / drawn["pdf"]).mean()
        assert probe.light_power(core, 0, radius) == pytest.approx(np.pi * radius**2 * irradiances, rel=2e-2)
        return
    ways = directions(120, 160)
    flux = 4.0 * np.pi * intensity(core, light.get("position", (0, 0, 0)), ways).mean()
    assert probe.light_power(core, 0, 1.0) == pytest.approx(flux, rel=5e-3)


def test_every_named_light_has_a_form_that_loads() -> None:
    formed = {param.values[0]["type"] for param in EVERY} | {case.kind for case in CASES}
    assert formed == set(schema.current().family("light").types)


@pytest.mark.parametrize("form", FORMS["spot"], ids=str)
def test_a_spot_falls_off_as_it_says(form: Description) -> None:
    position = np.array(form.get("position", (0.0, 0.0, 0.0)))
    axis = (
        unit(*np.subtract(form["target"], position)) if "target" in form else unit(*form.get("direction", (0, -1, 0)))
    )
    side = unit(*np.cross(axis, [0.3, 0.2, 1.0]))
    angle = np.linspace(0.0, 179.0, 717)
    angle = angle[np.abs(angle - form["outer_angle"]) > 0.01]
    ways = np.outer(np.cos(np.radians(angle)), axis) + np.outer(np.sin(np.radians(angle)), side)
    found = intensity(load({"lights": {"lamp": {"type": "spot", **form}}}), position, ways, distance=2.5)
    expected = (angle < form["outer_angle"]) * 1.0
    if form["inner_angle"] < form["outer_angle"]:
        expected = share(form, angle)
    assert np.abs(found - expected).max() < 2e-6


@pytest.mark.parametrize("falloff", ["smooth", "square", "linear"])
def test_a_narrow_beam_keeps_its_digits(falloff: str) -> None:
    """At a twentieth of a degree the cosines of the angles differ by less than single precision resolves."""
    form = {"outer_angle": 0.05, "inner_angle": 0.02, "falloff": falloff}
    core = load({"lights": {"lamp": {"type": "spot", **form}}})
    angle = np.linspace(0.0, 0.06, 25)
    ways = np.stack([np.sin(np.radians(angle)), -np.cos(np.radians(angle)), np.zeros(25)], axis=1)
    t = np.clip((0.05**2 - angle**2) / (0.05**2 - 0.02**2), 0.0, 1.0)
    expected = {"smooth": t * t * (3 - 2 * t), "square": t * t, "linear": np.clip((0.05 - angle) / 0.03, 0, 1)}[falloff]
    assert np.abs(intensity(core, np.zeros(3), ways) - expected).max() < 1e-3
    whole = {"smooth": 0.5, "square": 1.0 / 3.0}
    if falloff in whole:  # versines of small angles are half their squares
        cap = np.pi * math.radians(1.0) ** 2 * (0.02**2 + whole[falloff] * (0.05**2 - 0.02**2))
        assert probe.light_power(core, 0, 1.0) == pytest.approx(cap, rel=1e-6)


@pytest.mark.parametrize(
    ("falloff", "expected"),
    [
        ("smooth", 23.0578939),  # physics: 2 pi I ((1 - cos a) + (cos a - cos b) / 2)
        ("square", 20.0 * math.pi * (1 - math.cos(math.radians(40)) + (math.cos(math.radians(40)) - 0.5) / 3)),
        (
            "linear",
            20.0 * math.pi * (1 - (math.sin(math.radians(60)) - math.sin(math.radians(40))) / math.radians(20)),
        ),
    ],
)
def test_the_power_of_a_spot_in_closed_form(falloff: str, expected: float) -> None:
    light = {"type": "spot", "inner_angle": 40, "outer_angle": 60, "falloff": falloff}
    assert 10.0 * probe.light_power(load({"lights": {"lamp": light}}), 0, 1.0) == pytest.approx(expected, rel=1e-7)


def batwing(vertical: float, horizontal: float) -> float:
    """Candelas without any symmetry."""
    return 100.0 + vertical * (
        1.0 + 0.5 * math.sin(math.radians(horizontal)) + 0.2 * math.cos(math.radians(horizontal))
    )


def even(vertical: float, horizontal: float) -> float:
    """Candelas with both of a luminaire's planes of symmetry."""
    return 50.0 + vertical * (2.0 + math.cos(math.radians(2.0 * horizontal)))


def sided(vertical: float, horizontal: float) -> float:
    """Candelas with the plane of 0 and 180 as symmetry."""
    return 50.0 + vertical * (2.0 + math.cos(math.radians(horizontal)))


def turned(vertical: float, horizontal: float) -> float:
    """Candelas with the plane of 90 and 270 as symmetry."""
    return sided(vertical, horizontal - 90.0)


def interpolated(distribution: Any, vertical: FloatArray, v: float, h: float, step: float) -> float:
    """Bilinear between the vertical angles and the multiples of ``step``, 0 beyond the vertical ones."""
    if not vertical[0] <= v <= vertical[-1]:
        return 0.0
    low = step * math.floor(h / step)
    ends = [np.interp(v, vertical, [distribution(float(a), b) for a in vertical]) for b in (low, low + step)]
    return float(ends[0] + (h - low) / step * (ends[1] - ends[0]))


@pytest.mark.parametrize(
    ("distribution", "horizontal"),
    [
        (lambda v, _: 10.0 + v, [0.0]),
        (even, [0, 30, 60, 90]),
        (sided, [0, 30, 60, 90, 120, 150, 180]),
        (turned, [90, 120, 150, 180, 210, 240, 270]),
        (batwing, [30.0 * i for i in range(13)]),
        (batwing, [30.0 * i for i in range(12)]),  # 360 left out
    ],
    ids=["round", "quadrants", "sides-0", "sides-90", "whole", "open"],
)
def test_an_ies_light_is_bilinear_in_the_angles(distribution: Any, horizontal: list[float], tmp_path: Path) -> None:
    vertical = np.array([0.0, 20.0, 45.0, 70.0, 90.0, 135.0])
    (tmp_path / "x.ies").write_text(ies_text(vertical, horizontal, distribution))
    table = {"type": "ies", "file": "x.ies", "position": [0.5, 2, -1], "direction": [0, -3, 0], "c0": [0, 5, 2]}
    scene = accuray.Scene.from_dict({"lights": {"lamp": table}}, folder=tmp_path)
    rng = np.random.default_rng(SEED)
    v, h = np.degrees(np.arccos(rng.uniform(-1, 1, 500))), rng.uniform(0, 360, 500)
    s = np.sin(np.radians(v))
    # c0 is +Z here. Counter-clockwise from above, with +Z to the right and +X up, 90 degrees lie towards +X.
    ways = np.stack([s * np.sin(np.radians(h)), -np.cos(np.radians(v)), s * np.cos(np.radians(h))], axis=1)
    core = devices.load(scene).core
    found = intensity(core, [0.5, 2, -1], ways, distance=3.0)
    expected = [interpolated(distribution, vertical, a, b, 30.0) for a, b in zip(v, h, strict=True)]
    assert np.abs(found / np.maximum(expected, 1.0) - np.array(expected) / np.maximum(expected, 1.0)).max() < 2e-5


def test_the_flux_of_an_ies_light_by_hand(tmp_path: Path) -> None:
    """A uniform intensity is 4 pi I0 exactly; a cosine sampled every degree pi I0 but for the chords."""
    for candela, lumens, rel in (
        (lambda v, _: 100.0, 400.0 * math.pi, 1e-6),
        (lambda v, _: 100.0 * max(0.0, math.cos(math.radians(v))), 100.0 * math.pi, 1e-4),
    ):
        (tmp_path / "x.ies").write_text(ies_text(np.arange(181.0), [0.0], candela))
        scene = accuray.Scene.from_dict({"lights": {"lamp": {"type": "ies", "file": "x.ies"}}}, folder=tmp_path)
        assert probe.light_power(devices.load(scene).core, 0, 1.0) == pytest.approx(lumens, rel=rel)


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ({"type": "spot", "target": [0, 0, 0]}, "lights.lamp.target"),
        ({"type": "spot", "direction": [0, 0, 0]}, "lights.lamp.direction"),
        ({"type": "spot", "outer_angle": 20, "inner_angle": 21}, "lights.lamp.inner_angle"),
        ({"type": "directional", "direction": [0, 0, 0]}, "lights.lamp.direction"),
        ({"type": "ies", "file": "builtin:wall_washer.ies", "c0": [0, 2, 0]}, "lights.lamp.c0"),
        ({"type": "ies", "file": "builtin:wall_washer.ies", "c0": [0, 0, 0]}, "lights.lamp.c0"),
    ],
    ids=str,
)
def test_what_contradicts_itself_is_refused(table: Description, key: str) -> None:
    with pytest.raises(accuray.SceneError) as caught:
        load({"lights": {"lamp": table}})
    assert caught.value.key == key
    assert "allowed" in str(caught.value)
