"""The container: GLB chunks or JSON text, buffers, buffer views and what URIs name."""

from __future__ import annotations

import binascii
from base64 import b64decode
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote

from accuray.formats import json
from accuray.formats.gltf.item import Item
from accuray.scene.errors import Document, SceneError, Source, Where
from accuray.scene.paths import MEBIBYTE, Confinement, display_path

MAGIC = b"glTF"
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
MAX_JSON = 64 * MEBIBYTE
MAX_BUFFER = 1 << 34
"""Bytes of the JSON text, and of one buffer."""

SUPPORTED = frozenset(
    {
        "EXT_texture_webp",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
    }
)


class View(NamedTuple):
    """Bytes of a buffer view and the distance of its elements, 0 if they lie next to each other."""

    data: memoryview
    stride: int


class GltfDocument:
    """A file's JSON and the bytes that it refers to, which are read when they are first needed."""

    def __init__(self, root: Item, binary: bytes | None, files: Confinement) -> None:
        self.root = root
        self._binary = binary
        self._files = files
        self._lists: dict[str, list[Item]] = {}
        self._buffers: dict[int, memoryview] = {}
        self.unknown_extensions = self._check_extensions()

    def objects(self, name: str) -> list[Item]:
        """A list of the file's objects: "nodes", "meshes", ..."""
        if name not in self._lists:
            self._lists[name] = self.root.items(name)
        return self._lists[name]

    def view(self, index: int) -> View:
        """A buffer view by its number."""
        item = self.objects("bufferViews")[index]
        number = item.index("buffer", len(self.objects("buffers")))
        if number is None:
            raise item.where.error("names no buffer", allowed="buffer = a number")
        buffer = self._buffer(number)
        offset = item.integer("byteOffset", 0)
        size = item.integer("byteLength", low=1)
        if offset + size > len(buffer):
            raise item.where.error(
                f"ends at byte {offset + size} of its buffer",
                allowed=f"up to {len(buffer)} bytes, which the buffer has",
            )
        return View(buffer[offset : offset + size], item.integer("byteStride", 0, 0, 252))

    def resolve(self, uri: Item) -> Path:
        """The file that a URI names, below the folders that the scene may read. Raises SceneError."""
        return self._files.resolve(file_name(uri), uri.where)

    def _buffer(self, index: int) -> memoryview:
        if index not in self._buffers:
            self._buffers[index] = memoryview(self._read_buffer(index))
        return self._buffers[index]

    def _read_buffer(self, index: int) -> bytes:
        item = self.objects("buffers")[index]
        size = item.integer("byteLength", low=1, high=MAX_BUFFER)
        if not item.has("uri"):
            if index != 0 or self._binary is None:
                raise item.where.error(
                    "has no bytes", allowed="a uri, or to be the first buffer of a .glb with a BIN chunk"
                )
            found = self._binary
        elif item.text("uri").startswith("data:"):
            found = data_uri(item.child("uri"))
        else:
            found = self._read_file(item.child("uri"), size)
        if len(found) < size:
            raise item.child("byteLength").error(f"is more than the {len(found)} bytes that there are", f"{len(found)}")
        return found

    def _read_file(self, uri: Item, size: int) -> bytes:
        path = self.resolve(uri)
        if path.stat().st_size < size:
            raise uri.error(f"has {path.stat().st_size} bytes", f"at least the byteLength, {size}")
        with path.open("rb") as file:
            return file.read(size)

    def _check_extensions(self) -> list[str]:
        """Extensions that are used and not known. Raises SceneError if one of them is required."""
        for item in self.root.items("extensionsRequired"):
            if item.value not in SUPPORTED:
                raise item.error("is required and not supported", ", ".join(sorted(SUPPORTED)))
        used = [str(item.value) for item in self.root.items("extensionsUsed")]
        return [name for name in dict.fromkeys(used) if name not in SUPPORTED]


def open_document(path: Path, files: Confinement) -> GltfDocument:
    """Reads the JSON of a .gltf or .glb file and checks its version. Raises SceneError."""
    shown = display_path(path)
    try:
        if path.stat().st_size > MAX_BUFFER:
            raise SceneError(f"has {path.stat().st_size} bytes", file=shown, allowed=f"up to {MAX_BUFFER}")
        content = path.read_bytes()
    except OSError as error:
        raise SceneError(f"cannot be read ({error.strerror})", file=shown) from None
    binary: bytes | None = None
    glb = content.startswith(MAGIC)
    raw, binary = _chunks(content, shown) if glb else (content, None)
    if len(raw) > MAX_JSON:
        raise SceneError(f"has {len(raw)} bytes of JSON", file=shown, allowed=f"up to {MAX_JSON}")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(
            f"byte {error.start} of the JSON is not UTF-8 text", file=shown, allowed="UTF-8 text"
        ) from None
    data = json.parse(text, shown)
    source = Source(shown, None if glb else text, "json", path.parent)
    root = Item(data, Where(Document(data, source)))
    _check_version(root)
    return GltfDocument(root, binary, files)


def _check_version(root: Item) -> None:
    asset = root.table("asset")
    version = asset.child("version")
    if not isinstance(version.value, str) or not version.value.startswith("2."):
        raise version.error("is not a version that is read here", '"2.0"')
    if asset.has("minVersion") and asset.text("minVersion") != "2.0":
        raise asset.child("minVersion").error("is not a version that is read here", '"2.0"')


def _chunks(content: bytes, shown: str) -> tuple[bytes, bytes | None]:
    """The JSON text and the binary chunk of a GLB file."""

    def fail(offset: int, problem: str, allowed: str) -> SceneError:
        return SceneError(f"byte {offset}: {problem}", file=shown, allowed=allowed)

    def word(offset: int) -> int:
        return int.from_bytes(content[offset : offset + 4], "little")

    if len(content) < 20:
        raise fail(0, f"the file has {len(content)} bytes", "a header of 12 bytes and a chunk of JSON")
    if word(4) != 2:
        raise fail(4, f"version {word(4)} of the container is not read here", "2")
    if word(8) > len(content):
        raise fail(8, f"the length {word(8)} is more than the {len(content)} bytes that there are", f"{len(content)}")
    chunks: list[tuple[int, bytes]] = []
    offset, end = 12, word(8)
    while offset + 8 <= end and len(chunks) < 2:
        size = word(offset)
        if offset + 8 + size > end:
            raise fail(offset, f"the chunk of {size} bytes goes beyond the file", f"up to {end - offset - 8}")
        chunks.append((word(offset + 4), content[offset + 8 : offset + 8 + size]))
        offset += 8 + size
    if not chunks or chunks[0][0] != JSON_CHUNK:
        raise fail(16, "the first chunk is not JSON", "JSON")
    binary = chunks[1][1] if len(chunks) > 1 and chunks[1][0] == BINARY_CHUNK else None
    return chunks[0][1], binary


def data_uri(item: Item) -> bytes:
    """The bytes of a ``data:`` URI in base64. Raises SceneError."""
    header, comma, payload = str(item.value).partition(",")
    if not comma or not header.endswith(";base64"):
        raise item.error("is not a data URI that is read here", "data:TYPE;base64,...")
    try:
        return b64decode(unquote(payload) if "%" in payload else payload, validate=True)
    except (binascii.Error, ValueError) as error:
        raise item.where.error(f"is not base64 ({error})", allowed="data:TYPE;base64,...") from None


def file_name(item: Item) -> str:
    """The file name that a relative URI stands for; ``%20`` is a blank."""
    if not isinstance(item.value, str):
        raise item.error("is not a text", "a relative file name")
    name = unquote(item.value, errors="replace")
    if name.startswith("builtin:"):
        raise item.error("is not a file of the model", "a relative file name")
    return name
