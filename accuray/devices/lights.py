"""Named lights for the compiled builder."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from accuray import data
from accuray.devices.emitters import lamp
from accuray.scene import Spectrum

Values = dict[str, Any]


class LightLowering:
    """Adds the named lights of a scene to a builder.

    Args:
        builder: ``accuray._core.lower.SceneBuilder``.
        values: the builder's values of a light's parameters.
        spectrum: the builder's number of a spectrum.
        picture: the builder's number of a picture.
        need_rgb_table: called before colours are given to the builder.
    """

    def __init__(
        self,
        builder: Any,
        values: Callable[[Values], Values],
        spectrum: Callable[[Spectrum], Any],
        picture: Callable[[Any], int],
        need_rgb_table: Callable[[], None],
    ) -> None:
        self._builder = builder
        self._values = values
        self._spectrum = spectrum
        self._picture = picture
        self._need_rgb_table = need_rgb_table

    def add(self, light: Values) -> None:
        """Adds one light."""
        adders = {"environment": self._add_environment, "sky": self._add_sky, "sun": self._add_sun}
        adders.get(light["type"], self._add_lamp)(light)

    def _add_environment(self, light: Values) -> None:
        self._need_rgb_table()
        picture, srgb = self._picture(light["pixels"]), light["color_space"] == "srgb"
        self._builder.add_environment(self._values(light), matrix(light["transform"]), picture, srgb)

    def _add_sky(self, light: Values) -> None:
        values = self._values(light)
        coefficients = (np.array(numbers) for numbers in data.sky())
        self._builder.add_sky(values, values["ground_albedo"], *coefficients)

    def _add_sun(self, light: Values) -> None:
        irradiance = light["irradiance"]
        emission = self._spectrum(light["radiance"] if irradiance is None else irradiance)
        self._builder.add_sun(self._values(light), emission, irradiance is not None)

    def _add_lamp(self, light: Values) -> None:
        """One of a single spectrum, whose amount may be that of all of it."""
        from accuray._core import lower as core

        values = self._values({key: value for key, value in light.items() if not isinstance(value, Spectrum)})
        made = lamp(light, values, core.lamp_power)
        self._builder.add_light(light["type"], values, self._spectrum(made.emission), made.photometry)


def matrix(transform: Any) -> list[float] | None:
    """The upper three rows of a 4x4 matrix, row by row; None for none."""
    return None if transform is None else [float(value) for value in transform[:3].ravel()]
