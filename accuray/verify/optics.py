"""Closed forms of optics: Fresnel's equations, thin films, slabs, diffuse reflectance, Sellmeier's formula.

Light is unpolarised at every interface, as in the renderer: reflectances are means over both polarisations taken
interface by interface. For stacks this differs from nature, where s and p light go their separate ways: a glass slab
at 60 degrees transmits 0.8362 in this model and 0.8481 in nature (`slab_transmittance_in_nature`).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence


def fresnel_pair(theta: float, index: complex) -> tuple[float, float]:
    """Reflectances (s, p) at the angle `theta` (radians) from a medium of index 1 onto one of `index` = n + ik."""
    cos_i = math.cos(theta)
    cos_t = (1.0 - (math.sin(theta) / index) ** 2) ** 0.5
    if isinstance(cos_t, complex) and (index * cos_t).imag < 0.0:
        cos_t = -cos_t
    r_s = (cos_i - index * cos_t) / (cos_i + index * cos_t)
    r_p = (index * cos_i - cos_t) / (index * cos_i + cos_t)
    return abs(r_s) ** 2, abs(r_p) ** 2


def fresnel(theta: float, index: complex) -> float:
    """Reflectance of one interface for unpolarised light (Fresnel 1823); above the critical angle exactly 1."""
    if isinstance(index, float) and math.sin(theta) >= index:
        return 1.0
    return 0.5 * sum(fresnel_pair(theta, index))


def film_reflectance(
    theta: float, film: float, behind: complex, thickness: float, wavelength: float, before: float = 1.0
) -> float:
    """Reflectance for unpolarised light of a plane film between two media, from the one of index `before`.

    Airy's (1833) sum over the reflections inside the film. `thickness` and `wavelength` share a unit.
    """
    indices = (complex(before), complex(film), complex(behind))
    cosines = [cmath.sqrt(1.0 - (before * math.sin(theta) / n) ** 2) for n in indices]
    cosines = [-c if (n * c).imag < 0.0 else c for n, c in zip(indices, cosines, strict=True)]
    turn = cmath.exp(4j * math.pi * indices[1] * cosines[1] * thickness / wavelength)
    total = 0.0
    for power in (1, -1):  # s, p
        y = [n * c**power for n, c in zip(indices, cosines, strict=True)]
        first, second = ((y[j] - y[j + 1]) / (y[j] + y[j + 1]) for j in (0, 1))
        total += 0.5 * abs((first + second * turn) / (1.0 + first * second * turn)) ** 2
    return total


def slab_transmittance(reflectance: float) -> float:
    """Lossless plane slab with all internal reflections: the geometric series of its two interfaces."""
    return (1.0 - reflectance) / (1.0 + reflectance)


def slab_transmittance_in_nature(theta: float, index: float) -> float:
    """The same for unpolarised sunlight on real glass: the mean of the s and p series (Stokes 1862)."""
    return 0.5 * sum(slab_transmittance(r) for r in fresnel_pair(theta, index))


def absorbing_slab(reflectance: float, share: float) -> tuple[float, float]:
    """(transmittance, reflectance) of a slab that lets `share` through on one passage, all internal reflections."""
    series = 1.0 / (1.0 - (reflectance * share) ** 2)
    transmitted = (1.0 - reflectance) ** 2 * share * series
    return transmitted, reflectance + (1.0 - reflectance) ** 2 * share**2 * reflectance * series


def plates_transmittance(reflectance: float, plates: int) -> float:
    """A pile of lossless plates with gaps between them (Stokes 1862)."""
    return (1.0 - reflectance) / (1.0 + (2 * plates - 1) * reflectance)


def diffuse_reflectance(index: float) -> float:
    """Cosine-weighted mean reflectance of an interface seen from index 1, `index` > 1 (Walsh 1926, Duntley 1942)."""
    n = index
    n2, n4 = n * n, n**4
    total = 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) ** 2)
    total += n2 * (n2 - 1.0) ** 2 / (n2 + 1.0) ** 3 * math.log((n - 1.0) / (n + 1.0))
    total -= 2.0 * n**3 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
    return total + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) ** 2) * math.log(n)


def diffuse_reflectance_inside(index: float) -> float:
    """The same seen from within: reciprocity gives 1 - F_in = (1 - F_out) / n^2."""
    return 1.0 - (1.0 - diffuse_reflectance(index)) / index**2


def lateral_shift(thickness: float, theta: float, index: float) -> float:
    """Sideways displacement, perpendicular to the ray, of a ray that crosses a plane slab."""
    sin_t = math.sin(theta)
    return thickness * sin_t * (1.0 - math.cos(theta) / math.sqrt(index**2 - sin_t**2))


def sellmeier(wavelength: float, a0: float, b: Sequence[float], c: Sequence[float]) -> float:
    """Refractive index at `wavelength` nm; `c` in square micrometres: n^2 = 1 + A0 + sum B L^2 / (L^2 - C)."""
    square = (wavelength * 1e-3) ** 2
    return math.sqrt(1.0 + a0 + sum(p * square / (square - q) for p, q in zip(b, c, strict=True)))
