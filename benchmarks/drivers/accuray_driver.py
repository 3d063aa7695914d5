"""Drives AccuRay through its public Python interface."""

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from common import Image, drive


class AccuRay:
    """AccuRay with the scene read and validated; each render prepares it for tracing again."""

    def __init__(self, job: dict[str, Any], _scene: dict[str, Any]) -> None:
        self.accuray: Any = importlib.import_module("accuray")
        self.version = str(self.accuray.__version__)
        self.threads = job["threads"]
        self.scene = self.accuray.load(str(Path(job["scene"]) / "scene.toml"))
        self.pixels: Any = None

    def render(self, spp: int, seed: int) -> float:
        self.pixels = self.accuray.render(self.scene, spp=spp, seed=seed, threads=self.threads)
        return float(spp)

    def image(self) -> Image:
        return np.asarray(self.pixels, dtype=np.float32)

    def write(self, path: str) -> None:
        self.pixels.save(path)


if __name__ == "__main__":
    drive(AccuRay)
