"""Meshes that change their form while the shutter is open: the positions and normals of their vertices have keys.

Vertices move on straight lines from key to key. Renderers want forms at equally spaced times instead, so the keys are
sampled anew over the shutter's interval: as often as it takes for no vertex to lie further off its way than a share of
the mesh's size, and not less often than there are keys, because normals that are made bend in between.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from accuray.scene.errors import Where
from accuray.scene.keys import read_keys, span_at
from accuray.scene.scope import Scope

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Forms = npt.NDArray[np.float32]

MOVING = ("positions", "normals")
"""Arrays of a mesh that may differ from key to key."""

MOST_SEGMENTS = 128
"""Embree takes 129 time steps."""

TOLERANCE = 1e-4
"""How far a vertex may lie off its way, over the size of the mesh, for the least number of steps to do."""

MOST_ERROR = 1e-2
"""The same for keys that no number of steps follows so closely: the best does, up to this."""

Loader = Callable[[Path, Where], dict[str, Any]]
"""Reads a mesh file into arrays by the names of the parameters."""


def over_shutter(times: list[float], forms: Forms, scope: Scope, where: Where) -> Forms:
    """Forms (K, N, 3) at rising times, in seconds, as (N, 3) where they stay what they are while the shutter is open.

    Else as (S, N, 3) at S equally spaced times, from where it opens to where it closes. Raises SceneError if 129 of
    them cannot follow.
    """
    import numpy as np

    clock = scope.clock
    inner = [time for time in times if clock.open < time < clock.close]
    stops = [clock.open, *inner, clock.close]
    true = np.stack([_form_at(times, forms, time) for time in stops])
    if bool((true == true[0]).all()):
        return _frozen(true[0])
    size = max(float(np.ptp(true, axis=(0, 1)).max()), 1e-30)
    best, least = true[[0, -1]], np.inf
    for segments in range(min(len(inner) + 1, MOST_SEGMENTS), MOST_SEGMENTS + 1):
        evenly = [clock.open + (clock.close - clock.open) * step / segments for step in range(segments + 1)]
        sampled = np.stack([_form_at(times, forms, time) for time in evenly])
        off = [np.abs(_form_at(evenly, sampled, time) - at).max() for time, at in zip(inner, true[1:-1], strict=True)]
        error = float(max(off, default=0.0)) / size
        if error < least:
            best, least = sampled, error
        if error <= TOLERANCE:
            break
    if least > MOST_ERROR:
        raise where.error(
            f"deforms in {len(inner)} keys while the shutter is open that {MOST_SEGMENTS} equal steps cannot follow",
            allowed="keys at equally spaced times, or a shorter shutter",
        )
    return _frozen(best)


def resolve_moving(value: Any, where: Where, scope: Scope, one: Callable[[Any, Where], Any]) -> Forms:
    """A keyed array of a mesh over the shutter; ``one`` resolves the array of one key. Raises SceneError."""
    import numpy as np

    times, values, places = _straight(value, where)
    forms = [one(item, place) for item, place in zip(values, places, strict=True)]
    for form, place in zip(forms, places, strict=True):
        if form.shape != forms[0].shape:
            raise place.error(f"has {len(form)} rows", allowed=f"{len(forms[0])}, as many as the first key")
        if not np.isfinite(form).all():
            raise place.error("has numbers that are not finite", allowed="finite numbers where a mesh deforms")
    return over_shutter(times, np.stack(forms), scope, where)


class KeyedFiles(NamedTuple):
    """The files of a mesh that deforms, by rising times in seconds."""

    times: list[float]
    paths: list[Path]
    places: list[Where]


def keyed_files(value: Any, where: Where, resolve: Callable[[Any, Where], Path]) -> KeyedFiles:
    """The keys of a file; ``resolve`` finds the file that one names. Raises SceneError."""
    times, values, places = _straight(value, where)
    return KeyedFiles(times, [resolve(item, place) for item, place in zip(values, places, strict=True)], places)


def arrays_over_shutter(files: KeyedFiles, read: Loader, scope: Scope) -> dict[str, Any]:
    """The arrays of a mesh whose keys are files of equal faces; positions and normals over the shutter."""
    import numpy as np

    keys = [read(path, place) for path, place in zip(files.paths, files.places, strict=True)]
    for arrays, place in zip(keys[1:], files.places[1:], strict=True):
        _check_alike(keys[0], arrays, place)
    arrays = dict(keys[0])
    for name in MOVING:
        if arrays[name] is not None:
            forms = np.stack([key[name] for key in keys])
            arrays[name] = over_shutter(files.times, forms, scope, files.places[0])
    return arrays


def deforms(shape: dict[str, Any]) -> bool:
    """Does a resolved shape change its form while the shutter is open?"""
    positions = shape.get("positions")
    return positions is not None and positions.ndim == 3


def check_deforming(shapes: dict[str, dict[str, Any]], materials: dict[str, dict[str, Any]], where: Where) -> None:
    """Raises SceneError for what a mesh that deforms cannot have: found creases, a finer form, emission."""
    for name, shape in shapes.items():
        if not deforms(shape):
            continue
        if shape["crease_angle"] is not None and shape["normals"] is None:
            raise where.child(name, "crease_angle").error(
                "would move the creases of a mesh that deforms", allowed='normals in every key, or shading = "smooth"'
            )
        for key in ("subdivision_levels", "edge_length_px", "displacement"):
            if shape[key] is not None or shape["subdivision"] != "none":
                raise where.child(name, key).error("would cut a mesh finely that deforms", allowed="meshes that do not")
        if shape["material"] is not None and materials[shape["material"]]["emission"] is not None:
            raise where.child(name, "material").error(
                "emits, on a mesh that deforms", value=shape["material"], allowed="a material without emission"
            )


def _straight(value: Any, where: Where) -> tuple[list[float], list[Any], list[Where]]:
    """Times, values and places of keys between which everything moves in straight lines."""
    if value.get("interpolation", "linear") != "linear":
        raise where.child("interpolation").error(
            "is not what vertices follow", value=value["interpolation"], allowed="linear"
        )
    times, values = read_keys(value, where)
    return times, values, [where.child("keys", number, "value") for number in range(len(values))]


def _form_at(times: list[float], forms: Forms, time: float) -> Forms:
    """The form at a time, constant before the first and after the last of ``times``."""
    import numpy as np

    span = span_at(times, "linear", time)
    form: Forms = forms[span.before]
    if span.along > 0.0:
        first, last = form.astype(np.float64), forms[span.after].astype(np.float64)
        form = (first + (last - first) * span.along).astype(np.float32)
    return form


def _check_alike(first: dict[str, Any], arrays: dict[str, Any], where: Where) -> None:
    """Raises SceneError unless two files have the same faces and texture coordinates of as many vertices."""
    import numpy as np

    for key in ("positions", "normals"):
        a, b = first.get(key), arrays.get(key)
        if (a is None) != (b is None) or (a is not None and b is not None and a.shape != b.shape):
            raise where.error(f"has other {key} than the first key's file", allowed="files of the same mesh")
    if not np.array_equal(first["faces"], arrays["faces"]):
        raise where.error("has other faces than the first key's file", allowed="files of the same mesh")


def _frozen(forms: Forms) -> Forms:
    """Contiguous, and no longer writable: a scene's identity must not change under it."""
    import numpy as np

    frozen: Forms = np.ascontiguousarray(forms)
    frozen.flags.writeable = False
    return frozen
