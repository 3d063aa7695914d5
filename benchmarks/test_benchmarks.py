"""What the benchmarks compare must be equal for all: geometry, colours, error measure. No renderer is needed."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from benchmarks import agreement, description, lights, measures, report, scenes, settings, sky, worlds
from benchmarks.drivers.ply import read_ply
from benchmarks.geometry import Mesh, bumpy_sphere, frame_around

TO_REC709 = np.linalg.inv(
    np.array([[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]])
)
HALF_LAST_DIGIT = 2e-5


def test_bumpy_sphere_is_closed_and_its_normals_fit() -> None:
    """Each edge is met once in each direction, positions deciding; the given normals are near those of the facets."""
    mesh = bumpy_sphere("sphere", "white", (0.1, 0.2, 0.3), 0.16, segments=160, rings=80)
    assert len(mesh.triangles) == 2 * 160 * 80
    assert mesh.normals is not None
    _, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    corners = place.reshape(-1)[mesh.triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    forward, backward = (set(map(tuple, pairs.tolist())) for pairs in (edges, edges[:, ::-1]))
    assert forward == backward
    assert len(forward) == len(edges)
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(np.float64) for k in range(3))
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    assert np.sum(flat * mesh.normals[mesh.triangles[:, 0]], axis=1).min() > 0.9


def test_frame_has_the_area_between_its_quads() -> None:
    """A 3 x 4 rectangle less a unit square, all of it facing the same way."""
    outer = [[0, 0, 0], [0, 0, 4], [3, 0, 4], [3, 0, 0]]
    hole = [[1, 0, 1], [1, 0, 2], [2, 0, 2], [2, 0, 1]]
    triangles = [np.array(quad, dtype=float)[[0, k, k + 1]] for quad in frame_around(outer, hole) for k in (1, 2)]
    normals = [np.cross(t[1] - t[0], t[2] - t[0]) / 2 for t in triangles]
    assert all(normal[1] > 0 for normal in normals)
    assert np.sum(normals, axis=0) == pytest.approx([0, 11, 0])


@pytest.mark.parametrize("name", ["white", "red", "green", "emission", "mixed", "daylight"])
def test_rgb_is_that_of_the_spectrum(name: str) -> None:
    """The constants for RGB renderers follow from the measured spectra."""
    spectrum = {
        **description.paints(),
        "emission": description.cornell_lamp(),
        "mixed": description.mixed(0.2, 0.5, 0.3),
        "daylight": description.daylight(1.0),
    }[name]
    cie = np.loadtxt(description.DATA / "cie1931_2deg_1nm.csv", delimiter=",", comments=["#", "w"])
    lights = np.loadtxt(description.DATA / "cie_illuminants_300_830_5nm.csv", delimiter=",", comments=["#", "w"])
    values = np.interp(cie[:, 0], spectrum.wavelengths, spectrum.values, left=0, right=0)
    light = np.ones(len(cie)) if name in ("emission", "daylight") else np.interp(cie[:, 0], lights[:, 0], lights[:, 3])
    xyz = cie[:, 1:].T @ (values * light) / (cie[:, 2] @ light)
    error = 3e-4 if name == "daylight" else HALF_LAST_DIGIT  # D65 is white to four digits only
    assert TO_REC709 @ xyz == pytest.approx(spectrum.rgb, abs=error, rel=error)


def test_all_forms_of_a_scene_hold_the_same_geometry(tmp_path: Path) -> None:
    """PLY and TOML give back every bit of the positions."""
    scene = scenes.build("cornell")
    folder = scenes.write(scene, tmp_path, size=16)
    neutral = json.loads((folder / "scene.json").read_text())
    text = tomllib.loads((folder / "scene.toml").read_text())
    for mesh, described in zip(scene.meshes, neutral["meshes"], strict=True):
        positions, triangles = read_ply(folder / described["file"])
        assert np.array_equal(positions, mesh.positions)
        assert np.array_equal(triangles, mesh.triangles)
        assert np.array_equal(np.array(text["shapes"][mesh.name]["positions"], dtype=np.float32), mesh.positions)
        assert text["shapes"][mesh.name]["faces"] == mesh.triangles.tolist()


def test_relative_mse_ignores_units_and_sees_noise() -> None:
    """A noise of 10 % has the relMSE that its definition gives, in any unit of radiance."""
    reference = np.broadcast_to(np.array([0.24, 0.14, 0.06], dtype=np.float32), (8, 8, 3)).copy()
    noisy = reference * np.where(np.arange(8) % 2, 1.1, 0.9).astype(np.float32)[:, None, None]
    scaled = reference.astype(np.float64) * measures.common_scale(reference)
    expected = np.mean(0.01 * scaled**2 / (scaled**2 + settings.RELATIVE_MSE_OFFSET))
    assert measures.relative_mse([noisy], reference) == pytest.approx(expected, rel=1e-5)
    assert measures.relative_mse([noisy * 1000], reference * 1000) == pytest.approx(expected, rel=1e-5)


def test_ratio_is_to_the_best_peer() -> None:
    """A renderer without a figure is left out."""
    rows = [{"renderer": "accuray", "samples_per_s": 4.0}, {"renderer": "cycles", "samples_per_s": 2.0}]
    rows += [{"renderer": "mitsuba:llvm_ad_spectral:independent", "samples_per_s": 5.0}, {"renderer": "luxcore"}]
    found = {row["what"]: row for row in report.ratios({"cornell": rows, "million": rows})}
    assert found["samples/s of Cycles"]["ratio"] == 2.0
    assert found["samples/s of the fastest peer, 1 M triangles"]["ratio"] == 0.8
    assert [row["met"] for row in found.values()] == [False, False, False]


def test_any_number_of_lamps_has_the_same_area_and_shines_down() -> None:
    """The flux of a flat lamp is its area times pi times its radiance, and it lights the floor."""
    for count in lights.COUNTS[:2]:
        positions, faces = lights.lamps(count)
        assert len(faces) == 2 * count
        a, b, c = (positions[faces[:, k]].astype(np.float64) for k in range(3))
        normal = np.cross(b - a, c - a)
        assert 0.5 * np.linalg.norm(normal, axis=1).sum() == pytest.approx(lights.LAMP_AREA, rel=1e-3)
        assert (normal[:, 1] < -0.6 * np.linalg.norm(normal, axis=1)).all()


def closed(mesh: Mesh) -> bool:
    """Whether each edge is met as often in one direction as in the other, by position to a micrometre."""
    _, place = np.unique(np.round(mesh.positions, 6), axis=0, return_inverse=True)
    corners = place.reshape(-1)[mesh.triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    forward, backward = (np.sort(pairs[:, 0] * len(place) + pairs[:, 1]) for pairs in (edges, edges[:, ::-1]))
    return bool(np.array_equal(forward, backward))


def volume(mesh: Mesh) -> float:
    """Enclosed by a closed mesh; negative if its fronts are inside."""
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(np.float64) for k in range(3))
    return float(np.sum(a * np.cross(b, c)) / 6.0)


def facing(mesh: Mesh) -> float:
    """The least cosine between a triangle and the normal of one of its corners."""
    assert mesh.normals is not None
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(np.float64) for k in range(3))
    flat = np.cross(b - a, c - a)
    area = np.linalg.norm(flat, axis=1)
    cosines = np.sum(flat * mesh.normals[mesh.triangles[:, 0]], axis=1) / np.maximum(area, 1e-30)
    return float(cosines[area > 1e-12].min())


def test_the_knot_is_closed_and_faces_outwards() -> None:
    """Its volume is near that of the tube: its section times its length."""
    scene = worlds.environment()
    knot = next(mesh for mesh in scene.meshes if mesh.name == "knot")
    assert closed(knot)
    assert facing(knot) > 0.9
    t = np.linspace(0.0, 2.0 * np.pi, 20001)
    reach = 0.5 + 0.24 * np.cos(3 * t)
    line = np.stack([reach * np.cos(2 * t), 0.24 * np.sin(3 * t), reach * np.sin(2 * t)], axis=1)
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    assert volume(knot) == pytest.approx(np.pi * 0.14**2 * length, rel=0.01)


def test_the_room_has_the_triangles_that_it_promises_and_its_fronts_inside() -> None:
    """Walls face the middle of the room, but for the window's."""
    scene = worlds.interior()
    assert 190_000 < sum(len(mesh.triangles) for mesh in scene.meshes) < 220_000
    meshes = {mesh.name: mesh for mesh in scene.meshes}
    for name in ("walls", "floor", "back"):
        mesh = meshes[name]
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(np.float64) for k in range(3))
        assert (np.sum(np.cross(b - a, c - a) * (np.array(worlds.ROOM) / 2 - a), axis=1) > 0).all()
    assert volume(meshes["shelves"]) > 0
    assert volume(meshes["books"]) > 0


def test_copies_are_turned_and_scaled_only() -> None:
    """Each transform's rotation part is a scale times a proper rotation."""
    for transforms in worlds.instanced().copies.values():
        assert transforms.shape == (settings.COPIES // 2, 3, 4)
        rotation = transforms[:, :, :3]
        scale = np.cbrt(np.linalg.det(rotation))
        assert scale.min() > 0.49
        products = rotation @ rotation.transpose(0, 2, 1)
        assert products == pytest.approx(np.eye(3) * (scale**2)[:, None, None], abs=1e-12)


def test_no_lamp_of_the_hall_shines_at_the_camera() -> None:
    """A lamp whose front can be seen lies outside of the picture's corners."""
    scene = worlds.lamps()
    mesh = next(mesh for mesh in scene.meshes if mesh.name == "lamps")
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(np.float64) for k in range(3))
    eye, target = (np.array(scene.camera[key], dtype=np.float64) for key in ("position", "look_at"))
    shines = np.sum(np.cross(b - a, c - a) * (eye - a), axis=1) > 0
    assert shines.any()
    forward = (target - eye) / np.linalg.norm(target - eye)
    cosines = (a - eye) @ forward / np.linalg.norm(a - eye, axis=1)
    corner = np.sqrt(2.0) * np.tan(np.radians(scene.camera["fov"] / 2))
    assert cosines[shines].max() < np.cos(np.arctan(corner))


def test_both_maps_hold_the_same_sky() -> None:
    """A plane receives the same from either, texels weighted by their own areas; a sun sends what it promises."""
    found = {}
    for poles in (False, True):
        pixels = sky.pixels("sunny", poles).astype(np.float64)
        rows = len(pixels)
        theta = np.pi * (np.arange(rows) / (rows - 1) if poles else (np.arange(rows) + 0.5) / rows)
        weight = np.maximum(np.cos(theta), 0.0) * np.sin(theta)
        found[poles] = np.einsum("h,hwc->c", weight, pixels) * np.pi / settings.SKY_HEIGHT * 2 * np.pi / pixels.shape[1]
    assert found[True] == pytest.approx(found[False], rel=1e-3)
    direct = sum(sun[3] * np.sin(np.radians(sun[0])) * np.array(sun[4]) for sun in sky.SUNS["sunny"])
    plain = sky.pixels("overcast", False).astype(np.float64)
    theta = np.pi * (np.arange(len(plain)) + 0.5) / len(plain)
    weight = np.maximum(np.cos(theta), 0.0) * np.sin(theta) * np.pi / len(plain) * 2 * np.pi / plain.shape[1]
    assert found[False] - np.einsum("h,hwc->c", weight, plain) == pytest.approx(direct, rel=0.02)


def test_agreement_sees_a_block_that_differs() -> None:
    """And takes the first image as the measure."""
    plain = np.full((64, 64, 3), 0.5, dtype=np.float32)
    other = plain.copy()
    other[8:16, 48:56] *= 1.25
    rows = agreement.compared({"accuray": plain, "other": other})
    assert rows[1]["worst"] == pytest.approx(0.25)
    assert rows[1]["at"] == [6, 1]
    assert rows[1]["whole"] == pytest.approx(0.25 / 64)
