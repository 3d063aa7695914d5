"""The one exception for wrong scenes, and the objects that know where a value was written.

A ``Document`` is what the readers of ``accuray.formats`` hand over: plain dicts and lists, plus the
``Source`` (file, override or Python) of each part. A ``Where`` is a key path in a document; validators
pass it along and ask it for an error only when something is wrong, so a correct scene pays nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Key = str | int
SHOWN_VALUE = 80
SHOWN_LINE = 160
NO_VALUE = object()


class SceneError(ValueError):
    """A scene, or a file it names, is wrong.

    Attributes: ``file`` and ``line`` (None for scenes built in Python), ``key`` (dotted path, "" for the
    whole scene), ``value`` (the offending value, None if something is missing), ``allowed`` (text),
    ``nearest`` (the closest allowed name, or None). ``str()`` gives all of them and the source line.
    """

    def __init__(
        self,
        problem: str,
        *,
        file: str | None = None,
        line: int | None = None,
        key: str = "",
        value: Any = None,
        allowed: str | None = None,
        nearest: str | None = None,
        shown: str | None = None,
    ) -> None:
        self.file, self.line, self.key = file, line, key
        self.value, self.allowed, self.nearest = value, allowed, nearest
        place = "" if file is None else file if line is None else f"{file}:{line}"
        head = ": ".join(part for part in (place, key, problem) if part)
        if allowed:
            head += f": allowed {allowed}"
        if nearest:
            head += f" (did you mean {show(nearest)}?)"
        if shown and shown.strip():
            head += "\n    " + shorten(shown.strip(), SHOWN_LINE)
        super().__init__(head)


@dataclass(frozen=True)
class Source:
    """Where values were written.

    ``name`` is shown in errors ("" for Python objects), ``text`` and ``syntax`` ("toml" or "json") find
    lines, ``folder`` is where relative file names start, ``length_unit`` is the unit of bare lengths.
    """

    name: str = ""
    text: str | None = None
    syntax: str = ""
    folder: Path = field(default_factory=Path.cwd)
    length_unit: str = "m"

    def line_of(self, path: tuple[Key, ...]) -> int | None:
        """1-based line of the deepest part of ``path`` that the text holds, None without a text."""
        if self.text is None:
            return None
        from accuray.scene.locate import locate

        return locate(self.text, self.syntax, path)

    def shown_line(self, line: int | None) -> str | None:
        """The text of a 1-based line, None if there is none."""
        if self.text is None or line is None:
            return None
        lines = self.text.split("\n")
        return lines[line - 1] if 0 < line <= len(lines) else None


@dataclass
class Document:
    """A scene as read.

    ``data`` is what it says after includes and overrides, ``top`` the file asked for, and ``origins`` holds the
    source of every key path that came from elsewhere.
    """

    data: dict[str, Any]
    top: Source
    origins: dict[tuple[Key, ...], Source] = field(default_factory=dict)

    def source_of(self, path: tuple[Key, ...]) -> Source:
        """Source of the value at ``path``: that of its longest recorded prefix."""
        if self.origins:
            for length in range(len(path), 0, -1):
                found = self.origins.get(path[:length])
                if found is not None:
                    return found
        return self.top


@dataclass(frozen=True)
class Where:
    """A key path inside a document."""

    document: Document
    path: tuple[Key, ...] = ()

    def child(self, *keys: Key) -> Where:
        """The same document one or more keys or indices deeper."""
        return Where(self.document, (*self.path, *keys))

    def sibling(self, key: Key) -> Where:
        """Another key of the same table."""
        return Where(self.document, (*self.path[:-1], key))

    @property
    def source(self) -> Source:
        """The file (or override, or Python) that wrote this value."""
        return self.document.source_of(self.path)

    @property
    def key(self) -> str:
        """The path as text: ``shapes.floor.positions[3][1]``."""
        return dotted(self.path)

    def error(
        self, problem: str, *, value: Any = NO_VALUE, allowed: str | None = None, nearest: str | None = None
    ) -> SceneError:
        """An error at this place; a given ``value`` is put before the problem: ``1.7 is out of range``."""
        source = self.source
        line = source.line_of(self.path)
        given = value is not NO_VALUE
        return SceneError(
            f"{show(value)} {problem}" if given else problem,
            file=source.name or None,
            line=line,
            key=self.key,
            value=value if given else None,
            allowed=allowed,
            nearest=nearest,
            shown=source.shown_line(line),
        )

    def unknown(self, name: Any, noun: str, known: Iterable[str]) -> SceneError:
        """An error for a name that is not among the known ones; names the nearest of them."""
        names = list(known)
        allowed = ", ".join(names) if names else f"none (no {noun} is defined)"
        return self.error(f"is not a known {noun}", value=name, allowed=allowed, nearest=nearest_name(name, names))


def nearest_name(name: Any, known: Iterable[str]) -> str | None:
    """The known name closest to ``name`` ignoring case, None if nothing is close."""
    if not isinstance(name, str) or len(name) > 200:
        return None
    from difflib import get_close_matches

    by_lower = {entry.lower(): entry for entry in known}
    found = get_close_matches(name.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[found[0]] if found else None


def show(value: Any) -> str:
    """A value as a scene file would spell it, shortened to one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + shorten(value.encode("unicode_escape").decode("ascii"), SHOWN_VALUE) + '"'
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return shorten("{" + ", ".join(str(key) for key in list(value)[:8]) + "}", SHOWN_VALUE)
    if isinstance(value, (list, tuple)):
        items = ["[...]" if isinstance(item, (list, tuple)) else show(item) for item in value[:4]]
        return shorten("[" + ", ".join([*items, "..."] if len(value) > 4 else items) + "]", SHOWN_VALUE)
    return shorten(_plain_text(value), SHOWN_VALUE)


def _plain_text(value: Any) -> str:
    """str() of a number or another object; Python refuses to print integers of thousands of digits."""
    try:
        return " ".join(str(value).split())
    except ValueError:
        return "an integer of thousands of digits"


def shorten(text: str, limit: int) -> str:
    """``text`` cut to ``limit`` characters with an ellipsis."""
    return text if len(text) <= limit else text[: limit - 3] + "..."


def dotted(path: tuple[Key, ...]) -> str:
    """A key path as text; keys that TOML would quote are quoted."""
    parts: list[str] = []
    for key in path:
        if isinstance(key, int):
            parts.append(f"[{key}]")
        else:
            bare = key.replace("-", "").replace("_", "").isalnum() and key.isascii()
            parts.append(("." if parts else "") + (key if bare else show(key)))
    return "".join(parts)
