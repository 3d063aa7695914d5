"""What can go wrong with films and image files, as exceptions that say what and where."""

from __future__ import annotations

import os


class ImageError(ValueError):
    """An image file that cannot be read or written, or image data that makes no sense.

    Attributes:
        path: the file concerned, or None when no file is involved.
        reason: what is wrong, without the path.
    """

    def __init__(self, reason: str, path: str | os.PathLike[str] | None = None) -> None:
        self.path = None if path is None else os.fspath(path)
        self.reason = reason
        super().__init__(reason if self.path is None else f"{self.path}: {reason}")


class ImageWriteError(ImageError, OSError):
    """The file system refused a file: also an `OSError`, with its `errno` where there is one."""

    def __init__(self, reason: str, path: str | os.PathLike[str], cause: OSError | None = None) -> None:
        super().__init__(f"cannot be written: {reason}", path)
        self.errno = None if cause is None else cause.errno
        self.strerror = reason

    def __str__(self) -> str:
        return f"{self.path}: {self.reason}"


class MergeError(ImageError):
    """Films that must not be added: another scene, another setting, or samples that both of them hold."""


class FilmOverflowError(ImageError):
    """A 64-bit fixed-point sum left its range. Nothing was wrapped; the inputs are unchanged."""
