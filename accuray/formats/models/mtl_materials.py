"""What the statements of an MTL material mean: glass, mirrors, or `openpbr`.

Phong's exponent becomes the width of facets with a highlight alike, alpha = sqrt(2 / (Ns + 2)) (Walter et al. 2007).
"""

from __future__ import annotations

import math
from pathlib import PurePosixPath
from typing import Any

from accuray.formats.models.model import Model, Options, Table
from accuray.formats.models.mtl import MtlMap, MtlMaterial
from accuray.scene.errors import Document, Source, Where
from accuray.scene.paths import display_path

GLASS = (4, 6, 7, 9)
MIRRORS = (3, 5, 8)
MATTE = (0, 1)
WITHOUT_MEANING = ("Ka", "map_Ka", "sharpness", "disp", "decal", "refl", "anisor", "Tf", "map_Ps", "map_Ks", "map_Ns")
"""Statements that nothing stands for; each is noted where it says something other than the default."""

BUMPS = ("map_Bump", "map_bump", "bump")


def translate(m: MtlMaterial, model: Model, options: Options) -> Table:
    """A material of the scene; its textures are added to the model. Raises SceneError for files that cannot be had."""
    maps = _Maps(m, model, options)
    opaque = _opacity(m)
    physical = "Pr" in m.numbers or "Pm" in m.numbers or "map_Pr" in m.maps or "map_Pm" in m.maps
    if m.illum in GLASS and opaque < 1.0 and not physical:
        table: Table = {"type": "dielectric", "ior": _clipped(m.numbers.get("Ni", 1.5), 1.0, 3.0)}
        rough = _roughness(m)
        if rough > 0.05:
            table["roughness"] = rough
        opaque = 1.0
    elif m.illum in MIRRORS and not physical and max(_color(m, "Ks", 0.0)) > 0.0:
        table = {"type": "conductor", "reflectance": _color(m, "Ks", 0.0), "roughness": _roughness(m)}
    else:
        table = _glossy(m, maps, physical)
    _header(m, maps, table, opaque)
    for word in [key for key in (*m.colors, *m.numbers, *m.maps) if key in WITHOUT_MEANING and not _is_default(m, key)]:
        model.note(m.place, f"{word} of the material {m.name} was left out")
    for word in m.unknown:
        model.note(m.place, f"{word} of the material {m.name} is not known and was left out")
    return table


def _glossy(m: MtlMaterial, maps: _Maps, physical: bool) -> Table:
    """A matte or metallic base, glossy if the material has highlights."""
    base = _color(m, "Kd", 1.0 if "map_Kd" in m.maps else 0.8)
    table: Table = {"type": "openpbr", "base_color": maps.color("map_Kd", base)}
    if physical:
        table["specular_roughness"] = maps.number("map_Pr", _clipped(m.numbers.get("Pr", 0.5)))
        table["base_metalness"] = maps.number("map_Pm", _clipped(m.numbers.get("Pm", 0.0)))
        _layers(m, table)
    elif m.illum in MATTE or max(_color(m, "Ks", 0.0)) == 0.0:
        table["specular_weight"] = 0.0
        return table
    else:
        table["specular_roughness"] = _roughness(m)
    index = m.numbers.get("Ni", 1.5)
    table["specular_ior"] = _clipped(index, 1.0, 3.0) if index > 1.0 else 1.5
    return table


def _layers(m: MtlMaterial, table: Table) -> None:
    """Clearcoat, sheen and anisotropy of the physically based statements."""
    if m.numbers.get("Pc", 0.0) > 0.0:
        table |= {"coat_weight": _clipped(m.numbers["Pc"]), "coat_roughness": _clipped(m.numbers.get("Pcr", 0.0))}
    if m.numbers.get("Ps", 0.0) > 0.0:
        table["fuzz_weight"] = _clipped(m.numbers["Ps"])
    if m.numbers.get("aniso", 0.0) > 0.0:
        table["specular_roughness_anisotropy"] = _clipped(m.numbers["aniso"])


def _header(m: MtlMaterial, maps: _Maps, table: Table, opaque: float) -> None:
    """Opacity, emission and maps of normals and heights."""
    alpha = maps.opacity(opaque)
    if alpha != 1.0:
        table["opacity"] = alpha
    emission = [max(0.0, value) for value in m.colors.get("Ke", (0.0, 0.0, 0.0))]
    if "map_Ke" in m.maps and max(emission) == 0.0:
        emission = [1.0, 1.0, 1.0]
    if max(emission) > 0.0:
        if alpha != 1.0:
            maps.model.note(
                m.place, f"Ke of the material {m.name} was left out: a surface that light passes cannot emit"
            )
        else:
            table["emission"] = maps.emission(emission)
    normal = maps.name("norm", "data")
    if normal is not None:
        table["normal_map"] = normal
    for key in BUMPS:
        height = maps.name(key, "data")
        if height is not None:
            table |= {"bump_map": {"texture": height, "scale": max(0.0, maps.option_number(key, "-bm", 1.0))}}
            break


class _Maps:
    """The pictures of one material as textures of the model."""

    def __init__(self, m: MtlMaterial, model: Model, options: Options) -> None:
        self._m = m
        self.model = model
        self._options = options
        self._known: dict[tuple[Any, ...], str] = {}

    def color(self, key: str, factor: list[float]) -> Any:
        """A texture, as it is usual without the factor unless that is grey; the colour without one."""
        name = self.name(key, "srgb")
        if name is None:
            return factor
        grey = len(set(factor)) == 1 and 0.0 < factor[0] < 1.0
        if len(set(factor)) > 1:
            self.model.note(self._m.place, f"{key} of the material {self._m.name} is not multiplied with its colour")
        return {"texture": name, **({"scale": factor[0]} if grey else {})}

    def number(self, key: str, value: float) -> Any:
        """A channel of a texture, the number without one."""
        name = self.name(key, "data")
        return value if name is None else {"texture": name, **self._channel(key)}

    def emission(self, factor: list[float]) -> Any:
        """Emission: white of 1 is Y = 1 over the model's white luminance."""
        scale = 1.0 / self._options.white_luminance
        name = self.name("map_Ke", "srgb")
        if name is None:
            return {"rgb": factor, "scale": scale}
        return {"texture": name, "scale": max(factor) * scale}

    def opacity(self, value: float) -> Any:
        """A share of light: map_d, or map_Tr the other way round, which is left out."""
        if "map_Tr" in self._m.maps:
            self.model.note(self._m.place, f"map_Tr of the material {self._m.name} was left out; map_d is read")
        name = self.name("map_d", "data")
        if name is None:
            return value
        return {"texture": name, **self._channel("map_d"), **({} if value == 1.0 else {"scale": value})}

    def option_number(self, key: str, option: str, default: float) -> float:
        """The number that follows an option of a map."""
        words = self._m.maps[key].options.get(option, [])
        try:
            value = float(words[0]) if words else default
        except ValueError:
            return default
        return value if math.isfinite(value) else default

    def name(self, key: str, color_space: str) -> str | None:
        """The texture of a map, None if the material has no such map. Raises SceneError for a wrong file."""
        given = self._m.maps.get(key)
        if given is None:
            return None
        table = {"type": "image", "file": self._file(given, key), "color_space": color_space, **self._wrap(given)}
        identity = tuple((k, str(v)) for k, v in table.items())
        for name, other in self.model.textures.items():
            if tuple((k, str(v)) for k, v in other.items()) == identity:
                return name
        stem = PurePosixPath(given.file.replace("\\", "/")).stem
        name = self.model.free_name(self.model.textures, stem)
        self.model.textures[name] = table
        return name

    def _file(self, given: MtlMap, key: str) -> str:
        """The file's name from the model's folder, once it is sure that it is one which may be read."""
        written = given.file.replace("\\", "/")
        where = Where(Document({}, Source(given.place, folder=self._m.folder)), (key,))
        path = self._options.files.resolve(written, where)
        folder = self.model.folder.resolve()
        return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else display_path(path)

    def _wrap(self, given: MtlMap) -> Table:
        table: Table = {}
        if given.options.get("-clamp") == ["on"]:
            table |= {"wrap_u": "clamp", "wrap_v": "clamp"}
        for option, param in (("-s", "uv_scale"), ("-o", "uv_translate")):
            words = given.options.get(option)
            if words is not None:
                default = ["1", "1"] if option == "-s" else ["0", "0"]
                table[param] = [_float(word) for word in [*words, *default[len(words) :]][:2]]
        left_out = sorted(set(given.options) - {"-clamp", "-s", "-o", "-bm", "-imfchan"})
        if left_out:
            self.model.note(given.place, f"{' '.join(left_out)} was left out")
        return table

    def _channel(self, key: str) -> Table:
        letter = (self._m.maps[key].options.get("-imfchan") or ["r"])[0]
        names = {"g": "green", "b": "blue", "m": "alpha"}
        return {"channel": names[letter]} if letter in names else {}


def _float(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        return 1.0
    return value if math.isfinite(value) else 1.0


def _color(m: MtlMaterial, key: str, default: float) -> list[float]:
    return [_clipped(value) for value in m.colors.get(key, (default,) * 3)]


def _clipped(value: float, low: float = 0.0, high: float = 1.0) -> float:
    return min(max(value, low), high)


def _roughness(m: MtlMaterial) -> float:
    """Square root of alpha for the exponent Ns; smooth from 900 on, where highlights are smaller than a pixel."""
    exponent = max(m.numbers.get("Ns", 0.0), 0.0)
    return 0.0 if exponent >= 900.0 and m.illum in (*GLASS, *MIRRORS) else (2.0 / (exponent + 2.0)) ** 0.25


def _opacity(m: MtlMaterial) -> float:
    return _clipped(m.numbers["d"]) if "d" in m.numbers else 1.0 - _clipped(m.numbers.get("Tr", 0.0))


def _is_default(m: MtlMaterial, key: str) -> bool:
    """Ambient light is what the renderer computes, and a filter of white or black is none."""
    return key in ("Ka", "map_Ka") or (key == "Tf" and set(m.colors["Tf"]) <= {0.0, 1.0})
