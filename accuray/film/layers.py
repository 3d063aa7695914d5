"""The named layers of an image, each computed from the film when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .colour import Matrix
from .estimates import pixel_estimates
from .film import Film


class Layers(Mapping[str, NDArray[Any]]):
    """A read-only mapping from layer name to read-only array (height, width[, 3]).

    rgb: float32, linear Rec.709, white balanced, premultiplied by alpha. alpha: float32. error: float32, standard
    error of rgb, infinite where unknown. xyz: float64, raw CIE XYZ. samples: uint64, samples per pixel. dropped:
    uint64, non-finite samples left out per pixel. Where the film holds it, indirect: float32, as rgb, the light that
    was scattered more than once on its way to the camera; error.indirect: its standard error.
    """

    _NAMES = ("rgb", "alpha", "error", "xyz", "samples", "dropped")

    def __init__(self, film: Film, matrix: Matrix) -> None:
        self._film = film
        self._matrix = matrix
        self._names = (*self._NAMES, *film.layers, *(f"error.{layer}" for layer in film.layers))
        self._computed: dict[str, NDArray[Any]] = {}

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._names:
            raise KeyError(f"{name!r}: allowed are {', '.join(self._names)}")
        if name not in self._computed:
            for key, layer in self._compute(name).items():
                layer.flags.writeable = False
                self._computed[key] = layer
        return self._computed[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def _compute(self, name: str) -> dict[str, NDArray[Any]]:
        """The layer, with those that come with it at no cost."""
        film = self._film
        if name in ("rgb", "error"):
            mean, error = pixel_estimates(film, self._matrix, np.float32)
            return {"rgb": mean, "error": error}
        layer = name.removeprefix("error.")
        if layer in film.layers:
            mean, error = pixel_estimates(film, self._matrix, np.float32, layer=layer)
            return {layer: mean, f"error.{layer}": error}
        if name == "xyz":
            return {"xyz": film.mean(slice(0, 3))}
        if name == "alpha":
            index = film.channels.index("A")
            return {"alpha": film.mean(slice(index, index + 1))[:, :, 0].astype(np.float32)}
        if name == "samples":
            return {"samples": film.samples()}
        return {"dropped": film.dropped.sum(axis=2, dtype=np.uint64)}
