"""merge, info, schema, doctor and verify with a fake engine."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from fake_engine import FakeEngine, FakeImage

import accuray
from accuray.cli import doctor, main

Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    "arguments",
    [["a.exr", "b.exr", "-o", "c.exr"], ["-o", "c.exr", "a.exr", "b.exr"], ["a.exr", "-o", "c.exr", "b.exr"]],
)
def test_merge_takes_its_files_in_any_place(arguments: list[str], engine: FakeEngine, capsys: Captured) -> None:
    engine.images = {"a.exr": FakeImage((0, 16)), "b.exr": FakeImage((16, 64))}
    assert main(["merge", *arguments]) == 0
    assert capsys.readouterr().out == "c.exr\nc.png\n"
    assert json.loads(Path("c.exr").read_text())["command"].startswith("accuray ")


def test_merge_of_what_does_not_fit_names_the_file(engine: FakeEngine, capsys: Captured) -> None:
    engine.images = {"a.exr": FakeImage((0, 16)), "b.exr": FakeImage((8, 64))}
    assert main(["merge", "a.exr", "b.exr", "-o", "c.exr"]) == 2
    assert "b.exr: both films hold the same samples" in capsys.readouterr().err
    assert not Path("c.exr").exists()


def test_mixed_merge_must_be_asked_for(engine: FakeEngine) -> None:
    engine.images = {"a.exr": FakeImage((0, 16)), "b.exr": FakeImage((16, 64))}
    for flags, mixed in (([], False), (["--mixed"], True)):
        assert main(["merge", "a.exr", "b.exr", "-o", "c.exr", *flags]) == 0
        assert json.loads(Path("c.exr").read_text())["mixed"] is mixed


def test_info_tells_the_ledger(engine: FakeEngine, capsys: Captured) -> None:
    image = FakeImage((16, 64))
    image.film.window = (0, 0, 100, 50)
    image.metadata |= {"command": "accuray render box.toml", "render_seconds": 1.25}
    engine.images = {"a.exr": image}
    assert main(["info", "a.exr"]) == 0
    out = capsys.readouterr().out
    for text in ("200 x 100 pixels, of which x 0:100, y 0:50", "16:64", "48", "cafe", "1.8 %", "1.25 s", "box.toml"):
        assert text in out


def test_info_sums_up_a_scene(engine: FakeEngine, capsys: Captured) -> None:
    assert main(["info", "box.toml"]) == 0
    out = capsys.readouterr().out
    for text in ("200 x 100 pixels", "16 per pixel", "3: 2 mesh, 1 sphere", "1: 1 constant", "none", "feed"):
        assert text in out


def test_info_of_a_broken_scene_ends_with_2(engine: FakeEngine) -> None:
    assert main(["info", "broken.toml"]) == 2


def test_schema_and_reference(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(accuray, "json_schema", lambda: {"type": "object"}, raising=False)
    monkeypatch.setattr(accuray, "reference_markdown", lambda: "# Reference\n", raising=False)
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == {"type": "object"}
    assert main(["schema", "--reference"]) == 0
    assert capsys.readouterr().out == "# Reference\n"


class Report:
    """A verification report as accuray.verify.run returns it."""

    def __init__(self, passed: bool) -> None:
        self.passed = passed

    def table(self) -> str:
        return "case expected measured"

    def to_json(self) -> str:
        return json.dumps({"passed": self.passed})


@pytest.mark.parametrize(("passed", "status"), [(True, 0), (False, 1)])
def test_verify_ends_with_1_if_a_case_fails(
    passed: bool, status: int, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    asked = []

    def run(quick: bool, progress: object) -> Report:
        assert progress is None, "standard error is no terminal here"
        asked.append(quick)
        return Report(passed)

    monkeypatch.setattr("accuray.verify.run", run)
    assert main(["verify"]) == status
    assert capsys.readouterr().out == "case expected measured\n"
    assert main(["verify", "--json", "--quick"]) == status
    assert json.loads(capsys.readouterr().out) == {"passed": passed}
    assert asked == [False, True]


def test_doctor_names_what_the_processor_lacks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    flags = " ".join(sorted(doctor.REQUIRED_CPU_FLAGS - {"avx2"}))
    listing = tmp_path / "cpuinfo"
    listing.write_text(f"processor : 0\nmodel name\t: Old 9000\nflags\t\t: fpu {flags}\n")
    assert doctor.processor(listing)[0] == "Old 9000"
    found = doctor.processor(listing)
    monkeypatch.setattr(doctor, "processor", lambda: found)
    assert main(["doctor"]) == 1
    assert "Old 9000 lacks avx2" in capsys.readouterr().out


def test_doctor_tells_what_it_finds(
    engine: FakeEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(accuray, "__version__", "1.2.3", raising=False)
    monkeypatch.setattr(accuray, "build_info", lambda: {"Embree": "3.13.5", "isa": "x86-64-v3"}, raising=False)
    monkeypatch.setattr(accuray, "cache_folder", lambda: tmp_path / "cache", raising=False)
    monkeypatch.setattr(doctor, "processor", lambda: ("New 9000", doctor.REQUIRED_CPU_FLAGS))
    monkeypatch.setattr(doctor, "files", lambda: "OpenEXR")
    assert main(["doctor"]) == 0
    out = capsys.readouterr().out
    for text in ("AccuRay 1.2.3, Embree 3.13.5, isa x86-64-v3", "New 9000", "cache", "all is well"):
        assert text in out


def test_doctor_survives_a_broken_part(
    engine: FakeEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def broken() -> dict[str, str]:
        raise ImportError("libembree3.so.3: cannot open shared object file")

    monkeypatch.setattr(accuray, "build_info", broken, raising=False)
    monkeypatch.setattr(accuray, "cache_folder", lambda: tmp_path, raising=False)
    monkeypatch.setattr(doctor, "processor", lambda: ("New 9000", doctor.REQUIRED_CPU_FLAGS))
    assert main(["doctor"]) == 1
    assert "FAIL  engine       ImportError: libembree3.so.3" in capsys.readouterr().out
