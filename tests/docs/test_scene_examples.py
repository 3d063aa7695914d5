"""Every example of docs/scene-format.md is a scene; every error that a page shows is what AccuRay says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import REPOSITORY, Block, blocks

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray

PAGE = REPOSITORY / "docs/scene-format.md"
PYRAMID = "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nv 0.5 1 -0.5\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n"
FILE_NAME = re.compile(r"# (\S+\.(?:toml|csv))\b")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the files that the page's scenes name; the page writes most of them itself."""
    (tmp_path / "pyramid.obj").write_text(PYRAMID, encoding="utf-8")
    for picture in (REPOSITORY / "scenes/textures").iterdir():
        (tmp_path / picture.name).write_bytes(picture.read_bytes())
    (tmp_path / "models").mkdir()
    (tmp_path / "models/chess.glb").write_bytes((REPOSITORY / "scenes/models/chess.glb").read_bytes())
    for block in (*blocks(PAGE, "csv"), *blocks(PAGE, "toml")):
        if name := FILE_NAME.match(block.text):
            (tmp_path / name[1]).write_text(block.text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("block", blocks(PAGE, "toml"), ids=str)
def test_example_is_a_scene(block: Block, folder: Path) -> None:
    text = block.text if "accuray = 1" in block.text else "accuray = 1\n" + block.text
    path = folder / "example.toml"
    path.write_text(text, encoding="utf-8")
    scene = accuray.load(path)
    image = accuray.render(scene, spp=4, crop=(0, 0, 8, 8))
    assert image.film.dropped_total == 0


def test_examples_cover_every_section() -> None:
    text = "".join(block.text for block in blocks(PAGE, "toml"))
    for section in ("film", "camera", "models", "spectra", "textures", "materials", "lights", "shapes"):
        assert re.search(rf"^\[{section}\b", text, re.MULTILINE), section


def test_the_error_of_the_readme_is_what_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    lines = ["accuray = 1", "[materials.floor]", 'type = "diffuse"', "reflectance = 1.7", ""]
    Path("room.toml").write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(accuray.SceneError) as caught:
        accuray.load("room.toml")
    shown = blocks(REPOSITORY / "README.md", "text")[0].text
    assert shown == f"accuray: error: {caught.value}\n"
