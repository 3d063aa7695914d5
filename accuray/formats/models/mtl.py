"""MTL, the materials of OBJ files: its statements as they stand, checked; ``mtl_materials`` says what they mean."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from accuray.scene.errors import SceneError
from accuray.scene.paths import MEBIBYTE, display_path

MAX_BYTES = 16 * MEBIBYTE
MAX_MATERIALS = 100_000

COLORS = ("Ka", "Kd", "Ks", "Ke", "Tf")
NUMBERS = ("Ns", "Ni", "d", "Tr", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "sharpness")
MAPS = (
    "map_Ka", "map_Kd", "map_Ks", "map_Ke", "map_Ns", "map_d", "map_Tr", "map_Pr", "map_Pm", "map_Ps",
    "map_Bump", "map_bump", "bump", "norm", "disp", "decal", "refl",
)  # fmt: skip
OPTION_COUNTS = {
    "-blendu": (1, 1), "-blendv": (1, 1), "-bm": (1, 1), "-boost": (1, 1), "-cc": (1, 1), "-clamp": (1, 1),
    "-imfchan": (1, 1), "-mm": (2, 2), "-o": (1, 3), "-s": (1, 3), "-t": (1, 3), "-texres": (1, 1), "-type": (1, 1),
}  # fmt: skip
"""Options of a map, and the least and most words that follow them."""


@dataclass(frozen=True)
class MtlMap:
    """A picture: its file as written, its options by name (with the dash), and the place for errors."""

    file: str
    options: dict[str, list[str]]
    place: str


@dataclass
class MtlMaterial:
    """The statements of one material."""

    name: str
    place: str
    colors: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    maps: dict[str, MtlMap] = field(default_factory=dict)
    illum: int = 2
    unknown: list[str] = field(default_factory=list)
    folder: Path = field(default_factory=Path)


def read(path: Path) -> dict[str, MtlMaterial]:
    """The materials in a file, by name; of two with one name the first. Raises SceneError."""
    shown = display_path(path)
    if path.stat().st_size > MAX_BYTES:
        raise SceneError(f"has {path.stat().st_size} bytes", file=shown, allowed=f"up to {MAX_BYTES}")
    text = path.read_bytes().decode("utf-8-sig", errors="replace")
    materials = parse(text, shown)
    for material in materials.values():
        material.folder = path.parent
    return materials


def parse(text: str, shown: str) -> dict[str, MtlMaterial]:
    """As ``read``, from a text; ``shown`` stands for the file in messages."""
    materials: dict[str, MtlMaterial] = {}
    current: MtlMaterial | None = None
    for number, line in enumerate(text.split("\n"), start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue

        def fail(problem: str, allowed: str, line_number: int = number, content: str = line) -> SceneError:
            return SceneError(problem, file=shown, line=line_number, allowed=allowed, shown=content)

        if words[0] == "newmtl":
            name = line.strip()[len("newmtl") :].partition(" #")[0].strip()
            current = MtlMaterial(name, f"{shown}:{number}")
            materials.setdefault(name, current)
            if len(materials) > MAX_MATERIALS:
                raise fail("is one material too many", f"up to {MAX_MATERIALS}")
        elif current is None:
            raise fail(f"{words[0][:40]!r} comes before any material", "newmtl NAME")
        else:
            _statement(current, words, f"{shown}:{number}", fail)
    return materials


Fail = Callable[[str, str], SceneError]


def _statement(material: MtlMaterial, words: list[str], place: str, fail: Fail) -> None:
    keyword, rest = words[0], words[1:]
    if keyword in COLORS:
        color = _color(rest, fail)
        if color is None:
            material.unknown.append(f"{keyword} {rest[0]}")
        else:
            material.colors[keyword] = color
    elif keyword in NUMBERS:
        values = [word for word in rest if word != "-halo"]
        if len(values) != 1:
            raise fail(f"{keyword} has {len(values)} numbers", "one number")
        material.numbers[keyword] = _number(values[0], fail)
    elif keyword == "illum":
        value = _number(rest[0], fail) if len(rest) == 1 else -1.0
        if not value.is_integer() or not 0 <= value <= 10:
            raise fail("illum is not a model of illumination", "a whole number from 0 to 10")
        material.illum = int(value)
    elif keyword in MAPS:
        material.maps[keyword] = _map(rest, place, fail)
    else:
        material.unknown.append(keyword[:60])


def _number(word: str, fail: Fail) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or "_" in word:
        raise fail(f"{word[:40]!r} is not a finite number", "a number such as 0.5")
    return value


def _color(words: list[str], fail: Fail) -> tuple[float, float, float] | None:
    """One number for grey or three; None for spectral curves and CIE XYZ."""
    if words and words[0] in ("spectral", "xyz"):
        return None
    values = [_number(word, fail) for word in words]
    if len(values) == 1:
        return values[0], values[0], values[0]
    if len(values) != 3:
        raise fail(f"a colour has {len(values)} numbers", "1 or 3 numbers")
    return values[0], values[1], values[2]


def _map(words: list[str], place: str, fail: Fail) -> MtlMap:
    options: dict[str, list[str]] = {}
    at = 0
    while at < len(words) and words[at] in OPTION_COUNTS:
        least, most = OPTION_COUNTS[words[at]]
        end = at + 1 + least
        while end < min(len(words), at + 1 + most) and _is_number(words[end]):
            end += 1
        if end >= len(words):
            raise fail(f"{words[at]} is not followed by its values and a file", "an option, its values, a file name")
        options[words[at]] = words[at + 1 : end]
        at = end
    if at == len(words):
        raise fail("names no file", "a file name")
    return MtlMap(" ".join(words[at:]), options, place)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
