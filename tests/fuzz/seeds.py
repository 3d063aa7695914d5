"""Small whole files of every kind that is read, to be damaged: each uses many features of its format."""

from __future__ import annotations

import io
import json
import struct
import tempfile
import tomllib
from functools import cache
from pathlib import Path

import numpy as np

import accuray
from tests.ies_files import ies_text
from tests.models.model_files import every_feature

REPOSITORY = Path(__file__).resolve().parents[2]
SCENES = REPOSITORY / "scenes"

OBJ_TOKENS = (
    b"f ", b"v ", b"vt ", b"vn ", b"usemtl a\n", b"mtllib ", b"s 1\n", b"s off\n", b"\\\n", b"/", b"//", b"-9",
)  # fmt: skip
MTL_TOKENS = (b"newmtl m\n", b"map_Kd ", b"-s ", b"-bm ", b"illum 7\n", b"Pr ", b"Tf ", b"d ", b"norm ", b"-imfchan m ")
PLY_TOKENS = (b"double ", b"list ", b"uchar ", b"element vertex 3\n", b"property int k\n", b"end_header\n", b"comment ")
STL_TOKENS = (b"solid", b"endsolid\n", b"facet normal ", b"outer loop\n", b"vertex ", b"endloop\n", b"endfacet\n")

TOML = """accuray = 1
length_unit = "cm"
include = []
[film]
width = 8
height = 6
filter = { type = "gaussian" }
[camera]
type = "perspective"
position = [0, 1, "4 m"]
look_at = [0, 0, 0]
focal_length = "35 mm"
film_size = "24 mm"
f_number = 2.8
focus_distance = "3 m"
[textures.checks]
type = "checker"
[materials.floor]
type = "diffuse"
reflectance = { texture = "checks" }
[materials.glass]
type = "dielectric"
ior = "N-BK7"
[materials.metal]
type = "conductor"
metal = "Cu"
roughness = 0.2
[materials.lamp]
type = "diffuse"
reflectance = { rgb = [0.1, 0.2, 0.3] }
emission = { blackbody = "2700 K", flux = "800 lm" }
[shapes.plate]
type = "mesh"
material = "floor"
positions = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]
faces = [[0, 1, 2, 3]]
uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
[shapes.ball]
type = "sphere"
radius = "5 mm"
material = "glass"
prototype = true
[shapes.copy]
type = "instance"
of = ["ball"]
transform = [{ scale = 2 }, { rotate = { axis = [0, 1, 0], angle = 30 } }, { translate = [0, 1, 0] }]
[shapes.lamp]
type = "disk"
center = [0, 2, 0]
normal = [0, -1, 0]
material = "lamp"
[lights.sky]
type = "constant"
radiance = { wavelengths = [400, 550, 700], values = [1, 0.5, 0.2] }
[lights.point]
type = "point"
position = [1, 2, 1]
intensity = "100 cd"
"""

MOVING = """accuray = 1
[film]
width = 8
height = 6
[animation]
fps = 25
frame = 10
shutter_open = "-10 ms"
shutter_close = "10 ms"
shutter_shape = "trapezoid"
shutter_ramp = 0.2
[camera]
type = "perspective"
position = [0, 1, 4]
look_at = [0, 0, 0]
fov = { keys = [{ time = 0, value = "40 deg" }, { time = "1 s", value = "50 deg" }], interpolation = "smooth" }
[textures.bumps]
type = "noise"
[materials.matte]
type = "diffuse"
[shapes.stone]
type = "mesh"
material = "matte"
subdivision = "catmull_clark"
subdivision_levels = 1
displacement = "bumps"
displacement_scale = 0.1
creases = [[0, 1, 2.5]]
positions = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1], [0, 1, 0]]
faces = [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
[shapes.flap]
type = "mesh"
material = "matte"
faces = [[0, 1, 2]]
positions = { keys = [
  { time = 0, value = [[0, 2, 0], [1, 2, 0], [1, 3, 0]] },
  { time = 1, value = [[0, 2, 0], [1, 2, 0], [1, 3, 1]] },
] }
[shapes.ball]
type = "sphere"
radius = 0.2
material = "matte"
transform = { keys = [
  { time = 0, rotate = { axis = [0, 1, 0], angle = 0 } },
  { time = 1, translate = [1, 1, 0], rotate = { axis = [0, 1, 0], angle = 720 } },
] }
[lights.sky]
type = "constant"
radiance = 1
"""

OBJ = (
    "# text\nmtllib a.mtl\nv 0 0 0 1 0.5 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0.5 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
    "vn 0 0 1\ns 1\nusemtl a b\nf 1/1/1 2/2/1 3/3/1 4/1/1\nusemtl b\ns off\nf -4 -3 \\\n-2\no name\ng part\nl 1 2\n"
)
MTL = (
    "# text\nnewmtl m\nKd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nKe 0 0 0\nNs 96.5\nNi 1.45\nd 0.9\nillum 2\n"
    "map_Kd -s 2 2 -clamp on a.png\nmap_Bump -bm 0.5 a.png\nPr 0.3\nPm 0.1\nnewmtl n\nTr 0.5\nillum 7\n"
)
PLY_HEADER = (
    "ply\nformat {} 1.0\ncomment text\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty float weight\nend_header\n"
)
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.5))


def toml_scenes() -> list[bytes]:
    """Scene files in TOML."""
    return [
        TOML.encode(),
        *((SCENES / f"{name}.toml").read_bytes() for name in ("spheres", "coated", "textured-light")),
    ]


def json_scenes() -> list[bytes]:
    """The same in JSON."""
    return [json.dumps(tomllib.loads(text.decode())).encode() for text in toml_scenes()[:2]]


def overrides() -> list[bytes]:
    """What may follow -D."""
    return [b"film.width=64", b"camera.\"fov\"='40 deg'", b"camera.type=orthographic"]


def gltf() -> list[bytes]:
    """A glTF file of every feature."""
    return [every_feature().text().encode()]


def glb() -> list[bytes]:
    """The same as GLB."""
    return [every_feature().glb()]


def obj() -> list[bytes]:
    """An OBJ file with and one without colours."""
    return [OBJ.encode(), b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 3 2 1\n"]


def obj_cages() -> list[bytes]:
    """An open and a closed surface of polygons with and without uvs."""
    pyramid = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 1 0\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"
    return [OBJ.encode(), pyramid.encode()]


def mtl() -> list[bytes]:
    """An MTL file."""
    return [MTL.encode()]


def obj_with_library(name: str) -> bytes:
    """A square of two materials of an MTL file."""
    vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    return f"mtllib {name}\n{vertices}usemtl m\nf 1/1 2/2 3/3 4/4\nusemtl n\nf 1/1 2/2 3/3\n".encode()


def ply() -> list[bytes]:
    """PLY files in text and in both orders of bytes."""
    text = "".join(f"{x} {y} {z} 255 128 {i}\n" for i, (x, y, z) in enumerate(CORNERS)) + "4 0 1 2 3 0.5\n3 0 1 2 1\n"
    files = [(PLY_HEADER.format("ascii") + text).encode()]
    for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        rows = b"".join(struct.pack(order + "3f3B", *corner, 255, 128, i) for i, corner in enumerate(CORNERS))
        rows += struct.pack(order + "B4if", 4, 0, 1, 2, 3, 0.5) + struct.pack(order + "B3if", 3, 0, 1, 2, 1.0)
        files.append(PLY_HEADER.format(name).encode() + rows)
    return files


def stl() -> list[bytes]:
    """STL files, binary and as text."""
    triangles = [(CORNERS[0], CORNERS[1], CORNERS[2]), (CORNERS[0], CORNERS[2], CORNERS[3])]
    rows = b"".join(struct.pack("<12fH", 0, 0, 1, *a, *b, *c, 0) for a, b, c in triangles)
    text = "solid name\n"
    for triangle in triangles:
        corners = "".join(f"vertex {x} {y} {z}\n" for x, y, z in triangle)
        text += f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n"
    return [b"\0" * 80 + struct.pack("<I", 2) + rows, (text + "endsolid name\n").encode()]


def ies() -> list[bytes]:
    """Luminaires of two years, with and without a table of tilts."""
    angles = [0.0, 45.0, 90.0]
    new = ies_text(angles, [0.0, 90.0, 180.0], lambda a, b: 100.0 + a + b)
    old = ies_text(angles, [0.0], lambda a, b: 50.0 - a / 3, first="IESNA91", tilt="TILT=INCLUDE\n1 2 0 90 1 1")
    return [new.encode(), old.encode()]


def csv() -> list[bytes]:
    """Measured spectra of one column and of two."""
    return [b"# text\nnm,a\n400,0.1\n500,0.5\n700.5,1e-1\n", b"nm, a, b\n380, 1, 0.2\n390, 0.3, 0.4\n780, 0, 1\n"]


ROWS = np.stack([scale * np.eye(3, 4) + place * np.eye(4)[3] for scale, place in ((1, 0), (0.5, 2.25), (-2, 1e3))])
"""Three transforms in double precision, (3, 3, 4)."""


def npy() -> list[bytes]:
    """Transforms of instances in both orders of axes and bytes."""
    files = []
    for array in (ROWS, np.asfortranarray(ROWS.reshape(3, 12)), ROWS.astype(">f4")):
        stream = io.BytesIO()
        np.save(stream, array)
        files.append(stream.getvalue())
    return files


def rows() -> list[bytes]:
    """The same as text."""
    lines = "\n".join(",".join(map(str, row)) for row in ROWS.reshape(3, 12).tolist())
    return [f"# text\na,b,c,d,e,f,g,h,i,j,k,l\n{lines}\n".encode()]


@cache
def pictures(kind: str) -> tuple[bytes, ...]:
    """Pictures of 31 x 24 texels with some structure, in types that the format holds."""
    import OpenImageIO as oiio  # noqa: N813

    rows, columns = np.mgrid[0:24, 0:31]
    pixels = np.stack([rows / 23.0, columns / 30.0, (rows * columns % 7) / 6.0], axis=-1).astype(np.float32)
    types = {"png": ("uint8", "uint16"), "exr": ("half", "float"), "hdr": ("float",), "tif": ("uint8", "uint16")}
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for type_ in types.get(kind, ("uint8",)):
            path = Path(folder, f"a.{kind}")
            output = oiio.ImageOutput.create(str(path))
            if not output.open(str(path), oiio.ImageSpec(31, 24, 3, type_)) or not output.write_image(pixels):
                raise OSError(output.geterror())
            output.close()
            found.append(path.read_bytes())
    return tuple(found)


@cache
def films() -> tuple[bytes, ...]:
    """A rendered image of ours with its state."""
    scene = accuray.Scene.from_dict({"film": {"width": 6, "height": 5}, "lights": {"sky": {"type": "constant"}}})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a.exr")
        accuray.render(scene, spp=4, seed=1).save(path)
        return (path.read_bytes(),)
