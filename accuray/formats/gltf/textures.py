"""Textures: a picture with a sampler, a transform and what a material makes of it, as textures of a scene."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from numpy.typing import NDArray

from accuray.formats import image
from accuray.formats.gltf.document import GltfDocument, data_uri, file_name
from accuray.formats.gltf.item import Item
from accuray.formats.models.model import Model, Table
from accuray.formats.models.pictures import alpha_mask, tinted

WRAPS = {10497: "repeat", 33648: "mirror", 33071: "clamp"}
NEAREST = 9728
SUFFIXES = {"image/png": ".png", "image/jpeg": ".jpg", "image/webp": ".webp"}


@dataclass(frozen=True)
class Look:
    """What is made of a picture: colours, numbers, colours times ``tint``, or where alpha times a factor is enough.

    ``mask`` is (factor of alpha, cutoff); ``kept`` is the share of light that gloss above tinted colours keeps inside.
    """

    color_space: str
    tint: tuple[float, ...] | None = None
    mask: tuple[float, float] | None = None
    kept: float = 0.0


COLOR, DATA = Look("srgb"), Look("data")


class Textures:
    """Adds textures to a model, each once, and knows which set of coordinates a material reads."""

    def __init__(self, document: GltfDocument, model: Model) -> None:
        self._document = document
        self._model = model
        self._names: dict[Any, str] = {}
        self._pixels: dict[int, NDArray[Any]] = {}

    def coordinates(self, info: Item) -> int:
        """The number of the set of texture coordinates that a texture reference reads."""
        transform = info.extension("KHR_texture_transform")
        if transform is not None and transform.has("texCoord"):
            return transform.integer("texCoord")
        return info.integer("texCoord", 0)

    def name(self, info: Item, look: Look) -> str | None:
        """The name of the texture that a reference (``{"index": 0}``) stands for; None, with a note, if it has none."""
        index = info.index("index", len(self._document.objects("textures")))
        if index is None:
            raise info.where.error("names no texture", allowed="index = a number")
        texture = self._document.objects("textures")[index]
        webp = texture.extension("EXT_texture_webp")
        images = self._document.objects("images")
        source = texture.index("source", len(images))
        if source is None and webp is not None:
            source = webp.index("source", len(images))
        if source is None:
            self._model.note(texture.where.key, "has no picture of a kind that is read here")
            return None
        settings = self._sampler(texture) | transform_table(info)
        key = (source, look, tuple((k, str(v)) for k, v in settings.items()))
        if key not in self._names:
            self._names[key] = self._add(source, look, settings)
        return self._names[key]

    def _add(self, source: int, look: Look, settings: Table) -> str:
        item = self._document.objects("images")[source]
        table: Table = {"type": "image", **self._picture(item, source, look), **settings}
        name = self._model.free_name(self._model.textures, _picture_name(item, source))
        self._model.textures[name] = table
        return name

    def _picture(self, item: Item, source: int, look: Look) -> Table:
        if look.mask is not None:
            return {
                "pixels": alpha_mask(self._read(item, source), *look.mask),
                "color_space": "data",
                "filter": "nearest",
            }
        if look.tint is not None:
            return {"pixels": tinted(self._read(item, source), look.tint, look.kept), "color_space": "linear"}
        if item.has("uri") and not item.text("uri").startswith("data:"):
            self._document.resolve(item.child("uri"))
            return {"file": file_name(item.child("uri")), "color_space": look.color_space}
        return {"pixels": self._read(item, source), "color_space": look.color_space}

    def _read(self, item: Item, source: int) -> NDArray[Any]:
        """The pixels of a picture; those of integers have the sRGB curve."""
        if source not in self._pixels:
            try:
                self._pixels[source] = self._decoded(item)
            except (ValueError, OSError) as error:
                raise item.where.error(f"cannot be read: {error}", allowed="a PNG, JPEG or WebP picture") from None
        return self._pixels[source]

    def _decoded(self, item: Item) -> NDArray[Any]:
        if item.has("uri"):
            uri = item.child("uri")
            if not item.text("uri").startswith("data:"):
                return image.read(self._document.resolve(uri))
            mime = item.text("uri")[len("data:") :].partition(";")[0]
            return image.read_bytes(data_uri(uri), SUFFIXES.get(mime, ".png"))
        view = item.index("bufferView", len(self._document.objects("bufferViews")))
        if view is None:
            raise item.where.error("has no picture", allowed="a uri or a bufferView")
        mime = item.text("mimeType", "image/png")
        if mime not in SUFFIXES:
            raise item.child("mimeType").error("is not a type that is read here", ", ".join(SUFFIXES))
        return image.read_bytes(bytes(self._document.view(view).data), SUFFIXES[mime])

    def _sampler(self, texture: Item) -> Table:
        samplers = self._document.objects("samplers")
        index = texture.index("sampler", len(samplers))
        if index is None:
            return {}
        sampler, table = samplers[index], {}
        for key, param in (("wrapS", "wrap_u"), ("wrapT", "wrap_v")):
            number = sampler.integer(key, 10497)
            if number not in WRAPS:
                raise sampler.child(key).error("is no way of wrapping", ", ".join(map(str, WRAPS)))
            if WRAPS[number] != "repeat":
                table[param] = WRAPS[number]
        if sampler.integer("magFilter", 9729) == NEAREST:
            table["filter"] = "nearest"
        return table


def transform_table(info: Item) -> Table:
    """KHR_texture_transform in our coordinates, whose v runs upwards."""
    transform = info.extension("KHR_texture_transform")
    if transform is None:
        return {}
    x, y = transform.vector("offset", (0.0, 0.0))
    scale_x, scale_y = transform.vector("scale", (1.0, 1.0))
    angle = transform.number("rotation", 0.0)
    return {
        "uv_scale": [scale_x, scale_y],
        "uv_rotate": math.degrees(angle),
        "uv_translate": [x + scale_y * math.sin(angle), 1.0 - y - scale_y * math.cos(angle)],
    }


def _picture_name(item: Item, source: int) -> str:
    uri = item.child("uri").value
    file = PurePosixPath(uri).stem if isinstance(uri, str) and not uri.startswith("data:") else ""
    return item.name(file or f"picture {source}")
