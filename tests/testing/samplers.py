"""Samplers with known densities, right and planted wrong, for the tests of the test kit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def spherical(cos_theta: FloatArray, phi: FloatArray) -> FloatArray:
    """Unit vectors (N, 3) from polar coordinates."""
    sin_theta = np.sqrt(np.maximum(0.0, 1.0 - cos_theta**2))
    return np.stack([sin_theta * np.cos(phi), sin_theta * np.sin(phi), cos_theta], axis=1)


def cosine_sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cosine-weighted hemisphere about +z."""
    return spherical(np.sqrt(u[:, 0]), 2.0 * np.pi * u[:, 1]), np.ones(len(u))


def cosine_pdf(w: FloatArray) -> FloatArray:
    return np.maximum(w[:, 2], 0.0) / np.pi


def uniform_sampler(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Uniform over the whole sphere."""
    return spherical(1.0 - 2.0 * u[:, 0], 2.0 * np.pi * u[:, 1]), np.ones(len(u))


def uniform_pdf(w: FloatArray) -> FloatArray:
    return np.full(len(w), 0.25 / np.pi)


def cone_sampler(axis: FloatArray, cos_max: float, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Uniform over the cone about `axis` (unit) of half angle arccos(cos_max): a spherical light."""
    local = spherical(1.0 - u[:, 0] * (1.0 - cos_max), 2.0 * np.pi * u[:, 1])
    helper = np.array([1.0, 0.0, 0.0]) if abs(axis[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    tangent = np.cross(helper, axis)
    tangent /= np.linalg.norm(tangent)
    return local @ np.stack([tangent, np.cross(axis, tangent), axis]), np.ones(len(u))


def cone_pdf(axis: FloatArray, cos_max: float, w: FloatArray) -> FloatArray:
    return np.where(w @ axis >= cos_max, 1.0 / (2.0 * np.pi * (1.0 - cos_max)), 0.0)


def ggx_reflection_sampler(wo: FloatArray, alpha: float, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Reflection of `wo` in GGX normals (Walter et al. 2007); weight 0 below the horizon."""
    cos_theta = np.sqrt((1.0 - u[:, 0]) / (1.0 + (alpha**2 - 1.0) * u[:, 0]))
    h = spherical(cos_theta, 2.0 * np.pi * u[:, 1])
    wi = 2.0 * (h @ wo)[:, None] * h - wo
    return wi, ((wi[:, 2] > 0) & (h @ wo > 0)).astype(np.float64)


def ggx_reflection_pdf(wo: FloatArray, alpha: float, w: FloatArray) -> FloatArray:
    h = w + wo
    h /= np.maximum(np.linalg.norm(h, axis=1, keepdims=True), 1e-300)
    cos_h = np.maximum(h[:, 2], 0.0)
    d = alpha**2 / (np.pi * (1.0 + cos_h**2 * (alpha**2 - 1.0)) ** 2)
    jacobian = 4.0 * np.maximum(np.abs(h @ wo), 1e-300)
    return np.where((w[:, 2] > 0) & (h @ wo > 0), d * cos_h / jacobian, 0.0)
