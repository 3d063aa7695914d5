"""Wrong command lines: exit status 2, a sentence on standard error, and nothing done."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from fake_engine import FakeEngine

from accuray.cli import VERBS, main


def test_version_prints_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("accuray ")


def test_no_argument_explains_and_fails(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert all(verb in captured.err for verb in VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_explains_itself(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([verb, "--help"])
    assert stop.value.code == 0
    assert f"usage: accuray {verb}" in capsys.readouterr().out


WRONG = [
    (["rendr", "a.toml"], "unknown command 'rendr'; the nearest one is 'render'"),
    (["mrege"], "the nearest one is 'merge'"),
    (["--verson"], "unknown flag --verson; the nearest one is --version"),
    (["render"], "SCENE"),
    (["render", "a.toml", "b.toml"], "b.toml"),
    (["render", "a.toml", "--sppp", "4"], "unknown flag --sppp; the nearest one is --spp"),
    (["render", "--sppp=4", "a.toml"], "unknown flag --sppp; the nearest one is --spp"),
    (["render", "--heigth", "4", "a.toml"], "the nearest one is --height"),
    (["render", "a.toml", "--ouput", "b.exr"], "the nearest one is --output"),
    (["render", "a.toml", "--sample", "0:4"], "unknown flag --sample; the nearest one is --samples"),
    (["render", "a.toml", "--Threads", "2"], "the nearest one is --threads"),
    (["render", "a.toml", "-T", "2"], "unknown flag -T; the nearest one is -t"),
    (["render", "a.toml", "-spp", "2"], "unknown flag -spp; the nearest one is --spp"),
    (["render", "a.toml", "--spp"], "--spp"),
    (["render", "a.toml", "--spp", "0"], "'0' is not a whole number of at least 1"),
    (["render", "a.toml", "--spp", "1e3"], "'1e3' is not a whole number"),
    (["render", "a.toml", "--seed", "-1"], "'-1' is not a whole number of at least 0"),
    (["render", "a.toml", "-t", "0"], "'0' is not a whole number of at least 1"),
    (["render", "a.toml", "--samples", "8"], "'8' is not a range A:B"),
    (["render", "a.toml", "--samples", "8:8"], "'8:8' is not a range A:B"),
    (["render", "a.toml", "--samples", "-4:8"], "--samples"),
    (["render", "a.toml", "--spp", "8", "--samples", "4:9"], "--samples 4:9 asks for more than the 8 of --spp"),
    (["render", "a.toml", "--crop", "0,1,0"], "'0,1,0' is not of the form four numbers"),
    (["render", "a.toml", "--crop", "0,1.5,0,1"], "is no part of the image"),
    (["render", "a.toml", "--crop", "0.5,0.5,0,1"], "is no part of the image"),
    (["render", "a.toml", "--crop", "0,nan,0,1"], "is no part of the image"),
    (["render", "a.toml", "--crop", "0,0.001,0,1"], "--crop asks for the pixels x 0:0"),
    (["render", "a.toml", "--pixel-bounds", "0,8,4,4"], "holds no pixel"),
    (["render", "a.toml", "--pixel-bounds", "0,201,0,9"], "--pixel-bounds asks for the pixels x 0:201"),
    (["render", "a.toml", "--crop", "0,1,0,1", "--pixel-bounds", "0,8,0,8"], "not allowed with"),
    (["render", "a.toml", "-D", "film.width"], "'film.width' is not of the form key=value"),
    (["render", "a.toml", "--progress", "xml"], "invalid choice: 'xml'"),
    (["render", "a.toml", "-o", "a.png"], "must end in .exr"),
    (["render", "a.toml", "-o", "absent/a.exr"], "there is no folder absent"),
    (["merge", "a.exr"], "-o"),
    (["merge", "-o", "c.exr"], "FILE.exr"),
    (["info"], "FILE"),
    (["info", "absent.exr"], "not an EXR"),
    (["schema", "--refrence"], "the nearest one is --reference"),
    (["verify", "--fast"], "unknown flag --fast"),
    (["doctor", "--all"], "unknown flag --all"),
]


@pytest.mark.parametrize(("arguments", "message"), WRONG, ids=[" ".join(words) for words, _ in WRONG])
def test_wrong_use_ends_with_2(
    arguments: list[str], message: str, engine: FakeEngine, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("accuray: error: ")
    assert message in captured.err
    assert "Traceback" not in captured.err
    assert engine.rendered == []


def test_wrong_use_is_told_before_the_scene_is_loaded(engine: FakeEngine) -> None:
    assert main(["render", "a.toml", "-o", "absent/a.exr"]) == 2
    assert engine.loaded == []


HEAVY = ("numpy", "OpenEXR", "OpenImageIO", "PIL", "pydantic", "rich", "scipy", "accuray._core", "difflib")


@pytest.mark.parametrize("arguments", [["--version"], ["render", "--help"], ["--help"]])
def test_the_command_starts_without_heavy_imports(arguments: list[str]) -> None:
    program = (
        "import json, sys\n"
        "from accuray.cli import main\n"
        "try: main(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        "print(json.dumps(sorted(sys.modules)))\n"
    )
    output = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=True)
    imported = json.loads(output.stdout.splitlines()[-1])
    assert [name for name in HEAVY if name in imported] == []
