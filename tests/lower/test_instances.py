"""Instances from arrays and of instances: the same scene as written out one by one, or refused before it is made."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from instance_arrays import matrix, scene_with, similarities

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray
from accuray import SceneError, devices
from accuray.devices import budget
from accuray.devices.lowering import lower
from accuray.scene import memory

ROWS = similarities(30, 11)
IDS = np.random.default_rng(2).integers(0, 2, len(ROWS))
TURN = [{"rotate": {"axis": [1, 2, 3], "angle": 50}}, {"scale": -1.5}, {"translate": [0.2, 0.1, -0.3]}]
RECORD = 68


def scene(shapes: dict[str, Any], **more: Any) -> accuray.Scene:
    return accuray.Scene.from_dict(scene_with(shapes, **more))


def film(shapes: dict[str, Any], **more: Any) -> accuray.film.Film:
    return accuray.render(scene(shapes, **more), spp=16).film


def instance(of: Any, **more: Any) -> dict[str, Any]:
    return {"type": "instance", "of": of, **more}


def product(outer: Any, inner: Any) -> Any:
    """Rows of `outer` after the row `inner`, as 3 x 4 float64."""
    last = [[0.0, 0.0, 0.0, 1.0]]
    return np.array([(np.vstack([row, last]) @ np.vstack([inner, last]))[:3] for row in np.float64(outer)])


def one_by_one(of: Any, rows: Any, **more: Any) -> dict[str, Any]:
    return {f"copy{i:04}": instance(of, transform=matrix(row), **more) for i, row in enumerate(rows)}


# --- The same as one by one -------------------------------------------------------------------------------------------


def test_an_array_is_as_many_instances() -> None:
    field = film({"field": instance(["ball", "box", "lid"], instances=ROWS)})
    assert field.identical(film(one_by_one(["ball", "box", "lid"], ROWS)))
    assert not field.identical(film({"field": instance(["ball", "box", "lid"], instances=ROWS[:-1])}))


def test_a_material_covers_all_of_an_array() -> None:
    field = film({"field": instance(["ball", "box"], instances=ROWS, material="red")})
    assert field.identical(film(one_by_one(["ball", "box"], ROWS, material="red")))


def test_ids_choose_among_the_prototypes() -> None:
    chosen = {0: "ball", 1: "box"}
    order = np.argsort(IDS, kind="stable")
    apart = {f"c{i:04}": instance(chosen[int(IDS[k])], transform=matrix(ROWS[k])) for i, k in enumerate(order)}
    assert film({"field": instance(["ball", "box"], instances=ROWS, ids=IDS)}).identical(film(apart))


def test_a_transform_follows_those_of_the_array() -> None:
    moved = scene({"field": instance("box", instances=ROWS, transform=TURN)})
    turned = moved.shapes["field"]["transform"]
    apart = product(turned[None, :3], np.eye(3, 4))
    rows = np.concatenate([product(apart, row) for row in ROWS])
    difference = np.asarray(accuray.render(moved, spp=64)) - np.asarray(
        accuray.render(scene(one_by_one("box", rows)), spp=64)
    )
    assert abs(difference.mean()) < 2e-4
    assert np.count_nonzero(np.abs(difference) > 1e-3) < 0.02 * difference.size


def test_instances_of_instances_are_multiplied_out() -> None:
    """A tree of a trunk and leaves, of which there is a row, and of the rows a field: by arrays and singly, mixed."""
    leaves, trees, rows = similarities(4, 1, 1.0), similarities(3, 2, 1.5), similarities(2, 3, 1.5)
    deep = {
        "leaves": instance("ball", instances=leaves, prototype=True, material="red"),
        "tree": instance(["box", "leaves", "lid"], prototype=True),
        "row": instance("tree", instances=trees, prototype=True),
        "field": instance(["row"], instances=rows),
    }
    places = np.concatenate([product(rows, tree) for tree in trees])
    flat = one_by_one(["box", "lid"], places)
    flat |= {
        f"leaf{i:04}": instance("ball", transform=matrix(row), material="red")
        for i, row in enumerate(np.concatenate([product(places, leaf) for leaf in leaves]))
    }
    counts = devices.lowering._Lowering(scene(deep)).shapes.instancing
    assert counts.total(["field"]) == 2 * 3 * (1 + 4) == len(flat)
    a, b = (np.asarray(accuray.render(scene(shapes), spp=64)) for shapes in (deep, flat))
    assert abs((a - b).mean()) < 2e-4
    assert np.count_nonzero(np.abs(a - b) > 1e-3) < 0.02 * a.size


def test_an_outer_material_covers_an_inner_one() -> None:
    inner = instance("ball", instances=ROWS, prototype=True, material="grey")
    once = film({"inner": inner, "outer": instance("inner", material="red")})
    assert once.identical(film({"inner": {**inner, "material": "red"}, "outer": instance("inner")}))
    assert not once.identical(film({"inner": inner, "outer": instance("inner")}))


def test_prototypes_in_several_groups_are_stored_once() -> None:
    mesh = {"type": "torus", "segments": 64, "tube_segments": 32, "material": "grey", "prototype": True}
    one, _ = lower(scene({"ring": mesh, "a": instance("ring")}))
    two, _ = lower(scene({"ring": mesh, "a": instance("ring"), "b": instance(["ring", "ball"])}))
    assert two.sections == one.sections
    assert two.bytes < one.bytes + 1000


def test_an_instance_takes_its_record() -> None:
    few, many = (lower(scene({"f": instance("box", instances=similarities(n, 4))}))[0] for n in (1000, 21_000))
    assert many.bytes - few.bytes == 20_000 * RECORD


def test_no_instances_at_all() -> None:
    nothing = film({"field": instance("box", instances=ROWS[:0])})
    assert nothing.identical(film({}))


# --- Instances that emit ----------------------------------------------------------------------------------------------


GLOW = {"glow": {"type": "diffuse", "reflectance": 0, "emission": 3, "emission_sides": "both"}}


def glowing(emission: Any = 3) -> dict[str, Any]:
    return scene_with({})["materials"] | {"glow": GLOW["glow"] | {"emission": emission}}


def test_lights_of_an_array_are_those_of_single_instances() -> None:
    rows = similarities(12, 8)
    shown = {"materials": glowing(), "lights": {}}
    field = scene({"field": instance(["ball", "box", "lid"], instances=rows, material="glow")}, **shown)
    apart = scene(one_by_one(["ball", "box", "lid"], rows, material="glow"), **shown)
    assert devices.load(field).core.lights == devices.load(apart).core.lights == 12 * (1 + 6 + 1)
    assert accuray.render(field, spp=16).film.identical(accuray.render(apart, spp=16).film)


def test_a_flux_is_that_of_each_instance() -> None:
    rows = similarities(5, 8)
    rows[:, :, :3] /= np.linalg.norm(rows[:, :, :1], axis=1, keepdims=True)
    lumens = glowing({"flux": "800 lm", "illuminant": "D65"})
    lamps = instance("ball", instances=rows, material="glow")
    single = instance("ball", material="glow")
    many, one = (scene({"lamps": shape}, materials=lumens, lights={}) for shape in (lamps, single))
    assert devices.load(many).core.lights == 5
    seen = accuray.render(one, spp=64, crop=(11, 7, 13, 9))
    assert np.asarray(seen).min() > 0
    nested = {"part": instance("ball", prototype=True), "lamps": instance("part", instances=rows, material="glow")}
    again = scene(nested, materials=lumens, lights={})
    assert accuray.render(again, spp=4).film.identical(accuray.render(many, spp=4).film)
    rows[3] *= 2
    with pytest.raises(SceneError, match=r"glow\.emission: is a flux for each of 5 surfaces, of 8\.\d+ to 32\.\d+ m"):
        devices.load(scene({"lamps": {**lamps, "instances": rows}}, materials=lumens, lights={}))


# --- What is too much -------------------------------------------------------------------------------------------------


def test_cycles_are_named() -> None:
    shapes = {name: instance(of, prototype=True) for name, of in {"a": "b", "b": "c", "c": ["ball", "a"]}.items()}
    with pytest.raises(SceneError, match=r"shapes\.\w\.of: is made of itself: (a -> b -> c -> a|b -> c|c -> a)"):
        scene({**shapes, "field": instance("a")})
    with pytest.raises(SceneError, match=r"shapes\.a\.of: is made of itself: a -> a"):
        scene({"a": instance("a", prototype=True)})


def levels(depth: int, of: list[str]) -> dict[str, Any]:
    """Prototypes each of which shows the one before it once per entry of `of`."""
    shapes = {"level0": instance("ball", prototype=True)}
    for level in range(1, depth + 1):
        shapes[f"level{level}"] = instance([name.format(level - 1) for name in of], prototype=True)
    return {**shapes, "field": instance(f"level{depth}")}


def test_two_to_the_fortieth_leaves_are_refused() -> None:
    bomb = scene(levels(40, ["level{}", "level{}"]))
    with pytest.raises(
        SceneError, match=r"shapes: 1099511627776 instances, and \d+ inside of them, would take \d+\.\d TiB"
    ):
        devices.load(bomb)
    pairs = similarities(2, 3)
    shapes = levels(40, ["level{}"])
    for level in range(1, 41):
        shapes[f"level{level}"]["instances"] = pairs
    with pytest.raises(SceneError, match="1099511627776 instances, and"):
        devices.load(scene(shapes))
    with pytest.raises(SceneError, match=f"{2**3000} instances, and"):
        devices.load(scene(levels(3000, ["level{}", "level{}"])))


def test_deep_chains_and_bombs_that_nothing_shows_are_rendered() -> None:
    chain = film(levels(500, ["level{}"]))
    assert chain.identical(film({"field": instance("ball")}))
    bomb = levels(40, ["level{}", "level{}"])
    del bomb["field"]
    assert film({**bomb, "field": instance("ball")}).identical(chain)
    assert film({**bomb, "b": instance("level40", instances=ROWS[:0]), "field": instance("ball")}).identical(chain)


def test_more_than_the_memory_is_refused_with_the_estimate(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budget, "SLACK", 1000)
    monkeypatch.setattr(memory, "available_bytes", lambda: 100_000)
    field = {"field": instance("ball", instances=similarities(1000, 1))}
    needed = memory.readable(1000 * (RECORD + budget.EMBREE_INSTANCE))
    with pytest.raises(SceneError, match=f"shapes: 1000 instances would take {needed}: allowed are the 97.6 KiB that"):
        lower(scene(field))
    ring = {"type": "torus", "segments": 64, "tube_segments": 32, "material": "grey"}
    with pytest.raises(SceneError, match=r"shapes\.ring: a mesh of 4096 triangles would take 5\d\d\.\d KiB"):
        lower(scene({"ring": ring}))
    lamps = {"field": instance("box", instances=ROWS, material="glow")}
    with pytest.raises(SceneError, match=r"shapes\.field: 360 lights of instances, with .* would take 1\d\d\.\d KiB"):
        lower(scene(lamps, materials=glowing(), lights={}))


def test_an_instance_may_be_moved_too_far_by_those_around_it() -> None:
    far = similarities(2, 1)
    far[:, :, 3] = 1e10
    shapes = {"inner": instance("ball", instances=far, prototype=True)}
    with pytest.raises(SceneError, match=r"shapes\.field: transform moves or scales by more than 1e15"):
        devices.load(scene({**shapes, "field": instance("inner", transform={"scale": 1e8})}))


def test_a_mesh_file_larger_than_the_memory_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    vertices = "".join(f"{i} {i * i} 0\n" for i in range(100))
    faces = "".join(f"3 0 {i} {i + 1}\n" for i in range(1, 99))
    header = "ply\nformat ascii 1.0\nelement vertex 100\nproperty float x\nproperty float y\nproperty float z\n"
    header += "element face 98\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "fan.ply").write_text(header + vertices + faces)
    (tmp_path / "fan.obj").write_text(50 * "v 0 0 0\n" + "f 1 2 3\n")
    message = r"fan\.ply:7: element face with 98 rows takes more memory than there is, 2376 bytes: allowed 2000 bytes"
    for file, room, expected in (("fan.ply", 2000, message), ("fan.obj", 60, "a mesh from 408 bytes would take 68 B")):
        monkeypatch.setattr(memory, "available_bytes", lambda room=room: room)
        with pytest.raises(SceneError, match=expected):
            accuray.Scene.from_dict(
                scene_with({"fan": {"type": "mesh", "file": file, "material": "grey"}}), folder=tmp_path
            )
        with pytest.raises(SceneError, match=expected[:20]):
            accuray.load(tmp_path / file)
