"""The section ``[models]``: files that hold whole objects with their materials, and may hold cameras and lights.

Their readers belong to ``accuray.formats``, which registers here what puts their parts into a scene.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from accuray.scene.errors import Document, Where
from accuray.scene.objects import expect_table, resolve_params
from accuray.scene.paths import Confinement
from accuray.scene.schema import Param, Schema, Type
from accuray.scene.scope import Scope

SUFFIXES = (".gltf", ".glb", ".obj", ".ply", ".stl")

MODEL = Type(
    "model",
    "An object, or a whole scene, from a file: its shapes, materials, textures and lights become those of the scene.",
    (
        Param("file", "file", required=True, choices=SUFFIXES, doc="glTF, GLB, OBJ (with its MTL), PLY or STL file."),
        Param("transform", "transform", doc="Places the model; it may shear and stretch."),
        Param("scene", "text", doc="Name or number of the scene inside the file; by default the file's own choice."),
        Param("camera", "text", doc="Name or number of a camera inside the file, for a scene without a [camera]."),
        Param("lights", "bool", default=True, doc="Whether the file's lights shine; surfaces that emit always do."),
        Param("material", "reference", role="material", doc="A material of the scene in place of all of the file's."),
        Param(
            "crease_angle",
            "float",
            min=0.0,
            max=180.0,
            unit="deg",
            doc="Makes normals where the file has none, but not across edges that bend by more than this.",
        ),
        Param(
            "white_luminance",
            "float",
            default=1.0,
            min=1e-6,
            max=1e12,
            unit="cd/m^2",
            doc='Luminance of the file\'s lights and emission that becomes Y = 1; "72983 cd/m^2" keeps what they are.',
        ),
    ),
)

Expander = Callable[[Document, dict[str, dict[str, Any]], Confinement, frozenset[str]], tuple[Document, list[str]]]
"""Puts what models hold below what a document says, given their tables by name and the light types that there are.
Returns the whole, and what could not be translated. Raises SceneError."""

_expander: Expander | None = None


def register_expander(expander: Expander) -> None:
    """Use ``expander`` for all models."""
    global _expander
    _expander = expander


def expand_models(document: Document, schema: Schema, files: Confinement) -> tuple[Document, list[str]]:
    """The document with the parts of its models, and notes. Raises SceneError."""
    where = Where(document, ("models",))
    section = expect_table(document.data.get("models", {}), where)
    if not section:
        return document, []
    if _expander is None:
        raise where.error("has no reader", allowed="none (import accuray.formats)")
    scope = Scope(document, schema, files)
    tables = {
        name: resolve_params(MODEL, expect_table(section[name], where.child(name)), where.child(name), scope)
        for name in sorted(section)
    }
    return _expander(document, tables, files, frozenset(schema.family("light").types))
