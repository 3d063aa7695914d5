"""The validated scene: every section with every parameter, in canonical values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from accuray.scene import openpbr
from accuray.scene import schema as schemas
from accuray.scene.clock import STILL, Clock
from accuray.scene.composition import check_parts
from accuray.scene.environments import check_environments
from accuray.scene.errors import Document, Source, Where
from accuray.scene.exposure import resolve_exposure
from accuray.scene.identity import scene_identity
from accuray.scene.models import expand_models
from accuray.scene.objects import expect_table, resolve_object, resolve_params
from accuray.scene.paths import Confinement
from accuray.scene.photometry import read_photometries
from accuray.scene.refinement import check_refinement
from accuray.scene.scope import Scope
from accuray.scene.shapes import check_shapes
from accuray.scene.spectra import check_unused
from accuray.scene.textures import check_bumps, check_opacity, check_vertices, settle_colour_spaces
from accuray.scene.units import LENGTH_UNITS

FORMAT_VERSION = 1
SECTIONS = (
    "render", "film", "animation", "camera", "integrator", "models", "spectra", "textures", "materials", "lights",
    "shapes",
)  # fmt: skip
FILE_KEYS = ("accuray", "length_unit", "include")
FILM_BITS = 24
MAX_NAME = 256


@dataclass(frozen=True)
class Scene:
    """A scene ready for rendering; treat it as read-only.

    ``film``, ``filter``, ``camera``, ``integrator`` and ``render`` are single tables; ``textures``, ``materials``,
    ``lights`` and ``shapes`` map names, in sorted order, to tables. Each table has "type" where its family has
    types, and every parameter of that type: SI values as ``accuray.scene.kinds`` describes, None for what is neither
    given nor has a default; a light with a measured distribution has it as "photometry". ``path`` is the file the
    scene was read from, None for scenes built in Python; ``mesh_reports`` says, by shape, what was left out of mesh
    files or made up, ``model_notes`` what could not be translated of models; ``clock`` is the moment of the frame.
    """

    film: dict[str, Any]
    filter: dict[str, Any]
    camera: dict[str, Any]
    integrator: dict[str, Any]
    render: dict[str, Any]
    materials: dict[str, dict[str, Any]]
    lights: dict[str, dict[str, Any]]
    shapes: dict[str, dict[str, Any]]
    path: Path | None = None
    mesh_reports: dict[str, dict[str, Any]] = field(default_factory=dict)
    textures: dict[str, dict[str, Any]] = field(default_factory=dict)
    model_notes: tuple[str, ...] = ()
    clock: Clock = STILL

    @classmethod
    def from_dict(
        cls, description: dict[str, Any], *, folder: str | Path | None = None, roots: Iterable[str | Path] = ()
    ) -> Scene:
        """A scene from Python objects with the structure of a scene file; arrays may be numpy arrays.

        ``folder`` is where relative file names start (the current folder if not given), ``roots`` are further
        folders that files may lie in. ``accuray = 1`` may be left out, ``include`` is not allowed. Raises
        SceneError.
        """
        source = Source(folder=Path.cwd() if folder is None else Path(folder))
        document = Document(description, source)
        where = Where(document)
        table = expect_table(description, where)
        if "include" in table:
            raise where.child("include").error("is only allowed in scene files")
        document.top = Source(folder=source.folder, length_unit=check_file_keys(table, where, needs_version=False))
        return build(document, roots=roots)

    @cached_property
    def identity(self) -> str:
        """SHA-256, 64 hexadecimal digits, of everything that changes a sample."""
        return scene_identity(self, schemas.current())


def build(
    document: Document, *, roots: Iterable[str | Path] = (), path: Path | None = None, notes: Iterable[str] = ()
) -> Scene:
    """Validate a document and resolve it into a Scene. ``notes`` are its ``model_notes`` so far. Raises SceneError."""
    schema = schemas.current()
    top = Where(document)
    data = expect_table(document.data, top)
    for key in data:
        if key not in SECTIONS and key not in FILE_KEYS:
            raise top.child(key).unknown(key, "section", (*FILE_KEYS, *SECTIONS))
    files = Confinement.around(document.top.folder, roots)
    document, more_notes = expand_models(document, schema, files)
    top, data = Where(document), document.data
    scope = Scope(document, schema, files)
    scope.clock = _clock(scope)
    film, pixel_filter = _film(scope)
    textures = _named("textures", schema.family("texture").types, scope)
    materials = _named("materials", schema.material_types, scope)
    lights = _named("lights", schema.family("light").types, scope)
    shapes = _named("shapes", schema.family("shape").types, scope)
    read_photometries(lights, schema, top.child("lights"))
    check_shapes(shapes, schema, top.child("shapes"))
    check_refinement(shapes, textures, schema, top.child("shapes"))
    openpbr.settle(materials, top.child("materials"))
    check_parts(materials, schema, top.child("materials"))
    settle_colour_spaces(textures, materials, shapes, top.child("textures"))
    check_environments(lights, top.child("lights"))
    check_opacity(materials, top)
    check_bumps(textures, materials, schema, top)
    check_vertices(textures, materials, shapes, schema, top)
    _check_spectra(scope)
    camera = _single("camera", data, top.child("camera"), scope)
    film["exposure"] = resolve_exposure(film, camera, top.child("film"))
    film["unit"] = film_unit(film["unit"], film["exposure"])
    return Scene(
        film=film,
        filter=pixel_filter,
        camera=camera,
        integrator=_single("integrator", data, top.child("integrator"), scope),
        render=resolve_params(schema.family("render").header, _section("render", scope), top.child("render"), scope),
        materials=materials,
        lights=lights,
        shapes=shapes,
        path=path,
        mesh_reports=scope.mesh_reports,
        textures=textures,
        model_notes=(*notes, *more_notes),
        clock=scope.clock,
    )


def check_file_keys(table: dict[str, Any], where: Where, *, needs_version: bool = True) -> str:
    """Check ``accuray`` and ``length_unit`` of one file; returns the length unit."""
    version = table.get("accuray")
    allowed = f"accuray = {FORMAT_VERSION}"
    if version is None and needs_version:
        raise where.error("has no format version", allowed=allowed)
    if version is not None and (isinstance(version, bool) or version != FORMAT_VERSION):
        raise where.child("accuray").error("is not a format version that is read here", value=version, allowed=allowed)
    unit = table.get("length_unit", "m")
    if not isinstance(unit, str) or unit not in LENGTH_UNITS:
        raise where.child("length_unit").unknown(unit, "length unit", LENGTH_UNITS)
    return unit


def _section(name: str, scope: Scope) -> dict[str, Any]:
    return expect_table(scope.document.data.get(name, {}), Where(scope.document, (name,)))


def _single(name: str, table: dict[str, Any], where: Where, scope: Scope) -> dict[str, Any]:
    """The one object of a family that ``table`` may hold; the family's default type where it does not."""
    family = scope.schema.family(name)
    return resolve_object(family.types, table.get(name, {"type": family.default}), where, scope)


def _named(section: str, types: dict[str, schemas.Type], scope: Scope) -> dict[str, dict[str, Any]]:
    """A section of named objects, in the order of their names, so that spelling order changes no sample."""
    where = Where(scope.document, (section,))
    table = _section(section, scope)
    for name in table:
        _check_name(name, where)
    return {name: resolve_object(types, table[name], where.child(name), scope) for name in sorted(table)}


def _check_name(name: str, where: Where) -> None:
    if not name or len(name) > MAX_NAME or any(ord(character) < 32 for character in name):
        raise where.child(name).error("is not a name", value=name, allowed=f"1 to {MAX_NAME} printable characters")


def _clock(scope: Scope) -> Clock:
    where = Where(scope.document, ("animation",))
    values = resolve_params(scope.schema.family("animation").header, _section("animation", scope), where, scope)
    clock = Clock.of(values)
    if clock.close < clock.open:
        raise where.child("shutter_close").error(
            "closes the shutter before it opens", value=values["shutter_close"], allowed="shutter_open or later"
        )
    return clock


def _film(scope: Scope) -> tuple[dict[str, Any], dict[str, Any]]:
    """The film, and the pixel filter inside it."""
    where = Where(scope.document, ("film",))
    given = dict(_section("film", scope))
    inner = {"filter": given.pop("filter")} if "filter" in given else {}
    pixel_filter = _single("filter", inner, where.child("filter"), scope)
    film = resolve_params(scope.schema.family("film").header, given, where, scope, other_keys=("filter",))
    return film, pixel_filter


def film_unit(unit: float | None, exposure: float) -> float:
    """The fixed-point step: the given one, or 2^-24 of the exposed white, rounded to a power of two."""
    if unit is None:
        return math.ldexp(1.0, math.floor(-FILM_BITS - exposure + 0.5))
    mantissa, exponent = math.frexp(unit)
    return math.ldexp(1.0, exponent if mantissa * mantissa >= 0.5 else exponent - 1)


def _check_spectra(scope: Scope) -> None:
    where = Where(scope.document, ("spectra",))
    for name, value in _section("spectra", scope).items():
        _check_name(name, where)
        if isinstance(value, str):
            raise where.child(name).error("is a name", value=value, allowed="a spectrum itself, written out")
        check_unused(value, where.child(name), scope)
