"""Accessors: typed arrays in buffers, with sparse replacements and integers that stand for fractions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.formats.gltf.document import GltfDocument
from accuray.formats.gltf.item import Item

COMPONENTS: dict[int, Any] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
MOST_WITHOUT_DATA = 1 << 24
"""Elements, in all, of accessors that take no bytes of the file: they are zero."""

MAX_COUNT = (1 << 32) - 2


class Accessors:
    """Reads the accessors of a file; each once."""

    def __init__(self, document: GltfDocument) -> None:
        self._document = document
        self._arrays: dict[int, NDArray[Any]] = {}
        self._without_data = 0

    def floats(self, owner: Item, key: str, widths: tuple[int, ...]) -> NDArray[np.float32]:
        """The accessor that ``owner[key]`` names as float32 (count, width). Raises SceneError."""
        item, raw = self._read(owner, key, widths)
        if raw.dtype.kind == "f":
            return raw.astype(np.float32)
        if not item.boolean("normalized"):
            return raw.astype(np.float32)
        whole = float(np.iinfo(raw.dtype).max)
        return np.maximum(raw.astype(np.float64) / whole, -1.0).astype(np.float32)

    def indices(self, owner: Item, key: str, vertices: int) -> NDArray[np.uint32]:
        """The accessor as uint32 (count,), all below ``vertices``. Raises SceneError."""
        item, raw = self._read(owner, key, (1,))
        if raw.dtype.kind != "u":
            raise item.child("componentType").error("is no type of indices", "5121, 5123, 5125")
        found: NDArray[np.uint32] = raw[:, 0].astype(np.uint32)
        if found.size and int(found.max()) >= vertices:
            raise item.where.error(f"names the vertex {int(found.max())}", allowed=f"0 to {vertices - 1}")
        return found

    def _read(self, owner: Item, key: str, widths: tuple[int, ...]) -> tuple[Item, NDArray[Any]]:
        accessors = self._document.objects("accessors")
        index = owner.index(key, len(accessors))
        if index is None:
            raise owner.where.error(f"lacks `{key}`", allowed="the number of an accessor")
        item = accessors[index]
        if WIDTHS.get(str(item.child("type").value)) not in widths:
            names = [name for name, width in WIDTHS.items() if width in widths]
            raise item.child("type").error(f"is not right for {key}", " or ".join(names))
        if index not in self._arrays:
            self._arrays[index] = self._array(item)
        return item, self._arrays[index]

    def _array(self, item: Item) -> NDArray[Any]:
        dtype, width = _component(item), WIDTHS[item.text("type")]
        count = item.integer("count", low=1, high=MAX_COUNT)
        if item.has("bufferView"):
            array = self._elements(item, count, width, dtype)
        else:
            self._without_data += count
            if self._without_data > MOST_WITHOUT_DATA:
                raise item.child("count").error("is too many elements without data", f"{MOST_WITHOUT_DATA} in a file")
            array = np.zeros((count, width), dtype)
        if item.has("sparse"):
            array = self._replaced(array.copy(), item.table("sparse"))
        return array

    def _replaced(self, array: NDArray[Any], sparse: Item) -> NDArray[Any]:
        """The array with the rows that a sparse accessor replaces."""
        count = sparse.integer("count", low=1, high=len(array))
        places = sparse.table("indices")
        rows = self._elements(places, count, 1, _component(places))[:, 0]
        if rows.dtype.kind != "u" or int(rows.max()) >= len(array):
            raise places.where.error("has an index out of range", allowed=f"unsigned integers, 0 to {len(array) - 1}")
        array[rows] = self._elements(sparse.table("values"), count, array.shape[1], array.dtype)
        return array

    def _elements(self, item: Item, count: int, width: int, dtype: np.dtype[Any]) -> NDArray[Any]:
        """``count`` elements of a buffer view, which is long enough for them."""
        index = item.index("bufferView", len(self._document.objects("bufferViews")))
        if index is None:
            raise item.where.error("names no bufferView", allowed="bufferView = a number")
        view = self._document.view(index)
        offset = item.integer("byteOffset", 0)
        size = width * dtype.itemsize
        stride = view.stride or size
        if stride < size:
            raise item.where.error(f"has elements of {size} bytes, {stride} bytes apart", allowed=f"at least {size}")
        if offset + stride * (count - 1) + size > len(view.data):
            raise item.where.error(
                f"needs {offset + stride * (count - 1) + size} bytes of its bufferView",
                allowed=f"up to {len(view.data)}",
            )
        return np.ndarray((count, width), dtype, view.data, offset, (stride, dtype.itemsize))


def _component(item: Item) -> np.dtype[Any]:
    number = item.integer("componentType")
    if number not in COMPONENTS:
        raise item.child("componentType").error("is not a type of components", ", ".join(map(str, COMPONENTS)))
    found: np.dtype[Any] = COMPONENTS[number]
    return found
