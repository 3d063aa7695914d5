"""The wheel of docs/packaging.md, made by the commands of that page: portable, self-contained, and it renders.

Also `pip install .` from source, and a fresh clone by `uv run` alone. Long: the module is compiled three times.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "docs/packaging.md"
RENDER = ["render", "scenes/spheres.toml", "-w", "32", "--height", "18", "--spp", "4", "-q"]

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(shutil.which("uv") is None, reason="uv is not on the PATH"),
]


def clean_environment() -> dict[str, str]:
    """The environment without what would change a fresh user's Python, and without this one's `.venv`."""
    leave_out = {"PYTHONDONTWRITEBYTECODE", "PYTHONPATH", "VIRTUAL_ENV", "UV_PROJECT_ENVIRONMENT"}
    environment = {name: value for name, value in os.environ.items() if name not in leave_out}
    own = str(Path(sys.executable).parent)
    environment["PATH"] = os.pathsep.join(part for part in os.environ["PATH"].split(os.pathsep) if part != own)
    return environment


def run(command: str | list[str], folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Runs a command, in a shell if it is one line of text; fails with what it printed."""
    done = subprocess.run(
        command,
        shell=isinstance(command, str),
        cwd=folder,
        env=clean_environment() | more,
        capture_output=True,
        text=True,
        check=False,
        timeout=1800,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
    return done


def copy_of_the_sources(folder: Path) -> Path:
    """The files that git knows or would add, in a folder of their own: a clone with what is not committed yet."""
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listing, cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout.split("\0")
    for name in filter(None, names):
        if (REPOSITORY / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / name, folder / name)
    return folder


def page_commands() -> list[str]:
    """The commands of the page, without comments."""
    found = re.findall(r"^```sh\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    return [line for block in found for line in block.splitlines()]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A copy of the sources in which the commands of the page have run, but for the last, which renders at length."""
    folder = copy_of_the_sources(tmp_path_factory.mktemp("wheel") / "clone")
    *commands, render = page_commands()
    assert render.startswith("elsewhere/bin/accuray render")
    for command in commands:
        run(command, folder)
    yield folder
    shutil.rmtree(folder)


@pytest.fixture(scope="module")
def wheel(built: Path) -> Path:
    """The repaired wheel."""
    (found,) = (built / "dist/repaired").glob("*.whl")
    return found


def test_the_wheel_is_for_every_python_from_3_11(wheel: Path) -> None:
    assert re.fullmatch(r"accuray-[\d.]+-cp311-abi3-manylinux_2_\d+_x86_64\.whl", wheel.name)


def test_the_wheel_holds_its_own_embree_and_tbb(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    for library in ("libembree", "libtbb"):
        assert [name for name in names if name.startswith(f"accuray.libs/{library}")], library
    assert "accuray/data/cie1931_2deg_1nm.csv" in names
    assert not [name for name in names if name.endswith(".pyc") or "/tests/" in name]


def test_the_installed_command_renders_with_its_own_libraries(built: Path, tmp_path: Path) -> None:
    (tmp_path / "scenes").symlink_to(REPOSITORY / "scenes")
    done = run([str(built / "elsewhere/bin/accuray"), *RENDER, "-o", "a.exr"], tmp_path, LD_DEBUG="files")
    assert (tmp_path / "a.exr").exists()
    loaded = re.findall(r"calling init: (\S*lib(?:embree|tbb)\S*)", done.stderr)
    assert len(loaded) >= 2
    assert all("accuray.libs" in name for name in loaded), loaded


def test_the_wheel_and_this_build_give_the_same_bits(built: Path, tmp_path: Path) -> None:
    accuray = pytest.importorskip("accuray")
    (tmp_path / "scenes").symlink_to(REPOSITORY / "scenes")
    run([str(built / "elsewhere/bin/accuray"), *RENDER, "-o", "a.exr"], tmp_path)
    scene = accuray.load(REPOSITORY / "scenes/spheres.toml", overrides={"film.width": 32, "film.height": 18})
    assert accuray.Image.load(tmp_path / "a.exr").film.identical(accuray.render(scene, spp=4).film)


def test_pip_installs_from_source(tmp_path: Path) -> None:
    folder = copy_of_the_sources(tmp_path / "clone")
    environment = tmp_path / "environment"
    run([sys.executable, "-m", "venv", str(environment)], tmp_path)
    run([str(environment / "bin/pip"), "install", "--quiet", "."], folder)
    (tmp_path / "scenes").symlink_to(REPOSITORY / "scenes")
    run([str(environment / "bin/accuray"), *RENDER, "-o", "a.exr"], tmp_path)
    assert (tmp_path / "a.exr").exists()


def test_a_fresh_clone_runs_by_uv_alone(tmp_path: Path) -> None:
    folder = copy_of_the_sources(tmp_path / "clone")
    assert run(["uv", "run", "--quiet", "accuray", "--version"], folder).stdout.startswith("accuray ")
