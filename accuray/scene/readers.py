"""Readers of files by their ending, which ``accuray.formats`` registers: this package knows no file formats."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

from accuray.scene.errors import Where

Content = TypeVar("Content")


class Readers(Generic[Content]):
    """What reads one kind of file; a reader raises ValueError with the line for a wrong one."""

    def __init__(self) -> None:
        self._readers: dict[str, Callable[..., Content]] = {}

    def register(self, suffix: str, reader: Callable[..., Content]) -> None:
        """Use ``reader`` for files with this lower-case suffix (".obj")."""
        self._readers[suffix] = reader

    def read(self, path: Path, where: Where, **options: bool) -> Content:
        """The content of a file; ``options`` are the reader's own. Raises SceneError at ``where``."""
        reader = self._readers.get(path.suffix.lower())
        if reader is None:
            known = ", ".join(self._readers) or "none (import accuray.formats)"
            raise where.error("has no reader", value=path.name, allowed=known)
        try:
            return reader(path, **options)
        except (ValueError, OSError) as error:
            raise where.error(f"cannot be read: {error}", value=path.name) from error
