"""Atomic, durable writes: only the old or the new complete file, whatever call fails."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from accuray.film import ImageWriteError, atomic_write, probe_writable

DATA = bytes(range(256)) * 100


def test_writes_and_replaces(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    for data in (DATA, b"", b"short"):
        atomic_write(path, data)
        assert path.read_bytes() == data
    assert os.listdir(tmp_path) == ["a.bin"]


def test_permissions_follow_the_umask(tmp_path: Path) -> None:
    previous = os.umask(0o027)
    try:
        atomic_write(tmp_path / "a.bin", DATA)
    finally:
        os.umask(previous)
    assert stat.S_IMODE((tmp_path / "a.bin").stat().st_mode) == 0o640


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link.bin").symlink_to(tmp_path / "real" / "a.bin")
    atomic_write(tmp_path / "link.bin", DATA)
    assert (tmp_path / "link.bin").is_symlink()
    assert (tmp_path / "real" / "a.bin").read_bytes() == DATA


def test_long_names_work(tmp_path: Path) -> None:
    path = tmp_path / ("n" * 250 + ".exr")
    atomic_write(path, DATA)
    assert path.read_bytes() == DATA


@pytest.mark.parametrize("check", [lambda p: atomic_write(p, DATA), probe_writable])
def test_impossible_targets_are_named(tmp_path: Path, check) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(
        ImageWriteError, match=f"^{tmp_path}/no/a.exr: cannot be written: there is no folder {tmp_path}/no$"
    ):
        check(tmp_path / "no" / "a.exr")
    with pytest.raises(ImageWriteError, match="is not a regular file"):
        check(tmp_path)
    with pytest.raises(ImageWriteError, match="is not a regular file"):
        check("/dev/null")
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(ImageWriteError, match="cannot be written"):
        check(tmp_path / "file" / "a.exr")
    assert os.listdir(tmp_path) == ["file"]


def test_probe_leaves_nothing_behind(tmp_path: Path) -> None:
    probe_writable(tmp_path / "a.exr")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("call", ["open", "write", "fsync", "replace", "close"])
@pytest.mark.parametrize("for_ever", [False, True])
def test_fault_loop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, for_ever: bool) -> None:
    """The n-th call fails, n = 1, 2, ... until none does: the file is the old or the new one, and no litter stays."""
    path = tmp_path / "a.bin"
    real = getattr(os, call)
    for n in range(1, 20):
        path.write_bytes(b"old")
        calls = 0

        def failing(*args, n=n, **kwargs):  # type: ignore[no-untyped-def]
            nonlocal calls
            calls += 1
            if calls == n or (for_ever and calls > n):
                if call == "close":
                    real(*args, **kwargs)
                raise OSError(errno.ENOSPC, "No space left on device")
            return real(*args, **kwargs)

        monkeypatch.setattr(os, call, failing)
        error = None
        try:
            atomic_write(path, DATA)
        except ImageWriteError as raised:
            error = raised
        finally:
            monkeypatch.setattr(os, call, real)
        assert os.listdir(tmp_path) == ["a.bin"]
        if error is None:
            assert path.read_bytes() == DATA
            assert calls < n
            return
        assert path.read_bytes() in (b"old", DATA)
        assert isinstance(error, OSError)
        assert isinstance(error.__cause__, OSError)
        assert error.errno == errno.ENOSPC
        assert str(error) == f"{path}: cannot be written: No space left on device"
    pytest.fail("the faults never ended")


def test_short_writes_are_continued(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.write
    monkeypatch.setattr(os, "write", lambda descriptor, data: real(descriptor, data[:1000]))
    atomic_write(tmp_path / "a.bin", DATA)
    assert (tmp_path / "a.bin").read_bytes() == DATA


def test_an_interrupt_cleans_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        atomic_write(tmp_path / "a.bin", DATA)
    assert os.listdir(tmp_path) == []


def test_order_of_durability(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The content reaches the disk before the name, and the name before the call returns."""
    order: list[str] = []
    for name in ("write", "fsync", "replace"):
        real = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *args, name=name, real=real: (order.append(name), real(*args))[1])
    atomic_write(tmp_path / "a.bin", DATA)
    assert order == ["write", "fsync", "replace", "fsync"]
