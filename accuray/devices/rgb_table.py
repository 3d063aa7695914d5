"""The table that turns RGB colours into reflectance spectra: built on first use, then read from the cache."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from accuray import data
from accuray.film.files import atomic_write

SHA256 = "c8bef704234195e9ce0f764f394217313f5250dd05ed966a1204864d3e430bde"
"""Of the coefficients' bytes: the same on every machine, because the builder uses no libm (`src/lower/rgb_table.h`)."""


def cache_folder() -> Path:
    """Where tables are kept: ACCURAY_CACHE_DIR, else accuray below XDG_CACHE_HOME or ~/.cache."""
    own = os.environ.get("ACCURAY_CACHE_DIR")
    if own:
        return Path(own)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "accuray"


def rgb_table(cmf: NDArray[np.float64]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Nodes of the largest component (n,) and sigmoid coefficients, flat, for ``SceneBuilder.set_rgb_table``.

    A cached file counts only if its checksum is right. A cache that cannot be written costs a second next time.
    """
    from accuray._core import lower as core

    n = core.RGB_TABLE_NODES
    nodes: NDArray[np.float32] = core.rgb_table_nodes(n)
    path = cache_folder() / f"rgb-{n}-{SHA256[:16]}.f32"
    content = _read(path)
    if content is None:
        table: NDArray[np.float32] = core.build_rgb_table(n, cmf, _d65(), os.cpu_count() or 1)
        content = table.tobytes()
        _check(content)
        _write(path, content)
    return nodes, np.frombuffer(content, dtype=np.float32)


def _d65() -> NDArray[np.float64]:
    """D65 as tabulated, 360, 365, ... 830 nm."""
    points, values = data.illuminants()["D65"]
    return np.array([v for w, v in zip(points, values, strict=True) if 360.0 <= w <= 830.0])


def _read(path: Path) -> bytes | None:
    try:
        content = path.read_bytes()
    except OSError:
        return None
    return content if hashlib.sha256(content).hexdigest() == SHA256 else None


def _write(path: Path, content: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        atomic_write(path, content)
    except OSError:
        return


def _check(content: bytes) -> None:
    found = hashlib.sha256(content).hexdigest()
    if found != SHA256:
        raise RuntimeError(f"the RGB table built here has the checksum {found}, not {SHA256}: this build is not exact")
