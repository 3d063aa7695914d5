"""Small model files, written by the tests themselves."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Table = dict[str, Any]

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype="<f4")
"""A unit square that faces +z."""

SQUARE_UVS = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype="<f4")
"""Its texture coordinates as glTF counts them: (0, 0) is the upper left corner of a picture."""

TWO_TRIANGLES = np.array([0, 1, 2, 0, 2, 3], dtype="<u2")
WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
COMPONENTS = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123, "uint32": 5125, "float32": 5126}


class GltfFile:
    """A glTF document that grows; ``data`` may be changed at will before it is saved."""

    def __init__(self) -> None:
        self.blob = bytearray()
        self.data: Table = {"asset": {"version": "2.0"}}

    def add(self, section: str, item: Table) -> int:
        """Appends an object to a list of the file and returns its number."""
        self.data.setdefault(section, []).append(item)
        return len(self.data[section]) - 1

    def view(self, content: bytes, **more: Any) -> int:
        """A buffer view of these bytes."""
        self.blob += b"\0" * (-len(self.blob) % 4)
        offset = len(self.blob)
        self.blob += content
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(content), **more})

    def accessor(self, array: NDArray[Any], **more: Any) -> int:
        """An accessor of a (N,) or (N, width) array."""
        array = np.ascontiguousarray(array)
        width = 1 if array.ndim == 1 else array.shape[1]
        item = {
            "bufferView": self.view(array.tobytes()),
            "componentType": COMPONENTS[array.dtype.name],
            "count": len(array),
            "type": WIDTHS[width],
        }
        return self.add("accessors", {**item, **more})

    def mesh(self, material: int | None = None, name: str | None = None, **attributes: NDArray[Any]) -> int:
        """A mesh of one square, or of other POSITION, indices and attributes."""
        given: dict[str, Any] = {"POSITION": SQUARE, "indices": TWO_TRIANGLES, **attributes}
        indices = given.pop("indices")
        numbers = {key: self.accessor(array) for key, array in given.items()}
        primitive: Table = {"attributes": numbers}
        if indices is not None:
            primitive["indices"] = self.accessor(indices)
        if material is not None:
            primitive["material"] = material
        return self.add("meshes", {"primitives": [primitive], **({"name": name} if name else {})})

    def node(self, root: bool = True, **item: Any) -> int:
        """A node; of the scene's roots unless it is to be a child."""
        number = self.add("nodes", item)
        if root:
            self.data.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(number)
        return number

    def material(self, **item: Any) -> int:
        """A material."""
        return self.add("materials", item)

    def picture(self, pixels: NDArray[np.uint8], **sampler: Any) -> int:
        """A texture with these pixels in the buffer."""
        view = self.view(png(pixels))
        image = self.add("images", {"bufferView": view, "mimeType": "image/png"})
        texture: Table = {"source": image}
        if sampler:
            texture["sampler"] = self.add("samplers", sampler)
        return self.add("textures", texture)

    def square(self, material: Table, **attributes: NDArray[Any]) -> GltfFile:
        """The file with a node that shows a square of this material."""
        self.node(mesh=self.mesh(self.material(name="m", **material), **attributes))
        return self

    def glb(self) -> bytes:
        """The file as GLB."""
        data = {**self.data, **({"buffers": [{"byteLength": len(self.blob)}]} if self.blob else {})}
        text = json.dumps(data).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        if self.blob:
            binary = bytes(self.blob) + b"\0" * (-len(self.blob) % 4)
            chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks

    def text(self, uri: str | None = None) -> str:
        """The file as JSON, its buffer inside or at a URI."""
        inside = "data:application/octet-stream;base64," + base64.b64encode(self.blob).decode()
        buffer = {"byteLength": len(self.blob), "uri": uri or inside}
        return json.dumps({**self.data, **({"buffers": [buffer]} if self.blob else {})}, indent=1)

    def save(self, path: Path) -> Path:
        """Writes .glb or .gltf."""
        if path.suffix == ".glb":
            path.write_bytes(self.glb())
        else:
            path.write_text(self.text())
        return path


def png(pixels: NDArray[np.uint8]) -> bytes:
    """(height, width, channels) as a PNG file."""
    from io import BytesIO

    from PIL import Image

    stream = BytesIO()
    Image.fromarray(pixels[..., 0] if pixels.shape[2] == 1 else pixels).save(stream, "PNG")
    return stream.getvalue()


def every_feature() -> GltfFile:
    """A file that uses most of what is read: instances, textures, sparse accessors, extensions, lights, a camera."""
    file = GltfFile()
    pixels = np.arange(4 * 4 * 4, dtype=np.uint8).reshape(4, 4, 4) * 3 + 60
    picture = file.picture(pixels, wrapS=33071, wrapT=33648, magFilter=9728)
    moved = {"extensions": {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [2, 3]}}}
    file.material(
        name="plastic",
        pbrMetallicRoughness={
            "baseColorFactor": [0.9, 0.8, 0.7, 1],
            "baseColorTexture": {"index": picture, **moved},
            "metallicRoughnessTexture": {"index": picture},
            "metallicFactor": 0.5,
        },
        normalTexture={"index": picture, "scale": 0.5},
        doubleSided=True,
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.2}},
    )
    file.material(name="leaf", alphaMode="MASK", pbrMetallicRoughness={"baseColorTexture": {"index": picture}})
    file.material(
        name="glass",
        pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0},
        extensions={
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.5]},
            "KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_dispersion": {"dispersion": 0.3},
        },
    )
    first = file.mesh(0, "panel", TEXCOORD_0=SQUARE_UVS, NORMAL=np.tile(np.array([[0, 0, 1]], "<f4"), (4, 1)))
    second = file.mesh(1, "leaf", TEXCOORD_0=SQUARE_UVS)
    third = file.mesh(2, "drop")
    values = file.view(np.array([[0, 1, 0.5]], "<f4").tobytes())
    places = file.view(np.array([3], "<u2").tobytes())
    sparse = {"count": 1, "indices": {"bufferView": places, "componentType": 5123}, "values": {"bufferView": values}}
    file.data["accessors"][file.data["meshes"][third]["primitives"][0]["attributes"]["POSITION"]]["sparse"] = sparse
    child = file.node(root=False, mesh=first, translation=[0, 0, -1], name="far")
    file.node(mesh=first, name="near", children=[child], rotation=[0, 0.3, 0, 0.95])
    file.node(mesh=second, scale=[1, 2, 1], translation=[1.5, 0, 0])
    file.node(mesh=third, matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1.5, 0, 0, 1])
    file.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.8, "aspectRatio": 1.5}})
    file.node(camera=0, translation=[0.5, 0.5, 4])
    lights = [{"type": "point", "intensity": 20, "color": [1, 0.9, 0.8]}, {"type": "spot", "spot": {}}]
    file.data["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    file.node(extensions={"KHR_lights_punctual": {"light": 0}}, translation=[0, 2, 2])
    file.node(extensions={"KHR_lights_punctual": {"light": 1}})
    return file
