"""A value inside a glTF file together with its place, and checked ways to the values inside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from accuray.scene.errors import SceneError, Where

LARGEST = 1 << 53
"""Whole numbers up to here are exact in JSON."""


@dataclass(frozen=True)
class Item:
    """``value`` at the place ``where``. All methods raise SceneError for values of the wrong kind."""

    value: Any
    where: Where

    def error(self, problem: str, allowed: str | None = None) -> SceneError:
        """An error about this value."""
        return self.where.error(problem, value=self.value, allowed=allowed)

    def has(self, key: str) -> bool:
        """Is there such a key?"""
        return isinstance(self.value, dict) and key in self.value

    def child(self, key: str, default: Any = None) -> Item:
        """The value of a key of this object."""
        if not isinstance(self.value, dict):
            raise self.error("is not an object", "{...}")
        return Item(self.value.get(key, default), self.where.child(key))

    def table(self, key: str) -> Item:
        """An object inside this one, empty if it is not there."""
        inner = self.child(key, {})
        if not isinstance(inner.value, dict):
            raise inner.error("is not an object", "{...}")
        return inner

    def extension(self, name: str) -> Item | None:
        """The object of an extension, None without it."""
        extensions = self.table("extensions")
        return extensions.table(name) if extensions.has(name) else None

    def items(self, key: str) -> list[Item]:
        """The elements of a list, none if it is not there."""
        inner = self.child(key, [])
        if not isinstance(inner.value, list):
            raise inner.error("is not a list", "[...]")
        return [Item(value, inner.where.child(index)) for index, value in enumerate(inner.value)]

    def text(self, key: str, default: str | None = None) -> str:
        """A text. Required without a default."""
        inner = self.child(key, default)
        if not isinstance(inner.value, str):
            raise inner.error("is not a text", "a text")
        return inner.value

    def name(self, fallback: str) -> str:
        """The name of this object, or another one if it has none."""
        value = self.child("name").value
        return value if isinstance(value, str) and value else fallback

    def boolean(self, key: str) -> bool:
        """A truth value, false if it is not there."""
        inner = self.child(key, False)
        if not isinstance(inner.value, bool):
            raise inner.error("is not a truth value", "true or false")
        return inner.value

    def integer(self, key: str, default: int | None = None, low: int = 0, high: int = LARGEST) -> int:
        """A whole number from ``low`` to ``high``. Required without a default."""
        return whole(self.child(key, default), low, high)

    def index(self, key: str, count: int) -> int | None:
        """A place in a list of ``count`` objects, None if there is no such key."""
        if not self.has(key):
            return None
        inner = self.child(key)
        if count == 0:
            raise inner.error("refers to nothing", "none, for the list is empty")
        return whole(inner, 0, count - 1)

    def number(self, key: str, default: float | None = None, low: float = -math.inf, high: float = math.inf) -> float:
        """A finite number from ``low`` to ``high``. Required without a default."""
        return real(self.child(key, default), low, high)

    def vector(self, key: str, default: tuple[float, ...], length: int | None = None) -> tuple[float, ...]:
        """Finite numbers, as many as the default has unless ``length`` says otherwise."""
        if not self.has(key):
            return default
        inner = self.items(key)
        count = len(default) if length is None else length
        if len(inner) != count:
            raise self.child(key).error(f"has {len(inner)} numbers", f"{count} numbers")
        return tuple(real(item) for item in inner)


def whole(item: Item, low: int, high: int) -> int:
    """The item as a whole number from ``low`` to ``high``."""
    value = item.value
    if isinstance(value, float) and value.is_integer() and abs(value) <= LARGEST:
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise item.error("is not such a whole number", f"{low} to {high}")
    return value


def real(item: Item, low: float = -math.inf, high: float = math.inf) -> float:
    """The item as a finite number from ``low`` to ``high``."""
    value = item.value
    if isinstance(value, bool) or not isinstance(value, (int, float)) or abs(value) > 1e300:
        raise item.error("is not a finite number", "a number")
    if not low <= value <= high:
        raise item.error("is out of range", f"{low:g} to {high:g}")
    return float(value)
