"""What a scene takes in memory, so that more than there is can be refused before it is allocated.

Bytes for each thing while the scene is prepared; the figures of Embree (3.13, robust, one thread) were measured
as the growth of a process's peak and rounded up, and the tests hold them against new measurements:

===================  =======================================================================
vertex of a mesh     12, and 12 with normals, 8 with texture coordinates, 16 with colours
triangle of a mesh   12, and Embree's ``EMBREE_TRIANGLE``, or ``EMBREE_COMPACT`` if the scene is compact
instance             ``RECORD``, and Embree's ``EMBREE_INSTANCE``
light of a surface   ``LIGHT``: its records, its place in the tree, and what builds it
===================  =======================================================================
"""

from __future__ import annotations

from typing import Any

from accuray.scene.memory import check_fits, readable

EMBREE_TRIANGLE = 115
EMBREE_COMPACT = 80
EMBREE_INSTANCE = 420
RECORD = 68
NESTED = 96
"""A transform in double precision, while instances of instances are multiplied out."""

LIGHT = 300
SLACK = 64 << 20
"""Bytes that may be claimed before the system is asked again how much there is."""


class Budget:
    """Adds up what is about to be allocated, and refuses what does not fit.

    What Embree takes comes last, when all arrays are there, so it is owed until then. ``claimed``: bytes in all.
    """

    def __init__(self, compact: bool) -> None:
        self._triangle = EMBREE_COMPACT if compact else EMBREE_TRIANGLE
        self.claimed = 0
        self._owed = 0
        self._unseen = 0

    def admit_mesh(self, arrays: Any) -> None:
        """Positions, faces, normals, uvs and colours of a mesh, None where there are none. Raises ValueError."""
        now = sum(array.nbytes for array in arrays if array is not None)
        faces = len(arrays[1])
        self._admit(now, faces * self._triangle, f"a mesh of {faces} triangles")

    def admit_instances(self, count: int, nested: int) -> None:
        """All instances of the scene, of which those of prototypes are multiplied out first. Raises ValueError."""
        what = f"{count} instances" + (f", and {nested} inside of them," if nested else "")
        self._admit(count * RECORD + nested * NESTED, count * EMBREE_INSTANCE, what)

    def admit_lights(self, count: int) -> None:
        """Surfaces that emit, of instances. Raises ValueError."""
        self._admit(0, count * LIGHT, f"{count} lights of instances")

    def _admit(self, now: int, later: int, what: str) -> None:
        self.claimed += now + later
        self._owed += later
        self._unseen += now
        if self._owed + self._unseen > SLACK:
            before = self._owed - later
            if before:
                what += f", with {readable(before)} for what came before,"
            check_fits(self._owed + now, what)
            self._unseen = 0
