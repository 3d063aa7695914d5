"""C7: what a lens, an opening and a projection do to the picture, in closed form.

Lengths are those of a photographer: a 50 mm lens at f/2, focused at 2 m unless a case says otherwise. The light is a
glowing disk before darkness, whose sharp image is a disk too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from accuray.verify import colorimetry
from accuray.verify.case import Case, FloatArray
from accuray.verify.probes import ImageProbe
from accuray.verify.scenes import Table, assemble, disk, environment, lamp, rectangle, sphere

FOCAL_LENGTH, F_NUMBER = 0.05, 2.0
FOCUS = 2.0
PIXELS = 16
#: Radius of the lamp's sharp image, and width of the film, in diameters of the blur.
LAMP, FILM = 0.25, 1.6
AHEAD = (0.0, 0.0, -1.0)
TO_CAMERA = (0.0, 0.0, 1.0)
FILTERS = ("box", "tent", "gaussian", "blackman_harris")
#: Batches tell the error, so all samples of a pixel may form one net.
ONE: Table = {"replicates": 1}


def image_distance(focus: float) -> float:
    """Distance from the lens to the film (Gauss 1841)."""
    return 1.0 / (1.0 / FOCAL_LENGTH - 1.0 / focus)


def blur_diameter(focus: float, distance: float) -> float:
    """Diameter of the blur circle on the film of a point at `distance` from the lens: (f/N) f |S2-S1| / (S2 (S1-f))."""
    opening = FOCAL_LENGTH / F_NUMBER
    return opening * FOCAL_LENGTH * abs(distance - focus) / (distance * (focus - FOCAL_LENGTH))


def _lens(film_size: float, focus: float = FOCUS, **more: Any) -> Table:
    here = {"position": [0, 0, 0], "look_at": list(AHEAD), "focal_length": FOCAL_LENGTH, "film_size": film_size}
    return {"type": "perspective", "f_number": F_NUMBER, "focus_distance": focus, **here, **more}


def _film(width: int, height: int) -> Table:
    return {"width": width, "height": height, "filter": {"type": "box"}}


def _radii(pixels: int) -> FloatArray:
    """Distance of each pixel's middle from the picture's, in widths of the picture."""
    x = (np.arange(pixels) + 0.5) / pixels - 0.5
    return np.asarray(np.hypot(x[:, None], x[None, :]))


def polygon_moments(corners: float, radius: float) -> tuple[float, float]:
    """Means of r^2 and r^4 over a regular polygon, by the triangles about its middle; infinite corners: a disk."""
    squared = (radius * math.cos(math.pi / corners)) ** 2
    t = math.tan(math.pi / corners) ** 2
    return squared / 2.0 * (1.0 + t / 3.0), squared**2 / 3.0 * (1.0 + 2.0 * t / 3.0 + t**2 / 5.0)


def _blur_moments(image: FloatArray) -> FloatArray:
    """Means of r^2 and r^4 over the blur alone, in units of its diameter.

    The picture is the blur, the lamp's sharp image and the pixel (Sheppard 1898) on top of each other. Of independent
    X and Y about the middle, alike on both axes, E|X + Y|^2 = E|X|^2 + E|Y|^2 and E|X + Y|^4 = E|X|^4 + E|Y|^4 +
    4 E|X|^2 E|Y|^2.
    """
    light = np.asarray(colorimetry.luminance(image))
    radii = FILM * _radii(PIXELS)
    second, fourth = ((light * radii**n).sum() / light.sum() for n in (2, 4))
    side = FILM / PIXELS
    for two, four in ((side**2 / 6.0, 7.0 * side**4 / 180.0), polygon_moments(math.inf, LAMP)):
        second -= two
        fourth -= four + 4.0 * two * second
    return np.array([second, fourth])


def _blur(name: str, sentence: str, source: str, distance: float, corners: float, **more: Any) -> list[Case]:
    """The blur of a lamp at `distance`: its size, and for the long run its shape too."""
    blur = blur_diameter(FOCUS, distance)
    radius = LAMP * blur * distance / image_distance(FOCUS)
    scene = assemble(
        [disk((0, 0, -distance), TO_CAMERA, radius, lamp())],
        film=_film(PIXELS, PIXELS),
        camera=_lens(FILM * blur, **more),
        render=ONE,
    )
    moments = polygon_moments(corners, 0.5)
    size = ImageProbe(scene, lambda image: _blur_moments(image)[0], spp=512)
    shape = ImageProbe(scene, _blur_moments, spp=512)
    return [
        Case(f"C7.blur-{name}", f"{sentence}: r^2 of the light, in diameters", source, moments[:1], size),
        Case(f"C7.blur-{name}/shape", f"{sentence}: r^2, r^4", source, moments, shape, ("r^2", "r^4"), quick=False),
    ]


def _blurs() -> list[Case]:
    """The blur of a lamp behind, before and far behind the focus, and through blades."""
    rows = []
    for name, distance in (("far", 4.0), ("near", 1.0), ("sky", 1e5)):
        size = 1e3 * blur_diameter(FOCUS, distance)
        sentence = f"A lamp at {distance:g} m, lens focused at 2 m: an even disk of {size:.5f} mm"
        rows += _blur(name, sentence, "c = (f/N) f |S2 - S1| / (S2 (S1 - f))", distance, math.inf)
    sentence = "The lamp at 4 m through five blades: an even pentagon"
    return rows + _blur("pentagon", sentence, "regular polygon", 4.0, 5, blades=5, blade_rotation=20)


def _fluxes() -> list[Case]:
    """What the lens gathers does not depend on its focus: area on the film by the image distance squared."""
    rows = []
    for focus in (1.0, 2.0, 8.0):
        size, radius = 1.8e-3, 24e-3
        scale = (size / image_distance(focus)) ** 2 / (math.pi * (radius / 4.0) ** 2)
        scene = assemble(
            [disk((0, 0, -4), TO_CAMERA, radius, lamp())], film=_film(4, 4), camera=_lens(size, focus), render=ONE
        )
        rows.append(
            Case(
                f"C7.flux-{focus:g}",
                f"Light of a lamp at 4 m with the lens focused at {focus:g} m: as much as in any focus",
                "conservation of flux",
                (1.0,),
                ImageProbe(scene, _mean_of(scale), spp=2048),
                quick=focus > 1.0,
            )
        )
    return rows


def _mean_of(factor: float) -> Callable[[FloatArray], float]:
    return lambda image: factor * float(np.mean(colorimetry.luminance(image)))


def _in_focus() -> Case:
    """The edge of a wall in the plane in focus, 3.3 pixels from the left, where a pinhole would show it."""
    size = 1e-3
    width = size * FOCUS / image_distance(FOCUS)
    edge = (3.3 / 8.0 - 0.5) * width
    scene = assemble(
        [rectangle((edge - 3, -3, -FOCUS), (3, 0, 0), (0, 6, 0), lamp())], film=_film(8, 8), camera=_lens(size)
    )
    return Case(
        "C7.edge-in-focus",
        "An edge in the plane in focus, in pixels, where central projection has it",
        "thin lens",
        (3.3,),
        ImageProbe(scene, _mean_of(8.0)),
    )


def _filters() -> list[Case]:
    """An edge 3.3 pixels from the left, under each pixel filter: none adds or loses light."""
    camera = {"type": "orthographic", "height": 8.0, "position": [0, 0, 0], "look_at": list(AHEAD)}
    rows = []
    for name in FILTERS:
        film = {"width": 8, "height": 8, "filter": {"type": name}}
        scene = assemble([rectangle((-0.7, -20, -2), (40, 0, 0), (0, 40, 0), lamp())], film=film, camera=camera)
        sentence = f"An edge at 3.3 pixels of 8 under the {name} filter: light of the rest"
        source = "the filter's weights add up to 1"
        rows.append(Case(f"C7.filter-{name}", sentence, source, (4.7,), ImageProbe(scene, _mean_of(8.0))))
    return rows


def _wall() -> Case:
    camera = {"type": "perspective", "fov": 100, "aperture_radius": 0.05}
    scene = assemble([], [environment()], film=_film(8, 8), camera=camera)
    return Case(
        "C7.even-wall",
        "A wall of radiance 1 in a field of 100 degrees: corner and middle, without vignetting",
        "the film shows radiance",
        (1.0, 1.0),
        ImageProbe(scene, lambda image: np.asarray(colorimetry.luminance(image))[[0, 4], [0, 4]]),
        ("corner", "middle"),
    )


def _covered(name: str, sentence: str, source: str, camera: Table, solids: list[Any], share: float) -> Case:
    """A case on the share of a square picture, or of a panorama, that a glowing ball covers."""
    film = _film(64, 32) if camera["type"] == "panorama" else _film(32, 32)
    here = {"position": [0, 0, 0], "look_at": list(AHEAD)}
    scene = assemble(solids, film=film, camera={**here, **camera})
    return Case(f"C7.{name}", sentence, source, (share,), ImageProbe(scene, _mean_of(1.0)))


def _ball(theta: float, alpha: float, distance: float = 3.0) -> Any:
    """A ball of angular radius `alpha` at the angle `theta` from the axis, upwards."""
    center = (0.0, distance * math.sin(theta), -distance * math.cos(theta))
    return sphere(center, distance * math.sin(alpha), lamp())


def ellipse_area(theta: float, alpha: float) -> float:
    """Area of a ball's central projection to the plane at distance 1: the section of a cone."""
    squared = math.cos(alpha) ** 2 - math.sin(theta) ** 2
    return math.pi * math.sin(alpha) ** 2 * math.cos(alpha) / math.pow(squared, 1.5)


def _half_widths(theta: float, alpha: float, steps: int = 20000) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Polar angles across a cap about `theta`, half its width in azimuth at each, and quadrature weights."""
    t = (np.arange(steps) + 0.5) * math.pi / steps
    polar = theta - alpha * np.cos(t)
    cosine = (math.cos(alpha) - np.cos(polar) * math.cos(theta)) / (np.sin(polar) * math.sin(theta))
    return polar, np.arccos(np.clip(cosine, -1.0, 1.0)), alpha * np.sin(t) * math.pi / steps


def equidistant_share(theta: float, alpha: float, edge: float) -> float:
    """Share of the square around an equidistant image circle, `edge` its angle, that a cap covers."""
    polar, half_width, weight = _half_widths(theta, alpha)
    return float((2.0 * half_width * polar * weight).sum() / (4.0 * edge**2))


def equirectangular_share(theta: float, alpha: float) -> float:
    """Share of a panorama that a cap at the polar angle `theta` covers."""
    _, half_width, weight = _half_widths(theta, alpha)
    return float((2.0 * half_width * weight).sum() / (2.0 * math.pi**2))


def _projections() -> list[Case]:
    theta, alpha = math.radians(25.0), math.radians(12.0)
    square = 4.0 * math.tan(math.radians(40.0)) ** 2
    at = {"type": "perspective", "fov": 80.0}
    rows = [
        _covered(
            "ball-off-axis", "A ball 25 degrees off the axis of a pinhole: an ellipse", "section of a cone", at,
            [_ball(theta, alpha)], ellipse_area(theta, alpha) / square,
        ),
        _covered(
            "orthographic", "A ball under parallel rays: pi r^2", "parallel projection",
            {"type": "orthographic", "height": 2.0}, [sphere((0.2, -0.1, -7), 0.6, lamp())], math.pi * 0.09,
        ),
        _covered(
            "panorama-side", "A ball 60 degrees above the horizon of a panorama", "equirectangular map",
            {"type": "panorama"}, [_ball(math.radians(60), alpha)], equirectangular_share(math.radians(30), alpha),
        ),
        _covered(
            "panorama-pole", "A ball at a panorama's zenith: a strip of constant height", "equirectangular map",
            {"type": "panorama"}, [_ball(math.radians(90), alpha)], alpha / math.pi,
        ),
        _covered(
            "fisheye-off-axis", "A ball 50 degrees off the axis of an equidistant fisheye", "r = f t",
            {"type": "fisheye"}, [_ball(math.radians(50), alpha)],
            equidistant_share(math.radians(50), alpha, math.radians(90)),
        ),
    ]  # fmt: skip
    wide = math.radians(35.0)
    mappings: dict[str, Callable[[float], float]] = {
        "equidistant": lambda t: t,
        "equisolid": lambda t: math.sin(0.5 * t),
        "stereographic": lambda t: math.tan(0.5 * t),
        "orthographic": math.sin,
    }
    for name, radius in mappings.items():
        share = 0.25 * math.pi * (radius(wide) / radius(math.radians(80.0))) ** 2
        camera = {"type": "fisheye", "mapping": name, "fov": 160.0}
        rows.append(
            _covered(f"fisheye-{name}", f"A ball on the axis of the {name} fisheye", "the mapping's own formula",
                     camera, [_ball(0.0, wide)], share)
        )  # fmt: skip
    return rows


def cases() -> list[Case]:
    """All cases of this chapter."""
    return [*_blurs(), *_fluxes(), _in_focus(), *_filters(), _wall(), *_projections()]
