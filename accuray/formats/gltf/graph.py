"""The node hierarchy: meshes become shapes or prototypes with instances; cameras and lights get their places."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from accuray.formats.gltf.document import GltfDocument
from accuray.formats.gltf.item import Item
from accuray.formats.gltf.meshes import Meshes
from accuray.formats.gltf.views import camera_table, light_table
from accuray.formats.models.model import MOST_SHAPES, Model, Options, placement
from accuray.scene.errors import SceneError
from accuray.scene.transforms import flattens, is_similarity

Matrix = NDArray[np.float64]
MAX_DEPTH = 1000


@dataclass(frozen=True)
class _Placed:
    """A node and its matrix to the world."""

    item: Item
    number: int
    matrix: Matrix


class SceneGraph:
    """Walks the nodes of a scene once."""

    def __init__(self, document: GltfDocument, model: Model, options: Options) -> None:
        self._document = document
        self._model = model
        self._options = options
        self._meshes = Meshes(document, model, options)

    def read(self) -> None:
        """Fills the model. Raises SceneError."""
        placed = list(self._placed())
        meshes = len(self._document.objects("meshes"))
        uses = Counter(node.item.index("mesh", meshes) for node in placed if is_similarity(node.matrix))
        for node in placed:
            self._add_meshes(node, uses)
            self._add_camera(node)
            if self._options.lights:
                self._add_light(node)
        self._choose_camera()
        for name in ("animations", "skins"):
            if self._document.objects(name):
                self._model.note(name, f"{len(self._document.objects(name))} left out: meshes are shown as they rest")

    def _placed(self) -> Iterator[_Placed]:
        """The nodes of the scene that are not flattened, parents first. Raises SceneError for a graph with loops."""
        nodes = self._document.objects("nodes")
        pending = [(index, self._options.matrix, 0) for index in reversed(self._roots())]
        met: set[int] = set()
        while pending:
            index, parent, depth = pending.pop()
            item = nodes[index]
            if index in met:
                raise item.where.error("is its own ancestor or has two parents", allowed="a tree of nodes")
            if depth > MAX_DEPTH:
                raise item.where.error("is nested too deeply", allowed=f"{MAX_DEPTH} levels of nodes")
            met.add(index)
            matrix = _product(parent, local_matrix(item))
            if not np.isfinite(matrix).all() or flattens(matrix):
                self._model.note(item.where.key, "was left out with what is below it: its transform flattens")
                continue
            children = [child_index(child, len(nodes)) for child in item.items("children")]
            pending += [(child, matrix, depth + 1) for child in reversed(children)]
            yield _Placed(item, index, matrix)

    def _roots(self) -> list[int]:
        """Nodes of the chosen scene; without scenes, all that are nobody's children."""
        scenes, nodes = self._document.objects("scenes"), self._document.objects("nodes")
        wanted = self._options.scene
        if not scenes:
            if wanted is not None:
                raise self._options.where.child("scene").error("is not there", value=wanted, allowed="none: no scenes")
            children = {child_index(child, len(nodes)) for node in nodes for child in node.items("children")}
            return [index for index in range(len(nodes)) if index not in children]
        default = self._document.root.index("scene", len(scenes)) or 0
        scene = scenes[default if wanted is None else _chosen(wanted, scenes, self._options, "scene")]
        return [child_index(child, len(nodes)) for child in scene.items("nodes")]

    def _add_meshes(self, node: _Placed, uses: Counter[int | None]) -> None:
        index = node.item.index("mesh", len(self._document.objects("meshes")))
        if index is None:
            return
        if node.item.has("skin"):
            self._model.note(node.item.where.key, "its skin was left out")
        shapes, place = self._model.shapes, placement(node.matrix)
        name = node.item.name(self._document.objects("meshes")[index].name(f"node {node.number}"))
        if is_similarity(node.matrix) and uses[index] > 1:
            members = self._meshes.prototypes(index)
            if members:
                shapes[self._model.free_name(shapes, name)] = {
                    "type": "instance",
                    "of": members,
                    **place,
                }
        else:
            for table in self._meshes.tables(index):
                shapes[self._model.free_name(shapes, name)] = {**table, **place}
        if len(shapes) > MOST_SHAPES:
            raise node.item.where.error(
                f"makes more than {MOST_SHAPES} shapes", allowed=f"up to {MOST_SHAPES} in a model"
            )

    def _add_camera(self, node: _Placed) -> None:
        index = node.item.index("camera", len(self._document.objects("cameras")))
        if index is None:
            return
        camera = self._document.objects("cameras")[index]
        name = self._model.free_name(self._model.cameras, camera.name(node.item.name(f"camera {index}")))
        self._model.cameras[name] = camera_table(camera, node.matrix, self._model)

    def _choose_camera(self) -> None:
        cameras, wanted = self._model.cameras, self._options.camera
        names = list(cameras)
        if wanted is not None and wanted not in names:
            if not wanted.isdecimal() or int(wanted) >= len(names):
                raise self._options.where.child("camera").unknown(wanted, "camera of the model", names)
            wanted = names[int(wanted)]
        self._model.camera = wanted or (names[0] if names else None)
        if self._model.camera is not None:
            self._model.aspect = cameras[self._model.camera].pop("aspect", None)
        for table in cameras.values():
            table.pop("aspect", None)

    def _add_light(self, node: _Placed) -> None:
        used = node.item.extension("KHR_lights_punctual")
        shared = self._document.root.extension("KHR_lights_punctual")
        lights = [] if shared is None else shared.items("lights")
        index = None if used is None else used.index("light", len(lights))
        if index is None:
            return
        light = lights[index]
        table = light_table(light, node.matrix, self._options.white_luminance)
        if table["type"] not in self._options.known_lights:
            self._model.note(
                f"light {light.name(str(index))}", f"the renderer has no light of the type {table['type']}"
            )
            return
        name = self._model.free_name(self._model.lights, node.item.name(light.name(f"light {index}")))
        self._model.lights[name] = table


def child_index(item: Item, count: int) -> int:
    """An element of a list of nodes."""
    value = item.value
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < count:
        raise item.error("is not a node", f"0 to {count - 1}" if count else "none: there are no nodes")
    return value


def local_matrix(node: Item) -> Matrix:
    """A node's matrix to its parent: its own, or translation times rotation times scale."""
    if node.has("matrix"):
        columns = node.vector("matrix", (), 16)
        matrix = np.array(columns).reshape(4, 4).T
        if matrix[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
            raise node.child("matrix").error("has another last row", "0, 0, 0, 1")
        return matrix
    matrix = np.eye(4)
    matrix[:3, :3] = _rotation(node) * np.array(node.vector("scale", (1.0, 1.0, 1.0)))
    matrix[:3, 3] = node.vector("translation", (0.0, 0.0, 0.0))
    return matrix


def _rotation(node: Item) -> Matrix:
    """The rotation of a quaternion x, y, z, w, of any length but zero."""
    x, y, z, w = node.vector("rotation", (0.0, 0.0, 0.0, 1.0))
    square = x * x + y * y + z * z + w * w
    if not 1e-100 < square < 1e100:
        raise node.child("rotation").error("is no rotation", "a unit quaternion")
    s = 2.0 / square
    return np.array(
        [
            [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
        ]
    )


def _product(a: Matrix, b: Matrix) -> Matrix:
    """Matrix product with the sums in index order, so that its bits are the same on every machine."""
    with np.errstate(over="ignore", invalid="ignore"):
        product: Matrix = a[:, 0, None] * b[0] + a[:, 1, None] * b[1] + a[:, 2, None] * b[2] + a[:, 3, None] * b[3]
    return product


def _chosen(wanted: str, items: list[Item], options: Options, key: str) -> int:
    """The number of the object that a name or a number means. Raises SceneError."""
    names = [item.name(str(number)) for number, item in enumerate(items)]
    if wanted in names:
        return names.index(wanted)
    if wanted.isdecimal() and int(wanted) < len(items):
        return int(wanted)
    error: SceneError = options.where.child(key).unknown(wanted, f"{key} of the model", names)
    raise error
