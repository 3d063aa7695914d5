"""Confinement of the files that a scene names.

A scene is data from anywhere, so its file references resolve only below the folder of the scene file and below
asset roots that the caller or the environment variable ACCURAY_PATH gives; symbolic links are followed before
that is checked. ``builtin:NAME`` names a data file that comes with the renderer.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from accuray import data
from accuray.scene.errors import Where, nearest_name

BUILTIN = "builtin:"
MAX_NAME = 1024
MEBIBYTE = 1 << 20
MAX_BYTES = {".toml": 64 * MEBIBYTE, ".json": 64 * MEBIBYTE, ".csv": 16 * MEBIBYTE}
MAX_BYTES_OTHER = 64 << 30


@dataclass(frozen=True)
class Confinement:
    """Folders that file names may lead into: the scene's own first, then the asset roots, all resolved."""

    folders: tuple[Path, ...]

    @classmethod
    def around(cls, folder: Path, roots: Iterable[str | Path] = ()) -> Confinement:
        """Confinement to a scene's folder, the given roots and those of ACCURAY_PATH."""
        from_environment = [entry for entry in os.environ.get("ACCURAY_PATH", "").split(os.pathsep) if entry]
        return cls(tuple(Path(os.path.realpath(entry)) for entry in (folder, *roots, *from_environment)))

    def resolve(self, name: object, where: Where, suffixes: Sequence[str] = (), *, bulk: bool = False) -> Path:
        """The real path of an existing regular file, or SceneError at ``where``.

        Relative names start at the folder of the file that wrote them, then at each root. ``suffixes`` are the
        allowed endings, any if empty. ``bulk``: as large a file as a mesh may be, whatever its ending.
        """
        text = _checked_name(name, where)
        found = self._builtin(text, where) if text.startswith(BUILTIN) else self._search(text, where)
        if suffixes and found.suffix.lower() not in suffixes:
            raise where.error("has a file type that is not read here", value=text, allowed=", ".join(suffixes))
        check_regular(found, where, text, bulk=bulk)
        return found

    def _builtin(self, text: str, where: Where) -> Path:
        name = text[len(BUILTIN) :]
        known = data.files()
        if name not in known:
            nearest = nearest_name(name, known)
            raise where.error(
                "is not a data file that comes with the renderer",
                value=text,
                allowed=", ".join(known),
                nearest=nearest and BUILTIN + nearest,
            )
        return data.FOLDER / name

    def _search(self, text: str, where: Where) -> Path:
        """The first existing candidate; one that leads outside is an error even if a later one would do."""
        for folder in (Path(os.path.realpath(where.source.folder)), *self.folders):
            real = _real(folder / text, where, text)
            if not any(real.is_relative_to(allowed) for allowed in self.folders):
                raise where.error("leads outside of the scene's folders", value=text, allowed=self._allowed())
            if os.path.lexists(real):
                return real
        raise where.error("does not exist", value=text, allowed=self._allowed())

    def _allowed(self) -> str:
        unique = list(dict.fromkeys(map(str, self.folders)))
        return "a file below " + " or ".join(unique) + " (more roots: ACCURAY_PATH)"


def _checked_name(name: object, where: Where) -> str:
    """A file name that is safe to hand to the operating system."""
    if not isinstance(name, str | os.PathLike):
        raise where.error("is not a file name", value=name, allowed='a text such as "paint.csv"')
    text = os.fspath(name)
    if not isinstance(text, str) or not text:
        raise where.error("is not a file name", value=text, allowed='a text such as "paint.csv"')
    if len(text) > MAX_NAME:
        raise where.error(f"is too long a file name ({len(text)} characters)", value=text, allowed=f"up to {MAX_NAME}")
    if any(ord(character) < 32 or ord(character) == 127 for character in text) or "\\" in text:
        raise where.error(
            "has a control character or backslash", value=text, allowed="printable characters, / between folders"
        )
    if text.startswith("~") or ("://" in text) or text.lower().startswith("file:"):
        raise where.error(
            "is not a plain file name", value=text, allowed='a relative name or "builtin:NAME"; no ~ and no URL'
        )
    return text


def _real(path: Path, where: Where, text: str) -> Path:
    try:
        return Path(os.path.realpath(path))
    except (OSError, ValueError) as error:
        raise where.error(f"cannot be resolved ({error})", value=text) from None


def display_path(path: Path) -> str:
    """A path as errors show it: relative to the current folder where that is shorter."""
    relative = os.path.relpath(path)
    return relative if len(relative) < len(str(path)) else str(path)


def check_regular(path: Path, where: Where, text: str, *, bulk: bool = False) -> None:
    """SceneError unless ``path`` is a readable regular file of at most the size for its type."""
    try:
        status = path.stat()
    except OSError as error:
        raise where.error(f"cannot be read ({error.strerror})", value=text, allowed="an existing file") from None
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe, socket or device"
        raise where.error(f"is {kind}", value=text, allowed="a regular file")
    limit = MAX_BYTES_OTHER if bulk else MAX_BYTES.get(path.suffix.lower(), MAX_BYTES_OTHER)
    if status.st_size > limit:
        raise where.error(f"is too large ({status.st_size} bytes)", value=text, allowed=f"up to {limit} bytes")
