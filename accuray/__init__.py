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
    from accuray.render import (
        FoundFrame,
        Frame,
        Progress,
        Radiance,
        find_frame,
        frame_path,
        parse_frames,
        radiance,
        render,
        render_frames,
    )
    from accuray.scene import Scene, SceneError, Spectrum
    from accuray.scene.jsonschema import json_schema
    from accuray.scene.reference import reference_markdown

# Where each public name lives; a module is imported when one of its names is first used, so that `accuray --version`
# and the other small commands start at once.
_HOMES = {
    "Comparison": "accuray.film.comparing",
    "FoundFrame": "accuray.render",
    "Frame": "accuray.render",
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
    "find_frame": "accuray.render",
    "frame_path": "accuray.render",
    "json_schema": "accuray.scene.jsonschema",
    "load": "accuray.formats",
    "parse_frames": "accuray.render",
    "probe_writable": "accuray.film",
    "radiance": "accuray.render",
    "reference_markdown": "accuray.scene.reference",
    "render": "accuray.render",
    "render_frames": "accuray.render",
    "triangles": "accuray.devices.lowering",
}

__all__ = [
    "Comparison",
    "FoundFrame",
    "Frame",
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
    "find_frame",
    "frame_path",
    "json_schema",
    "load",
    "parse_frames",
    "probe_writable",
    "radiance",
    "reference_markdown",
    "render",
    "render_frames",
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
