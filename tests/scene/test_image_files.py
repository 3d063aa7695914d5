"""Image files as textures: every stored type, and files that are broken, lie about their size or lead elsewhere."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("OpenImageIO", reason="OpenImageIO is not installed")
import OpenImageIO as oiio  # noqa: N813

from accuray.formats import Scene
from accuray.scene import SceneError
from accuray.scene.images import MAX_SIDE

MUTATIONS = 140
SCRIPT = Path(__file__).with_name("image_mutations.py")


def texture(folder: Path, name: str, **more: Any) -> dict[str, Any]:
    """The resolved texture of a file."""
    table = {"type": "image", "file": name, **more}
    return Scene.from_dict({"textures": {"t": table}}, folder=folder).textures["t"]


def write(path: Path, pixels: NDArray[Any], kind: str, **attributes: Any) -> None:
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    for key, value in attributes.items():
        spec.attribute(key, value)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    assert output.write_image(pixels), output.geterror()
    assert output.close(), output.geterror()


@pytest.mark.parametrize(
    ("suffix", "kind", "expected"),
    [
        ("png", "uint8", "uint8"),
        ("png", "uint16", "uint16"),
        ("tif", "uint8", "uint8"),
        ("tif", "uint16", "uint16"),
        ("tif", "float", "float32"),
        ("tif", "double", "float32"),
        ("exr", "half", "float16"),
        ("exr", "float", "float32"),
        ("bmp", "uint8", "uint8"),
        ("tga", "uint8", "uint8"),
    ],
)
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_every_stored_type_comes_back_as_it_is(
    suffix: str, kind: str, expected: str, channels: int, tmp_path: Path
) -> None:
    rng = np.random.default_rng(3)
    if expected.startswith("uint"):
        pixels = rng.integers(0, np.iinfo(expected).max, (6, 9, channels), dtype=expected, endpoint=True)
    else:
        pixels = rng.uniform(0.0, 4.0, (6, 9, channels)).astype(expected)
    given = pixels.astype(np.float32) if kind in ("double", "half") else pixels
    unassociated = {"oiio:UnassociatedAlpha": 1} if suffix in ("png", "tif", "tga") else {}
    write(tmp_path / f"p.{suffix}", given, kind, **unassociated)
    found = texture(tmp_path, f"p.{suffix}")["pixels"]
    if suffix == "bmp" and channels == 1:
        found = found[..., :1]
    assert found.dtype.name == expected
    assert np.array_equal(found, pixels)


def test_photographs_and_radiance_files_are_read(tmp_path: Path) -> None:
    pixels = np.full((8, 8, 3), 0.5, dtype=np.float32)
    write(tmp_path / "p.jpg", pixels, "uint8")
    write(tmp_path / "p.hdr", pixels, "float")
    assert texture(tmp_path, "p.jpg")["pixels"].dtype == np.uint8
    hdr = texture(tmp_path, "p.hdr")
    assert hdr["color_space"] == "linear"
    assert np.allclose(hdr["pixels"], 0.5, rtol=0.01)


@pytest.mark.parametrize("suffix", ["png", "jpg", "exr", "hdr", "tif"])
def test_damaged_files_load_or_are_refused(suffix: str, tmp_path: Path) -> None:
    """140 mutations of each format in one process: none ends it, and none takes long."""
    result = subprocess.run(
        [sys.executable, str(SCRIPT), str(tmp_path), suffix, str(MUTATIONS)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    reached = (tmp_path / "current").read_text()
    assert result.returncode == 0, f"mutation {reached}: {result.returncode}\n{result.stderr[-2000:]}"
    found = json.loads(result.stdout)
    assert found["loaded"] + found["refused"] == MUTATIONS
    assert found["refused"] >= MUTATIONS // 4, found
    assert found["longest"] < 2000


@pytest.mark.parametrize("suffix", ["png", "jpg", "exr", "hdr", "tif", "tga", "bmp"])
def test_a_truncated_file_is_refused(suffix: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    write(tmp_path / f"p.{suffix}", rng.random((64, 64, 3), dtype=np.float32), "uint8")
    content = (tmp_path / f"p.{suffix}").read_bytes()
    for share in (0.02, 0.5, 0.9):
        (tmp_path / f"p.{suffix}").write_bytes(content[: int(share * len(content))])
        with pytest.raises(SceneError, match=r"textures.t.file: .*cannot be read"):
            texture(tmp_path, f"p.{suffix}")


def png_claiming(width: int, height: int) -> bytes:
    """A PNG of 16-bit RGBA with a header that is right in all but the amount of data."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 16, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(100))) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(("x.png", png_claiming(300_000, 300_000)), id="png-90-gigapixels"),
        pytest.param(("x.png", png_claiming(MAX_SIDE + 1, 1)), id="png-long"),
        pytest.param(("x.png", png_claiming(30_000, 30_000)), id="png-too-many-bytes"),
        pytest.param(
            ("x.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 400000 +X 400000\n"), id="hdr-160-gigapixels"
        ),
        pytest.param(("x.pfm", b"PF\n500000 500000\n-1.0\n"), id="pfm-250-gigapixels"),
    ],
)
def test_a_claim_beyond_the_limits_is_refused_unread(content: tuple[str, bytes], tmp_path: Path) -> None:
    (tmp_path / content[0]).write_bytes(content[1])
    with pytest.raises(SceneError, match=r"textures.t.file: .*cannot be read"):
        texture(tmp_path, content[0])


@pytest.mark.parametrize(
    ("name", "complaint"),
    [
        ("../outside.png", "leads outside"),
        ("/etc/hostname", "leads outside"),
        ("link.png", "leads outside"),
        ("missing.png", "does not exist"),
        ("folder", "is a folder"),
        ("notes.txt", "cannot be read"),
        ("empty.png", "cannot be read"),
        (17, "is not a file name"),
    ],
)
def test_a_file_that_is_no_picture_of_this_scene_is_refused(name: Any, complaint: str, tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    (folder / "folder").mkdir(parents=True)
    write(tmp_path / "outside.png", np.zeros((2, 2, 3), dtype=np.uint8), "uint8")
    (folder / "link.png").symlink_to(tmp_path / "outside.png")
    (folder / "notes.txt").write_text("not a picture")
    (folder / "empty.png").write_bytes(b"")
    with pytest.raises(SceneError, match=complaint):
        texture(folder, name)


def test_texels_that_are_not_finite_are_refused_and_named(tmp_path: Path) -> None:
    pixels = np.ones((3, 4, 3), dtype=np.float32)
    pixels[2, 1, 0] = np.nan
    write(tmp_path / "p.exr", pixels, "float")
    with pytest.raises(SceneError, match=r"not a finite number: row 2, column 1, channel 0"):
        texture(tmp_path, "p.exr")


def test_start_up_does_not_import_the_library() -> None:
    code = "import sys, accuray; accuray.Scene.from_dict({}); sys.exit('OpenImageIO' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=60).returncode == 0
