"""A light meter: radiance along chosen rays, without a camera, as photometric numbers with error bars.

A round ceiling lamp shines on a white card, and the card is read like a photographer's grey card. Right below the
middle of the lamp the illuminance is known in closed form, so the meter can be checked by hand:

    .venv/bin/python examples/02_light_meter.py
"""

import math

import numpy as np

import accuray
from accuray import data

LUMINANCE = 3000.0  # of the lamp, cd/m^2
RADIUS, HEIGHT = 0.5, 2.0  # of the lamp and above the card, m
REFLECTANCE = 0.8  # of the card

scene = accuray.Scene.from_dict(
    {
        "materials": {
            "lamp": {
                "type": "diffuse",
                "reflectance": 0,
                "emission": {"illuminant": "F11", "luminance": f"{LUMINANCE} cd/m^2"},
            },
            "card": {"type": "diffuse", "reflectance": REFLECTANCE},
        },
        "shapes": {
            "lamp": {
                "type": "disk",
                "material": "lamp",
                "center": [0, HEIGHT, 0],
                "normal": [0, -1, 0],
                "radius": RADIUS,
            },
            "card": {
                "type": "rectangle",
                "material": "card",
                "corner": [-1, 0, 1],
                "edge_u": [5, 0, 0],
                "edge_v": [0, 0, -2],
            },
        },
    }
)

# Five rays from a hand's breadth above the card straight down, half a metre apart.
distance = np.array([0.0, 0.5, 1.0, 1.5, 2.0])
origins = np.stack([distance, np.full(5, 0.1), np.zeros(5)], axis=1)
directions = np.tile([0.0, -1.0, 0.0], (5, 1))
found = accuray.radiance(scene, origins, directions, spp=4096, space="xyz")

# Y is the integral of radiance times ybar over that of ybar (docs/conventions.md). It gives the luminance in cd/m^2,
# and that of a matte card of known reflectance gives the illuminance in lux.
luminance_of_y = data.LUMINOUS_EFFICACY * sum(data.observer().y)
lux = math.pi / REFLECTANCE * luminance_of_y * found.mean[:, 1]
error = math.pi / REFLECTANCE * luminance_of_y * found.error[:, 1]
for x, value, sigma in zip(distance, lux, error, strict=True):
    print(f"{x:3.1f} m from the middle: {value:7.2f} lx +- {sigma:.2f}")

# A disk of luminance L that fills the cone of half angle t gives E = pi L sin^2 t on the axis.
exact = math.pi * LUMINANCE * RADIUS**2 / (RADIUS**2 + HEIGHT**2)
print(
    f"below the middle of the lamp theory says {exact:.2f} lx: {(lux[0] - exact) / error[0]:+.1f} standard errors off"
)

# The same rays by wavelength, in W m^-2 sr^-1 nm^-1: the lamp's mercury line at 545 nm beside the gap at 520 nm.
spectral = accuray.radiance(scene, origins[:1], directions[:1], spp=4096, wavelengths=[520, 545])
gap, line = spectral.mean[0]
print(f"spectral radiance of the card: {gap:.2e} at 520 nm, {line:.2e} at 545 nm")
