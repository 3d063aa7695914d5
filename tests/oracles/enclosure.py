"""A description of diffuse scenes made of planar pieces around convex blocks, for the radiosity oracle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from .form_factors import TOLERANCE, Array, Prism, clip


@dataclass(frozen=True, eq=False)
class Piece:
    """One planar piece of a surface: convex quadrilaterals (Q, 4, 3) that do not overlap, front counter-clockwise."""

    surface: str
    material: str
    quads: Array
    block: int | None = None

    @property
    def normal(self) -> Array:
        """Unit normal of the front side."""
        a, b, c, d = self.quads[0]
        direction = np.cross(c - a, d - b)
        return np.asarray(direction / np.linalg.norm(direction))

    @property
    def area(self) -> float:
        """Area of all quadrilaterals, in squared units of the scene."""
        return float(_areas(_triangles(self.quads)).sum())

    def sample(self, uniform: Array) -> Array:
        """Points (n, 3) distributed uniformly by area, from points (n, 3) of the unit cube."""
        triangles = _triangles(self.quads)
        share = np.cumsum(_areas(triangles))
        chosen = triangles[np.minimum(np.searchsorted(share, uniform[:, 0] * share[-1]), len(triangles) - 1)]
        root = np.sqrt(uniform[:, 1:2])
        side = root * uniform[:, 2:3]
        return np.asarray((1.0 - root) * chosen[:, 0] + (root - side) * chosen[:, 1] + side * chosen[:, 2])


@dataclass(frozen=True, eq=False)
class Enclosure:
    """Planar pieces around and on convex blocks; `blocks[k]` is the body whose faces carry the number k."""

    pieces: list[Piece]
    blocks: list[Prism]

    def groups(self) -> dict[str, list[int]]:
        """Piece numbers by name: every surface as a whole, and `name/k` for the k-th listed piece of a block."""
        found: dict[str, list[int]] = {}
        for number, piece in enumerate(self.pieces):
            siblings = found.setdefault(piece.surface, [])
            if piece.block is not None:
                found[f"{piece.surface}/{len(siblings)}"] = [number]
            siblings.append(number)
        return found

    def probes(self, name: str, log2_count: int, seed: int, lift: float = 0.1) -> tuple[Array, Array]:
        """Rays that look at uniformly distributed points of a surface: origins and directions (2**log2_count, 3).

        Scrambled Sobol points, one independent scramble per seed, are spread over the surface by area. Each ray starts
        `lift` (in the scene's unit) off the surface and looks straight down at it, so the radiance it measures is the
        outgoing radiance of a diffuse surface at that point; the mean over the rays is the surface's area average.
        """
        numbers = self.groups()[name]
        uniform = np.clip(qmc.Sobol(3, seed=seed).random_base2(log2_count), 0.0, np.nextafter(1.0, 0.0))
        share = np.concatenate([[0.0], np.cumsum([self.pieces[k].area for k in numbers])])
        share /= share[-1]
        owner = np.searchsorted(share, uniform[:, 0], side="right") - 1
        uniform[:, 0] = (uniform[:, 0] - share[owner]) / np.diff(share)[owner]
        points, normals = np.empty_like(uniform), np.empty_like(uniform)
        for slot, k in enumerate(numbers):
            points[owner == slot] = self.pieces[k].sample(uniform[owner == slot])
            normals[owner == slot] = self.pieces[k].normal
        return points + lift * normals, -normals


def _triangles(quads: Array) -> Array:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _areas(triangles: Array) -> Array:
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.asarray(0.5 * np.linalg.norm(cross, axis=1))


def without(polygon: Array, hole: Array) -> list[Array]:
    """What a convex polygon (n, 3) keeps outside a convex hole (m, 3) in its plane, as convex polygons.

    The sides of the hole cut off one polygon after the other; both may be wound either way.
    """
    kept: list[Array] = []
    centre = hole.mean(axis=0)
    normal = np.cross(polygon[1] - polygon[0], polygon[2] - polygon[0])
    for start, end in zip(hole, np.roll(hole, -1, axis=0), strict=True):
        outward = np.cross(end - start, normal)
        outward *= np.sign(outward @ (start - centre)) / np.linalg.norm(outward)
        beyond, within = (_half(polygon, start, side) for side in (outward, -outward))
        if len(beyond) > 2:
            kept.append(beyond)
        if len(within) < 3:
            return kept
        polygon = within
    return kept


def _half(polygon: Array, origin: Array, direction: Array) -> Array:
    """The part of a polygon with `direction . (x - origin) >= 0`, without repeated corners."""
    cut = clip((polygon - origin)[None], direction[None])[0]
    distinct = np.linalg.norm(cut - np.roll(cut, 1, axis=0), axis=1) > TOLERANCE
    return np.asarray(cut[distinct] + origin)


def quadrilaterals(polygon: Array) -> Array:
    """Split a convex polygon (n, 3) into convex quadrilaterals (Q, 4, 3), wound the same way.

    Anything but a quadrilateral is divided at its centroid and the middles of its sides.
    """
    if len(polygon) == 4:
        return polygon[None]
    following = 0.5 * (polygon + np.roll(polygon, -1, axis=0))
    preceding = np.roll(following, 1, axis=0)
    centre = np.broadcast_to(polygon.mean(axis=0), polygon.shape)
    return np.stack([polygon, following, centre, preceding], axis=1)
