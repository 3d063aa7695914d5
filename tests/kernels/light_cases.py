"""Every kind of light with its exact geometry, from plain, moved, mirrored and instanced shapes; places to see it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from tests.kernels.support import FloatArray, unit

Description = dict[str, Any]


def rounded(values: FloatArray) -> FloatArray:
    """The nearest single-precision numbers: what the engine is given."""
    return np.asarray(values, dtype=np.float32).astype(np.float64)


def tangents(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors perpendicular to the normal and to each other."""
    x = unit(*np.cross(normal, unit(*np.roll(normal, 1) + np.array([0.3, 0.1, 0.2]))))
    return x, np.asarray(np.cross(normal, x))


@dataclass(frozen=True)
class Polygon:
    """A triangle or a parallelogram; its front side is where the vertices run counter-clockwise."""

    vertices: FloatArray

    @property
    def center(self) -> FloatArray:
        return np.asarray(self.vertices.mean(axis=0))

    @property
    def edges(self) -> tuple[FloatArray, FloatArray]:
        return self.vertices[1] - self.vertices[0], self.vertices[-1] - self.vertices[0]

    @property
    def normal(self) -> FloatArray:
        return unit(*np.cross(*self.edges))

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.vertices - self.center, axis=1).max())

    @property
    def area(self) -> float:
        return float(np.linalg.norm(np.cross(*self.edges))) * (0.5 if len(self.vertices) == 3 else 1.0)

    def solid_angle(self, reference: FloatArray) -> float:
        """A fan of triangles, each by Van Oosterom and Strackee 1983, its numerator from the unscaled volume."""
        v = self.vertices - reference
        total = 0.0
        for b, c in pairwise(v[1:]):
            a = v[0]
            la, lb, lc = (float(np.linalg.norm(x)) for x in (a, b, c))
            volume = float(np.dot(a, np.cross(b - a, c - a)))
            total += 2.0 * math.atan2(abs(volume), la * lb * lc + (a @ b) * lc + (b @ c) * la + (c @ a) * lb)
        return total

    def off(self, points: FloatArray, reference: FloatArray) -> FloatArray:
        """Distance of each point from the polygon: from its plane, or as seen from the reference beyond an edge."""
        beyond = [np.abs((points - self.center) @ self.normal)]
        d = points - reference
        cosine = np.abs(d @ self.normal) / np.linalg.norm(d, axis=1)
        for p, q in zip(self.vertices, np.roll(self.vertices, -1, axis=0), strict=True):
            beyond.append((points - p) @ unit(*np.cross(q - p, self.normal)) * cosine)
        return np.asarray(np.max(beyond, axis=0))

    def normals(self, points: FloatArray) -> FloatArray:
        return np.broadcast_to(self.normal, points.shape)

    def to_square(self, points: FloatArray, reference: FloatArray) -> FloatArray:
        """An area-preserving map from the polygon to the unit square, the same from any reference."""
        st = (points - self.vertices[0]) @ np.linalg.pinv(np.stack(self.edges, axis=1)).T
        if len(self.vertices) == 4:
            return np.asarray(st)
        total = st.sum(axis=1)
        return np.stack([total * total, st[:, 1] / np.maximum(total, 1e-30)], axis=1)

    def from_square(self, square: FloatArray, reference: FloatArray) -> FloatArray:
        s, t = square.T
        if len(self.vertices) == 3:
            s, t = np.sqrt(s) * (1.0 - t), np.sqrt(s) * t
        u, v = self.edges
        return np.asarray(self.vertices[0] + s[:, None] * u + t[:, None] * v)

    def seen_area(self, reference: FloatArray) -> float:
        return self.area


@dataclass(frozen=True)
class Round:
    """A disk, or with `normal` None a sphere."""

    center: FloatArray
    size: float
    normal: FloatArray | None

    def _distance(self, reference: FloatArray) -> float:
        return float(np.linalg.norm(reference - self.center))

    def _least_cosine(self, reference: FloatArray) -> float:
        """Of the angle from the axis to a visible point, at the centre: the horizon from outside, -1 from inside."""
        distance = self._distance(reference)
        return self.size / distance if distance > self.size else -1.0

    def solid_angle(self, reference: FloatArray) -> float:
        distance = self._distance(reference)
        if self.normal is None:
            inside = distance <= self.size
            return 4.0 * math.pi if inside else 2.0 * math.pi * (1.0 - math.sqrt(1.0 - (self.size / distance) ** 2))
        x, y = tangents(self.normal)
        angle = 2.0 * np.pi * np.arange(40_001)[:, None] / 40_000
        rim = self.center + self.size * (np.cos(angle) * x + np.sin(angle) * y)
        slices = np.stack([np.broadcast_to(self.center, rim[1:].shape), rim[:-1], rim[1:]], axis=1) - reference
        a, b, c = slices.transpose(1, 0, 2)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        volume = np.abs((a * np.cross(b - a, c - a)).sum(axis=1))
        cosines = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        return float((2.0 * np.arctan2(volume, cosines)).sum())

    def off(self, points: FloatArray, reference: FloatArray) -> FloatArray:
        radial = np.linalg.norm(points - self.center, axis=1)
        if self.normal is None:
            return np.asarray(np.abs(radial - self.size))
        return np.asarray(np.maximum(np.abs((points - self.center) @ self.normal), radial - self.size))

    def normals(self, points: FloatArray) -> FloatArray:
        if self.normal is not None:
            return np.broadcast_to(self.normal, points.shape)
        away = points - self.center
        return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True))

    def _axis(self, reference: FloatArray) -> FloatArray:
        return unit(*(reference - self.center)) if self.normal is None else self.normal

    def to_square(self, points: FloatArray, reference: FloatArray) -> FloatArray:
        """An area-preserving map from the part that can be seen to the unit square."""
        axis = self._axis(reference)
        x, y = tangents(axis)
        d = (points - self.center) / self.size
        low = self._least_cosine(reference)
        along = (d @ axis - low) / (1.0 - low) if self.normal is None else (d * d).sum(axis=1)
        return np.stack([along, (np.arctan2(d @ y, d @ x) / (2.0 * np.pi)) % 1.0], axis=1)

    def from_square(self, square: FloatArray, reference: FloatArray) -> FloatArray:
        axis = self._axis(reference)
        x, y = tangents(axis)
        along, phi = square[:, :1], 2.0 * np.pi * square[:, 1:]
        if self.normal is None:
            low = self._least_cosine(reference)
            height = low + (1.0 - low) * along
            radius = np.sqrt(np.maximum(0.0, 1.0 - height * height))
        else:
            height, radius = np.zeros_like(along), np.sqrt(along)
        return np.asarray(self.center + self.size * (radius * (np.cos(phi) * x + np.sin(phi) * y) + height * axis))

    def seen_area(self, reference: FloatArray) -> float:
        share = 1.0 if self.normal is not None else 2.0 * (1.0 - self._least_cosine(reference))
        return math.pi * self.size**2 * share


Geometry = Polygon | Round


@dataclass(frozen=True)
class Case:
    """A scene with one light of `kind` (as the engine names it), and where that light is."""

    name: str
    kind: str
    scene: Description
    geometry: Geometry


def motion(scale: float) -> FloatArray:
    """A rotation about a skew axis, a scale (negative: mirrored) and a translation in proportion to it."""
    x, y, z = unit(1.0, -2.0, 0.7)
    c, s = math.cos(0.9), math.sin(0.9)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = c * np.eye(3) + s * cross + (1 - c) * np.outer([x, y, z], [x, y, z])
    matrix = np.eye(4)
    matrix[:3, :3] = scale * rotation
    matrix[:3, 3] = abs(scale) * np.array([3.0, -1.5, 0.5])
    return matrix


def moved(matrix: FloatArray, geometry: Geometry) -> Geometry:
    """The geometry under a transform whose front sides stay front sides, as the scene language says."""
    linear, offset = matrix[:3, :3], matrix[:3, 3]
    if isinstance(geometry, Polygon):
        vertices = rounded(geometry.vertices @ linear.T + offset)
        return Polygon(vertices[::-1] if np.linalg.det(linear) < 0 else vertices)
    scale = abs(np.linalg.det(linear)) ** (1.0 / 3.0)
    normal = None if geometry.normal is None else unit(*(linear @ geometry.normal))
    return Round(rounded(geometry.center @ linear.T + offset), geometry.size * scale, normal)


def _mesh(vertices: FloatArray) -> Description:
    return {"type": "mesh", "positions": vertices.astype(np.float32), "faces": [list(range(len(vertices)))]}


def _shapes() -> list[tuple[str, str, Description, Geometry]]:
    octant = np.eye(3)
    thin = rounded(np.array([[0, 0, 0], [2, 0, 0], [2, 0.05, 0]]))
    corner, u, v = rounded(np.array([[-0.5, 1, 0.25], [1.0, 0, 0], [0, 0, 0.4]]))
    slanted = v + np.array([0.5, 0.0, 0.0])
    square = np.array([corner, corner + u, corner + u + v, corner + v])
    skew = np.array([corner, corner + u, corner + u + slanted, corner + slanted])
    rectangle = {"type": "rectangle", "corner": list(corner), "edge_u": list(u), "edge_v": list(v)}
    center, normal = rounded(np.array([0.3, -0.2, 0.5])), unit(1.0, 2.0, -1.0)
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


#: Places by name: height above the middle along the normal, and way along the plane, in sizes of the light.
PLACES: dict[str, tuple[float, float]] = {
    "above": (1.5, 0.4),
    "far": (30.0, 11.0),
    "near": (0.05, 0.1),
    "grazing": (0.06, 3.0),
    "behind": (-0.8, 0.3),
}
#: For spheres, along any direction.
SPHERE_PLACES: dict[str, tuple[float, float]] = {
    "above": (1.5, 0.4),
    "far": (30.0, 11.0),
    "near": (1.001, 0.0),
    "touching": (1.00001, 0.0),
    "inside": (0.3, 0.5),
    "inside-near": (0.85, 0.0),
}


def places(geometry: Geometry) -> dict[str, tuple[float, float]]:
    sphere = isinstance(geometry, Round) and geometry.normal is None
    return SPHERE_PLACES if sphere else PLACES


def place(geometry: Geometry, name: str) -> FloatArray:
    """A reference point, rounded to single precision."""
    n = unit(0.2, 0.9, -0.4) if geometry.normal is None else geometry.normal
    x = unit(*geometry.edges[0]) if isinstance(geometry, Polygon) else tangents(n)[0]
    height, way = places(geometry)[name]
    return rounded(geometry.center + geometry.size * (height * n + way * x))
