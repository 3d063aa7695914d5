"""Scene and mesh files: one module per format, and one line for it here.

Importing this package registers the readers of meshes, images and photometry, so ``Scene.from_dict`` can take such
files too: the public ``accuray.Scene`` comes from here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.formats import image, json, mesh, toml
from accuray.formats.reading import SceneReader, load_scene
from accuray.scene import Scene
from accuray.scene.images import register_image_reader
from accuray.scene.meshes import MeshReader, register_reader
from accuray.scene.models import register_expander
from accuray.scene.photometry import register_photometry_reader
from accuray.scene.placements import register_array_reader

if TYPE_CHECKING:
    from accuray.formats.models.model import ModelReader

__all__ = ["MESH_READERS", "MODEL_READERS", "SCENE_READERS", "Scene", "convert", "load"]


def _late(module: str, function: str) -> Callable[..., Any]:
    """A function of this package whose module is imported by the first call: most scenes need none of these."""

    def call(*arguments: Any, **keywords: Any) -> Any:
        return getattr(import_module(f"accuray.formats.{module}"), function)(*arguments, **keywords)

    return call


SCENE_READERS: dict[str, SceneReader] = {
    ".toml": toml.parse,
    ".json": json.parse,
}

MESH_READERS: dict[str, MeshReader] = {
    ".obj": mesh.read_obj,
    ".ply": mesh.read_ply,
    ".stl": mesh.read_stl,
}

MODEL_READERS: dict[str, ModelReader] = {
    ".gltf": _late("gltf", "read"),
    ".glb": _late("gltf", "read"),
    ".obj": _late("models.obj", "read"),
    ".ply": _late("models.plain", "read_ply"),
    ".stl": _late("models.plain", "read_stl"),
}

for _suffix, _reader in MESH_READERS.items():
    register_reader(_suffix, _reader)
register_image_reader(image.read)
register_array_reader(".npy", _late("arrays", "read_npy"))
register_array_reader(".csv", _late("arrays", "read_csv"))
register_photometry_reader(".ies", _late("ies", "read"))
register_expander(partial(_late("models.expanding", "expand"), readers=MODEL_READERS))


def convert(model: str | PathLike[str], scene: str | PathLike[str]) -> list[str]:
    """Write a model file as a scene file that can be edited.

    ``scene`` gets the ending .toml; meshes and pictures go into a folder beside it, ``NAME_files`` for NAME.toml. What
    is there under these names is replaced. Returns what could not be translated, which the scene file lists as well;
    the scene renders as the model does. Raises SceneError for the model, OSError for what cannot be written.
    """
    from accuray.formats.converting import convert_model

    return convert_model(Path(model), Path(scene), MODEL_READERS)


def load(
    path: str | PathLike[str],
    overrides: Iterable[str] | Mapping[str, Any] = (),
    roots: Iterable[str | PathLike[str]] = (),
    *,
    frame: float | None = None,
) -> Scene:
    """Read, merge and validate a scene file, or a model file as a scene: by its own camera, else by one that shows it.

    ``overrides`` change values before validation: texts such as ``"film.width=256"`` (the value in TOML syntax,
    else taken as text) or a mapping from dotted keys to values. ``roots`` are folders, besides the scene's own
    and those in ACCURAY_PATH, that the files named in the scene may lie in. ``frame`` is the frame of an animation,
    by default that of the scene's section ``[animation]``; ``Scene.at`` gives further ones. Raises SceneError.
    """
    return load_scene(path, SCENE_READERS, MODEL_READERS, overrides, roots, frame)
