"""Measurements: how a case gets independent estimates of a number out of the public API.

A probe returns batches, an array (K, n) of K independent estimates of n numbers. `RayProbe` shoots rays: a ray, or a
group of rays spread evenly over a surface, is a batch, since every ray has its own scramble of the sampler.
`ImageProbe` renders one small image per batch.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

import accuray

FloatArray = NDArray[np.float64]
#: (random generator, batches, rays per batch) -> origins (N, 3) and unit directions (N, 3), N = their product
Rays = Callable[[np.random.Generator, int, int], tuple[FloatArray, FloatArray]]

GREEN = (550.0,)


class Probe(Protocol):
    """A source of independent batches."""

    @property
    def start(self) -> int:
        """Batches to begin with, at least 32."""

    @property
    def samples_per_batch(self) -> int:
        """Paths behind one batch."""

    def batches(self, count: int, seed: int) -> FloatArray:
        """`count` independent estimates (count, n)."""


@dataclass(frozen=True)
class RayProbe:
    """Radiance along rays, `group` of them to a batch, times `factor`.

    A group above 1 must be a square number: its rays are jittered over the domain of `rays`, one to a cell.
    `space` is "xyz" or "rgb" for colours; otherwise the spectral radiance at `wavelengths` (nm) is measured.
    """

    scene: dict[str, Any]
    rays: Rays
    factor: float = 1.0
    wavelengths: tuple[float, ...] = GREEN
    space: str | None = None
    spp: int = 2048
    start: int = 128
    group: int = 1

    @property
    def samples_per_batch(self) -> int:
        return self.spp * self.group

    def batches(self, count: int, seed: int) -> FloatArray:
        origins, directions = self.rays(np.random.default_rng(seed), count, self.group)
        scene = accuray.Scene.from_dict(self.scene)
        if self.space is None:
            result = accuray.radiance(scene, origins, directions, self.spp, seed=seed, wavelengths=self.wavelengths)
        else:
            result = accuray.radiance(scene, origins, directions, self.spp, seed=seed, space=self.space)
        values = np.asarray(result.mean, dtype=np.float64).reshape(count * self.group, -1)
        _check_independence(values, np.asarray(result.error, dtype=np.float64))
        return np.asarray(self.factor * values.reshape(count, self.group, -1).mean(axis=1))


@dataclass(frozen=True)
class ImageProbe:
    """Small images of one scene under different seeds, each reduced to a few numbers."""

    scene: dict[str, Any]
    reduce: Callable[[FloatArray], ArrayLike]
    spp: int = 64
    start: int = 32

    @property
    def samples_per_batch(self) -> int:
        film = self.scene["film"]
        return int(self.spp * film["width"] * film["height"])

    def batches(self, count: int, seed: int) -> FloatArray:
        scene = accuray.Scene.from_dict(self.scene)
        seeds = np.random.default_rng(seed).integers(0, 2**32, count)
        images = (np.asarray(accuray.render(scene, spp=self.spp, seed=int(s)), dtype=np.float64) for s in seeds)
        return np.stack([np.atleast_1d(np.asarray(self.reduce(image), dtype=np.float64)) for image in images])


def _check_independence(values: FloatArray, errors: FloatArray) -> None:
    """Refuse equal results of noisy rays: they share random numbers and their spread says nothing."""
    if len(values) > 1 and np.ptp(values, axis=0).max() == 0.0 and errors.max() > 1e-4 * np.abs(values).max() > 0.0:
        raise RuntimeError("all rays gave the same noisy result: accuray.radiance does not sample rays independently")


def _jittered(rng: np.random.Generator, batches: int, group: int) -> FloatArray:
    """Points (batches * group, 2) of the unit square, one in each cell of a square grid per batch."""
    side = math.isqrt(group)
    if side * side != group:
        raise ValueError(f"a group of {group} rays is no square number")
    cell = np.arange(batches * group) % group
    corner = np.stack([cell // side, cell % side], axis=1)
    return np.asarray((corner + rng.random((batches * group, 2))) / side)


def _on_sphere(u: FloatArray) -> FloatArray:
    """Uniform unit vectors from points of the unit square."""
    z, phi = 1.0 - 2.0 * u[:, 0], 2.0 * math.pi * u[:, 1]
    r = np.sqrt(np.maximum(0.0, 1.0 - z * z))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


def fixed(origin: ArrayLike, direction: ArrayLike) -> Rays:
    """The same ray again and again."""
    o, d = np.asarray(origin, dtype=np.float64), np.asarray(direction, dtype=np.float64)
    d = d / np.linalg.norm(d)
    return lambda rng, batches, group: (np.tile(o, (batches * group, 1)), np.tile(d, (batches * group, 1)))


def looking_at(point: ArrayLike, normal: ArrayLike, gap: float = 0.01) -> Rays:
    """A ray that meets a surface point from straight above, starting `gap` metres off."""
    p, n = np.asarray(point, dtype=np.float64), np.asarray(normal, dtype=np.float64)
    n = n / np.linalg.norm(n)
    return fixed(p + gap * n, -n)


def meeting_origin(theta: float, distance: float = 0.05, below: bool = False) -> Rays:
    """A ray towards the origin in the x-y plane, at the angle `theta` (radians) to +y, or to -y if `below`."""
    away = np.array([math.sin(theta), -math.cos(theta) if below else math.cos(theta), 0.0])
    return fixed(distance * away, -away)


def every_way(origin: ArrayLike, toward: ArrayLike | None = None) -> Rays:
    """Uniform directions from one point, in the half space of `toward` if given."""
    o = np.asarray(origin, dtype=np.float64)

    def rays(rng: np.random.Generator, batches: int, group: int) -> tuple[FloatArray, FloatArray]:
        d = _on_sphere(_jittered(rng, batches, group))
        if toward is not None:
            d *= np.where(d @ np.asarray(toward, dtype=np.float64) < 0.0, -1.0, 1.0)[:, None]
        return np.tile(o, (len(d), 1)), d

    return rays


def from_all_sides(radius: float) -> Rays:
    """Rays towards the origin from all over a sphere of `radius` about it."""
    about = every_way((0.0, 0.0, 0.0))

    def rays(rng: np.random.Generator, batches: int, group: int) -> tuple[FloatArray, FloatArray]:
        origins, outward = about(rng, batches, group)
        return origins + radius * outward, -outward

    return rays


def cosine_about(origin: ArrayLike, axis: ArrayLike) -> Rays:
    """Directions about `axis` (a unit vector), weighted by their cosine with it, all from `origin`."""
    o, n = np.asarray(origin, dtype=np.float64), np.asarray(axis, dtype=np.float64)

    def rays(rng: np.random.Generator, batches: int, group: int) -> tuple[FloatArray, FloatArray]:
        d = _on_sphere(_jittered(rng, batches, group)) + n
        return np.tile(o, (len(d), 1)), d / np.linalg.norm(d, axis=1, keepdims=True)

    return rays


def parallel_beam(direction: ArrayLike, radius: float, distance: float = 4.0) -> Rays:
    """Parallel rays, uniform over the disk of `radius` about the origin, starting `distance` before it."""
    d = np.asarray(direction, dtype=np.float64)
    d = d / np.linalg.norm(d)
    u = np.cross(np.eye(3)[int(np.argmin(np.abs(d)))], d)
    u /= np.linalg.norm(u)
    v = np.cross(d, u)

    def rays(rng: np.random.Generator, batches: int, group: int) -> tuple[FloatArray, FloatArray]:
        s = _jittered(rng, batches, group)
        r, phi = radius * np.sqrt(s[:, 0]), 2.0 * math.pi * s[:, 1]
        offset = (r * np.cos(phi))[:, None] * u + (r * np.sin(phi))[:, None] * v
        return offset - distance * d, np.tile(d, (len(s), 1))

    return rays


def across_parallelogram(corner: ArrayLike, edge_u: ArrayLike, edge_v: ArrayLike, direction: ArrayLike) -> Rays:
    """Parallel rays from origins uniform over a parallelogram."""
    c, u, v, d = (np.asarray(x, dtype=np.float64) for x in (corner, edge_u, edge_v, direction))
    d = d / np.linalg.norm(d)

    def rays(rng: np.random.Generator, batches: int, group: int) -> tuple[FloatArray, FloatArray]:
        s = _jittered(rng, batches, group)
        return c + s[:, :1] * u + s[:, 1:] * v, np.tile(d, (len(s), 1))

    return rays
