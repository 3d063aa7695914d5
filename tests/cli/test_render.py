"""`accuray render` with a fake engine: what it asks for, what it writes, what it prints, and its exit status."""

from __future__ import annotations

import json
import random
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from fake_engine import FakeEngine

from accuray.cli import main

FLAGS = [
    ["scenes/box.toml"],
    ["-o", "picture.exr"],
    ["--spp", "64"],
    ["--samples", "16:64"],
    ["--seed", "3"],
    ["-t", "2"],
    ["-w", "200"],
    ["--height", "100"],
    ["--crop", "0.25,0.5,0,1"],
    ["-D", "film.exposure=1"],
    ["-D", "integrator.max_depth=4"],
    ["--progress", "json"],
]


def test_flags_may_come_in_any_order(engine: FakeEngine) -> None:
    shuffled = random.Random(1)
    for _ in range(25):
        flags = FLAGS.copy()
        shuffled.shuffle(flags)
        assert main(["render", *(word for flag in flags for word in flag)]) == 0
        path, overrides = engine.loaded[-1]
        assert path == Path("scenes/box.toml")
        assert {"film.width=200", "film.height=100", "film.exposure=1", "integrator.max_depth=4"} == set(overrides)
        asked = engine.rendered[-1]
        assert (asked["spp"], asked["samples"], asked["seed"], asked["threads"]) == (None, (16, 64), 3, 2)
        assert asked["crop"] == (50, 0, 100, 100)
    assert Path("picture.exr").exists()
    assert Path("picture.png").exists()


def test_attached_values_mean_the_same(engine: FakeEngine) -> None:
    assert main(["render", "box.toml", "--spp=8", "-t3", "-Dfilm.unit=2", "-w40"]) == 0
    assert engine.loaded[-1][1] == ["film.unit=2", "film.width=40"]
    assert (engine.rendered[-1]["spp"], engine.rendered[-1]["threads"]) == (8, 3)


def test_a_flag_with_a_name_wins_over_an_override(engine: FakeEngine) -> None:
    main(["render", "box.toml", "-w", "64", "-D", "film.width=32"])
    assert engine.loaded[-1][1][-1] == "film.width=64"


def test_output_is_named_after_the_scene(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "some/where/box.toml"]) == 0
    assert sorted(path.name for path in Path().iterdir()) == ["box.exr", "box.png"]
    assert capsys.readouterr().out == "box.exr\nbox.png\n"


def test_quiet_prints_nothing(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "-q", "box.toml"]) == 0
    assert capsys.readouterr() == ("", "")


def test_verbose_says_what_is_done(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "box.toml", "-v", "-t", "2"]) == 0
    captured = capsys.readouterr()
    assert "identity feed" in captured.err
    assert "2 threads" in captured.err
    assert captured.out == "box.exr\nbox.png\n"


def test_the_image_knows_its_command(engine: FakeEngine, monkeypatch: pytest.MonkeyPatch) -> None:
    arguments = ["render", "a box.toml", "--spp", "4"]
    monkeypatch.setattr("sys.argv", ["accuray", *arguments])
    main(arguments)
    assert json.loads(Path("a box.exr").read_text())["command"] == "accuray render 'a box.toml' --spp 4"


def test_crops_with_a_common_edge_neither_overlap_nor_leave_a_gap(engine: FakeEngine) -> None:
    edges = ["0", "0.1234", "0.333333", "0.7775", "1"]
    for x0, x1 in pairwise(edges):
        assert main(["render", "box.toml", "--crop", f"{x0},{x1},0,1"]) == 0
    windows = [asked["crop"] for asked in engine.rendered]
    assert windows[0][0] == 0
    assert windows[-1][2] == 200
    assert all(left[2] == right[0] for left, right in pairwise(windows))


def test_pixel_bounds_are_taken_as_they_are(engine: FakeEngine) -> None:
    main(["render", "box.toml", "--pixel-bounds", "3,200,5,100"])
    assert engine.rendered[-1]["crop"] == (3, 5, 200, 100)


def test_scene_error_ends_with_2(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "broken.toml"]) == 2
    assert "broken.toml:3: film.width: -1 is out of range" in capsys.readouterr().err
    assert not Path("broken.exr").exists()


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (RuntimeError("the device is lost"), "RuntimeError: the device is lost"),
        (OSError(28, "No space left on device"), "No space left on device"),
        (MemoryError(), "out of memory"),
    ],
)
def test_failed_render_ends_with_1(
    error: Exception, message: str, engine: FakeEngine, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(_: dict[str, Any]) -> None:
        raise error

    engine.on_render = fail
    assert main(["render", "box.toml"]) == 1
    captured = capsys.readouterr()
    assert message in captured.err
    assert "Traceback" not in captured.err
    assert captured.out == ""
    assert not Path("box.exr").exists()


def test_verbose_shows_where_an_internal_error_is(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    def fail(_: dict[str, Any]) -> None:
        raise RuntimeError("the device is lost")

    engine.on_render = fail
    assert main(["render", "box.toml", "-v"]) == 1
    assert "Traceback" in capsys.readouterr().err


def test_dropped_samples_are_told(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    engine.dropped = 3
    assert main(["render", "box.toml"]) == 0
    assert "accuray: warning: 3 samples were not finite" in capsys.readouterr().err
    assert main(["render", "box.toml", "--progress", "json"]) == 0
    last = capsys.readouterr().err.splitlines()[-1]
    assert json.loads(last) == {"warning": "3 samples were not finite and were left out"}


def test_losses_of_meshes_are_told(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    engine.mesh_reports = {"a": {"degenerate_triangles": 0}, "b": {"degenerate_triangles": 2, "nonfinite_triangles": 1}}
    assert main(["render", "box.toml"]) == 0
    err = capsys.readouterr().err
    assert "shapes.b: left out 1 triangles with a vertex that is not finite, 2 triangles without area" in err
    assert "shapes.a" not in err


def test_thread_flag_beats_variable_beats_machine(engine: FakeEngine, monkeypatch: pytest.MonkeyPatch) -> None:
    main(["render", "box.toml"])
    assert engine.rendered[-1]["threads"] >= 1
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "5")
    main(["render", "box.toml"])
    monkeypatch.setenv("ACCURAY_THREADS", "3")
    main(["render", "box.toml"])
    main(["render", "box.toml", "-t", "2"])
    assert [asked["threads"] for asked in engine.rendered[1:]] == [5, 3, 2]


def test_wrong_variable_is_named(
    engine: FakeEngine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ACCURAY_THREADS", "many")
    assert main(["render", "box.toml"]) == 2
    assert "ACCURAY_THREADS is 'many'" in capsys.readouterr().err


def test_json_progress_is_one_object_per_line(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "box.toml", "--progress", "json", "--spp", "64"]) == 0
    captured = capsys.readouterr()
    records = [json.loads(line) for line in captured.err.splitlines()]
    assert [record["done"] for record in records] == [32, 64]
    names = {"done", "total", "elapsed", "eta", "rays", "rays_per_second", "samples_per_second", "error"}
    assert all(set(record) == names for record in records)
    assert captured.out == "box.exr\nbox.png\n"


def test_plain_progress_ends_with_all_of_it(engine: FakeEngine, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", "box.toml", "--spp", "640"]) == 0
    assert capsys.readouterr().err == "Progress: 100% 640/640 spp 00:12<00:22 5.20 Mrays/s, error 1.8 %\n"
