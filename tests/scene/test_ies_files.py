"""IES files: every year of the format, symmetries, factors; and files that are broken or lie about their size."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ies_files import ies_text

from accuray import data
from accuray.formats import Scene, ies
from accuray.scene import SceneError
from accuray.scene.photometry import Photometry

VERTICAL = [0.0, 30.0, 60.0, 90.0]
HORIZONTAL = [0.0, 45.0, 90.0]
BUILT_IN = (data.FOLDER / "wall_washer.ies").read_bytes()


def candela(vertical: float, horizontal: float) -> float:
    return 100.0 + vertical + 0.5 * horizontal


def parsed(folder: Path, content: str | bytes) -> Photometry:
    path = folder / "x.ies"
    path.write_bytes(content.encode("latin-1") if isinstance(content, str) else content)
    return ies.read(path)


def light(folder: Path, **more: Any) -> dict[str, Any]:
    """The resolved light of a file, through the scene."""
    return Scene.from_dict({"lights": {"l": {"type": "ies", "file": "x.ies", **more}}}, folder=folder).lights["l"]


def check(found: Photometry) -> None:
    """What the renderer relies on."""
    assert found.candela.shape == (len(found.horizontal), len(found.vertical))
    assert np.isfinite(found.candela).all()
    assert (found.candela >= 0.0).all()
    assert (np.diff(found.vertical) > 0.0).all()
    assert len(found.vertical) >= 2
    assert 0.0 <= found.vertical[0] < found.vertical[-1] <= 180.0
    assert (np.diff(found.horizontal) > 0.0).all()
    assert len(found.horizontal) == 1 or (found.horizontal[0], found.horizontal[-1]) == (0.0, 360.0)


@pytest.mark.parametrize(
    ("first", "factors", "factor"),
    [
        ("", "0.9 0.8 10", 0.72),
        ("IESNA91", "0.9 0.8 10", 0.72),
        ("IESNA:LM-63-1995", "0.9 0.8 10", 0.9),
        ("IESNA:LM-63-2002", "0.9 1 10", 0.9),
        ("IES:LM-63-2019", "0.9 1.00001 10", 0.9),
    ],
)
def test_every_year_is_read(first: str, factors: str, factor: float, tmp_path: Path) -> None:
    """The second factor counts in the years in which it meant the lamp on its ballast."""
    text = ies_text(VERTICAL, HORIZONTAL, candela, first=first, factors=factors, multiplier=2.0)
    found = parsed(tmp_path, text)
    check(found)
    assert found.horizontal.tolist() == [0, 45, 90, 135, 180, 225, 270, 315, 360]
    assert found.vertical.tolist() == VERTICAL
    expected = [[2.0 * factor * candela(v, h) for v in VERTICAL] for h in (0, 45, 90, 45, 0, 45, 90, 45, 0)]
    assert np.allclose(found.candela, expected, rtol=1e-12)
    assert found.lamp_lumens == 1000.0


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", " \n\n", ",\n"])
def test_numbers_may_stand_on_any_lines(end: str, tmp_path: Path) -> None:
    head, _, numbers = ies_text(VERTICAL, HORIZONTAL, candela).partition("TILT=NONE\n")
    straight = parsed(tmp_path, head + "TILT=NONE\n" + numbers)
    shuffled = parsed(
        tmp_path,
        head.replace("\n", end.strip(" ,") or "\n") + "TILT=NONE" + end.strip(" ,") + end.join(numbers.split()),
    )
    assert np.array_equal(straight.candela, shuffled.candela)


def test_a_table_of_tilts_is_read_over(tmp_path: Path) -> None:
    tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.95 0.9"
    found = parsed(tmp_path, ies_text(VERTICAL, HORIZONTAL, candela, tilt=tilt))
    assert np.array_equal(found.candela, parsed(tmp_path, ies_text(VERTICAL, HORIZONTAL, candela)).candela)


def test_a_plane_across_is_a_symmetry_too(tmp_path: Path) -> None:
    """From 90 to 270: what lies at 180 + x lies at -x. Between 150 and 200 stands what is between at 360 - 10."""
    found = parsed(tmp_path, ies_text(VERTICAL, [90, 150, 200, 270], candela))
    check(found)
    assert found.horizontal.tolist() == [0, 30, 90, 150, 200, 270, 340, 360]
    between = candela(0.0, 150.0) + 0.6 * (candela(0.0, 200.0) - candela(0.0, 150.0))
    columns = {0: between, 30: candela(0, 150), 340: candela(0, 200), 360: between}
    assert {h: found.candela[found.horizontal.tolist().index(h), 0] for h in columns} == pytest.approx(columns)


def test_absolute_photometry_has_no_lamp_lumens(tmp_path: Path) -> None:
    assert parsed(tmp_path, ies_text(VERTICAL, [0.0], candela, lamps="1 -1")).lamp_lumens is None
    with pytest.raises(SceneError, match=r"lights.l.lamp_lumens: needs the lumens of the lamps in the file"):
        light(tmp_path, lamp_lumens=900)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"kind": "2 2"}, "type B; allowed is type C"),
        ({"kind": "3 1"}, "type A; allowed is type C"),
        ({"kind": "7 1"}, "type number 7"),
        ({"kind": "1 3"}, "line 4: the unit of lengths"),
        ({"tilt": "TILT=lamp.tlt"}, "line 3: 'TILT=lamp.tlt' is not read"),
        ({"tilt": "TILT="}, "is not read"),
        ({"tilt": "tilted"}, "is not read"),
        ({"multiplier": 0.0}, "the candela multiplier is 0"),
        ({"multiplier": -1.0}, "the candela multiplier is -1"),
        ({"factors": "nan 1 10"}, "'nan' is no finite number, in place of the ballast factor"),
        ({"factors": "0 1 10"}, "the ballast factor is 0"),
        ({"vertical": [0, 10, 10, 20]}, "the vertical angle 10 does not rise from 10"),
        ({"vertical": [0, 20, 10]}, "the vertical angle 10 does not rise from 20"),
        ({"vertical": [-90, 0, 90]}, "vertical angles are -90 to 90; allowed are 0 to 180"),
        ({"vertical": [0, 190]}, "allowed are 0 to 180"),
        ({"vertical": [0]}, "the number of vertical angles is 1"),
        ({"horizontal": [0, 30, 20, 90]}, "the horizontal angle 20 does not rise"),
        (
            {"horizontal": [0, 30, 60]},
            "horizontal angles are 0 to 60; allowed are 0, 0 to 90, 180 or 360, or 90 to 270",
        ),
        ({"horizontal": [0, 30, 60, 300]}, "horizontal angles are 0 to 300"),
        ({"vertical": [0, 1e-5, 90]}, "the vertical angle 0 does not rise from 0"),
        ({"lamps": "1 1e300"}, "line 4: the lumens of a lamp are 1e+300"),
        ({"horizontal": [10, 360]}, "horizontal angles are 10 to 360"),
        ({"horizontal": [0, 400]}, "horizontal angles are 0 to 400"),
        ({"candela": lambda *_: -1.0}, "candelas are -1 to -1"),
        ({"candela": lambda *_: float("nan")}, "'nan' is no finite number, in place of candela 1 of 12"),
        ({"candela": lambda *_: float("inf")}, "'inf' is no finite number"),
        ({"candela": lambda *_: 1e300, "multiplier": 1e300}, "allowed are 0 to 1e30"),
        ({"lamps": "1.5 1000"}, "the number of lamps is 1.5"),
    ],
    ids=str,
)
def test_what_is_wrong_is_named(changes: dict[str, Any], complaint: str, tmp_path: Path) -> None:
    table = {"vertical": VERTICAL, "horizontal": HORIZONTAL, "candela": candela, **changes}
    (tmp_path / "x.ies").write_text(
        ies_text(table.pop("vertical"), table.pop("horizontal"), table.pop("candela"), **table)
    )
    with pytest.raises(SceneError) as caught:
        light(tmp_path)
    assert caught.value.key == "lights.l.file"
    assert '"x.ies" cannot be read: ' in str(caught.value)
    assert complaint in str(caught.value)


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ("", "no line `TILT=`"),
        ("a picture, in truth", "no line `TILT=`"),
        ("TILT=NONE", "it ends before the number of lamps"),
        ("TILT=NONE 1 1000", "is not read"),
        ("TILT=NONE\n1 1000 1 1000000 1000000 1 2 0 0 0", "claims 1000000 x 1000000 candelas"),
        ("TILT=NONE\n1 1000 1 4294967296 1 1 2 0 0 0", "the number of vertical angles is 4.29497e+09"),
        ("TILT=NONE\n1 1000 1 1000000 1 1 2 0 0 0 1 1 10 0 90", "it ends before vertical angle 3 of 1000000"),
        ("TILT=NONE\n1 1000 1 -2 1 1 2 0 0 0", "the number of vertical angles is -2"),
        ("TILT=INCLUDE\n1 1000000000 0 90", "the number of tilt angles is 1e+09"),
        ("TILT=NONE\n1 1e99999 1", "is no finite number"),
        ("TILT=NONE\n1 " + "9" * 10_000, "is no finite number"),
        ("TILT=NONE\n" + "x" * 10_000, "is no finite number"),
        ("TILT=NONE\n\x00\x01\x02", "is no finite number"),
        (ies_text(VERTICAL, HORIZONTAL, candela) + "5\n", "'5' follows the last candela; the counts are wrong"),
    ],
    ids=range(14),
)
def test_lies_about_the_size_are_refused_at_once(content: str, complaint: str, tmp_path: Path) -> None:
    start = time.process_time()
    with pytest.raises(ValueError, match=r".") as caught:
        parsed(tmp_path, content)
    assert complaint in str(caught.value)
    assert len(str(caught.value)) < 300
    assert time.process_time() - start < 1.0


def test_a_file_beyond_the_limit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="larger than 16777216 bytes"):
        parsed(tmp_path, b" " * (ies.MAX_BYTES + 1))


def mutations(content: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Truncated everywhere, then with bytes replaced, words replaced, blocks repeated and removed."""
    yield from (content[: len(content) * end // count] for end in range(count))
    rng = random.Random(seed)
    words = [
        b"nan",
        b"-1",
        b"1e308",
        b"0",
        b"99999999",
        b"x",
        b"TILT=",
        b"\x00",
        b"inf",
        b"1 2 3",
        b"",
        b"-0.0",
        b"1e-320",
    ]
    for number in range(count):
        parts = content.split(b" ")
        damaged = bytearray(content)
        for _ in range(rng.randrange(1, 4)):
            at = rng.randrange(len(damaged))
            if number % 4 == 0:
                damaged[at : at + 1] = bytes([rng.randrange(256)])
            elif number % 4 == 1:
                parts[rng.randrange(len(parts))] = rng.choice(words)
                damaged = bytearray(b" ".join(parts))
            elif number % 4 == 2:
                del damaged[at : at + rng.randrange(1, 30)]
            else:
                damaged[at:at] = damaged[at : at + rng.randrange(1, 60)]
        yield bytes(damaged)


@pytest.mark.parametrize("which", ["built-in", "1991"])
def test_damaged_files_are_lights_or_clear_errors(which: str, tmp_path: Path) -> None:
    content = BUILT_IN
    if which == "1991":
        content = ies_text(VERTICAL, HORIZONTAL, candela, first="IESNA91", tilt="TILT=INCLUDE\n1 2 0 90 1 1").encode()
    start, messages = time.process_time(), []
    for damaged in mutations(content, 150, seed=7):
        (tmp_path / "x.ies").write_bytes(damaged)
        try:
            check(light(tmp_path)["photometry"])
        except SceneError as error:
            messages.append(str(error))
    assert len(messages) >= 150
    assert all("cannot be read: " in message and len(message) < 500 for message in messages)
    assert time.process_time() - start < 30.0


def test_the_identity_follows_the_content(tmp_path: Path) -> None:
    def identity(text: str) -> str:
        (tmp_path / "x.ies").write_text(text)
        return Scene.from_dict({"lights": {"l": {"type": "ies", "file": "x.ies"}}}, folder=tmp_path).identity

    one = ies_text(VERTICAL, HORIZONTAL, candela)
    assert identity(one) == identity(one)
    assert identity(one) != identity(ies_text(VERTICAL, HORIZONTAL, candela, multiplier=1.5))
