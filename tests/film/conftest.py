"""Synthetic films: samples that are a pure function of (seed, pixel, index), as the renderer's are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from accuray.film import Film, Image

FilmMaker = Callable[..., Film]
STEP = 2.0**-24


def _hash(x: np.ndarray) -> np.ndarray:
    """SplitMix64's finaliser (Steele, Lea and Flood 2014) on uint64."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


def synthetic_film(
    first: int,
    end: int,
    *,
    size: tuple[int, int] = (37, 21),
    window: tuple[int, int, int, int] | None = None,
    mask: np.ndarray | None = None,
    replicates: int = 4,
    seed: int = 1,
    dropped: bool = False,
) -> Film:
    """Samples first..end-1 of the window's masked pixels; X, Y, Z in 0..2 and alpha 1. `mask` is per 16x16 block."""
    film = Film.empty(*size, window=window, replicates=replicates, step=STEP)
    x0, y0, x1, y1 = film.window
    ys, xs = np.mgrid[y0:y1, x0:x1].astype(np.uint64)
    pixels = np.ones(film.shape, dtype=bool)
    if mask is not None:
        pixels = np.kron(mask, np.ones((16, 16), dtype=bool))[: film.shape[0], : film.shape[1]].astype(bool)
    for i in range(first, end):
        key = ((ys << np.uint64(20)) + xs << np.uint64(20)) + np.uint64(i * 4 + (seed << 50))
        lost = pixels & (_hash(key + np.uint64(3)) % np.uint64(17) == 0) if dropped else np.zeros_like(pixels)
        for c in range(3):
            value = (_hash(key + np.uint64(c)) >> np.uint64(39)).astype(np.int64)
            film.sums[:, :, i % replicates, c] += np.where(pixels & ~lost, value, 0)
        film.sums[:, :, i % replicates, 3] += np.where(pixels & ~lost, int(1 / STEP), 0)
        film.dropped[:, :, i % replicates] += lost
    film.cover(first, end, mask)
    return film


@pytest.fixture
def splitmix() -> Callable[[np.ndarray], np.ndarray]:
    """A hash of uint64 arrays, as good as random."""
    return _hash


@pytest.fixture
def make_film() -> FilmMaker:
    return synthetic_film


@pytest.fixture
def image() -> Image:
    """A small image with every kind of metadata."""
    return Image(
        synthetic_film(0, 10, dropped=True),
        {
            "scene_hash": "ab" * 32,
            "seed": 2**63 + 5,
            "version": "0.1.0",
            "command": 'accuray render "scène.toml" -D x=1',
            "exposure": 0.75,
            "white_balance": (1.1, 1.0, 0.35),
            "render_seconds": 0.1,
            "nested": {"list": [1, 2.5, None, True], "numpy": np.float64(0.3)},
        },
    )
