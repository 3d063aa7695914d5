"""EXR files: exact round trips, what other tools see, equal bytes for equal data, and hostile input."""

from __future__ import annotations

import struct
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from accuray.film import Film, Image, ImageError

FilmMaker = Callable[..., Film]


def round_trip(image: Image, path: Path, **options: object) -> Image:
    image.save(path, **options)
    return Image.load(path)


@pytest.mark.parametrize("compression", ["zip", "none"])
def test_film_and_metadata_come_back_exactly(image: Image, tmp_path: Path, compression: str) -> None:
    again = round_trip(image, tmp_path / "a.exr", compression=compression)
    assert again.film.identical(image.film)
    assert again.metadata == image.metadata
    assert again.pixels_equal(image)


@pytest.mark.parametrize(
    "options",
    [
        {"window": (5, 3, 30, 20)},
        {"window": (36, 20, 37, 21)},
        {"mask": np.array([[True, False, True], [False, True, False]])},
        {"replicates": 1},
        {"replicates": 8},
        {"dropped": True},
    ],
    ids=str,
)
def test_every_kind_of_film_comes_back(make_film: FilmMaker, tmp_path: Path, options: dict[str, object]) -> None:
    film = make_film(2, 11, **options)
    assert round_trip(Image(film), tmp_path / "a.exr").film.identical(film)


def test_merged_crops_with_pixel_masks_come_back(make_film: FilmMaker, tmp_path: Path) -> None:
    merged = Image.merge([Image(make_film(0, 3, window=w)) for w in ((1, 2, 9, 9), (20, 3, 31, 17))])
    assert round_trip(merged, tmp_path / "a.exr").film.identical(merged.film)


def test_extreme_sums_come_back(tmp_path: Path) -> None:
    film = Film.empty(4, 3, step=2.0**-60)
    film.sums.flat[:] = np.random.default_rng(1).integers(-(2**63), 2**63, film.sums.size)
    film.sums.flat[:4] = 2**63 - 1, -(2**63), -1, 2**32
    film.dropped[1, 2] = 2**32 - 1
    film.cover(0, 2**40)
    film.cover(2**41, 2**41 + 1)
    assert round_trip(Image(film), tmp_path / "a.exr").film.identical(film)


def test_an_empty_film_comes_back(tmp_path: Path) -> None:
    film = Film.empty(300, 200)
    assert round_trip(Image(film), tmp_path / "a.exr").film.identical(film)


def test_other_tools_see_a_picture(image: Image, tmp_path: Path) -> None:
    image.save(tmp_path / "a.exr")
    picture, state = OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True).parts
    assert (picture.name(), state.name()) == ("rgba", "accuray.state")
    channels = {name: channel.pixels for name, channel in picture.channels.items()}
    rgb = np.asarray(image)
    for index, name in enumerate("RGB"):
        assert channels[name].dtype == channels[f"error.{name}"].dtype == np.float32
        assert np.array_equal(channels[name], rgb[..., index])
        assert np.array_equal(channels[f"error.{name}"], image.error[..., index])
    assert np.array_equal(channels["A"], image.layers["alpha"])
    assert channels["samples"].dtype == np.uint32
    assert np.array_equal(channels["samples"], image.layers["samples"])
    header = picture.header
    assert header["compression"] == OpenEXR.ZIP_COMPRESSION
    assert header["accuray:version"] == "0.1.0"
    assert header["accuray:sceneHash"] == "ab" * 32
    assert header["accuray:seed"] == str(2**63 + 5)
    assert (header["accuray:sampleStart"], header["accuray:sampleCount"]) == ("0", "10")
    assert header["accuray:cmd"] == 'accuray render "scène.toml" -D x=1'
    assert header["accuray:whiteBalance"].tolist() == [1.1, 1.0, 0.35]
    assert header["accuray:renderTime"].tolist() == [0.1]
    assert np.allclose(header["chromaticities"], (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329))
    assert state.header["accuray:stateFormat"] == 1
    assert all(channel.pixels.dtype == np.uint32 for channel in state.channels.values())


def test_crops_have_data_and_display_windows(make_film: FilmMaker, tmp_path: Path) -> None:
    Image(make_film(0, 4, window=(5, 3, 30, 20))).save(tmp_path / "a.exr")
    for part in OpenEXR.File(str(tmp_path / "a.exr"), header_only=True).parts:
        assert [v.tolist() for v in part.header["dataWindow"]] == [[5, 3], [29, 19]]
        assert [v.tolist() for v in part.header["displayWindow"]] == [[0, 0], [36, 20]]


def test_sample_start_and_count_follow_gaps(make_film: FilmMaker, tmp_path: Path) -> None:
    merged = Image.merge([Image(make_film(a, b)) for a, b in ((3, 5), (9, 16))])
    merged.save(tmp_path / "a.exr")
    header = OpenEXR.File(str(tmp_path / "a.exr"), header_only=True).parts[0].header
    assert (header["accuray:sampleStart"], header["accuray:sampleCount"]) == ("3", "9")


def test_counts_beyond_32_bits_are_held_at_the_largest(tmp_path: Path) -> None:
    film = Film.empty(2, 2)
    film.cover(0, 2**33)
    again = round_trip(Image(film), tmp_path / "a.exr")
    part = OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True).parts[0]
    assert (part.channels["samples"].pixels == 2**32 - 1).all()
    assert (again.layers["samples"] == 2**33).all()


def test_arrays_of_any_layout_are_written_right(make_film: FilmMaker, tmp_path: Path) -> None:
    """OpenEXR takes strided memory for contiguous; a film whose dropped counts are a view must still be exact."""
    film = make_film(0, 9, dropped=True)
    wide = np.zeros((*film.dropped.shape, 3), dtype=np.uint32)
    wide[..., 1] = film.dropped
    film.dropped = wide[..., 1]
    image = Image(film)
    assert round_trip(image, tmp_path / "a.exr").film.identical(film)
    flipped = {name: plane[::-1] for name, plane in image._picture().items()}
    from accuray.film.exr import write_exr

    write_exr(tmp_path / "b.exr", film, {}, flipped)
    part = OpenEXR.File(str(tmp_path / "b.exr"), separate_channels=True).parts[0]
    assert np.array_equal(part.channels["G"].pixels, np.asarray(image)[::-1, :, 1])


def test_equal_data_give_equal_bytes(image: Image, tmp_path: Path) -> None:
    image.save(tmp_path / "a.exr")
    Image(image.film, dict(reversed(image.metadata.items()))).save(tmp_path / "b.exr")
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_the_render_time_changes_its_own_bytes_only_and_can_be_omitted(image: Image, tmp_path: Path) -> None:
    slower = Image(image.film, image.metadata | {"render_seconds": 12345.678901234567})
    for name, each in (("a", image), ("b", slower)):
        each.save(tmp_path / f"{name}.exr")
        each.save(tmp_path / f"{name}-timeless.exr", omit_time=True)
    a, b = ((tmp_path / f"{name}.exr").read_bytes() for name in "ab")
    differing = np.flatnonzero(np.frombuffer(a, np.uint8) != np.frombuffer(b, np.uint8))
    assert differing[-1] - differing[0] < 8
    assert (tmp_path / "a-timeless.exr").read_bytes() == (tmp_path / "b-timeless.exr").read_bytes()
    assert "render_seconds" not in Image.load(tmp_path / "a-timeless.exr").metadata


def test_command_lines_of_undecodable_bytes_are_kept_escaped(make_film: FilmMaker, tmp_path: Path) -> None:
    command = b"accuray render caf\xe9.toml".decode("utf-8", "surrogateescape")
    assert round_trip(Image(make_film(0, 4), {"command": command}), tmp_path / "a.exr").metadata["command"] == command


def test_unknown_compression_is_refused(image: Image, tmp_path: Path) -> None:
    with pytest.raises(ImageError, match=r"'dwaa' is unknown: allowed are zip, none"):
        image.save(tmp_path / "a.exr", compression="dwaa")


def test_foreign_files_are_named_for_what_they_are(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    with pytest.raises(ImageError, match=f"^{path}: cannot be read: No such file"):
        Image.load(path)
    with pytest.raises(ImageError, match="cannot be read: Is a directory"):
        Image.load(tmp_path)
    for content, message in ((b"", "is empty"), (b"P6 2 2 255 junk", "is not an EXR file")):
        path.write_bytes(content)
        with pytest.raises(ImageError, match=f"^{path}: {message}"):
            Image.load(path)
    pixels = np.zeros((4, 4), dtype=np.float32)
    OpenEXR.File({"type": OpenEXR.scanlineimage}, {"R": pixels}).write(str(path))
    with pytest.raises(ImageError, match="is an EXR without AccuRay's state"):
        Image.load(path)


def test_a_picture_too_large_for_its_file_is_refused_before_decoding(image: Image, tmp_path: Path) -> None:
    """Rows as before, so that the offset table fits, and columns that ask for 704 MB."""
    path = tmp_path / "a.exr"
    image.save(path)
    lie = path.read_bytes().replace(struct.pack("<4i", 0, 0, 36, 20), struct.pack("<4i", 0, 0, (1 << 20) - 1, 20))
    path.write_bytes(lie.replace(b'"window":[0,0,37,21]', b'"window":[0,0,1048576,21]'))
    # The ledger grew by five characters: its attribute's size says so.
    data = path.read_bytes()
    name = b"accuray:ledger\0string\0"
    at = data.index(name) + len(name)
    (length,) = struct.unpack_from("<i", data, at)
    path.write_bytes(data[:at] + struct.pack("<i", length + 5) + data[at + 4 :])
    with pytest.raises(ImageError, match=r"it declares \d{9} bytes of pixels in a file of \d{5} bytes"):
        Image.load(path)


def test_a_newer_format_is_named(image: Image, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    image.save(path)
    name = b"accuray:stateFormat\0int\0\4\0\0\0"
    data = path.read_bytes()
    assert data.count(name + struct.pack("<i", 1)) == 1
    path.write_bytes(data.replace(name + struct.pack("<i", 1), name + struct.pack("<i", 2)))
    with pytest.raises(ImageError, match="format 2, written by a newer AccuRay: this one reads up to 1"):
        Image.load(path)


@pytest.mark.parametrize("size", [(1 << 15, 1 << 15), (1 << 20, 64), (64, 1 << 20), (2**31 - 1, 2**31 - 1)])
def test_lies_about_the_size_are_refused_without_allocating(
    image: Image, tmp_path: Path, size: tuple[int, int]
) -> None:
    path = tmp_path / "a.exr"
    image.save(path)
    window = struct.pack("<4i", 0, 0, 36, 20)
    lie = struct.pack("<4i", 0, 0, size[0] - 1, size[1] - 1)
    data = path.read_bytes().replace(window, lie).replace(b'"window":[0,0,37,21]', b'"window":[0,0,%d,%d]' % size)
    path.write_bytes(data)
    with pytest.raises(ImageError, match="damaged"):
        Image.load(path)


SWEEP = """
import random, sys
from pathlib import Path
from accuray.film import Image, ImageError

source, scratch = Path(sys.argv[1]), Path(sys.argv[2])
data, film = source.read_bytes(), Image.load(source).film
rng = random.Random(20261122)
variants = [data[:n] for n in range(0, len(data), 131)] + [data[:-1]]
for _ in range(400):
    damaged = bytearray(data)
    for _ in range(rng.choice((1, 1, 4))):
        damaged[rng.randrange(len(damaged) if rng.random() < 0.5 else 3000)] ^= 1 << rng.randrange(8)
    variants.append(bytes(damaged))
refused = 0
for variant in variants:
    scratch.write_bytes(variant)
    try:
        again = Image.load(scratch)
    except ImageError as error:
        refused += 1
        assert str(scratch) in str(error), error
    else:
        assert again.film.identical(film), "damage changed the film unnoticed"
print(len(variants), refused)
"""


def test_reading_damage_prints_nothing_and_leaves_stdout_alone(
    image: Image, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.exr"
    image.save(path)
    path.write_bytes(path.read_bytes()[:-50])
    before = sys.stdout
    with pytest.raises(ImageError, match=r"state cannot be decoded \(Warning: .*\)$"):
        Image.load(path)
    assert sys.stdout is before
    assert capsys.readouterr().out == ""


def test_threads_load_and_print_at_the_same_time(
    image: Image, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.exr"
    image.save(path)
    with ThreadPoolExecutor(4) as pool:
        loads = [pool.submit(Image.load, path) for _ in range(12)]
        prints = [pool.submit(print, "line") for _ in range(50)]
        assert all(load.result().film.identical(image.film) for load in loads)
        assert [each.result() for each in prints] == [None] * 50
    assert capsys.readouterr().out.split() == ["line"] * 50


def test_every_damage_is_noticed_or_harmless(image: Image, tmp_path: Path) -> None:
    """Truncations and bit flips, in a process of its own because a crash must fail this test and no other."""
    image.save(tmp_path / "a.exr")
    command = [sys.executable, "-c", SWEEP, str(tmp_path / "a.exr"), str(tmp_path / "b.exr")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    variants, refused = (int(v) for v in done.stdout.split())
    assert refused > variants / 2
