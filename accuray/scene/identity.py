"""The identity of a scene: SHA-256 of its canonical description.

It covers every resolved value that changes a sample, so two scenes with the same identity have the same samples:
units and defaults are applied, floats are written in hexadecimal, arrays and files count by content. Names of
objects are part of it, because objects are lowered in the order of their names. Not part of it: samples per
pixel, seed, layers, exposure by EV or by ISO and shutter (except through ``film.unit``), white balance, file names,
spelling, order, comments.
"""

from __future__ import annotations

import hashlib
import json
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.scene.deformation import deforms
from accuray.scene.meshes import POLYGONS
from accuray.scene.motion import Motion
from accuray.scene.placements import Transforms
from accuray.scene.schema import Schema, Type
from accuray.scene.spectrum import Spectrum
from accuray.scene.textures import TextureUse

if TYPE_CHECKING:
    from accuray.scene.scene import Scene

DISPLAY_ONLY = {"film": ("exposure", "iso", "shutter", "white_balance"), "render": ("spp", "seed", "layers")}
_FIELDS_OF_FORM = {
    "constant": ("value",),
    "rgb": ("rgb", "white"),
    "table": ("wavelengths", "values", "extrapolate"),
    "blackbody": ("kelvin",),
    "sellmeier": ("A0", "B", "C"),
    "cauchy": ("A0", "B"),
}


def scene_identity(scene: Scene, schema: Schema) -> str:
    """64 hexadecimal digits."""
    text = json.dumps(canonical(scene, schema), sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def canonical(scene: Scene, schema: Schema) -> dict[str, Any]:
    """The canonical description: nested dicts of texts, integers and truth values."""
    textures = schema.family("texture").types
    shapes, lights = schema.family("shape").types, schema.family("light").types
    described: dict[str, Any] = {
        "sampling_version": schema.sampling_version,
        "film": _table("film", scene.film, schema.family("film").header),
        "render": _table("render", scene.render, schema.family("render").header),
        "filter": _object(scene.filter, schema.family("filter").types),
        "camera": _object(scene.camera, schema.family("camera").types),
        "integrator": _object(scene.integrator, schema.family("integrator").types),
        "textures": {name: _object(item, textures) for name, item in scene.textures.items()},
        "materials": {name: _object(item, schema.material_types) for name, item in scene.materials.items()},
        "lights": {name: _object(item, lights) for name, item in scene.lights.items()},
        "shapes": {name: _object(item, shapes) for name, item in scene.shapes.items()},
    }
    moving = [scene.camera, *scene.shapes.values()]
    if scene.clock.shutter and any(isinstance(table["transform"], Motion) or deforms(table) for table in moving):
        described["shutter"] = _value(scene.clock.shutter)
    return described


def _table(section: str, values: dict[str, Any], type_: Type) -> dict[str, Any]:
    hidden = DISPLAY_ONLY.get(section, ())
    return {key: item for key, item in _params(values, type_).items() if key not in hidden}


def _object(values: dict[str, Any], types: Mapping[str, Type]) -> dict[str, Any]:
    return {"type": values["type"], **_params(values, types[values["type"]])}


def _params(values: dict[str, Any], type_: Type) -> dict[str, Any]:
    """Canonical parameters, without the names that stand for contents which are described as well."""
    described: dict[str, Any] = {}
    for param in type_.params:
        others = [p for group in type_.sets().get(param.set_name, {}).values() for p in group if p.group != param.group]
        stands_for_others = param.kind in ("file", "text") and any(values[other.name] is not None for other in others)
        described[param.name] = None if stands_for_others else _value(values[param.name])
    if values.get(POLYGONS) is not None:
        described[POLYGONS] = _value(values[POLYGONS])
    return described


def _value(value: Any) -> Any:
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        return value.hex()
    if isinstance(value, (tuple, list)):
        return [_value(item) for item in value]
    if isinstance(value, Motion):
        return {"motion": _value(value.numbers())}
    if isinstance(value, Spectrum):
        fields = {key: _value(getattr(value, key)) for key in _FIELDS_OF_FORM[value.form]}
        flux = {"flux": True} if value.flux else {}
        return {"form": value.form, "scale": value.scale.hex(), **fields, **flux}
    if isinstance(value, TextureUse):
        return {"texture": value.texture, "scale": value.scale.hex(), "channel": value.channel}
    if isinstance(value, Transforms):
        return {"transforms": value.count, "sha256": value.sha256}
    if isinstance(value, Path):
        return {"sha256": _file_hash(value)}
    return {"dtype": value.dtype.str, "shape": list(value.shape), "sha256": _array_hash(value)}


_array_hashes: dict[int, str] = {}
"""Of arrays that cannot change, while they live: frames of an animation share them."""


def _array_hash(array: Any) -> str:
    key = id(array)
    if key not in _array_hashes:
        digest = hashlib.sha256(array).hexdigest()
        if array.flags.writeable:
            return digest
        _array_hashes[key] = digest
        weakref.finalize(array, _array_hashes.pop, key, None)
    return _array_hashes[key]


def _file_hash(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
