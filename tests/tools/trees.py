"""Trees of files for the tests of this folder, and the checks of `tools/` run on them as `make lint` runs them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def check(name: str, root: Path) -> subprocess.CompletedProcess[str]:
    """Runs `tools/NAME.py` on the tree below `root`; the exit status is 0 if it finds nothing."""
    command = [sys.executable, str(REPOSITORY / "tools" / f"{name}.py"), "--root", str(root)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


def plant(root: Path, name: str, text: str) -> None:
    """Writes a file into the tree below `root`."""
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
