"""Exact addition of films that hold different samples of the same image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .coverage import Mask, SampleRange, normalise, pixel_mask
from .errors import FilmOverflowError, MergeError
from .film import Film, row_blocks

Window = tuple[int, int, int, int]


def merge(a: Film, b: Film) -> Film:
    """The film that holds the samples of both, over the smallest window that contains both windows.

    Addition is of integers, hence exact, commutative and associative: merging 0:16 and 16:64 gives the bits of 0:64.
    That both show the same scene with the same seed is for the caller to check (`Image.merge` does).

    Raises:
        MergeError: size, replicates, step or channels differ, or a sample of a pixel is in both.
        FilmOverflowError: a sum leaves 64 bits.
    """
    _check_same_kind(a, b)
    window = _union(a.window, b.window)
    shape = (window[3] - window[1], window[2] - window[0])
    ranges = [_placed(r, film, window) for film in (a, b) for r in film.coverage]
    try:
        coverage = normalise(ranges, shape)
    except MergeError as error:
        raise MergeError(f"both films hold the same samples: {error.reason}") from None
    merged = Film.empty(a.width, a.height, window=window, replicates=a.replicates, step=a.step, channels=a.channels)
    merged.coverage = coverage
    for film in (a, b):
        _add(merged, film)
    return merged


def _check_same_kind(a: Film, b: Film) -> None:
    for what, of_a, of_b in (
        ("image sizes", (a.width, a.height), (b.width, b.height)),
        ("numbers of replicates", a.replicates, b.replicates),
        ("steps (film.unit)", a.step, b.step),
        ("channels", a.channels, b.channels),
    ):
        if of_a != of_b:
            raise MergeError(f"films have different {what}: {of_a} and {of_b}")


def _union(a: Window, b: Window) -> Window:
    return min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])


def _slices(film: Film, window: Window) -> tuple[slice, slice]:
    """Where the film's window lies in `window`, as (rows, columns)."""
    x0, y0, x1, y1 = film.window
    return slice(y0 - window[1], y1 - window[1]), slice(x0 - window[0], x1 - window[0])


def _placed(r: SampleRange, film: Film, window: Window) -> SampleRange:
    """The range of the film, said of the pixels of `window`."""
    if film.window == window:
        return r
    mask: Mask = np.zeros((window[3] - window[1], window[2] - window[0]), dtype=np.bool_)
    mask[_slices(film, window)] = pixel_mask(r.mask, film.shape)
    return SampleRange(r.first, r.end, mask)


def _add(target: Film, film: Film) -> None:
    """Adds the film's sums and dropped counts into `target`, whose window contains it."""
    rows, columns = _slices(film, target.window)
    for block in row_blocks(film.shape):
        inside = slice(rows.start + block.start, rows.start + block.stop)
        origin = (film.window[0], film.window[1] + block.start)
        sums = target.sums[inside, columns]
        sums[...] = _checked_sum(sums, film.sums[block], target.channels, origin)
        dropped = target.dropped[inside, columns].astype(np.uint64) + film.dropped[block]
        if (dropped > np.iinfo(np.uint32).max).any():
            raise FilmOverflowError("the count of dropped samples of a pixel exceeds 32 bits")
        target.dropped[inside, columns] = dropped


def _checked_sum(
    a: NDArray[np.int64], b: NDArray[np.int64], channels: tuple[str, ...], origin: tuple[int, int]
) -> NDArray[np.int64]:
    """A + b; `origin` (x, y) of the first pixel names the pixel that overflows."""
    total = a + b
    # Two's complement: the sum left the range exactly when both terms differ from it in sign.
    wrapped = ((a ^ total) & (b ^ total)) < 0
    if wrapped.any():
        y, x, replicate, channel = (int(i) for i in np.argwhere(wrapped)[0])
        raise FilmOverflowError(
            f"the sum of pixel ({origin[0] + x}, {origin[1] + y}), replicate {replicate}, channel {channels[channel]} "
            "exceeds 64 bits: render with a larger film.unit"
        )
    return total
