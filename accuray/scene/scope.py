"""What the validators of single values need to know about the whole scene."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from accuray.scene.clock import STILL, Clock
from accuray.scene.errors import Document, Key
from accuray.scene.paths import Confinement
from accuray.scene.schema import Schema

SECTION_OF = {"texture": "textures", "material": "materials", "light": "lights", "shape": "shapes"}
"""Families whose objects have names, and the section that holds them."""


@dataclass
class Scope:
    """The document under validation with its schema and folders.

    ``defaults`` holds resolved defaults by the identity of their parameter; ``mesh_reports`` collects what the
    readers of mesh files counted, by the name of the shape; ``images`` keeps the pictures that were read, by file,
    ``meshes`` the arrays of mesh files, by file, length unit and whether they have polygons, ``arrays`` those that the
    document itself holds, by key path: further frames of an animation find them there. ``clock`` is the moment of the
    frame.
    """

    document: Document
    schema: Schema
    files: Confinement
    defaults: dict[int, Any] = field(default_factory=dict)
    mesh_reports: dict[str, dict[str, Any]] = field(default_factory=dict)
    images: dict[Path, Any] = field(default_factory=dict)
    meshes: dict[tuple[Path, str, bool], dict[str, Any]] = field(default_factory=dict)
    arrays: dict[tuple[Key, ...], Any] = field(default_factory=dict)
    clock: Clock = STILL

    def defines(self, section: str, name: str) -> bool:
        """Is there an object of this name in a section?"""
        table = self.document.data.get(section)
        return isinstance(table, dict) and name in table

    def names(self, section: str) -> list[str]:
        """Names defined in a section ("materials", "spectra", ...), in the order of the file."""
        table = self.document.data.get(section)
        return list(table) if isinstance(table, dict) else []
