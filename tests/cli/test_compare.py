"""`accuray compare` on real files: what it prints, its exit status, the heat map."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from accuray.cli import main
from accuray.film.png import encode_codes

Captured = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def pictures(empty_folder: Path) -> None:
    """b.png, and a.png with 10 more in red; wide.png is larger."""
    codes = np.full((12, 16, 3), 100, dtype=np.uint8)
    Path("b.png").write_bytes(encode_codes(codes))
    Path("a.png").write_bytes(encode_codes(codes + np.array([10, 0, 0], dtype=np.uint8)))
    Path("wide.png").write_bytes(encode_codes(np.repeat(codes, 2, axis=1)))


def test_figures_in_words(capsys: Captured) -> None:
    assert main(["compare", "a.png", "b.png"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    first, *facts = out.splitlines()
    assert first == "a.png against b.png"
    assert [fact.split()[0] for fact in facts] == ["size", "accuracy", "largest", "relMSE", "PSNR", "FLIP", "noise"]
    assert "16 x 12 pixels, exposure 0 EV" in out
    assert "98.693 %: display values differ by 0.03922 (R), 0.00000 (G), 0.00000 (B)" in out
    assert "32.90 dB" in out
    assert "at 67 pixels per degree" in out
    assert "not judged: not both have error estimates" in out
    assert main(["compare", "a.png", "a.png"]) == 0
    assert "every value is the same" in capsys.readouterr().out


def test_figures_as_json_and_a_heat_map(capsys: Captured) -> None:
    assert main(["compare", "--json", "a.png", "--diff", "d.png", "b.png", "--tolerance", "2", "--ppd=30"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["accuracy"] == pytest.approx(100 - 1000 / 255 / 3)
    assert report["difference"] == pytest.approx([10 / 255, 0, 0])
    assert (report["name"], report["reference"], report["diff"]) == ("a.png", "b.png", "d.png")
    assert (report["tolerance"], report["exceeded"], report["pixels_per_degree"]) == (2.0, False, 30.0)
    assert report["diff_white"] == pytest.approx(0.02)
    assert Path("d.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("tolerance", "status"), [("1.31", 0), ("1.31%", 0), ("1.3", 1), ("0", 1), ("100", 0)])
def test_a_tolerance_decides_the_exit_status(tolerance: str, status: int, capsys: Captured) -> None:
    assert main(["compare", "a.png", "b.png", "--tolerance", tolerance]) == status
    assert ("exceeded" if status else "kept") in capsys.readouterr().out
    assert main(["compare", "b.png", "b.png", "--tolerance", tolerance]) == 0


def test_the_heat_map_is_written_when_the_tolerance_is_exceeded(capsys: Captured) -> None:
    assert main(["compare", "a.png", "b.png", "--tolerance", "0", "--diff", "d.png"]) == 1
    assert Path("d.png").exists()
    assert "d.png, white where display values differ by 0.02" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["a.png", "wide.png"], "a.png has 16 x 12 pixels, wide.png 32 x 12; their shapes differ too"),
        (["a.png", "none.png"], "none.png: cannot be read: No such file"),
        (["a.png", "b.tga"], "unknown image extension '.tga': allowed are .exr, .png"),
        (["a.png"], "B"),
        (["a.png", "b.png", "--diff", "d.jpg"], "must end in .png"),
        (["a.png", "b.png", "--diff", "nowhere/d.png"], "no folder"),
        (["a.png", "b.png", "--tolerance", "-1"], "'-1' is not a number from 0 to 100"),
        (["a.png", "b.png", "--tolerance", "nan"], "'nan' is not a number"),
        (["a.png", "b.png", "--ppd", "0"], "1 to 1000"),
        (["a.png", "b.png", "--tolerence", "1"], "--tolerance"),
    ],
)
def test_wrong_usage_ends_with_2(arguments: list[str], message: str, capsys: Captured) -> None:
    assert main(["compare", *arguments]) == 2
    assert message in capsys.readouterr().err
