"""Reads the spellings of a spectrum in a scene and checks them against the parameter that takes it.

A spectrum is a number, ``[r, g, b]``, a name, a quantity such as ``"6500 K"``, or a table with one form key
(``value``, ``rgb``, ``file``, ``wavelengths`` + ``values``, ``blackbody``, ``illuminant``, ``sellmeier``,
``cauchy``) and modifiers (``scale``, ``extrapolate``, and for emissions ``normalize`` or an amount of light such as
``luminance``). A quantity that is an amount, ``"100 cd"``, is white light, the same at all wavelengths.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from accuray import data
from accuray.scene import amounts, units
from accuray.scene.errors import SceneError, Where
from accuray.scene.keys import first_value, is_keyed, resolve_keyed
from accuray.scene.plain import finite_number, in_range, number_list, quantity, range_text, text_value
from accuray.scene.schema import Param
from accuray.scene.scope import Scope
from accuray.scene.spectrum import FIRST_NM, LAST_NM, Spectrum, xyz
from accuray.scene.spectrum_file import Column, read_column

KELVIN = Param("blackbody", "float", unit="K", min=500.0, max=100_000.0)
SCALE = Param("scale", "float", min=0.0)
RADIANCE_UNIT = "W/(m^2 sr nm)"
PERFECT_METAL = "perfect"
MODIFIERS = ("scale", "extrapolate", "normalize", *amounts.NAMES)
ROLES_OF_FORM = {
    "value": ("reflectance", "emission", "index"),
    "rgb": ("reflectance", "emission"),
    "file": ("reflectance", "emission", "index"),
    "wavelengths": ("reflectance", "emission", "index"),
    "blackbody": ("emission",),
    "illuminant": ("emission",),
    "sellmeier": ("index",),
    "cauchy": ("index",),
}
COMPANIONS = {"file": ("column",), "wavelengths": ("values",)}


@dataclass(frozen=True)
class _Reading:
    """One spectrum being read; ``column`` is set when its table comes from a CSV file."""

    param: Param
    scope: Scope
    where: Where
    column: Column | None = None

    @property
    def role(self) -> str:
        return self.param.role


_Read = tuple[Spectrum, Column | None]


def parse_spectrum(param: Param, value: Any, where: Where, scope: Scope) -> Spectrum:
    """The Spectrum that ``value`` spells, for a parameter's role, unit and range. Raises SceneError."""
    reading = _Reading(param, scope, where)
    if isinstance(value, Spectrum):
        if value.role != param.role:
            raise where.error(f"is {_article(value.role)}, not {_article(param.role)}", value=value)
        spectrum = value
    elif is_keyed(value):
        return _from_keys(reading, value)
    elif isinstance(value, dict):
        return _from_table(reading, value)
    elif isinstance(value, str):
        return _from_text(reading, value)
    elif isinstance(value, bool) or value is None:
        raise where.error("is not a spectrum", value=value, allowed=_allowed(param))
    elif hasattr(value, "__len__"):
        if param.role == "index":
            raise where.error("is an RGB colour, which has no refractive index", value=value, allowed=_allowed(param))
        spectrum = _rgb(reading, value)
    else:
        spectrum = Spectrum("constant", param.role, value=finite_number(value, where, _allowed(param)))
    _check_range(reading, spectrum)
    return spectrum


def check_unused(value: Any, where: Where, scope: Scope) -> None:
    """Check a [spectra] entry that nothing refers to: as an emission, the least restricted role, if it can be one."""
    sample, place = first_value(value, where)
    roles = ROLES_OF_FORM[_form_key(place, sample)] if isinstance(sample, dict) else ("emission",)
    role = "emission" if "emission" in roles else roles[0]
    amount = next((key for key in sample if key in amounts.NAMES), "") if isinstance(sample, dict) else ""
    unit, takes_flux = amounts.spectral_unit(amount) if amount else (RADIANCE_UNIT, False)
    param = Param(where.key, "spectrum", role=role, unit=unit, takes_flux=takes_flux, min=0.0, animatable=True)
    parse_spectrum(param, value, where, scope)


def metal_names() -> list[str]:
    """Names that ``metal_spectra`` knows."""
    return [*data.metals(), PERFECT_METAL]


def metal_spectra(name: str) -> dict[str, Spectrum]:
    """Index n and k of a named metal as the parameters ``eta`` and ``k``; "perfect" reflects everything (n = 0)."""
    if name == PERFECT_METAL:
        return {key: Spectrum("constant", "index", value=value) for key, value in (("eta", 0.0), ("k", 1.0))}
    metal = data.metals()[name]
    return {
        key: Spectrum("table", "index", wavelengths=metal.wavelengths, values=values)
        for key, values in (("eta", metal.n), ("k", metal.k))
    }


def _allowed(param: Param) -> str:
    examples = {
        "reflectance": 'a number, [r, g, b], the name of a spectrum in [spectra], or a table such as {file = "x.csv"}',
        "emission": 'a number, [r, g, b], the name of a spectrum or illuminant, "6500 K", or a table',
        "index": "a number, the name of a glass or of a spectrum in [spectra], or a table",
    }
    return examples[param.role]


def _from_keys(reading: _Reading, value: dict[str, Any]) -> Spectrum:
    param, scope = reading.param, reading.scope

    def plain(item: Any, place: Where) -> Spectrum:
        return parse_spectrum(param, item, place, scope)

    spectrum: Spectrum = resolve_keyed(param, value, reading.where, scope, plain)
    return spectrum


def _from_text(reading: _Reading, text: str) -> Spectrum:
    """A name or a quantity. Names in [spectra] come before built-in ones."""
    param, where, scope = reading.param, reading.where, reading.scope
    named = scope.names("spectra")
    if text in named:
        document = scope.document
        value = document.data["spectra"][text]
        origin = Where(document, ("spectra", text))
        if isinstance(value, str):
            raise origin.error("is a name", value=value, allowed="a spectrum itself, written out")
        return parse_spectrum(param, value, origin, scope)
    if units.looks_like_quantity(text):
        return _from_quantity(reading, text)
    builtin = list(data.illuminants() if param.role == "emission" else data.glasses() if param.role == "index" else ())
    if text in builtin:
        return _illuminant(text) if param.role == "emission" else _glass(text)
    noun = {"emission": "spectrum or illuminant", "index": "spectrum or glass"}.get(param.role, "spectrum in [spectra]")
    raise where.unknown(text, noun, [*named, *builtin])


def _from_quantity(reading: _Reading, text: str) -> Spectrum:
    param, where = reading.param, reading.where
    try:
        exponents = units.parse_unit(units.parse_quantity(text).unit).exponents
    except units.UnitError as error:
        raise where.error(str(error), value=text, allowed=_allowed(param)) from None
    if exponents == (("K", 1),) and param.role == "emission":
        spectrum = _blackbody(reading, text)
    elif exponents == units.parse_unit(param.unit).exponents and exponents:
        spectrum = Spectrum("constant", param.role, value=quantity(param, text, where))
    elif exponents in amounts.kinds(param):
        white = Spectrum("constant", param.role, value=1.0)
        spectrum = amounts.scaled_to(white, amounts.plain_amount(param, text, where), where)
    elif not exponents:
        raise where.error("has no unit (a number is written without quotes)", value=text, allowed=_allowed(param))
    else:
        takes = f" ({', '.join([param.unit, *amounts.fitting_units(param)])})" if param.unit not in ("", "1") else ""
        raise where.error("has the wrong unit", value=text, allowed=_allowed(param) + takes)
    _check_range(reading, spectrum)
    return spectrum


def _form_key(where: Where, table: dict[str, Any]) -> str:
    """The one form key of a table; errors for none, several and unknown keys."""
    known = [*ROLES_OF_FORM, *(key for keys in COMPANIONS.values() for key in keys), *MODIFIERS]
    for key in table:
        if key not in known:
            raise where.child(key).unknown(key, "key of a spectrum", known)
    if "values" in table and "wavelengths" not in table:
        raise where.child("values").error("is given without `wavelengths`")
    forms = [key for key in table if key in ROLES_OF_FORM]
    if len(forms) != 1:
        problem = f"has {len(forms)} of the keys that give a spectrum" + (f": {', '.join(forms)}" if forms else "")
        raise where.error(problem, value=table, allowed="exactly one of " + ", ".join(ROLES_OF_FORM))
    for form, companions in COMPANIONS.items():
        for key in companions:
            if key in table and form != forms[0]:
                raise where.child(key).error(f"is only allowed beside `{form}`")
    return forms[0]


def _from_table(reading: _Reading, table: dict[str, Any]) -> Spectrum:
    where, role = reading.where, reading.role
    form = _form_key(where, table)
    if role not in ROLES_OF_FORM[form]:
        raise where.child(form).error(f"is not a form of {_article(role)}", value=form, allowed=_allowed(reading.param))
    spectrum, column = _READ_FORM[form](replace(reading, where=where.child(form)), table)
    reading = replace(reading, column=column)
    if "extrapolate" in table:
        choice = text_value(table["extrapolate"], where.child("extrapolate"))
        if choice not in ("hold", "zero") or spectrum.form != "table":
            raise where.child("extrapolate").error(
                "is not allowed here", value=choice, allowed='"hold" or "zero", for tables of wavelengths'
            )
        spectrum = replace(spectrum, extrapolate=choice)
    spectrum = _scaled(reading, spectrum, table)
    _check_range(reading, spectrum, form)
    return spectrum


def _article(role: str) -> str:
    return {"reflectance": "a reflectance", "emission": "an emission", "index": "a refractive index"}[role]


def _scaled(reading: _Reading, spectrum: Spectrum, table: dict[str, Any]) -> Spectrum:
    """Folds ``normalize`` or an amount of light, then ``scale``, into the spectrum."""
    where = reading.where
    normalize = table.get("normalize", False)
    if not isinstance(normalize, bool):
        raise where.child("normalize").error("is not a truth value", value=normalize, allowed="true or false")
    given = [key for key in table if key in amounts.NAMES] + ["normalize"] * normalize
    if given and reading.role != "emission":
        raise where.child(given[0]).error(f"is for emissions, and this is {_article(reading.role)}")
    if len(given) > 1:
        raise where.child(given[0]).error(f"cannot go with `{given[-1]}`", value=table[given[0]])
    if normalize:
        spectrum = _with_y(reading, spectrum, 1.0)
    elif given:
        amount = amounts.named_amount(reading.param, given[0], table[given[0]], where.child(given[0]))
        spectrum = amounts.scaled_to(spectrum, amount, where)
    if "scale" in table:
        spectrum = spectrum.times(quantity(SCALE, table["scale"], where.child("scale")))
    return spectrum


def _with_y(reading: _Reading, spectrum: Spectrum, target: float) -> Spectrum:
    """Scaled so that Y = target."""
    y = xyz(spectrum)[1]
    if not y > 0.0 or not math.isfinite(target / y):
        raise reading.where.error("has no visible light, so it cannot be scaled to a luminance")
    return amounts.folded(spectrum, target / y)


def _check_range(reading: _Reading, spectrum: Spectrum, form: str = "") -> None:
    """SceneError unless all values are real, finite and in the parameter's range; names the row of a table.

    ``form`` is the key that holds the values if the spectrum is a table in the scene.
    """
    param, table = reading.param, reading.where
    where = table.child(form) if form else table
    low, high = spectrum.bounds()
    if math.isnan(low) or math.isinf(high):
        problem = "has no real value at some wavelength between 360 and 830 nm" if math.isnan(low) else "is too large"
        raise where.error(problem, allowed=range_text(param) or "finite values")
    if in_range(param, low) and in_range(param, high):
        return
    value = high if in_range(param, low) else low
    factor = f" (scaled by {spectrum.scale:g})" if spectrum.scale != 1.0 else ""
    factor += f" for `{param.name}`" if table.path[0] == "spectra" else ""
    allowed = range_text(param)
    if spectrum.form != "table":
        shown = int(value) if value.is_integer() else value
        raise where.error(f"is out of range{factor}", value=shown, allowed=allowed)
    row = next(row for row, item in enumerate(spectrum.values) if not in_range(param, item * spectrum.scale))
    problem = f"{spectrum.values[row]!r} at {spectrum.wavelengths[row]:g} nm is out of range{factor}"
    if reading.column is not None:
        raise reading.column.file.error(reading.column.rows[row], problem, allowed)
    raise table.child("values", row).error(problem, allowed=allowed)


def _constant(reading: _Reading, table: dict[str, Any]) -> _Read:
    return Spectrum("constant", reading.role, value=finite_number(table["value"], reading.where, "a number")), None


def _rgb(reading: _Reading, value: Any) -> Spectrum:
    rgb = number_list(value, reading.where, "[r, g, b] in linear Rec.709")
    if len(rgb) != 3:
        raise reading.where.error(f"has {len(rgb)} components", value=value, allowed="3: [r, g, b] in linear Rec.709")
    return Spectrum("rgb", reading.role, rgb=rgb, white="D65" if reading.role == "emission" else "")


def _file(reading: _Reading, table: dict[str, Any]) -> _Read:
    where = reading.where
    path = reading.scope.files.resolve(table["file"], where, (".csv",))
    name = table.get("column")
    if name is not None:
        name = text_value(name, where.sibling("column"))
    column = read_column(path, name, where)
    return _table(replace(reading, column=column), column.wavelengths, column.values), column


def _inline(reading: _Reading, table: dict[str, Any]) -> _Read:
    where, beside = reading.where, reading.where.sibling("values")
    wavelengths = number_list(table["wavelengths"], where, "a list of wavelengths in nm")
    if "values" not in table:
        raise where.error("is given without `values`")
    values = number_list(table["values"], beside, "a list of numbers")
    if len(values) != len(wavelengths):
        raise beside.error(f"has {len(values)} numbers", allowed=f"{len(wavelengths)}, as many as wavelengths")
    return _table(reading, wavelengths, values), None


def _table(reading: _Reading, wavelengths: tuple[float, ...], values: tuple[float, ...]) -> Spectrum:
    if len(wavelengths) < 2:
        raise _row_error(reading, None, f"has {len(wavelengths)} wavelengths", "at least 2")
    for row, wavelength in enumerate(wavelengths):
        if wavelength <= 0.0:
            raise _row_error(reading, row, f"{wavelength:g} is not a wavelength", "more than 0 nm")
        if row and wavelength <= wavelengths[row - 1]:
            repeats = wavelength == wavelengths[row - 1]
            problem = "is there twice" if repeats else f"comes after {wavelengths[row - 1]:g}"
            raise _row_error(reading, row, f"{wavelength:g} nm {problem}", "wavelengths in rising order")
    if wavelengths[0] > LAST_NM or wavelengths[-1] < FIRST_NM:
        span = f"{wavelengths[0]:g} to {wavelengths[-1]:g}"
        raise _row_error(reading, 0, f"{span} nm is outside of the visible range", "wavelengths in nm, 360 to 830")
    outside = "zero" if reading.role == "emission" else "hold"
    return Spectrum("table", reading.role, wavelengths=wavelengths, values=values, extrapolate=outside)


def _row_error(reading: _Reading, row: int | None, problem: str, allowed: str) -> SceneError:
    """An error at a row of a table: in the CSV if it came from one."""
    if reading.column is not None:
        return reading.column.file.error(None if row is None else reading.column.rows[row], problem, allowed)
    where = reading.where if row is None else reading.where.child(row)
    return where.error(problem, allowed=allowed)


def _blackbody(reading: _Reading, value: Any) -> Spectrum:
    return Spectrum("blackbody", reading.role, kelvin=quantity(KELVIN, value, reading.where))


def _illuminant_form(reading: _Reading, table: dict[str, Any]) -> _Read:
    name = text_value(table["illuminant"], reading.where)
    if name not in data.illuminants():
        raise reading.where.unknown(name, "illuminant", data.illuminants())
    return _illuminant(name), None


def _illuminant(name: str) -> Spectrum:
    """A CIE illuminant scaled to Y = 1."""
    if name == "E":
        return Spectrum("constant", "emission", value=1.0)
    wavelengths, values = data.illuminants()[name]
    spectrum = Spectrum("table", "emission", wavelengths=wavelengths, values=values, extrapolate="zero")
    return replace(spectrum, scale=float(f"{1.0 / xyz(spectrum)[1]:.{amounts.FOLDED_DIGITS - 1}e}"))


def _glass(name: str) -> Spectrum:
    glass = data.glasses()[name]
    return Spectrum("sellmeier", "index", A0=glass.A0, B=glass.B, C=glass.C)


def _sellmeier(reading: _Reading, table: dict[str, Any]) -> _Read:
    where, terms = reading.where, table["sellmeier"]
    if not isinstance(terms, dict):
        raise where.error("is not a table of coefficients", value=terms, allowed="{A0 = 0, B = [..], C = [..]}")
    for key in terms:
        if key not in ("A0", "B", "C"):
            raise where.child(key).unknown(key, "Sellmeier coefficient", ("A0", "B", "C"))
    missing = [key for key in ("B", "C") if key not in terms]
    if missing:
        raise where.error(f"lacks {' and '.join(missing)}", allowed="{A0 = 0, B = [..], C = [..]}")
    b = number_list(terms["B"], where.child("B"), "a list of numbers")
    c = number_list(terms["C"], where.child("C"), "a list of numbers in um^2")
    if len(b) != len(c) or not 1 <= len(b) <= 6:
        raise where.error(f"has {len(b)} B and {len(c)} C", allowed="as many B as C, 1 to 6")
    a0 = finite_number(terms.get("A0", 0.0), where.child("A0"), "a number")
    return Spectrum("sellmeier", "index", A0=a0, B=b, C=c), None


def _cauchy(reading: _Reading, table: dict[str, Any]) -> _Read:
    terms = number_list(table["cauchy"], reading.where, "[A, B] with wavelengths in um")
    if len(terms) != 2:
        raise reading.where.error(f"has {len(terms)} coefficients", allowed="[A, B]: n = A + B / L^2 with L in um")
    return Spectrum("cauchy", "index", A0=terms[0], B=terms[1:]), None


_READ_FORM: dict[str, Callable[[_Reading, dict[str, Any]], _Read]] = {
    "value": _constant,
    "rgb": lambda reading, table: (_rgb(reading, table["rgb"]), None),
    "file": _file,
    "wavelengths": _inline,
    "blackbody": lambda reading, table: (_blackbody(reading, table["blackbody"]), None),
    "illuminant": _illuminant_form,
    "sellmeier": _sellmeier,
    "cauchy": _cauchy,
}
