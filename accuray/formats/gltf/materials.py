"""Materials: metallic-roughness and the KHR extensions as `openpbr`, which has a parameter for nearly all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from accuray.formats.gltf.document import SUPPORTED, GltfDocument
from accuray.formats.gltf.item import Item
from accuray.formats.gltf.textures import COLOR, DATA, Look, Textures
from accuray.formats.models.composing import MOST_PARTS, count_parts
from accuray.formats.models.model import Model, Options, Table
from accuray.formats.models.pictures import under_gloss
from accuray.scene.openpbr import kept_inside, weighted_ior

HEADER = ("opacity", "emission", "emission_sides", "normal_map")
VERTEX_COLORS = "vertex colours"
ABBE_OF_DISPERSION = 20.0
"""KHR_materials_dispersion gives 20 divided by Abbe's number."""


@dataclass(frozen=True)
class Surface:
    """A material of the scene, and what its meshes need: a set of coordinates, and the tint of vertex colours."""

    name: str
    coordinates: int = 0
    tint: tuple[float, ...] | None = None


@dataclass
class _Building:
    """One material on its way: the item, its table, which set of coordinates it reads, and how notes name it."""

    item: Item
    place: str
    table: Table = field(default_factory=lambda: {"type": "openpbr", "base_color": 1.0})
    coordinates: int | None = None


class Materials:
    """Adds materials to a model, each once with and once without the colours of vertices."""

    def __init__(self, document: GltfDocument, model: Model, options: Options) -> None:
        self._document = document
        self._model = model
        self._white = options.white_luminance
        self._textures = Textures(document, model)
        self._surfaces: dict[tuple[int | None, bool], Surface] = {}

    def surface(self, index: int | None, colored: bool) -> Surface:
        """The material of this number, None for the default one, of meshes with or without colours."""
        key = (index, colored)
        if key not in self._surfaces:
            item = Item({}, self._document.root.where) if index is None else self._document.objects("materials")[index]
            self._surfaces[key] = self._add(item, "default" if index is None else f"material {index}", colored)
        return self._surfaces[key]

    def _add(self, item: Item, fallback: str, colored: bool) -> Surface:
        name = self._model.free_name(self._model.materials, item.name(fallback))
        b = _Building(item, f"material {name}")
        pbr = item.table("pbrMetallicRoughness")
        factor = tuple(self._share(b, value) for value in pbr.vector("baseColorFactor", (1.0, 1.0, 1.0, 1.0)))
        tint = self._base(b, pbr, factor, colored)
        self._metal(b, pbr)
        self._clear(b)
        self._layers(b)
        self._film(b)
        self._opacity(b, pbr, factor[3], colored)
        self._emission(b)
        self._maps(b)
        self._unknown(b)
        self._finish(name, b)
        return Surface(name, b.coordinates or 0, tint)

    def _base(self, b: _Building, pbr: Item, factor: tuple[float, ...], colored: bool) -> tuple[float, ...] | None:
        """Base colour; returns what vertex colours are multiplied with, None if the material shows none."""
        kept = self._kept_under_gloss(b, pbr)
        texture = self._color(b, pbr, "baseColorTexture", factor[:3], kept)
        if texture is not None:
            b.table["base_color"] = texture
            if colored:
                self._model.note(b.place, "colours of vertices cannot be multiplied with a picture and were left out")
            return None
        if not colored:
            b.table["base_color"] = [under_gloss(value, kept) for value in factor[:3]]
            return None
        if kept > 0.0:
            self._model.note(b.place, "gloss darkens colours of vertices, which in glTF it does not")
        self._model.textures.setdefault(VERTEX_COLORS, {"type": "vertex_color"})
        b.table["base_color"] = {"texture": VERTEX_COLORS}
        return factor

    def _kept_under_gloss(self, b: _Building, pbr: Item) -> float:
        """Share of the light from a matte base that the surface above it would send back inside.

        glTF knows no such darkening (appendix B of its specification): the base is made so much brighter. Not so what
        is partly metal, whose colour is that of the metal as well, and what lets light through.
        """
        metal = pbr.number("metallicFactor", 1.0) > 0.0
        transmission = b.item.extension("KHR_materials_transmission")
        if metal or (transmission is not None and transmission.number("transmissionFactor", 0.0) > 0.0):
            return 0.0
        index, specular = b.item.extension("KHR_materials_ior"), b.item.extension("KHR_materials_specular")
        ior = 1.5 if index is None else min(max(index.number("ior", 1.5, 0.0), 1.0), 3.0)
        weight = 1.0 if specular is None else min(max(specular.number("specularFactor", 1.0), 0.0), 1.0)
        bare = weighted_ior(ior, weight)
        return kept_inside(1.0, bare) if bare > 1.0 else 0.0

    def _metal(self, b: _Building, pbr: Item) -> None:
        metal, rough = self._number(b, pbr, "metallicFactor", 1.0), self._number(b, pbr, "roughnessFactor", 1.0)
        b.table["base_metalness"] = self._scaled(b, pbr, "metallicRoughnessTexture", "blue", metal)
        b.table["specular_roughness"] = self._scaled(b, pbr, "metallicRoughnessTexture", "green", rough)
        anisotropy = b.item.extension("KHR_materials_anisotropy")
        if anisotropy is not None:
            self._anisotropy(b, anisotropy)

    def _anisotropy(self, b: _Building, extension: Item) -> None:
        """Strength to OpenPBR's anisotropy; both give the facets' alpha along and across the tangent."""
        strength = self._number(b, extension, "anisotropyStrength", 0.0)
        rough = b.table["specular_roughness"]
        if strength == 0.0:
            return
        if extension.has("anisotropyTexture") or isinstance(rough, dict):
            self._model.note(b.place, "anisotropy that varies over a surface was left out")
            return
        if extension.number("anisotropyRotation", 0.0) != 0.0:
            self._model.note(b.place, "anisotropyRotation was left out: highlights are stretched along u")
        across = rough * rough
        along = across + (1.0 - across) * strength * strength
        b.table["specular_roughness_anisotropy"] = 1.0 - across / along
        b.table["specular_roughness"] = (0.5 * (along * along + across * across)) ** 0.25

    def _clear(self, b: _Building) -> None:
        """Index, specular weight, transmission, volume and dispersion."""
        ior = b.item.extension("KHR_materials_ior")
        if ior is not None:
            index = ior.number("ior", 1.5, 0.0)
            b.table["specular_ior"] = min(max(index, 1.0), 3.0)
            if not 1.0 <= index <= 3.0:
                self._model.note(
                    b.place, f"ior {index:g} became {b.table['specular_ior']:g}, the nearest that there is"
                )
        specular = b.item.extension("KHR_materials_specular")
        if specular is not None:
            weight = self._number(b, specular, "specularFactor", 1.0)
            b.table["specular_weight"] = self._scaled(b, specular, "specularTexture", "alpha", weight)
            if specular.has("specularColorTexture") or set(specular.vector("specularColorFactor", (1.0,) * 3)) != {1.0}:
                self._model.note(b.place, "specularColorFactor was left out: dielectrics reflect all colours alike")
        transmission = b.item.extension("KHR_materials_transmission")
        if transmission is not None:
            share = self._number(b, transmission, "transmissionFactor", 0.0)
            b.table["transmission_weight"] = self._scaled(b, transmission, "transmissionTexture", "red", share)
        if b.table.get("transmission_weight", 0.0) != 0.0:
            self._volume(b)

    def _volume(self, b: _Building) -> None:
        volume = b.item.extension("KHR_materials_volume")
        if volume is None or volume.number("thicknessFactor", 0.0, 0.0) == 0.0:
            b.table["geometry_thin_walled"] = True
        elif volume.has("attenuationDistance"):
            color = tuple(self._share(b, value) for value in volume.vector("attenuationColor", (1.0, 1.0, 1.0)))
            b.table["transmission_color"] = list(color)
            b.table["transmission_depth"] = volume.number("attenuationDistance", low=1e-12)
        plain = isinstance(b.table["base_color"], list)
        if plain and "transmission_depth" not in b.table:
            b.table["transmission_color"] = b.table["base_color"]
        elif b.table["base_color"] != [1.0, 1.0, 1.0]:
            what = "attenuationColor does" if plain else "a picture cannot"
            self._model.note(b.place, f"the base colour does not tint what is transmitted; {what}")
        dispersion = b.item.extension("KHR_materials_dispersion")
        amount = 0.0 if dispersion is None else dispersion.number("dispersion", 0.0, 0.0)
        if amount > 0.0 and not b.table.get("geometry_thin_walled"):
            abbe = ABBE_OF_DISPERSION / amount
            b.table["transmission_dispersion_abbe_number"] = min(max(abbe, 9.0), 91.0)
            b.table["transmission_dispersion_scale"] = min(1.0, max(abbe, 9.0) / abbe, 91.0 / abbe)

    def _layers(self, b: _Building) -> None:
        """Clearcoat and sheen."""
        coat = b.item.extension("KHR_materials_clearcoat")
        if coat is not None and coat.number("clearcoatFactor", 0.0) > 0.0:
            weight = self._number(b, coat, "clearcoatFactor", 0.0)
            b.table["coat_weight"] = self._scaled(b, coat, "clearcoatTexture", "red", weight)
            rough = self._number(b, coat, "clearcoatRoughnessFactor", 0.0)
            b.table["coat_roughness"] = self._scaled(b, coat, "clearcoatRoughnessTexture", "green", rough)
            b.table["coat_ior"] = 1.5
            if isinstance(b.table["base_color"], list):
                b.table["coat_darkening"] = 0.0
            else:
                self._model.note(b.place, "the coat darkens the picture below it, which in glTF it does not")
            if coat.has("clearcoatNormalTexture"):
                self._model.note(b.place, "clearcoatNormalTexture was left out: a coat has the normal map of its base")
        sheen = b.item.extension("KHR_materials_sheen")
        if sheen is None:
            return
        color = tuple(self._share(b, value) for value in sheen.vector("sheenColorFactor", (0.0, 0.0, 0.0)))
        strength = max(color)
        if strength > 0.0:
            hue = tuple(value / strength for value in color)
            texture = self._color(b, sheen, "sheenColorTexture", hue)
            b.table["fuzz_weight"] = strength
            b.table["fuzz_color"] = list(hue) if texture is None else texture
            rough = self._number(b, sheen, "sheenRoughnessFactor", 0.0)
            b.table["fuzz_roughness"] = self._scaled(b, sheen, "sheenRoughnessTexture", "alpha", rough)

    def _film(self, b: _Building) -> None:
        film = b.item.extension("KHR_materials_iridescence")
        if film is None or film.number("iridescenceFactor", 0.0) == 0.0:
            return
        weight = self._number(b, film, "iridescenceFactor", 0.0)
        b.table["thin_film_weight"] = self._scaled(b, film, "iridescenceTexture", "red", weight)
        b.table["thin_film_ior"] = min(max(film.number("iridescenceIor", 1.3), 1.0), 3.0)
        thickest = film.number("iridescenceThicknessMaximum", 400.0, 0.0, 1e5)
        if film.has("iridescenceThicknessTexture") and film.number("iridescenceThicknessMinimum", 100.0) != 0.0:
            self._model.note(b.place, "iridescenceThicknessMinimum was left out: the texture's 0 is no film")
        b.table["thin_film_thickness"] = self._scaled(b, film, "iridescenceThicknessTexture", "green", thickest)

    def _opacity(self, b: _Building, pbr: Item, factor: float, colored: bool) -> None:
        mode = b.item.text("alphaMode", "OPAQUE")
        if mode not in ("OPAQUE", "MASK", "BLEND"):
            raise b.item.child("alphaMode").error("is no such mode", "OPAQUE, MASK, BLEND")
        if mode == "OPAQUE":
            return
        cutoff = b.item.number("alphaCutoff", 0.5)
        if mode == "MASK":
            name = self._name(b, pbr, "baseColorTexture", Look("data", mask=(factor, cutoff)))
            b.table["opacity"] = float(factor >= cutoff) if name is None else {"texture": name}
        else:
            b.table["opacity"] = self._scaled(b, pbr, "baseColorTexture", "alpha", factor, COLOR)
        if colored and not pbr.has("baseColorTexture"):
            if mode == "MASK":
                self._model.note(b.place, "alphaCutoff was not applied to the alpha of vertices, which is a share")
            b.table["opacity"] = {"texture": VERTEX_COLORS, "channel": "alpha"}

    def _emission(self, b: _Building) -> None:
        """Luminance: a white emission of 1 is 1 cd/m^2."""
        factor = b.item.vector("emissiveFactor", (0.0, 0.0, 0.0))
        if max(factor) <= 0.0:
            return
        extension = b.item.extension("KHR_materials_emissive_strength")
        strength = 1.0 if extension is None else extension.number("emissiveStrength", 1.0, 0.0)
        if b.table.get("opacity", 1.0) != 1.0:
            self._model.note(b.place, "emission was left out: a surface that light passes cannot emit")
            return
        texture = self._color(b, b.item, "emissiveTexture", tuple(max(0.0, value) for value in factor))
        scale = strength / self._white
        if texture is None:
            b.table["emission"] = {"rgb": [max(0.0, value) for value in factor], "scale": scale}
        else:
            b.table["emission"] = {**texture, "scale": texture.get("scale", 1.0) * scale}
        if b.item.boolean("doubleSided"):
            b.table["emission_sides"] = "both"

    def _maps(self, b: _Building) -> None:
        if b.item.has("normalTexture"):
            name = self._name(b, b.item, "normalTexture", DATA)
            scale = b.item.table("normalTexture").number("scale", 1.0)
            if name is not None and scale < 0.0:
                self._model.note(b.place, "a normal map of negative scale was left out")
            elif name is not None:
                b.table["normal_map"] = {"texture": name, "scale": scale}
        if b.item.has("occlusionTexture"):
            self._model.note(b.place, "occlusionTexture was left out: the renderer computes occlusion")

    def _unknown(self, b: _Building) -> None:
        for name in b.item.table("extensions").value:
            if name not in SUPPORTED:
                self._model.note(b.place, f"{name} was left out")

    def _finish(self, name: str, b: _Building) -> None:
        """Keeps within the parts that a material may be made of, and gives what is double-sided a back."""
        table = b.table
        if count_parts(table) > MOST_PARTS and "thin_film_weight" in table:
            table["thin_film_weight"] = 1.0
            self._model.note(b.place, "has too many layers: its film covers all of it")
        if count_parts(table) > MOST_PARTS:
            table.pop("fuzz_weight", None)
            self._model.note(b.place, "has too many layers: its sheen was left out")
        clear = table.get("transmission_weight", 0.0) != 0.0
        layered = table["base_metalness"] != 1.0 or "coat_weight" in table or "fuzz_weight" in table
        if b.item.boolean("doubleSided") and layered and not clear and 2 * count_parts(table) <= MOST_PARTS:
            header = {key: table.pop(key) for key in HEADER if key in table}
            self._model.materials[name] = {}  # the name is taken
            side = self._model.free_name(self._model.materials, f"{name}, one side")
            self._model.materials[side] = table
            table = {"type": "two_sided", "front": side, "back": side, **header}
        self._model.materials[name] = table

    def _number(self, b: _Building, item: Item, key: str, default: float) -> float:
        return self._share(b, item.number(key, default))

    def _share(self, b: _Building, value: float) -> float:
        """A number that is to lie from 0 to 1."""
        if not 0.0 <= value <= 1.0:
            self._model.note(b.place, f"the factor {value:g} was cut off to 0 to 1")
        return min(max(value, 0.0), 1.0)

    def _scaled(self, b: _Building, item: Item, key: str, channel: str, factor: float, look: Look = DATA) -> Any:
        """A channel of a texture times a factor; the factor alone without a texture, or if it is 0."""
        name = self._name(b, item, key, look) if factor != 0.0 else None
        if name is None:
            return factor
        return {"texture": name, "channel": channel, **({} if factor == 1.0 else {"scale": factor})}

    def _color(self, b: _Building, item: Item, key: str, factor: Sequence[float], kept: float = 0.0) -> Table | None:
        """A texture times a colour, None without a texture; ``kept`` inside below gloss."""
        if kept > 0.0:
            name = self._name(b, item, key, Look("linear", tint=tuple(factor), kept=kept))
            return None if name is None else {"texture": name}
        grey = len(set(factor)) == 1
        name = self._name(b, item, key, COLOR if grey else Look("linear", tint=tuple(factor)))
        if name is None:
            return None
        return {"texture": name, **({"scale": factor[0]} if grey and factor[0] != 1.0 else {})}

    def _name(self, b: _Building, item: Item, key: str, look: Look) -> str | None:
        if not item.has(key):
            return None
        info = item.table(key)
        coordinates = self._textures.coordinates(info)
        if b.coordinates is None:
            b.coordinates = coordinates
        if coordinates != b.coordinates:
            self._model.note(
                b.place, f"{key} was left out: a mesh has one set of coordinates, here TEXCOORD_{b.coordinates}"
            )
            return None
        return self._textures.name(info, look)
