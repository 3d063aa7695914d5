"""Which samples of which pixels a film holds.

A coverage is a list of `SampleRange`. Its canonical form (see `normalise`) is a function of the set of
(sample, pixel) pairs alone, so films that hold the same samples have equal coverages whatever the order in which
the samples were rendered or merged.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .errors import ImageError, MergeError

BLOCK = 16
"""Edge of a coverage block in pixels. Blocks are aligned to the origin of the film's window."""

Mask: TypeAlias = NDArray[np.bool_]


class SampleRange(NamedTuple):
    """Samples `first` to `end` (exclusive) of every pixel that `mask` selects.

    `mask` is None for the whole window, or a bool array: one value per 16x16 block (blocks_y, blocks_x), or one per
    pixel (height, width) where blocks cannot say it (crop windows merged off the block grid).
    """

    first: int
    end: int
    mask: Mask | None = None


def block_shape(shape: tuple[int, int]) -> tuple[int, int]:
    """Number of blocks (blocks_y, blocks_x) that a window of `shape` (height, width) pixels takes."""
    return -(-shape[0] // BLOCK), -(-shape[1] // BLOCK)


def pixel_mask(mask: Mask | None, shape: tuple[int, int]) -> Mask:
    """The mask with one value per pixel, shape (height, width)."""
    if mask is None:
        return np.ones(shape, dtype=np.bool_)
    if mask.shape == shape:
        return mask
    return np.repeat(np.repeat(mask, BLOCK, axis=0), BLOCK, axis=1)[: shape[0], : shape[1]]


def compact_mask(mask: Mask, shape: tuple[int, int]) -> Mask | None:
    """The shortest form of a mask: None when everything is selected, else per block, else per pixel."""
    if mask.all():
        return None
    if mask.shape != shape:
        return mask
    blocks = mask[::BLOCK, ::BLOCK]
    return blocks.copy() if np.array_equal(pixel_mask(blocks, shape), mask) else mask


def check_ranges(ranges: Iterable[tuple[int, int, Mask | None]], shape: tuple[int, int]) -> list[SampleRange]:
    """The entries as `SampleRange`s of Python ints, without empty ones.

    Raises:
        ImageError: first < 0, end < first, or a mask whose shape is neither per block nor per pixel.
    """
    checked = []
    for entry in ranges:
        first, end = int(entry[0]), int(entry[1])
        mask = entry[2] if len(entry) > 2 else None
        if first < 0 or end < first:
            raise ImageError(f"sample range {first}:{end} is not of the form A:B with 0 <= A <= B")
        if mask is not None:
            mask = np.asarray(mask, dtype=np.bool_)
            if mask.shape not in (shape, block_shape(shape)):
                raise ImageError(
                    f"coverage mask has shape {mask.shape}; a window of {shape[1]}x{shape[0]} pixels takes "
                    f"{block_shape(shape)} (blocks) or {shape} (pixels)"
                )
        if end > first and (mask is None or mask.any()):
            checked.append(SampleRange(first, end, mask))
    return checked


def normalise(ranges: Iterable[tuple[int, int, Mask | None]], shape: tuple[int, int]) -> list[SampleRange]:
    """The canonical form: ranges sorted, without common samples, joined where masks agree; masks as short as possible.

    Args:
        ranges: entries (first, end, mask) in any order.
        shape: (height, width) of the window in pixels.

    Raises:
        ImageError: an entry is malformed.
        MergeError: a sample of a pixel is covered twice; the message names the samples and the pixels.
    """
    checked = check_ranges(ranges, shape)
    per_pixel = any(r.mask is not None and r.mask.shape == shape for r in checked)
    grid = shape if per_pixel else block_shape(shape)
    edges = sorted({edge for r in checked for edge in (r.first, r.end)})
    joined: list[SampleRange] = []
    overlaps: list[SampleRange] = []
    for first, end in pairwise(edges):
        masks = [r.mask for r in checked if r.first <= first < r.end]
        union, overlap = _combine(masks, shape, grid)
        if overlap is not None:
            _append(overlaps, SampleRange(first, end, compact_mask(overlap, shape)))
        elif union is not None:
            _append(joined, SampleRange(first, end, compact_mask(union, shape)))
    if overlaps:
        raise MergeError("samples counted twice: " + describe(overlaps, shape))
    return joined


def _combine(
    masks: Sequence[Mask | None], shape: tuple[int, int], grid: tuple[int, int]
) -> tuple[Mask | None, Mask | None]:
    """Union of the masks on `grid` (None: nothing) and where two of them meet (None: nowhere)."""
    if not masks:
        return None, None
    union = np.zeros(grid, dtype=np.bool_)
    overlap = np.zeros(grid, dtype=np.bool_)
    for mask in masks:
        cells = np.ones(grid, dtype=np.bool_) if mask is None else mask
        if cells.shape != grid:
            cells = pixel_mask(cells, shape)
        overlap |= union & cells
        union |= cells
    return union, overlap if overlap.any() else None


def _append(ranges: list[SampleRange], new: SampleRange) -> None:
    """Appends `new`, or extends the last range when it ends where `new` begins and has the same mask."""
    last = ranges[-1] if ranges else None
    if last is not None and last.end == new.first and masks_equal(last.mask, new.mask):
        ranges[-1] = SampleRange(last.first, new.end, last.mask)
    else:
        ranges.append(new)


def masks_equal(a: Mask | None, b: Mask | None) -> bool:
    """Whether two masks in their shortest form select the same pixels."""
    if a is None or b is None:
        return a is b
    return np.array_equal(a, b)


def coverages_equal(a: Sequence[SampleRange], b: Sequence[SampleRange]) -> bool:
    """Whether two canonical coverages are the same."""
    return len(a) == len(b) and all(
        x.first == y.first and x.end == y.end and masks_equal(x.mask, y.mask) for x, y in zip(a, b, strict=True)
    )


def describe(ranges: Sequence[SampleRange], shape: tuple[int, int]) -> str:
    """The ranges in words, e.g. "0:16 of all pixels, 16:64 of 512 pixels in x 0:32, y 16:32 of the window"."""
    return ", ".join(f"{r.first}:{r.end} of {_describe_mask(r.mask, shape)}" for r in ranges) or "none"


def _describe_mask(mask: Mask | None, shape: tuple[int, int]) -> str:
    if mask is None:
        return "all pixels"
    pixels = pixel_mask(mask, shape)
    ys, xs = np.flatnonzero(pixels.any(axis=1)), np.flatnonzero(pixels.any(axis=0))
    box = f"x {xs[0]}:{xs[-1] + 1}, y {ys[0]}:{ys[-1] + 1} of the window"
    return f"{np.count_nonzero(pixels)} pixels in {box}"


def replicate_counts(first: int, end: int, replicates: int) -> list[int]:
    """How many of the samples first..end-1 belong to each replicate: those i with i mod replicates = r."""
    return [
        (end - r + replicates - 1) // replicates - (first - r + replicates - 1) // replicates for r in range(replicates)
    ]
