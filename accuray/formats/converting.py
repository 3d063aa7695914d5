"""From a model file to a scene that can be edited: a TOML file, with meshes as PLY files and pictures beside it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from accuray.formats import image
from accuray.formats.models.expanding import model_document
from accuray.formats.models.model import ModelReader
from accuray.formats.ply_writing import write_ply
from accuray.formats.toml_writing import write_toml
from accuray.scene import SceneError
from accuray.scene import schema as schemas
from accuray.scene.errors import Document, Where
from accuray.scene.paths import Confinement

ARRAYS = ("positions", "faces", "normals", "uvs", "colors")
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
LONGEST_NAME = 80


def convert_model(model: Path, scene: Path, readers: Mapping[str, ModelReader]) -> list[str]:
    """See ``accuray.convert``."""
    if model.suffix.lower() not in readers:
        raise SceneError("is not a model file", file=str(model), allowed="the endings " + ", ".join(readers))
    if not model.is_file():
        raise SceneError("does not exist", file=str(model), allowed="a model file")
    if scene.suffix.lower() != ".toml":
        raise SceneError("is not a name for a scene file", file=str(scene), allowed="the ending .toml")
    real = Path(os.path.realpath(model.parent)) / model.name
    files = Confinement.around(real.parent)
    lights = frozenset(schemas.current().family("light").types)
    document, notes = model_document(real, str(model), files, lights, readers)
    writer = _Writer(document, scene, files)
    comments = [f"Made of {model.name}."]
    if notes:
        comments += ["", "What could not be translated:", *(f"  {note}" for note in notes)]
    text = write_toml(writer.sections(), comments)
    temporary = scene.with_name(scene.name + ".part")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, scene)
    return notes


class _Writer:
    """Writes the arrays of a document into files and puts their names in place of them."""

    def __init__(self, document: Document, scene: Path, files: Confinement) -> None:
        self._document = document
        self._files = files
        self._folder = scene.parent / f"{scene.stem}_files"
        self._taken: set[str] = set()
        self._meshes: dict[tuple[int, ...], str] = {}

    def sections(self) -> dict[str, Any]:
        """The sections of the scene file. Raises OSError."""
        data = dict(self._document.data)
        objects = {key: data.get(key, {}) for key in ("textures", "shapes")}
        data["textures"] = {name: self._texture(name, table) for name, table in objects["textures"].items()}
        data["shapes"] = {name: self._shape(name, table) for name, table in objects["shapes"].items()}
        order = ("accuray", "film", "camera", "lights", "textures", "materials", "shapes")
        return {key: data[key] for key in order if data.get(key)}

    def _texture(self, name: str, table: dict[str, Any]) -> dict[str, Any]:
        if "pixels" in table:
            pixels = table["pixels"]
            path = self._path(name, ".exr" if pixels.dtype.kind == "f" else ".png")
            image.write(path, pixels)
        elif "file" in table:
            source = self._files.resolve(table["file"], Where(self._document, ("textures", name, "file")))
            path = self._path(name, source.suffix.lower())
            shutil.copyfile(source, path)
        else:
            return table
        rest = {key: value for key, value in table.items() if key not in ("pixels", "file", "type")}
        return {"type": table["type"], "file": self._relative(path), **rest}

    def _shape(self, name: str, table: dict[str, Any]) -> dict[str, Any]:
        if "positions" not in table:
            return table
        arrays = {key: table[key] for key in ARRAYS if key in table}
        key = tuple(id(array) for array in arrays.values())
        if key not in self._meshes:
            path = self._path(name, ".ply")
            write_ply(path, arrays)
            self._meshes[key] = self._relative(path)
        rest = {key: value for key, value in table.items() if key not in (*ARRAYS, "type")}
        return {"type": table["type"], "file": self._meshes[key], **rest}

    def _path(self, name: str, suffix: str) -> Path:
        """A new file's path, under a name that every system takes."""
        self._folder.mkdir(exist_ok=True)
        stem = _UNSAFE.sub("_", name).strip("._")[:LONGEST_NAME] or "unnamed"
        unique, number = stem, 1
        while (unique + suffix).lower() in self._taken:
            number += 1
            unique = f"{stem}-{number}"
        self._taken.add((unique + suffix).lower())
        return self._folder / (unique + suffix)

    def _relative(self, path: Path) -> str:
        return f"{self._folder.name}/{path.name}"
