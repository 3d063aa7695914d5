"""Writes src/kernels/bsdf/energy_data.h: the light that rough facets lose when each path meets only one of them.

    python tools/make_energy_table.py > src/kernels/bsdf/energy_data.h

Losses are 1 minus the directional albedo of a lossless surface of GGX facets with Smith's masking, by quadrature over
the facets that a direction sees (Dupuy and Benyoub 2023) and over reflection and refraction at each of them. The
kernels interpolate linearly between the nodes, see kernels/bsdf/energy.h for the coordinates. It takes a minute.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INDICES, ROUGHNESSES, COSINES = 28, 18, 16
"""Nodes along each axis."""
REACH = 2.0
LEAST_ALPHA = 1e-4
POINTS = 112
STEPS = 65_535
"""Losses are stored as whole numbers of this part of 1."""

HEADER = """// Made by tools/make_energy_table.py; see there and energy.h. Losses in parts of 65535.
#pragma once

#include "kernels/port.h"

namespace accuray {{

constexpr uint32_t energy_indices = {indices};
constexpr uint32_t energy_roughnesses = {roughnesses};
constexpr uint32_t energy_cosines = {cosines};
constexpr float energy_step = 1.0f / 65535.0f;
constexpr float energy_reach = {reach}f;           // cosines are spread by this times alpha
constexpr float energy_least_alpha = {least}f;  // of the row of roughness 0

struct EnergyGrid {{
  uint16_t value[energy_roughnesses][energy_cosines];
}};
struct EnergyRow {{
  uint16_t value[energy_roughnesses];
}};
struct EnergyTable {{
  EnergyGrid interface[energy_indices][2];  // losses from the rarer medium and from the denser one
  EnergyRow mean[energy_indices][2];        // their means over diffuse light
  uint16_t transmitted[energy_indices];     // share of diffuse light that a smooth interface lets into the denser one
  EnergyGrid separable;                     // a perfect metal with separable masking
  EnergyRow separable_mean;
}};
"""


@cache
def graded(count: int) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1], dense at both ends where the integrands have edges."""
    t, weight = np.polynomial.legendre.leggauss(count)
    t, weight = 0.5 * (t + 1.0), 0.5 * weight
    return t * t * (3.0 - 2.0 * t), weight * 6.0 * t * (1.0 - t)


def visible_facets(cosine: Array, alpha: float) -> tuple[Array, Array, Array]:
    """Cosines of the facets that directions see with the surface's normal and with the direction, (N, P); weights."""
    t, along = np.polynomial.legendre.leggauss(POINTS // 2)
    phi, along = 0.5 * np.pi * (t + 1.0), 0.5 * along
    v, across = graded(POINTS)
    phi, v = (a.ravel() for a in np.meshgrid(phi, v, indexing="ij"))
    weight = np.outer(along, across).ravel()
    sine = np.sqrt(1.0 - cosine * cosine)
    length = np.hypot(alpha * sine, cosine)
    wx, wz = (alpha * sine / length)[:, None], (cosine / length)[:, None]
    z = (1.0 - v) * (1.0 + wz) - wz
    r = np.sqrt(np.maximum(0.0, 1.0 - z * z))
    mx, my, mz = alpha * (r * np.cos(phi) + wx), alpha * r * np.sin(phi), z + wz
    norm = np.sqrt(mx * mx + my * my + mz * mz)
    mx, mz = mx / norm, mz / norm
    return mz, np.minimum(mx * sine[:, None] + mz * cosine[:, None], 1.0), weight


def shadowing(cos_o: Array, cos_i: Array, alpha: float, separable: bool) -> Array:
    """G2 / G1(wo), 0 for light that leaves on the wrong side (cos_i <= 0)."""
    root_o, root_i = (np.sqrt(c * c + alpha * alpha * (1.0 - c * c)) for c in (cos_o, cos_i))
    apart = 2.0 * cos_i / (cos_i + root_i)
    together = cos_i * (cos_o + root_o) / (cos_o * root_i + cos_i * root_o)
    return np.where(cos_i > 0.0, apart if separable else together, 0.0)


def losses(cosine: Array, alpha: float, eta: float, separable: bool = False) -> Array:
    """Light lost from the directions, (N,); `eta` is the index beyond over the index before, infinite for a mirror."""
    if eta == 1.0:  # straight through: wi = -wo
        return np.asarray(1.0 - shadowing(cosine, cosine, alpha, separable))
    mz, cos_m, weight = visible_facets(cosine, alpha)
    cos_o = cosine[:, None]
    reflected = shadowing(cos_o, 2.0 * cos_m * mz - cos_o, alpha, separable)
    if np.isinf(eta):
        return np.asarray(1.0 - reflected @ weight)
    sin2_t = (1.0 - cos_m * cos_m) / (eta * eta)
    cos_t = np.sqrt(np.maximum(0.0, 1.0 - sin2_t))
    s = (cos_m - eta * cos_t) / (cos_m + eta * cos_t)
    p = (eta * cos_m - cos_t) / (eta * cos_m + cos_t)
    fresnel = np.where(sin2_t < 1.0, 0.5 * (s * s + p * p), 1.0)
    cos_i = cos_o / eta - (cos_m / eta - cos_t) * mz
    refracted = shadowing(cos_o, cos_i, alpha, separable)
    return np.asarray(1.0 - (fresnel * reflected + (1.0 - fresnel) * refracted) @ weight)


def alphas() -> Array:
    """Widths of the rows."""
    return np.asarray(np.maximum(np.linspace(0.0, 1.0, ROUGHNESSES) ** 2, LEAST_ALPHA))


def cosines(alpha: float) -> Array:
    """Cosines of the nodes of a row; the first is not quite 0."""
    square = np.linspace(0.0, 1.0, COSINES) ** 2
    reach = REACH * alpha
    return np.clip(reach * square / (1.0 + reach - square), 1e-7, 1.0)


def mean_of(row: Array, alpha: float) -> float:
    """Integral of 2 cos loss over the cosine, of the loss as the kernels interpolate it."""
    t, weight = graded(400)
    reach = REACH * alpha
    place = np.sqrt(t * (1.0 + reach) / (t + reach)) * (COSINES - 1)
    return float(np.sum(weight * 2.0 * t * np.interp(place, np.arange(COSINES), row)))


def transmitted(eta: float) -> float:
    """1 minus the integral of 2 cos F(cos)."""
    if np.isinf(eta):
        return 0.0
    c, weight = graded(400)
    cos_t = np.sqrt(1.0 - (1.0 - c * c) / (eta * eta))
    s = (c - eta * cos_t) / (c + eta * cos_t)
    p = (eta * c - cos_t) / (eta * c + cos_t)
    return float(1.0 - np.sum(weight * 2.0 * c * 0.5 * (s * s + p * p)))


def grid(eta: float, separable: bool = False) -> Array:
    """Losses (roughness, cosine)."""
    return np.array([losses(cosines(alpha), alpha, eta, separable) for alpha in alphas()])


def means(losses_of: Array) -> Array:
    """Means of the rows of a grid."""
    return np.array([mean_of(row, alpha) for row, alpha in zip(losses_of, alphas(), strict=True)])


def text(values: Array) -> str:
    """A nested initialiser of whole numbers."""
    if values.ndim > 1:
        return "{" + ",\n".join(text(v) for v in values) + "}"
    return "{" + ", ".join(str(round(v)) for v in np.clip(values, 0.0, 1.0) * STEPS) + "}"


def pairs(parts: list[tuple[Array, Array]]) -> str:
    """Initialisers of structs of one array each, two by two."""
    return "{" + ",\n".join("{" + ",\n".join("{" + text(part) + "}" for part in pair) + "}" for pair in parts) + "}"


def main() -> None:
    """Prints the header."""
    q = np.linspace(0.0, 1.0, INDICES)
    with np.errstate(divide="ignore"):
        etas = (1.0 + q * q) / (1.0 - q * q)
    sides = [(grid(eta), grid(1.0 / eta if np.isfinite(eta) else eta)) for eta in etas]
    apart = grid(np.inf, separable=True)
    parts = [
        pairs(sides),
        pairs([(means(rare), means(dense)) for rare, dense in sides]),
        text(np.array([transmitted(eta) for eta in etas])),
        "{" + text(apart) + "}",
        "{" + text(means(apart)) + "}",
    ]
    counts = {"indices": INDICES, "roughnesses": ROUGHNESSES, "cosines": COSINES}
    print(HEADER.format(**counts, reach=REACH, least=LEAST_ALPHA))
    print("// clang-format off\ninline constexpr EnergyTable energy_table = {\n" + ",\n".join(parts) + "\n};")
    print("// clang-format on\n\n}  // namespace accuray")


if __name__ == "__main__":
    main()
