"""Radiance along single rays: light meters, tests, lighting calculations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from accuray import devices
from accuray.film import Film
from accuray.film.colour import XYZ_TO_RGB
from accuray.render.session import POLL_SECONDS, thread_count
from accuray.scene import Scene

SPACES = ("rgb", "xyz")
WAVELENGTHS_AT_ONCE = 4


@dataclass(frozen=True, eq=False)
class Radiance:
    """What ``radiance`` measures.

    Attributes:
        mean: float64 (N, 3) in the colour space, or (N, n) for n wavelengths; nan where no sample was finite.
        error: standard error of ``mean``, the same shape, from the scene's replicates (R - 1 degrees of freedom
            each); infinite where fewer than two of them have a sample.
        count: samples per ray.
    """

    mean: NDArray[np.float64]
    error: NDArray[np.float64]
    count: int


def radiance(
    scene: Scene,
    origins: ArrayLike,
    directions: ArrayLike,
    spp: int,
    *,
    seed: int = 0,
    threads: int | None = None,
    space: str = "rgb",
    wavelengths: Sequence[float] | None = None,
) -> Radiance:
    """Radiance that arrives at ``origins`` from ``directions``.

    Args:
        scene: the scene; its camera, filter and film size do not matter.
        origins: (N, 3) metres.
        directions: (N, 3), from the observer to what is looked at; any length but zero.
        spp: samples per ray, at least 1.
        seed: rays and seeds give independent estimates.
        threads: default: all processors that this process may use.
        space: "rgb": linear Rec.709; "xyz": CIE 1931 with Y = 1 for a spectral radiance of 1 W m^-2 sr^-1 nm^-1 at
            all wavelengths. Neither is white-balanced.
        wavelengths: nm; gives spectral radiance in W m^-2 sr^-1 nm^-1 at these in place of colours.

    Raises:
        ValueError: a wrong shape, a value that is not finite, a zero direction, or another argument out of range.
        SceneError: what only lowering can find wrong with the scene.
    """
    starts, towards = _rays(origins, directions)
    if spp < 1:
        raise ValueError(f"spp is {spp}: it must be at least 1")
    if space not in SPACES:
        raise ValueError(f"space is {space!r}: allowed are {', '.join(SPACES)}")
    threads = thread_count(threads)
    if wavelengths is None:
        means = _trace(scene, starts, towards, spp, seed, threads, [])[:, :, :3]
        if space == "rgb":
            means = means @ np.array(XYZ_TO_RGB).T
    else:
        means = _spectral(scene, starts, towards, spp, seed, threads, _checked(wavelengths))
    return _pooled(means, spp)


def _rays(origins: ArrayLike, directions: ArrayLike) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    starts = np.ascontiguousarray(np.atleast_2d(np.asarray(origins, dtype=np.float64)))
    towards = np.ascontiguousarray(np.atleast_2d(np.asarray(directions, dtype=np.float64)))
    for name, array in (("origins", starts), ("directions", towards)):
        if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0:
            raise ValueError(f"{name} have the shape {array.shape}: it must be (N, 3) with N at least 1")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} hold values that are not finite")
    if len(starts) != len(towards):
        raise ValueError(f"there are {len(starts)} origins but {len(towards)} directions")
    lengths = np.sqrt((towards * towards).sum(axis=1, keepdims=True))
    if not (lengths > 0).all():
        raise ValueError(f"direction {int(np.argmin(lengths))} is zero")
    return starts.astype(np.float32), (towards / lengths).astype(np.float32)


def _checked(wavelengths: Sequence[float]) -> list[float]:
    values = [float(w) for w in wavelengths]
    for value in values:
        if not 360.0 <= value <= 830.0:
            raise ValueError(f"wavelength {value} nm is out of range: allowed are 360 to 830")
    if not values:
        raise ValueError("wavelengths are empty: give at least one, or None for colours")
    return values


def _spectral(
    scene: Scene,
    starts: NDArray[np.float32],
    towards: NDArray[np.float32],
    spp: int,
    seed: int,
    threads: int,
    wavelengths: list[float],
) -> NDArray[np.float64]:
    """Replicate means (N, R, n), four wavelengths at a time."""
    parts = []
    for begin in range(0, len(wavelengths), WAVELENGTHS_AT_ONCE):
        group = wavelengths[begin : begin + WAVELENGTHS_AT_ONCE]
        parts.append(_trace(scene, starts, towards, spp, seed, threads, group)[:, :, : len(group)])
    return np.concatenate(parts, axis=2)


def _trace(
    scene: Scene,
    starts: NDArray[np.float32],
    towards: NDArray[np.float32],
    spp: int,
    seed: int,
    threads: int,
    wavelengths: list[float],
) -> NDArray[np.float64]:
    """Means of the four channels by ray and replicate, (N, R, 4); nan for a replicate without samples."""
    film = Film.empty(len(starts), 1, replicates=scene.render["replicates"], step=scene.film["unit"])
    core = devices.load(scene).ray_pass(film, starts, towards, spp, seed=seed, threads=threads, wavelengths=wavelengths)
    try:
        while not core.wait(POLL_SECONDS):
            pass
    except BaseException:
        core.stop()
        raise
    film.cover(0, spp)
    counts = film.counts()[0].astype(np.float64)[:, :, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        means: NDArray[np.float64] = film.sums[0] * film.step / counts
    return means


def _pooled(means: NDArray[np.float64], spp: int) -> Radiance:
    """Mean over the replicates that have samples, and its standard error from their spread.

    A ray's replicate may be without any because its samples were not finite and were dropped.
    """
    held = ~np.isnan(means)
    count = held.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.where(held, means, 0.0).sum(axis=1) / count
        squares = np.where(held, means - mean[:, None, :], 0.0) ** 2
        error = np.sqrt(squares.sum(axis=1) / (count - 1)) / np.sqrt(count)
    return Radiance(mean, np.where(count < 2, np.inf, error), spp)
