"""Coverage: the canonical form is a function of the set of covered (sample, pixel) pairs."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from accuray.film import ImageError, MergeError, SampleRange
from accuray.film.coverage import coverages_equal, describe, normalise, pixel_mask, replicate_counts

SHAPE = (33, 20)  # height, width: 3 x 2 blocks, the last ones cut


def block_mask(*cells: int) -> np.ndarray:
    mask = np.zeros((3, 2), dtype=bool)
    mask.flat[list(cells)] = True
    return mask


def pairs(ranges: list[SampleRange]) -> set[tuple[int, int]]:
    """The covered (sample, flat pixel) pairs, counted one by one."""
    return {
        (i, int(p)) for r in ranges for i in range(r.first, r.end) for p in np.flatnonzero(pixel_mask(r.mask, SHAPE))
    }


@pytest.mark.parametrize("replicates", [1, 2, 4, 7])
def test_replicate_counts_are_those_of_enumeration(replicates: int) -> None:
    for first in range(12):
        for end in range(first, 25):
            counted = [sum(i % replicates == r for i in range(first, end)) for r in range(replicates)]
            assert replicate_counts(first, end, replicates) == counted


def test_replicate_counts_are_exact_beyond_32_bits() -> None:
    assert replicate_counts(3, 3 + 4 * 10**12, 4) == [10**12] * 4


def test_adjacent_ranges_join_in_any_order() -> None:
    ranges = [(16, 64, None), (64, 65, None), (0, 16, None)]
    assert normalise(ranges, SHAPE) == [SampleRange(0, 65, None)]


def test_gaps_stay() -> None:
    assert normalise([(8, 9, None), (0, 4, None)], SHAPE) == [SampleRange(0, 4), SampleRange(8, 9)]


def test_masks_that_complete_each_other_become_the_whole_window() -> None:
    ranges = [(0, 4, block_mask(0, 1, 2)), (0, 4, block_mask(3, 4, 5)), (4, 6, None)]
    assert normalise(ranges, SHAPE) == [SampleRange(0, 6, None)]


def test_pixel_masks_on_the_block_grid_become_block_masks() -> None:
    (only,) = normalise([(0, 1, pixel_mask(block_mask(1, 4), SHAPE))], SHAPE)
    assert only.mask is not None
    assert np.array_equal(only.mask, block_mask(1, 4))


def test_empty_entries_vanish() -> None:
    assert normalise([(5, 5, None), (0, 3, block_mask())], SHAPE) == []


entry = st.tuples(st.integers(0, 6), st.integers(0, 4), st.sets(st.integers(0, 5)))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(entry, max_size=6), st.randoms(use_true_random=False))
def test_canonical_form_is_the_set_and_nothing_else(entries: list[tuple[int, int, set[int]]], shuffle) -> None:  # type: ignore[no-untyped-def]
    disjoint: list[SampleRange] = []
    for first, length, cells in entries:
        new = SampleRange(first, first + length, block_mask(*cells))
        if not pairs([new]) & pairs(disjoint):
            disjoint.append(new)
    canonical = normalise(disjoint, SHAPE)
    assert pairs(canonical) == pairs(disjoint)
    singles = [SampleRange(i, i + 1, r.mask) for r in disjoint for i in range(r.first, r.end)]
    shuffle.shuffle(singles)
    assert coverages_equal(normalise(singles, SHAPE), canonical)


def test_overlap_names_samples_and_pixels() -> None:
    with pytest.raises(MergeError, match=r"samples counted twice: 8:16 of all pixels"):
        normalise([(0, 16, None), (8, 32, None)], SHAPE)
    with pytest.raises(MergeError, match=r"3:4 of 64 pixels in x 16:20, y 16:32 of the window"):
        normalise([(0, 4, block_mask(3, 4)), (3, 9, block_mask(3))], SHAPE)


@pytest.mark.parametrize(
    ("ranges", "message"),
    [
        ([(-1, 4, None)], "-1:4 is not of the form"),
        ([(4, 3, None)], "4:3 is not of the form"),
        ([(0, 1, np.ones((2, 2), dtype=bool))], r"mask has shape \(2, 2\)"),
    ],
)
def test_malformed_entries_are_refused(ranges: list[SampleRange], message: str) -> None:
    with pytest.raises(ImageError, match=message):
        normalise(ranges, SHAPE)


def test_describe_says_none() -> None:
    assert describe([], SHAPE) == "none"
