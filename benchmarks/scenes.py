"""The benchmark scenes, described once and written for every renderer: PLY meshes, ``scene.json``, ``scene.toml``.

``scene.json`` is the neutral form that the peers' drivers read: camera, materials with a measured spectrum and the
linear Rec.709 colour of it, meshes. ``scene.toml`` is AccuRay's own form of the same scene.
"""

import argparse
import csv
import json
import math
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks import settings
from benchmarks.geometry import Mesh, bumpy_sphere, carpet, frame_around, quad_mesh, widened, write_ply

DATA = Path(__file__).parents[1] / "accuray" / "data"
MILLIMETRE = 0.001
INLINE_TRIANGLES = 1000

SCENES = ("cornell", "million", "glossy", "frosted", "room")
"""The Cornell box; the box with, in place of the blocks, a sphere of a million triangles, one of rough metal over a
textured floor, one of rough glass; the box with nothing in it."""

BRICKS = Path(__file__).parents[1] / "scenes" / "textures" / "bricks.png"
BRICK_REPEATS = 2
LAMP_WIDENING = 2.6
"""The lamp of those two is so much wider: no path tracer finds the caustics of a small one soon, and a few bright
paths would decide the comparison."""

RGB = {
    "white": (0.738376, 0.735961, 0.738503),
    "green": (0.068429, 0.398447, 0.086546),
    "red": (0.493966, 0.048867, 0.051152),
    "lamp": (0.78, 0.78, 0.78),
    "emission": (20.720144, 10.854298, 2.770084),
}
"""Linear Rec.709, CIE 1931 observer: reflectances under D65; the lamp's radiance with Y = integral(L ybar) /
integral(ybar), the lamp being dark outside 400-700 nm."""

LAMP_REFLECTANCE = 0.78
VISIBLE = (360.0, 830.0)


@dataclass(frozen=True)
class Spectrum:
    """Samples at wavelengths in nm, linear between them, and the RGB that stands for it in RGB renderers."""

    wavelengths: tuple[float, ...]
    values: tuple[float, ...]
    rgb: tuple[float, float, float]


@dataclass(frozen=True)
class Material:
    """What a surface is made of: ``kind`` is diffuse, conductor or dielectric.

    A diffuse one has a reflectance or the name of a picture in sRGB that is repeated over the surface; the others have
    ``eta`` and ``k``, the same for all wavelengths, and GGX facets of this perceived roughness (alpha is its square),
    which lose what they scatter more than once: the one model that all renderers have.
    """

    kind: str = "diffuse"
    reflectance: Spectrum | None = None
    picture: str = ""
    eta: float = 1.0
    k: float = 0.0
    roughness: float = 0.0


@dataclass(frozen=True)
class Scene:
    """Meshes in metres and what they are made of. Reflectances cover 360-830 nm; emission ends with its table."""

    name: str
    meshes: tuple[Mesh, ...]
    materials: dict[str, Material]
    emission: Spectrum
    emitter: str
    camera: dict[str, Any]


def build(name: str) -> Scene:
    """One of ``SCENES``."""
    if name not in SCENES:
        raise ValueError(f"unknown scene {name!r}: allowed {', '.join(SCENES)}")
    page = json.loads((DATA / "cornell_box_geometry.json").read_text())
    surfaces = page["surfaces"]
    ceiling = surfaces["ceiling"]
    white = [quad for part in ("floor", "back_wall") for quad in surfaces[part]["quads"]]
    widening = LAMP_WIDENING if name in ("glossy", "frosted") else 1.0
    lamp_quads = [widened(quad, widening) for quad in surfaces["light"]["quads"]]
    white += frame_around(ceiling["quads"][0], widened(ceiling["hole_for_light"], widening))
    if name == "cornell":
        white += surfaces["short_block"]["quads"] + surfaces["tall_block"]["quads"]
    meshes = [
        quad_mesh("white", "white", white, MILLIMETRE),
        quad_mesh("red", "red", surfaces["left_wall"]["quads"], MILLIMETRE),
        quad_mesh("green", "green", surfaces["right_wall"]["quads"], MILLIMETRE),
        quad_mesh("lamp", "lamp", lamp_quads, MILLIMETRE),
    ]
    columns = _read_columns(DATA / "cornell_box_reflectance.csv")
    materials = {
        paint: Material(reflectance=_hold(Spectrum(columns["wavelength_nm"], columns[paint], RGB[paint])))
        for paint in ("white", "red", "green")
    }
    lamp = Spectrum(VISIBLE, (LAMP_REFLECTANCE, LAMP_REFLECTANCE), RGB["lamp"])
    materials["lamp"] = Material(reflectance=lamp)
    if name in SPHERES:
        size, material = SPHERES[name]
        materials["sphere"] = material or materials["white"]
        meshes.append(bumpy_sphere("sphere", "sphere", (0.278, 0.2, 0.28), 0.16, *size))
    if name == "glossy":
        materials["bricks"] = Material(picture=BRICKS.name)
        meshes.append(carpet("bricks", "bricks", (0.03, 0.0005, 0.53), 0.5, BRICK_REPEATS))
    light = _read_columns(DATA / "cornell_box_light.csv")
    emission = Spectrum(light["wavelength_nm"], light["relative_radiance"], RGB["emission"])
    return Scene(name, tuple(meshes), materials, emission, "lamp", _camera(page["camera"]))


SPHERES = {
    "million": ((settings.MILLION_SEGMENTS, settings.MILLION_RINGS), None),
    "glossy": ((settings.SEGMENTS, settings.RINGS), Material("conductor", eta=0.2, k=3.9, roughness=0.35)),
    "frosted": ((settings.SEGMENTS, settings.RINGS), Material("dielectric", eta=1.5, roughness=0.4)),
}
"""Segments and rings of the sphere in the box, and its material; None is the white of the walls."""


def _hold(spectrum: Spectrum) -> Spectrum:
    """Continue a table of even steps with its end values over the visible range, in the same steps.

    Every renderer then sees the same reflectance there, and Mitsuba its faster, evenly spaced kind of table.
    """
    first, last = spectrum.wavelengths[0], spectrum.wavelengths[-1]
    step = spectrum.wavelengths[1] - first
    before, after = math.ceil((first - VISIBLE[0]) / step), math.ceil((VISIBLE[1] - last) / step)
    wavelengths = tuple(first + step * k for k in range(-before, len(spectrum.values) + after))
    values = (spectrum.values[0],) * before + spectrum.values + (spectrum.values[-1],) * after
    return Spectrum(wavelengths, values, spectrum.rgb)


def _camera(camera: dict[str, Any]) -> dict[str, Any]:
    """Eye, point looked at, up, and the full field of view of the square film in degrees."""
    eye = [value * MILLIMETRE for value in camera["position"]]
    target = [a + b for a, b in zip(eye, camera["direction"], strict=True)]
    return {"position": eye, "look_at": target, "up": camera["up"], "fov": camera["derived_full_fov_deg"]}


def _read_columns(path: Path) -> dict[str, tuple[float, ...]]:
    """Columns of a CSV file whose lines starting with ``#`` are remarks and whose first other line names them."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: tuple(float(row[name]) for row in rows) for name in rows[0]}


def write(scene: Scene, folder: Path, size: int) -> Path:
    """Write the scene for a ``size`` x ``size`` image into ``folder`` (made if missing); return the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for mesh in scene.meshes:
        write_ply(mesh, folder / f"{mesh.name}.ply")
    for material in scene.materials.values():
        if material.picture:
            shutil.copyfile(BRICKS.with_name(material.picture), folder / material.picture)
    (folder / "scene.json").write_text(json.dumps(_neutral(scene, size), indent=1))
    (folder / "scene.toml").write_text(_toml(scene, size))
    return folder


def _neutral(scene: Scene, size: int) -> dict[str, Any]:
    """The content of ``scene.json``."""
    return {
        "name": scene.name,
        "width": size,
        "height": size,
        "camera": scene.camera,
        "threads": settings.THREADS,
        "roulette_start": settings.ROULETTE_START,
        "finite_depth": settings.FINITE_DEPTH,
        "materials": {name: asdict(material) for name, material in scene.materials.items()},
        "emission": vars(scene.emission),
        "emitter": scene.emitter,
        "meshes": [
            {
                "name": mesh.name,
                "file": f"{mesh.name}.ply",
                "material": mesh.material,
                "smooth": mesh.normals is not None,
                "triangles": len(mesh.triangles),
            }
            for mesh in scene.meshes
        ],
    }


def _toml(scene: Scene, size: int) -> str:
    """AccuRay's scene file; small meshes are inline, large ones in their PLY file."""
    lines = ["accuray = 1", 'length_unit = "m"', "", "[film]", f"width = {size}", f"height = {size}", ""]
    lines += ["[film.filter]", 'type = "box"', "radius = 0.5", "", "[camera]", 'type = "perspective"']
    lines += [f"{key} = {value}" for key, value in scene.camera.items()]
    lines += ["", "[integrator]", 'type = "path"', "max_depth = -1", f"roulette_depth = {settings.ROULETTE_START}"]
    for name, material in scene.materials.items():
        lines += ["", f"[materials.{name}]", *_material(name, material)]
        if name == scene.emitter:
            lines.append(f"emission = {_inline(scene.emission)}")
    for mesh in scene.meshes:
        lines += ["", f"[shapes.{mesh.name}]", 'type = "mesh"', f'material = "{mesh.material}"']
        if len(mesh.triangles) > INLINE_TRIANGLES or mesh.uvs is not None:
            lines.append(f'file = "{mesh.name}.ply"')
        else:
            lines.append(f"positions = {_rows(mesh.positions.tolist())}")
            lines.append(f"faces = {_rows(mesh.triangles.tolist())}")
    return "\n".join(lines) + "\n"


def _material(name: str, material: Material) -> list[str]:
    """The lines of a material's table; a picture's texture is named like the material."""
    lines = [f'type = "{material.kind}"']
    if material.kind == "conductor":
        lines += [f"eta = {material.eta}", f"k = {material.k}"]
    if material.kind == "dielectric":
        lines += [f"ior = {material.eta}"]
    if material.roughness:
        lines += [f"roughness = {material.roughness}", "compensate = false"]
    if material.reflectance is not None:
        lines += [f"reflectance = {_inline(material.reflectance)}"]
    if material.picture:
        lines += [f'reflectance = {{ texture = "{name}" }}', f"[textures.{name}]", 'type = "image"']
        lines += [f'file = "{material.picture}"', 'filter = "bilinear"']
    return lines


def _inline(spectrum: Spectrum) -> str:
    return f"{{ wavelengths = {list(spectrum.wavelengths)}, values = {list(spectrum.values)} }}"


def _rows(rows: Sequence[Sequence[float]]) -> str:
    return "[\n" + "".join(f"  {row},\n" for row in rows) + "]"


def main() -> None:
    """Write one scene: ``python -m benchmarks.scenes cornell FOLDER --size 512``."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--size", type=int, default=settings.SIZE)
    parser.add_argument("--xml", action="store_true", help="also write mitsuba.xml, 1 sample per pixel")
    arguments = parser.parse_args()
    scene = build(arguments.scene)
    print(write(scene, arguments.folder, arguments.size))
    if arguments.xml:
        from benchmarks.mitsuba_xml import write_xml

        print(write_xml(scene, arguments.folder, arguments.size, spp=1))


if __name__ == "__main__":
    main()
