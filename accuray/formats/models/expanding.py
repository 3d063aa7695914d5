"""Puts models into scenes: under a name of their own, below what the scene itself says; or as a scene by themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from accuray.formats.merging import merge
from accuray.formats.models.framing import default_camera, default_lights
from accuray.formats.models.model import Model, ModelReader, Options, Table
from accuray.scene import SceneError
from accuray.scene.errors import Document, Source, Where
from accuray.scene.paths import Confinement, display_path

FILM_HEIGHT = 512
PARTS = ("front", "back")
"""Parameters that name a material of the same model."""


def read_model(path: Path, readers: Mapping[str, ModelReader], options: Options) -> Model:
    """The model in a file. Raises SceneError, at the place that asked for it if the reader knows no better one."""
    try:
        return readers[path.suffix.lower()](path, options)
    except SceneError:
        raise
    except (ValueError, OSError) as error:
        raise options.where.error(f"cannot be read: {error}", value=path.name) from error


def expand(
    document: Document,
    tables: dict[str, Table],
    files: Confinement,
    known_lights: frozenset[str],
    readers: Mapping[str, ModelReader],
) -> tuple[Document, list[str]]:
    """See ``accuray.scene.models.Expander``."""
    below: Document | None = None
    notes: list[str] = []
    for name, table in tables.items():
        where = Where(document, ("models", name))
        options = _options(table, where, files, known_lights)
        model = read_model(table["file"], readers, options)
        if table["material"] is not None:
            _cover(model, table["material"])
        shown = display_path(table["file"])
        part = Document(_prefixed(model, f"{name}/"), Source(shown, folder=model.folder))
        if table["camera"] is not None and model.camera is not None:
            part.data["camera"] = model.cameras[model.camera]
        below = part if below is None else merge(below, part)
        notes += [f"{shown}: {note}" for note in model.notes]
    if below is None:
        return document, notes
    merged = merge(below, document)
    del merged.data["models"]
    return merged, notes


def _options(table: Table, where: Where, files: Confinement, known_lights: frozenset[str]) -> Options:
    return Options(
        where=where,
        files=files,
        matrix=np.eye(4) if table["transform"] is None else table["transform"],
        length_unit=where.child("file").source.length_unit,
        scene=table["scene"],
        camera=table["camera"],
        lights=table["lights"],
        crease_angle=table["crease_angle"],
        white_luminance=table["white_luminance"],
        known_lights=known_lights,
    )


def _cover(model: Model, material: str) -> None:
    """Gives all shapes one material, which is not the model's."""
    for shape in model.shapes.values():
        if "material" in shape:
            shape["material"] = Foreign(material)
    model.materials, model.textures = {}, {}


class Foreign(str):
    """A name that is not one of the model's own."""


def _prefixed(model: Model, prefix: str) -> Table:
    """The sections of the model with ``prefix`` before all its names."""

    def named(name: str) -> str:
        return str(name) if isinstance(name, Foreign) else prefix + name

    def value(key: str, item: Any) -> Any:
        if isinstance(item, dict) and "texture" in item:
            return {**item, "texture": named(item["texture"])}
        if key in ("material", *PARTS) and isinstance(item, str):
            return named(item)
        return [named(member) for member in item] if key == "of" else item

    def section(objects: dict[str, Table]) -> Table:
        return {named(name): {key: value(key, item) for key, item in table.items()} for name, table in objects.items()}

    return {name: section(objects) for name, objects in _sections(model).items()}


def _sections(model: Model) -> dict[str, dict[str, Table]]:
    sections = {
        "textures": model.textures,
        "materials": model.materials,
        "lights": model.lights,
        "shapes": model.shapes,
    }
    return {name: objects for name, objects in sections.items() if objects}


def model_document(
    path: Path, shown: str, files: Confinement, known_lights: frozenset[str], readers: Mapping[str, ModelReader]
) -> tuple[Document, list[str]]:
    """A model as a scene: seen by its first camera, else by one that shows all of it; lit evenly if it has no light."""
    source = Source(shown, folder=path.parent)
    options = Options(Where(Document({}, source)), files, known_lights=known_lights)
    model = read_model(path, readers, options)
    data: Table = {"accuray": 1, **_prefixed(model, "")}
    if model.aspect is not None:
        width = round(FILM_HEIGHT * model.aspect)
        data["film"] = {"width": min(max(width, 1), 1 << 16), "height": FILM_HEIGHT}
    camera = default_camera(model) if model.camera is None else model.cameras[model.camera]
    if camera is not None:
        data["camera"] = camera
    data["lights"] = data.get("lights") or default_lights(model)
    return Document(data, replace(source, length_unit="m")), [f"{shown}: {note}" for note in model.notes]
