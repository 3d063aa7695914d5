"""C2: enclosures, where every order of reflection counts and the sum of the series is known."""

from __future__ import annotations

import math

import numpy as np

from accuray.verify import form_factors
from accuray.verify.case import Case
from accuray.verify.probes import (
    RayProbe,
    Rays,
    across_parallelogram,
    every_way,
    fixed,
    looking_at,
    parallel_beam,
)
from accuray.verify.scenes import (
    PATH,
    Solid,
    Table,
    assemble,
    black,
    box,
    diffuse,
    direct_only,
    disk,
    glass,
    lamp,
    mirror,
    point_light,
    rectangle,
    sphere,
    square,
    with_strategy,
)

SERIES = "L = Le + rho L"
UP = (0.0, 1.0, 0.0)
DOWN = (0.0, -1.0, 0.0)
NEVER = 1_000_000


def _case(name: str, sentence: str, source: str, expected: float, scene: Table, rays: Rays, spp: int = 512) -> Case:
    return Case(f"C2.{name}", sentence, source, (expected,), RayProbe(scene, rays, spp=spp))


def _box(albedo: float, integrator: Table, extra: list[Solid] | None = None) -> Table:
    return assemble([*box(diffuse(albedo, 1.0)), *(extra or [])], (), integrator)


def _furnaces() -> list[Case]:
    view = every_way((0.1, -0.2, 0.05))
    rows = []
    for albedo in (0.5, 0.8, 0.9):
        expected = form_factors.closed_enclosure(1.0, albedo)
        sentence = f"A closed glowing box of albedo {albedo:g}, all bounces"
        rows.append(_case(f"box-{albedo:g}/mis", sentence, SERIES, expected, _box(albedo, PATH), view))
    for strategy in ("light", "bsdf", "reference"):
        scene = _box(0.8, with_strategy(strategy))
        sentence = "The box of albedo 0.8 by another strategy"
        rows.append(_case(f"box-0.8/{strategy}", sentence, SERIES, 5.0, scene, view))
    early = _box(0.8, with_strategy("mis", roulette_depth=1))
    sentence = "The box of albedo 0.8 with Russian roulette from the first bounce on"
    rows.append(_case("box-0.8/early-roulette", sentence, SERIES, 5.0, early, view))
    forty = form_factors.closed_enclosure(1.0, 0.5, 40)
    scene = _box(0.5, with_strategy("mis", max_depth=40, roulette_depth=NEVER))
    rows.append(
        _case("box-0.5/no-roulette", "The box of albedo 0.5 without Russian roulette", SERIES, forty, scene, view)
    )
    return rows


def _truncated() -> list[Case]:
    view = every_way((0.1, -0.2, 0.05))
    rows = []
    for bounces in (0, 1, 2, 4, 8):
        expected = form_factors.closed_enclosure(1.0, 0.8, bounces)
        for strategy in ("mis", "reference") if bounces in (1, 4) else ("mis",):
            scene = _box(0.8, with_strategy(strategy, max_depth=bounces))
            sentence = f"The box of albedo 0.8 cut off after {bounces} bounces"
            rows.append(_case(f"box-depth-{bounces}/{strategy}", sentence, SERIES, expected, scene, view))
    expected = form_factors.closed_enclosure(1.0, 0.8, 5)
    scene = _box(0.8, with_strategy("mis", depth_budget=20))
    sentence = "A depth budget of 20 pays for five diffuse bounces of 4"
    rows.append(_case("box-depth-budget", sentence, SERIES, expected, scene, view))
    return rows


def _specular_parts() -> list[Case]:
    """Mirrors and glass inside a uniform field change nothing."""
    view = every_way((0.1, -0.2, 0.05))
    wall, silver = diffuse(0.8, 1.0), mirror()
    sides = {"-x": wall, "+x": silver, "-y": wall, "+y": silver, "-z": wall, "+z": silver}
    ball = sphere((-0.2, 0.1, 0.1), 0.2, glass(1.5))
    shiny = sphere((-0.2, 0.1, 0.1), 0.2, mirror())
    uniform = "a uniform field stays uniform"
    rows = [
        _case("mirror-walls", "The box with three walls of perfect mirror", uniform, 5.0, assemble(box(sides)), view),
        _case("box-mirror-ball", "The box with a mirror ball in it", uniform, 5.0, _box(0.8, PATH, [shiny]), view),
        _case("box-glass-ball", "The box with a glass ball in it", uniform, 5.0, _box(0.8, PATH, [ball]), view),
    ]
    duct = {"-z": diffuse(0.5, 1.0), "+z": diffuse(0.8)} | dict.fromkeys(("-x", "+x", "-y", "+y"), silver)
    plates = form_factors.parallel_plates((0.5, 0.8), (1.0, 0.0))
    for plate, expected, z in (("glowing", plates[0], -1.0), ("dark", plates[1], 1.0)):
        sentence = f"Infinite parallel plates as a duct of mirrors: the {plate} plate"
        rays = fixed((0.1, 0.2, 0.0), (0.03, -0.05, z))
        rows.append(_case(f"plates-{plate}", sentence, "two equations", expected, assemble(box(duct)), rays))
    return rows


def _spheres() -> list[Case]:
    inside = every_way((0.3, 0.2, -0.1))
    lit = assemble([sphere((0, 0, 0), 1.0, diffuse(0.5))], [point_light((0, 0, 0), math.pi)])
    rows = [
        _case(
            "sphere-point-light",
            "A hollow sphere with a point light at its centre",
            "rho I / (pi R^2 (1 - rho))",
            1.0,
            lit,
            inside,
        )
    ]
    for source, emission in (("inner", (1.0, 0.0)), ("outer", (0.0, 1.0))):
        radiances = form_factors.concentric_spheres(0.25, (0.5, 0.8), emission)
        materials = [diffuse(0.5), diffuse(0.8)]
        materials[emission.index(1.0)] |= {"emission": 1.0, "emission_sides": "both" if source == "outer" else "front"}
        scene = assemble([sphere((0, 0, 0), 1.0, materials[0]), sphere((0, 0, 0), 2.0, materials[1])])
        for seen, expected, x in (("inner", radiances[0], -1.0), ("outer", radiances[1], 1.0)):
            sentence = f"Concentric spheres, the {source} one glows: radiance of the {seen} one"
            rays = fixed((1.5, 0.0, 0.0), (x, 0.2, 0.1))
            rows.append(_case(f"concentric-{source}-{seen}", sentence, "two equations", expected, scene, rays))
    return rows


def _cavity(albedo: float, opening: float, emission: float, outside: float) -> list[Solid]:
    """A unit sphere shut by a black disk: seen from inside, a black disk is an opening, and a lit one a bright sky."""
    height = 1.0 - 2.0 * opening
    lid = disk((0, height, 0), DOWN, 1.0001 * math.sqrt(1.0 - height**2), lamp(outside) if outside else black())
    wall = diffuse(albedo, emission, "both") if emission else diffuse(albedo)
    return [sphere((0, 0, 0), 1.0, wall), lid]


def _cavities() -> list[Case]:
    source = "uniform irradiance in a sphere"
    view = every_way((0.1, -0.2, 0.05), DOWN)
    rows = []
    for albedo, opening in ((0.8, 0.5), (0.95, 0.05), (0.5, 0.25)):
        for kind, emission, outside in (("glowing", 1.0, 0.0), ("skylit", 0.0, 1.0)):
            expected = form_factors.spherical_cavity(albedo, opening, emission, outside)
            sentence = f"A spherical cavity of albedo {albedo:g}, {opening:.0%} open, {kind}"
            scene = assemble(_cavity(albedo, opening, emission, outside))
            rows.append(_case(f"cavity-{albedo:g}-{opening:g}-{kind}", sentence, source, expected, scene, view))
    multiplier = form_factors.spherical_cavity(0.95, 0.05, 0.95)
    scene = assemble(_cavity(0.95, 0.05, 0.0, 0.0), [point_light((0, 0, 0), math.pi)])
    sentence = "An integrating sphere of albedo 0.95, 5% open: its multiplier rho / (1 - rho (1 - f))"
    rows.append(_case("integrating-sphere", sentence, source, multiplier, scene, view))
    return rows


def _exchange() -> list[Case]:
    """View factors: the mean direct light over a receiver, rays spread over its area."""
    floor = rectangle((0, 0, 0), (0, 0, 1), (1, 0, 0), diffuse(0.5))
    over_floor = across_parallelogram((0, 1e-3, 0), (0, 0, 1), (1, 0, 0), DOWN)
    opposed = rectangle((0, 1, 0), (1, 0, 0), (0, 0, 1), lamp())
    beside = rectangle((0, 0, 0), (0, 1, 0), (0, 0, 1), lamp())
    walls = dict.fromkeys(("-x", "+x", "-z", "+z", "+y"), lamp()) | {"-y": diffuse(0.5)}
    over_box = across_parallelogram((-0.5, -0.499, -0.5), (0, 0, 1), (1, 0, 0), DOWN)
    plate, source = disk((0, 0, 0), UP, 1.0, diffuse(0.5)), disk((0, 1, 0), DOWN, 1.0, lamp())
    setups: list[tuple[str, str, str, float, list[Solid], Rays]] = [
        (
            "squares-opposed",
            "View factor of opposed unit squares at distance 1",
            "Howell C-11",
            form_factors.parallel_rectangles(1, 1, 1),
            [floor, opposed],
            over_floor,
        ),
        (
            "squares-perpendicular",
            "View factor of perpendicular unit squares with a common edge",
            "Howell C-14",
            form_factors.perpendicular_rectangles(1, 1, 1),
            [floor, beside],
            over_floor,
        ),
        ("cube-sum", "The view factors of a closed cube sum to 1", "closure", 1.0, box(walls), over_box),
        (
            "disks-coaxial",
            "View factor of coaxial unit disks at distance 1",
            "Howell C-41",
            form_factors.coaxial_disks(1, 1, 1),
            [plate, source],
            parallel_beam(DOWN, 1.0, 1e-3),
        ),
    ]
    rows = []
    for name, sentence, reference, factor, solids, rays in setups:
        scene = assemble(solids, (), direct_only("mis"))
        probe = RayProbe(scene, rays, factor=2.0, spp=16, start=64, group=1024)
        rows.append(Case(f"C2.{name}", sentence, reference, (factor,), probe))
    return rows


def _phases() -> list[Case]:
    """Lambert's sphere under parallel light of irradiance 1."""
    rows = []
    for degrees in (0, 60, 90, 120):
        phase = math.radians(degrees)
        sun = {"type": "directional", "direction": [-math.sin(phase), -math.cos(phase), 0.0]}
        scene = assemble([sphere((0, 0, 0), 1.0, diffuse(0.5))], [sun], direct_only("mis"))
        probe = RayProbe(scene, parallel_beam(DOWN, 1.0), factor=2.0, spp=4, start=64, group=4096)
        sentence = f"Lambert's sphere at a phase angle of {degrees} degrees"
        expected = form_factors.lambert_sphere(phase)
        rows.append(Case(f"C2.lambert-sphere-{degrees}", sentence, "Lambert 1760", (expected,), probe))
    return rows


def _light_tightness() -> list[Case]:
    """A closed black box in a bright field is exactly dark inside."""
    shell = [square(0.5 * n, n, 1.0, diffuse(0.9)) for n in np.concatenate([np.eye(3), -np.eye(3)])]
    scene = assemble(shell, [{"type": "constant", "radiance": 1000.0}])
    sentence = "A closed box in a bright environment is exactly dark inside"
    rays = looking_at((0.1, -0.5, 0.2), UP)
    return [_case("light-tight", sentence, "nothing passes a wall", 0.0, scene, rays)]


def cases() -> list[Case]:
    """All cases of this chapter."""
    groups = (_furnaces, _truncated, _specular_parts, _spheres, _cavities, _exchange, _phases, _light_tightness)
    return [case for group in groups for case in group()]
