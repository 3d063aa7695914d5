"""The film: exact integer sums of samples, with the record of which samples they contain.

A sample value is rounded once, without bias, to a multiple of a power-of-two step and added to a 64-bit integer, so
the order of the additions cannot change a bit. Sample i of a pixel belongs to replicate i mod R; the replicates are
independently scrambled, and their scatter gives the standard error.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .coverage import Mask, SampleRange, coverages_equal, normalise, pixel_mask, replicate_counts
from .errors import ImageError

DEFAULT_STEP = 2.0**-24
XYZA = ("X", "Y", "Z", "A")
LAYERS = ("indirect",)
"""What a film may hold besides its colours, each as three channels X, Y, Z under its name."""


@dataclass(eq=False)
class Film:
    """Exact per-pixel, per-replicate sums of a window of an image.

    Attributes:
        sums: int64 (height, width, replicates, channels), C-contiguous, in units of `step`; the mean of a channel is
            sums * step / count.
        dropped: uint32 (height, width, replicates); non-finite samples that were left out of sums and counts.
        step: the fixed-point unit, a power of two.
        coverage: the samples held, as `SampleRange` (first, end, mask), in canonical form after construction.
        window: (x0, y0, x1, y1), half open, the pixels held, inside the full image.
        width, height: size of the full image in pixels.
        channels: names of the last axis of `sums`.

    Raises:
        ImageError: a shape, dtype, window, step or coverage that does not fit the others.
    """

    sums: NDArray[np.int64]
    dropped: NDArray[np.uint32]
    step: float
    coverage: list[SampleRange]
    window: tuple[int, int, int, int]
    width: int
    height: int
    channels: tuple[str, ...] = field(default=XYZA)

    def __post_init__(self) -> None:
        self.window = (int(self.window[0]), int(self.window[1]), int(self.window[2]), int(self.window[3]))
        self.channels = tuple(self.channels)
        self._check_window()
        self._check_arrays()
        if not (math.isfinite(self.step) and self.step > 0 and math.frexp(self.step)[0] == 0.5):
            raise ImageError(f"film step {self.step!r} is not a positive power of two")
        self.coverage = normalise(self.coverage, self.shape)

    def _check_window(self) -> None:
        x0, y0, x1, y1 = self.window
        if not (0 <= x0 < x1 <= self.width and 0 <= y0 < y1 <= self.height):
            raise ImageError(
                f"film window x {x0}:{x1}, y {y0}:{y1} is empty or leaves the image of {self.width}x{self.height}"
            )

    def _check_arrays(self) -> None:
        h, w = self.shape
        if self.sums.dtype != np.int64 or self.sums.ndim != 4 or not self.sums.flags.c_contiguous:
            raise ImageError("film sums must be a C-contiguous int64 array (height, width, replicates, channels)")
        if self.sums.shape[:2] != (h, w) or self.sums.shape[3] != len(self.channels) or self.sums.shape[2] < 1:
            wanted = f"({h}, {w}, R, {len(self.channels)})"
            raise ImageError(f"film sums have shape {self.sums.shape}; the window and channels ask for {wanted}")
        if self.dropped.dtype != np.uint32 or self.dropped.shape != self.sums.shape[:3]:
            raise ImageError(f"film dropped counts must be uint32 of shape {self.sums.shape[:3]}")

    @classmethod
    def empty(
        cls,
        width: int,
        height: int,
        *,
        window: tuple[int, int, int, int] | None = None,
        replicates: int = 4,
        step: float = DEFAULT_STEP,
        channels: tuple[str, ...] = XYZA,
    ) -> Film:
        """A film of zeros that holds no sample; `window` defaults to the full image."""
        x0, y0, x1, y1 = window or (0, 0, width, height)
        shape = (y1 - y0, x1 - x0, replicates)
        sums = np.zeros((*shape, len(channels)), dtype=np.int64)
        return cls(sums, np.zeros(shape, dtype=np.uint32), step, [], (x0, y0, x1, y1), width, height, channels)

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) of the window in pixels."""
        x0, y0, x1, y1 = self.window
        return y1 - y0, x1 - x0

    @property
    def replicates(self) -> int:
        """The number R of replicates."""
        return int(self.sums.shape[2])

    @property
    def layers(self) -> tuple[str, ...]:
        """The further layers that the film holds, of `LAYERS`."""
        return tuple(layer for layer in LAYERS if f"{layer}.X" in self.channels)

    def layer_start(self, layer: str) -> int:
        """Index of the channel X of a further layer, or of the colours, whose name is ""."""
        return self.channels.index(f"{layer}.X" if layer else "X")

    def cover(self, first: int, end: int, mask: Mask | None = None) -> None:
        """Records that samples first..end-1 of the masked pixels were added.

        Raises:
            MergeError: one of them is covered already.
        """
        self.coverage = normalise([*self.coverage, SampleRange(first, end, mask)], self.shape)

    def counts(self) -> NDArray[np.uint64]:
        """Samples in the sums per pixel and replicate, uint64 (height, width, R), read-only.

        Raises:
            ImageError: more samples were dropped than the coverage holds.
        """
        h, w = self.shape
        whole = np.zeros(self.replicates, dtype=np.uint64)
        for r in self.coverage:
            if r.mask is None:
                whole += np.array(replicate_counts(r.first, r.end, self.replicates), dtype=np.uint64)
        counts = np.broadcast_to(whole, (h, w, self.replicates))
        masked = [r for r in self.coverage if r.mask is not None]
        if masked or self.dropped.any():
            counts = counts.copy()
            for r in masked:
                held = np.array(replicate_counts(r.first, r.end, self.replicates), dtype=np.uint64)
                counts[pixel_mask(r.mask, (h, w))] += held
            if (self.dropped > counts).any():
                raise ImageError("film drops more samples than it covers")
            counts -= self.dropped
        counts.flags.writeable = False
        return counts

    def samples(self) -> NDArray[np.uint64]:
        """Samples in the sums per pixel, uint64 (height, width)."""
        total: NDArray[np.uint64] = self.counts().sum(axis=2, dtype=np.uint64)
        return total

    def mean(self, channels: slice = slice(None)) -> NDArray[np.float64]:
        """Mean of the channels, float64 (height, width, channels); 0 where a pixel holds no sample.

        Replicates are added in their order, so the bits depend on the film alone.
        """
        mean = np.empty((*self.shape, len(self.channels[channels])), dtype=np.float64)
        samples = self.samples()
        for rows in row_blocks(self.shape):
            mean[rows] = np.moveaxis(
                pooled_mean(planes(self.sums[rows, :, :, channels]), samples[rows], self.step), 0, 2
            )
        return mean

    @property
    def dropped_total(self) -> int:
        """Number of non-finite samples left out, over all pixels."""
        return int(self.dropped.sum(dtype=np.uint64))

    def identical(self, other: Film) -> bool:
        """Whether both hold the same samples with the same sums, exactly."""
        return (
            (self.step, self.window, self.width, self.height, self.channels)
            == (other.step, other.window, other.width, other.height, other.channels)
            and coverages_equal(self.coverage, other.coverage)
            and np.array_equal(self.sums, other.sums)
            and np.array_equal(self.dropped, other.dropped)
        )


def channels_with(layers: Iterable[str]) -> tuple[str, ...]:
    """Channels of a film that holds these layers besides its colours.

    Raises:
        ImageError: a name that is none of `LAYERS`.
    """
    wanted = set(layers)
    if unknown := sorted(wanted.difference(LAYERS)):
        raise ImageError(f"layer {unknown[0]!r} is unknown: allowed are {', '.join(LAYERS)}")
    return (*XYZA, *(f"{layer}.{axis}" for layer in LAYERS if layer in wanted for axis in "XYZ"))


def planes(sums: NDArray[np.int64]) -> NDArray[np.float64]:
    """The (h, w, R, C) sums as double planes (R, C, h, w)."""
    return np.ascontiguousarray(sums.transpose(2, 3, 0, 1), dtype=np.float64)


def pooled_mean(sums: NDArray[np.float64], samples: NDArray[np.uint64], step: float) -> NDArray[np.float64]:
    """Mean over all replicates: planes (R, C, h, w) and counts (h, w) to (C, h, w); 0 without samples."""
    mean: NDArray[np.float64] = sums[0].copy()
    for replicate in sums[1:]:
        mean += replicate
    mean *= step
    mean /= np.maximum(samples, 1).astype(np.float64)
    return mean


def row_blocks(shape: tuple[int, int], pixels: int = 8192) -> Iterator[slice]:
    """Slices of whole rows of about `pixels` pixels each: temporaries stay in the cache and their size is bounded."""
    height, width = shape
    rows = max(1, pixels // width)
    return (slice(y, min(y + rows, height)) for y in range(0, height, rows))
