"""Every light of the list: what sample() draws has the density that pdf() says and lies on the light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from accuray._core import probe
from accuray.testing import Plane, chi2_test
from tests.kernels.light_cases import Case, Polygon, cases, place, places
from tests.kernels.support import SEED, FloatArray, load, single, uniform

CASES = cases()
BY_NAME = {case.name: case for case in CASES}
VISITS = [(case, name) for case in CASES for name in places(case.geometry)]
#: The chi-square tests of one run: every eighth visit, the others with other seeds.
CHOSEN = [
    pytest.param(*visit, id=f"{visit[0].name}-{visit[1]}") for i, visit in enumerate(VISITS) if (i + SEED) % 8 == 0
]
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)


@dataclass(frozen=True)
class Drawn:
    """Light samples as doubles, with the light's front normal at each point."""

    wi: FloatArray
    point: FloatArray
    distance: FloatArray
    pdf: FloatArray
    scale: FloatArray

    @property
    def ok(self) -> NDArray[np.bool_]:
        return np.asarray(self.pdf > 0.0)


def draw(core: Any, reference: FloatArray, u: FloatArray) -> Drawn:
    s = probe.light_sample(core, 0, [float(x) for x in reference], single(u))
    return Drawn(*(np.asarray(s[key], dtype=np.float64) for key in ("wi", "point", "distance", "pdf", "scale")))


def density(core: Any, reference: FloatArray, wi: FloatArray) -> FloatArray:
    return np.asarray(probe.light_pdf(core, 0, [float(x) for x in reference], single(wi)), dtype=np.float64)


def cos_front(drawn: Drawn, case: Case) -> FloatArray:
    """Cosine between the front normal and the way back to the reference."""
    return np.asarray(-(case.geometry.normals(drawn.point) * drawn.wi).sum(axis=1))


def visible(drawn: Drawn, case: Case, name: str) -> NDArray[np.bool_]:
    """Samples that the light itself does not hide: all but the far side of a sphere that is sampled by area."""
    hides = case.kind == "sphere" and not name.startswith("inside")
    return drawn.ok & (cos_front(drawn, case) > 0.0) if hides else drawn.ok


def coordinates(case: Case, reference: FloatArray) -> float:
    """Largest coordinate that takes part: rounding errors are in proportion to it."""
    return float(max(np.abs(reference).max(), np.abs(case.geometry.center).max() + case.geometry.size))


def one_light(core: Any) -> bool:
    return len(probe.light_names(core)) == 1


def passed(faults: dict[str, Any]) -> None:
    found = {name: fault for name, fault in faults.items() if fault}
    assert not found, f"seed {SEED}: {found}"


@each_case
def test_the_shape_becomes_the_light_it_should(case: Case) -> None:
    kinds = probe.light_names(load(case.scene))
    assert kinds == [case.kind] * (1 if one_light(load(case.scene)) else len(case.geometry.vertices) - 2)


@each_case
def test_samples_lie_on_the_light(case: Case) -> None:
    core = load(case.scene)
    faults: dict[str, Any] = {}
    for name in places(case.geometry):
        reference = place(case.geometry, name)
        drawn = draw(core, reference, uniform(4096, 2, SEED))
        ok = drawn.ok
        off = case.geometry.off(drawn.point, reference)[ok].max() / (1e-6 * coordinates(case, reference))
        straight = drawn.point - reference
        distance = np.linalg.norm(straight, axis=1)
        aside = np.linalg.norm(straight - distance[:, None] * drawn.wi, axis=1)
        rounding = 1e-6 * (distance + coordinates(case, reference))
        faults[name] = [
            fault
            for fault, wrong in {
                "not finite": not all(np.isfinite(values).all() for values in vars(drawn).values()),
                "failed": ok.mean() < 0.999,
                "no unit vector": np.abs(np.linalg.norm(drawn.wi, axis=1) - 1.0).max() > 1e-6,
                f"off the light by {off:.2g} times the rounding": off > 1.0,
                "distance": (np.abs(distance - drawn.distance) > rounding)[ok].any(),
                "direction": (aside > rounding)[ok].any(),
            }.items()
            if wrong
        ]
    passed(faults)


@each_case
def test_the_front_side_emits_and_the_back_side_does_not(case: Case) -> None:
    core = load(case.scene)
    faults: dict[str, Any] = {}
    for name in places(case.geometry):
        drawn = draw(core, place(case.geometry, name), uniform(4096, 2, SEED))
        cosine = cos_front(drawn, case)
        clear = drawn.ok & (np.abs(cosine) > 1e-3)
        wrong = drawn.scale[clear] != (cosine[clear] > 0.0)
        faults[name] = f"{wrong.mean():.1%} of the samples have the wrong side" if wrong.any() else ""
    passed(faults)


@each_case
def test_a_ray_that_meets_the_light_finds_the_density_of_the_sample(case: Case) -> None:
    """What multiple importance sampling relies on. A few rays at the rim may pass it by."""
    core = load(case.scene)
    if not one_light(core):
        pytest.skip("two triangles are two lights")
    faults: dict[str, Any] = {}
    for name in places(case.geometry):
        reference = place(case.geometry, name)
        drawn = draw(core, reference, uniform(4096, 2, SEED + 1))
        seen = visible(drawn, case, name)
        found = density(core, reference, drawn.wi)
        met = seen & (found > 0.0)
        if name == "touching":
            continue  # nearly all of the area is behind the horizon
        wrong = np.abs(found[met] / drawn.pdf[met] - 1.0)
        missed = 1.0 - met.sum() / seen.sum()
        bad = missed > 0.01 or np.quantile(wrong, 0.99) > 1e-3 or wrong.max() > 0.05
        faults[name] = (
            f"{missed:.2%} missed, 99 % within {np.quantile(wrong, 0.99):.2g}, {wrong.max():.2g}" if bad else ""
        )
    passed(faults)


@each_case
def test_the_mean_of_one_over_pdf_is_the_solid_angle(case: Case) -> None:
    core = load(case.scene)
    if not one_light(core):
        pytest.skip("two triangles are two lights")
    faults: dict[str, Any] = {}
    for name in places(case.geometry):
        reference = place(case.geometry, name)
        drawn = draw(core, reference, uniform(50_000, 2, SEED + 2))
        if name == "touching":
            continue  # by area: right in the mean over far more samples
        inverse = np.where(visible(drawn, case, name), 1.0 / np.maximum(drawn.pdf, 1e-30), 0.0)
        expected = case.geometry.solid_angle(reference)
        error = 4.5 * inverse.std(ddof=1) / np.sqrt(len(inverse)) + 2e-4 * expected
        bad = abs(inverse.mean() - expected) > error
        faults[name] = f"{inverse.mean():.6g} in place of {expected:.6g}, allowed {error:.2g}" if bad else ""
    passed(faults)


@pytest.mark.parametrize(("case", "name"), CHOSEN)
def test_points_follow_the_density(case: Case, name: str) -> None:
    """Chi-square over the light's own area, where pdf() per solid angle is a smooth density without edges."""
    core, reference = load(case.scene), place(case.geometry, name)
    if not one_light(core) or name == "touching":
        pytest.skip("two triangles are two lights; of a sphere's area almost nothing is seen from so near")
    geometry = case.geometry
    area = geometry.seen_area(reference)

    def sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        drawn = draw(core, reference, u)
        inside = np.clip(geometry.to_square(drawn.point, reference), 0.0, 1.0)
        return inside, visible(drawn, case, name).astype(np.float64)

    def pdf(square: FloatArray) -> FloatArray:
        points = geometry.from_square(square, reference)
        d = points - reference
        squared = (d * d).sum(axis=1)
        cosine = np.abs((d * geometry.normals(points)).sum(axis=1)) / np.sqrt(squared)
        return density(core, reference, d / np.sqrt(squared)[:, None]) * cosine / squared * area

    result = chi2_test(
        sampler,
        pdf,
        domain=Plane((0.0, 1.0), (0.0, 1.0)),
        samples=200_000,
        resolution=(20, 40),
        tests=len(VISITS),
        seed=SEED,
        tolerance=5e-3,
        stray=1e-2,
    )
    assert result, f"seed {SEED}: {result.reason}"


def test_the_environment_is_uniform() -> None:
    core = load({"lights": {"sky": {"type": "constant", "radiance": 2.0}}})
    assert probe.light_names(core) == ["constant"]
    reference = np.array([1.0, 2.0, 3.0])
    drawn = draw(core, reference, uniform(10_000, 2, SEED))
    assert np.allclose(drawn.pdf, 0.25 / np.pi, rtol=1e-6)
    assert (drawn.scale == 1.0).all()
    result = chi2_test(
        lambda u: (draw(core, reference, u).wi, np.ones(len(u))),
        lambda wi: density(core, reference, wi),
        samples=1_000_000,
        resolution=(40, 80),
        seed=SEED,
    )
    assert result, result.reason


def test_a_point_sends_its_intensity_over_the_square_of_the_distance() -> None:
    position = np.array([0.5, -1.0, 2.0])
    core = load({"lights": {"lamp": {"type": "point", "position": list(position), "intensity": 3.0}}})
    assert probe.light_names(core) == ["point"]
    for reference in (np.zeros(3), np.array([0.5, -1.0, 2.0 + 2.0**-10]), np.array([1e4, 2e4, -1e4])):
        drawn = draw(core, reference, uniform(4, 2, SEED))
        d = position - reference
        assert (drawn.pdf == 1.0).all()
        assert np.allclose(drawn.wi, d / np.linalg.norm(d), atol=1e-6)
        assert np.allclose(drawn.distance, np.linalg.norm(d), rtol=1e-6)
        assert np.allclose(drawn.scale, 1.0 / (d @ d), rtol=1e-6)
        assert (density(core, reference, drawn.wi) == 0.0).all()
    assert (draw(core, position, uniform(4, 2, SEED)).pdf == 0.0).all(), "at the point itself there is no direction"


def test_both_sides_emit_where_the_material_says_so() -> None:
    case = BY_NAME["rectangle"]
    lamp = {"type": "diffuse", "emission": 1.0, "emission_sides": "both"}
    core = load({**case.scene, "materials": {"lamp": lamp}})
    for name in ("above", "behind"):
        assert (draw(core, place(case.geometry, name), uniform(1000, 2, SEED)).scale == 1.0).all()


def test_the_octant_triangle_fills_half_pi() -> None:
    """Seen from the corner of the cube, three unit vectors span an eighth of the sphere."""
    drawn = draw(load(BY_NAME["triangle"].scene), np.zeros(3), uniform(1000, 2, SEED))
    assert np.allclose(1.0 / drawn.pdf, np.pi / 2, rtol=1e-6)


def test_every_light_kind_has_a_case() -> None:
    seen = {kind for case in CASES for kind in probe.light_names(load(case.scene))}
    assert seen == {"triangle", "quad", "sphere", "disk"}


def test_a_mirrored_rectangle_is_one_light_like_any_other() -> None:
    for name in ("rectangle-mirrored", "rectangle-mirrored-instance"):
        assert isinstance(BY_NAME[name].geometry, Polygon)
        assert probe.light_names(load(BY_NAME[name].scene)) == ["quad"], name
