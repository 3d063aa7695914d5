"""Scenes with the light and the geometry that people have: an environment map, a furnished room, lamps, a crowd."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import furniture, settings
from benchmarks.description import Material, Scene, camera, daylight, grey, mixed
from benchmarks.geometry import Mesh, bumpy_sphere, frame_around, quad_mesh

Quads = list[Any]
SILVER = Material("conductor", eta=0.2, k=3.9, roughness=0.5)
"""Rough, lest the sun's caustics decide everything."""


def matt(white: float, red: float, green: float) -> Material:
    """Lambert's law in a mixture of the Cornell box's paints."""
    return Material(reflectance=mixed(white, red, green))


def environment() -> Scene:
    """A knot of rough silver and a bumpy ball of paint on a grey ground under a map with a sun."""
    knot = furniture.surface(furniture.knot(2, 3, 0.5, 0.24, 0.14), 1200, 60)
    standing = furniture.placed(furniture.grid_mesh("knot", "silver", knot), (-0.35, 0.39, 0.0))
    ball = bumpy_sphere("ball", "paint", (0.95, 0.4, 0.15), 0.36, settings.SEGMENTS, settings.RINGS)
    ground = quad_mesh("ground", "grey", [[[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]]], 1.0)
    materials = {"silver": SILVER, "paint": matt(0.2, 0.75, 0.0), "grey": Material(reflectance=grey(0.5))}
    view = camera((0.2, 1.5, 3.6), (0.2, 0.35, 0.0), 36.0)
    return Scene("environment", (standing, ball, ground), materials, view, sky="sunny")


ROOM = (5.0, 3.0, 6.0)
"""Width, height and depth of the interior; its floor is at y = 0, its corner at the origin."""


def interior() -> Scene:
    """A furnished room of 200 000 triangles; light comes through a window in its left wall only."""
    smooth = [
        furniture.joined("columns", "white", _columns()),
        furniture.joined("vases", "green", _vases()),
        furniture.joined("spheres", "white", _spheres()),
        furniture.placed(_knot("knot", "silver"), (2.4, 1.12, 2.6)),
    ]
    flat = [quad_mesh(name, material, quads, 1.0) for name, (material, quads) in (_walls() | _boxes()).items()]
    materials = {
        "white": matt(1.0, 0.0, 0.0),
        "red": matt(0.2, 0.8, 0.0),
        "green": matt(0.2, 0.0, 0.8),
        "wood": matt(0.25, 0.4, 0.1),
        "silver": SILVER,
    }
    view = camera((3.1, 1.5, 5.9), (2.2, 1.15, 2.0), 66.0)
    return Scene("interior", (*flat, *smooth), materials, view, sky="sunny")


def _walls() -> dict[str, tuple[str, Quads]]:
    """Floor, walls and ceiling seen from inside, with a window in the wall x = 0."""
    w, h, d = ROOM
    left = [[0, 0, d], [0, 0, 0], [0, h, 0], [0, h, d]]
    window = [[0, 0.8, 4.6], [0, 0.8, 2.2], [0, 2.6, 2.2], [0, 2.6, 4.6]]
    white: Quads = frame_around(left, window)
    white += [[[w, 0, 0], [w, 0, d], [w, h, d], [w, h, 0]], [[w, 0, d], [0, 0, d], [0, h, d], [w, h, d]]]
    white += [[[0, h, 0], [w, h, 0], [w, h, d], [0, h, d]]]
    floor = [[0, 0, d], [w, 0, d], [w, 0, 0], [0, 0, 0]]
    back = [[0, 0, 0], [w, 0, 0], [w, h, 0], [0, h, 0]]
    return {"walls": ("white", white), "floor": ("wood", [floor]), "back": ("red", [back])}


def _boxes() -> dict[str, tuple[str, Quads]]:
    """A table, a frame in the window, and shelves full of books on the right."""
    rng = np.random.default_rng(5)
    wood, books = [], []
    wood += furniture.box((2.4, 0.7, 2.6), (1.8, 0.06, 1.0))
    for x in (1.6, 3.2):
        for z in (2.2, 3.0):
            wood += furniture.box((x, 0.335, z), (0.08, 0.67, 0.08))
    wood += furniture.box((0.0, 1.7, 3.4), (0.08, 1.8, 0.06)) + furniture.box((0.0, 1.7, 3.4), (0.08, 0.06, 2.4))
    for level in range(6):
        wood += furniture.box((4.78, 0.3 + 0.4 * level, 2.5), (0.4, 0.03, 3.6))
        for z in np.arange(0.8, 4.2, 0.06):
            size = rng.uniform((0.2, 0.2, 0.03), (0.3, 0.34, 0.055))
            books += furniture.box((4.78, 0.315 + 0.4 * level + size[1] / 2, float(z)), size.tolist())
    return {"shelves": ("wood", wood), "books": ("red", books)}


def _columns() -> list[Mesh]:
    """Fluted columns along the back wall."""

    def profile(v: NDArray[np.float64]) -> NDArray[np.float64]:
        return 0.16 - 0.03 * v + 0.05 * np.exp(-80.0 * v) + 0.05 * np.exp(-80.0 * (1.0 - v))

    grid = furniture.surface(furniture.lathe(profile, ROOM[1], 20, 0.12), 60, 161)
    return [furniture.placed(furniture.grid_mesh("c", "white", grid), (x, 0.0, 0.5)) for x in (0.5, 1.8, 3.1, 4.3)]


def _vases() -> list[Mesh]:
    """Three on the table and two on the floor."""

    def profile(v: NDArray[np.float64]) -> NDArray[np.float64]:
        return 0.07 + 0.05 * np.sin(2.0 * np.pi * v) * (1.0 - 0.5 * v)

    small = furniture.surface(furniture.lathe(profile, 0.35, 0, 0.0), 48, 97)
    places = ((1.75, 0.73, 2.9), (1.8, 0.73, 2.35), (3.1, 0.73, 2.5), (0.5, 0.0, 1.4), (4.2, 0.0, 4.6))
    return [furniture.placed(furniture.grid_mesh("v", "green", small), place) for place in places]


def _spheres() -> list[Mesh]:
    """Rippled balls on the floor and on the table."""
    places = (((1.2, 0.3, 4.2), 0.28), ((3.9, 0.36, 3.6), 0.33), ((2.95, 0.88, 2.85), 0.13))
    return [bumpy_sphere("s", "white", place, radius, 96, 96) for place, radius in places]


def _knot(name: str, material: str) -> Mesh:
    return furniture.grid_mesh(name, material, furniture.surface(furniture.knot(2, 3, 0.32, 0.16, 0.09), 301, 49))


def lamps() -> Scene:
    """The hall of ``benchmarks.lights`` with boxes and 10 000 lamps, from above: no lamp shines at the camera.

    A lamp is a thousandth of a pixel, and one that is seen or missed by chance would decide the comparison.
    """
    from benchmarks import lights

    positions, faces = lights.lamps(lights.LIMITED)
    walls = [
        [np.add(w["corner"], np.multiply(w["edge_u"], a) + np.multiply(w["edge_v"], b)) for a, b in CORNERS]
        for w in lights.walls().values()
    ]
    boxes = [quad for b in lights.boxes(lights.BOXES).values() for quad in furniture.box(b["center"], b["size"])]
    meshes = (
        quad_mesh("walls", "grey", walls + boxes, 1.0),
        Mesh("lamps", "lamp", positions, faces.astype(np.int32)),
    )
    materials = {"grey": Material(reflectance=grey(0.5)), "lamp": Material(reflectance=grey(0.0))}
    view = camera((0, 9.6, 1), (0, 0, 0), 56.0)
    return Scene("lamps", meshes, materials, view, daylight(60.0), "lamp", lamp_backs=True)


CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


def instanced() -> Scene:
    """Thousands of copies of two meshes of some 25 000 triangles under an overcast sky and a lamp."""
    knot = furniture.grid_mesh("knot", "red", furniture.surface(furniture.knot(2, 3, 0.5, 0.24, 0.15), 401, 33))
    rock = bumpy_sphere("rock", "white", (0.0, 0.0, 0.0), 0.6, 160, 80)
    side = 60.0
    ground = [[[-side, 0, side], [side, 0, side], [side, 0, -side], [-side, 0, -side]]]
    lamp = [[[-3, 9, -9], [-3, 9, -15], [3, 9, -15], [3, 9, -9]]]
    meshes = (knot, rock, quad_mesh("ground", "green", ground, 1.0), quad_mesh("lamp", "lamp", lamp, 1.0))
    materials = {
        "red": matt(0.3, 0.7, 0.0),
        "white": matt(1.0, 0.0, 0.0),
        "green": matt(0.5, 0.1, 0.4),
        "lamp": Material(reflectance=grey(0.0)),
    }
    places = crowd(settings.COPIES)
    copies = {"knot": places[::2], "rock": places[1::2]}
    view = camera((0.0, 6.0, 6.0), (0.0, 1.0, -14.0), 42.0)
    return Scene("instanced", meshes, materials, view, daylight(40.0), "lamp", sky="overcast", copies=copies)


def crowd(count: int) -> NDArray[np.float64]:
    """Transforms (count, 3, 4): scattered over 30 m x 40 m in heaps, turned at random, scaled by 0.5 to 1."""
    rng = np.random.default_rng(3)
    axes = rng.normal(size=(count, 4))
    w, x, y, z = (axes / np.linalg.norm(axes, axis=1, keepdims=True)).T
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    scale = rng.uniform(0.5, 1.0, count)
    place = np.column_stack([rng.uniform(-15, 15, count), 0 * scale, rng.uniform(-40, 0, count)])
    hill = 1.5 + np.sin(0.5 * place[:, 0]) * np.cos(0.4 * place[:, 2])
    place[:, 1] = 0.4 + hill * rng.uniform(0.0, 1.0, count)
    return np.concatenate([rotation * scale[:, None, None], place[:, :, None]], axis=2)


WORLDS: dict[str, Callable[[], Scene]] = {
    "environment": environment,
    "interior": interior,
    "lamps": lamps,
    "instanced": instanced,
}
"""Each made by a function: tens of megabytes, so none before it is asked for."""
