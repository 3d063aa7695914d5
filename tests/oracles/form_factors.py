"""Exact point-to-polygon form factors in a scene whose only occluders are convex prisms.

The form factor F of a polygon seen from a point is the share of the point's cosine-weighted hemisphere that the
polygon covers, so an irradiance is E = pi L F. An unoccluded polygon has Lambert's closed form: a sum over its edges of
the angle an edge subtends times the cosine between the edge's plane normal and the receiver's (Lambert 1760;
Baum, Rushmeier and Winget 1989). The shadow of a convex body is a convex cone of directions, so an occluded polygon is
clipped against that cone and the same formula applies to what is left: visibility is exact, without shadow rays,
and the factors of a closed surrounding add up to 1 to rounding.

Lengths are in one unit throughout (the Cornell data's millimetres); polygons are convex, planar and wound
counter-clockwise when seen from their front, the side that emits.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

TOLERANCE = 1e-7
"""Distance below which a point counts as lying in a plane, in the scene's unit (0.1 nm for millimetres)."""


def polygon_factor(polygons: Array, normals: Array) -> Array:
    """Form factors of polygons (M, n, 3), given relative to their receivers, for receiver normals (M, 3).

    Polygons must lie above their receiver's horizon. Repeated vertices and empty polygons (all zeros) add nothing.
    """
    following = np.roll(polygons, -1, axis=1)
    cross = np.cross(polygons, following)
    sine = np.sqrt(np.einsum("mni,mni->mn", cross, cross))
    cosine = np.einsum("mni,mni->mn", polygons, following)
    angle = np.arctan2(sine, cosine)
    height = np.einsum("mni,mi->mn", cross, normals)
    terms = np.divide(angle * height, sine, out=np.zeros_like(sine), where=sine > 0.0)
    return -np.asarray(terms.sum(axis=1)) / (2.0 * np.pi)


def clip(polygons: Array, planes: Array) -> Array:
    """Cut each convex polygon (M, n, 3) to the side `plane . x >= 0` of its own plane (M, 3): (M, n + 1, 3).

    One pass of Sutherland and Hodgman (1974). Results are padded by repeating the first vertex; one that is cut away
    completely becomes all zeros.
    """
    count, corners, _ = polygons.shape
    distance = np.einsum("mni,mi->mn", polygons, planes)
    distance[np.abs(distance) < TOLERANCE] = 0.0
    following = np.roll(distance, -1, axis=1)
    crossing = distance * following < 0.0
    span = np.where(crossing, distance - following, 1.0)
    cut = polygons + (distance / span)[..., None] * (np.roll(polygons, -1, axis=1) - polygons)

    candidates = np.stack([polygons, cut], axis=2).reshape(count, 2 * corners, 3)
    kept = np.stack([distance >= 0.0, crossing], axis=2).reshape(count, 2 * corners)
    first = candidates[np.arange(count), kept.argmax(axis=1)]
    clipped = np.repeat(first[:, None, :], corners + 1, axis=1)
    slot = np.cumsum(kept, axis=1) - 1
    row, candidate = np.nonzero(kept & (slot <= corners))
    clipped[row, slot[row, candidate]] = candidates[row, candidate]
    clipped[~(distance > 0.0).any(axis=1)] = 0.0
    return clipped


@dataclass(frozen=True, eq=False)
class Prism:
    """A convex occluder: a convex base polygon (n, 2) in (x, z), extruded from `bottom` to `top` along y."""

    base: Array
    bottom: float
    top: float

    @cached_property
    def vertices(self) -> Array:
        """The 2n corners: the bottom ring, then the top ring, both in the order of the base."""
        ring = np.insert(self.base, 1, self.bottom, axis=1)
        lid = np.insert(self.base, 1, self.top, axis=1)
        return np.concatenate([ring, lid])

    @cached_property
    def faces(self) -> list[list[int]]:
        """Vertex loops of all faces, counter-clockwise from outside."""
        n = len(self.base)
        sides = [[k, n + k, n + (k + 1) % n, (k + 1) % n] for k in range(n)]
        loops = [*sides, list(range(n)), list(range(2 * n - 1, n - 1, -1))]
        along, across = self.base[1] - self.base[0], self.base[2] - self.base[1]
        # The walk (x, z) of a positive turn runs clockwise seen from +y, because z x x = y.
        return loops if along[0] * across[1] - along[1] * across[0] > 0.0 else [loop[::-1] for loop in loops]

    @cached_property
    def planes(self) -> tuple[Array, Array]:
        """Outward unit normals (F, 3) and offsets (F,) of the faces: a face is `normal . x = offset`."""
        corners = np.array([self.vertices[loop[:3]] for loop in self.faces])
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return normals, np.einsum("fi,fi->f", normals, corners[:, 0])

    def clipped(self, normal: Array, offset: float) -> Prism | None:
        """The part on the side `normal . x > offset` of a horizontal or vertical plane, None when there is none."""
        if abs(normal[1]) > 0.5:
            level = offset / normal[1]
            low, high = (max(self.bottom, level), self.top) if normal[1] > 0 else (self.bottom, min(self.top, level))
            return Prism(self.base, low, high) if high - low > TOLERANCE else None
        around = np.insert(self.base, 1, 0.0, axis=1)
        # Two dimensions suffice: shift the plane through the origin, cut, shift back, drop the padding.
        shift = normal * offset
        cut = clip((around - shift)[None], normal[None])[0]
        if not cut.any():
            return None
        ring = (cut + shift)[:, [0, 2]]
        distinct = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1) > TOLERANCE
        return Prism(ring[distinct], self.bottom, self.top) if distinct.sum() >= 3 else None

    def silhouette(self, visible: int) -> list[int]:
        """The outline, as a vertex loop, for the faces whose bits are set in `visible`: counter-clockwise as seen."""
        edges = set()
        for index, loop in enumerate(self.faces):
            if visible >> index & 1:
                edges |= set(zip(loop, loop[1:] + loop[:1], strict=True))
        outline = {a: b for a, b in edges if (b, a) not in edges}
        walk = [min(outline)]
        while (after := outline[walk[-1]]) != walk[0]:
            walk.append(after)
        return walk

    def shadow_cones(self, points: Array) -> Array:
        """Cones of directions that the prism hides from points (P, 3) outside it: unit plane normals (P, K, 3).

        A direction d is hidden when `plane . d >= 0` for all K planes; unused planes are zero.
        """
        normals, offsets = self.planes
        bits = (points @ normals.T - offsets > TOLERANCE) @ (1 << np.arange(len(offsets)))
        cones = np.zeros((len(points), len(self.vertices), 3))
        for visible in np.unique(bits):
            walk = self.silhouette(int(visible))
            chosen = np.flatnonzero(bits == visible)
            ring = self.vertices[walk][None] - points[chosen, None]
            cones[chosen, : len(walk)] = np.cross(np.roll(ring, -1, axis=1), ring)
        length = np.linalg.norm(cones, axis=2, keepdims=True)
        used = int((length[..., 0] > 0.0).any(axis=0).sum())
        return np.asarray(cones / np.where(length > 0.0, length, 1.0))[:, :used]


@dataclass(frozen=True, eq=False)
class Patches:
    """Convex quadrilaterals on one plane: vertices (V, 3), corner indices (N, 4), and what may stand in front.

    `blocks` names the occluders by number, each cut to the part in front of this plane (None: nothing is left).
    """

    vertices: Array
    quads: Integers
    normal: Array
    blocks: dict[int, Prism | None] = field(default_factory=dict)

    @cached_property
    def offset(self) -> float:
        """Position of the plane: `normal . x = offset`."""
        return float(self.vertices[self.quads[0, 0]] @ self.normal)

    @cached_property
    def edges(self) -> tuple[Integers, sparse.csr_array]:
        """Distinct edges (E, 2) and the signed incidence matrix (N, E) of the quadrilaterals."""
        directed = np.stack([self.quads, np.roll(self.quads, -1, axis=1)], axis=2).reshape(-1, 2)
        edges, index = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True)
        sign = np.where(directed[:, 0] < directed[:, 1], 1.0, -1.0)
        row = np.repeat(np.arange(len(self.quads)), 4)
        return edges, sparse.csr_array((sign, (row, index.ravel())), shape=(len(self.quads), len(edges)))


def factors(points: Array, normal: Array, targets: Patches, standing_on: int | None = None) -> Array:
    """Form factors (N, P) of all target patches from points (P, 3) of one plane with the given unit normal.

    `standing_on` numbers the block whose surface holds the points, which can hide nothing from them.
    """
    result = _unoccluded(points, normal, targets)
    above = np.einsum("vi,i->v", targets.vertices, normal)[:, None] - points @ normal
    outside = (above < -TOLERANCE).astype(np.uint8)
    horizon = _corner_codes(outside, targets.quads)[0]
    below = _corner_codes((above <= TOLERANCE).astype(np.uint8), targets.quads)[1]
    hidden = below.astype(bool) | (points @ targets.normal - targets.offset <= TOLERANCE)
    special = horizon.astype(bool)

    occluders = []
    for number, prism in targets.blocks.items():
        if prism is None or number == standing_on:
            continue
        cones = prism.shadow_cones(points)
        crossed, missed = _corner_codes(_outcodes(targets.vertices, points, cones), targets.quads)
        hidden |= crossed == 0
        partly = missed == 0
        special |= partly
        occluders.append((cones, np.where(partly, crossed, 0)))

    result[hidden] = 0.0
    patch, point = np.nonzero(special & ~hidden)
    if len(patch):
        result[patch, point] = _clipped(points, normal, targets, patch, point, horizon, occluders)
    return result


def _unoccluded(points: Array, normal: Array, targets: Patches) -> Array:
    """Lambert's formula for every patch and point, an edge shared by two patches being evaluated once: (N, P)."""
    edges, incidence = targets.edges
    a, b = edges[:, 0], edges[:, 1]
    corner = targets.vertices
    squared = np.zeros((len(corner), len(points)))
    for axis in range(3):
        squared += np.subtract.outer(corner[:, axis], points[:, axis]) ** 2
    length2 = np.sum((corner[b] - corner[a]) ** 2, axis=1)
    near, far = squared[a], squared[b]
    cosine = 0.5 * (near + far - length2[:, None])
    sine = np.sqrt(np.maximum(near * far - cosine * cosine, 0.0))
    # normal . ((A - p) x (B - p)), expanded so that the points enter by one matrix product.
    height = (np.cross(normal, corner[b] - corner[a]) @ points.T) + (np.cross(corner[a], corner[b]) @ normal)[:, None]
    terms = np.divide(np.arctan2(sine, cosine) * height, sine, out=np.zeros_like(sine), where=sine > 0.0)
    return np.asarray(incidence @ terms) / (-2.0 * np.pi)


def _outcodes(vertices: Array, points: Array, cones: Array) -> NDArray[np.uint8]:
    """One bit per cone plane that has the vertex on its outer side (Cohen and Sutherland's code): (V, P)."""
    codes = np.zeros((len(vertices), len(points)), dtype=np.uint8)
    for k in range(cones.shape[1]):
        planes = cones[:, k]
        distance = vertices @ planes.T - np.einsum("pi,pi->p", planes, points)
        codes |= (distance < -TOLERANCE).astype(np.uint8) << np.uint8(k)
    return codes


def _corner_codes(codes: NDArray[np.uint8], quads: Integers) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Bits set at any corner and bits set at all four corners of each patch: two arrays (N, P)."""
    a, b, c, d = (codes[quads[:, k]] for k in range(4))
    return a | b | c | d, a & b & c & d


def _clipped(
    points: Array,
    normal: Array,
    targets: Patches,
    patch: Integers,
    point: Integers,
    horizon: NDArray[np.uint8],
    occluders: list[tuple[Array, NDArray[np.uint8]]],
) -> Array:
    """Form factors (M,) of the pairs (patch, point) that cross the horizon or a shadow's edge.

    Two shadows are combined by inclusion and exclusion: F - F(in 1) - F(in 2) + F(in both).
    """
    normals = np.broadcast_to(normal, (len(patch), 3))
    polygons = targets.vertices[targets.quads[patch]] - points[point][:, None]
    below = horizon[patch, point].astype(bool)
    whole = np.concatenate([polygons, polygons[:, :1]], axis=1)
    whole[below] = clip(polygons[below], normals[below])
    result = polygon_factor(whole, normals)

    shadowed: list[tuple[NDArray[np.bool_], Array]] = []
    for cones, crossed in occluders:
        code = crossed[patch, point]
        some = code > 0
        pieces = np.zeros((len(patch), whole.shape[1] + cones.shape[1], 3))
        pieces[some] = _within(whole[some], cones[point[some]], code[some])
        result[some] -= polygon_factor(pieces[some], normals[some])
        shadowed.append((some, pieces))
    for first in range(len(occluders)):
        for second in range(first + 1, len(occluders)):
            both = shadowed[first][0] & shadowed[second][0]
            cones, crossed = occluders[second]
            pieces = _within(shadowed[first][1][both], cones[point[both]], crossed[patch[both], point[both]])
            result[both] += polygon_factor(pieces, normals[both])
    return result


def _within(polygons: Array, cones: Array, codes: NDArray[np.uint8]) -> Array:
    """Clip polygons (M, n, 3) to their cones (M, K, 3) with the planes that the codes (M,) name: (M, n + K, 3)."""
    corners = polygons.shape[1]
    clipped = np.repeat(polygons[:, :1], corners + cones.shape[1], axis=1)
    clipped[:, :corners] = polygons
    for k in range(cones.shape[1]):
        rows = np.flatnonzero(codes >> k & 1)
        used = corners + k  # each earlier cut added at most one corner
        cut = clip(clipped[rows, :used], cones[rows, k])
        clipped[rows, : used + 1] = cut
        clipped[rows, used + 1 :] = cut[:, :1]
    return clipped
