"""AccuRay: a physically based spectral renderer whose results can be trusted, explained and repeated.

    import accuray
    scene = accuray.load("scenes/cornell-box.toml")
    image = accuray.render(scene, spp=64)
    image.save("cornell-box.exr")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from accuray.version import __version__

if TYPE_CHECKING:
    from accuray.film import Image, ImageError
    from accuray.formats import load
    from accuray.render import Progress, Radiance, radiance, render
    from accuray.scene import Scene, SceneError, Spectrum

# Where each public name lives; a module is imported when one of its names is first used, so that `accuray --version`
# and the other small commands start at once.
_HOMES = {
    "Image": "accuray.film",
    "ImageError": "accuray.film",
    "load": "accuray.formats",
    "Progress": "accuray.render",
    "Radiance": "accuray.render",
    "radiance": "accuray.render",
    "render": "accuray.render",
    "Scene": "accuray.scene",
    "SceneError": "accuray.scene",
    "Spectrum": "accuray.scene",
}

__all__ = [
    "Image",
    "ImageError",
    "Progress",
    "Radiance",
    "Scene",
    "SceneError",
    "Spectrum",
    "__version__",
    "load",
    "radiance",
    "render",
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
