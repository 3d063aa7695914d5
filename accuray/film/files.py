"""Durable, atomic file writing.

A file appears under its final name complete, or not at all: bytes go to a temporary file in the same folder, are
flushed to the disk, and the temporary is renamed; then the folder is flushed, so the name survives a power cut too.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import ImageWriteError

if TYPE_CHECKING:
    from typing_extensions import Buffer


def atomic_write(path: str | os.PathLike[str], data: Buffer) -> None:
    """Writes a file so that only the old or the new complete one is ever seen under its name.

    The content comes as bytes, not through a stream that an encoder writes to, because encoders swallow errors: OpenEXR
    writes its offset table in a destructor, where a full disk goes unnoticed. A symbolic link is followed: the file it
    names is replaced, not the link.

    Args:
        path: the final name; its folder must exist.
        data: the content.

    Raises:
        ImageWriteError: the folder is missing, the name is taken by something that is not a file, or a write, flush
            or rename failed (the OSError is its cause). The temporary file is removed and an old file left as it was.
    """
    final = _writable_target(path)
    temporary = _temporary_name(final)
    try:
        with _explained(path):
            _write_durably(temporary, data)
            os.replace(temporary, final)
            _flush_folder(final.parent)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise


def probe_writable(path: str | os.PathLike[str]) -> None:
    """Checks, before hours are spent, that `atomic_write(path, ...)` has a folder it may create files in.

    Raises:
        ImageWriteError: as `atomic_write` would.
    """
    final = _writable_target(path)
    temporary = _temporary_name(final)
    with _explained(path):
        os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
        temporary.unlink()


def _writable_target(path: str | os.PathLike[str]) -> Path:
    """The real path to replace."""
    final = Path(os.path.realpath(path))
    try:
        mode = final.stat().st_mode
    except FileNotFoundError:
        mode = None
    except OSError as error:
        raise ImageWriteError(error.strerror or str(error), path, error) from error
    if mode is not None and not stat.S_ISREG(mode):
        raise ImageWriteError("it exists and is not a regular file", path)
    if not final.parent.is_dir():
        raise ImageWriteError(f"there is no folder {final.parent}", path)
    return final


def _temporary_name(final: Path) -> Path:
    """A name in the same folder, short enough for any file system, that nobody else uses."""
    return final.with_name(f".{final.name[:60]}.{os.urandom(8).hex()}.tmp")


def _write_durably(path: Path, data: Buffer) -> None:
    """Creates `path` with the data and waits until they are on the disk."""
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        remaining = memoryview(data).cast("B")
        while remaining:
            remaining = remaining[os.write(descriptor, remaining) :]
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _flush_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def _explained(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns an OSError into an ImageWriteError that names the path."""
    try:
        yield
    except OSError as error:
        raise ImageWriteError(error.strerror or str(error), path, error) from error
