"""Bad geometry, lights and cameras do not stop a render: what cannot be used is left out, counted and reported.

The rest of the picture keeps every bit. Everything is tried in a small scene and in one with `BALLAST`, because few
triangles and many are traced in different ways.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fair import FOLDER, Table, shipped

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray.cli import main
from accuray.scene import schema
from accuray.scene.motion import Motion
from accuray.scene.placements import Transforms

NAN, INF = float("nan"), float("inf")
SPP = 8
PLATE = [[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]]

every_size = pytest.mark.parametrize("ballast", [False, True], ids=["small", "large"])


def mesh(positions: Any, faces: Any, material: str = "grey", **more: Any) -> Table:
    positions = np.array(positions, dtype=np.float32).reshape(-1, 3)
    return {"type": "mesh", "positions": positions, "faces": faces, "material": material, **more}


def grid(n: int) -> Table:
    """A wall behind the plate of 2 n^2 triangles."""
    x, y = np.meshgrid(np.linspace(-2, 2, n + 1), np.linspace(0, 2, n + 1))
    positions = np.stack([x.ravel(), y.ravel(), np.full(x.size, -2.0)], axis=1)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return mesh(positions, np.stack([corner, corner + 1, corner + n + 2, corner + n + 1], axis=1).tolist())


BALLAST = {"wall": grid(20)}


def room(ballast: bool = False, shapes: Table | None = None, lights: Table | None = None, **more: Any) -> accuray.Scene:
    """A plate under a square lamp and a dim sky; `shapes` and `lights` add to it or replace by name."""
    description: Table = {
        "film": {"width": 24, "height": 24, "filter": {"type": "box"}},
        "camera": {"type": "perspective", "position": [0, 1, 4], "look_at": [0, 0.5, 0], "fov": 50},
        "materials": {
            "grey": {"type": "diffuse", "reflectance": 0.5},
            "lamp": {"type": "diffuse", "reflectance": 0, "emission": 4},
            "off": {"type": "diffuse", "reflectance": 0, "emission": 0},
            "black": {"type": "diffuse", "reflectance": 0},
            "glass": {"type": "dielectric", "ior": 1.5},
        },
        "shapes": {
            "plate": mesh(PLATE, [[0, 1, 2, 3]]),
            "lamp": {
                "type": "rectangle",
                "corner": [-0.5, 2, -0.5],
                "edge_u": [1, 0, 0],
                "edge_v": [0, 0, 1],
                "material": "lamp",
            },
            **(BALLAST if ballast else {}),
            **(shapes or {}),
        },
        "lights": {"sky": {"type": "constant", "radiance": 0.2}, **(lights or {})},
    }
    return accuray.Scene.from_dict(description | more)


def render(scene: accuray.Scene) -> accuray.Image:
    """The image, which must be whole: finite, nothing dropped."""
    image = accuray.render(scene, spp=SPP)
    assert np.isfinite(np.asarray(image)).all()
    assert image.film.dropped_total == 0
    return image


def same(image: accuray.Image, other: accuray.Image) -> bool:
    return bool(np.array_equal(image.film.sums, other.film.sums))


FIRST = [[0, 1, 2, 3]]
FIRST_THREE = [[0, 1, 2]]
LOST: dict[str, tuple[Table, dict[str, int]]] = {
    "nan vertex": (mesh([*PLATE, [NAN, 0, 0]], [*FIRST, [0, 1, 4]]), {"nonfinite_triangles": 1}),
    "infinite vertex": (mesh([*PLATE, [0, INF, 0]], [*FIRST, [0, 1, 4]]), {"nonfinite_triangles": 1}),
    "minus infinity": (mesh([*PLATE, [0, 0, -INF]], [[4, 1, 0], *FIRST]), {"nonfinite_triangles": 1}),
    "beyond all bounds": (mesh([*PLATE, [0, 3e38, 0]], [*FIRST, [0, 1, 4]]), {"nonfinite_triangles": 1}),
    "beyond Embree's bounds": (mesh([*PLATE, [0, 1e30, 0]], [*FIRST, [0, 1, 4]]), {"nonfinite_triangles": 1}),
    "nan in a polygon": (mesh([*PLATE, [NAN, NAN, NAN]], [*FIRST, [0, 1, 4, 2]]), {"nonfinite_triangles": 2}),
    "unused nan vertex": (mesh([*PLATE, [NAN, INF, 0]], FIRST), {}),
    "a corner twice": (mesh(PLATE, [*FIRST, [0, 1, 1]]), {"degenerate_triangles": 1}),
    "one point": (mesh(PLATE, [[2, 2, 2], *FIRST]), {"degenerate_triangles": 1}),
    "corners in a row": (mesh([*PLATE, [0, 0, 2]], [*FIRST, [0, 4, 1]]), {"degenerate_triangles": 1}),
    "equal corners": (mesh([*PLATE, PLATE[0]], [*FIRST, [0, 4, 1]]), {"degenerate_triangles": 1}),
    "both kinds": (
        mesh([*PLATE, [NAN, 0, 0]], [[0, 0, 0], *FIRST, [1, 2, 4], [3, 3, 1]]),
        {"nonfinite_triangles": 1, "degenerate_triangles": 2},
    ),
}
NOTHING: dict[str, Table] = {
    "no vertices": mesh([], []),
    "no faces": mesh(PLATE, []),
    "only nan": mesh([[NAN, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 1, 2]]),
    "only a line": mesh([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[0, 1, 2]]),
    "a thousand without area": mesh(PLATE, [[0, 1, 1], [2, 2, 2]] * 500),
    "lamp of nan": mesh([[NAN, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 1, 2]], "lamp"),
    "lamp without area": mesh([[0, 1, 0], [1, 1, 0], [0.5, 1, 0]], [[0, 1, 2]], "lamp"),
}


@every_size
@pytest.mark.parametrize("name", LOST)
def test_bad_triangles_are_left_out(name: str, ballast: bool) -> None:
    plate, report = LOST[name]
    image = render(room(ballast, {"plate": plate}))
    assert same(image, render(room(ballast)))
    reported = image.metadata.get("mesh_reports", {}).get("plate", {})
    counted = {key: reported[key] for key in ("nonfinite_triangles", "degenerate_triangles") if reported.get(key)}
    assert counted == report


@every_size
@pytest.mark.parametrize("name", NOTHING)
def test_shapes_without_area_change_nothing(name: str, ballast: bool) -> None:
    assert same(render(room(ballast, {"nothing": NOTHING[name]})), render(room(ballast)))


REFUSED: dict[str, tuple[Table, str]] = {
    "rectangle without width": ({"type": "rectangle", "edge_u": [0, 0, 0]}, "no area"),
    "rectangle of parallel edges": ({"type": "rectangle", "edge_u": [0, 1, 0], "edge_v": [0, 0.5, 0]}, "no area"),
    "flattened": ({**mesh(PLATE, FIRST), "transform": {"scale": [1, 0, 1]}}, "flattens"),
    "shrunk to a point": ({**mesh(PLATE, FIRST), "transform": {"scale": 0}}, "flattens"),
    "corners that are not there": (mesh(PLATE, [[0, 1, 4]]), "vertex 4 does not exist"),
    "disk without a direction": ({"type": "disk", "normal": [0, 0, 0]}, "no direction"),
}
"""What is described by few numbers, so that a mistake in one of them is worth an error, and a word of the error."""


@pytest.mark.parametrize("name", REFUSED)
def test_single_shapes_without_area_are_errors(name: str) -> None:
    shape, word = REFUSED[name]
    with pytest.raises(accuray.SceneError, match=rf"shapes\.bad.*{word}"):
        accuray.render(room(False, {"bad": {"material": "lamp", **shape}}), spp=1)


@every_size
@pytest.mark.parametrize("width", [1e-6, 1e-12, 1e-20, 1e-30, 1e-38])
def test_lamps_that_are_slivers_give_no_light_to_speak_of(width: float, ballast: bool) -> None:
    """A lit triangle next to nothing wide: all pixels are finite, none shines, and the mean stays where it was."""
    sliver = mesh([[0, 0, 0.5], [1, 0, 0.5], [0.5, width, 0.5]], FIRST_THREE, "lamp")
    seen, without = render(room(ballast, {"sliver": sliver})), render(room(ballast))
    assert np.asarray(seen).mean() == pytest.approx(np.asarray(without).mean(), rel=0.05)
    assert np.asarray(seen).max() < 1.5 * np.asarray(without).max()


@every_size
def test_a_mirrored_shape_is_its_mirror_image(ballast: bool) -> None:
    """By a transform, as by hand: negative scales turn neither the front nor the light of a lamp round."""
    leaning = [[-1, 1.0, 0], [0.5, 1.2, 0], [0.5, 1.4, 0.7]]
    by_hand = mesh(np.array(leaning) * [-1, 1, 1], [[0, 2, 1]], "lamp")
    mirrored = {**mesh(leaning, FIRST_THREE, "lamp"), "transform": {"scale": [-1, 1, 1]}}
    a, b = (np.asarray(render(room(ballast, {"bad": shape}))) for shape in (by_hand, mirrored))
    assert a.max() > 2.0
    assert a.mean() == pytest.approx(b.mean(), rel=0.02)


@pytest.mark.parametrize(
    ("positions", "warning"),
    [
        ("[nan, 0, 0], [0, 0, 0], [1, 0, 0]", "shapes.bad: left out 1 triangles with a vertex that is not finite"),
        ("[0, 0, 0], [1, 1, 1], [2, 2, 2]", "shapes.bad: left out 1 triangles without area"),
    ],
)
def test_command_line_warns(
    positions: str, warning: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(
        'accuray = 1\n[film]\nwidth = 8\nheight = 8\n[materials.m]\ntype = "diffuse"\n[lights.sky]\ntype = "constant"\n'
        f'[shapes.bad]\ntype = "mesh"\nmaterial = "m"\npositions = [{positions}]\nfaces = [[0, 1, 2]]\n',
        encoding="utf-8",
    )
    assert main(["render", "scene.toml", "--spp", "4"]) == 0
    assert warning in capsys.readouterr().err
    assert "bad" in accuray.Image.load("scene.exr").metadata["mesh_reports"]


@pytest.mark.parametrize("as_shapes", [False, True], ids=["in one mesh", "as shapes"])
def test_a_thousand_coincident_copies_look_like_one(as_shapes: bool) -> None:
    copies = (
        {f"copy{i}": mesh(PLATE, FIRST) for i in range(1000)} if as_shapes else {"plate": mesh(PLATE, FIRST * 1000)}
    )
    assert same(render(room(True, copies)), render(room(True)))


DARK: dict[str, Table] = {
    "point": {"lights": {"a": {"type": "point", "position": [0, 1, 0], "intensity": 0}}},
    "last point": {"lights": {"z": {"type": "point", "position": [0, 1, 0], "intensity": 0}}},
    "disk": {"shapes": {"a": {"type": "disk", "center": [0, -1, 0], "material": "off"}}},
}


@every_size
@pytest.mark.parametrize("name", DARK)
def test_lights_without_power_change_nothing(name: str, ballast: bool) -> None:
    """The disk, which hides behind the plate, takes light away from below: compared with one that is no lamp."""
    plain = {"a": {**DARK[name]["shapes"]["a"], "material": "black"}} if "shapes" in DARK[name] else None
    assert same(render(room(ballast, **DARK[name])), render(room(ballast, plain)))


@pytest.mark.parametrize("integrator", ["path", "direct", "reference"])
def test_without_light_all_is_black(integrator: str) -> None:
    off = {"lamp": {"type": "disk", "center": [0, 2, 0], "material": "off"}}
    dark = {"sky": {"type": "constant", "radiance": 0}, "p": {"type": "point", "intensity": 0}}
    for lights in (dark, {"sky": dark["sky"]}):
        image = render(room(False, off, lights, integrator={"type": integrator}))
        assert not image.film.sums[..., :3].any()


def test_an_empty_scene_is_black() -> None:
    assert not accuray.render(accuray.Scene.from_dict({"film": {"width": 4, "height": 4}}), spp=4).film.sums.any()


def camera(position: list[float], look_at: list[float], fov: float = 50, **more: Any) -> Table:
    return {"type": "perspective", "position": position, "look_at": look_at, "fov": fov, **more}


BALL: Table = {"type": "sphere", "center": [0, 1, 1], "radius": 0.5, "material": "glass"}
CAMERAS: dict[str, Table] = {
    "inside glass": camera([0.1, 1.1, 0.9], [0, 0, 0]),
    "on the glass, looking in": camera([0, 1, 1.5], [0, 1, 0]),
    "on the glass, looking out": camera([0, 1, 1.5], [0, 1, 3]),
    "on the plate, looking along": camera([0, 0, 1], [0, 0, 0]),
    "on the plate, looking down": camera([0, 0, 1], [0, -1, 1], up=[0, 0, 1]),
    "on the plate's edge": camera([2, 0, 2], [0, 0, 0]),
    "on the plate's corner, looking away": camera([2, 0, 2], [4, 0, 4]),
    "on the lamp": camera([0, 2, 0], [0, 0, 0], up=[0, 0, 1]),
    "in the point light": camera([0, 0.5, 0], [0, 0, 1]),
    "in the middle of the ball": camera([0, 1, 1], [0, 0, 0]),
    "almost telescopic": camera([0, 1, 4], [0, 0.5, 0], 1e-3),
    "almost a half space": camera([0, 1, 4], [0, 0.5, 0], 179),
    "to the limits": camera([0, 1, 4], [0, 0.5, 0], 179.99),
    "nearly upside down": camera([0, 5, 0], [0, 0, 0], up=[1e-6, 1, 0]),
}


@every_size
@pytest.mark.parametrize("name", CAMERAS)
def test_cameras_in_bad_places(name: str, ballast: bool) -> None:
    lights = {"p": {"type": "point", "position": [0, 0.5, 0], "intensity": 1}}
    image = render(room(ballast, {"ball": BALL}, lights, camera=CAMERAS[name]))
    assert np.asarray(image).min() > -0.1


def test_from_the_middle_of_a_glass_ball_all_is_n_squared_bright() -> None:
    """In a field of radiance 1 every ray through the centre shows n^2, whatever is reflected on the way."""
    description: Table = {
        "film": {"width": 16, "height": 16},
        "camera": camera([0, 0, 0], [0, 0, -1], 120),
        "materials": {"glass": {"type": "dielectric", "ior": 1.5}},
        "shapes": {"ball": {"type": "sphere", "material": "glass"}},
        "lights": {"sky": {"type": "constant", "radiance": "E"}},
    }
    luminance = accuray.render(accuray.Scene.from_dict(description), spp=1024).film.mean()[:, :, 1]
    assert luminance.mean() == pytest.approx(2.25, rel=5e-3)


LENGTHS = (float, tuple, np.ndarray, Transforms)


def scaled(scene: accuray.Scene, factor: float) -> accuray.Scene:
    """The same scene, every length times a factor; the intensity of point lights goes with its square."""
    families = schema.current()

    def lengths(family: str, table: Table) -> Table:
        types = families.material_types if family == "material" else families.family(family).types
        params = types[table["type"]].params
        given = [p.name for p in params if p.unit == "m" and isinstance(table.get(p.name), LENGTHS)]
        found = {name: _times(table[name], factor) for name in given}
        if isinstance(table.get("transform"), Motion):
            poses = (pose._replace(move=_times(pose.move, factor)) for pose in table["transform"].poses)
            found["transform"] = replace(table["transform"], poses=tuple(poses))
        elif table.get("transform") is not None:
            found["transform"] = table["transform"] * np.array([[1, 1, 1, factor]] * 3 + [[1, 1, 1, 1]])
        return table | found

    shapes = {name: lengths("shape", table) for name, table in scene.shapes.items()}
    materials = {name: lengths("material", table) for name, table in scene.materials.items()}
    textures = {name: lengths("texture", table) for name, table in scene.textures.items()}
    lights = {name: lengths("light", table) for name, table in scene.lights.items()}
    for table in lights.values():
        if table["type"] == "ies":
            table["multiplier"] *= factor**2
        elif "intensity" in table:
            table["intensity"] = replace(table["intensity"], scale=table["intensity"].scale * factor**2)
    camera = lengths("camera", scene.camera)
    return replace(scene, shapes=shapes, materials=materials, textures=textures, lights=lights, camera=camera)


def _times(value: Any, factor: float) -> Any:
    if isinstance(value, Transforms):
        return Transforms(value.rows() * np.tile(np.float32([1, 1, 1, factor]), 3), None, None)
    if isinstance(value, np.ndarray):
        return (value * np.float32(factor)).astype(np.float32)
    return tuple(factor * x for x in value) if isinstance(value, tuple) else factor * value


@pytest.mark.parametrize("exponent", [-20, 20])
@pytest.mark.parametrize("name", shipped())
def test_a_million_times_larger_or_smaller_is_the_same_picture(name: str, exponent: int) -> None:
    """To the bit, because powers of two only change exponents: no length is hidden in the code."""
    scene = accuray.load(FOLDER / f"{name}.toml", overrides=["film.width=24", "film.height=24"])
    assert same(render(scaled(scene, 2.0**exponent)), render(scene))


FAR: dict[str, Callable[[float], str]] = {
    "sphere": lambda s: f'[shapes.x]\ntype = "sphere"\ncenter = [0, {3 * s}, 0]\nradius = {s}\nmaterial = "lamp"\n',
    "disk": lambda s: f'[shapes.x]\ntype = "disk"\ncenter = [0, {s}, 0]\nradius = {s}\nmaterial = "lamp"\n',
    "rectangle": lambda s: f'[shapes.x]\ntype = "rectangle"\nedge_u = [{s}, 0, 0]\nmaterial = "lamp"\n',
    "scale": lambda s: f'[shapes.x]\ntype = "sphere"\nmaterial = "lamp"\ntransform = {{ scale = {s} }}\n',
    "shift": lambda s: f'[shapes.x]\ntype = "sphere"\nmaterial = "lamp"\ntransform = {{ translate = [{s}, 0, 0] }}\n',
    "instance": lambda s: (
        '[shapes.p]\ntype = "sphere"\nmaterial = "lamp"\nprototype = true\n'
        f'[shapes.x]\ntype = "instance"\nof = "p"\ntransform = {{ scale = {1 / s} }}\n'
    ),
    "point": lambda s: f'[lights.x]\ntype = "point"\nposition = [0, {s}, 0]\nintensity = 1e30\n',
    "camera": lambda s: f'[camera]\ntype = "perspective"\nposition = [0, 0, {s}]\n',
}


@pytest.mark.parametrize("distance", [3e18, 1e38])
@pytest.mark.parametrize("kind", FAR)
def test_nothing_is_so_far_off_or_so_small_that_it_crashes(kind: str, distance: float, tmp_path: Path) -> None:
    """Either there is an image, or the scene is refused as others are."""
    text = 'accuray = 1\n[film]\nwidth = 16\nheight = 16\n[materials.lamp]\ntype = "diffuse"\nemission = 1\n'
    text += '[lights.sky]\ntype = "constant"\n' + FAR[kind](distance)
    for i, (x, y) in enumerate((x, y) for x in range(-6, 7) for y in range(-6, 7)):
        place = f"corner = [{x / 4}, {y / 4}, 0]\nedge_u = [0.2, 0, 0]\nedge_v = [0, 0.2, 0]\n"
        text += f'[shapes.ballast{i}]\ntype = "rectangle"\nmaterial = "lamp"\n{place}'
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "accuray", "render", "scene.toml", "--spp", "4"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert result.returncode in (0, 2), result.stderr
    assert "Traceback" not in result.stderr
    if result.returncode == 2:
        assert kind in ("point", "camera") or "shapes.x" in result.stderr


def test_a_ray_without_a_finite_sample_has_no_radiance_and_its_neighbours_have() -> None:
    """A lamp too bright for single precision: samples that see it are dropped, and only they."""
    lamp = {"type": "diffuse", "reflectance": 0, "emission": {"rgb": [1e301, 1e301, 1e301]}}
    scene = accuray.Scene.from_dict(
        {
            "materials": {"lamp": lamp},
            "shapes": {"ball": {"type": "sphere", "material": "lamp"}},
            "lights": {"sky": {"type": "constant", "radiance": "E"}},
        }
    )
    for spp in (1, 8):
        seen = accuray.radiance(scene, [[0, 0, 3]] * 2, [[0, 0, -1], [0, 0, 1]], spp)
        assert np.isnan(seen.mean[0]).all()
        assert np.isinf(seen.error[0]).all()
        assert np.isfinite(seen.mean[1]).all()
        assert np.isfinite(seen.error[1]).all() == (spp > 1)
