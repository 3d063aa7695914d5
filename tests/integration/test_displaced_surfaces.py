"""Displaced surfaces in pictures: their outline, their shadow, the light on their slopes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray

BUMP = {"displacement_scale": 0.25, "displacement": "full"}
FULL = {"full": {"type": "gradient", "first": [1, 1, 1]}}


def ball(levels: int) -> dict[str, Any]:
    """A unit sphere as a mesh with the normals of the sphere."""
    octahedron = np.vstack([np.eye(3), -np.eye(3)])
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    shape = {"type": "mesh", "positions": octahedron, "faces": faces, "subdivision_levels": levels, "material": "grey"}
    mesh = accuray.triangles(
        accuray.Scene.from_dict({"materials": {"grey": {"type": "diffuse"}}, "shapes": {"it": shape}}), "it"
    )
    points = mesh.positions / np.linalg.norm(mesh.positions, axis=1)[:, None]
    return {"type": "mesh", "positions": points, "normals": points, "uvs": points[:, :2], "faces": mesh.faces}


@pytest.mark.parametrize(("keys", "radius"), [({}, 1.0), (BUMP, 1.25), ({**BUMP, "displacement_offset": 2}, 0.75)])
def test_the_outline_is_that_of_the_displaced_surface(keys: dict[str, Any], radius: float) -> None:
    scene = accuray.Scene.from_dict(
        {
            "film": {"width": 64, "height": 64, "hide_environment": True, "filter": {"type": "box"}},
            "camera": {"type": "orthographic", "position": [0, 0, 5], "look_at": [0, 0, 0], "height": 3},
            "lights": {"sky": {"type": "constant"}},
            "materials": {"grey": {"type": "diffuse"}},
            "textures": FULL,
            "shapes": {"ball": {**ball(5), "material": "grey", **keys}},
        }
    )
    image = accuray.render(scene, spp=16, seed=3)
    area = float(np.asarray(image.layers["alpha"], dtype=np.float64).mean()) * 9
    # 32 points of the great circle's quarter: the polygon's area is within 0.1 % of the disc's.
    assert area == pytest.approx(math.pi * radius**2, rel=3e-3)


def plateau(**sections: Any) -> accuray.Scene:
    """Ground that is 0.5 m high where x < 0, under parallel light that falls at 45 degrees towards +x."""
    texels = np.array([[[1.0, 0.0]]], dtype=np.float32).reshape(1, 2, 1)
    step = {"type": "image", "pixels": np.repeat(texels, 3, axis=2), "filter": "nearest", "wrap_u": "clamp"}
    ground = {"type": "rectangle", "corner": [-2, 0, 2], "edge_u": [4, 0, 0], "edge_v": [0, 0, -4]}
    keys = {"displacement": "step", "displacement_scale": 0.5, "subdivision_levels": 8, "material": "grey"}
    return accuray.Scene.from_dict(
        {
            "lights": {"sun": {"type": "directional", "direction": [1, -1, 0], "irradiance": 2}},
            "materials": {"grey": {"type": "diffuse", "reflectance": 0.5}},
            "textures": {"step": step},
            "shapes": {"ground": {**ground, **keys}},
            "integrator": {"type": "direct"},
            **sections,
        }
    )


def test_bumps_cast_shadows() -> None:
    # The shadow of a step of 0.5 m under 45 degrees is 0.5 m long; the step itself is 4 m / 256 wide.
    x = np.array([-1.0, -0.1, 0.05, 0.25, 0.45, 0.55, 1.0])
    origins = np.column_stack([x, np.full(7, 5.0), np.zeros(7)])
    result = accuray.radiance(plateau(), origins, np.tile([0.0, -1, 0], (7, 1)), 1, wavelengths=[550.0])
    lit = 2 * math.cos(math.pi / 4) * 0.5 / math.pi
    value = np.asarray(result.mean, dtype=np.float64).ravel()
    assert np.allclose(value, [lit, lit, 0, 0, 0, lit, lit], rtol=1e-4)


def test_the_flux_of_a_lamp_leaves_its_displaced_surface() -> None:
    # A ramp of slope 3/4 makes the lamp 5/4 as large, and so its radiance 4/5 of what it was.
    def radiance(**keys: Any) -> float:
        lamp = {"type": "rectangle", "corner": [-1, 0, 1], "edge_u": [2, 0, 0], "edge_v": [0, 0, -2]}
        glow = {"type": "diffuse", "reflectance": 0, "emission": {"illuminant": "D65", "flux": "100 lm"}}
        scene = accuray.Scene.from_dict(
            {
                "materials": {"glow": glow},
                "textures": {"ramp": {"type": "gradient"}},
                "shapes": {"lamp": {**lamp, "material": "glow", **keys}},
            }
        )
        result = accuray.radiance(scene, [[0.1, 5, 0.2]], [[0, -1, 0]], 4, wavelengths=[550.0])
        return float(np.asarray(result.mean).ravel()[0])

    tilted = radiance(displacement="ramp", displacement_scale=1.5, subdivision_levels=2)
    assert tilted == pytest.approx(0.8 * radiance(), rel=1e-4)
