"""C3, rough surfaces: what facets that scatter once keep of the light, and that compensated ones keep all of it.

The albedo of single scattering is an integral over the facets' normals here; the renderer samples the facets that a
direction sees and adds up directions of light.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from accuray.verify.case import Case
from accuray.verify.probes import RayProbe, Rays, meeting_origin
from accuray.verify.scenes import PATH, Table, assemble, disk, environment, lamp

FloatArray = NDArray[np.float64]

INDEX = 1.5
MIRROR = math.inf
POINTS = 1500, 160
"""Nodes along xi, where the edges are, and along phi."""
COSINES = (1.0, 0.5, 0.1)
SOURCE = "GGX: Walter et al. 2007, Heitz 2014"
COMPENSATED = 0.005
"""What compensation may be off by: its tables are interpolated."""


@cache
def _normals() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Nodes xi and phi, (N,), and weights, of D cos(theta_m) d omega_m = d xi d phi / (2 pi) on one half of phi.

    The facet's slope is tan^2(theta_m) = alpha^2 xi / (1 - xi).
    """
    t, across = ((np.arange(n) + 0.5) / n for n in POINTS)
    xi, phi = (a.ravel() for a in np.meshgrid(t * t * (3.0 - 2.0 * t), np.pi * across, indexing="ij"))
    return xi, phi, np.repeat(6.0 * t * (1.0 - t), POINTS[1]) / (POINTS[0] * POINTS[1])


def _smith(cosine: FloatArray, alpha: float) -> FloatArray:
    """Lambda of G1 = 1 / (1 + Lambda)."""
    tan2 = np.maximum(1.0 / np.maximum(cosine, 1e-12) ** 2 - 1.0, 0.0)
    return np.asarray(0.5 * (np.sqrt(1.0 + alpha**2 * tan2) - 1.0))


def albedo(cosine: float, alpha: float, eta: float = MIRROR, separable: bool = False) -> float:
    """Light that leaves a lossless surface of GGX facets after one scattering, of light that comes at `cosine`.

    `eta` is the index beyond over the index before the surface; MIRROR reflects everything. `separable`: masking and
    shadowing by G1 each, instead of the height-correlated G2.
    """
    xi, phi, weight = _normals()
    tan2 = alpha**2 * xi / (1.0 - xi)
    cos_m = 1.0 / np.sqrt(1.0 + tan2)
    sine = math.sqrt(1.0 - cosine**2)
    cos_o = sine * np.sqrt(tan2) * cos_m * np.cos(phi) + cosine * cos_m
    seen = np.maximum(cos_o, 0.0) / (cosine * cos_m) * weight
    before = _smith(np.array(cosine), alpha)

    def passed(cos_i: FloatArray) -> FloatArray:
        after = _smith(cos_i, alpha)
        g = 1.0 / ((1.0 + before) * (1.0 + after)) if separable else 1.0 / (1.0 + before + after)
        return np.where(cos_i > 0.0, g, 0.0)

    reflected = seen * passed(2.0 * cos_o * cos_m - cosine)
    if math.isinf(eta):
        return float(reflected.sum())
    sin2_t = (1.0 - cos_o**2) / eta**2
    cos_t = np.sqrt(np.maximum(0.0, 1.0 - sin2_t))
    s, p = (cos_o - eta * cos_t) / (cos_o + eta * cos_t), (eta * cos_o - cos_t) / (eta * cos_o + cos_t)
    fresnel = np.where(sin2_t < 1.0, 0.5 * (s * s + p * p), 1.0)
    transmitted = seen * passed(cosine / eta - (cos_o / eta - cos_t) * cos_m)
    return float((fresnel * reflected + (1.0 - fresnel) * transmitted).sum())


def _case(name: str, sentence: str, expected: float, scene: Table, rays: Rays, factor: float = 1.0) -> Case:
    probe = RayProbe(scene, rays, factor, spp=2048, start=64)
    compensated = name.endswith("compensated")
    return Case(
        f"C3.{name}",
        sentence,
        "white furnace: nothing absorbs" if compensated else SOURCE,
        (expected,),
        probe,
        quick="0.3" in name,
        tolerance=COMPENSATED if compensated else 0.0,
    )


def _metals() -> list[Case]:
    """A sky of radiance 1 in a plate of a metal that reflects everything."""
    rows = []
    for alpha in (0.1, 0.3, 0.5, 1.0):
        for masking, compensate in (("correlated", False), ("separable", False), ("correlated", True)):
            facets = {"roughness": math.sqrt(alpha), "masking": masking, "compensate": compensate}
            plate = disk((0, 0, 0), (0, 1, 0), 1.0, {"type": "conductor", "metal": "perfect", **facets})
            scene = assemble([plate], [environment()], PATH)
            for cosine in COSINES:
                kind = "compensated" if compensate else masking
                expected = 1.0 if compensate else albedo(cosine, alpha, separable=masking == "separable")
                sentence = f"Metal of alpha {alpha} at cosine {cosine}, F = 1, {kind}"
                rays = meeting_origin(math.acos(cosine))
                rows.append(_case(f"metal-{alpha}-{cosine}-{kind}", sentence, expected, scene, rays))
    return rows


def _glasses() -> list[Case]:
    """Reflection and transmission together: a sky of radiance 1 before, a lamp of radiance n^2 behind the interface."""
    rows = []
    for alpha in (0.1, 0.3, 0.5):
        for compensate in (False, True):
            frosted = {"type": "dielectric", "ior": INDEX, "roughness": math.sqrt(alpha), "compensate": compensate}
            interface = disk((0, 0, 0), (0, 1, 0), 10.0, frosted)
            floor = disk((0, -0.1, 0), (0, 1, 0), 1e4, lamp(INDEX**2))
            scene = assemble([interface, floor], [environment()], PATH | {"max_depth": 1})
            for cosine in COSINES:
                for side, eta in (("outside", INDEX), ("inside", 1.0 / INDEX)):
                    kind = "compensated" if compensate else "once"
                    expected = 1.0 if compensate else albedo(cosine, alpha, eta)
                    sentence = f"Glass (n = 1.5) of alpha {alpha} at cosine {cosine} from {side}: R + T, {kind}"
                    rays = meeting_origin(math.acos(cosine), below=side == "inside")
                    factor = INDEX**-2 if side == "inside" else 1.0
                    rows.append(_case(f"glass-{alpha}-{cosine}-{side}-{kind}", sentence, expected, scene, rays, factor))
    return rows


def cases() -> list[Case]:
    """The rough part of this chapter."""
    return [*_metals(), *_glasses()]
