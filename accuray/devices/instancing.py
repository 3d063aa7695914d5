"""Instances as the intersector takes them: one level, each a transform of a group of shapes.

Instances of instances are multiplied out, whole arrays at a time. How many that gives is counted first, so that what no
memory holds is refused before it begins.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from accuray.scene.shapes import Shapes, from_the_leaves

CHUNK = 1 << 16
"""Transforms that are worked on at a time."""

Rows = NDArray[np.float64]
IDENTITY: Rows = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]])


class Group(NamedTuple):
    """Shapes that are no instances, shown together; ``material`` is that of all of them, None: each has its own."""

    members: tuple[str, ...]
    material: str | None

    def under(self, material: str | None) -> Group:
        """The group as an instance with a material of its own, or None, shows it."""
        return self if material is None else Group(self.members, material)


class Copies(NamedTuple):
    """A group under each of some transforms, float64 (n, 12), three rows of four each."""

    group: Group
    rows: Rows


class Instancing:
    """The instances of a scene's resolved shapes."""

    def __init__(self, shapes: Shapes) -> None:
        self._shapes = shapes
        self._whole: dict[str, dict[Group, Rows]] = {}

    @cached_property
    def counts(self) -> dict[str, Counter[Group]]:
        """For every instance shape how many instances of which groups it comes to; whole numbers of any size."""
        counts: dict[str, Counter[Group]] = {}
        for name in from_the_leaves(self._shapes):
            if self._shapes[name]["type"] != "instance":
                continue
            material = self._shapes[name]["material"]
            counts[name] = Counter()
            for many, targets in self._choices(name):
                plain, nested = self._sorted_out(targets)
                if plain:
                    counts[name][Group(plain, material)] += many
                for member in nested:
                    for group, inner in counts[member].items():
                        counts[name][group.under(material)] += many * inner
        return counts

    def total(self, names: Iterable[str]) -> int:
        """How many instances of groups some instance shapes come to together."""
        return sum(self.counts[name].total() for name in names)

    def shown(self) -> list[str]:
        """Names of the instance shapes that the scene shows, in its order."""
        return [name for name, shape in self._shapes.items() if shape["type"] == "instance" and not shape["prototype"]]

    def nested(self) -> list[str]:
        """Names of those that others show at least once, each after those that it is made of."""
        found: set[str] = set()
        order = from_the_leaves(self._shapes)
        for name in reversed(order):
            if self._shapes[name]["type"] == "instance" and (name in found or not self._shapes[name]["prototype"]):
                for many, targets in self._choices(name):
                    found.update(self._sorted_out(targets)[1] if many else ())
        return [name for name in order if name in found]

    def copies(self, name: str) -> Iterator[Copies]:
        """All instances of groups that an instance shape comes to, in pieces of bounded size."""
        for member in self.nested():
            if member not in self._whole:
                self._whole[member] = _joined(self._own(member))
        yield from self._own(name)

    def _own(self, name: str) -> Iterator[Copies]:
        """Those of one shape, when what it is made of is known whole."""
        material = self._shapes[name]["material"]
        for targets, rows in self._placed(name):
            plain, nested = self._sorted_out(targets)
            if plain:
                yield Copies(Group(plain, material), rows)
            for member in nested:
                for group, inner in self._whole[member].items():
                    step = max(1, CHUNK // max(len(inner), 1))
                    for first in range(0, len(rows), step):
                        yield Copies(group.under(material), product(rows[first : first + step], inner))

    def _placed(self, name: str) -> Iterator[tuple[tuple[str, ...], Rows]]:
        """What an instance shape names, and where: its array, under its transform if still, by id and in order."""
        shape = self._shapes[name]
        still = isinstance(shape["transform"], np.ndarray)
        outer = np.ascontiguousarray(shape["transform"][:3]).reshape(1, 12) if still else IDENTITY
        if shape["instances"] is None:
            yield tuple(shape["of"]), outer
            return
        rows = shape["instances"].rows()
        if shape["ids"] is None:
            for first in range(0, len(rows), CHUNK):
                yield tuple(shape["of"]), product(outer, rows[first : first + CHUNK].astype(np.float64))
            return
        order = np.argsort(shape["ids"], kind="stable")
        ends = np.cumsum(np.bincount(shape["ids"], minlength=len(shape["of"])))
        for target, begin, end in zip(shape["of"], (0, *ends[:-1].tolist()), ends.tolist(), strict=True):
            for first in range(begin, end, CHUNK):
                chosen = order[first : min(first + CHUNK, end)]
                yield (target,), product(outer, rows[chosen].astype(np.float64))

    def _choices(self, name: str) -> list[tuple[int, tuple[str, ...]]]:
        """How often an instance shape shows which of those that it names."""
        shape = self._shapes[name]
        if shape["ids"] is None:
            return [(1 if shape["instances"] is None else shape["instances"].count, tuple(shape["of"]))]
        times = np.bincount(shape["ids"], minlength=len(shape["of"])).tolist()
        return [(many, (target,)) for many, target in zip(times, shape["of"], strict=True)]

    def _sorted_out(self, targets: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Shapes, and instances of others."""
        nested = tuple(target for target in targets if self._shapes[target]["type"] == "instance")
        return tuple(target for target in targets if self._shapes[target]["type"] != "instance"), nested


def product(outer: Rows, inner: Rows) -> Rows:
    """Every transform of ``outer`` (m, 12) after every one of ``inner`` (n, 12): (m n, 12).

    Sums are in index order and never a BLAS product, so the bits are the same on every machine.
    """
    if outer is IDENTITY:
        return inner
    a, b = outer.reshape(-1, 1, 3, 4), inner.reshape(1, -1, 3, 4)
    result = np.empty((len(outer), len(inner), 3, 4))
    for i in range(3):
        for j in range(4):
            entry = a[..., i, 0] * b[..., 0, j] + a[..., i, 1] * b[..., 1, j] + a[..., i, 2] * b[..., 2, j]
            result[..., i, j] = entry + a[..., i, 3] if j == 3 else entry
    return result.reshape(-1, 12)


def scales(rows: Rows) -> NDArray[np.float64]:
    """The one scale of each transform, (n,): the length of its first column."""
    return np.sqrt(rows[:, 0] ** 2 + rows[:, 4] ** 2 + rows[:, 8] ** 2)


def _joined(pieces: Iterator[Copies]) -> dict[Group, Rows]:
    """All rows of each group."""
    found: defaultdict[Group, list[Rows]] = defaultdict(list)
    for group, rows in pieces:
        found[group].append(rows)
    return {group: np.concatenate(rows) for group, rows in found.items()}
