"""Cases of `accuray verify` with the real renderer: a share of them that changes with ACCURAY_TEST_SEED."""

from __future__ import annotations

import os

import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")

from accuray.verify import Case, all_cases, run

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SHARE = 12

#: Always run: one case for each kind of light, strategy, BSDF and unit of colour.
ALWAYS = (
    "C1.disk-on-axis/mis",
    "C1.disk-on-axis/light",
    "C1.disk-on-axis/bsdf",
    "C1.point/mis",
    "C1.environment/mis",
    "C1.spot-edge/mis",
    "C1.directional/mis",
    "C1.luminaire/mis",
    "C1.lumen-sphere/mis",
    "C1.sphere-45/mis",
    "C2.box-0.8/mis",
    "C2.concentric-outer-outer",
    "C3.glass-sphere",
    "C3.image-furnace",
    "C4.slab-T-60",
    "C4.into-glass-30",
    "C4.metal-Au-60",
    "C4.film-oxide-0",
    "C5.prism-N-BK7-d",
    "C5.caustic-1.5-0.25",
    "C7.blur-far",
    "C7.edge-in-focus",
    "C7.ball-off-axis",
    "C7.panorama-side",
    "C7.fisheye-off-axis",
    "C7.bar-ramp",
    "C7.disk-0.05",
    "C7.turns-2-290",
    "C7.shutter-triangle-side",
    "C7.picture-camera",
    "C7.flying-lamp/mis",
    "C8.xy-D65",
    "C8.red-lamp-xyz",
    "C9.sky-560nm",
    "C9.ground-560nm-sun/mis",
)


def chosen() -> list[Case]:
    cases = [case for case in all_cases() if case.quick]
    return [case for i, case in enumerate(cases) if case.id in ALWAYS or (i + SEED) % SHARE == 0]


def test_the_list_names_cases() -> None:
    assert set(ALWAYS) <= {case.id for case in all_cases()}


@pytest.mark.parametrize("case", chosen(), ids=lambda case: case.id)
def test_case(case: Case) -> None:
    report = run(quick=True, seed=SEED, only=lambda other: other.id == case.id)
    assert report.passed, report.table()
