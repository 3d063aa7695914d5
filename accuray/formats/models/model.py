"""What the readers of model files hand over: parts of a scene, in the structure of a scene file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from accuray.scene.errors import Where
from accuray.scene.paths import Confinement

if TYPE_CHECKING:
    import numpy.typing as npt

Table = dict[str, Any]

MOST_SHAPES = 1 << 18
MOST_VERTICES = 1 << 28
"""Shapes, and vertices of all meshes together, that one model may have."""

MAX_NAME = 200


@dataclass(frozen=True)
class Options:
    """How a model is to be read.

    ``where`` is the place that asked for it, ``files`` the folders that it may read from. ``matrix`` (4, 4) places it,
    in metres; ``length_unit`` is that of files which have none of their own. ``scene`` and ``camera`` choose by name or
    number. ``crease_angle`` in radians, None for flat shading where there are no normals. ``white_luminance`` is the
    luminance in cd/m^2 that becomes Y = 1. ``known_lights`` are the light types that the renderer has.
    """

    where: Where
    files: Confinement
    matrix: npt.NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    length_unit: str = "m"
    scene: str | None = None
    camera: str | None = None
    lights: bool = True
    crease_angle: float | None = None
    white_luminance: float = 1.0
    known_lights: frozenset[str] = frozenset()


@dataclass
class Model:
    """Sections of a scene, lengths in metres, meshes and pictures as arrays.

    ``cameras`` are those of the file by name, ``camera`` the name of the chosen one. ``notes`` say what could not be
    translated. ``folder`` is where file names start.
    """

    folder: Path
    textures: dict[str, Table] = field(default_factory=dict)
    materials: dict[str, Table] = field(default_factory=dict)
    lights: dict[str, Table] = field(default_factory=dict)
    shapes: dict[str, Table] = field(default_factory=dict)
    cameras: dict[str, Table] = field(default_factory=dict)
    camera: str | None = None
    aspect: float | None = None
    notes: list[str] = field(default_factory=list)
    _numbers: dict[tuple[int, str], int] = field(default_factory=dict)

    def note(self, place: str, text: str) -> None:
        """Says once that something could not be translated."""
        line = f"{place}: {text}"
        if line not in self.notes:
            self.notes.append(line)

    def free_name(self, section: dict[str, Table], wanted: str) -> str:
        """``wanted``, or the same with a number after it that is free in this section, fit for a scene file."""
        clean = "".join(c if c.isprintable() else "_" for c in wanted)[:MAX_NAME] or "unnamed"
        name = clean
        while name in section:
            number = self._numbers.get((id(section), clean), 1) + 1
            self._numbers[id(section), clean] = number
            name = f"{clean}.{number}"
        return name


ModelReader = Callable[[Path, Options], Model]
"""Reads a file. Raises SceneError, or ValueError with file and line."""


def placement(matrix: npt.NDArray[np.float64]) -> Table:
    """The ``transform`` of a shape as a scene file spells it, nothing for the identity."""
    rows = [[float(x) + 0.0 for x in row] for row in matrix]
    if not np.array_equal(matrix[:3, :3], np.eye(3)):
        return {"transform": {"matrix": rows}}
    move = [row[3] for row in rows[:3]]
    return {"transform": {"translate": move}} if any(move) else {}


def matrix_of(shape: Table) -> npt.NDArray[np.float64]:
    """The matrix (4, 4) of what ``placement`` gave a shape."""
    matrix = np.eye(4)
    transform = shape.get("transform", {})
    if "matrix" in transform:
        return np.array(transform["matrix"])
    matrix[:3, 3] = transform.get("translate", 0.0)
    return matrix


def mesh_table(arrays: Any, material: str, crease_angle: float | None = None) -> Table:
    """A shape of the compiled module's mesh (``accuray._core.mesh.Mesh``)."""
    found = {
        "positions": arrays.positions,
        "faces": arrays.indices,
        "normals": arrays.normals,
        "uvs": arrays.uvs,
        "colors": arrays.colors,
    }
    table: Table = {"type": "mesh", **{key: value for key, value in found.items() if value is not None}}
    if crease_angle is not None and arrays.normals is None:
        table["crease_angle"] = float(np.degrees(crease_angle))
    return {**table, "material": material}
