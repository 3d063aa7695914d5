"""Closed forms of diffuse exchange: configuration factors, view factors between surfaces, enclosures.

A configuration factor F is the irradiance at a point divided by pi times the radiance of a uniform Lambertian source;
a Lambertian point of albedo rho shows the radiance rho F L. Formulas as in Howell, Menguc and Siegel 2016, "Thermal
Radiation Heat Transfer", and its on-line catalogue of factors (numbers such as C-41 are the catalogue's).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def disk_on_axis(radius: float, height: float) -> float:
    """Disk parallel to the receiver, centred above it."""
    return radius**2 / (radius**2 + height**2)


def disk_off_axis(radius: float, height: float, shift: float) -> float:
    """Disk parallel to the receiver, its axis `shift` away."""
    total = height**2 + shift**2 + radius**2
    return 0.5 * (1.0 - (total - 2.0 * radius**2) / math.sqrt(total**2 - 4.0 * shift**2 * radius**2))


def rectangle_above_corner(width: float, depth: float, height: float) -> float:
    """Rectangle parallel to the receiver, one corner straight above it."""
    x, y = width / height, depth / height
    p, q = math.sqrt(1.0 + x * x), math.sqrt(1.0 + y * y)
    return (x / p * math.atan(y / p) + y / q * math.atan(x / q)) / (2.0 * math.pi)


def polygon(vertices: ArrayLike, point: ArrayLike, normal: ArrayLike) -> float:
    """Polygon wholly above the receiver's horizon (Lambert 1760): half the sum of edge angles times edge normals."""
    v = np.asarray(vertices, dtype=np.float64) - np.asarray(point, dtype=np.float64)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    n = np.asarray(normal, dtype=np.float64)
    total = 0.0
    for a, b in zip(v, np.roll(v, -1, axis=0), strict=True):
        axis = np.cross(a, b)
        length = float(np.linalg.norm(axis))
        total += math.atan2(length, float(a @ b)) * float(axis @ n) / length
    return abs(total) / (2.0 * math.pi)


def sphere(radius: float, distance: float, theta: float) -> float:
    """Sphere whose centre lies at the angle `theta` (radians) from the receiver's normal, cut by the horizon or not."""
    if theta + math.asin(radius / distance) <= 0.5 * math.pi:
        return (radius / distance) ** 2 * math.cos(theta)
    k = math.sqrt(distance**2 - radius**2)
    sin_t, cos_t = math.sin(theta), math.cos(theta)
    edge = radius**2 * cos_t * math.acos(-k * cos_t / (sin_t * radius))
    edge -= k * math.sqrt(radius**2 - distance**2 * cos_t**2)
    return 0.5 - math.asin(k / (distance * sin_t)) / math.pi + edge / (math.pi * distance**2)


def parallel_rectangles(width: float, depth: float, distance: float) -> float:
    """View factor between two equal, directly opposed rectangles (C-11)."""
    x, y = width / distance, depth / distance
    p, q = math.sqrt(1.0 + x * x), math.sqrt(1.0 + y * y)
    total = math.log(p * q / math.sqrt(1.0 + x * x + y * y))
    total += x * q * math.atan(x / q) + y * p * math.atan(y / p) - x * math.atan(x) - y * math.atan(y)
    return 2.0 * total / (math.pi * x * y)


def perpendicular_rectangles(width: float, height: float, edge: float) -> float:
    """View factor from a rectangle (`width` x `edge`) to one (`height` x `edge`) upright on the same edge (C-14)."""
    w, h = width / edge, height / edge
    w2, h2 = w * w, h * h
    s = w2 + h2
    total = w * math.atan(1.0 / w) + h * math.atan(1.0 / h) - math.sqrt(s) * math.atan(1.0 / math.sqrt(s))
    logs = math.log((1.0 + w2) * (1.0 + h2) / (1.0 + s))
    logs += w2 * math.log(w2 * (1.0 + s) / ((1.0 + w2) * s))
    logs += h2 * math.log(h2 * (1.0 + s) / ((1.0 + h2) * s))
    return (total + 0.25 * logs) / (math.pi * w)


def coaxial_disks(radius: float, other: float, distance: float) -> float:
    """View factor from a disk to a parallel disk on the same axis (C-41)."""
    r1, r2 = radius / distance, other / distance
    s = 1.0 + (1.0 + r2 * r2) / (r1 * r1)
    return 0.5 * (s - math.sqrt(s * s - 4.0 * (r2 / r1) ** 2))


def closed_enclosure(emission: float, albedo: float, bounces: int | None = None) -> float:
    """Radiance in a closed enclosure, all walls alike: L = Le + rho L, or its series up to `bounces` reflections."""
    missing = 0.0 if bounces is None else albedo ** (bounces + 1)
    return emission * (1.0 - missing) / (1.0 - albedo)


def concentric_spheres(ratio: float, albedo: Sequence[float], emission: Sequence[float]) -> tuple[float, float]:
    """Radiances of the inner and outer of two concentric spheres; `ratio` is inner over outer area."""
    (rho1, rho2), (m1, m2) = albedo, emission
    outer = (m2 + rho2 * ratio * m1) / (1.0 - rho2 * (1.0 - ratio) - rho1 * rho2 * ratio)
    return m1 + rho1 * outer, outer


def parallel_plates(albedo: Sequence[float], emission: Sequence[float]) -> tuple[float, float]:
    """Radiances of two infinite parallel Lambertian plates."""
    (rho1, rho2), (m1, m2) = albedo, emission
    loss = 1.0 - rho1 * rho2
    return (m1 + rho1 * m2) / loss, (m2 + rho2 * m1) / loss


def spherical_cavity(albedo: float, opening: float, emission: float = 0.0, outside: float = 0.0) -> float:
    """Radiance of the wall of a sphere of which the area fraction `opening` is missing.

    `outside` is the radiance that enters through the opening. Exact: form factors between points of one sphere are
    constant, so the irradiance inside is uniform.
    """
    return (emission + albedo * opening * outside) / (1.0 - albedo * (1.0 - opening))


def lambert_sphere(phase: float) -> float:
    """Mean radiance of the disk of a white Lambertian sphere per unit irradiance, at `phase` radians (Lambert 1760)."""
    return 2.0 / (3.0 * math.pi**2) * (math.sin(phase) + (math.pi - phase) * math.cos(phase))
