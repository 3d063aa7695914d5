"""Shapes that are cut finely: subdivision surfaces, edges halved until they are short in the picture, displacement."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray.devices.lights import matrix

Values = dict[str, Any]

LEVELS = 3
"""Of a subdivision surface that does not say how fine it is."""

MOST_LEVELS = 12
MOST_HALVINGS = 24
"""Of an edge: one that leads through the camera would be too long for ever."""

JUMP = 8.0
"""An edge so much shorter than its bound before displacement is not halved: it crosses a jump of the texture."""

BYTES_PER_TRIANGLE = 400
"""Of memory while a surface is cut, all in all; the largest figure of those that were measured."""


class Triangles(NamedTuple):
    """The triangles that a shape is rendered as, before its transform: front sides run counter-clockwise.

    positions: float32 (N, 3), metres. faces: uint32 (M, 3), indices of positions. normals: float32 (N, 3), unit, or
    None for flat shading. uvs: float32 (N, 2), or None. colors: float32 (N, 4), linear Rec.709 and alpha, or None.
    """

    positions: NDArray[np.float32]
    faces: NDArray[np.uint32]
    normals: NDArray[np.float32] | None
    uvs: NDArray[np.float32] | None
    colors: NDArray[np.float32] | None = None


def is_refined(table: Values) -> bool:
    """Does the shape ask for more than the triangles that it has?"""
    asked = (table.get(key) is not None for key in ("subdivision_levels", "edge_length_px", "displacement"))
    return any(asked) or table.get("subdivision", "none") != "none"


def least_cosine(crease_angle: float) -> float:
    """Cosine of the largest angle, in radians, that is no crease; below all cosines for half a turn."""
    from accuray.scene.transforms import sine_cosine

    degrees = math.degrees(crease_angle)
    return -2.0 if degrees >= 180.0 else sine_cosine(degrees)[1]


class Refiner:
    """Makes the triangles of refined shapes.

    Args:
        texture_values: red, green and blue (N, 3) of a texture, by its name, at uvs (N, 2) or None and points (N, 3).
        view: ``accuray._core.mesh.View`` of the scene's camera; called only where a length in pixels counts.
    """

    def __init__(self, texture_values: Callable[[str, Any, Any], NDArray[np.float32]], view: Callable[[], Any]) -> None:
        self._texture_values = texture_values
        self._view = view

    def triangles(self, table: Values, plain: Callable[[], Triangles]) -> tuple[Triangles, Values]:
        """The shape of ``table``, which is ``plain()`` unless it is refined, and a report of what was made.

        The report counts ``tessellated_triangles``, and what had to be left out as mesh readers do. Raises ValueError
        with the name of the parameter for more than ``max_triangles`` (before they are made), for creases that fit no
        edge, and for displacement that is not finite.
        """
        report: Values = {}
        smooth = table.get("subdivision", "none") != "none"
        surface = self._subdivided(table, report) if smooth else self._halved(plain(), table)
        result = self._displaced(surface, table)
        if table["edge_length_px"] is not None and (not smooth or table["displacement"] is not None):
            result = self._fitted(surface, result, table)
        if table["displacement"] is not None:
            result = _reshaded(result, table, report)
        elif table.get("shading") == "flat":
            result = result._replace(normals=None)
        report["tessellated_triangles"] = len(result.faces)
        return result, report

    def _subdivided(self, table: Values, report: Values) -> Triangles:
        """The surface that the faces control, at the levels that are given or that make its edges short enough."""
        bound, given = table["edge_length_px"], table["subdivision_levels"]
        level = 1 if bound is not None else LEVELS if given is None else given
        while True:
            mesh = self._at_level(table, level)
            surface = Triangles(mesh.positions, mesh.indices, mesh.normals, mesh.uvs, mesh.colors)
            if bound is None or level == MOST_LEVELS or not (self._lengths(surface, table) > bound).any():
                break
            level += 1
        losses = ("nonfinite_triangles", "degenerate_triangles")
        report.update({key: mesh.report[key] for key in losses if mesh.report[key]})
        return surface

    def _at_level(self, table: Values, level: int) -> Any:
        from accuray._core import mesh as core

        scheme, polygons = table["subdivision"], table.get("polygons")
        count = core.subdivided_triangles(len(table["faces"]), polygons, scheme, level)
        _admit(count, table, f"{level} levels of subdivision make")
        angle = table["crease_angle"]
        return core.subdivide(
            *(table["positions"], table["faces"], polygons, table["uvs"], table["colors"]),
            scheme=scheme,
            levels=level,
            smooth_uvs=table["uv_subdivision"] == "smooth",
            creases=table["creases"],
            corners=table["corners"],
            least_cosine=-2.0 if angle is None else least_cosine(angle),
        )

    def _halved(self, surface: Triangles, table: Values) -> Triangles:
        """Every edge halved as often as ``subdivision_levels`` says; the shape stays as it is."""
        levels = table["subdivision_levels"] or 0
        _admit(len(surface.faces) << 2 * levels, table, f"{levels} levels make")
        for _ in range(levels):
            surface = _split(surface, np.ones(surface.faces.shape, dtype=np.uint8))
        return surface

    def _fitted(self, surface: Triangles, moved: Triangles, table: Values) -> Triangles:
        """The moved surface with its edges halved until they are short enough in the picture."""
        from accuray._core import mesh as core

        bound = table["edge_length_px"]
        for _ in range(MOST_HALVINGS):
            marks = self._lengths(moved, table) > bound
            if moved is not surface:
                marks &= self._lengths(surface, table, facing=True) > bound / JUMP
            if not marks.any():
                break
            marks = core.spread_marks(surface.positions, surface.faces, marks.astype(np.uint8))
            count = len(surface.faces) + int(np.count_nonzero(marks))
            _admit(count, table, f"edges of at most {bound:g} px make at least")
            surface = _split(surface, marks)
            moved = self._displaced(surface, table)
        return moved

    def _lengths(self, surface: Triangles, table: Values, *, facing: bool = False) -> NDArray[np.float32]:
        """Pixels (M, 3) of the edges from each corner of a triangle to the next; or as if they faced the camera."""
        from accuray._core import mesh as core

        lengths: NDArray[np.float32] = core.lengths_in_view(
            surface.positions, surface.faces, self._view(), matrix(table["transform"]), facing
        )
        return lengths

    def _displaced(self, surface: Triangles, table: Values) -> Triangles:
        """The surface with its points moved by the texture; itself where there is none."""
        use = table["displacement"]
        if use is None:
            return surface
        from accuray._core import mesh as core

        values = self._texture_values(use.texture, surface.uvs, surface.positions).astype(np.float64) * use.scale
        with np.errstate(over="ignore", invalid="ignore"):
            offsets = ((values - table["displacement_offset"]) * table["displacement_scale"]).astype(np.float32)
        bad = np.count_nonzero(~np.isfinite(offsets).all(axis=1))
        if bad:
            problem = f"is not finite at {bad} of {len(offsets)} vertices: allowed are finite values within 1e18 m"
            raise ValueError(problem, "displacement")
        space = table["displacement_space"]
        positions = core.displaced(surface.positions, surface.faces, surface.normals, surface.uvs, offsets, space)
        return surface._replace(positions=positions)


def _split(surface: Triangles, marks: NDArray[np.uint8]) -> Triangles:
    from accuray._core import mesh as core

    mesh = core.split_edges(*surface, marks)
    return Triangles(mesh.positions, mesh.indices, mesh.normals, mesh.uvs, mesh.colors)


def _reshaded(surface: Triangles, table: Values, report: Values) -> Triangles:
    """A displaced surface with its own normals, without triangles that have lost their area."""
    from accuray._core import mesh as core

    mesh = core.repair(surface.positions, surface.faces, None, surface.uvs, surface.colors)
    if mesh.report["nonfinite_triangles"]:
        raise ValueError("moves points beyond 1e18 m: allowed is less", "displacement")
    if mesh.report["degenerate_triangles"]:
        report["degenerate_triangles"] = mesh.report["degenerate_triangles"]
    positions, faces, uvs, colors = mesh.positions, mesh.indices, mesh.uvs, mesh.colors
    if table.get("shading") == "flat":
        return Triangles(positions, faces, None, uvs, colors)
    if table.get("crease_angle") is None:
        return Triangles(positions, faces, core.smooth_normals(positions, faces), uvs, colors)
    source, faces, normals = core.creased_normals(positions, faces, least_cosine(table["crease_angle"]))
    return Triangles(positions[source], faces, normals, *(None if a is None else a[source] for a in (uvs, colors)))


def _admit(count: int, table: Values, what: str) -> None:
    """Refuses more triangles than the shape may have, before they are made."""
    most = table["max_triangles"]
    if count <= most:
        return
    size = count * BYTES_PER_TRIANGLE / 1e6
    key = "subdivision_levels" if table["edge_length_px"] is None else "edge_length_px"
    change = "fewer levels" if key == "subdivision_levels" else "a larger length"
    raise ValueError(
        f"is too fine: {what} {count} triangles, about {size:.0f} MB, and max_triangles is {most}: "
        f"allowed are {change}, or a larger max_triangles",
        key,
    )
