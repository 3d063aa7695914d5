"""From a scene file on disk to a validated Scene: includes, merging, overrides."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from accuray.formats.merging import apply_override, merge, parse_override
from accuray.scene import Scene, SceneError
from accuray.scene import schema as schemas
from accuray.scene.errors import Document, Source, Where, show
from accuray.scene.paths import Confinement, check_regular, display_path
from accuray.scene.scene import build, check_file_keys

if TYPE_CHECKING:
    from accuray.formats.models.model import ModelReader

SceneReader = Callable[[str, str], dict[str, Any]]
"""(text, name for errors) -> dict; raises SceneError."""

MAX_INCLUDE_DEPTH = 32
MAX_FILES = 1000


def load_scene(
    path: str | PathLike[str],
    readers: Mapping[str, SceneReader],
    models: Mapping[str, ModelReader],
    overrides: Iterable[str] | Mapping[str, Any],
    roots: Iterable[str | PathLike[str]],
    frame: float | None = None,
) -> Scene:
    """See ``accuray.formats.load``."""
    shown = os.fspath(path)
    real = _existing(shown, (*readers, *models))
    folders = tuple(Path(root) for root in roots)
    files = Confinement.around(real.parent, folders)
    notes: list[str] = []
    if real.suffix.lower() in models:
        from accuray.formats.models.expanding import model_document

        lights = frozenset(schemas.current().family("light").types)
        document, notes = model_document(real, shown, files, lights, models)
    else:
        document = _Reading(readers, files).read(real, shown, ())
    document.top = replace(document.top, folder=files.folders[0])
    if isinstance(overrides, str):
        overrides = (overrides,)
    if isinstance(overrides, Mapping):
        changes = [(f"override {key}", key, value) for key, value in overrides.items()]
    else:
        changes = [(f"-D {text}", *parse_override(text)) for text in overrides]
    for name, key, value in changes:
        apply_override(document, name, key, value)
    return build(document, roots=folders, path=real, notes=notes, frame=frame)


def _existing(shown: str, suffixes: Sequence[str]) -> Path:
    """The scene or model file that the caller names: anywhere, but a regular file of a known type."""
    where = Where(Document({}, Source(name=shown)))
    path = Path(shown)
    if not os.path.exists(shown):
        raise SceneError(f"{show(shown)} does not exist", file=shown, value=shown, allowed="a scene file")
    if path.suffix.lower() not in suffixes:
        raise where.error("is not a scene file", value=shown, allowed="the endings " + ", ".join(suffixes))
    check_regular(path, where, shown)
    return Path(os.path.realpath(path.parent)) / path.name


@dataclass(frozen=True)
class _Reading:
    """Reads a file and what it includes."""

    readers: Mapping[str, SceneReader]
    files: Confinement
    opened: list[Path] = field(default_factory=list)

    def read(self, path: Path, shown: str, chain: tuple[tuple[Path, str], ...]) -> Document:
        """The merged document of a file; ``chain`` are the files that include it, outermost first."""
        self.opened.append(path)
        text = _text(path, shown)
        syntax = path.suffix.lower().lstrip(".")
        data = self.readers[path.suffix.lower()](text, shown)
        source = Source(shown, text, syntax, path.parent)
        where = Where(Document(data, source))
        source = replace(source, length_unit=check_file_keys(data, where))
        document = Document(data, source)
        included = self._included(Where(document), (*chain, (Path(os.path.realpath(path)), shown)))
        result: Document | None = None
        for below in included:
            result = below if result is None else merge(result, below)
        return document if result is None else merge(result, document)

    def _included(self, where: Where, chain: tuple[tuple[Path, str], ...]) -> list[Document]:
        """The documents of the files in ``include``, in order."""
        names = where.document.data.get("include", [])
        where = where.child("include")
        if not isinstance(names, list):
            raise where.error("is not a list", value=names, allowed='a list of file names such as ["room.toml"]')
        documents = []
        for index, name in enumerate(names):
            item = where.child(index)
            path = self.files.resolve(name, item, tuple(self.readers))
            loop = [shown for real, shown in chain if real == path]
            shown = display_path(path)
            if loop:
                raise item.error("includes itself: " + " -> ".join([*(s for _, s in chain), shown]), value=name)
            if len(chain) > MAX_INCLUDE_DEPTH:
                raise item.error("is included too deeply", value=name, allowed=f"{MAX_INCLUDE_DEPTH} levels")
            if len(self.opened) >= MAX_FILES:
                raise item.error("is one file too many", value=name, allowed=f"{MAX_FILES} files in all")
            documents.append(self.read(path, shown, chain))
        return documents


def _text(path: Path, shown: str) -> str:
    """The UTF-8 text of a file without its byte order mark."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise SceneError(f"cannot be read ({error.strerror})", file=shown) from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise SceneError(f"byte {error.start} is not UTF-8 text", file=shown, line=line, allowed="UTF-8 text") from None
