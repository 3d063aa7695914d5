"""What an image says about its making."""

from __future__ import annotations

from typing import Any

from accuray import devices
from accuray.data.version import __version__
from accuray.scene import Scene
from accuray.scene import schema as schemas
from accuray.scene.spectrum import xyz


def image_metadata(
    scene: Scene, *, seed: int, seconds: float, rays: int, reports: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    """Plain values for ``Image.metadata``: what identifies the samples, and what develops them."""
    build = devices.build_info()
    white = scene.film["white_balance"]
    metadata: dict[str, Any] = {
        "version": __version__,
        "scene_hash": scene.identity,
        "sampling_version": schemas.current().sampling_version,
        "seed": seed,
        "isa": build["isa"],
        "cpu_vendor": build["cpu_vendor"],
        "exposure": scene.film["exposure"],
        "white_balance": None if white is None else list(xyz(white)),
        "hide_environment": scene.film["hide_environment"],
        "render_seconds": seconds,
        "rays": rays,
    }
    if reports:
        metadata["mesh_reports"] = reports
    return metadata
