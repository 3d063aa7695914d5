"""How many plain materials an `openpbr` table ends in, which the kernels limit."""

from __future__ import annotations

from typing import Any

from accuray.formats.models.model import Table
from accuray.scene.composition import MOST_PARTS

__all__ = ["MOST_PARTS", "count_parts"]


def count_parts(table: Table) -> int:
    """Leaves of the tree that an `openpbr` table is taken apart into (``accuray.scene.openpbr.tree``)."""
    dielectric = 1 + _partial(table.get("transmission_weight", 0.0))
    if isinstance(table.get("specular_weight"), dict):
        dielectric += 1
    metal = table.get("base_metalness", 0.0)
    count: int = 1 if metal == 1.0 else dielectric + _partial(metal)
    if _partial(table.get("thin_film_weight", 0.0)):
        count *= 2
    if _partial(table.get("coat_weight", 0.0)):
        count *= 2
    return count + int(table.get("fuzz_weight", 0.0) != 0.0)


def _partial(weight: Any) -> bool:
    return isinstance(weight, dict) or weight not in (0.0, 1.0)
