"""AccuRay: a physically based spectral renderer whose results can be trusted, explained and repeated.

>>> import accuray
>>> scene = accuray.load("scenes/cornell-box.toml")
>>> image = accuray.render(scene, spp=64)
>>> image.save("cornell-box.exr")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from accuray.data.version import __version__

if TYPE_CHECKING:
    from accuray.devices import build_info, cache_folder
    from accuray.devices.lowering import triangles
    from accuray.devices.refining import Triangles
    from accuray.film import Image, ImageError, probe_writable
    from accuray.film.comparing import Comparison, compare
    from accuray.formats import convert, load
    from accuray.render import Progress, Radiance, radiance, render
    from accuray.scene import Scene, SceneError, Spectrum
    from accuray.scene.jsonschema import json_schema
    from accuray.scene.reference import reference_markdown

# Where each public name lives; a module is imported when one of its names is first used, so that `accuray --version`
# and the other small commands start at once.
_HOMES = {
    "Comparison": "accuray.film.comparing",
    "Image": "accuray.film",
    "ImageError": "accuray.film",
    "Progress": "accuray.render",
    "Radiance": "accuray.render",
    "Scene": "accuray.formats",
    "SceneError": "accuray.scene",
    "Spectrum": "accuray.scene",
    "Triangles": "accuray.devices.refining",
    "build_info": "accuray.devices",
    "cache_folder": "accuray.devices",
    "compare": "accuray.film.comparing",
    "convert": "accuray.formats",
    "json_schema": "accuray.scene.jsonschema",
    "load": "accuray.formats",
    "probe_writable": "accuray.film",
    "radiance": "accuray.render",
    "reference_markdown": "accuray.scene.reference",
    "render": "accuray.render",
    "triangles": "accuray.devices.lowering",
}

__all__ = [
    "Comparison",
    "Image",
    "ImageError",
    "Progress",
    "Radiance",
    "Scene",
    "SceneError",
    "Spectrum",
    "Triangles",
    "__version__",
    "build_info",
    "cache_folder",
    "compare",
    "convert",
    "json_schema",
    "load",
    "probe_writable",
    "radiance",
    "reference_markdown",
    "render",
    "triangles",
]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'accuray' has no attribute {name!r}")
    value = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
