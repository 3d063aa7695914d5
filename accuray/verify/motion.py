"""C7, motion: what moves while the shutter is open, as rays and pictures see it, in closed form.

A ray that crosses the path of a glowing body sees it for a share of the time: that share, weighted by what the shutter
lets through, is the radiance. Bodies move along x or turn about z while the shutter is open from 0 s to 1 s.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from accuray.verify import colorimetry
from accuray.verify.case import Case, FloatArray
from accuray.verify.probes import ImageProbe, RayProbe, fixed, looking_at
from accuray.verify.receiver import ALBEDO, ALL, SAMPLED, UP, receiver
from accuray.verify.scenes import Solid, Table, assemble, direct_only, disk, lamp, rectangle, sphere

WIDTH, RADIUS = 0.2, 0.1
TOWARDS = (0.0, 0.0, -1.0)
OPEN: Table = {"shutter_open": 0, "shutter_close": 1}
#: Motions are as exact as the picture asks for.
FINE: Table = {"width": 4096, "height": 4096, "filter": {"type": "box"}}
#: Straight segments between rotations, and pixels of a picture, leave this much of the answer.
SEGMENTS = 5e-4


def keyed(*keys: Table) -> Table:
    """A keyed transform; the keys are one second long in all."""
    last = len(keys) - 1
    return {"keys": [{"time": index / last, **key} for index, key in enumerate(keys)]}


def moving(solid: Solid, transform: Table) -> Solid:
    """The solid under a transform."""
    shape, material = solid
    return {**shape, "transform": transform}, material


ACROSS = keyed({"translate": [-0.5, 0.0, 0.0]}, {"translate": [0.5, 0.0, 0.0]})
BACK = keyed({"translate": [0.5, 0.0, 0.0]}, {"translate": [-0.5, 0.0, 0.0]})


def turning(turns: float) -> Table:
    """A rotation about z."""
    return keyed(
        {"rotate": {"axis": [0.0, 0.0, 1.0], "turns": 0.0}}, {"rotate": {"axis": [0.0, 0.0, 1.0], "turns": turns}}
    )


def bar() -> Solid:
    """A glowing bar across the x axis."""
    return rectangle((-0.5 * WIDTH, -2.0, 0.0), (WIDTH, 0.0, 0.0), (0.0, 4.0, 0.0), lamp())


def blade() -> Solid:
    """A glowing bar from the origin outwards, as wide as the other."""
    return rectangle((0.0, -0.5 * WIDTH, 0.0), (1.0, 0.0, 0.0), (0.0, WIDTH, 0.0), lamp())


def _seen(
    name: str, sentence: str, source: str, value: float, solid: Solid, at: tuple[float, float], **more: Any
) -> Case:
    """The radiance along a ray against z."""
    animation = {**OPEN, **more}
    scene = assemble([solid], film=FINE, animation=animation)
    return Case(
        f"C7.{name}",
        sentence,
        source,
        (value,),
        RayProbe(scene, fixed((*at, 3.0), TOWARDS)),
        tolerance=SEGMENTS * value,
    )


def _profiles() -> list[Case]:
    source = "share of the time that the body is there"
    rows = [
        _seen(f"bar-{name}", f"A bar of 0.2 that moves by 1, {x:g} from the middle", source, value,
              moving(bar(), ACROSS), (x, 0.0))
        for name, x, value in (("plateau", 0.3, 0.2), ("ramp", 0.5, 0.1), ("edge", 0.55, 0.05), ("outside", 0.601, 0.0))
    ]  # fmt: skip
    body = moving(disk((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), RADIUS, lamp()), ACROSS)
    ball = moving(sphere((0.0, 0.0, 0.0), RADIUS, lamp()), ACROSS)
    for y in (0.0, 0.05):
        value = 2.0 * math.sqrt(RADIUS**2 - y**2)
        text = f"of radius 0.1 that moves by 1, {y:g} beside its way: 2 sqrt(r^2 - y^2)"
        rows.append(_seen(f"disk-{y:g}", f"A disk {text}", source, value, body, (0.1, y)))
        rows.append(_seen(f"ball-{y:g}", f"A ball {text}", source, value, ball, (0.1, y)))
    return rows


def _rotations() -> list[Case]:
    """Share of a circle about the axis that the blade covers: its arc, asin(a / r) to both sides, over the turns."""
    radius = 0.5
    arc = math.asin(0.5 * WIDTH / radius) / math.pi
    rows = []
    for turns, degrees, passes in ((1.0, 40.0, 1), (1.0, 190.0, 1), (2.0, 290.0, 2), (1.5, 90.0, 2), (1.5, 270.0, 1)):
        at = (radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees)))
        sentence = f"A blade that turns by {turns:g} turns, seen at {degrees:g} degrees: passes {passes} times"
        name = f"turns-{turns:g}-{degrees:g}"
        rows.append(
            _seen(name, sentence, "arc of the blade", arc * passes / turns, moving(blade(), turning(turns)), at)
        )
    return rows


def _shutters() -> list[Case]:
    source = "integral of the shutter's shape while the bar is there"
    body = moving(bar(), ACROSS)
    shapes: list[tuple[str, float, float, Table]] = [
        ("triangle-middle", 0.0, 0.36, {"shutter_shape": "triangle"}),
        ("triangle-side", -0.3, 0.16, {"shutter_shape": "triangle"}),
        ("trapezoid-middle", 0.0, 0.8 / 3.0, {"shutter_shape": "trapezoid", "shutter_ramp": 0.25}),
        ("trapezoid-ramp", -0.35, 0.16, {"shutter_shape": "trapezoid", "shutter_ramp": 0.25}),
        # Twice the area under a line from 0 to 1 over 0.2 and back over 0.8, between 0.3 and 0.5.
        ("curve", -0.1, 0.3, {"shutter_curve": [[0, 0], [0.2, 1], [1, 0]]}),
    ]
    return [
        _seen(f"shutter-{name}", f"A moving bar, {x:g} from the middle, by a shutter that opens slowly", source, value,
              body, (x, 0.0), **more)
        for name, x, value, more in shapes
    ]  # fmt: skip


def _profile(image: FloatArray) -> FloatArray:
    """Columns of the picture, the left and the right half together: from the bar's foot to the plateau, and the sum."""
    light = np.asarray(colorimetry.luminance(image)).mean(axis=0)
    folded = 0.5 * (light + light[::-1])
    return np.array([*folded[1:4], RADIUS * light.sum()])


def _pictures() -> list[Case]:
    """The same picture of a bar that moves, and of one that the camera moves along: columns of 0.1."""
    film = {"width": 13, "height": 2, "filter": {"type": "box"}}
    still = {"type": "orthographic", "height": 0.2, "position": [0, 0, 3], "look_at": [0, 0, 0]}
    rows = []
    for name, body, camera in (
        ("body", moving(bar(), ACROSS), still),
        ("camera", bar(), {**still, "transform": BACK}),
    ):
        scene = assemble([body], film=film, camera=camera, animation=OPEN, render={"replicates": 1})
        rows.append(
            Case(
                f"C7.picture-{name}",
                f"A bar that moves by 1 in a picture: trapezoid, by motion of the {name}",
                "convolution of two boxes",
                (0.1, 0.1875, 0.2, 0.2),
                ImageProbe(scene, _profile, spp=256),
                ("ramp", "bend", "plateau", "sum"),
            )
        )
    return rows


def _lamps() -> list[Case]:
    """A spherical lamp that flies over a point: mean of h / (x^2 + h^2)^(3/2) over its way."""
    radius, height, reach = 0.3, 1.0, 1.5
    factor = radius**2 / (height * math.hypot(reach, height))
    way = keyed({"translate": [-reach, 0.0, 0.0]}, {"translate": [reach, 0.0, 0.0]})
    ball = moving(sphere((0.0, height, 0.0), radius, lamp()), way)
    rows = []
    for strategy in ALL:
        scene = assemble([receiver(), ball], integrator=direct_only(strategy), animation=OPEN, film=FINE)
        rows.append(
            Case(
                f"C7.flying-lamp/{strategy}",
                "Irradiance by a ball that flies over a point, on the average: r^2 / (h sqrt(a^2 + h^2))",
                "inverse square law, integrated",
                (ALBEDO * factor,),
                RayProbe(scene, looking_at((0, 0, 0), UP)),
                quick=strategy in SAMPLED,
            )
        )
    return rows


def cases() -> list[Case]:
    """All cases of this part of the chapter."""
    return [*_profiles(), *_rotations(), *_shutters(), *_pictures(), *_lamps()]
