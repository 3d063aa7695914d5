"""How much memory there is: what takes more is refused before it is allocated."""

from __future__ import annotations

from pathlib import Path

MEMINFO = Path("/proc/meminfo")
CGROUPS = Path("/proc/self/cgroup")
CGROUP_ROOT = Path("/sys/fs/cgroup")
UNLIMITED = 1 << 62
"""Limits from here on, and the memory where the system does not tell."""


def available_bytes() -> int:
    """Bytes that this process may still allocate: what the system has to give, or less where its control group says so.

    Memory that files occupy in caches counts as free. Without the files of Linux there is no limit.
    """
    return max(min(_system_bytes(), *_group_bytes()), 0)


def check_fits(needed: int, what: str) -> None:
    """ValueError with the estimate if ``needed`` bytes, of ``what``, are more than there are."""
    free = available_bytes()
    if needed > free:
        raise ValueError(f"{what} would take {readable(needed)}: allowed are the {readable(free)} that are free")


def readable(size: int) -> str:
    """A number of bytes in the largest unit that leaves it at least 1; whole numbers of any size."""
    units = ("B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB")
    step = min(max(size.bit_length() - 1, 0) // 10, len(units) - 1)
    tenths = size * 10 >> 10 * step
    return f"{tenths // 10}.{tenths % 10} {units[step]}" if step else f"{size} B"


def _system_bytes() -> int:
    for line in _lines(MEMINFO):
        name, _, value = line.partition(":")
        if name == "MemAvailable":
            return int(value.split()[0]) << 10
    return UNLIMITED


def _group_bytes() -> list[int]:
    """What is left in each control group that this process is in, of version 1 or 2."""
    left = [UNLIMITED]
    for line in _lines(CGROUPS):
        _, controllers, path = line.split(":", 2)
        if controllers == "":
            left += _left(CGROUP_ROOT, path, "memory.max", "memory.current", "inactive_file")
        elif "memory" in controllers.split(","):
            names = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
            left += _left(CGROUP_ROOT / "memory", path, *names)
    return left


def _left(root: Path, path: str, limit: str, usage: str, cache: str) -> list[int]:
    """The limit less the usage, but for caches, of a group and all above it; inside a container its own is the root."""
    below = root / path.lstrip("/")
    folders = [root, *(folder for folder in (below, *below.parents) if root in folder.parents)]
    left = []
    for folder in folders:
        most, used = _number(folder / limit), _number(folder / usage)
        if most is not None and used is not None:
            caches = (line.split() for line in _lines(folder / "memory.stat"))
            cached = sum(int(words[1]) for words in caches if words[0] == cache)
            left.append(most - used + cached)
    return left


def _number(path: Path) -> int | None:
    """The number in a file; None if there is none, such as the `max` of a group without a limit."""
    text = "".join(_lines(path)).strip()
    return int(text) if text.isdigit() else None


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="ascii").splitlines()
    except (OSError, ValueError):
        return []
