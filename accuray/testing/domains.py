"""Where the samples of a test live, and how they are laid on a rectangular grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Bounds = tuple[tuple[float, float], tuple[float, float]]


class Domain(Protocol):
    """A set that is mapped to a rectangle so that equal areas of the rectangle are equal measures of the set."""

    @property
    def bounds(self) -> Bounds:
        """Limits of the rectangle on its two axes."""

    def to_plane(self, samples: FloatArray) -> FloatArray:
        """Samples (N, d) to points (N, 2); outside the domain: outside `bounds`."""

    def from_plane(self, points: FloatArray) -> FloatArray:
        """Points (N, 2) of the rectangle to samples (N, d)."""


@dataclass(frozen=True)
class Sphere:
    """Unit directions on the grid (cos theta, phi) about `axis`; the measure is solid angle.

    `cos_min` above -1 restricts the grid to a cone about the axis, for lobes and lights too narrow for a grid over
    the whole sphere; directions outside it are still counted, as one more cell.
    """

    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    cos_min: float = -1.0

    @property
    def bounds(self) -> Bounds:
        return (self.cos_min, 1.0), (0.0, 2.0 * math.pi)

    def _frame(self) -> FloatArray:
        """Rows: two tangents and the axis."""
        axis = np.asarray(self.axis, dtype=np.float64)
        axis = axis / np.linalg.norm(axis)
        if axis[2] > 0.999999999999:
            return np.eye(3)
        helper = np.eye(3)[np.argmin(np.abs(axis))]
        tangent = np.cross(helper, axis)
        tangent /= np.linalg.norm(tangent)
        return np.stack([tangent, np.cross(axis, tangent), axis])

    def to_plane(self, samples: FloatArray) -> FloatArray:
        x, y, z = (samples @ self._frame().T).T
        return np.stack([np.clip(z, -1.0, 1.0), np.arctan2(y, x) % (2.0 * math.pi)], axis=1)

    def from_plane(self, points: FloatArray) -> FloatArray:
        cos_theta, phi = points.T
        sin_theta = np.sqrt(np.maximum(0.0, 1.0 - cos_theta * cos_theta))
        local = np.stack([sin_theta * np.cos(phi), sin_theta * np.sin(phi), cos_theta], axis=1)
        return local @ self._frame()


@dataclass(frozen=True)
class Plane:
    """Points of a rectangle of the plane, measure area: pixel filters, texture and wavelength samplers.

    For samples of one number use `Plane((low, high))`: they are (N, 1) arrays and the second axis is idle.
    """

    x: tuple[float, float]
    y: tuple[float, float] | None = None

    @property
    def bounds(self) -> Bounds:
        return self.x, self.y or (0.0, 1.0)

    def to_plane(self, samples: FloatArray) -> FloatArray:
        if self.y is not None:
            return samples
        return np.stack([samples[:, 0], np.full(len(samples), 0.5)], axis=1)

    def from_plane(self, points: FloatArray) -> FloatArray:
        return points if self.y is not None else points[:, :1]
