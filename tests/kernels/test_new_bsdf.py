"""A new BSDF touches one header and one list: shown with one that lives in the tests only.

The engine is built once more with `overlay/kernels/bsdf/retroreflector.h` and with a copy of the renderer's own list to
which the test adds the header and the word. Nothing else changes, and everything that reads the lists must know it. The
build stays in `build/overlay`, so that later runs compile only what changed.
"""

from __future__ import annotations

import fcntl
import json
import os
import re
import shutil
import sys
import sysconfig
from pathlib import Path

import pytest

from tests.commands import REPOSITORY, run
from tests.kernels.nvrtc import compile_kernel

BUILD = REPOSITORY / "build" / "overlay"
HEADER = Path(__file__).parent / "overlay" / "kernels" / "bsdf" / "retroreflector.h"
LIST = "kernels/bsdf/list.h"
NAME, WORD = "retroreflector", "Retroreflector"


def overlay() -> dict[str, str]:
    """The new header, and the list with one more line and one more word, by the names they are included by."""
    text = (REPOSITORY / "src" / LIST).read_text(encoding="utf-8")
    text, lines = re.subn(
        r'(#include "kernels/bsdf/diffuse\.h"\n)', rf'\1#include "kernels/bsdf/{HEADER.name}"\n', text
    )
    text, words = re.subn(r"(using Bsdfs = TypeList<[^>]*)>", rf"\1, {WORD}>", text)
    assert (lines, words) == (1, 1), f"{LIST} no longer looks as this test knows it"
    return {f"kernels/bsdf/{HEADER.name}": HEADER.read_text(encoding="utf-8"), LIST: text}


def write_if_changed(path: Path, text: str) -> None:
    """Leaves an unchanged file its time, so that nothing is compiled again."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def build_module() -> Path:
    """The engine with the overlay: its compiled module."""
    include, cmake = BUILD / "include", BUILD / "cmake"
    for name, text in overlay().items():
        write_if_changed(include / name, text)
    nanobind = run(sys.executable, "-m", "nanobind", "--cmake_dir").strip()
    run(
        "cmake", "-S", ".", "-B", str(cmake), "-G", "Ninja", f"-DACCURAY_OVERLAY={include}", "-DSKBUILD=2",
        "-DSKBUILD_SABI_COMPONENT=Development.SABIModule", f"-Dnanobind_DIR={nanobind}",
        f"-DPython_EXECUTABLE={sys.executable}",
    )  # fmt: skip
    run("cmake", "--build", str(cmake), "--target", "_core", "--parallel", "2")
    return next(cmake.glob("_core*.so"))


@pytest.fixture(scope="module")
def package() -> Path:
    """A folder with the package `accuray`, all of it the repository's but for the compiled module."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        module = build_module()
        folder = BUILD / "package"
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "accuray").mkdir(parents=True)
        for entry in (REPOSITORY / "accuray").iterdir():
            if not entry.name.startswith(("_core", "__pycache__")):
                (folder / "accuray" / entry.name).symlink_to(entry)
        shutil.copy2(module, folder / "accuray")
    return folder


def python(package: Path, *arguments: str) -> str:
    """Runs Python with that package: without site, because an editable installation would come first."""
    paths = [str(package), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")]
    environment = {"PYTHONPATH": os.pathsep.join(paths), "PYTHONDONTWRITEBYTECODE": "1"}
    return run(sys.executable, "-S", "-P", *arguments, env=environment)


def scene(tmp_path: Path, material: str) -> Path:
    """A lit ball of the material, in a file."""
    path = tmp_path / "ball.toml"
    path.write_text(
        f"""accuray = 1
[film]
width = 24
height = 24
[materials.paint]
{material}
[shapes.ball]
type = "sphere"
material = "paint"
[lights.sky]
type = "constant"
"""
    )
    return path


def test_it_validates(package: Path, tmp_path: Path) -> None:
    path = scene(tmp_path, 'type = "retroreflector"\nexponent = 5.0')
    program = "import sys, json, accuray; print(json.dumps(accuray.load(sys.argv[1]).materials['paint'], default=str))"
    values = json.loads(python(package, "-c", program, str(path)))
    assert values["type"] == NAME
    assert values["exponent"] == 5.0
    assert "0.5" in values["reflectance"], "the default of its table"


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ('type = "retroreflector"\nexponent = 101', "out of range: allowed 0 to 100"),
        ('type = "retroreflector"\nexponant = 5', "exponent"),
        ('type = "retroreflecter"', "retroreflector"),
    ],
)
def test_its_mistakes_are_named(package: Path, tmp_path: Path, material: str, message: str) -> None:
    path = scene(tmp_path, material)
    program = "import sys, accuray\ntry: accuray.load(sys.argv[1])\nexcept accuray.SceneError as error: print(error)"
    assert message in python(package, "-c", program, str(path))


def test_it_renders(package: Path, tmp_path: Path) -> None:
    """By the command; in a furnace the ball shows the lobe's albedo: 1 in the middle, where light meets it straight."""
    path = scene(tmp_path, 'type = "retroreflector"\nreflectance = 1.0')
    out = tmp_path / "ball.exr"
    python(package, "-m", "accuray", "render", str(path), "-o", str(out), "--spp", "64", "-q")
    program = (
        "import sys, json, numpy, accuray; image = numpy.asarray(accuray.Image.load(sys.argv[1]));"
        "print(json.dumps([float(image[11:13, 11:13].mean()), float(image[0, 0].mean()), float(image.max())]))"
    )
    middle, corner, largest = json.loads(python(package, "-c", program, str(out)))
    assert middle == pytest.approx(corner, rel=0.05)
    assert largest < 1.5 * corner


def test_every_integrator_agrees_on_it(package: Path) -> None:
    """The radiance of a lit point by path, direct and reference, and by either strategy alone."""
    program = """
import json, accuray
def measure(integrator):
    scene = accuray.Scene.from_dict({"accuray": 1, "integrator": integrator,
        "materials": {"sign": {"type": "retroreflector", "reflectance": 0.9, "exponent": 3},
                      "lamp": {"type": "diffuse", "reflectance": 0, "emission": 1}},
        "shapes": {"wall": {"type": "disk", "normal": [0, 1, 0], "radius": 2, "material": "sign"},
                   "lamp": {"type": "disk", "center": [0.5, 1, 0], "normal": [0, -1, 0], "material": "lamp"}}})
    found = accuray.radiance(scene, [[1.0, 0.5, 0.2]], [[-1, -0.5, -0.1]], 200000, space="xyz")
    return [float(found.mean[0, 1]), float(found.error[0, 1])]
kinds = [{"type": "path"}, {"type": "path", "strategy": "light"}, {"type": "path", "strategy": "bsdf"},
         {"type": "direct"}, {"type": "reference"}]
print(json.dumps([measure(kind) for kind in kinds]))
"""
    results = json.loads(python(package, "-c", program))
    truth = results[0][0]
    assert truth > 0.1
    for mean, error in results:
        assert error < 0.01 * truth
        assert abs(mean - truth) < 6.0 * (error + results[0][1])  # errors of 3 degrees of freedom each


def test_it_appears_in_schema_and_reference(package: Path) -> None:
    text = python(package, "-m", "accuray", "schema")
    assert NAME in text
    assert "Power of the cosine: the larger, the narrower." in text
    assert json.loads(text)["$schema"]
    reference = python(package, "-m", "accuray", "schema", "--reference")
    assert NAME in reference
    assert "Sends light back to where it came from." in reference
    assert NAME not in run(sys.executable, "-m", "accuray", "schema"), "the renderer itself does not have it"


def test_it_passes_the_tests_of_the_list(package: Path) -> None:
    paths = f"pythonpath={package} {REPOSITORY} {REPOSITORY / 'tests'}"
    arguments = ["-m", "pytest", "-q", "-o", paths, "tests/kernels/test_bsdf_list.py", "-k", NAME]
    output = python(package, *arguments)
    passed = re.search(r"(\d+) passed", output)
    assert passed is not None, output
    assert int(passed.group(1)) >= 15, output
    assert "failed" not in output


#: A sample of the new BSDF: all that is new in the kernel which reaches everything (test_nvrtc.py).
KERNEL = f"""
#include "kernels/bsdf/list.h"

static_assert(accuray::tag_of<accuray::{WORD}>(accuray::Bsdfs{{}}) < accuray::Bsdfs::size);

extern "C" __global__ void sample_bsdf(const unsigned char* const* sections, accuray::Tagged bsdf,
                                       accuray::Wavelengths wl, accuray::Vec3 wo, accuray::BsdfSample* out) {{
  using namespace accuray;
  const SceneView scene = SceneView::of(sections);
  const ShadingPoint p{{scene, wl, TexturePoint{{}}, lanes(1.0f)}};
  *out = scene.as<{WORD}>(bsdf).at(p).sample(wo, 0.5f, {{0.25f, 0.75f}});
}}
"""


def test_it_is_device_code() -> None:
    """It stands in the list, and a kernel that samples it builds."""
    build = compile_kernel(KERNEL, overlay())
    assert build.cubin.startswith(b"\x7fELF")
    assert 0 <= build.stack <= 1024
