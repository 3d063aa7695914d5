"""`accuray render --frames`: lists and names of frames, restarts, interrupts, and what is said about them."""

from __future__ import annotations

import json
import signal
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import accuray
from accuray.cli import main

STEADY = settings(max_examples=100, deadline=None, derandomize=True)
NUMBERS = st.integers(-1000, 1000)

SCENE = """
accuray = 1
[film]
width = 20
height = 20
[render]
spp = 8
[animation]
fps = 10
[camera]
type = "perspective"
fov = { keys = [{ time = 0, value = 30 }, { time = 1, value = 60 }] }
[materials.grey]
type = "diffuse"
[shapes.ball]
type = "sphere"
material = "grey"
[lights.sky]
type = "constant"
"""


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("5", (5,)),
        ("1,5,9", (1, 5, 9)),
        ("1-4", (1, 2, 3, 4)),
        ("1-10x3", (1, 4, 7, 10)),
        ("1-10x20", (1,)),
        ("1-3,7-9x2", (1, 2, 3, 7, 9)),
        ("-2", (-2,)),
        ("-2-1", (-2, -1, 0, 1)),
        ("-5--1x2", (-5, -3, -1)),
        ("9,1-3,2", (9, 1, 2, 3)),
        (" 1 - 3 , 5 ", (1, 2, 3, 5)),
        ("007", (7,)),
        ("4-4", (4,)),
    ],
)
def test_lists_of_frames(text: str, frames: tuple[int, ...]) -> None:
    assert accuray.parse_frames(text) == frames


@STEADY
@given(st.lists(st.tuples(NUMBERS, st.integers(0, 50), st.integers(1, 7)), min_size=1, max_size=5))
def test_a_list_names_what_its_ranges_hold(parts: list[tuple[int, int, int]]) -> None:
    text = ",".join(f"{first}-{first + length}x{step}" for first, length, step in parts)
    held = [number for first, length, step in parts for number in range(first, first + length + 1, step)]
    frames = accuray.parse_frames(text)
    assert sorted(frames) == sorted(set(held))
    assert list(frames) == list(dict.fromkeys(held))
    assert accuray.parse_frames(",".join(map(str, frames))) == frames


@STEADY
@given(st.text(alphabet="0123456789-x, .#", max_size=12))
def test_any_text_is_a_list_or_told(text: str) -> None:
    with suppress(ValueError):
        assert accuray.parse_frames(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "allowed are"),
        ("one", "'one': allowed are"),
        ("1-", "allowed are"),
        ("1..5", "allowed are"),
        ("1,,2", "allowed are"),
        ("1-5x", "allowed are"),
        ("1-5x-2", "allowed are"),
        ("1.5", "allowed are"),
        ("5-1", "run backwards: write 1-5"),
        ("-1--5", "run backwards: write -5--1"),
        ("1-5x0", "a step of 0 leads nowhere"),
        ("1-99999999", "more than 1000000 frames"),
        ("1-900000,1000000-1900000", "more than 1000000 frames"),
        ("9999999999", "allowed are numbers from -1000000000"),
        ("1" * 30, "allowed are"),
    ],
)
def test_wrong_lists_are_told(text: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="frames") as caught:
        accuray.parse_frames(text)
    assert said in str(caught.value)
    assert main(["render", "box.toml", f"--frames={text}"]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("pattern", "frame", "name"),
    [
        ("out/f.####.exr", 12, "out/f.0012.exr"),
        ("f#.exr", 12, "f12.exr"),
        ("f.##.exr", 12345, "f.12345.exr"),
        ("f.####.exr", -12, "f.-0012.exr"),
        ("##/f.####.exr", 3, "03/f.0003.exr"),
        ("out.exr", 12, "out.0012.exr"),
        ("a.b.exr", 0, "a.b.0000.exr"),
    ],
)
def test_names_of_frames(pattern: str, frame: int, name: str) -> None:
    assert accuray.frame_path(pattern, frame) == Path(name)


@STEADY
@given(NUMBERS, NUMBERS, st.sampled_from(["f.exr", "f.#.exr", "#/f.####.exr", "f-##"]))
def test_two_frames_never_share_a_file(first: int, second: int, pattern: str) -> None:
    same = accuray.frame_path(pattern, first) == accuray.frame_path(pattern, second)
    assert same == (first == second)


@pytest.fixture
def zoom() -> str:
    """An animation in the current folder."""
    Path("zoom.toml").write_text(SCENE, encoding="utf-8")
    return "zoom.toml"


def film(path: str) -> Any:
    """The film of a file."""
    return accuray.Image.load(path).film


def test_frames_are_rendered_once(zoom: str, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["render", zoom, "--frames", "1-5x2", "-o", "f.##.exr"]
    assert main(command) == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == [f"f.0{n}.{ending}" for n in (1, 3, 5) for ending in ("exr", "png")]
    assert said.err.splitlines()[-1] == "accuray: 3 frames: 3 rendered, 0 finished before"
    Path("f.03.exr").unlink()
    Path("f.05.png").unlink()
    assert main([*command, "-v"]) == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == ["f.03.exr", "f.03.png"]
    assert "frame 1: f.01.exr is finished" in said.err
    assert said.err.splitlines()[-1] == "accuray: 3 frames: 1 rendered, 2 finished before"
    assert Path("f.05.png").exists()
    # A frame is the picture of its number alone.
    assert main(["render", zoom, "-q", "-D", "animation.frame=3", "-o", "alone.exr"]) == 0
    assert film("f.03.exr").identical(film("alone.exr"))


def test_what_is_replaced_is_told(zoom: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", zoom, "-q", "--frames", "4"]) == 0
    assert main(["render", zoom, "--frames", "4", "-D", "lights.sky.radiance=2"]) == 0
    assert "frame 4: zoom.0004.exr holds another scene, and is replaced" in capsys.readouterr().err
    assert main(["render", zoom, "--frames", "4", "-D", "lights.sky.radiance=2", "--spp", "12"]) == 0
    assert "frame 4: zoom.0004.exr holds other samples" in capsys.readouterr().err


def test_json_names_the_frame_and_ends_with_a_summary(zoom: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", zoom, "-q", "--frames", "1"]) == 0
    assert main(["render", zoom, "-q", "--frames=-1-1", "--progress", "json"]) == 0
    records = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert {record["frame"] for record in records[:-1]} == {-1, 0}
    assert records[-1] == {"frames": 3, "rendered": 2, "skipped": 1}


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_frame_is_written_and_rendered_anew(
    number: signal.Signals, status: int, zoom: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    render = accuray.render

    def interrupted(scene: accuray.Scene, **arguments: Any) -> accuray.Image:
        if scene.animation["frame"] != 2:
            return render(scene, **arguments)
        arguments["progress"] = lambda state: signal.raise_signal(number) if state.done >= 4 else None
        return render(scene, **arguments)

    command = ["render", zoom, "--frames", "1-3"]
    with monkeypatch.context() as patched:
        patched.setattr(accuray, "render", interrupted)
        assert main(command) == status
    said = capsys.readouterr()
    assert "interrupted; frame 2 so far has been written" in said.err
    assert said.err.splitlines()[-1] == "accuray: 3 frames: 1 rendered, 0 finished before, 2 left"
    assert sorted(path.name for path in Path().glob("*.exr")) == ["zoom.0001.exr", "zoom.0002.exr"]
    partial = accuray.Image.load("zoom.0002.exr")
    assert partial.metadata["interrupted"]
    assert 0 < partial.layers["samples"].max() < 8

    assert main(command) == 0
    assert capsys.readouterr().err.splitlines()[-1] == "accuray: 3 frames: 2 rendered, 1 finished before"
    for frame in (1, 2, 3):
        main(["render", zoom, "-q", "-D", f"animation.frame={frame}", "-o", "alone.exr"])
        assert film(f"zoom.000{frame}.exr").identical(film("alone.exr"))


def test_a_signal_between_frames_ends_after_the_one_that_is_written(
    zoom: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    save = accuray.Image.save

    def interrupted(image: accuray.Image, path: Path, **options: Any) -> None:
        if Path(path).name == "zoom.0001.exr":
            signal.raise_signal(signal.SIGINT)
        save(image, path, **options)

    monkeypatch.setattr(accuray.Image, "save", interrupted)
    assert main(["render", zoom, "--frames", "1-3"]) == 130
    assert sorted(path.name for path in Path().glob("zoom.*")) == ["zoom.0001.exr", "zoom.0001.png", "zoom.toml"]
    assert capsys.readouterr().err.splitlines()[-1] == "accuray: 3 frames: 1 rendered, 0 finished before, 2 left"


def test_wrong_outputs_are_told_before_anything_is_rendered(zoom: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", zoom, "--frames", "1-3", "-o", "f.####.png"]) == 2
    assert "must end in .exr" in capsys.readouterr().err
    assert main(["render", zoom, "--frames", "1-3", "-o", "nowhere/f.exr"]) == 2
    assert "there is no folder" in capsys.readouterr().err
    Path("f.0003.exr").mkdir()
    assert main(["render", zoom, "--frames", "1-3", "-o", "f.exr"]) == 2
    assert not Path("f.0001.exr").exists()


def test_a_wrong_scene_is_told(zoom: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = SCENE.replace("value = 60", "value = 190")
    Path(zoom).write_text(text, encoding="utf-8")
    assert main(["render", zoom, "--frames", "1-3"]) == 2
    assert "keys[1].value: 190" in capsys.readouterr().err
