"""Every kind of light with its exact geometry, from plain, moved, mirrored and instanced shapes, and places to see it from."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.kernels.support import FloatArray, unit

Description = dict[str, Any]


@dataclass(frozen=True)
class Polygon:
    """A flat convex polygon; its front side is where the vertices run counter-clockwise."""

    vertices: FloatArray

    @property
    def center(self) -> FloatArray:
        return np.asarray(self.vertices.mean(axis=0))

    @property
    def normal(self) -> FloatArray:
        a, b, c = self.vertices[:3]
        return unit(*np.cross(b - a, c - a))

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.vertices - self.center, axis=1).max())

    def solid_angle(self, reference: FloatArray) -> float:
        """A fan of triangles, each by Van Oosterom and Strackee 1983; the fan's centre keeps its slices even."""
        v = self.vertices - reference
        v = v / np.linalg.norm(v, axis=1, keepdims=True)
        a, b, c = np.broadcast_to(unit(*(self.center - reference)), v.shape), v, np.roll(v, -1, axis=0)
        triple = np.einsum("ij,ij->i", a, np.cross(b, c))
        denominator = 1.0 + (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1)
        return float(abs((2.0 * np.arctan2(triple, denominator)).sum()))

    def distances(self, points: FloatArray) -> FloatArray:
        """Of each point from the polygon: from its plane, or beyond one of its edges."""
        beyond = [np.abs((points - self.center) @ self.normal)]
        for p, q in zip(self.vertices, np.roll(self.vertices, -1, axis=0), strict=True):
            beyond.append((points - p) @ unit(*np.cross(q - p, self.normal)))
        return np.asarray(np.max(beyond, axis=0))

    def normals(self, points: FloatArray) -> FloatArray:
        return np.broadcast_to(self.normal, points.shape)


@dataclass(frozen=True)
class Round:
    """A disk, or with `normal` None a sphere."""

    center: FloatArray
    size: float
    normal: FloatArray | None

    def solid_angle(self, reference: FloatArray) -> float:
        distance = float(np.linalg.norm(reference - self.center))
        if self.normal is None:
            inside = distance <= self.size
            return 4.0 * math.pi if inside else 2.0 * math.pi * (1.0 - math.sqrt(1.0 - (self.size / distance) ** 2))
        return self._rim(40_000).solid_angle(reference)

    def _rim(self, corners: int) -> Polygon:
        assert self.normal is not None
        x = unit(*np.cross(self.normal, unit(*np.roll(self.normal, 1) + [0.3, 0.1, 0.2])))
        angle = 2.0 * np.pi * np.arange(corners)[:, None] / corners
        return Polygon(self.center + self.size * (np.cos(angle) * x + np.sin(angle) * np.cross(self.normal, x)))

    def distances(self, points: FloatArray) -> FloatArray:
        radial = np.linalg.norm(points - self.center, axis=1)
        if self.normal is None:
            return np.asarray(np.abs(radial - self.size))
        return np.asarray(np.maximum(np.abs((points - self.center) @ self.normal), radial - self.size))

    def normals(self, points: FloatArray) -> FloatArray:
        if self.normal is not None:
            return np.broadcast_to(self.normal, points.shape)
        away = points - self.center
        return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True))


Geometry = Polygon | Round


@dataclass(frozen=True)
class Case:
    """A scene with one light of `kind` (as the engine names it), and where that light is."""

    name: str
    kind: str
    scene: Description
    geometry: Geometry


def motion(scale: float) -> FloatArray:
    """A rotation about a skew axis, a scale (negative: mirrored) and a translation."""
    x, y, z = unit(1.0, -2.0, 0.7)
    c, s = math.cos(0.9), math.sin(0.9)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = c * np.eye(3) + s * cross + (1 - c) * np.outer([x, y, z], [x, y, z])
    matrix = np.eye(4)
    matrix[:3, :3] = scale * rotation
    matrix[:3, 3] = [3.0, -1.5, 0.5]
    return matrix


def moved(matrix: FloatArray, geometry: Geometry) -> Geometry:
    """The geometry under a transform whose front sides stay front sides, as the scene language says."""
    linear, offset = matrix[:3, :3], matrix[:3, 3]
    if isinstance(geometry, Polygon):
        vertices = geometry.vertices @ linear.T + offset
        return Polygon(vertices[::-1] if np.linalg.det(linear) < 0 else vertices)
    scale = abs(np.linalg.det(linear)) ** (1.0 / 3.0)
    normal = None if geometry.normal is None else unit(*(linear @ geometry.normal))
    return Round(geometry.center @ linear.T + offset, geometry.size * scale, normal)


def _mesh(vertices: FloatArray) -> Description:
    faces = [list(range(len(vertices)))]
    return {"type": "mesh", "positions": vertices.astype(np.float32), "faces": faces}


def _shapes() -> list[tuple[str, str, Description, Geometry]]:
    octant = np.eye(3)
    thin = np.array([[0, 0, 0], [2, 0, 0], [2, 0.05, 0]], dtype=np.float64)
    corner, u, v = np.array([-0.5, 1, 0.25]), np.array([1.0, 0, 0]), np.array([0, 0, 0.4])
    slanted = np.array([0.5, 0.0, 0.4])
    square = np.array([corner, corner + u, corner + u + v, corner + v])
    skew = np.array([corner, corner + u, corner + u + slanted, corner + slanted])
    rectangle = {"type": "rectangle", "corner": list(corner), "edge_u": list(u), "edge_v": list(v)}
    center, normal = np.array([0.3, -0.2, 0.5]), unit(1.0, 2.0, -1.0)
    ball = {"type": "sphere", "center": list(center), "radius": 0.75}
    disk = {"type": "disk", "center": list(center), "normal": [1, 2, -1], "radius": 0.75}
    return [
        ("triangle", "triangle", _mesh(octant), Polygon(octant)),
        ("thin-triangle", "triangle", _mesh(thin), Polygon(thin)),
        ("rectangle", "quad", rectangle, Polygon(square)),
        ("mesh-rectangle", "quad", _mesh(square), Polygon(square)),
        ("parallelogram", "triangle", _mesh(skew), Polygon(skew)),
        ("sphere", "sphere", ball, Round(center, 0.75, None)),
        ("disk", "disk", disk, Round(center, 0.75, normal)),
    ]


def cases() -> list[Case]:
    """All lights: each shape as it is, and under each transform as a shape and as an instance."""
    result: list[Case] = []
    materials = {"lamp": {"type": "diffuse", "reflectance": 0.0, "emission": 1.0}}
    for name, kind, shape, geometry in _shapes():
        plain = {**shape, "material": "lamp"}
        result.append(Case(name, kind, {"materials": materials, "shapes": {"lamp": plain}}, geometry))
        for word, scale in (("moved", 2.5), ("tiny", 1e-3), ("mirrored", -0.4)):
            matrix = motion(scale)
            transform = {"matrix": [float(x) for x in matrix.ravel()]}
            there = moved(matrix, geometry)
            shapes = {"lamp": {**plain, "transform": transform}}
            result.append(Case(f"{name}-{word}", kind, {"materials": materials, "shapes": shapes}, there))
            shapes = {
                "lamp": {**plain, "prototype": True},
                "copy": {"type": "instance", "of": "lamp", "transform": transform},
            }
            result.append(Case(f"{name}-{word}-instance", kind, {"materials": materials, "shapes": shapes}, there))
    return result


def _frame(geometry: Geometry) -> tuple[FloatArray, FloatArray]:
    """The normal (some direction for a sphere) and a direction of the plane."""
    if isinstance(geometry, Polygon):
        return geometry.normal, unit(*(geometry.vertices[1] - geometry.vertices[0]))
    n = unit(0.2, 0.9, -0.4) if geometry.normal is None else geometry.normal
    return n, unit(*np.cross(n, unit(*np.roll(n, 1) + [0.3, 0.1, 0.2])))


#: Places by name: height above the middle along the normal, and way along the plane, in sizes of the light.
PLACES: dict[str, tuple[float, float]] = {
    "above": (1.5, 0.4),
    "far": (30.0, 11.0),
    "near": (0.05, 0.1),
    "grazing": (0.06, 3.0),
    "behind": (-0.8, 0.3),
}
SPHERE_PLACES: dict[str, tuple[float, float]] = {
    "above": (1.5, 0.4),
    "far": (30.0, 11.0),
    "near": (1.001, 0.0),
    "touching": (1.00001, 0.0),
    "inside": (0.3, 0.5),
    "inside-near": (0.9995, 0.0),
}


def places(geometry: Geometry) -> dict[str, tuple[float, float]]:
    sphere = isinstance(geometry, Round) and geometry.normal is None
    return SPHERE_PLACES if sphere else PLACES


def place(geometry: Geometry, name: str) -> FloatArray:
    """A reference point, rounded to single precision."""
    n, x = _frame(geometry)
    height, way = places(geometry)[name]
    return np.asarray((geometry.center + geometry.size * (height * n + way * x)).astype(np.float32).astype(np.float64))


Visit = Callable[[Case, str], None]
