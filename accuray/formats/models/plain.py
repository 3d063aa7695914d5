"""Models of one mesh without materials: PLY and STL."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from accuray.formats.mesh import read_compiled
from accuray.formats.models.model import Model, Options, Table, mesh_table, placement
from accuray.scene.arrays import scale_to_metres

MATERIAL: Table = {"type": "diffuse", "reflectance": 0.6}
COLORED: Table = {"type": "diffuse", "reflectance": {"texture": "vertex colours"}}


def read_ply(path: Path, options: Options) -> Model:
    """A PLY file; its colours, if it has any, are those of a matte surface. Raises ValueError."""
    return _model(path, read_compiled(path), options)


def read_stl(path: Path, options: Options) -> Model:
    """An STL file. Raises ValueError."""
    return _model(path, read_compiled(path), options)


def _model(path: Path, arrays: Any, options: Options) -> Model:
    model = Model(path.parent)
    shape = place(mesh_table(arrays, "surface", options.crease_angle), options)
    if "colors" in shape:
        model.textures["vertex colours"] = {"type": "vertex_color"}
    model.materials["surface"] = dict(COLORED if "colors" in shape else MATERIAL)
    model.shapes[path.stem] = shape
    note_report(model, path.stem, arrays.report)
    return model


def place(shape: Table, options: Options) -> Table:
    """The shape in metres and with the model's transform."""
    shape["positions"] = scale_to_metres(shape["positions"], options.length_unit).astype(np.float32)
    return {**shape, **placement(options.matrix)}


def note_report(model: Model, place: str, report: dict[str, Any]) -> None:
    """Says what the compiled reader left out."""
    for key in ("nonfinite_triangles", "degenerate_triangles"):
        if report[key]:
            model.note(place, f"{report[key]} {key.replace('_', ' ')} were left out")
    if report["unknown"]:
        model.note(place, f"{report['unknown']} parts of the file were left out: {report['first_unknown']}")
