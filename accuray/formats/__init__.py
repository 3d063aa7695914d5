"""Scene and mesh files: one module per format, and one line for it here.

Importing this package registers the readers of meshes, images and photometry, so ``Scene.from_dict`` can take such
files too: the public ``accuray.Scene`` comes from here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any

from accuray.formats import ies, image, json, mesh, toml
from accuray.formats.reading import SceneReader, load_scene
from accuray.scene import Scene
from accuray.scene.images import register_image_reader
from accuray.scene.meshes import MeshReader, register_reader
from accuray.scene.photometry import register_photometry_reader

__all__ = ["MESH_READERS", "SCENE_READERS", "Scene", "load"]

SCENE_READERS: dict[str, SceneReader] = {
    ".toml": toml.parse,
    ".json": json.parse,
}

MESH_READERS: dict[str, MeshReader] = {
    ".obj": mesh.read_obj,
    ".ply": mesh.read_ply,
}

for _suffix, _reader in MESH_READERS.items():
    register_reader(_suffix, _reader)
register_image_reader(image.read)
register_photometry_reader(".ies", ies.read)


def load(
    path: str | PathLike[str],
    overrides: Iterable[str] | Mapping[str, Any] = (),
    roots: Iterable[str | PathLike[str]] = (),
) -> Scene:
    """Read, merge and validate a scene file.

    ``overrides`` change values before validation: texts such as ``"film.width=256"`` (the value in TOML syntax,
    else taken as text) or a mapping from dotted keys to values. ``roots`` are folders, besides the scene's own
    and those in ACCURAY_PATH, that the files named in the scene may lie in. Raises SceneError.
    """
    return load_scene(path, SCENE_READERS, overrides, roots)
