"""Finds the line of a key path in the text of a TOML or JSON file.

Used only after the text was read without a syntax error and a value turned out wrong, so the scanner may
trust the syntax and needs no speed. It walks the text once and remembers the line of the longest prefix of
the wanted path that it met: table headers, dotted and quoted keys, inline tables, arrays over many lines,
arrays of tables.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

Key = str | int

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_SCALAR = re.compile(r"[^,\]\}\n#]+")
_BASIC_STRING = re.compile(r'"(?:[^"\\]|\\.)*"', re.DOTALL)
_LITERAL_STRING = re.compile(r"'[^']*'")
_MULTI_BASIC = re.compile(r'"""(?:[^\\]|\\.)*?"{3,5}', re.DOTALL)
_MULTI_LITERAL = re.compile(r"'''.*?'{3,5}", re.DOTALL)


def locate(text: str, syntax: str, path: tuple[Key, ...]) -> int | None:
    """1-based line of the longest prefix of ``path`` found in ``text``; None if not even its first key is.

    ``syntax`` is "toml" or "json".
    """
    scanner = _Scanner(text, path)
    try:
        if syntax == "json":
            scanner.value((), separator=":")
        else:
            scanner.toml_document()
    except (_Surprise, RecursionError):
        pass  # a text this scanner cannot follow keeps the best line so far
    return scanner.best_line


class _Surprise(Exception):
    """The text is not what the scanner expected."""


@dataclass
class _Scanner:
    text: str
    wanted: tuple[Key, ...]
    position: int = 0
    best_length: int = 0
    best_line: int | None = None

    def note(self, path: tuple[Key, ...], position: int) -> None:
        """Remember the line of ``path`` if it is a longer prefix of the wanted one than any before."""
        if len(path) > self.best_length and self.wanted[: len(path)] == path:
            self.best_length = len(path)
            self.best_line = self.text.count("\n", 0, position) + 1

    def toml_document(self) -> None:
        """A whole TOML file: headers and key-value lines."""
        table: tuple[Key, ...] = ()
        counts: dict[tuple[Key, ...], int] = {}
        while True:
            self.skip_blank()
            if self.position >= len(self.text):
                return
            start = self.position
            if self.text.startswith("[", start):
                array = self.text.startswith("[[", start)
                self.position += 2 if array else 1
                table = self.header(self.key_path(), counts, array)
                self.position += 2 if array else 1
                self.note(table, start)
            else:
                self.key_value(table, "=")

    def header(self, keys: tuple[str, ...], counts: dict[tuple[Key, ...], int], array: bool) -> tuple[Key, ...]:
        """The full path of a table header; elements of arrays of tables get their index."""
        path: tuple[Key, ...] = ()
        for depth, key in enumerate(keys):
            path = (*path, key)
            if depth == len(keys) - 1 and array:
                counts[path] = counts.get(path, -1) + 1
            if path in counts:
                path = (*path, counts[path])
        return path

    def key_value(self, table: tuple[Key, ...], separator: str) -> None:
        """One ``key = value`` (TOML) or ``"key": value`` (JSON)."""
        start = self.position
        path = (*table, *self.key_path())
        for length in range(len(table) + 1, min(len(path), len(self.wanted)) + 1):
            self.note(path[:length], start)
        self.skip_blank()
        self.expect(separator)
        self.value(path, separator)

    def key_path(self) -> tuple[str, ...]:
        """A dotted key, each part bare or quoted."""
        keys: list[str] = []
        while True:
            self.skip_spaces()
            character = self.text[self.position : self.position + 1]
            if character == '"':
                keys.append(_unescape(self.take(_BASIC_STRING)[1:-1]))
            elif character == "'":
                keys.append(self.take(_LITERAL_STRING)[1:-1])
            else:
                keys.append(self.take(_BARE_KEY))
            self.skip_spaces()
            if not self.text.startswith(".", self.position):
                return tuple(keys)
            self.position += 1

    def value(self, path: tuple[Key, ...], separator: str) -> None:
        """Any value; notes the elements of arrays and the keys of inline tables."""
        self.skip_blank()
        character = self.text[self.position : self.position + 1]
        if character == "[":
            self.position += 1
            index = 0
            while not self.at_end_of("]"):
                self.note((*path, index), self.position)
                self.value((*path, index), separator)
                index += 1
        elif character == "{":
            self.position += 1
            while not self.at_end_of("}"):
                self.key_value(path, separator)
        elif character == '"':
            self.take(_MULTI_BASIC if self.text.startswith('"""', self.position) else _BASIC_STRING)
        elif character == "'":
            self.take(_MULTI_LITERAL if self.text.startswith("'''", self.position) else _LITERAL_STRING)
        else:
            self.take(_SCALAR)

    def at_end_of(self, bracket: str) -> bool:
        """Skip blanks and one comma; True (and skipped) at the closing bracket."""
        self.skip_blank()
        if self.text.startswith(",", self.position):
            self.position += 1
            self.skip_blank()
        if self.text.startswith(bracket, self.position):
            self.position += 1
            return True
        if self.position >= len(self.text):
            raise _Surprise
        return False

    def take(self, pattern: re.Pattern[str]) -> str:
        """Consume and return what matches here."""
        match = pattern.match(self.text, self.position)
        if match is None:
            raise _Surprise
        self.position = match.end()
        return match.group()

    def expect(self, text: str) -> None:
        """Consume exactly this text."""
        if not self.text.startswith(text, self.position):
            raise _Surprise
        self.position += len(text)

    def skip_spaces(self) -> None:
        """Skip blanks inside a line."""
        while self.text[self.position : self.position + 1] in (" ", "\t"):
            self.position += 1

    def skip_blank(self) -> None:
        """Skip blanks, line ends and comments."""
        while self.position < len(self.text):
            character = self.text[self.position]
            if character == "#":
                end = self.text.find("\n", self.position)
                self.position = len(self.text) if end < 0 else end
            elif character in " \t\r\n":
                self.position += 1
            else:
                return


def _unescape(text: str) -> str:
    """The characters that a basic string stands for (escapes of keys are rare, so json's rules do)."""
    if "\\" not in text:
        return text
    import json

    try:
        return str(json.loads(f'"{text}"'))
    except ValueError:
        return text
