"""Files that a scene names lie below its folder or an asset root, whatever the name looks like."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray import data
from accuray.scene import SceneError, paths
from accuray.scene.errors import Document, Source, Where
from accuray.scene.paths import Confinement


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A scene folder, an asset root and a secret beside them."""
    for name in ("scene/a.csv", "scene/sub/b.csv", "root/c.csv", "secret.csv"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name, encoding="utf-8")
    return tmp_path


def resolve(tree: Path, name: object, folder: str = "scene") -> Path:
    where = Where(Document({}, Source(folder=tree / folder)), ("file",))
    return Confinement.around(tree / "scene", [tree / "root"]).resolve(name, where, [".csv"])


def test_inside(tree: Path) -> None:
    assert resolve(tree, "a.csv") == tree / "scene/a.csv"
    assert resolve(tree, "sub/../a.csv") == tree / "scene/a.csv"
    assert resolve(tree, "../a.csv", folder="scene/sub") == tree / "scene/a.csv"
    assert resolve(tree, "b.csv", folder="scene/sub") == tree / "scene/sub/b.csv"
    assert resolve(tree, "c.csv") == tree / "root/c.csv"
    assert resolve(tree, str(tree / "root/c.csv")) == tree / "root/c.csv"
    assert resolve(tree, Path("a.csv")) == tree / "scene/a.csv"
    assert resolve(tree, "builtin:cornell_box_light.csv") == data.FOLDER / "cornell_box_light.csv"


def test_roots_from_the_environment(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ACCURAY_PATH", f"{tree / 'nowhere'}{os.pathsep}{tree}")
    assert resolve(tree, "secret.csv") == tree / "secret.csv"


def test_links(tree: Path) -> None:
    (tree / "scene/in.csv").symlink_to(tree / "root/c.csv")
    (tree / "scene/out.csv").symlink_to(tree / "secret.csv")
    (tree / "scene/up").symlink_to(tree)
    (tree / "scene/loop.csv").symlink_to("loop.csv")
    assert resolve(tree, "in.csv") == tree / "root/c.csv"
    for name in ("out.csv", "up/secret.csv", "loop.csv", "up/scene/../secret.csv"):
        with pytest.raises(SceneError):
            resolve(tree, name)


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", "/", "../secret.csv", "sub/../../secret.csv", "/dev/zero", "/dev/null", "~/x.csv", "~root/x.csv",
     "http://localhost/a.csv", "file:///etc/passwd", "FILE:a.csv", "a.csv\0", "a\n.csv", "\\\\?\\a.csv", "x" * 4096,
     "builtin:", "builtin:../scene/__init__.py", "builtin:README.md", "builtin:/etc/passwd", "missing.csv", "sub", None,
     3, b"a.csv", ["a.csv"], "/proc/self/environ", "a.csv/../../secret.csv"],
)  # fmt: skip
def test_refused(tree: Path, name: object) -> None:
    with pytest.raises(SceneError):
        resolve(tree, name)


def test_size_limit(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(paths.MAX_BYTES, ".csv", 3)
    with pytest.raises(SceneError, match="too large"):
        resolve(tree, "a.csv")


_PARTS = st.sampled_from(
    ["..", ".", "", "scene", "root", "sub", "up", "a.csv", "secret.csv", "~", "\0", "x:", "\\", "%2e%2e"]
)


@STEADY
@given(names=st.lists(st.lists(_PARTS, min_size=1, max_size=7).map("/".join), min_size=20, max_size=20))
def test_no_generated_path_escapes(tmp_path_factory: pytest.TempPathFactory, names: list[str]) -> None:
    base = tmp_path_factory.getbasetemp() / "escape"
    for name in ("scene/a.csv", "scene/sub/secret.csv", "secret.csv"):
        (base / name).parent.mkdir(parents=True, exist_ok=True)
        (base / name).write_text("x", encoding="utf-8")
    if not (base / "scene/up").is_symlink():
        (base / "scene/up").symlink_to(base)
    where = Where(Document({}, Source(folder=base / "scene")), ("file",))
    for name in names:
        try:
            found = Confinement.around(base / "scene").resolve(name, where)
        except SceneError:
            continue
        assert found.resolve().is_relative_to(base / "scene")
