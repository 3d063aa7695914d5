"""An image shows itself in a notebook."""

from __future__ import annotations

import io

import numpy as np
import PIL.Image
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray


def shown(width: int, height: int) -> PIL.Image.Image:
    """What a notebook shows of a small render."""
    scene = accuray.Scene.from_dict(
        {"film": {"width": width, "height": height}, "lights": {"sky": {"type": "constant"}}}
    )
    return PIL.Image.open(io.BytesIO(accuray.render(scene, spp=1)._repr_png_()))


def test_an_image_is_a_picture() -> None:
    picture = shown(24, 10)
    assert (picture.format, picture.mode, picture.size) == ("PNG", "RGB", (24, 10))
    assert np.asarray(picture).min() > 200


def test_a_large_image_is_shown_small() -> None:
    assert shown(1930, 20).size == (644, 7)
