"""Vertex colours: interpolated, from arrays and files, on every parameter; clear errors where there are none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.devices.lowering import lower

Table = dict[str, Any]
COLORS = np.array([[0.9, 0.9, 0.9, 1.0], [0.1, 0.1, 0.1, 0.5], [0.4, 0.4, 0.4, 0.0]])
#: A triangle in the plane z = 0 whose front side is +z.
TRIANGLE: Table = {
    "type": "mesh",
    "material": "m",
    "positions": [[0, 0, 0], [4, 0, 0], [0, 4, 0]],
    "faces": [[0, 1, 2]],
}
AT = [[0.5, 0.5, 1.0], [3.0, 0.2, 1.0], [0.2, 3.0, 1.0], [1.3, 1.3, 1.0]]
WEIGHTS = np.array([[1 - (x + y) / 4, x / 4, y / 4] for x, y, _ in AT])


def scene(shape: Table, material: Table | None = None, **sections: Table) -> accuray.Scene:
    """A triangle whose emission, or the given material, shows its vertex colours, under a sky of radiance 1."""
    described = {
        "textures": {"t": {"type": "vertex_color"}},
        "materials": {
            "m": {"type": "diffuse", **({"reflectance": {"texture": "t"}} if material is None else material)}
        },
        "shapes": {"leaf": shape},
        "lights": {"sky": {"type": "constant", "radiance": 1}},
    }
    return accuray.Scene.from_dict({**described, **sections})


def seen(of: accuray.Scene, spp: int = 1024) -> tuple[Any, Any]:
    found = accuray.radiance(of, AT, [[0.0, 0.0, -1.0]] * len(AT), spp, wavelengths=[550.0])
    return found.mean[:, 0], found.error[:, 0]


def test_colours_are_interpolated_between_vertices() -> None:
    for colors in (COLORS, COLORS[:, :3], COLORS[:, :3].tolist(), COLORS.astype(np.float32)):
        mean, error = seen(scene({**TRIANGLE, "colors": colors}))
        assert (np.abs(mean - WEIGHTS @ COLORS[:, 0]) <= 5.0 * error + 1e-6).all()


def test_alpha_can_be_an_opacity() -> None:
    material = {"reflectance": 0, "opacity": {"texture": "t", "channel": "alpha"}}
    mean, error = seen(scene({**TRIANGLE, "colors": COLORS}, material), 1 << 14)
    assert (np.abs(mean - (1.0 - WEIGHTS @ COLORS[:, 3])) <= 5.0 * error).all()


def test_colours_above_one_can_be_an_emission() -> None:
    from accuray.devices.lowering import colour_arrays

    white = float(colour_arrays()[1][190])
    material = {"reflectance": 0, "emission": {"texture": "t", "scale": 2}}
    mean, _ = seen(scene({**TRIANGLE, "colors": 5 * COLORS[:, :3]}, material, lights={}), 1)
    assert np.allclose(mean, 10 * white * (WEIGHTS @ COLORS[:, 0]), rtol=1e-4)


def test_instances_keep_the_colours_of_their_prototype() -> None:
    copy = {"type": "instance", "of": "leaf", "transform": {"translate": [0, 0, 0.25]}}
    mean, error = seen(scene({}, shapes={"leaf": {**TRIANGLE, "colors": COLORS, "prototype": True}, "copy": copy}))
    assert (np.abs(mean - WEIGHTS @ COLORS[:, 0]) <= 5.0 * error + 1e-6).all()


def from_srgb(x: Any) -> Any:
    """IEC 61966-2-1."""
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


STORED = np.array([[255, 128, 0, 255], [51, 51, 51, 102], [0, 10, 200, 0]])


def ply(kind: str, channels: int) -> str:
    names = ("red", "green", "blue", "alpha")[:channels]
    largest = {"uchar": 1, "ushort": 257, "float": 1 / 255, "double": 1 / 255}[kind]
    properties = "".join(f"property {kind} {name}\n" for name in names)
    rows = "".join(
        " ".join(map(str, [*position, *((largest * value).tolist() for value in color[:channels])])) + "\n"
        for position, color in zip(TRIANGLE["positions"], STORED, strict=True)
    )
    xyz = "".join(f"property float {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat ascii 1.0\nelement vertex 3\n{xyz}{properties}element face 1\n"
        f"property list uchar int vertex_indices\nend_header\n{rows}3 0 1 2\n"
    )


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("kind", ["uchar", "ushort", "float", "double"])
def test_ply_colours_are_srgb_as_integers_and_linear_as_floats(tmp_path: Path, kind: str, channels: int) -> None:
    (tmp_path / "leaf.ply").write_text(ply(kind, channels), encoding="ascii")
    shape = {"type": "mesh", "material": "m", "file": "leaf.ply"}
    described = {"materials": {"m": {"type": "diffuse"}}, "shapes": {"leaf": shape}}
    colors = accuray.Scene.from_dict(described, folder=tmp_path).shapes["leaf"]["colors"]
    numbers = STORED / 255.0
    expected = np.concatenate(
        [numbers[:, :3] if kind in ("float", "double") else from_srgb(numbers[:, :3]), numbers[:, 3:]], 1
    )
    if channels == 3:
        expected[:, 3] = 1.0
    assert np.allclose(colors, expected, rtol=1e-6, atol=1e-7)


def test_obj_colours_are_srgb_and_white_where_they_are_missing(tmp_path: Path) -> None:
    text = "v 0 0 0\nv 4 0 0 1 0.5 0.2\nv 0 4 0 0.25 0 1\nf 1 2 3\n"
    (tmp_path / "leaf.obj").write_text(text, encoding="ascii")
    described = {
        "materials": {"m": {"type": "diffuse"}},
        "shapes": {"leaf": {"type": "mesh", "material": "m", "file": "leaf.obj"}},
    }
    made = accuray.Scene.from_dict(described, folder=tmp_path)
    expected = [[1, 1, 1, 1], [*from_srgb(np.array([1, 0.5, 0.2])), 1], [*from_srgb(np.array([0.25, 0, 1])), 1]]
    assert np.allclose(made.shapes["leaf"]["colors"], expected, rtol=1e-6)
    assert made.mesh_reports["leaf"]["missing_colors"] == 1


def test_colours_that_no_texture_shows_take_no_memory() -> None:
    shapes = [TRIANGLE, {**TRIANGLE, "colors": COLORS}]
    sizes = [lower(scene(shape, {}, textures={}))[0].bytes for shape in shapes]
    assert sizes[0] == sizes[1]


@pytest.mark.parametrize("shape", [TRIANGLE, {"type": "sphere", "material": "m"}], ids=lambda s: s["type"])
def test_a_shape_without_colours_is_named(shape: Table) -> None:
    with pytest.raises(accuray.SceneError, match=r'no vertex colours, .* "t" of materials.m.reflectance') as caught:
        scene(shape)
    assert caught.value.key == "shapes.leaf"


@pytest.mark.parametrize(
    ("change", "key", "complaint"),
    [
        ({"colors": COLORS[:2]}, "shapes.leaf.colors", "has 2 rows"),
        ({"colors": COLORS[:, :2]}, "shapes.leaf.colors", "has the shape"),
        ({"colors": [[1, 1, 1], [1, 1], [1, 1, 1]]}, "shapes.leaf.colors[1]", "is not a row of 3 numbers"),
        ({"colors": (255 * COLORS).astype(np.uint8)}, "shapes.leaf.colors", "is an array of uint8"),
        ({"colors": COLORS * np.nan}, "shapes.leaf.colors[0][0]", "is not a finite number"),
        ({"colors": -COLORS}, "shapes.leaf.colors[0][0]", "is out of range"),
        ({"colors": 3}, "shapes.leaf.colors", "is not a list"),
        ({"colors": [3, 4, 5]}, "shapes.leaf.colors[0]", "is not a row"),
    ],
)
def test_wrong_colours_are_named(change: Table, key: str, complaint: str) -> None:
    with pytest.raises(accuray.SceneError, match=complaint) as caught:
        scene({**TRIANGLE, **change})
    assert caught.value.key == key


def test_a_bump_map_cannot_come_from_vertex_colours() -> None:
    with pytest.raises(accuray.SceneError, match="cannot come from vertex colours") as caught:
        scene({**TRIANGLE, "colors": COLORS}, {"bump_map": "t"})
    assert caught.value.key == "materials.m.bump_map"
