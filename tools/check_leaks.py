#!/usr/bin/env python3
"""Checks that no committed file names a folder of the machine it was written on, or the host of a package registry.

Such a name works for one person and breaks for the next; which registry to use is a setting of the user's tools.
(Letters in brackets keep the patterns below from finding themselves.)
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from source_tree import Violation, run_check

PATTERNS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"(?<![\w.*])/(?:w[o]rk|r[o]ot|h[o]me|U[s]ers)/[\w.][^\s\"'`)]*"), "a path of one machine"),
    (re.compile(r"(?<![\w.])/tmp/b[a]sh_\w+"), "a path of one machine"),
    (
        re.compile(r"\b(?:py[p]i\.org|pythonh[o]sted\.org|registry\.n[p]mjs\.org|an[a]conda\.org|cr[a]tes\.io)\b"),
        "the host of a package registry",
    ),
)
# Text that is not ours to phrase.
EXEMPT = frozenset({"LICENSE"})


def committed_files(root: Path) -> list[Path]:
    """The files that git tracks or would add below `root`; every file where `root` is no repository."""
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listing = subprocess.run(command, capture_output=True, check=False)
    if listing.returncode != 0:
        return sorted(path for path in root.rglob("*") if path.is_file())
    names = listing.stdout.decode("utf-8", errors="surrogateescape").split("\0")
    return [root / name for name in names if name and (root / name).is_file()]


def check_leaks(root: Path) -> Iterator[Violation]:
    """Yields each line of a committed text file that matches a pattern."""
    for path in committed_files(root):
        content = path.read_bytes()
        if path.name in EXEMPT or b"\0" in content[:4096]:
            continue
        for number, line in enumerate(content.decode("utf-8", errors="replace").splitlines(), start=1):
            for pattern, what in PATTERNS:
                if match := pattern.search(line):
                    yield Violation(path.relative_to(root).as_posix(), number, f"{match.group()}: {what}")


if __name__ == "__main__":
    sys.exit(run_check("Checks that no committed file names this machine or a package registry.", check_leaks))
