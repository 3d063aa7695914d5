"""A benchmark scene as a Mitsuba XML file, for its command-line program."""

from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

from benchmarks import settings
from benchmarks.description import Scene, Spectrum


def write_xml(scene: Scene, folder: Path, size: int, spp: int) -> Path:
    """Write ``folder/mitsuba.xml``, which names the PLY files in ``folder``; return its path."""
    root = Element("scene", version="3.0.0")
    integrator = SubElement(root, "integrator", type="path")
    SubElement(integrator, "integer", name="max_depth", value="-1")
    SubElement(integrator, "integer", name="rr_depth", value=str(settings.ROULETTE_START))
    _sensor(root, scene, size, spp)
    for name, material in scene.materials.items():
        if material.reflectance is None:
            raise ValueError(f"scene {scene.name}, material {name}: only plain diffuse ones are written as XML")
        bsdf = SubElement(root, "bsdf", type="diffuse", id=name)
        SubElement(bsdf, "spectrum", name="reflectance", value=_pairs(material.reflectance))
    for mesh in scene.meshes:
        shape = SubElement(root, "shape", type="ply")
        SubElement(shape, "string", name="filename", value=f"{mesh.name}.ply")
        SubElement(shape, "boolean", name="face_normals", value=str(mesh.normals is None).lower())
        SubElement(shape, "ref", id=mesh.material)
        if mesh.material == scene.emitter and scene.emission:
            emitter = SubElement(shape, "emitter", type="area")
            SubElement(emitter, "spectrum", name="radiance", value=_pairs(scene.emission))
    indent(root)
    path = folder / "mitsuba.xml"
    ElementTree(root).write(path)
    return path


def _sensor(root: Element, scene: Scene, size: int, spp: int) -> None:
    sensor = SubElement(root, "sensor", type="perspective")
    SubElement(sensor, "float", name="fov", value=str(scene.camera["fov"]))
    place = SubElement(sensor, "transform", name="to_world")
    eye, target, up = (", ".join(map(str, scene.camera[key])) for key in ("position", "look_at", "up"))
    SubElement(place, "lookat", origin=eye, target=target, up=up)
    sampler = SubElement(sensor, "sampler", type="independent")
    SubElement(sampler, "integer", name="sample_count", value=str(spp))
    film = SubElement(sensor, "film", type="hdrfilm")
    SubElement(film, "integer", name="width", value=str(size))
    SubElement(film, "integer", name="height", value=str(size))
    SubElement(film, "string", name="pixel_format", value="rgb")
    SubElement(film, "rfilter", type="box")


def _pairs(spectrum: Spectrum) -> str:
    """Mitsuba's ``wavelength:value`` list."""
    pairs = zip(spectrum.wavelengths, spectrum.values, strict=True)
    return ", ".join(f"{wavelength}:{value}" for wavelength, value in pairs)
