"""Sessions: a scene becomes an image, pass by pass; and probes along single rays."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

from accuray.film import Image
from accuray.render.frames import frame_path, parse_frames
from accuray.render.probe import Radiance, radiance
from accuray.render.sequence import FoundFrame, Frame, find_frame, render_frames
from accuray.render.session import Progress, render

__all__ = [
    "FoundFrame",
    "Frame",
    "Progress",
    "Radiance",
    "find_frame",
    "frame_path",
    "parse_frames",
    "radiance",
    "render",
    "render_frames",
]


class _CallableModule(ModuleType):
    """``accuray.render`` names both this package and the function; whichever Python binds last, it can be called."""

    def __call__(self, *args: Any, **kwargs: Any) -> Image:
        return render(*args, **kwargs)


sys.modules[__name__].__class__ = _CallableModule
