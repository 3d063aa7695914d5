"""Merging is integer addition: exact, in any order, over any windows; other films are refused with reasons."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from accuray.film import Film, FilmOverflowError, Image, MergeError, SampleRange, merge

FilmMaker = Callable[..., Film]


def test_parts_merge_to_the_whole_bit_for_bit(make_film: FilmMaker) -> None:
    whole = make_film(0, 64, dropped=True)
    parts = merge(make_film(16, 64, dropped=True), make_film(0, 16, dropped=True))
    assert parts.identical(whole)
    assert parts.coverage == [SampleRange(0, 64, None)]
    assert Image(parts).pixels_equal(Image(whole))


def test_order_and_grouping_do_not_matter(make_film: FilmMaker) -> None:
    a, b, c = (make_film(i, i + 3) for i in (0, 3, 9))
    assert merge(merge(a, b), c).identical(merge(a, merge(c, b)))


@pytest.mark.parametrize("cut", [1, 16, 19])
def test_crops_merge_to_the_whole(make_film: FilmMaker, cut: int) -> None:
    left = make_film(0, 5, window=(0, 0, cut, 21), dropped=True)
    right = make_film(0, 5, window=(cut, 0, 37, 21), dropped=True)
    assert merge(right, left).identical(make_film(0, 5, dropped=True))


def test_crops_apart_leave_the_rest_without_samples(make_film: FilmMaker) -> None:
    a, b = make_film(0, 5, window=(3, 2, 9, 7)), make_film(0, 9, window=(20, 5, 30, 20))
    merged = merge(a, b)
    assert merged.window == (3, 2, 30, 20)
    samples = merged.samples()
    assert samples[:5, :6].min() == samples[:5, :6].max() == 5
    assert samples[3:, 17:].min() == samples[3:, 17:].max() == 9
    assert samples.sum() == a.samples().sum() + b.samples().sum()
    assert np.array_equal(merged.sums[3:, 17:], b.sums)
    assert np.isinf(Image(merged).error[0, 10]).all()


def test_overlapping_crops_add_where_samples_differ(make_film: FilmMaker) -> None:
    a, b = make_film(0, 8, window=(0, 0, 20, 21)), make_film(8, 16, window=(10, 0, 37, 21))
    samples = merge(a, b).samples()
    assert samples[0, [0, 9, 10, 19, 20, 36]].tolist() == [8, 8, 16, 16, 8, 8]


def test_shared_samples_are_refused_by_name(make_film: FilmMaker) -> None:
    with pytest.raises(MergeError, match=r"both films hold the same samples: .*8:16 of all pixels"):
        merge(make_film(0, 16), make_film(8, 24))
    with pytest.raises(MergeError, match=r"0:2 of 105 pixels in x 10:15, y 0:21"):
        merge(make_film(0, 4, window=(0, 0, 15, 21)), make_film(0, 2, window=(10, 0, 37, 21)))


def test_inputs_are_left_alone(make_film: FilmMaker) -> None:
    a, b = make_film(0, 4), make_film(4, 8)
    merge(a, b)
    assert a.identical(make_film(0, 4))
    assert b.identical(make_film(4, 8))


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (Film.empty(38, 21), "image sizes"),
        (Film.empty(37, 21, replicates=8), "numbers of replicates: 4 and 8"),
        (Film.empty(37, 21, step=2.0**-20), "steps"),
        (Film.empty(37, 21, channels=("X", "Y", "Z")), "channels"),
    ],
)
def test_other_kinds_of_film_are_refused(make_film: FilmMaker, other: Film, message: str) -> None:
    with pytest.raises(MergeError, match=message):
        merge(make_film(0, 1), other)


@pytest.mark.parametrize(("a", "b"), [(2**63 - 1, 1), (2**62, 2**62), (-(2**63), -1)])
def test_overflow_is_detected_never_wrapped(a: int, b: int) -> None:
    films = []
    for i, value in enumerate((a, b)):
        film = Film.empty(50, 400, window=(10, 20, 40, 390))
        film.sums[300, 17, 2, 1] = value
        film.cover(i, i + 1)
        films.append(film)
    with pytest.raises(FilmOverflowError, match=r"pixel \(27, 320\), replicate 2, channel Y exceeds 64 bits"):
        merge(*films)


def test_largest_sums_add_without_alarm() -> None:
    a, b = Film.empty(1, 1), Film.empty(1, 1)
    a.sums[...], b.sums[...] = 2**62, 2**62 - 1
    a.cover(0, 4)
    b.cover(4, 8)
    assert (merge(a, b).sums == 2**63 - 1).all()


def test_dropped_counts_do_not_wrap() -> None:
    a, b = Film.empty(1, 1), Film.empty(1, 1)
    a.dropped[...], b.dropped[...] = 2**32 - 1, 1
    a.cover(0, 2**35)
    b.cover(2**35, 2**36)
    with pytest.raises(FilmOverflowError, match="32 bits"):
        merge(a, b)


def _image(film: Film, **metadata: object) -> Image:
    same = {"scene_hash": "s", "seed": 7, "version": "1", "isa": "x86-64-v3", "cpu_vendor": "AMD"}
    return Image(film, same | metadata)


def test_images_of_one_scene_merge_and_add_their_times(make_film: FilmMaker) -> None:
    parts = [_image(make_film(i, i + 4), render_seconds=1.5, rays=100) for i in (4, 0, 8)]
    merged = Image.merge(parts)
    assert merged.film.identical(make_film(0, 12))
    assert (merged.metadata["render_seconds"], merged.metadata["rays"]) == (4.5, 300)
    assert "mixed" not in merged.metadata


@pytest.mark.parametrize(("key", "value"), [("scene_hash", "t"), ("seed", 8), ("sampling_version", 2)])
def test_another_scene_or_seed_is_refused_even_mixed(make_film: FilmMaker, key: str, value: object) -> None:
    images = [_image(make_film(0, 4)), _image(make_film(4, 8), **{key: value})]
    for mixed in (False, True):
        with pytest.raises(MergeError, match=f"images differ in {key}: .*{value}"):
            Image.merge(images, mixed=mixed)


@pytest.mark.parametrize("key", ["version", "isa", "cpu_vendor"])
def test_another_level_needs_mixed_and_is_recorded(make_film: FilmMaker, key: str) -> None:
    images = [_image(make_film(0, 4)), _image(make_film(4, 8), **{key: "other"})]
    with pytest.raises(MergeError, match=f"images differ in {key}.*--mixed"):
        Image.merge(images)
    merged = Image.merge(images, mixed=True)
    assert merged.metadata["mixed"] is True
    assert merged.film.identical(make_film(0, 8))
    with pytest.raises(MergeError, match="mixed"):
        Image.merge([_image(make_film(8, 9)), merged])


def test_nothing_to_merge_is_an_error() -> None:
    with pytest.raises(MergeError, match="no images"):
        Image.merge([])
