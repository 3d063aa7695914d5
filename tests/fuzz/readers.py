"""The readers that Python sees: files to start from, how to damage one, what reads it and what it may raise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import accuray
from accuray import devices
from accuray.film import ImageError
from accuray.film.exr import read_rgb
from accuray.film.png_reading import read_png
from accuray.formats.merging import parse_override
from tests.fuzz import mutation, seeds
from tests.fuzz.mutation import Mutator

SMALL = {"film.width": 8, "film.height": 8}
RAYS = [[x / 4.0, y / 4.0, -1.0] for x in (-1.5, 0.0, 0.1, 1.5) for y in (-1.5, -1.0, 0.2)]


@dataclass(frozen=True)
class Reader:
    """One kind of file. ``read`` raises nothing but ``errors`` for any content."""

    suffix: str
    seeds: Callable[[], Sequence[bytes]]
    damage: Mutator
    read: Callable[[Path], Any]
    errors: tuple[type[Exception], ...] = (accuray.SceneError,)


def scene(path: Path) -> None:
    """Loads a scene or a model and looks into it along a few rays, so that all of it is lowered and much of it used."""
    loaded = accuray.load(path, SMALL, roots=[seeds.SCENES])
    accuray.radiance(loaded, [[0.0, 1.0, 4.0]] * len(RAYS), RAYS, 1, threads=1)


def part(section: str, table: dict[str, Any]) -> Callable[[Path], None]:
    """Reads the file as the `file` of an object in a scene."""

    def read(path: Path) -> None:
        loaded = accuray.Scene.from_dict({section: {"x": {**table, "file": path.name}}}, folder=path.parent)
        devices.load(loaded)

    return read


def spectrum(path: Path) -> None:
    """A CSV file as a reflectance: its only column, or the one that is named a."""
    column = {"column": "a"} if path.read_bytes().count(b",") > 4 else {}
    material = {"type": "diffuse", "reflectance": {"file": path.name, **column}}
    accuray.Scene.from_dict({"materials": {"m": material}}, folder=path.parent)


def places(path: Path) -> None:
    """A file of the transforms of instances."""
    shapes = {
        "ball": {"type": "sphere", "material": "m", "prototype": True},
        "field": {"type": "instance", "of": "ball", "instances": path.name},
    }
    description = {"materials": {"m": {"type": "diffuse"}}, "shapes": shapes}
    devices.load(accuray.Scene.from_dict(description, folder=path.parent))


def cage(path: Path) -> None:
    """A mesh file as the faces that control a subdivision surface."""
    shape = {
        "type": "mesh",
        "material": "m",
        "file": path.name,
        "subdivision": "catmull_clark",
        "subdivision_levels": 1,
    }
    description = {"materials": {"m": {"type": "diffuse"}}, "shapes": {"s": shape}}
    devices.load(accuray.Scene.from_dict(description, folder=path.parent))


def library(path: Path) -> None:
    """An MTL file, through an OBJ file that names it."""
    (path.parent / "user.obj").write_bytes(seeds.obj_with_library(path.name))
    (path.parent / "a.png").write_bytes(seeds.pictures("png")[0])
    scene(path.parent / "user.obj")


def override(path: Path) -> None:
    """A change of a scene on the command line."""
    text = path.read_bytes().decode("utf-8", "replace")
    parse_override(text)
    accuray.load(seeds.SCENES / "spheres.toml", [text])


def film(path: Path) -> None:
    """Our own EXR files, as `merge` and `info` read them."""
    accuray.Image.load(path)


TEXT_TOKENS = (
    b"nan", b"inf", b"-1", b"1e999", b"1e-320", b"0", b"4294967295", b"-2147483649", b"0x1p3", b"1,5", b"\n", b" ",
    b"\t", b"\r", b"\0", b"\xff", b"\xef\xbb\xbf", b"#", b"9" * 40,
)  # fmt: skip
TOML_TOKENS = (
    b"[", b"]", b"{", b"}", b'"', b"\'\'\'", b"=", b".", b"\\", b"true", b"1979-05-27", b'"D65"', b'"35 mm"',
    b'"../x.csv"', b"rgb = [1, 2, 3]\n", b'type = "mesh"\n', b'type = "sphere"\n', b'type = "dielectric"\n',
    b"transform = {scale = 0}\n",
)  # fmt: skip

NPY_TOKENS = (b"<f4", b">f8", b"|O", b"|V4", b"<i2", b"(", b")", b"True", b"4294967296", b"-1", b"'shape'", b"[", b"\n")

READERS: dict[str, Reader] = {
    "toml": Reader(".toml", seeds.toml_scenes, mutation.by_tokens(*TEXT_TOKENS, *TOML_TOKENS), scene),
    "json": Reader(".json", seeds.json_scenes, mutation.json_document, scene),
    "override": Reader(".txt", seeds.overrides, mutation.by_tokens(*TEXT_TOKENS, *TOML_TOKENS), override),
    "gltf": Reader(".gltf", seeds.gltf, mutation.json_document, scene),
    "glb": Reader(".glb", seeds.glb, mutation.glb, scene),
    "obj": Reader(".obj", seeds.obj, mutation.by_tokens(*TEXT_TOKENS, *seeds.OBJ_TOKENS), scene),
    "mtl": Reader(".mtl", seeds.mtl, mutation.by_tokens(*TEXT_TOKENS, *seeds.MTL_TOKENS), library),
    "ply": Reader(".ply", seeds.ply, mutation.by_tokens(*TEXT_TOKENS, *seeds.PLY_TOKENS, *mutation.WORDS), scene),
    "stl": Reader(".stl", seeds.stl, mutation.by_tokens(*TEXT_TOKENS, *seeds.STL_TOKENS, *mutation.WORDS), scene),
    "ies": Reader(
        ".ies", seeds.ies, mutation.by_tokens(*TEXT_TOKENS, b"TILT=", b"1 2 3"), part("lights", {"type": "ies"})
    ),
    "csv": Reader(".csv", seeds.csv, mutation.by_tokens(*TEXT_TOKENS, b","), spectrum),
    "cage-obj": Reader(".obj", seeds.obj_cages, mutation.by_tokens(*TEXT_TOKENS, *seeds.OBJ_TOKENS), cage),
    "cage-ply": Reader(".ply", seeds.ply, mutation.by_tokens(*TEXT_TOKENS, *seeds.PLY_TOKENS, *mutation.WORDS), cage),
    "npy": Reader(".npy", seeds.npy, mutation.by_tokens(*mutation.WORDS, *NPY_TOKENS), places),
    "rows": Reader(".csv", seeds.rows, mutation.by_tokens(*TEXT_TOKENS, b","), places),
    **{
        kind: Reader(
            f".{kind}",
            partial(seeds.pictures, kind),
            mutation.png if kind == "png" else mutation.binary,
            part("textures", {"type": "image"}),
        )
        for kind in ("png", "jpg", "exr", "hdr", "tif", "tga", "bmp")
    },
    "film": Reader(".exr", seeds.films, mutation.binary, film, (ImageError,)),
    "rgb": Reader(".exr", partial(seeds.pictures, "exr"), mutation.binary, read_rgb, (ImageError,)),
    "decoder": Reader(".png", partial(seeds.pictures, "png"), mutation.png, read_png, (ImageError,)),
}
