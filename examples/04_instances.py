"""A hundred thousand pearls from one array: a nautilus of spheres, none of which is an object of Python.

Writes nautilus.exr, nautilus.png and pearls.npy, which a scene file may name too (`instances = "pearls.npy"`), into the
current folder:

    .venv/bin/python examples/04_instances.py
"""

import numpy as np

import accuray

PEARLS = 100_000

# A logarithmic spiral whose tube grows with it; pearls lie at random on the tube's wall, as large as the tube is wide.
rng = np.random.default_rng(1)
turn = 7.0 * np.pi * np.sqrt(rng.uniform(0.02, 1.0, PEARLS))
around = rng.uniform(0.0, 2.0 * np.pi, PEARLS)
radius = 0.02 * np.exp(0.18 * turn)
width = 0.42 * radius
x = (radius + width * np.cos(around)) * np.cos(turn)
y = (radius + width * np.cos(around)) * np.sin(turn)
z = width * np.sin(around)

# Three rows of four for each pearl: its size on the diagonal, its place in the last column.
transforms = np.zeros((PEARLS, 3, 4))
transforms[:, [0, 1, 2], [0, 1, 2]] = (0.05 * width)[:, None]
transforms[:, :, 3] = np.stack([x, y, z], axis=1)
kinds = (np.sin(14.0 * turn) > 0.5).astype(int)
np.save("pearls.npy", transforms)

scene = accuray.Scene.from_dict(
    {
        "film": {"width": 480, "height": 400},
        "camera": {"type": "perspective", "position": [0, -0.6, 3.6], "look_at": [0, 0.1, 0], "fov": 43},
        "lights": {
            "sky": {"type": "constant", "radiance": {"rgb": [0.5, 0.6, 0.8], "scale": 0.5}},
            "sun": {"type": "sun", "towards": [1, 1.5, 2], "irradiance": 3, "angular_diameter": 5},
        },
        "materials": {
            "shell": {"type": "diffuse", "reflectance": [0.85, 0.75, 0.65]},
            "stripe": {"type": "diffuse", "reflectance": [0.5, 0.18, 0.08]},
        },
        "shapes": {
            "pale": {"type": "sphere", "material": "shell", "prototype": True},
            "dark": {"type": "sphere", "material": "stripe", "prototype": True},
            "pearls": {"type": "instance", "of": ["pale", "dark"], "instances": transforms, "ids": kinds},
        },
    }
)
print(f"{PEARLS} instances, scene {scene.identity[:16]}")
image = accuray.render(scene, spp=64)
image.save("nautilus.exr")
image.save("nautilus.png")
print(f"nautilus.png, estimated relative error {image.relative_error:.1%}")
