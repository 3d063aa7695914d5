"""The benchmark scenes, described once and written for every renderer: PLY meshes, ``scene.json``, ``scene.toml``.

``scene.json`` is the neutral form that the peers' drivers read: camera, materials with a measured spectrum and the
linear Rec.709 colour of it, meshes, transforms of copies, the map of the surroundings. ``scene.toml`` is AccuRay's own
form of the same scene.
"""

import argparse
import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import settings, sky, worlds
from benchmarks.description import (
    Material,
    Scene,
    Spectrum,
    camera,
    cornell_geometry,
    cornell_lamp,
    grey,
    paints,
)
from benchmarks.geometry import bumpy_sphere, carpet, frame_around, quad_mesh, widened, write_ply

MILLIMETRE = 0.001
INLINE_TRIANGLES = 1000

BOXES = ("cornell", "million", "glossy", "frosted", "room")
"""The Cornell box; the box with, in place of the blocks, a sphere of a million triangles, one of rough metal over a
textured floor, one of rough glass; the box with nothing in it."""

SCENES = (*BOXES, *worlds.WORLDS)

BRICKS = Path(__file__).parents[1] / "scenes" / "textures" / "bricks.png"
BRICK_REPEATS = 2
LAMP_WIDENING = 2.6
"""The lamp of those two is so much wider: no path tracer finds the caustics of a small one soon, and a few bright
paths would decide the comparison."""

LAMP_REFLECTANCE = 0.78


def build(name: str) -> Scene:
    """One of ``SCENES``."""
    if name not in SCENES:
        raise ValueError(f"unknown scene {name!r}: allowed {', '.join(SCENES)}")
    return worlds.WORLDS[name]() if name in worlds.WORLDS else _box(name)


def _box(name: str) -> Scene:
    """The Cornell box with what the name says in it."""
    page = cornell_geometry()
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
    materials = {paint: Material(reflectance=reflectance) for paint, reflectance in paints().items()}
    materials["lamp"] = Material(reflectance=grey(LAMP_REFLECTANCE))
    if name in SPHERES:
        size, material = SPHERES[name]
        materials["sphere"] = material or materials["white"]
        meshes.append(bumpy_sphere("sphere", "sphere", (0.278, 0.2, 0.28), 0.16, *size))
    if name == "glossy":
        materials["bricks"] = Material(picture=BRICKS.name)
        meshes.append(carpet("bricks", "bricks", (0.03, 0.0005, 0.53), 0.5, BRICK_REPEATS))
    return Scene(name, tuple(meshes), materials, _camera(page["camera"]), cornell_lamp(), "lamp")


SPHERES = {
    "million": ((settings.MILLION_SEGMENTS, settings.MILLION_RINGS), None),
    "glossy": ((settings.SEGMENTS, settings.RINGS), Material("conductor", eta=0.2, k=3.9, roughness=0.35)),
    "frosted": ((settings.SEGMENTS, settings.RINGS), Material("dielectric", eta=1.5, roughness=0.4)),
}
"""Segments and rings of the sphere in the box, and its material; None is the white of the walls."""


def _camera(described: dict[str, Any]) -> dict[str, Any]:
    """The measured camera in metres; the film is square."""
    eye = [value * MILLIMETRE for value in described["position"]]
    target = [a + b for a, b in zip(eye, described["direction"], strict=True)]
    return camera(eye, target, described["derived_full_fov_deg"]) | {"up": described["up"]}


def write(scene: Scene, folder: Path, size: int) -> Path:
    """Write the scene for a ``size`` x ``size`` image into ``folder`` (made if missing); return the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for mesh in scene.meshes:
        write_ply(mesh, folder / f"{mesh.name}.ply")
    for name, transforms in scene.copies.items():
        np.save(folder / f"{name}.npy", transforms)
    for material in scene.materials.values():
        if material.picture:
            shutil.copyfile(BRICKS.with_name(material.picture), folder / material.picture)
    if scene.sky:
        sky.write(scene.sky, folder)
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
        "emission": asdict(scene.emission) if scene.emission else None,
        "emitter": scene.emitter,
        "lamp_backs": scene.lamp_backs,
        "sky": {"file": sky.FILE, "from_pole_to_pole": sky.POLES_FILE} if scene.sky else None,
        "meshes": [
            {
                "name": mesh.name,
                "file": f"{mesh.name}.ply",
                "material": mesh.material,
                "smooth": mesh.normals is not None,
                "triangles": len(mesh.triangles),
                "copies": f"{mesh.name}.npy" if mesh.name in scene.copies else "",
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
    if scene.sky:
        lines += ["", "[lights.sky]", 'type = "environment"', f'file = "{sky.FILE}"']
    for name, material in scene.materials.items():
        lines += ["", f"[materials.{name}]", *_material(name, material)]
        if name == scene.emitter and scene.emission:
            lines.append(f"emission = {_inline(scene.emission)}")
    for mesh in scene.meshes:
        lines += ["", f"[shapes.{mesh.name}]", 'type = "mesh"', f'material = "{mesh.material}"']
        if len(mesh.triangles) > INLINE_TRIANGLES or mesh.uvs is not None:
            lines.append(f'file = "{mesh.name}.ply"')
        else:
            lines.append(f"positions = {_rows(mesh.positions.tolist())}")
            lines.append(f"faces = {_rows(mesh.triangles.tolist())}")
        lines += _copies(mesh.name, scene)
    return "\n".join(lines) + "\n"


def _copies(name: str, scene: Scene) -> list[str]:
    """Makes the mesh above a prototype, with an instance for each of its transforms."""
    if name not in scene.copies:
        return []
    lines = ["prototype = true"]
    for number, transform in enumerate(scene.copies[name]):
        matrix = [*transform.ravel().tolist(), 0, 0, 0, 1]
        lines += [f"[shapes.{name}-{number}]", 'type = "instance"', f'of = "{name}"']
        lines += [f"transform = {{ matrix = {matrix} }}"]
    return lines


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
