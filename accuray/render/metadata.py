"""What an image says about its making."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from accuray.scene import Scene
from accuray.scene import schema as schemas
from accuray.scene.spectrum import xyz
from accuray.version import __version__


def image_metadata(
    scene: Scene, *, seed: int, seconds: float, rays: int, reports: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    """Plain values for ``Image.metadata``: what identifies the samples, and what develops them."""
    from accuray._core import engine

    white = scene.film["white_balance"]
    metadata: dict[str, Any] = {
        "version": __version__,
        "scene_hash": scene.identity,
        "sampling_version": schemas.current().sampling_version,
        "seed": seed,
        "isa": engine.ISA,
        "cpu_vendor": cpu_vendor(),
        "exposure": scene.film["exposure"],
        "white_balance": None if white is None else list(xyz(white)),
        "hide_environment": scene.film["hide_environment"],
        "render_seconds": seconds,
        "rays": rays,
    }
    if reports:
        metadata["mesh_reports"] = reports
    return metadata


@cache
def cpu_vendor() -> str:
    """The processor's maker as it names itself; "unknown" where the system does not tell."""
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8") as lines:
            return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("vendor_id")), "unknown")
    except OSError:
        return "unknown"
