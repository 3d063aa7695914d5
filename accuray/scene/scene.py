"""The validated scene: every section with every parameter, in canonical values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from accuray.scene import openpbr
from accuray.scene import schema as schemas
from accuray.scene.clock import STILL, Clock
from accuray.scene.composition import check_parts
from accuray.scene.deformation import check_deforming
from accuray.scene.environments import check_environments
from accuray.scene.errors import Document, Source, Where
from accuray.scene.exposure import resolve_exposure
from accuray.scene.identity import scene_identity
from accuray.scene.keys import has_keys
from accuray.scene.models import expand_models
from accuray.scene.motion import matrices_of, mirrors
from accuray.scene.objects import expect_table, resolve_object, resolve_params
from accuray.scene.paths import Confinement
from accuray.scene.photometry import read_photometries
from accuray.scene.refinement import check_refinement
from accuray.scene.scope import Scope
from accuray.scene.shapes import check_shapes
from accuray.scene.spectra import check_unused
from accuray.scene.textures import check_bumps, check_opacity, check_vertices, settle_colour_spaces
from accuray.scene.transforms import check_rigid
from accuray.scene.units import LENGTH_UNITS

FORMAT_VERSION = 1
SECTIONS = (
    "render", "film", "animation", "camera", "integrator", "models", "spectra", "textures", "materials", "lights",
    "shapes",
)  # fmt: skip
FILE_KEYS = ("accuray", "length_unit", "include")
FILM_BITS = 24
MAX_NAME = 256


@dataclass
class Resident:
    """What the frames of one animation share.

    ``scope`` holds the document and all that was read for it, None if nothing in it changes with time; ``path`` and
    ``notes`` are the scene's. ``loaded`` belongs to the device: what it made of the latest frame.
    """

    scope: Scope | None = None
    path: Path | None = None
    notes: tuple[str, ...] = ()
    loaded: Any = None

    def __getstate__(self) -> dict[str, Any]:
        """What a copy takes along: not what a device holds."""
        return {**vars(self), "loaded": None}


@dataclass(frozen=True)
class Scene:
    """A scene ready for rendering; treat it as read-only.

    ``film``, ``filter``, ``camera``, ``integrator`` and ``render`` are single tables; ``textures``, ``materials``,
    ``lights`` and ``shapes`` map names, in sorted order, to tables. Each table has "type" where its family has
    types, and every parameter of that type: SI values as ``accuray.scene.kinds`` describes, None for what is neither
    given nor has a default; a light with a measured distribution has it as "photometry". ``path`` is the file the
    scene was read from, None for scenes built in Python; ``mesh_reports`` says, by shape, what was left out of mesh
    files or made up, ``model_notes`` what could not be translated of models; ``animation`` is the section of this
    name, ``clock`` the moment of the frame, and ``resident`` what the scene shares with its other frames.
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
    animation: dict[str, Any] = field(default_factory=dict)
    resident: Resident = field(default_factory=Resident, repr=False, compare=False)

    @classmethod
    def from_dict(
        cls,
        description: dict[str, Any],
        *,
        folder: str | Path | None = None,
        roots: Iterable[str | Path] = (),
        frame: float | None = None,
    ) -> Scene:
        """A scene from Python objects with the structure of a scene file; arrays may be numpy arrays.

        ``folder`` is where relative file names start (the current folder if not given), ``roots`` are further
        folders that files may lie in, ``frame`` takes the place of ``animation.frame``. ``accuray = 1`` may be left
        out, ``include`` is not allowed. Raises SceneError.
        """
        source = Source(folder=Path.cwd() if folder is None else Path(folder))
        document = Document(description, source)
        where = Where(document)
        table = expect_table(description, where)
        if "include" in table:
            raise where.child("include").error("is only allowed in scene files")
        document.top = Source(folder=source.folder, length_unit=check_file_keys(table, where, needs_version=False))
        return build(document, roots=roots, frame=frame)

    def at(self, frame: float) -> Scene:
        """The scene at another frame, which may lie between whole ones: its time is ``frame`` / ``animation.fps``.

        It has the values of ``accuray.load(..., frame=frame)``, but files are not read again, and a device that has
        rendered one frame rebuilds for the next only what changed. It is made from what was loaded: a copy with other
        tables (``dataclasses.replace``) does not pass them on. Raises SceneError.
        """
        if self.resident.scope is not None:
            return _resolved(self.resident, frame)
        given = {key: value for key, value in self.animation.items() if value is not None}
        scope = Scope(Document({"animation": given}, Source()), schemas.current(), Confinement(()))
        animation, clock = _moment(scope, frame)
        return replace(self, animation=animation, clock=clock)

    @cached_property
    def identity(self) -> str:
        """SHA-256, 64 hexadecimal digits, of everything that changes a sample."""
        return scene_identity(self, schemas.current())


def build(
    document: Document,
    *,
    roots: Iterable[str | Path] = (),
    path: Path | None = None,
    notes: Iterable[str] = (),
    frame: float | None = None,
) -> Scene:
    """Validate a document and resolve it into a Scene. Raises SceneError.

    ``notes`` are its ``model_notes`` so far, ``frame`` takes the place of ``animation.frame``.
    """
    schema = schemas.current()
    top = Where(document)
    data = expect_table(document.data, top)
    for key in data:
        if key not in SECTIONS and key not in FILE_KEYS:
            raise top.child(key).unknown(key, "section", (*FILE_KEYS, *SECTIONS))
    files = Confinement.around(document.top.folder, roots)
    document, more_notes = expand_models(document, schema, files)
    resident = Resident(Scope(document, schema, files), path, (*notes, *more_notes))
    scene = _resolved(resident, frame)
    if not has_keys(document.data):
        resident.scope = None
    return scene


def _resolved(resident: Resident, frame: float | None) -> Scene:
    """The scene of a validated document at a frame, by default its own. Raises SceneError."""
    scope = resident.scope
    assert scope is not None
    schema, top, data = scope.schema, Where(scope.document), scope.document.data
    animation, scope.clock = _moment(scope, frame)
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
    check_deforming(shapes, materials, top.child("shapes"))
    _check_spectra(scope)
    camera = _camera(scope)
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
        path=resident.path,
        mesh_reports=scope.mesh_reports,
        textures=textures,
        model_notes=resident.notes,
        clock=scope.clock,
        animation=animation,
        resident=resident,
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


def _camera(scope: Scope) -> dict[str, Any]:
    """The camera. One that a transform places starts at the origin and looks along -Z, unless it says otherwise."""
    data, where = scope.document.data, Where(scope.document, ("camera",))
    given = data.get("camera")
    if isinstance(given, dict) and "transform" in given:
        data = {"camera": {"position": [0.0, 0.0, 0.0], "look_at": [0.0, 0.0, -1.0], **given}}
    camera = _single("camera", data, where, scope)
    if camera["transform"] is not None:
        for matrix in matrices_of(camera["transform"]):
            check_rigid(matrix, "a camera", where.child("transform"))
            if mirrors(matrix):
                raise where.child("transform").error("mirrors the camera", allowed="a transform that turns and moves")
    return camera


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


def _moment(scope: Scope, frame: float | None) -> tuple[dict[str, Any], Clock]:
    """The resolved section ``[animation]``, with another frame if one is given, and its clock."""
    where = Where(scope.document, ("animation",))
    given = _section("animation", scope)
    if frame is not None:
        given = {**given, "frame": frame}
    values = resolve_params(scope.schema.family("animation").header, given, where, scope)
    return values, Clock.of(values, where)


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
