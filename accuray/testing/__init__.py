"""Statistical tests for samplers, scattering models and images, for this renderer's types and for yours.

Needs NumPy only. `chi2_test` compares a sampler with its density; `z_test`, `image_z_test` and `blocks` compare
estimates with error bars; `energy_test`, `albedo_test`, `reciprocity_error` and `white_furnace` check what no
scattering model may break; `parameter_sets` makes inputs for them from the tables of `accuray schema`.
"""

from accuray.testing.chi2 import Chi2Result, chi2_test
from accuray.testing.domains import Domain, Plane, Sphere
from accuray.testing.furnace import (
    Estimate,
    FurnaceResult,
    albedo,
    albedo_test,
    energy_test,
    eval_albedo,
    random_directions,
    reciprocity_error,
    white_furnace,
)
from accuray.testing.lists import alternatives, parameter_sets, types_of
from accuray.testing.stats import sidak
from accuray.testing.ztest import ZResult, blocks, image_z_test, z_test

__all__ = [
    "Chi2Result",
    "Domain",
    "Estimate",
    "FurnaceResult",
    "Plane",
    "Sphere",
    "ZResult",
    "albedo",
    "albedo_test",
    "alternatives",
    "blocks",
    "chi2_test",
    "energy_test",
    "eval_albedo",
    "image_z_test",
    "parameter_sets",
    "random_directions",
    "reciprocity_error",
    "sidak",
    "types_of",
    "white_furnace",
    "z_test",
]
