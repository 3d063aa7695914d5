"""The closed forms of `accuray.verify` agree with figures that were computed elsewhere. No renderer is involved."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from accuray.verify import all_cases, cameras, colorimetry, form_factors, lamps, optics, refraction

EXACT = 1e-9


@cache
def figures() -> dict[str, Any]:
    return json.loads((Path(__file__).parent / "physics_expected.json").read_text())  # type: ignore[no-any-return]


@cache
def expected() -> dict[str, tuple[float, ...]]:
    return {case.id: case.expected for case in all_cases()}


def close(value: float, reference: float, rel: float = EXACT) -> None:
    assert value == pytest.approx(reference, rel=rel)


@pytest.mark.parametrize(
    ("case", "key", "field", "rel"),
    [
        ("C1.disk-on-axis/mis", "disk_on_axis", "F", EXACT),
        ("C1.disk-off-axis/mis", "disk_off_axis", "F", EXACT),
        ("C1.rectangle-corner/mis", "rect_parallel_corner_1x1_h1", "F", EXACT),
        ("C1.rectangle-centre/mis", "rect_parallel_center_2x2_h1", "F", EXACT),
        ("C1.rectangle-scaled/mis", "rect_parallel_center_2x2_h1", "F", EXACT),
        ("C1.cornell-floor-centre/mis", "cornell_direct_floor_278_279.5", "F", EXACT),
        ("C1.cornell-floor-corner/mis", "cornell_direct_floor_0_0", "F", EXACT),
        ("C1.cornell-floor-side/mis", "cornell_direct_floor_400_100", "F", EXACT),
        ("C1.cornell-green-wall/mis", "cornell_direct_greenwall_mid", "F", EXACT),
        ("C1.sphere-0/mis", "sphere_light_R1_d2_theta0", "F", EXACT),
        ("C1.sphere-45/mis", "sphere_light_R1_d2_theta45", "F", EXACT),
        ("C1.sphere-80/mis", "sphere_light_R1_d2_theta80", "F", EXACT),
        ("C1.sphere-100/mis", "sphere_light_R1_d2_theta100", "F", EXACT),
    ],
)
def test_configuration_factors(case: str, key: str, field: str, rel: float) -> None:
    close(expected()[case][0], 0.5 * figures()[key][field], rel)


def test_polygon_formula_agrees_with_the_rectangle_formula() -> None:
    square = [(-0.3, 1, -0.2), (0.7, 1, -0.2), (0.7, 1, 0.8), (-0.3, 1, 0.8)]
    corner = form_factors.rectangle_above_corner
    whole = sum(corner(a, b, 1.0) for a in (0.3, 0.7) for b in (0.2, 0.8))
    close(form_factors.polygon(square, (0, 0, 0), (0, 1, 0)), whole)
    close(form_factors.polygon(square[::-1], (0, 0, 0), (0, 1, 0)), whole)


def test_point_light() -> None:
    close(expected()["C1.point/mis"][0] * math.pi / 0.5, 1.25)


def test_spot_light() -> None:
    reference = figures()["spot_power_smoothstep_40_60_I10"]["closed"]
    close(10.0 * lamps.SPOT_STERADIANS, reference)
    close(expected()["C1.spot-power/mis"][0] * 8.0 * math.pi**2, reference)


@pytest.mark.parametrize(
    ("case", "key", "field"),
    [
        ("C2.box-0.5/mis", "furnace_diffuse_box", "L_rho05"),
        ("C2.box-0.8/mis", "furnace_diffuse_box", "L_rho08"),
        ("C2.box-0.9/mis", "furnace_diffuse_box", "L_rho09"),
        ("C2.sphere-point-light", "sphere_point_light_center", "L"),
        ("C2.concentric-inner-inner", "concentric_spheres_r1_R2_rho05_08_Le1_inner", "L_inner"),
        ("C2.concentric-inner-outer", "concentric_spheres_r1_R2_rho05_08_Le1_inner", "L_outer"),
        ("C2.concentric-outer-inner", "concentric_spheres_Le1_outer", "L_inner"),
        ("C2.concentric-outer-outer", "concentric_spheres_Le1_outer", "L_outer"),
        ("C2.plates-glowing", "parallel_plates_mirror_duct_Le1_rho05_08", "L_1"),
        ("C2.plates-dark", "parallel_plates_mirror_duct_Le1_rho05_08", "L_2"),
        ("C2.cavity-0.8-0.5-glowing", "spherical_cavity_rho0.8_open0.5", "emissive_L_over_Le"),
        ("C2.cavity-0.8-0.5-skylit", "spherical_cavity_rho0.8_open0.5", "env_L_over_Lenv"),
        ("C2.cavity-0.95-0.05-glowing", "spherical_cavity_rho0.95_open0.05", "emissive_L_over_Le"),
        ("C2.cavity-0.95-0.05-skylit", "spherical_cavity_rho0.95_open0.05", "env_L_over_Lenv"),
        ("C2.cavity-0.5-0.25-glowing", "spherical_cavity_rho0.5_open0.25", "emissive_L_over_Le"),
        ("C2.cavity-0.5-0.25-skylit", "spherical_cavity_rho0.5_open0.25", "env_L_over_Lenv"),
        ("C2.integrating-sphere", "integrating_sphere_rho095_port005", "multiplier"),
        ("C2.squares-opposed", "unit_squares_aligned_d1", "F"),
        ("C2.squares-perpendicular", "unit_squares_perpendicular", "F"),
        ("C2.disks-coaxial", "coaxial_disks_r1_r1_h1", "F"),
    ],
)
def test_enclosures(case: str, key: str, field: str) -> None:
    close(expected()[case][0], figures()[key][field])


def test_truncated_series() -> None:
    partial = figures()["furnace_diffuse_box"]["partial_L_rho08_after_bounces_0_1_2_4_8"]
    for bounces, reference in zip((0, 1, 2, 4, 8), partial, strict=True):
        close(expected()[f"C2.box-depth-{bounces}/mis"][0], reference)


def test_lambert_sphere() -> None:
    reference = figures()["lambert_sphere_phase"]
    full, half = form_factors.lambert_sphere(0.0), form_factors.lambert_sphere(math.pi / 2)
    close(math.pi * full, reference["phase0_over_E"])
    close(half / full, reference["phase90_over_phase0"])
    assert form_factors.lambert_sphere(math.pi) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("degrees", [0, 30, 45, 56.31, 60, 75, 85])
def test_fresnel_and_slabs(degrees: float) -> None:
    reference = figures()[f"fresnel_n1.5_{degrees:g}"]
    theta = math.atan(1.5) if degrees == 56.31 else math.radians(degrees)
    s, p = optics.fresnel_pair(theta, 1.5)
    assert s == pytest.approx(reference["Rs"], rel=1e-6)
    assert p == pytest.approx(reference["Rp"], rel=1e-6, abs=1e-9)
    mean = optics.fresnel(theta, 1.5)
    assert optics.slab_transmittance(mean) == pytest.approx(reference["slab_T_unpolarised_renderer"], rel=1e-6)
    assert optics.slab_transmittance_in_nature(theta, 1.5) == pytest.approx(
        reference["slab_T_true_incoherent"], rel=1e-6
    )


def test_slab_cases_state_the_unpolarised_model() -> None:
    for degrees in (0, 45, 60, 75):
        reference = figures()[f"fresnel_n1.5_{degrees}"]
        close(expected()[f"C4.slab-T-{degrees}"][0], reference["slab_T_unpolarised_renderer"])
        close(expected()[f"C4.slab-R-{degrees}"][0], reference["slab_R_unpol_renderer"])
    close(expected()["C4.plates-5"][0], figures()["plates_stack_n1.5_normal"]["T_m5"])


def test_total_reflection_and_brewster() -> None:
    angles = figures()["critical_brewster_n1.5"]
    assert optics.fresnel(math.radians(angles["critical_deg"] + 1e-6), 1 / 1.5) == 1.0
    assert optics.fresnel(math.radians(angles["critical_deg"] - 1e-3), 1 / 1.5) < 1.0
    assert optics.fresnel_pair(math.radians(angles["brewster_deg"]), 1.5)[1] < 1e-20


def test_reflectance_is_the_same_from_both_sides() -> None:
    for degrees in (5, 35, 70):
        theta = math.radians(degrees)
        inside = math.asin(math.sin(theta) / 1.5)
        close(optics.fresnel(theta, 1.5), optics.fresnel(inside, 1 / 1.5))


def test_diffuse_reflectance() -> None:
    reference = figures()["diffuse_fresnel_n1.5"]
    close(optics.diffuse_reflectance(1.5), reference["external"], 1e-8)
    close(optics.diffuse_reflectance_inside(1.5), reference["internal"], 1e-8)


def test_absorbing_slabs() -> None:
    normal = figures()["absorbing_slab_n1.5_normal_tau0.5"]
    transmitted, reflected = expected()["C4.dyed-slab-T-0"][0], expected()["C4.dyed-slab-R-0"][0]
    close(transmitted, normal["T"])
    close(reflected, normal["R"])
    oblique = figures()["absorbing_slab_n1.5_45deg_sigma0.5_d1"]
    close(expected()["C4.dyed-slab-T-45"][0], oblique["T_unpol_renderer"])


def test_lateral_shift() -> None:
    reference = figures()["absorbing_slab_n1.5_45deg_sigma0.5_d1"]
    close(optics.lateral_shift(1.0, math.radians(45), 1.5), reference["lateral_offset_d1"])


@pytest.mark.parametrize("metal", ["Au", "Ag", "Cu", "Al"])
def test_metals(metal: str) -> None:
    reference = figures()[f"conductor_{metal}"]
    for key, degrees in (("R0", 0), ("R60", 60)):
        for value, wavelength in zip(expected()[f"C4.metal-{metal}-{degrees}"], (450, 550, 650), strict=True):
            close(value, reference[f"{key}_{wavelength}"], 1e-6)


def test_conductor_without_absorption_is_a_dielectric() -> None:
    for degrees in (0, 40, 80):
        theta = math.radians(degrees)
        close(optics.fresnel(theta, complex(1.5, 0.0)), optics.fresnel(theta, 1.5))


@pytest.mark.parametrize(("glass", "key"), [("N-BK7", "prism60_N-BK7"), ("SF11", "prism60_SF11")])
def test_sellmeier(glass: str, key: str) -> None:
    from accuray import data

    entry = data.glasses()[glass]
    for line, wavelength in (("C", 656.2725), ("d", 587.5618), ("F", 486.1327), ("g", 435.8343)):
        index = optics.sellmeier(wavelength, entry.A0, entry.B, entry.C)
        assert index == pytest.approx(figures()[key][f"n_{line}_{wavelength}"], abs=1e-6)


@pytest.mark.parametrize("glass", ["N-BK7", "SF11"])
def test_prisms(glass: str) -> None:
    from accuray import data

    entry, reference = data.glasses()[glass], figures()[f"prism60_{glass}"]
    incidence = math.radians(reference["incidence_min_dev_d_deg"])
    for line, wavelength in refraction.LINES.items():
        index = optics.sellmeier(wavelength, entry.A0, entry.B, entry.C)
        least = refraction.minimum_deviation(index)
        assert math.degrees(least) == pytest.approx(reference[f"Dmin_deg_{line}_{wavelength}"], abs=1e-5)
        assert refraction.deviation(0.5 * (least + refraction.APEX), index) == pytest.approx(least, abs=1e-12)
        if line in "CF":
            fixed = math.degrees(refraction.deviation(incidence, index))
            assert fixed == pytest.approx(reference[f"dev_at_that_incidence_{line}"], abs=2e-5)


def test_glass_ball() -> None:
    reference = figures()["glass_sphere_n1.5_collimated"]
    names = ("reflected_outside", "transmitted_p1", "after_one_internal_reflection")
    for order, name in enumerate(names):
        close(refraction.ball_order(order), reference[name], 1e-7)
    for name, value in reference.items():
        if name.startswith("flux_z"):
            z, radius = name.removeprefix("flux_z").split("_r")
            assert refraction.ball_flux(float(z), float(radius)) == pytest.approx(
                value, rel=4e-4
            )  # of sums over a coarser beam


def test_films() -> None:
    """No film, half a wave of one and one of the base's own index change nothing; Airy's formula; total reflection."""
    for theta in (0.0, 0.7, 1.4):
        bare = optics.fresnel(theta, complex(0.2, 3.5))
        close(optics.film_reflectance(theta, 1.7, complex(0.2, 3.5), 0.0, 550.0), bare)
        half = 550.0 / (2.0 * math.sqrt(1.7**2 - math.sin(theta) ** 2))
        close(optics.film_reflectance(theta, 1.7, complex(0.2, 3.5), half, 550.0), bare)
        close(optics.film_reflectance(theta, 1.5, 1.5, 123.0, 550.0), optics.fresnel(theta, 1.5))
    assert optics.film_reflectance(0.0, math.sqrt(1.5), 1.5, 550.0 / 4.0 / math.sqrt(1.5), 550.0) < 1e-15
    close(optics.film_reflectance(math.radians(60), 1.38, 1.0, 120.0, 550.0, before=1.5), 1.0)


def test_planck() -> None:
    reference = figures()["planck"]
    radiance = colorimetry.blackbody(6500)
    close(float(radiance(np.array([560.0]))[0]), reference["L_6500K_560nm_W_m2_sr_nm"], 1e-8)
    grid = np.arange(10.0, 200_000.0, 1.0)
    assert radiance(grid).sum() == pytest.approx(reference["sigmaT4_over_pi_6500"], rel=1e-5)
    assert grid[np.argmax(radiance(grid))] == pytest.approx(reference["wien_peak_6500K_nm"], abs=1.0)


@pytest.mark.parametrize("kelvin", [2856, 3000, 6500])
def test_blackbody_chromaticity(kelvin: int) -> None:
    x, y = expected()[f"C8.xy-{kelvin}K"]
    assert x == pytest.approx(figures()[f"blackbody_xy_{kelvin}"]["x"], abs=2e-6)
    assert y == pytest.approx(figures()[f"blackbody_xy_{kelvin}"]["y"], abs=2e-6)


@pytest.mark.parametrize(("name", "x", "y"), [("D65", 0.31273, 0.32902), ("A", 0.44756, 0.40743), ("E", 1 / 3, 1 / 3)])
def test_illuminants(name: str, x: float, y: float) -> None:
    assert expected()[f"C8.xy-{name}"] == pytest.approx((x, y), abs=5e-5)
    close(expected()[f"C8.Y-{name}"][0], 1.0)


@pytest.mark.parametrize("paint", ["white", "green", "red"])
def test_cornell_paints(paint: str) -> None:
    """The figures are sums in steps of 1 nm, ours integrals of the linear tables: they differ by 1e-4 at most."""
    reference = figures()[f"cornell_{paint}"]
    assert expected()[f"C8.{paint}-d65-xyz"] == pytest.approx(reference["D65_XYZ"], rel=1e-4)
    assert expected()[f"C8.{paint}-d65-rgb"] == pytest.approx(reference["D65_linear_sRGB"], abs=1e-4)
    assert expected()[f"C8.{paint}-lamp-xyz"] == pytest.approx(reference["lamp_XYZ"], rel=2e-4)


def test_cornell_lamp() -> None:
    reference = figures()["cornell_lamp_chromaticity"]
    assert expected()["C8.cornell-lamp-xy"] == pytest.approx((reference["x"], reference["y"]), abs=2e-5)
    assert expected()["C8.cornell-lamp-rgb"] == pytest.approx(reference["linear_sRGB_Ynorm"], abs=1e-4)


def test_white_is_white_and_luminance_is_y() -> None:
    assert expected()["C8.white-D65"] == pytest.approx((1, 1, 1), abs=3e-4)
    xyz = np.array([0.3, 0.7, 0.2])
    assert float(colorimetry.luminance(colorimetry.rec709(xyz))) == pytest.approx(0.7, rel=1e-12)


def test_every_case_is_well_formed() -> None:
    cases = all_cases()
    assert len({case.id for case in cases}) == len(cases) >= 45
    for case in cases:
        assert case.sentence
        assert case.source
        assert all(map(math.isfinite, case.expected))
        assert case.probe.start >= 32


def test_the_thin_lens() -> None:
    lens = figures()["thin_lens_f50_N2_focus2000"]
    close(1e3 * cameras.image_distance(2.0), lens["image_dist_mm"])
    close(1e3 * cameras.blur_diameter(2.0, 4.0), lens["coc_obj4000_mm"])
    close(1e3 * cameras.blur_diameter(2.0, 1.0), lens["coc_obj1000_mm"])
    close(1e3 * cameras.blur_diameter(2.0, 1e12), lens["coc_inf_mm"])
    second, fourth = cameras.polygon_moments(math.inf, 1.0)
    close(math.sqrt(second), lens["rms_radius_factor"])
    close(fourth, 1.0 / 3.0)


def test_moments_of_polygons() -> None:
    close(cameras.polygon_moments(4, math.sqrt(0.5))[0], 1.0 / 6.0)
    close(cameras.polygon_moments(4, math.sqrt(0.5))[1], 7.0 / 180.0)
    close(cameras.polygon_moments(5, 1.0)[0], (2.0 + math.cos(math.radians(72.0))) / 6.0)


def test_projected_caps_on_the_axis() -> None:
    alpha = math.radians(20.0)
    close(cameras.ellipse_area(0.0, alpha), math.pi * math.tan(alpha) ** 2)
    close(cameras.equidistant_share(math.pi / 2, 1e-3, math.pi / 2), math.pi * 1e-6 * math.pi / 2 / math.pi**2, 1e-5)
    close(cameras.equirectangular_share(math.pi / 2, 1e-3), math.pi * 1e-6 / (2.0 * math.pi**2), 1e-5)
