"""Every BSDF of the list keeps the laws that its table claims, for parameters at their defaults, ends and in between.

A type that is added to the list is tested here without a line of its own. `-k NAME` tests one type.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from accuray import data
from accuray._core import schema
from accuray.testing import (
    chi2_test,
    eval_albedo,
    parameter_sets,
    random_directions,
    reciprocity_error,
    sidak,
    types_of,
)
from accuray.testing.stats import two_sided_threshold
from tests.kernels.support import SEED, WAVELENGTHS, Bsdf, FloatArray, bsdfs, rows, uniform, unit

TABLES = {table["name"]: table for _, table in types_of(schema.tables(), "bsdf")}
#: A spectrum that differs between the wavelengths of a path, by role.
SPECTRAL: dict[str, Any] = {
    "index": "SF11",
    "reflectance": {"wavelengths": [400, 500, 600, 700], "values": [0.1, 0.9, 0.3, 1.0]},
}
#: Sets of interest that neither defaults nor chance would give.
MORE: dict[str, list[dict[str, Any]]] = {
    "conductor": [
        {"metal": "Cu", "roughness": 0.3, "anisotropy": 0.5},
        {"metal": "Ti", "roughness": 0.4, "film_thickness": 60, "film_ior": 2.4},
    ],
    "dielectric": [
        {"ior": "SF11", "roughness": 0.5},
        {"ior": 1.33, "roughness": 0.5, "anisotropy": 0.5},
        {"ior": 1.5, "roughness": 0.5, "film_thickness": 700, "film_ior": 2.4},
        {"ior": "SF11", "roughness": 0.7, "film_thickness": 400, "film_ior": 1.38},
        {"ior": 1.5, "film_thickness": 500},
        {"ior": 1.0, "film_thickness": 300},
    ],
    "coated": [
        {
            "base": {"type": "diffuse", "reflectance": 0.8},
            "roughness": 0.5,
            "transmission_color": SPECTRAL["reflectance"],
        },
        {"base": {"type": "conductor", "metal": "Cu", "roughness": 0.5}, "roughness": 0.5},
        {"base": {"type": "dielectric", "ior": 1.7, "roughness": 0.6}, "ior": 1.3, "roughness": 0.6},
        {"base": {"type": "dielectric", "ior": "SF11", "roughness": 0.8}, "ior": 1.3},
        {"base": {"type": "thin_dielectric", "ior": 1.6}, "roughness": 0.7},
        {"base": {"type": "diffuse", "reflectance": 0.8}, "film_thickness": 500, "film_ior": 2.0},
        {"base": {"type": "diffuse", "reflectance": 0.8}, "roughness": 0.5, "film_thickness": 300},
    ],
}
#: What lies under a type that needs another, one after the other.
BASES: list[dict[str, Any]] = [
    {"type": "diffuse", "reflectance": 0.8},
    {"type": "conductor", "metal": "Au", "roughness": 0.4},
    {"type": "dielectric", "ior": 1.33},
    {"type": "thin_dielectric"},
    {"type": "diffuse", "reflectance": 0.5, "roughness": 1.0},
    {"type": "conductor", "metal": "Ag"},
    {"type": "sheen", "roughness": 0.7},
    {"type": "dielectric", "ior": "SF11", "roughness": 0.5},
]
DIRECTIONS = {
    "0 deg": unit(0.0, 0.0, 1.0),
    "30 deg": unit(0.3, -0.4, 0.866),
    "60 deg": unit(-0.7, 0.5, 0.497),
    "85 deg": unit(np.sin(np.radians(85.0)), 0.0, np.cos(np.radians(85.0))),
    "behind 20 deg": unit(0.2, 0.28, -0.94),
    "behind 85 deg": unit(0.6, -0.797, -0.0872),
}
RIM = [0.0, -0.0, 1e-40, -1e-40, 1e-20, 1e-7, -1e-7, 1e-4, -1e-4]
#: Rounding of a direction's length; Snell's law amplifies it with the square of an index as large as 20.
UNIT_ERROR = 1e-4
each_type = pytest.mark.parametrize("name", list(TABLES))


#: What tells of the body behind a surface, not of the surface.
BODY = ("transmission_color", "transmission_depth", "priority")
#: Thickest film (nm) whose fringes the quadratures resolve.
THICKEST = 1000.0
#: Densities per solid angle beyond which a lobe is too narrow for the quadrature; chi-square tests those.
NARROW = 100.0
#: What the table of compensation may be above what is lost, between its nodes; and with a film on the facets, of
#: which compensation knows what it does to diffuse light.
TABLE_ERROR, FILM_ERROR = 1e-3, 0.03


def materials(name: str, count: int = 24) -> list[dict[str, Any]]:
    """Parameter sets of a type, the spectral ones last."""
    links = [p["name"] for p in TABLES[name]["params"] if p["role"] == "material"]
    params = [p for p in TABLES[name]["params"] if p["name"] not in (*BODY, *links)]
    table = TABLES[name] | {"params": [p | {"max": THICKEST} if p["name"] == "film_thickness" else p for p in params]}
    sets = parameter_sets(table, count, seed=SEED, texts={"metal": tuple(data.metals())})
    sets = [values | {link: BASES[i % len(BASES)] for link in links} for i, values in enumerate(sets)]
    for values in sets:
        if "reflectance" in values:  # no film lies on a colour
            values.pop("film_thickness", None)
    for p in table["params"]:
        if p["kind"] == "spectrum" and p["role"] in SPECTRAL:
            like = next((values for values in sets if p["name"] in values), None)
            if like is not None and not (p["group"] and p["role"] == "index"):
                sets.append({**like, p["name"]: SPECTRAL[p["role"]]})
    return [{"type": name, **values} for values in sets + MORE.get(name, [])]


def scattering(name: str) -> list[int]:
    """Numbers of the sets that have more than delta lobes, those of `MORE` first."""
    sets = materials(name)
    u = uniform(16, 3, SEED)
    smooth = [bsdf.sample_one(DIRECTIONS["30 deg"], u).specular.any() for bsdf in bsdfs(sets)]
    return [i for i in reversed(range(len(sets))) if not smooth[i]]


def claims(name: str, law: str) -> bool:
    return law in TABLES[name]["keeps"]


def hero_energy(bsdf: Bsdf, wo: FloatArray, u: FloatArray) -> FloatArray:
    """Weights without the compression of radiance, in the lanes that go on: the hero's alone after a dispersion."""
    s = bsdf.sample(wo, u)
    weight = s.weight * s.eta_scale[:, None]
    return weight[:, :1] if s.disperses.any() else weight


# --- Sampling -----------------------------------------------------------------------------------------------------


def sampling_cases() -> list[Any]:
    """Type, set, direction: the first set from everywhere with 10^6 samples, two more, by the seed, with less."""
    cases = []
    for name in TABLES:
        if claims(name, "exact_pdf"):
            first, *others = scattering(name)
            more = [others[(SEED + i * len(others) // 2) % len(others)] for i in (0, 1)]
            for number, samples in ((first, 1_000_000), (more[0], 200_000), (more[1], 200_000)):
                cases += [pytest.param(name, number, d, samples, id=f"{name}-{number}-{d}") for d in DIRECTIONS]
    return cases


@pytest.mark.parametrize(("name", "number", "direction", "samples"), sampling_cases())
def test_samples_follow_the_density(name: str, number: int, direction: str, samples: int) -> None:
    material = materials(name)[number]
    bsdf, wo = bsdfs([material])[0], DIRECTIONS[direction]

    def sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        s = bsdf.sample_one(wo, u)
        return s.wi, (s.succeeded & ~s.specular).astype(np.float64)

    result = chi2_test(
        sampler,
        lambda wi: bsdf.eval_one(wo, wi)[1],
        samples=samples,
        resolution=(40, 80),
        dimensions=3,
        tests=len(sampling_cases()),
        seed=SEED,
    )
    assert result, f"seed {SEED}, {material}: {result.reason}"


@each_type
def test_what_light_goes_through_is_lit_from_both_sides(name: str) -> None:
    wo, wi = random_directions(2000, SEED), random_directions(2000, SEED + 1)
    crosses = (wo[:, 2] > 0) != (wi[:, 2] > 0)
    for material, bsdf in zip(materials(name), bsdfs(materials(name)), strict=True):
        through = (bsdf.eval(wo, wi)[0][crosses] > 0).any()
        assert bsdf.transmits or not through, material


@each_type
def test_weight_is_eval_over_pdf(name: str) -> None:
    """For every sample that is not specular, and the density is the one that pdf() gives for its direction. The values
    of a stochastic type are compared in expectation, below.
    """
    for material, bsdf in zip(materials(name), bsdfs(materials(name)), strict=True):
        wo = random_directions(2000, SEED)
        s = bsdf.sample(wo, uniform(len(wo), 3, SEED))
        smooth = s.succeeded & ~s.specular
        value, pdf = bsdf.eval(wo, s.wi)
        assert np.allclose(pdf[smooth], s.pdf[smooth], rtol=1e-4, atol=1e-9), material
        if not claims(name, "stochastic"):
            assert np.allclose(value[smooth], (s.weight * s.pdf[:, None])[smooth], rtol=1e-4, atol=1e-9), material
        assert (s.pdf[s.specular] == 0.0).all(), "a delta lobe has no density"
        assert (s.weight[~s.succeeded] == 0.0).all(), "a failed sample has weight 0"
        assert np.allclose(np.linalg.norm(s.wi[s.succeeded], axis=1), 1.0, atol=UNIT_ERROR), material


@each_type
def test_the_mean_weight_is_the_integral_of_eval(name: str) -> None:
    if claims(name, "stochastic"):
        pytest.skip("compared cell by cell, below")
    chosen = materials(name)[:: max(1, len(materials(name)) // 3)]
    for material, bsdf in zip(chosen, bsdfs(chosen), strict=True):
        for wo in DIRECTIONS.values():
            s = bsdf.sample_one(wo, uniform(20_000, 3, SEED))
            if s.specular.all() or s.pdf.max() > NARROW:
                continue  # eval() of a delta lobe is 0
            weight = np.where(s.specular, 0.0, s.weight[:, 0])
            error = weight.std(ddof=1) / np.sqrt(len(weight))
            integral = eval_albedo(
                lambda wi, at=bsdf, o=wo: at.eval_one(o, wi)[0][:, 0], resolution=(16, 32), tolerance=1e-4
            )
            assert abs(weight.mean() - integral) <= 4.5 * error + 1e-3, (material, wo)


STOCHASTIC = [(name, i) for name in TABLES if claims(name, "stochastic") for i in range(len(MORE[name]))]
CELLS = (8, 8)
DRAWS = 20_000


def in_cells(values: FloatArray, directions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean and its variance of what falls into each cell of the sphere (along z, around z), and how often that is."""
    along = np.clip((0.5 * (directions[:, 2] + 1.0) * CELLS[0]).astype(int), 0, CELLS[0] - 1)
    turn = np.arctan2(directions[:, 1], directions[:, 0]) / (2.0 * np.pi) + 0.5
    cell = along * CELLS[1] + np.clip((turn * CELLS[1]).astype(int), 0, CELLS[1] - 1)
    count, size = len(values), CELLS[0] * CELLS[1]
    mean = np.bincount(cell, values, size) / count
    square = np.bincount(cell, values**2, size) / count
    return mean, (square - mean**2) / count, np.bincount(cell, values > 0.0, size)


@pytest.mark.parametrize("direction", ["30 deg", "85 deg", "behind 20 deg"])
@pytest.mark.parametrize(("name", "number"), STOCHASTIC)
def test_samples_follow_the_values_in_expectation(name: str, number: int, direction: str) -> None:
    """Weights of samples, cell by cell, are the integral of eval() there. One wavelength is followed while each of the
    four is the hero, since after a dispersion the hero stands for all.
    """
    wo = DIRECTIONS[direction]
    sampled, evaluated = [], []
    for hero in range(4):
        wi = random_directions(DRAWS, 4 * SEED + hero)
        bsdf = bsdfs([{"type": name, **MORE[name][number]}], WAVELENGTHS[hero:] + WAVELENGTHS[:hero])[0]
        s = bsdf.sample_one(wo, uniform(DRAWS, 3, 4 * SEED + hero))
        share = np.where(s.disperses, 4.0 if hero == 0 else 0.0, 1.0)
        sampled.append((np.where(s.specular, 0.0, s.weight[:, -hero] * share), s.wi))
        evaluated.append((4.0 * np.pi * bsdf.eval(rows(wo, DRAWS), wi, seed=4 * SEED + hero)[0][:, -hero], wi))
    (a, va, na), (b, vb, nb) = (
        in_cells(*(np.concatenate(x) for x in zip(*e, strict=True))) for e in (sampled, evaluated)
    )
    told = np.minimum(na, nb) >= 200
    assert a[told].sum() > 0.5 * a.sum(), "no power"
    z = np.abs(a - b)[told] / np.sqrt(va + vb)[told]
    threshold = two_sided_threshold(sidak(0.01, 3 * len(STOCHASTIC) * a.size))
    assert z.max() <= threshold, f"seed {SEED}, {MORE[name][number]}: {z.max():.3g} standard errors"


# --- Energy -------------------------------------------------------------------------------------------------------


@each_type
def test_no_direction_gets_back_more_than_it_gave(name: str) -> None:
    """64 directions by all sets, the noise allowed for at Sidak's significance for all of them together."""
    if not claims(name, "energy_conserving"):
        pytest.skip("not claimed")
    directions, count = random_directions(64, SEED), 1024
    sets = materials(name)
    threshold = two_sided_threshold(2.0 * sidak(0.01, len(sets) * len(directions) * 4))
    wo, u = np.repeat(directions, count, axis=0), uniform(len(directions) * count, 3, SEED)
    for material, bsdf in zip(sets, bsdfs(sets), strict=True):
        weight = hero_energy(bsdf, wo, u).reshape(len(directions), count, -1)
        filmed = material.get("film_thickness", 0.0) > 0.0 and material.get("roughness", 0.0) > 0.0
        allowed = TABLE_ERROR if material.get("compensate") else 1e-5
        allowed = FILM_ERROR if filmed else allowed
        excess = weight.mean(axis=1) - 1.0 - allowed - threshold * weight.std(axis=1, ddof=1) / np.sqrt(count)
        assert excess.max() <= 0.0, f"seed {SEED}, {material}: {excess.max():.3g} too much"


#: Roughnesses at which compensated facets lose nothing either.
ROUGH = (0.1, 0.33, 0.7, 1.0)
COMPENSATED = 0.005
#: Indices below films, their thicknesses (nm) and indices.
FILMS = [(1.5, 100.0, 1.22), (1.0, 400.0, 1.33), (2.4, 300.0, 0.8), (0.7, 5e4, 1.5), ("SF11", 600.0, 2.0)]
#: What absorbs nothing: the mean weight is 1 from every direction. Other types may reflect less.
LOSSLESS: dict[str, list[dict[str, Any]]] = {
    "diffuse": [{"reflectance": 1.0, "roughness": r} for r in (0.0, 0.4, 1.0)],
    "conductor": [{"metal": "perfect"}, {"eta": 0.0, "k": 1.0}, {"reflectance": 1.0}]
    + [{"metal": "perfect", "roughness": r, "masking": m} for r in ROUGH for m in ("correlated", "separable")]
    + [{"metal": "perfect", "roughness": r, "film_thickness": 300} for r in (0.0, 0.7)],
    "dielectric": [{"ior": n} for n in (0.05, 0.4, 0.75, 1.0, 1.0001, 1.5, 2.4, 20.0)]
    + [{"ior": "SF11"}, {"ior": "water_20C"}]
    + [{"ior": n, "roughness": r} for n in (0.05, 0.7, 1.01, 1.5, 4.0, "SF11") for r in ROUGH]
    + [{"ior": n, "film_thickness": d, "film_ior": f} for n, d, f in FILMS],
    "thin_dielectric": [{"ior": n} for n in (0.5, 1.0, 1.5, "SF11")],
    "coated": [
        {"base": {"type": "diffuse", "reflectance": 1.0}},
        {"base": {"type": "diffuse", "reflectance": 1.0}, "roughness": 0.5},
        {"base": {"type": "conductor", "metal": "perfect", "roughness": 0.5}, "roughness": 0.5},
        {"base": {"type": "dielectric", "ior": 1.2}},
        {"base": {"type": "dielectric", "ior": "SF11", "roughness": 0.5}, "ior": 1.3},
        {"base": {"type": "thin_dielectric", "ior": 1.7}, "roughness": 0.5},
    ],
}


@each_type
def test_what_absorbs_nothing_returns_everything(name: str) -> None:
    sets = [{"type": name, **values} for values in LOSSLESS.get(name, [])]
    if not sets:
        pytest.skip("no lossless parameters are known")
    directions = np.concatenate([random_directions(58, SEED), list(DIRECTIONS.values())])
    count = 4096
    wo, u = np.repeat(directions, count, axis=0), uniform(len(directions) * count, 3, SEED)
    for material, bsdf in zip(sets, bsdfs(sets), strict=True):
        weight = hero_energy(bsdf, wo, u).reshape(len(directions), count, -1)
        allowed = 5.0 * weight.std(axis=1, ddof=1) / np.sqrt(count) + 1e-5
        allowed += COMPENSATED if material.get("roughness", 0.0) > 0.0 else 0.0
        wrong = np.abs(weight.mean(axis=1) - 1.0) - allowed
        assert wrong.max() <= 0.0, f"seed {SEED}, {material}: {wrong.max():.3g} beyond the noise"


# --- Reciprocity --------------------------------------------------------------------------------------------------


@each_type
def test_light_goes_both_ways_alike(name: str) -> None:
    """f(wo, wi) = f(wi, wo), over 1e5 pairs of directions for each set; 0 = 0 for delta lobes, which come below."""
    if not claims(name, "reciprocal") or claims(name, "stochastic"):
        pytest.skip("not claimed, or in expectation only: see below")
    sets = materials(name)[:6]
    for material, bsdf in zip(sets, bsdfs(sets), strict=True):

        def f(wo: FloatArray, wi: FloatArray, at: Bsdf = bsdf) -> FloatArray:
            return np.asarray(at.eval(wo, wi)[0][:, 0] / np.maximum(np.abs(wi[:, 2]), 1e-30))

        eta = float(material["ior"]) if isinstance(material.get("ior"), float) else 1.0
        assert reciprocity_error(f, pairs=100_000, seed=SEED, eta=eta) <= 1e-5, material


@pytest.mark.parametrize(("name", "number"), STOCHASTIC)
def test_light_goes_both_ways_alike_in_expectation(name: str, number: int) -> None:
    material = {"type": name, **MORE[name][number]}
    behind = material["base"].get("ior", 1.0) if material["base"]["type"] == "dielectric" else 1.0
    if not claims(name, "reciprocal") or isinstance(behind, str):
        pytest.skip("not claimed, or the hero stands for all")
    bsdf, pairs, count = bsdfs([material])[0], 16, 4000
    a, b = (random_directions(pairs, SEED + i) for i in (0, 1))
    measured = []
    for wo, wi, seed in ((a, b, 2 * SEED), (b, a, 2 * SEED + 1)):
        value = bsdf.eval(np.repeat(wo, count, axis=0), np.repeat(wi, count, axis=0), seed)[0][:, 0].reshape(
            pairs, count
        )
        scale = np.where(wo[:, 2] < 0.0, behind, 1.0) ** 2 * np.abs(wi[:, 2])
        measured.append((value.mean(axis=1) / scale, value.var(axis=1, ddof=1) / count / scale**2))
    (there, error), (back, error_back) = measured
    assert (there > 0.0).any()
    allowed = two_sided_threshold(sidak(0.01, pairs * len(STOCHASTIC))) * np.sqrt(error + error_back) + 1e-5
    assert (np.abs(there - back) <= allowed).all(), f"seed {SEED}, {material}"


LOBE_STEPS = 4096


def delta_lobes(bsdf: Bsdf, wo: FloatArray) -> dict[str, tuple[FloatArray, FloatArray, float, float]]:
    """The hero's share of light in each delta lobe: wi, energy (4,), 1 / chance, eta_scale; the lobes are listed by
    even steps of the number that chooses among them.
    """
    u = np.full((LOBE_STEPS, 3), 0.5)
    u[:, 2] = (np.arange(LOBE_STEPS) + 0.5) / LOBE_STEPS
    s = bsdf.sample_one(wo, u)
    found = {}
    for word, which in (("reflected", s.specular & ~s.transmitted), ("transmitted", s.specular & s.transmitted)):
        if which.any():
            first = int(np.argmax(which))
            energy = s.weight[which].sum(axis=0) / LOBE_STEPS
            found[word] = (s.wi[first], energy, float(s.weight[first].max()), float(s.eta_scale[first]))
    return found


@each_type
def test_delta_lobes_go_both_ways_alike(name: str) -> None:
    """Reflected light returns with the same share. Refracted light returns along its own path with the same share of
    energy; radiance is scaled by (n_o / n_i)^2 on the way, which is (sin theta_i / sin theta_o)^2 by Snell's law.
    """
    if not claims(name, "reciprocal"):
        pytest.skip("not claimed")
    sets = materials(name)
    for material, bsdf in zip(sets, bsdfs(sets), strict=True):
        for wo in random_directions(8, SEED):
            for lobe, (wi, energy, largest, scale) in delta_lobes(bsdf, wo).items():
                back = delta_lobes(bsdf, wi).get(lobe)
                where = f"seed {SEED}, {material}, {lobe} from {wo}"
                if back is None:
                    assert energy[0] * scale < 4.0 / LOBE_STEPS, f"{where}: no way back"
                    continue
                returned, energy_back, largest_back, scale_back = back
                amplified = 2e-6 + 1e-6 * max(scale, scale_back) / max(abs(wo[2]), 1e-3)
                assert np.abs(returned - wo).max() < amplified, where
                step = 2.0 * max(largest * scale, largest_back * scale_back) / LOBE_STEPS
                if claims(name, "stochastic"):  # the first choice goes by even steps, the others are drawn
                    step += 5.0 * np.sqrt(max(energy[0] * largest, energy_back[0] * largest_back) / LOBE_STEPS)
                assert abs(energy[0] * scale - energy_back[0] * scale_back) <= step + 2.0 * amplified, where
                assert abs(scale * scale_back - 1.0) < 1e-5, where
                sines = np.hypot(*wo[:2]), np.hypot(*wi[:2])
                if lobe == "transmitted" and min(sines) > 0.01:
                    assert abs(scale * (sines[1] / sines[0]) ** 2 - 1.0) < 1e-3, where
                if lobe == "reflected":
                    assert scale == 1.0, where


# --- Robustness ---------------------------------------------------------------------------------------------------


@each_type
def test_nothing_breaks_at_grazing_angles(name: str) -> None:
    """Directions in and next to the tangent plane, both sides, and numbers at the ends of their range."""
    ends = [0.0, 2.0**-24, 0.5, 1.0 - 2.0**-24]
    grid = np.stack(np.meshgrid(ends, ends, ends, indexing="ij"), axis=-1).reshape(-1, 3)
    u = np.concatenate([grid, uniform(200, 3, SEED)])
    turned = random_directions(40, SEED)
    for material, bsdf in zip(materials(name), bsdfs(materials(name)), strict=True):
        for z in RIM:
            wo = np.array([0.6, -0.8, z])
            s = bsdf.sample_one(wo, u)
            value, pdf = bsdf.eval_one(wo, np.concatenate([s.wi, turned]))
            back, pdf_back = bsdf.eval(np.concatenate([s.wi, turned]), rows(wo, len(s.wi) + len(turned)))
            for what, values in {
                "wi": s.wi, "weight": s.weight, "pdf": s.pdf, "eta_scale": s.eta_scale, "eval": value, "pdf()": pdf,
                "eval back": back, "pdf() back": pdf_back,
            }.items():  # fmt: skip
                assert np.isfinite(values).all(), f"{what} at z = {z}: {material}"
                assert what == "wi" or (values >= 0.0).all(), f"{what} at z = {z}: {material}"
            energy = s.weight[:, :1] * s.eta_scale[:, None]
            most = 32.0 if claims(name, "stochastic") else 8.0  # a walk multiplies the weights of several events
            assert not claims(name, "energy_conserving") or energy.max() <= most, f"a firefly at z = {z}: {material}"


@each_type
def test_sampling_is_a_pure_function(name: str) -> None:
    bsdf = bsdfs(materials(name)[:1])[0]
    wo, u = random_directions(500, SEED), uniform(500, 3, SEED)
    first, again = bsdf.sample(wo, u), bsdf.sample(wo[::-1], u[::-1])
    assert all(np.array_equal(a, b[::-1]) for a, b in zip(vars(first).values(), vars(again).values(), strict=True))
