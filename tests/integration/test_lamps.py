"""Illuminances by hand: what lamps described in lm, cd, lx, nit and W throw on a white surface, measured in lux."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ies_files import ies_text

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray import data

Table = dict[str, Any]

LUMENS = 683.002 * math.fsum(data.observer().y)
"""lux of an irradiance with Y = 1."""
WARM = {"blackbody": "2700 K"}
WHITE = {"type": "diffuse", "reflectance": 1.0}
FLOOR = {"type": "rectangle", "material": "white", "corner": [-1, 0, 1], "edge_u": [2, 0, 0], "edge_v": [0, 0, -2]}
RAYS, SPP = 128, 256
UPSAMPLED = 4e-3
"""How far the spectrum that an RGB colour becomes may be from its Y."""


def scene(
    lights: Table, shapes: Table | None = None, emission: Any = None, folder: Path | None = None
) -> accuray.Scene:
    """A white floor at the origin, and lamps; shapes have an emissive material."""
    lamp = {"type": "diffuse", "reflectance": 0.0, "emission": emission}
    description = {
        "integrator": {"type": "direct"},
        "materials": {"white": WHITE} | ({"lamp": lamp} if shapes else {}),
        "shapes": {"floor": FLOOR, **(shapes or {})},
        "lights": lights,
    }
    return accuray.Scene.from_dict(description, folder=folder)


def check_lux(described: accuray.Scene, expected: float, tolerance: float = 1e-4) -> None:
    """The illuminance of the floor's middle, from its luminance along rays that are independent of each other."""
    found = accuray.radiance(described, [[0.0, 0.01, 0.0]] * RAYS, [[0.0, -1.0, 0.0]] * RAYS, SPP, seed=3, space="xyz")
    lux = math.pi * LUMENS * np.asarray(found.mean, dtype=np.float64)[:, 1]
    error = lux.std(ddof=1) / math.sqrt(RAYS)
    assert error < 3e-3 * expected, "no power"
    assert lux.mean() == pytest.approx(expected, abs=4.5 * error + tolerance * expected)


def lit(table: Table, expected: float, folder: Path | None = None) -> None:
    colour = any("rgb" in value for value in table.values() if isinstance(value, dict)) or "spectrum" in table
    check_lux(scene({"lamp": table}, folder=folder), expected, UPSAMPLED if colour else 1e-4)


def glowing(emission: Any, expected: float, **shapes: Table) -> None:
    solids = {name: {"material": "lamp", **table} for name, table in shapes.items()}
    for table in solids.values():
        if table["type"] == "instance":
            del table["material"]
    check_lux(scene({}, solids, emission), expected)


@pytest.mark.parametrize(
    ("intensity", "candela"),
    [
        ("100 cd", 100.0),
        ("800 lm", 800.0 / (4.0 * math.pi)),
        ({**WARM, "intensity": "100 cd"}, 100.0),
        ({**WARM, "flux": "800 lm"}, 800.0 / (4.0 * math.pi)),
        ({"illuminant": "F11", "flux": 800}, 800.0 / (4.0 * math.pi)),
        ({"rgb": [1.0, 0.7, 0.3], "flux": "800 lm"}, 800.0 / (4.0 * math.pi)),
        ("9 W", 9.0 / 470.0 / (4.0 * math.pi) * LUMENS),
    ],
    ids=str,
)
def test_a_point(intensity: Any, candela: float) -> None:
    """At 2 m and 60 degrees: I cos / d^2."""
    position = [2.0 * math.sin(math.pi / 3.0), 1.0, 0.0]
    lit({"type": "point", "position": position, "intensity": intensity}, candela * 0.5 / 4.0)


@pytest.mark.parametrize(
    ("intensity", "of_a_candela"), [("300 cd", 300.0), ({**WARM, "flux": "600 lm"}, None)], ids=str
)
@pytest.mark.parametrize("falloff", ["smooth", "square", "linear"])
def test_a_spot(intensity: Any, of_a_candela: float | None, falloff: str) -> None:
    """On its axis and where the cosine is halfway between those of its angles."""
    a, b = math.radians(20.0), math.radians(40.0)
    ends = math.cos(a) - math.cos(b)
    steradians = {
        "smooth": 1.0 - math.cos(a) + 0.5 * ends,
        "square": 1.0 - math.cos(a) + ends / 3.0,
        "linear": 1.0 - (math.sin(b) - math.sin(a)) / (b - a),
    }[falloff]
    candela = of_a_candela or 600.0 / (2.0 * math.pi * steradians)
    half = math.acos(0.5 * (math.cos(a) + math.cos(b)))
    off_axis = {"smooth": 0.5, "square": 0.25, "linear": (b - half) / (b - a)}[falloff]
    table = {"type": "spot", "position": [0, 2, 0], "inner_angle": 20, "outer_angle": 40, "falloff": falloff}
    lit({**table, "intensity": intensity}, candela / 4.0)
    away = [math.sin(half), -math.cos(half), 0.0]
    lit({**table, "intensity": intensity, "direction": away}, off_axis * candela / 4.0)


@pytest.mark.parametrize(
    "irradiance",
    ["500 lx", {**WARM, "illuminance": "500 lx"}, {"value": 1, "irradiance": f"{500 * 470 / LUMENS!r} W/m^2"}],
)
def test_parallel_light(irradiance: Any) -> None:
    """Half of it at 60 degrees; all of it straight down."""
    slanted = [math.sin(math.pi / 3.0), -0.5, 0.0]
    lit({"type": "directional", "irradiance": irradiance}, 500.0)
    lit({"type": "directional", "irradiance": irradiance, "direction": slanted}, 250.0)


@pytest.mark.parametrize("radiance", ["100 nit", {"illuminant": "D65", "luminance": 100}], ids=str)
def test_an_even_sky(radiance: Any) -> None:
    lit({"type": "constant", "radiance": radiance}, math.pi * 100.0)


@pytest.mark.parametrize(
    ("changes", "factor"),
    [
        ({}, 1.0),
        ({"multiplier": 2.5}, 2.5),
        ({"lamp_lumens": 1500}, 1.5),
        ({"lamp_lumens": "1.5 lm", "multiplier": 3}, 0.0045),
        ({"flux": "500 lm"}, 500.0 / (640.0 * math.pi)),
        ({"flux": 500, "multiplier": 2}, 1000.0 / (640.0 * math.pi)),
        ({"spectrum": "2700 K"}, 1.0),
        ({"spectrum": [1, 0.5, 0.1], "multiplier": 2}, 2.0),
    ],
    ids=str,
)
def test_a_luminaire(changes: Table, factor: float, tmp_path: Path) -> None:
    """240 cd below and 80 cd above the horizon, from lamps of 1000 lm: 2 pi (240 + 80) lm, I / d^2 either way up."""
    angles, candelas = [0.0, 90.0, 90.001, 180.0], {0.0: 240.0, 90.0: 240.0, 90.001: 80.0, 180.0: 80.0}
    (tmp_path / "x.ies").write_text(ies_text(angles, [0.0], lambda v, _: candelas[v]))
    table = {"type": "ies", "file": "x.ies", "position": [0, 2, 0], **changes}
    lit(table, factor * 240.0 / 4.0, tmp_path)
    lit({**table, "direction": [0, 1, 0]}, factor * 80.0 / 4.0, tmp_path)


def test_a_luminaire_turns_by_c0(tmp_path: Path) -> None:
    """Candelas 100 + the horizontal angle: with c0 along x and light straight down, +z is at 270 degrees."""
    (tmp_path / "x.ies").write_text(ies_text([0, 90], [0, 90, 180, 270, 360], lambda _, h: 100.0 + h % 360.0))
    table = {"type": "ies", "file": "x.ies", "position": [0, 1, -1]}
    slant = math.sqrt(0.5) / 2.0  # cos / d^2
    lit(table, 370.0 * slant, tmp_path)
    lit({**table, "c0": [0, 0, 1]}, 100.0 * slant, tmp_path)
    lit({**table, "c0": [0, 0, -1]}, 280.0 * slant, tmp_path)
    lit({**table, "c0": [-1, 0, 0]}, 190.0 * slant, tmp_path)


LAMP_SPHERE = {"type": "sphere", "center": [0, 2, 0], "radius": 0.3}
SQUARE = {"type": "rectangle", "corner": [-0.1, 2, -0.1], "edge_u": [0.2, 0, 0], "edge_v": [0, 0, 0.2]}


@pytest.mark.parametrize("flux", ["800 lm", {**WARM, "flux": "800 lm"}], ids=str)
def test_the_flux_of_a_sphere(flux: Any) -> None:
    """L = flux / (pi area), E = pi L (r/d)^2 = flux / (4 pi d^2), whatever the radius."""
    glowing(flux, 800.0 / (4.0 * math.pi * 4.0), lamp=LAMP_SPHERE)
    glowing(flux, 800.0 / (4.0 * math.pi * 4.0), lamp={**LAMP_SPHERE, "radius": 0.01})


def test_the_flux_of_a_disk() -> None:
    """F = R^2 / (R^2 + h^2), so E = flux / (pi (R^2 + h^2))."""
    lamp = {"type": "disk", "center": [0, 1, 0], "normal": [0, -1, 0], "radius": 0.5}
    glowing("800 lm", 800.0 / (math.pi * 1.25), lamp=lamp)


def test_both_sides_share_a_flux() -> None:
    lamp = {"type": "disk", "center": [0, 1, 0], "normal": [0, -1, 0], "radius": 0.5, "material": "lamp"}
    described = scene({}, {"lamp": lamp}, "800 lm")
    assert described.materials["lamp"]["emission"].flux
    two = accuray.Scene.from_dict(
        {
            "integrator": {"type": "direct"},
            "materials": {
                "white": WHITE,
                "lamp": {"type": "diffuse", "reflectance": 0, "emission": "800 lm", "emission_sides": "both"},
            },
            "shapes": {"floor": FLOOR, "lamp": lamp},
        }
    )
    check_lux(two, 400.0 / (math.pi * 1.25))


def far(flux: float, count: int = 1) -> float:
    """Illuminance 100 m straight below small flat lamps that face down: flux / (pi d^2)."""
    return count * flux / (math.pi * 1e4)


@pytest.mark.parametrize(
    "shapes",
    [
        {"lamp": {"type": "rectangle", "corner": [0, 100, 0], "edge_u": [0.2, 0, 0], "edge_v": [0, 0, 0.3]}},
        {
            "lamp": {
                "type": "rectangle",
                "corner": [0, 0, 0],
                "edge_u": [0.1, 0, 0],
                "edge_v": [0.05, 0, 0.3],
                "transform": {"scale": 3.0, "translate": [0, 100, 0]},
            }
        },
        {
            "lamp": {
                "type": "mesh",
                "positions": [[0, 100, 0], [0.1, 100, 0], [0.1, 100, 0.1], [0, 100, 0.1], [0.3, 100, 0.05]],
                "faces": [[0, 1, 2, 3], [1, 4, 2]],
            }
        },
        {
            "lamp": {"type": "disk", "center": [0, 0, 0], "normal": [0, -1, 0], "radius": 0.1, "prototype": True},
            "copy": {"type": "instance", "of": "lamp", "transform": {"scale": 2.0, "translate": [0, 100, 0]}},
        },
    ],
    ids=["rectangle", "scaled", "mesh", "instance"],
)
def test_the_flux_of_a_flat_lamp_does_not_depend_on_its_size(shapes: dict[str, Table]) -> None:
    glowing({**WARM, "flux": "5000 lm"}, far(5000.0), **shapes)


def test_the_flux_of_a_solid_that_is_cut_into_triangles() -> None:
    """Of a cube straight above the lower face alone is seen, which has a sixth of the flux."""
    cube = {"type": "cube", "center": [0, 100, 0], "size": [0.2, 0.2, 0.2]}
    glowing("6000 lm", far(1000.0), lamp=cube)


def test_lamps_of_one_area_each_have_the_flux_and_others_need_a_material_each() -> None:
    second = {**SQUARE, "corner": [-0.1, 100, -0.1]}
    glowing("5000 lm", far(5000.0, 2), one={**SQUARE, "corner": [0.1, 100, -0.1]}, two=second)
    with pytest.raises(
        accuray.SceneError, match=r"materials.lamp.emission: is a flux for each of 2 surfaces, of 0.04 to"
    ) as e:
        glowing("5000 lm", 1.0, one=SQUARE, two={**second, "edge_u": [0.3, 0, 0]})
    assert e.value.key == "materials.lamp.emission"


def test_a_flux_that_no_shape_has_does_no_harm() -> None:
    materials = {"white": WHITE, "lamp": {"type": "diffuse", "emission": "800 lm"}}
    sky = {"sky": {"type": "constant", "radiance": "10 nit"}}
    check_lux(
        accuray.Scene.from_dict({"materials": materials, "shapes": {"floor": FLOOR}, "lights": sky}), math.pi * 10.0
    )
