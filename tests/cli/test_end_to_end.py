"""The whole command with the real engine, as a process of its own: files, exit statuses, signals, exact merging."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import accuray

SCENE = """
accuray = 1
[film]
width = 24
height = 16
[render]
spp = 8
[camera]
type = "perspective"
position = [0, 0, 5]
look_at = [0, 0, 0]
[materials.grey]
type = "diffuse"
reflectance = 0.5
[shapes.ball]
type = "sphere"
material = "grey"
[lights.sky]
type = "constant"
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A scene file in a folder of its own, not the current one."""
    path = tmp_path / "scenes" / "ball.toml"
    path.parent.mkdir()
    path.write_text(SCENE, encoding="utf-8")
    return path


def run(*arguments: str | Path, status: int = 0) -> subprocess.CompletedProcess[str]:
    """Runs `accuray` in the current folder and checks its exit status."""
    command = [sys.executable, "-m", "accuray", *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert result.returncode == status, result.stderr
    assert "Traceback" not in result.stderr
    return result


def test_render_writes_both_files_and_names_them(scene: Path) -> None:
    result = run("render", scene)
    assert result.stdout.splitlines() == ["ball.exr", "ball.png"]
    assert Path("ball.png").read_bytes().startswith(b"\x89PNG")
    image = accuray.Image.load("ball.exr")
    assert (image.width, image.height) == (24, 16)
    assert "render" in image.metadata["command"]


def test_flags_change_what_is_rendered(scene: Path) -> None:
    run("render", "-q", scene, "-w", "10", "--height=6", "--seed", "5", "--spp", "12", "-o", "a.exr", "-t", "2")
    image = accuray.Image.load("a.exr")
    assert (image.film.width, image.film.height, image.metadata["seed"]) == (10, 6, 5)
    assert [(r.first, r.end) for r in image.film.coverage] == [(0, 12)]


def test_overrides_reach_the_scene(scene: Path) -> None:
    run("render", "-q", scene, "-o", "a.exr", "-D", "materials.grey.reflectance=0.25")
    run("render", "-q", scene, "-o", "b.exr")
    hashes = [accuray.Image.load(name).metadata["scene_hash"] for name in ("a.exr", "b.exr")]
    assert hashes[0] != hashes[1]


def test_crop_renders_the_same_pixels(scene: Path) -> None:
    run("render", "-q", scene, "-o", "all.exr")
    run("render", "-q", scene, "-o", "part.exr", "--crop", "0.25,0.75,0.5,1")
    part = accuray.Image.load("part.exr")
    assert part.film.window == (6, 8, 18, 16)
    whole = accuray.Image.load("all.exr")
    assert (whole.film.sums[8:16, 6:18] == part.film.sums).all()


def test_parts_merge_to_the_bits_of_the_whole(scene: Path) -> None:
    run("render", "-q", scene, "-o", "all.exr", "--samples", "0:16", "-t", "1")
    run("render", "-q", scene, "-o", "a.exr", "--samples", "0:5", "-t", "3")
    run("render", "-q", scene, "-o", "b.exr", "--samples", "5:16")
    run("merge", "b.exr", "a.exr", "-o", "both.exr")
    assert accuray.Image.load("both.exr").pixels_equal(accuray.Image.load("all.exr"))
    again = run("merge", "both.exr", "a.exr", "-o", "c.exr", status=2)
    assert "a.exr" in again.stderr
    assert not Path("c.exr").exists()


def test_progress_json_is_the_only_thing_on_standard_error(scene: Path) -> None:
    result = run("render", scene, "--progress", "json")
    records = [json.loads(line) for line in result.stderr.splitlines()]
    assert (records[-1]["done"], records[-1]["total"]) == (8, 8)
    assert result.stdout.splitlines() == ["ball.exr", "ball.png"]


def test_wrong_scene_is_named_with_its_line(scene: Path) -> None:
    scene.write_text(SCENE.replace("reflectance = 0.5", "reflectance = 1.7"), encoding="utf-8")
    error = run("render", scene, status=2).stderr
    assert f"ball.toml:{SCENE.splitlines().index('reflectance = 0.5') + 1}" in error
    assert "1.7" in error
    run("render", "absent.toml", status=2)
    run("info", "absent.toml", status=2)


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_process_leaves_a_usable_image(scene: Path, number: signal.Signals, status: int) -> None:
    command = [sys.executable, "-m", "accuray", "render", str(scene), "--spp", "100000000", "--progress", "json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        while json.loads(process.stderr.readline())["done"] < 1:
            pass
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    assert process.returncode == status
    assert out.splitlines() == ["ball.exr", "ball.png"]
    assert json.loads(err.splitlines()[-1]) == {"warning": "interrupted; the image so far has been written"}
    samples = accuray.Image.load("ball.exr").layers["samples"]
    assert 1 <= samples.min() <= samples.max() < 100_000_000


def test_info_of_scene_and_image(scene: Path) -> None:
    run("render", "-q", scene, "-o", "a.exr", "--seed", "9")
    identity = accuray.load(scene).identity
    for file in (scene, Path("a.exr")):
        out = run("info", file).stdout
        assert "24 x 16 pixels" in out
        assert identity in out


def test_schema_doctor_and_version() -> None:
    schema = json.loads(run("schema").stdout)
    assert "$schema" in schema
    assert "diffuse" in run("schema", "--reference").stdout
    assert "embree" in run("doctor").stdout
    assert run("--version").stdout == f"accuray {accuray.__version__}\n"


def test_reader_that_goes_away_is_no_traceback() -> None:
    command = f"{sys.executable} -m accuray schema --reference | head -n 1"
    result = subprocess.run(command, shell=True, capture_output=True, text=True, check=False, timeout=60)
    assert result.stderr == ""
