"""Sessions: a scene becomes an image, pass by pass; and probes along single rays."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

from accuray.film import Image
from accuray.render.probe import Radiance, radiance
from accuray.render.session import Progress, render

__all__ = ["Progress", "Radiance", "radiance", "render"]


class _CallableModule(ModuleType):
    """``accuray.render`` names both this package and the function; whichever Python binds last, it can be called."""

    def __call__(self, *args: Any, **kwargs: Any) -> Image:
        return render(*args, **kwargs)


sys.modules[__name__].__class__ = _CallableModule
