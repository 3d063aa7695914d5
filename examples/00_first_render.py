"""A first render: load a scene, render it, ask how accurate the picture is, save it.

Writes first-render.exr and first-render.png into the current folder:

    .venv/bin/python examples/00_first_render.py
"""

from pathlib import Path

import numpy as np

import accuray

SCENES = Path(__file__).parent.parent / "scenes"

# A scene is a text file; any value in it can be replaced when it is loaded.
scene = accuray.load(SCENES / "cornell-box.toml", overrides={"film.width": 256, "film.height": 256})

# Equal scene, seed and sample numbers give equal bits, with any number of threads.
image = accuray.render(scene, spp=64, seed=1)

# An image is an array: height x width x 3, linear Rec.709, float32.
pixels = np.asarray(image)
print(f"{image!r} has the mean colour {pixels.mean(axis=(0, 1))}")

# It also knows how far off it may be. First as a whole ...
print(f"estimated relative error of the picture: {image.relative_error:.1%}")

# ... then pixel by pixel: the standard error of red, green and blue ...
x, y = image.width // 2, image.height // 4
for name, value, error in zip("RGB", pixels[y, x], image.error[y, x], strict=True):
    print(f"pixel ({x}, {y}), {name}: {value:.4f} +- {error:.4f}")

# ... and of any region, where many pixels make a small error: here a square of the back wall.
size = image.width // 8
wall = image.region(x, x + size, y, y + size, confidence=0.95)
for name, mean, low, high in zip("RGB", wall.mean, wall.low, wall.high, strict=True):
    print(f"square of {wall.pixels} pixels, {name}: {mean:.5f}, with 95 % confidence in {low:.5f} to {high:.5f}")

# The EXR holds the picture, its error bars and the exact sums, so it can be extended later; the PNG is for looking at.
image.save("first-render.exr")
image.save("first-render.png")

# The samples 64 to 127 of the same pixels, added to what the file holds: the bits of a render with 128.
more = accuray.render(scene, samples=(64, 128), seed=1)
both = accuray.Image.merge([accuray.Image.load("first-render.exr"), more])
print(f"with twice the samples the error is {both.relative_error:.1%}")
