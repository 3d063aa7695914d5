"""Values that change with time: what they are at a moment, and what is said about wrong keys."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray.formats import Scene, load
from accuray.scene import SceneError, Spectrum
from accuray.scene import schema as schemas
from accuray.scene.jsonschema import json_schema
from accuray.scene.keys import KINDS, between, span_at, takes_keys
from accuray.scene.spectrum import xyz

TIMES = st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=8, unique=True).map(sorted)


def keyed(*pairs: tuple[Any, Any], interpolation: str = "linear") -> dict[str, Any]:
    """The description of keys."""
    return {"keys": [{"time": time, "value": value} for time, value in pairs], "interpolation": interpolation}


def scene_with(frame: float, **sections: Any) -> Scene:
    """A scene at 10 frames per second."""
    return Scene.from_dict({"animation": {"fps": 10}, **sections}, frame=frame)


def fov(value: Any, frame: float) -> float:
    """A camera's field of view, in degrees."""
    scene = scene_with(frame, camera={"type": "perspective", "fov": value})
    return float(np.degrees(scene.camera["fov"]))


def lamp(value: Any, frame: float, **sections: Any) -> Spectrum:
    """The radiance of a lamp."""
    spectrum = scene_with(frame, lights={"lamp": {"type": "constant", "radiance": value}}, **sections)
    result: Spectrum = spectrum.lights["lamp"]["radiance"]
    return result


@pytest.mark.parametrize(
    ("interpolation", "expected"),
    [
        # At the quarter of the way: s, the key before, 3 s^2 - 2 s^3 = 0.15625.
        ("linear", 32.5),
        ("step", 30.0),
        ("smooth", 30.0 + 10.0 * 0.15625),
    ],
)
def test_between_two_keys(interpolation: str, expected: float) -> None:
    value = keyed((1, 30), ("3000 ms", 40), interpolation=interpolation)
    assert fov(value, 15) == pytest.approx(expected, rel=1e-12)
    # It stays what it is before the first key and after the last.
    assert fov(value, -1e6) == fov(value, 10) == pytest.approx(30.0)
    assert fov(value, 30) == fov(value, 1e6) == pytest.approx(40.0)


def test_units_may_differ_from_key_to_key() -> None:
    camera = {"type": "perspective", "aperture_radius": keyed((0, "1 cm"), (1, "30 mm"))}
    assert scene_with(5, camera=camera).camera["aperture_radius"] == pytest.approx(0.02)


def test_vectors_go_component_by_component_in_the_files_unit() -> None:
    camera = {"type": "perspective", "position": keyed((0, [0, 0, 500]), (1, [100, "1 m", 500]))}
    scene = scene_with(5, camera=camera, length_unit="cm")
    assert scene.camera["position"] == pytest.approx((0.5, 0.5, 5.0))


@STEADY
@given(TIMES, st.floats(-2e3, 2e3), st.sampled_from(["linear", "step", "smooth"]))
def test_span_is_where_the_moment_lies(times: list[float], time: float, interpolation: str) -> None:
    before, after, along = span_at(times, interpolation, time)
    assert 0 <= before <= after <= before + 1 <= len(times)
    assert 0.0 <= along <= 1.0
    if along > 0.0:
        assert times[before] < time < times[after]
    for number, moment in enumerate(times):
        assert span_at(times, interpolation, moment) == (number, min(number + 1, len(times) - 1), 0.0) or (
            span_at(times, interpolation, moment)[::2] == (number, 0.0)
        )


@STEADY
@given(st.floats(-1e300, 1e300), st.floats(-1e300, 1e300), st.floats(0, 1))
def test_interpolation_stays_between_its_ends(first: float, last: float, along: float) -> None:
    assert min(first, last) <= between(first, last, along) <= max(first, last)
    assert between(first, first, along) == first


@pytest.mark.parametrize(
    ("first", "last", "middle"),
    [
        (1.0, 3.0, 2.0),
        ([1, 0, 0.5], [0, 1, 0.5], [0.5, 0.5, 0.5]),
        ({"rgb": [1, 0, 0]}, {"rgb": [0, 1, 0]}, {"rgb": [0.5, 0.5, 0]}),
        ("2000 K", "4000 K", "3000 K"),
        ({"blackbody": "2000 K", "scale": 2}, {"blackbody": 4000, "scale": 4}, {"blackbody": 3000, "scale": 3}),
        ("100 nit", "300 nit", "200 nit"),
        ({"illuminant": "D65", "scale": 1}, {"illuminant": "D65", "scale": 2}, {"illuminant": "D65", "scale": 1.5}),
        (
            {"wavelengths": [400, 700], "values": [0, 1]},
            {"wavelengths": [400, 700], "values": [1, 0]},
            {"wavelengths": [400, 700], "values": [0.5, 0.5]},
        ),
    ],
)
def test_a_spectrum_is_interpolated_as_it_is_spelled(first: Any, last: Any, middle: Any) -> None:
    if isinstance(last, dict) and last.get("blackbody") == 4000:
        first = {**first, "blackbody": 2000}
    assert lamp(keyed((0, first), (1, last)), 5) == lamp(middle, 5)


def test_a_warming_lamp_keeps_its_luminance() -> None:
    value = keyed(
        (0, {"blackbody": "2000 K", "luminance": "100 cd/m^2"}), (1, {"blackbody": "8000 K", "luminance": "100 cd/m^2"})
    )
    cold, half = lamp(value, 0), lamp(value, 5)
    assert half.kelvin == 5000.0
    assert xyz(half)[1] == pytest.approx(xyz(cold)[1], rel=1e-10)
    assert half.scale < cold.scale / 50


def test_indices_of_refraction() -> None:
    glass = {"type": "dielectric", "ior": keyed((0, {"cauchy": [1.4, 0.0]}), (1, {"cauchy": [1.6, 0.02]}))}
    ior = scene_with(5, materials={"glass": glass}).materials["glass"]["ior"]
    assert (ior.A0, *ior.B) == pytest.approx((1.5, 0.01))


def test_a_named_spectrum_may_have_keys() -> None:
    spectra = {"dimmed": keyed((0, [1, 1, 1]), (1, [0, 0.5, 1]))}
    assert lamp("dimmed", 5, spectra=spectra).rgb == pytest.approx((0.5, 0.75, 1.0))
    # Unused ones are checked as well.
    with pytest.raises(SceneError, match=r"spectra\.dimmed\.keys\[1\]\.value"):
        scene_with(0, spectra={"dimmed": keyed((0, 1), (1, "red"))})


def test_textures_film_and_shapes_have_keys() -> None:
    scene = scene_with(
        5,
        film={"exposure": keyed((0, 0), (1, 3)), "white_balance": keyed((0, "3000 K"), (1, "6000 K"))},
        textures={
            "tiles": {
                "type": "checker",
                "uv_rotate": keyed((0, 0), (1, 90)),
                "first": keyed((0, [0, 0, 0]), (1, [1, 1, 1])),
            }
        },
        materials={"m": {"type": "diffuse", "opacity": keyed((0, 1), (1, 0))}},
        shapes={"ball": {"type": "sphere", "material": "m", "center": keyed((0, [0, 0, 0]), (1, [0, 2, 0]))}},
    )
    assert scene.film["exposure"] == 1.5
    assert scene.film["white_balance"].kelvin == 4500.0
    assert scene.textures["tiles"]["uv_rotate"] == pytest.approx(np.pi / 4)
    assert scene.textures["tiles"]["first"] == (0.5, 0.5, 0.5)
    assert scene.materials["m"]["opacity"] == 0.5
    assert scene.shapes["ball"]["center"] == (0.0, 1.0, 0.0)


def test_the_identity_is_that_of_the_values() -> None:
    moving = {"type": "perspective", "fov": keyed((0, 30), (1, 40))}
    still = {"type": "perspective", "fov": 35}
    assert scene_with(5, camera=moving).identity == scene_with(5, camera=still).identity
    assert scene_with(5, camera=moving).identity != scene_with(6, camera=moving).identity
    # Time alone changes nothing.
    assert scene_with(5, camera=still).identity == scene_with(6, camera=still).identity


def test_every_animatable_number_of_every_type_takes_keys() -> None:
    """One key with the default says what the default says."""
    schema, tried = schemas.current(), 0
    for family, section in (("camera", "camera"), ("texture", "textures"), ("bsdf", "materials"), ("light", "lights")):
        for type_ in schema.family(family).types.values():
            for param in filter(takes_keys, type_.params):
                if param.default is None or param.group or param.required or any(p.required for p in type_.params):
                    continue
                table = {"type": type_.name, param.name: keyed((0, param.default))}
                sections = {section: table if section == "camera" else {"x": table}}
                try:
                    plain = {**table, param.name: param.default}
                    expected = Scene.from_dict({section: plain if section == "camera" else {"x": plain}})
                except SceneError:
                    continue  # the type needs more than one parameter
                assert Scene.from_dict(sections).identity == expected.identity
                tried += 1
    assert tried > 40


def test_what_makes_sense_to_animate_can_be() -> None:
    """Everything that is a number in the world; not what says how finely shapes are cut, or how pictures are made."""
    schema = schemas.current()
    families = ("bsdf", "composition", "light", "texture", "camera", "shape")
    still = {
        f"{type_.name}.{param.name}"
        for family in families
        for type_ in schema.family(family).types.values()
        for param in type_.params
        if param.kind in KINDS and not param.animatable
    }
    assert {name.partition(".")[2] for name in still} == {"crease_angle", "edge_length_px"}


def test_the_json_schema_knows_keys() -> None:
    schema = json_schema()
    keys = schema["$defs"]["keyed"]["properties"]
    assert keys["interpolation"]["enum"] == ["linear", "step", "smooth"]
    perspective = next(
        t for t in schema["properties"]["camera"]["oneOf"] if t["properties"]["type"]["const"] == "perspective"
    )
    assert {"$ref": "#/$defs/keyed"} in perspective["properties"]["fov"]["anyOf"]
    assert "anyOf" not in perspective["properties"]["blades"]


GOOD = "{time = 0, value = 30}"
BAD_KEYS = {
    # name: (value of camera.fov, what the error says)
    "no keys": ("{keys = []}", ("keys is not a list of keys", "1 to 100000 keys")),
    "keys not a list": ("{keys = 5}", ("keys is not a list of keys", "5")),
    "keys a text": ('{keys = "fast"}', ("keys is not a list of keys",)),
    "key not a table": ("{keys = [30]}", ("keys[0] is not a key", "{time = 0, value = ...}")),
    "key without time": ("{keys = [{value = 30}]}", ("keys[0] is not a key",)),
    "key without value": ("{keys = [{time = 0}]}", ("keys[0] is not a key",)),
    "key with more": ("{keys = [{time = 0, value = 30, ease = 1}]}", ("keys[0] is not a key", "ease")),
    "equal times": (f"{{keys = [{GOOD}, {GOOD}]}}", ("keys[1].time", "comes at 0 s", "rising times")),
    "falling times": (f'{{keys = [{GOOD}, {{time = "-1 ms", value = 31}}]}}', ("keys[1].time", "-0.001 s")),
    "time a length": ('{keys = [{time = "1 m", value = 30}]}', ("keys[0].time has the wrong unit", '"1 s"')),
    "time a text": ('{keys = [{time = "soon", value = 30}]}', ("keys[0].time is not a number with a unit",)),
    "time nan": ("{keys = [{time = nan, value = 30}]}", ("keys[0].time is not a finite number",)),
    "time infinite": ("{keys = [{time = inf, value = 30}]}", ("keys[0].time is not a finite number",)),
    "time beyond": ("{keys = [{time = 1e10, value = 30}]}", ("keys[0].time is out of range",)),
    "time a truth": ("{keys = [{time = true, value = 30}]}", ("keys[0].time is not a number",)),
    "value nan": ("{keys = [{time = 0, value = nan}]}", ("keys[0].value is not a finite number",)),
    "value out of range": (
        f"{{keys = [{GOOD}, {{time = 9, value = 190}}]}}",
        ("keys[1].value is out of range", "179.99"),
    ),
    "value of a wrong unit": ('{keys = [{time = 0, value = "3 m"}]}', ("keys[0].value has the wrong unit",)),
    "value a vector": ("{keys = [{time = 0, value = [1, 2]}]}", ("keys[0].value is not a number",)),
    "keys in keys": (
        f"{{keys = [{{time = 0, value = {{keys = [{GOOD}]}}}}]}}",
        ("keys[0].value is not a plain value",),
    ),
    "texture in keys": ('{keys = [{time = 0, value = {texture = "t"}}]}', ("keys[0].value is not a plain value",)),
    "unknown interpolation": (f'{{keys = [{GOOD}], interpolation = "smoth"}}', ('did you mean "smooth"?', '"linear"')),
    "interpolation a number": (f"{{keys = [{GOOD}], interpolation = 3}}", ("interpolation is not allowed",)),
    "misspelled part": (f'{{keys = [{GOOD}], interpolate = "step"}}', ('did you mean "interpolation"?',)),
}


def lacking(expected: tuple[str, ...], error: SceneError) -> list[str]:
    """Texts that an error does not hold; of one that begins with the end of a key path, path and problem."""
    parts = [part for text in expected for part in text.split(" ", 1) if text.startswith(("keys", "inter"))]
    parts += [text for text in expected if not text.startswith(("keys", "inter"))]
    return [f"{part} in {error}" for part in parts if part not in str(error)]


@pytest.mark.parametrize("name", BAD_KEYS)
def test_wrong_keys_are_told(name: str, tmp_path: Path) -> None:
    value, expected = BAD_KEYS[name]
    path = tmp_path / "bad.toml"
    path.write_text(f'accuray = 1\n[camera]\ntype = "perspective"\nfov = {value}\n', encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(path)
    assert caught.value.line == 4
    assert str(caught.value).startswith(f"{path}:4: camera.fov")
    assert lacking(expected, caught.value) == []


BAD_SPECTRA = [
    (keyed((0, 1), (1, [1, 0, 0])), "keys[1].value has another form than the first key"),
    (keyed((0, [1, 1, 1]), (1, "D65")), "keys[1].value has another form than the first key"),
    (keyed((0, "D65"), (1, "A")), "keys[1].value cannot be interpolated with the key before it"),
    (keyed((0, "2000 K"), (1, "100 nit")), "keys[1].value cannot be interpolated"),
    (keyed((0, {"rgb": [1, 1, 1]}), (1, {"blackbody": 2000})), "keys[1].value has another form than the first key"),
    (keyed((0, {"blackbody": 2000}), (1, {"blackbody": 3000, "scale": 2})), "keys[1].value has another form"),
    (keyed((0, {"value": 1}), (1, {"value": -1})), "keys[1].value.value is out of range"),
    (
        keyed((0, {"wavelengths": [400, 700], "values": [0, 1]}), (1, {"wavelengths": [400, 600], "values": [0, 1]})),
        "keys[1].value.wavelengths differ from those of the first key",
    ),
    (
        keyed(
            (0, {"wavelengths": [400, 700], "values": [0, 1]}),
            (1, {"wavelengths": [400, 500, 700], "values": [0, 1, 1]}),
        ),
        "keys[1].value.",
    ),
]


@pytest.mark.parametrize(("value", "expected"), BAD_SPECTRA)
def test_spectra_that_are_not_alike_are_told(value: Any, expected: str) -> None:
    with pytest.raises(SceneError) as caught:
        lamp(value, 5)
    assert lacking((expected,), caught.value) == []
    assert caught.value.key.startswith("lights.lamp.radiance.keys[1].value")


@pytest.mark.parametrize(
    ("section", "table", "key"),
    [
        ("render", {"spp": keyed((0, 1))}, "render.spp"),
        ("film", {"width": keyed((0, 8), (1, 16))}, "film.width"),
        ("animation", {"fps": keyed((0, 8), (1, 16))}, "animation.fps"),
        ("camera", {"type": "perspective", "blades": keyed((0, 5))}, "camera.blades"),
        ("materials", {"m": {"type": "diffuse", "emission_sides": keyed((0, "both"))}}, "materials.m.emission_sides"),
        ("shapes", {"s": {"type": "torus", "material": "x", "segments": keyed((0, 9))}}, "shapes.s.segments"),
        ("textures", {"t": {"type": "noise", "octaves": keyed((0, 1))}}, "textures.t.octaves"),
    ],
)
def test_what_cannot_change_with_time_is_told(section: str, table: dict[str, Any], key: str) -> None:
    with pytest.raises(SceneError, match="cannot change with time") as caught:
        Scene.from_dict({section: table})
    assert caught.value.key == key


@pytest.mark.parametrize("frame", [float("nan"), float("inf"), 1e10, "one"])
def test_wrong_frames_are_told(frame: Any) -> None:
    with pytest.raises(SceneError, match=r"animation\.frame"):
        Scene.from_dict({}, frame=frame)
    with pytest.raises(SceneError, match=r"animation\.frame"):
        Scene.from_dict({}).at(frame)
