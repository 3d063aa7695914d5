"""Sessions: a scene becomes an image, pass by pass; and probes along single rays."""

from accuray.render.probe import Radiance, radiance
from accuray.render.session import Progress, render

__all__ = ["Progress", "Radiance", "radiance", "render"]
