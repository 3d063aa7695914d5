"""Every light of the list: what sample() draws has the density that pdf() says and lies on the light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from accuray._core import probe
from accuray.testing import Sphere, chi2_test
from tests.kernels.light_cases import Case, Polygon, cases, place, places
from tests.kernels.support import SEED, FloatArray, load, single, uniform, unit

CASES = cases()
VISITS = [pytest.param(case, name, id=f"{case.name}-{name}") for case in CASES for name in places(case.geometry)]
#: The chi-square tests of one run: a third of all visits, each plain shape from each place within three seeds.
CHOSEN = [visit for i, visit in enumerate(VISITS) if (i + SEED) % 3 == 0]
CHI2_SAMPLES = 100_000


@dataclass(frozen=True)
class Drawn:
    """Light samples as doubles."""

    wi: FloatArray
    point: FloatArray
    error: FloatArray
    normal: FloatArray
    distance: FloatArray
    pdf: FloatArray
    scale: FloatArray


def draw(core: Any, reference: FloatArray, u: FloatArray) -> Drawn:
    s = probe.light_sample(core, 0, [float(x) for x in reference], single(u))
    keys = ("wi", "point", "error", "normal", "distance", "pdf", "scale")
    return Drawn(*(np.asarray(s[key], dtype=np.float64) for key in keys))


def density(core: Any, reference: FloatArray, wi: FloatArray) -> FloatArray:
    return np.asarray(probe.light_pdf(core, 0, [float(x) for x in reference], single(wi)), dtype=np.float64)


def visible(drawn: Drawn, case: Case, name: str) -> NDArray[np.bool_]:
    """Points of a sphere's area that its near side does not hide; all points of any other light."""
    if case.kind != "sphere" or name.startswith("inside"):
        return np.ones(len(drawn.pdf), dtype=bool)
    return np.asarray((drawn.normal * drawn.wi).sum(axis=1) < 0.0)


def rotated(case: Case) -> Sphere:
    return Sphere(axis=(0.0, 0.0, 1.0))


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_the_scene_has_the_light_it_was_made_for(case: Case) -> None:
    kinds = probe.light_names(load(case.scene))
    faces = len(case.geometry.vertices) - 2 if isinstance(case.geometry, Polygon) else 1
    if case.kind == "quad" and "mirrored" in case.name:
        assert kinds in (["quad"], ["triangle"] * 2)
    else:
        assert kinds == [case.kind] * (1 if case.kind == "quad" else faces)


@pytest.mark.parametrize(("case", "name"), VISITS)
def test_samples_lie_on_the_light_and_have_the_density_of_their_direction(case: Case, name: str) -> None:
    core, reference = load(case.scene), place(case.geometry, name)
    lights = len(probe.light_names(core))
    drawn = draw(core, reference, uniform(4096, 2, SEED))
    ok = drawn.pdf > 0.0
    assert ok.mean() > 0.999
    assert all(np.isfinite(values).all() for values in vars(drawn).values())
    assert np.abs(np.linalg.norm(drawn.wi, axis=1) - 1.0).max() < 1e-6

    # On the light, to the error that the sample itself states; the normal is that of the front side.
    if lights == 1:
        bound = np.linalg.norm(drawn.error, axis=1) + 1e-7 * np.abs(reference).max()
        assert (case.geometry.distances(drawn.point) <= 2.0 * bound)[ok].all()
        assert (drawn.normal * case.geometry.normals(drawn.point)).sum(axis=1)[ok].min() > 0.9999
    straight = drawn.point - reference
    distance = np.linalg.norm(straight, axis=1)
    rounding = 4e-7 * (np.abs(reference).max() + case.geometry.size)
    assert (np.abs(distance - drawn.distance) <= 1e-6 * distance + rounding)[ok].all()
    assert (np.linalg.norm(straight - distance[:, None] * drawn.wi, axis=1) <= 2e-6 * distance + rounding)[ok].all()

    # Only the front side emits; nothing else scales the radiance.
    front = (drawn.normal * drawn.wi).sum(axis=1) < 0.0
    assert np.array_equal(drawn.scale[ok], np.where(front, 1.0, 0.0)[ok])


@pytest.mark.parametrize(("case", "name"), VISITS)
def test_a_ray_that_meets_the_light_finds_the_density_of_the_sample(case: Case, name: str) -> None:
    """What multiple importance sampling relies on. Rays at the rim may pass it by."""
    core, reference = load(case.scene), place(case.geometry, name)
    drawn = draw(core, reference, uniform(4096, 2, SEED + 1))
    seen = (drawn.pdf > 0.0) & visible(drawn, case, name)
    found = density(core, reference, drawn.wi)
    met = seen & (found > 0.0)
    assert met.sum() >= 0.99 * seen.sum()
    wrong = np.abs(found[met] / drawn.pdf[met] - 1.0)
    assert np.quantile(wrong, 0.99) < 1e-3
    assert wrong.max() < 0.05


@pytest.mark.parametrize(("case", "name"), VISITS)
def test_the_mean_of_one_over_pdf_is_the_solid_angle(case: Case, name: str) -> None:
    core, reference = load(case.scene), place(case.geometry, name)
    if len(probe.light_names(core)) != 1:
        pytest.skip("two triangles are two lights")
    drawn = draw(core, reference, uniform(100_000, 2, SEED + 2))
    inverse = np.where((drawn.pdf > 0.0) & visible(drawn, case, name), 1.0 / np.maximum(drawn.pdf, 1e-30), 0.0)
    expected = case.geometry.solid_angle(reference)
    if name == "touching":
        expected = 2.0 * np.pi * (1.0 - np.sqrt(1.0 - (1.0 / 1.00001) ** 2))
    error = 4.5 * inverse.std(ddof=1) / np.sqrt(len(inverse))
    assert abs(inverse.mean() - expected) <= error + 2e-4 * expected, (inverse.mean(), expected, error)


@pytest.mark.parametrize(("case", "name"), CHOSEN)
def test_directions_follow_the_density(case: Case, name: str) -> None:
    core, reference = load(case.scene), place(case.geometry, name)
    if len(probe.light_names(core)) != 1:
        pytest.skip("two triangles are two lights")
    axis = unit(*(case.geometry.center - reference))
    probed = draw(core, reference, uniform(20_000, 2, SEED + 3))
    widest = float((probed.wi @ axis)[visible(probed, case, name)].min())
    cos_min = max(-1.0, widest - 0.05 * (1.0 - widest))

    def sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        drawn = draw(core, reference, u)
        return drawn.wi, ((drawn.pdf > 0.0) & visible(drawn, case, name)).astype(np.float64)

    result = chi2_test(
        sampler,
        lambda wi: density(core, reference, wi),
        domain=Sphere(axis=(float(axis[0]), float(axis[1]), float(axis[2])), cos_min=cos_min),
        samples=CHI2_SAMPLES,
        resolution=(24, 48),
        tests=len(VISITS),
        seed=SEED,
        tolerance=5e-3,
        stray=1e-2,
    )
    assert result, result.reason


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
    case = next(c for c in CASES if c.name == "rectangle")
    lamp = {"type": "diffuse", "emission": 1.0, "emission_sides": "both"}
    core = load({**case.scene, "materials": {"lamp": lamp}})
    for name in ("above", "behind"):
        drawn = draw(core, place(case.geometry, name), uniform(1000, 2, SEED))
        assert (drawn.scale == 1.0).all()


def test_the_octant_triangle_fills_half_pi() -> None:
    """Seen from the corner of the cube, three unit vectors span an eighth of the sphere."""
    case = next(c for c in CASES if c.name == "triangle")
    drawn = draw(load(case.scene), np.zeros(3), uniform(1000, 2, SEED))
    assert np.allclose(1.0 / drawn.pdf, np.pi / 2, rtol=1e-6)


def test_every_kind_of_the_list_has_a_case() -> None:
    assert {case.kind for case in CASES} | {"point", "constant"} == {"point", "constant", "triangle", "quad", "sphere", "disk"}
