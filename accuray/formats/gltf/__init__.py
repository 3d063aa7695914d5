"""glTF 2.0 and GLB, read by json and numpy alone; no size, index or name in a file is trusted.

The format is that of Khronos 2021, with the extensions that ``document.SUPPORTED`` lists.
"""

from __future__ import annotations

from pathlib import Path

from accuray.formats.gltf.document import open_document
from accuray.formats.gltf.graph import SceneGraph
from accuray.formats.models.model import Model, Options


def read(path: Path, options: Options) -> Model:
    """The model in a .gltf or .glb file. Raises SceneError."""
    document = open_document(path, options.files)
    model = Model(path.parent)
    for name in document.unknown_extensions:
        model.note("extensionsUsed", f"{name} is not known and was left out")
    SceneGraph(document, model, options).read()
    return model
