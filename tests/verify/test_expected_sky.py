"""What chapter C9 of `accuray.verify` expects of the sky agrees with the model, evaluated elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from accuray.verify import sky
from tests.oracles import hosek_wilkie

RADIUS = math.radians(0.533 / 2)


@pytest.mark.parametrize("key", sky.SEEN)
def test_radiance(key: tuple[float, ...]) -> None:
    wavelength, turbidity, albedo, *angles = key
    elevation, zenith, gamma = np.radians(angles)
    value = hosek_wilkie.radiance(wavelength, turbidity, albedo, elevation, np.array(zenith), np.array(gamma))
    assert float(value) == pytest.approx(sky.SEEN[key], rel=1e-8)


@pytest.mark.parametrize("key", sky.ON_THE_GROUND)
def test_irradiance_of_the_sky(key: tuple[float, ...]) -> None:
    wavelength, turbidity, albedo, elevation = key
    value = hosek_wilkie.irradiance(wavelength, turbidity, albedo, math.radians(elevation))
    assert value == pytest.approx(sky.ON_THE_GROUND[key], rel=1e-8)


@pytest.mark.parametrize("key", sky.UNDER_THE_SUN)
def test_irradiance_of_the_sky_and_its_sun(key: tuple[float, ...]) -> None:
    wavelength, turbidity, albedo, elevation = key
    up = math.radians(elevation)
    disc = hosek_wilkie.sun_irradiance(round((wavelength - 320) / 40), turbidity, up, RADIUS) * math.sin(up)
    value = hosek_wilkie.irradiance(wavelength, turbidity, albedo, up) + disc
    assert value == pytest.approx(sky.UNDER_THE_SUN[key], rel=1e-8)
