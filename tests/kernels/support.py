"""What the tests of the kernels share: a seed, and the compiled probe as functions of doubles.

The larger sets of cases are too many for every run: each run takes those that ACCURAY_TEST_SEED selects, 0 unless it
is set, and one set with all others follows from another seed. A failing test names the seed in its message.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray import devices

FloatArray = NDArray[np.float64]

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
#: One hero and three others (nm), no two alike.
WAVELENGTHS = [545.0, 455.0, 635.0, 590.0]
#: As the kernels have them (kernels/bsdf/bsdf.h).
LOBE_SPECULAR, LOBE_TRANSMISSION, LOBE_DISPERSES = 2, 4, 8


def load(description: Mapping[str, Any]) -> Any:
    """The lowered scene, as the probe takes it, of a description without its version."""
    return devices.load(accuray.Scene.from_dict({"accuray": 1, **description})).core


def unit(*components: float) -> FloatArray:
    v = np.array(components, dtype=np.float64)
    return np.asarray(v / np.linalg.norm(v))


def single(values: FloatArray) -> NDArray[np.float32]:
    """What the probe takes: contiguous single precision."""
    return np.ascontiguousarray(values, dtype=np.float32)


def rows(direction: FloatArray, count: int) -> NDArray[np.float32]:
    return single(np.broadcast_to(direction, (count, 3)))


@dataclass(frozen=True)
class Samples:
    """What `sample` returned for each row of numbers."""

    wi: FloatArray
    weight: FloatArray
    pdf: FloatArray
    eta_scale: FloatArray
    lobe: NDArray[np.uint32]

    @property
    def specular(self) -> NDArray[np.bool_]:
        return np.asarray(self.lobe & LOBE_SPECULAR != 0)

    @property
    def transmitted(self) -> NDArray[np.bool_]:
        return np.asarray(self.lobe & LOBE_TRANSMISSION != 0)

    @property
    def disperses(self) -> NDArray[np.bool_]:
        return np.asarray(self.lobe & LOBE_DISPERSES != 0)

    @property
    def succeeded(self) -> NDArray[np.bool_]:
        """Samples that have a direction: those of a black surface have one too, with weight 0."""
        return np.asarray((self.pdf > 0.0) | self.specular)


class Bsdf:
    """One material's BSDF at four wavelengths; directions are local, (N, 3)."""

    def __init__(self, core: Any, material: int, wavelengths: Sequence[float] = WAVELENGTHS) -> None:
        self._core, self._material, self._wavelengths = core, material, list(wavelengths)

    @property
    def transmits(self) -> bool:
        """Whether lamps on both sides of its surfaces are asked for their light."""
        from accuray._core import probe

        return bool(probe.transmits(self._core, self._material))

    def sample(self, wo: FloatArray, u: FloatArray, seed: int = 0) -> Samples:
        """Samples for `u` (N, 3): two numbers for the direction and one for the lobe. A stochastic type draws more, by
        `seed` and the row's own numbers.
        """
        from accuray._core import probe

        s = probe.bsdf_sample(self._core, self._material, self._wavelengths, single(wo), single(u), seed)
        values = (s[key].astype(np.float64) for key in ("wi", "weight", "pdf", "eta_scale"))
        return Samples(*values, s["lobe"])

    def sample_one(self, wo: FloatArray, u: FloatArray) -> Samples:
        return self.sample(rows(wo, len(u)), u)

    def eval(self, wo: FloatArray, wi: FloatArray, seed: int = 0) -> tuple[FloatArray, FloatArray]:
        """Values f |cos theta_i| (N, 4) and the density of wi (N,). Rows of a stochastic type are independent."""
        from accuray._core import probe

        value, pdf = probe.bsdf_eval(self._core, self._material, self._wavelengths, single(wo), single(wi), seed)
        return value.astype(np.float64), pdf.astype(np.float64)

    def eval_one(self, wo: FloatArray, wi: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self.eval(rows(wo, len(wi)), wi)


def bsdfs(materials: Sequence[Mapping[str, Any]], wavelengths: Sequence[float] = WAVELENGTHS) -> list[Bsdf]:
    """The BSDF of each material, all lowered in one scene. A material's `base` is written out in its place."""
    named: dict[str, dict[str, Any]] = {}
    for i, material in enumerate(materials):
        named[f"m{i:04}"] = dict(material)
        if "base" in material:
            named[f"b{i:04}"] = dict(material["base"])
            named[f"m{i:04}"]["base"] = f"b{i:04}"
    number = {name: i for i, name in enumerate(sorted(named))}  # bases come first, by their names and by their use
    core = load({"materials": named})
    return [Bsdf(core, number[f"m{i:04}"], wavelengths) for i in range(len(materials))]


def uniform(count: int, dimensions: int, seed: int) -> FloatArray:
    """Random numbers in [0, 1) that single precision holds exactly."""
    return np.random.default_rng(seed).random((count, dimensions), dtype=np.float32).astype(np.float64)
