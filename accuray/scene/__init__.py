"""The scene description: models, units, validation. No rendering and no file formats (see ``accuray.formats``)."""

from accuray.scene.errors import SceneError
from accuray.scene.scene import Scene
from accuray.scene.spectrum import Spectrum

__all__ = ["Scene", "SceneError", "Spectrum"]
