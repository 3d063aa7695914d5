"""The scenes that come with the renderer load, and the Cornell box is the measured one."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from accuray import data
from accuray.formats import load
from accuray.scene import Scene
from accuray.scene.jsonschema import json_schema

SCENES = Path(__file__).resolve().parents[2] / "scenes"
FILES = sorted(SCENES.glob("*.toml"))


def area(scene: Scene, name: str) -> float:
    """Area of a mesh in square millimetres."""
    points = scene.shapes[name]["positions"].astype(np.float64)[scene.shapes[name]["faces"]] * 1000
    cross = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    return float(np.linalg.norm(cross, axis=1).sum() / 2)


def test_all_are_there() -> None:
    names = {path.stem for path in FILES}
    assert names >= {"cornell-box", "spheres", "mirror-and-glass", "furnace", "closed-box", "sphere-cavity"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_loads_and_explains_itself(path: Path) -> None:
    scene = load(path)
    assert len(scene.identity) == 64
    assert path.read_text(encoding="utf-8").startswith("# "), "a scene opens with what it shows"


def test_identities_differ() -> None:
    assert len({load(path).identity for path in FILES}) == len(FILES)


def test_cornell_box_has_the_published_geometry() -> None:
    content = json.loads((data.FOLDER / "cornell_box_geometry.json").read_text(encoding="utf-8"))
    scene, areas = load(SCENES / "cornell-box.toml"), content["derived_areas_mm2"]
    assert scene.camera["position"] == (0.278, 0.273, -0.8)
    assert (scene.camera["focal_length"], scene.camera["film_size"]) == (0.035, 0.025)
    surfaces = {"lamp": "light", "ceiling": "ceiling_minus_hole"}
    for shape in ("floor", "ceiling", "lamp", "back-wall", "left-wall", "right-wall", "short-block", "tall-block"):
        surface = surfaces.get(shape, shape.replace("-", "_"))
        assert area(scene, shape) == pytest.approx(areas[surface], rel=1e-6), shape
    assert scene.shapes["left-wall"]["faces"].tolist() == [[0, 1, 2], [0, 2, 3]]


def test_cornell_box_has_the_published_paints_and_lamp() -> None:
    scene = load(SCENES / "cornell-box.toml")
    lamp = scene.materials["lamp"]
    assert [lamp["emission"].at(x) for x in (400, 500, 600, 700)] == [0, 8, 15.6, 18.4]
    assert lamp["reflectance"].value == 0.78
    for colour in ("white", "green", "red"):
        assert scene.materials[colour]["reflectance"].form == "table"


def test_lamp_shines_down_and_closed_box_inwards() -> None:
    for file, name, inside in (
        ("cornell-box", "lamp", (0.278, 0.2, 0.28)),
        ("mirror-and-glass", "lamp", (0.278, 0.2, 0.28)),
        ("closed-box", "room", (1.0, 0.6, 0.75)),
    ):
        shape = load(SCENES / f"{file}.toml").shapes[name]
        points = shape["positions"].astype(np.float64)[shape["faces"]]
        normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        assert (((np.array(inside) - points[:, 0]) * normals).sum(axis=1) > 0).all(), file


def test_json_schema_lists_every_key_of_the_shipped_scenes() -> None:
    import tomllib

    properties = json_schema()["properties"]
    for path in [*FILES, *SCENES.glob("parts/*.toml")]:
        assert set(tomllib.loads(path.read_text(encoding="utf-8"))) <= set(properties)
