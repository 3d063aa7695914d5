"""A table of broken scenes, meshes and spectra, with what each error must say.

The tests of the scene description load them through ``accuray.formats.load``; those of the command line expect exit
code 2 and the same texts. Each case is a set of files; ``expected`` are texts that the message holds: the line or the
key path, the offending value, what was allowed.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class BadScene:
    """Files to write into an empty folder; ``main`` is the scene to load."""

    name: str
    files: Mapping[str, str | bytes]
    expected: tuple[str, ...]
    main: str = "scene.toml"
    overrides: tuple[str, ...] = ()
    prepare: Callable[[Path], None] | None = field(default=None, compare=False)

    def write(self, folder: Path) -> Path:
        """Write the files; returns the path of the scene."""
        for name, content in self.files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content.encode() if isinstance(content, str) else content)
        if self.prepare is not None:
            self.prepare(folder)
        return folder / self.main


def scene(
    name: str,
    text: str,
    *expected: str,
    files: Mapping[str, str | bytes] | None = None,
    overrides: tuple[str, ...] = (),
    prepare: Callable[[Path], None] | None = None,
) -> BadScene:
    """A case whose scene is ``accuray = 1`` and then ``text``, whose first line is line 2."""
    written = {"scene.toml": f"accuray = 1\n{text}", **(files or {})}
    return BadScene(name, written, expected, overrides=overrides, prepare=prepare)


def material(
    name: str,
    value: str,
    *expected: str,
    files: Mapping[str, str | bytes] | None = None,
    prepare: Callable[[Path], None] | None = None,
) -> BadScene:
    """A case about the reflectance in line 4 of a scene."""
    text = f'[materials.floor]\ntype = "diffuse"\nreflectance = {value}\n'
    return scene(name, text, "scene.toml:4: materials.floor.reflectance", *expected, files=files, prepare=prepare)


def csv(name: str, content: str | bytes, *expected: str, column: str = ', column = "white"') -> BadScene:
    """A case about a measured reflectance in paint.csv."""
    text = f'[materials.floor]\ntype = "diffuse"\nreflectance = {{ file = "paint.csv"{column} }}\n'
    return scene(f"csv-{name}", text, "paint.csv", *expected, files={"paint.csv": content})


def emission(name: str, value: str, *expected: str) -> BadScene:
    """A case about an emission in line 4."""
    text = f'[materials.lamp]\ntype = "diffuse"\nemission = {value}\n'
    return scene(f"emission-{name}", text, "scene.toml:4: materials.lamp.emission", *expected)


def mesh(name: str, text: str, *expected: str, files: Mapping[str, str | bytes] | None = None) -> BadScene:
    """A case about a mesh whose own keys begin in line 7."""
    head = '[materials.m]\ntype = "diffuse"\n[shapes.s]\ntype = "mesh"\nmaterial = "m"\n'
    return scene(f"mesh-{name}", head + text, *expected, files=files)


def mesh_file(name: str, file: str, content: str | bytes, *expected: str) -> BadScene:
    """A case about the content of a mesh file."""
    return mesh(f"file-{name}", f'file = "{file}"\n', file, *expected, files={file: content})


def _fifo(folder: Path) -> None:
    os.mkfifo(folder / "paint.csv")


def _link_outside(folder: Path) -> None:
    (folder / "paint.csv").symlink_to("/etc/passwd")


TRIANGLE = "positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n"
DEEP = 10_000

SYNTAX = [
    BadScene("empty-file", {"scene.toml": ""}, ("scene.toml: has no format version", "accuray = 1")),
    BadScene("version-2", {"scene.toml": "accuray = 2\n"}, ("scene.toml:1: accuray: 2", "accuray = 1")),
    BadScene("version-text", {"scene.toml": 'accuray = "1"\n'}, ("scene.toml:1: accuray", '"1"', "accuray = 1")),
    BadScene("version-true", {"scene.toml": "accuray = true\n"}, ("scene.toml:1: accuray", "true", "accuray = 1")),
    BadScene("missing-scene", {}, ("scene.toml", "does not exist")),
    BadScene("unknown-suffix", {"scene.yaml": "a: 1"}, ("scene.yaml", ".toml"), main="scene.yaml"),
    BadScene("not-utf8", {"scene.toml": b"accuray = 1\n# \xff\n"}, ("scene.toml:2", "byte 14", "UTF-8")),
    scene("toml-syntax", "[film\nwidth = 3\n", "scene.toml:2", "column 6", "TOML syntax error", "[film"),
    scene("toml-duplicate-key", "[film]\nwidth = 3\nwidth = 4\n", "scene.toml:4", "TOML"),
    scene("toml-huge-integer", f"[film]\nwidth = {'9' * 5000}\n", "scene.toml:3", "4300 digits", "999"),
    scene("toml-deep-arrays", f"x = {'[' * DEEP}{']' * DEEP}\n", "scene.toml:2", "nested too deeply", "[[[["),
    BadScene("json-syntax", {"s.json": '{"accuray": 1,\n}'}, ("s.json:2", "JSON syntax error", "}"), main="s.json"),
    BadScene("json-list", {"s.json": "[1]"}, ("s.json", "[1]", '{"accuray": 1'), main="s.json"),
    BadScene("json-nan", {"s.json": '{"accuray": 1, "film": {"exposure": NaN}}'}, ("s.json", "NaN"), main="s.json"),
    BadScene("json-twice", {"s.json": '{"accuray": 1, "film": {}, "film": {}}'}, ("s.json", '"film"'), main="s.json"),
    BadScene(
        "json-deep", {"s.json": f'{{"accuray": 1, "x": {"[" * 10**6}'}, ("s.json:1", "nested too deeply"), main="s.json"
    ),
    BadScene(
        "json-value",
        {"s.json": '{"accuray": 1,\n "film": {\n  "width": 0\n}}'},
        ("s.json:3: film.width: 0 is out of range", "1 to 65536", '"width": 0'),
        main="s.json",
    ),
    BadScene(
        "json-null",
        {"s.json": '{"accuray": 1,\n "camera": null}'},
        ("s.json:2: camera: nothing is not a table",),
        main="s.json",
    ),
]

NAMES = [
    scene("unknown-section", "[flim]\nwidth = 3\n", "scene.toml:2: flim", "film", "did you mean", "materials"),
    scene("unknown-key", "[film]\nwidht = 3\n", "scene.toml:3: film.widht", 'did you mean "width"', "height"),
    scene("unknown-key-quoted", '[film]\n"a b" = 3\n', 'scene.toml:3: film."a b"', "width"),
    scene("unknown-type", '[camera]\ntype = "perspectiv"\n', "scene.toml:3: camera.type", 'did you mean "perspective"'),
    scene("no-type", "[integrator]\nmax_depth = 3\n", "scene.toml:2: integrator", "`type`", "path, direct"),
    scene("type-number", "[camera]\ntype = 3\n", "scene.toml:3: camera.type: 3", "perspective"),
    scene("filter-type", '[film.filter]\ntype = "sinc"\n', "scene.toml:3: film.filter.type", '"sinc"', "gaussian"),
    scene("section-not-table", "film = 3\n", "scene.toml:2: film: 3 is not a table"),
    scene("object-not-table", "[materials]\nfloor = 3\n", "scene.toml:3: materials.floor: 3 is not a table"),
    scene("empty-name", '[materials.""]\ntype = "diffuse"\n', "scene.toml:2", "is not a name", "1 to 256"),
    scene(
        "unknown-material",
        '[materials.floor]\ntype = "diffuse"\n[shapes.s]\ntype = "sphere"\nmaterial = "flor"\n',
        "scene.toml:6: shapes.s.material",
        '"flor" is not a known material',
        'did you mean "floor"',
    ),
    scene(
        "light-as-material",
        '[lights.sun]\ntype = "point"\n[shapes.s]\ntype = "sphere"\nmaterial = "sun"\n',
        "scene.toml:6: shapes.s.material",
        '"sun" is a light, not a material',
    ),
    scene(
        "material-missing", '[shapes.s]\ntype = "sphere"\n', "scene.toml:2: shapes.s", "has no material", "material ="
    ),
    scene(
        "material-of-itself",
        '[materials.m]\ntype = "mix"\nfirst = "m"\nsecond = "m"\n',
        "scene.toml:4: materials.m.first",
        "part of itself: m -> m",
    ),
    scene(
        "part-that-emits",
        '[materials.a]\ntype = "diffuse"\nemission = 1\n[materials.m]\ntype = "two_sided"\nfront = "a"\n',
        "scene.toml:4: materials.a.emission",
        'part of "m" (front)',
        "allowed",
    ),
    scene("material-number", '[shapes.s]\ntype = "sphere"\nmaterial = 3\n', "scene.toml:4: shapes.s.material: 3"),
    scene("instance-of-none", '[shapes.i]\ntype = "instance"\nof = "x"\n', "scene.toml:4: shapes.i.of", '"x"', "i"),
    scene("instance-lacks-of", '[shapes.i]\ntype = "instance"\n', "scene.toml:2: shapes.i", "`of`"),
    scene("instance-empty", '[shapes.i]\ntype = "instance"\nof = []\n', "scene.toml:4: shapes.i.of", "at least one"),
    scene(
        "instance-of-itself",
        '[shapes.i]\ntype = "instance"\nof = ["i"]\n',
        "scene.toml:4: shapes.i.of",
        "not a prototype",
    ),
    scene(
        "instance-of-no-prototype",
        '[materials.m]\ntype = "diffuse"\n[shapes.s]\ntype = "sphere"\nmaterial = "m"\n'
        '[shapes.i]\ntype = "instance"\nof = "s"\n',
        "scene.toml:9: shapes.i.of",
        '"s" is not a prototype',
        "prototype = true",
    ),
]

PAINT = '[materials.paint]\ntype = "diffuse"\n'
COATS = [
    scene("coat-without-base", '[materials.m]\ntype = "coated"\n', "materials.m", "lacks `base`", "reference"),
    scene(
        "coat-on-nothing",
        PAINT + '[materials.m]\ntype = "coated"\nbase = "pain"\n',
        "scene.toml:6: materials.m.base",
        '"pain" is not a known material',
        'did you mean "paint"',
    ),
    scene(
        "coat-on-coated-metal",
        '[materials.k]\ntype = "conductor"\nmetal = "Ag"\n[materials.m]\ntype = "coated"\nbase = "k"\n'
        '[materials.n]\ntype = "coated"\nbase = "m"\n',
        "scene.toml:10: materials.n.base",
        '"m" is coated over conductor, which is made of others itself',
        "a coated one whose base is diffuse",
    ),
    scene(
        "three-coats",
        PAINT
        + "".join(
            f'[materials.{b}]\ntype = "coated"\nbase = "{a}"\n' for a, b in (("paint", "m"), ("m", "n"), ("n", "o"))
        ),
        "materials.o.base",
        '"n" is coated over coated',
        "a coated one whose base is diffuse",
    ),
    scene(
        "coat-on-itself",
        '[materials.m]\ntype = "coated"\nbase = "m"\n',
        "scene.toml:4: materials.m.base",
        "part of itself: m -> m",
    ),
    scene(
        "coats-on-each-other",
        '[materials.m]\ntype = "coated"\nbase = "n"\n[materials.n]\ntype = "coated"\nbase = "m"\n',
        "scene.toml:7: materials.n.base",
        "part of itself: m -> n -> m",
    ),
    scene(
        "coat-on-a-lamp",
        PAINT + 'emission = 1\n[materials.m]\ntype = "coated"\nbase = "paint"\n',
        "scene.toml:4: materials.paint.emission",
        'part of "m" (base)',
        'emission of "m" as a whole',
    ),
    scene(
        "coat-on-a-veil",
        PAINT + 'opacity = 0.5\n[materials.m]\ntype = "coated"\nbase = "paint"\n',
        "scene.toml:4: materials.paint.opacity",
        'part of "m" (base)',
    ),
    scene(
        "coat-index-below-1",
        PAINT + '[materials.m]\ntype = "coated"\nbase = "paint"\nior = 0.9\n',
        "scene.toml:7: materials.m.ior",
        "0.9 is out of range",
        "1 to 3",
    ),
]

VALUES = [
    scene(
        "width-zero", "[film]\nwidth = 0\n", "scene.toml:3: film.width: 0 is out of range", "1 to 65536", "width = 0"
    ),
    scene("width-huge", "[film]\nwidth = 1000000000\n", "film.width: 1000000000 is out of range", "1 to 65536"),
    scene("width-float", "[film]\nwidth = 64.0\n", "film.width: 64.0 is not a whole number", "1 to 65536"),
    scene("width-true", "[film]\nwidth = true\n", "film.width: true is not a whole number"),
    scene("width-date", "[film]\nwidth = 2026-01-01\n", "film.width: 2026-01-01 is not a whole number"),
    scene("bool-number", "[film]\nhide_environment = 1\n", "film.hide_environment: 1", "true or false"),
    scene("exposure-nan", "[film]\nexposure = nan\n", "scene.toml:3: film.exposure: nan is not a finite number"),
    scene("exposure-inf", "[film]\nexposure = -inf\n", "film.exposure: -inf is not a finite number", "-60 to 60"),
    scene("exposure-1e400", "[film]\nexposure = 1e400\n", "film.exposure: inf is not a finite number", "1e400"),
    scene("exposure-list", "[film]\nexposure = [1]\n", "film.exposure: [1] is not a number"),
    scene("spp-negative", "[render]\nspp = -1\n", "render.spp: -1 is out of range", "1 to"),
    scene(
        "enum", '[integrator]\ntype = "path"\nstrategy = "mist"\n', "integrator.strategy", '"mist"', '"mis", "light"'
    ),
    scene(
        "fov-unit", '[camera]\ntype = "perspective"\nfov = "35 mm"\n', "camera.fov", '"35 mm"', "wrong unit", "15 deg"
    ),
    scene("fov-range", '[camera]\ntype = "perspective"\nfov = 180\n', "scene.toml:4: camera.fov: 180", "179.99 deg"),
    scene("fov-no-unit", '[camera]\ntype = "perspective"\nfov = "35"\n', "camera.fov", '"35" has no unit'),
    scene("fov-word", '[camera]\ntype = "perspective"\nfov = "wide"\n', "camera.fov", '"wide" is not a number'),
    scene(
        "fov-and-film",
        '[camera]\ntype = "perspective"\nfov = 40\nfocal_length = "35 mm"\nfilm_size = "25 mm"\n',
        "scene.toml:6: camera.film_size",
        "`fov` and `film_size` at once",
        "exactly one of fov | focal_length with film_size",
    ),
    scene(
        "film-incomplete",
        '[camera]\ntype = "perspective"\nfocal_length = "35 mm"\n',
        "scene.toml:2: camera: lacks `film_size`",
    ),
    scene("vec-short", '[camera]\ntype = "perspective"\nposition = [1, 2]\n', "camera.position: [1, 2]", "3 numbers"),
    scene(
        "vec-word",
        '[camera]\ntype = "perspective"\nposition = [\n 1,\n "x",\n 2]\n',
        'scene.toml:6: camera.position[1]: "x" is not a number',
        "35 mm",
    ),
    scene("length-unit", 'length_unit = "inch"\n', "scene.toml:2: length_unit", '"inch"', "m, mm, cm"),
    scene("radius-lumen", '[shapes.s]\ntype = "sphere"\nradius = "3 lm"\n', "shapes.s.radius", '"3 lm"', "35 mm"),
    scene(
        "radius-unit", '[shapes.s]\ntype = "sphere"\nradius = "3 furlong"\n', "shapes.s.radius", "furlong", "known: m"
    ),
    scene("radius-negative", '[shapes.s]\ntype = "sphere"\nradius = -1\n', "shapes.s.radius: -1", "at least"),
    scene(
        "scale-list",
        '[shapes.s]\ntype = "sphere"\ntransform = {scale = [1, 2, 3]}\n',
        "transform",
        "shears or stretches",
    ),
    scene(
        "scale-zero", '[shapes.s]\ntype = "sphere"\ntransform = {scale = 0}\n', "shapes.s.transform.scale: 0", "than 0"
    ),
    scene(
        "axis-zero",
        '[shapes.s]\ntype = "sphere"\ntransform = {rotate = {axis = [0, 0, 0], angle = 3}}\n',
        "rotate.axis",
    ),
    scene(
        "matrix-shear",
        '[shapes.s]\ntype = "sphere"\ntransform = {matrix = [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n',
        "scene.toml:4: shapes.s.transform",
        "shears",
        "rotation times one scale",
    ),
    scene(
        "matrix-short", '[shapes.s]\ntype = "sphere"\ntransform = {matrix = [1, 2]}\n', "transform.matrix", "16 numbers"
    ),
    scene(
        "transform-key", '[shapes.s]\ntype = "sphere"\ntransform = {move = [1, 2, 3]}\n', "transform.move", "translate"
    ),
    scene("transform-word", '[shapes.s]\ntype = "sphere"\ntransform = "up"\n', 'shapes.s.transform: "up"', "translate"),
]

SPECTRA = [
    material("reflectance-high", "1.7", "1.7 is out of range: allowed 0 to 1", "reflectance = 1.7"),
    material("reflectance-negative", "-0.1", "-0.1 is out of range: allowed 0 to 1"),
    material("reflectance-nan", "nan", "nan is not a finite number"),
    material("reflectance-bool", "true", "true is not a spectrum"),
    material("reflectance-rgb-high", "[0.2, 1.2, 0.3]", "1.2 is out of range: allowed 0 to 1"),
    material("reflectance-rgb-two", "[0.2, 0.3]", "has 2 components", "[r, g, b]"),
    material("reflectance-rgb-word", '[0.2, "x", 0.3]', '"x" is not a number'),
    material("reflectance-name", '"wite"', '"wite" is not a known spectrum'),
    material("reflectance-illuminant", '{ illuminant = "D65" }', "not a form of a reflectance"),
    material("reflectance-kelvin", '"6500 K"', '"6500 K" has the wrong unit'),
    material("spectrum-no-form", "{ scale = 2 }", "has 0 of the keys", "exactly one of value, rgb"),
    material("spectrum-two-forms", "{ value = 1, rgb = [1, 1, 1] }", "has 2 of the keys", "value, rgb"),
    material("spectrum-key", "{ valu = 1 }", "valu", 'did you mean "value"'),
    material("spectrum-scaled", "{ value = 0.5, scale = 3 }", "1.5 is out of range"),
    material("spectrum-normalize", "{ value = 0.5, normalize = true }", "normalize", "this is a reflectance"),
    material("spectrum-lonely-values", "{ values = [1, 2] }", "values", "without `wavelengths`"),
    material("spectrum-lonely-column", '{ value = 1, column = "a" }', "column", "only allowed beside `file`"),
    material("spectrum-lengths", "{ wavelengths = [400, 500], values = [1] }", "values", "has 1 numbers", "2"),
    material(
        "spectrum-order", "{ wavelengths = [500, 400], values = [1, 1] }", "wavelengths[1]", "400 nm comes after 500"
    ),
    material("spectrum-twice", "{ wavelengths = [500, 500], values = [1, 1] }", "500 nm is there twice", "rising"),
    material("spectrum-micrometres", "{ wavelengths = [0.4, 0.7], values = [1, 1] }", "0.4 to 0.7 nm", "360 to 830"),
    material("spectrum-one-row", "{ wavelengths = [500], values = [1] }", "has 1 wavelengths", "at least 2"),
    material(
        "spectrum-high", "{ wavelengths = [400, 500], values = [1, 2] }", "values[1]", "2.0 at 500 nm is out of range"
    ),
    material("extrapolate", '{ value = 1, extrapolate = "hold" }', "extrapolate", "for tables of wavelengths"),
    emission("negative", "-1", "-1 is out of range", "at least 0"),
    emission("illuminant", '"D66"', '"D66" is not a known spectrum or illuminant', 'did you mean "D65"'),
    emission("watts", '"10 W/sr"', '"10 W/sr" has the wrong unit', "W/(m^2 sr nm)"),
    emission("too-large", '"1e400 W/(m^2 sr nm)"', "too large a number"),
    emission("lux", '"800 lx"', '"800 lx" has the wrong unit', "cd/m^2"),
    emission("cold", '"5 K"', '"5 K" is out of range', "500 to 100000 K"),
    emission("black-normalized", "{ value = 0, normalize = true }", "no visible light"),
    emission("luminance-unit", '{ value = 1, luminance = "3 m" }', "luminance", '"3 m" has the wrong unit', "cd/m^2"),
    emission("luminance-twice", "{ value = 1, luminance = 1, normalize = true }", "luminance", "`normalize`"),
    emission("overflow", "{ value = 1e300, scale = 1e300 }", "too large"),
    scene(
        "luminance-of-point",
        '[lights.l]\ntype = "point"\nintensity = { value = 1, luminance = 80 }\n',
        "scene.toml:4: lights.l.intensity.luminance",
        "does not fit",
        "W/(sr nm)",
    ),
    scene(
        "flux-of-sky",
        '[lights.l]\ntype = "constant"\nradiance = "800 lm"\n',
        "scene.toml:4: lights.l.radiance",
        '"800 lm" has the wrong unit',
        "cd/m^2",
    ),
    scene(
        "ies-broken",
        '[lights.l]\ntype = "ies"\nfile = "x.ies"\n',
        "scene.toml:4: lights.l.file",
        "line 2: 'many' is no finite number, in place of the number of lamps",
        files={"x.ies": "TILT=NONE\nmany"},
    ),
    scene("ies-other", '[lights.l]\ntype = "ies"\nfile = "x.csv"\n', "lights.l.file", ".ies", files={"x.csv": ""}),
    scene("ies-outside", '[lights.l]\ntype = "ies"\nfile = "../x.ies"\n', "lights.l.file", "leads outside"),
    scene("metal", '[materials.m]\ntype = "conductor"\nmetal = "Gold"\n', "materials.m.metal", '"Gold"', "Au, "),
    scene(
        "metal-none",
        '[materials.m]\ntype = "conductor"\n',
        "scene.toml:2: materials.m",
        "exactly one of metal | eta with k",
    ),
    scene("metal-half", '[materials.m]\ntype = "conductor"\neta = 1.5\n', "scene.toml:2: materials.m: lacks `k`"),
    scene(
        "glass", '[materials.m]\ntype = "dielectric"\nior = "BK7"\n', "materials.m.ior", '"BK7"', 'did you mean "N-BK7"'
    ),
    scene("ior-zero", '[materials.m]\ntype = "dielectric"\nior = 0\n', "materials.m.ior: 0 is out of range", " to 20"),
    scene("ior-rgb", '[materials.m]\ntype = "dielectric"\nior = [1, 1, 1]\n', "materials.m.ior", "RGB"),
    scene(
        "sellmeier-imaginary",
        '[materials.m]\ntype = "dielectric"\nior = { sellmeier = { B = [5.0], C = [1.0] } }\n',
        "scene.toml:4: materials.m.ior",
        "no real value",
    ),
    scene(
        "sellmeier-lengths",
        '[materials.m]\ntype = "dielectric"\nior = { sellmeier = { B = [1, 2], C = [1] } }\n',
        "materials.m.ior.sellmeier",
        "2 B and 1 C",
    ),
    scene(
        "unused-spectrum", "[spectra.x]\nwavelengths = [500, 400]\nvalues = [1, 1]\n", "spectra.x.wavelengths", "400 nm"
    ),
    scene(
        "named-spectrum",
        '[spectra.x]\nvalue = 1.5\n[materials.m]\ntype = "diffuse"\nreflectance = "x"\n',
        "scene.toml:3: spectra.x.value: 1.5 is out of range for `reflectance`",
    ),
]

HEADER = "# measured\nwavelength_nm,white\n"

SPECTRUM_FILES = [
    csv("word", HEADER + "400,0.5\n404,x\n", "paint.csv:4", '"x"', 'column "white"', "number", "scene.toml:4", "404,x"),
    csv("nan", HEADER + "400,nan\n404,0.5\n", "paint.csv:3", "nan", "finite"),
    csv("negative", HEADER + "400,0.5\n404,-0.01\n", "paint.csv:4", "-0.01 at 404 nm is out of range", "0 to 1"),
    csv("high", HEADER + "400,1.01\n404,0.5\n", "paint.csv:3", "1.01 at 400 nm is out of range", "0 to 1"),
    csv("order", HEADER + "404,0.5\n400,0.5\n", "paint.csv:4", "400 nm comes after 404"),
    csv("twice", HEADER + "400,0.5\n400,0.5\n", "paint.csv:4", "400 nm is there twice"),
    csv("column", HEADER.replace("white", "whites") + "400,1\n", "paint.csv:2", "white", 'did you mean "whites"'),
    csv("which-column", "nm,a,b\n400,1,1\n500,1,1\n", "paint.csv:1", "several columns", "a, b", column=""),
    csv("cells", HEADER + "400,0.5\n404\n", "paint.csv:4", "1 cells", "2, as in the header"),
    csv("one-row", HEADER + "400,0.5\n", "paint.csv", "has 1 wavelengths", "at least 2"),
    csv("empty", "# nothing\n", "paint.csv", "has no rows"),
    csv("no-header", "400,0.5\n404,0.5\n", "paint.csv:1", "starts with numbers", "names the columns"),
    csv("binary", b"\xff\xfe\x00", "paint.csv", "UTF-8"),
]

FILES = [
    material("file-missing", '{ file = "paint.csv" }', "file", '"paint.csv" does not exist', "a file below"),
    material("file-up", '{ file = "../../../etc/passwd" }', "leads outside", "a file below"),
    material("file-absolute", '{ file = "/etc/passwd" }', '"/etc/passwd" leads outside'),
    material("file-home", '{ file = "~/paint.csv" }', "not a plain file name", "no ~ and no URL"),
    material("file-url", '{ file = "http://localhost/paint.csv" }', "not a plain file name", "no URL"),
    material("file-nul", '{ file = "paint\\u0000.csv" }', "control character"),
    material("file-long", f'{{ file = "{"x" * 4096}" }}', "too long a file name", "1024"),
    material("file-number", "{ file = 3 }", "3 is not a file name"),
    material("file-folder", '{ file = "paint.csv" }', "is a folder", files={"paint.csv/x": ""}),
    material("file-pipe", '{ file = "paint.csv" }', "pipe, socket or device", prepare=_fifo),
    material("file-link-outside", '{ file = "paint.csv" }', "leads outside", prepare=_link_outside),
    material("file-suffix", '{ file = "scene.toml" }', "file type", ".csv"),
    material("file-builtin", '{ file = "builtin:cornell_box.csv" }', "cornell_box_reflectance.csv", "did you mean"),
]

INCLUDES = [
    scene(
        "include-itself", 'include = ["scene.toml"]\n', "scene.toml:2: include[0]", "includes itself", "scene.toml ->"
    ),
    scene(
        "include-loop",
        'include = ["b.toml"]\n',
        "b.toml:2: include[0]",
        "includes itself",
        files={"b.toml": 'accuray = 1\ninclude = ["scene.toml"]\n'},
    ),
    scene("include-missing", 'include = ["b.toml"]\n', "scene.toml:2: include[0]", '"b.toml" does not exist'),
    scene("include-text", 'include = "b.toml"\n', "scene.toml:2: include", "is not a list"),
    scene("include-up", 'include = ["../b.toml"]\n', "scene.toml:2: include[0]", "leads outside"),
    scene(
        "include-deep",
        'include = ["f0.toml"]\n',
        "f31.toml:2: include[0]",
        "included too deeply",
        "32 levels",
        files={f"f{i}.toml": f'accuray = 1\ninclude = ["f{i + 1}.toml"]\n' for i in range(40)},
    ),
    scene(
        "include-bomb",
        'include = ["f0.toml", "f0.toml"]\n',
        ".toml:2: include[",
        "one file too many",
        "1000 files",
        files={f"f{i}.toml": f'accuray = 1\ninclude = ["f{i + 1}.toml", "f{i + 1}.toml"]\n' for i in range(30)}
        | {"f30.toml": "accuray = 1\n"},
    ),
    scene(
        "include-no-version", 'include = ["b.toml"]\n', "b.toml", "has no format version", files={"b.toml": "a = 1\n"}
    ),
    scene(
        "include-bad-value",
        'include = ["b.toml"]\n[film]\nheight = 3\n',
        "b.toml:3: film.width: 0 is out of range",
        files={"b.toml": "accuray = 1\n[film]\nwidth = 0\n"},
    ),
]

OVERRIDES = [
    scene("override-key", "", "-D film.widht=3", "film.widht", 'did you mean "width"', overrides=("film.widht=3",)),
    scene("override-value", "", "-D film.width=0", "0 is out of range", "1 to 65536", overrides=("film.width=0",)),
    scene("override-word", "", "-D film.width=big", '"big" is not a whole number', overrides=("film.width=big",)),
    scene("override-no-value", "", "film.width", "key=value", overrides=("film.width",)),
    scene("override-no-key", "", "is not a dotted key", "film.width", overrides=("a..b=3",)),
    scene("override-inside", "[film]\nwidth = 3\n", "film.width: 3", "not a table", overrides=("film.width.x=3",)),
    scene("override-version", "", "accuray", "cannot be overridden", overrides=("accuray=2",)),
]

MESHES = [
    mesh("nothing", "", "scene.toml:4: shapes.s", "exactly one of file | positions with faces"),
    mesh("no-faces", TRIANGLE, "scene.toml:4: shapes.s", "lacks `faces`"),
    mesh(
        "both",
        'file = "a.obj"\n' + TRIANGLE,
        "shapes.s.positions",
        "`file` and `positions` at once",
        files={"a.obj": ""},
    ),
    mesh("index", TRIANGLE + "faces = [[0, 1, 3]]\n", "scene.toml:8: shapes.s.faces", "vertex 3 does not", "0 to 2"),
    mesh("index-negative", TRIANGLE + "faces = [[0, 1, -1]]\n", "scene.toml:8: shapes.s.faces[0][2]: -1"),
    mesh("index-float", TRIANGLE + "faces = [[0, 1, 2.0]]\n", "shapes.s.faces[0][2]: 2.0 is not a vertex index"),
    mesh("edge", TRIANGLE + "faces = [[0, 1]]\n", "shapes.s.faces[0]: [0, 1] is not a polygon", "3 or more"),
    mesh("flat-faces", TRIANGLE + "faces = [0, 1, 2]\n", "shapes.s.faces[0]: 0 is not a polygon"),
    mesh(
        "row",
        "positions = [\n  [0, 0, 0],\n  [1, 0],\n]\nfaces = []\n",
        "scene.toml:9: shapes.s.positions[1]: [1, 0] is not a row of 3 numbers",
        "[1, 0],",
    ),
    mesh(
        "word",
        'positions = [[0, 0, "0 m"]]\nfaces = []\n',
        "scene.toml:7: shapes.s.positions[0][2]",
        '"0 m"',
        "numbers",
    ),
    mesh("huge-integer", f"positions = [[0, 0, {'9' * 400}]]\nfaces = []\n", "shapes.s.positions", "too large"),
    mesh(
        "normals-count",
        TRIANGLE + "faces = [[0, 1, 2]]\nnormals = [[0, 0, 1]]\n",
        "scene.toml:9: shapes.s.normals",
        "has 1 rows",
        "3, as many as positions",
    ),
    mesh(
        "normals-nan",
        TRIANGLE + "faces = [[0, 1, 2]]\nnormals = [[0, 0, 1], [0, 0, nan], [0, 0, 1]]\n",
        "shapes.s.normals[1][2]: nan",
    ),
    mesh("file-missing", 'file = "a.obj"\n', "scene.toml:7: shapes.s.file", '"a.obj" does not exist'),
    mesh(
        "file-type",
        'file = "a.3ds"\n',
        "scene.toml:7: shapes.s.file",
        '"a.3ds"',
        ".obj, .ply",
        files={"a.3ds": "solid"},
    ),
    mesh("file-up", 'file = "../a.obj"\n', "scene.toml:7: shapes.s.file", "leads outside"),
    mesh(
        "file-normals",
        'file = "a.obj"\nnormals = [[0, 0, 1]]\n',
        "scene.toml:8: shapes.s.normals",
        "only allowed together with `positions`",
        files={"a.obj": "v 0 0 0\n"},
    ),
    mesh_file("obj-number", "a.obj", "v 0 0 0\nv 1 x 0\n", "a.obj:2", "x"),
    mesh_file("obj-index", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj:4", "4"),
    mesh_file("obj-zero", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "a.obj:4", "0"),
    mesh_file("ply-magic", "a.ply", "plx\n", "a.ply"),
    mesh_file(
        "ply-size-lie",
        "a.ply",
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\nproperty float y\n"
        b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        + struct.pack("<3f", 0, 0, 0),
        "a.ply",
    ),
    mesh_file(
        "ply-index",
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
        "a.ply",
        "7",
    ),
]

BAD_SCENES: list[BadScene] = [
    *SYNTAX, *NAMES, *COATS, *VALUES, *SPECTRA, *SPECTRUM_FILES, *FILES, *INCLUDES, *OVERRIDES, *MESHES,
]  # fmt: skip
