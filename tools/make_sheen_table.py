"""Writes src/kernels/bsdf/sheen_data.h: the directional albedo of fuzz (kernels/bsdf/sheen.h).

    python tools/make_sheen_table.py > src/kernels/bsdf/sheen_data.h

`bare` is the albedo of D V, which exceeds 1 where the lobe is narrow; `albedo` that of what the kernels return, D V
divided by the larger albedo of its two directions where that is above 1. By Gauss and Legendre's quadrature over the
root of the cosine and the midpoints of the azimuth. It takes seconds.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ALPHAS, COSINES = 20, 24
"""Nodes along each axis."""
LEAST_ALPHA = 0.05
LARGEST = 2.0
"""Albedo that is stored as 65535."""
POINTS = 256, 256

HEADER = """// Made by tools/make_sheen_table.py; see there and sheen.h. Albedos in parts of 65535 / {largest:g}.
#pragma once

#include "kernels/port.h"

namespace accuray {{

constexpr uint32_t sheen_alphas = {alphas};
constexpr uint32_t sheen_cosines = {cosines};
constexpr float sheen_least_alpha = {least}f;
constexpr float sheen_step = {largest}f / 65535.0f;

struct SheenGrid {{
  uint16_t value[sheen_alphas][sheen_cosines];
}};
struct SheenTable {{
  SheenGrid bare;    // of D V
  SheenGrid albedo;  // of what is returned
}};
"""


def alphas() -> Array:
    """Widths of the rows."""
    return np.asarray(LEAST_ALPHA + (1.0 - LEAST_ALPHA) * np.linspace(0.0, 1.0, ALPHAS) ** 2)


def cosines() -> Array:
    """Cosines of the columns; the first is not quite 0."""
    return np.asarray(np.maximum(np.linspace(0.0, 1.0, COSINES) ** 2, 1e-9))


def lobe(cos_o: Array, cos_i: Array, alpha: float) -> Array:
    """Mean of 2 pi D V cos_i over the azimuth, for cosines (N, 1) and (M,)."""
    phi = np.pi * (np.arange(POINTS[1]) + 0.5) / POINTS[1]
    cos_o, cos_i = cos_o[..., None], cos_i[..., None]
    across = np.sqrt((1.0 - cos_o**2) * (1.0 - cos_i**2)) * np.cos(phi)
    squared = 2.0 + 2.0 * (across + cos_o * cos_i)
    sine2 = np.clip(1.0 - (cos_o + cos_i) ** 2 / squared, 0.0, 1.0)
    density = ((2.0 + 1.0 / alpha) * sine2 ** (0.5 / alpha)).mean(axis=-1)
    together = (cos_o + cos_i - cos_o * cos_i)[..., 0]
    return np.asarray(density * cos_i[..., 0] / (4.0 * together))


def albedos(cosine: Array, alpha: float) -> tuple[Array, Array]:
    """Albedos (bare, divided) of directions, (N,)."""
    t, weight = np.polynomial.legendre.leggauss(POINTS[0])
    t, weight = 0.5 * (t + 1.0), 0.5 * weight
    cos_i, weight = t * t, weight * 2.0 * t
    bare_i = np.concatenate([lobe(part[:, None], cos_i, alpha) @ weight for part in np.array_split(cos_i, 8)])
    values = lobe(cosine[:, None], cos_i, alpha)
    bare = values @ weight
    most = np.maximum(np.maximum(bare[:, None], bare_i), 1.0)
    return np.asarray(bare), np.asarray((values / most) @ weight)


def text(values: Array) -> str:
    """A struct's initialiser of whole numbers, row by row."""
    rows = ("{" + ", ".join(str(round(v)) for v in np.clip(row / LARGEST, 0.0, 1.0) * 65535) + "}" for row in values)
    return "{{" + ",\n".join(rows) + "}}"


def main() -> None:
    """Prints the header."""
    tables = [albedos(cosines(), float(alpha)) for alpha in alphas()]
    print(HEADER.format(alphas=ALPHAS, cosines=COSINES, least=LEAST_ALPHA, largest=LARGEST))
    print("// clang-format off\ninline constexpr SheenTable sheen_table = {")
    print(",\n".join(text(np.array(values)) for values in zip(*tables, strict=True)) + "\n};")
    print("// clang-format on\n\n}  // namespace accuray")


if __name__ == "__main__":
    main()
