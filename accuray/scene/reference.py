"""The reference page of the scene language, generated from the parameter tables."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from accuray import data
from accuray.scene import schema as schemas
from accuray.scene.amounts import NAMES
from accuray.scene.errors import show
from accuray.scene.keys import INTERPOLATION, takes_keys
from accuray.scene.kinds import vocabulary
from accuray.scene.models import MODEL
from accuray.scene.plain import range_text
from accuray.scene.schema import Param, Type
from accuray.scene.units import LENGTH_UNITS

_LAWS = {
    "exact_pdf": "its pdf is exact",
    "reciprocal": "reciprocal",
    "energy_conserving": "never reflects more than it receives",
    "stochastic": "evaluated in expectation",
}

_HEAD = """# Scene reference

This page is generated from the parameter tables in the kernels' headers; `accuray schema` prints the same as a JSON
Schema for editors.

A scene is a TOML 1.0 file (or JSON with the same structure) that begins with `accuray = 1`. Every key is checked: an
unknown one is an error that names the nearest known one.

| key | meaning |
|---|---|
| `accuray` | version of the format: 1 |
| `length_unit` | unit of bare lengths in this file: {units}; `"m"` if not given |
| `include` | list of files that are merged below this one; sections and named objects merge key by key |

## Values

- **Numbers with units** are texts: `"35 mm"`, `"15 deg"`, `"6500 K"`, `"1000 cd/m^2"`. A bare number is in the unit
  that the table names; a bare length is in `length_unit`. A wrong unit is an error.
- **Files** lie below the folder of the scene file or an asset root (`ACCURAY_PATH`). `"builtin:NAME"` names data that
  come with the renderer: {files}.
- **Transforms**: `{{translate = [x, y, z], rotate = {{axis = [x, y, z], angle = 30}}, scale = s}}` (scaled first, then
  rotated, then translated), `{{matrix = [16 numbers, row by row]}}`,
  `{{look_at = {{origin = [x, y, z], target = [x, y, z], up = [0, 1, 0]}}}}` (moved to the origin, the -z axis turned to
  the target), or a list of such steps applied in order. A scale is one number or three; a negative one mirrors. What
  is made of triangles may be sheared and stretched; spheres, disks and instances may not.
- **Keys**: what says "or keys" may change with time:
  `{{keys = [{{time = 0, value = 1}}, {{time = "500 ms", value = 2}}], interpolation = "linear"}}`, or {others}.
  Times are seconds since frame 0. The value holds for the whole frame; before the first key and after the last it
  stays what it is there. [Animation](animation.md) says more.
- **Arrays**: positions, normals and uvs are lists of rows; faces are lists of vertex indices that count from 0.

## Spectra

A spectrum is written in place or named: `[spectra.NAME]` defines one that any spectrum parameter can use by its name.

| spelling | meaning | for |
|---|---|---|
| `0.5` | the same value at all wavelengths | all |
| `[r, g, b]`, `{{rgb = [r, g, b]}}` | linear Rec.709; emissions multiply D65 scaled to Y = 1 | reflectance, emission |
| `{{file = "paint.csv", column = "white"}}` | measured: first column nm, linear between the rows | all |
| `{{wavelengths = [..], values = [..]}}` | the same, written out | all |
| `"6500 K"`, `{{blackbody = "6500 K"}}` | Planck's radiance, absolute unless scaled | emission |
| `"D65"`, `{{illuminant = "D65"}}` | CIE illuminant scaled to Y = 1: {illuminants} | emission |
| `"100 cd"`, `"800 lm"`, `"500 lx"`, `"300 nit"`, `"10 W"` | that much light, equal at all wavelengths | emission |
| `"N-BK7"` | glass: {glasses} | index |
| `{{sellmeier = {{A0 = 0, B = [..], C = [..]}}}}` | n^2 = 1 + A0 + sum B L^2 / (L^2 - C), L in micrometres | index |
| `{{cauchy = [A, B]}}` | n = A + B / L^2, L in micrometres | index |

Table spellings also take `scale = number`; tables of wavelengths take `extrapolate = "hold"` (default, zero for
emissions) or `"zero"`; emissions take `normalize = true` (Y = 1 before `scale`) or one amount of light:
{amounts}.
Here Y = integral(L ybar) / integral(ybar), and L is in W m^-2 sr^-1 nm^-1. A luminous amount is 683.002 lm/W times the
integral of ybar, one in W the integral from 360 to 830 nm. A `flux` is that of the whole emitter: of a point or spot
light, or of each shape with an emissive material.
"""

_TEXTURES = """A parameter whose kind says "or texture" takes `{ texture = "NAME" }` as well, with `scale = number`
to multiply it; one that is a number or an index of refraction takes `channel = "red"` (default), `"green"`, `"blue"`
or `"alpha"`."""


def reference_markdown() -> str:
    """The whole page as Markdown, ending with a line end."""
    schema = schemas.current()
    parts = [
        _HEAD.format(
            units=", ".join(f'`"{unit}"`' for unit in LENGTH_UNITS),
            files=", ".join(f"`{name}`" for name in data.files()),
            illuminants=", ".join(data.illuminants()),
            others=" or ".join(f'`"{name}"`' for name in INTERPOLATION.choices if name != INTERPOLATION.default),
            glasses=", ".join(data.glasses()),
            amounts=", ".join(f"`{name}` ({' or '.join(choices)})" for name, choices in NAMES.items()),
        )
    ]
    for name, title in (("render", "Rendering"), ("film", "Film"), ("animation", "Animation")):
        header = schema.family(name).header
        parts.append(f"## {title}: `[{name}]`\n\n{_table(header.params)}")
    for name, title, section in (
        ("filter", "Pixel filters", "film.filter"),
        ("camera", "Cameras", "camera"),
        ("integrator", "Integrators", "integrator"),
    ):
        family = schema.family(name)
        note = f"One of the types below; `{family.default}` if there is no such table."
        parts.append(_family(title, section, note, family.types.values()))
    header_names = "Besides its own parameters every material has the last ones of its table."
    parts.append(f"## Models: `[models.NAME]`\n\n{MODEL.doc}\n\n{_table(MODEL.params)}")
    parts.append(_family("Textures", "textures.NAME", _TEXTURES, schema.family("texture").types.values()))
    parts.append(_family("Materials", "materials.NAME", header_names, schema.material_types.values()))
    parts.append(_family("Lights", "lights.NAME", "", schema.family("light").types.values()))
    parts.append(_family("Shapes", "shapes.NAME", "", schema.family("shape").types.values()))
    return "\n".join(parts)


def _family(title: str, section: str, note: str, types: Iterable[Type]) -> str:
    body = "\n".join(_type(type_) for type_ in types)
    return f"## {title}: `[{section}]`\n\n" + (note + "\n\n" if note else "") + body


def _type(type_: Type) -> str:
    laws = ", ".join(_LAWS.get(law, law) for law in type_.keeps)
    text = f'### `type = "{type_.name}"`\n\n{type_.doc}\n'
    if laws:
        text += f"\nKeeps: {laws}.\n"
    return text + "\n" + _table(type_.params)


def _table(params: Iterable[Param]) -> str:
    rows = [f"| `{p.name}` | {_kind(p)} | {_unit(p)} | {_range(p)} | {_default(p)} | {_doc(p)} |" for p in params]
    if not rows:
        return "It has no parameters.\n"
    return "\n".join(
        ["| parameter | kind | unit | allowed | default | meaning |", "|---|---|---|---|---|---|", *rows, ""]
    )


def _kind(param: Param) -> str:
    forms = [_plain_kind(param)]
    if param.texturable and param.kind != "reference":
        forms.append("texture")
    if takes_keys(param):
        forms.append("keys")
    return " or ".join(forms)


def _plain_kind(param: Param) -> str:
    if param.kind == "spectrum":
        return f"spectrum ({param.role})"
    if param.kind == "reference":
        return f"name of a {param.role}"
    return f"array ({param.role})" if param.kind == "array" else param.kind


def _unit(param: Param) -> str:
    return param.unit.replace("|", "\\|") if param.unit not in ("", "1") else ""


def _range(param: Param) -> str:
    names = vocabulary(param)
    choices = param.choices or (tuple(names()) if names is not None else ())
    if choices:
        return ", ".join(f"`{choice}`" for choice in choices)
    return range_text(param) or "" if param.kind != "array" else ""


def _default(param: Param) -> str:
    if param.required:
        return "required"
    if param.default is None:
        return "one of a set" if param.group and not param.set_name.endswith("?") else ""
    return f"`{_spelled(param.default)}`"


def _spelled(value: Any) -> str:
    return "[" + ", ".join(map(_spelled, value)) + "]" if isinstance(value, (list, tuple)) else show(value)


def _doc(param: Param) -> str:
    group = ""
    if param.group:
        count = "At most" if param.set_name.endswith("?") else "Exactly"
        group = f" {count} one alternative of *{param.set_name.rstrip('?')}* is given: this is *{param.alternative}*."
    return param.doc.replace("|", "\\|") + group
