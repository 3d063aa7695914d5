"""Drives LuxCore's path tracer for processors."""

import importlib
import time
from pathlib import Path
from typing import Any

import numpy as np
from common import Image, drive

POLL_S = 0.002


class LuxCore:
    """LuxCore with the scene loaded; every render is a new session, which prepares the scene again."""

    def __init__(self, job: dict[str, Any], scene: dict[str, Any]) -> None:
        self.lux: Any = importlib.import_module("pyluxcore")
        self.lux.Init(lambda _message: None)
        self.version = str(self.lux.Version())
        self.job, self.description = job, scene
        self.scene = self.lux.Scene()
        self.scene.Parse(self._properties(self._camera() | self._materials() | self._shapes()))
        self.session: Any = None

    def render(self, spp: int, seed: int) -> float:
        config = self.lux.RenderConfig(self._properties(self._settings(spp, seed)), self.scene)
        self.session = self.lux.RenderSession(config)
        self.session.Start()
        while not self.session.HasDone():
            time.sleep(POLL_S)
            self.session.UpdateStats()
        self.session.Stop()
        self.session.UpdateStats()
        samples = float(self.session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat())
        return samples / float(self.description["width"] * self.description["height"])

    def image(self) -> Image:
        """The raw film; its rows start at the bottom, and the picture lies one row lower than the other renderers'."""
        height, width = self.description["height"], self.description["width"]
        pixels = np.empty((height, width, 3), dtype=np.float32)
        self.session.GetFilm().GetOutputFloat(self.lux.FilmOutputType.RGB, pixels)
        return pixels[::-1].copy()

    def write(self, path: str) -> None:
        self.session.GetFilm().SaveOutput(path, self.lux.FilmOutputType.RGB, self._properties({}))

    def _settings(self, spp: int, seed: int) -> dict[str, Any]:
        depth = self.description["finite_depth"]
        return {
            "renderengine.type": "PATHCPU",
            "renderengine.seed": seed + 1,
            "native.threads.count": self.job["threads"],
            "batch.haltspp": spp,
            "sampler.type": "SOBOL",
            "sampler.sobol.adaptive.strength": 0.0,
            "film.width": self.description["width"],
            "film.height": self.description["height"],
            "film.filter.type": "BOX",
            "film.filter.xwidth": 0.5,
            "film.filter.ywidth": 0.5,
            "film.noiseestimation.warmup": 1 << 30,
            "path.pathdepth.total": depth,
            "path.pathdepth.diffuse": depth,
            "path.pathdepth.glossy": depth,
            "path.pathdepth.specular": depth,
            "path.russianroulette.depth": self.description["roulette_start"],
            "path.clamping.variance.maxvalue": 0.0,
            "path.hybridbackforward.enable": False,
        }

    def _camera(self) -> dict[str, Any]:
        camera = self.description["camera"]
        return {
            "scene.camera.type": "perspective",
            "scene.camera.lookat.orig": camera["position"],
            "scene.camera.lookat.target": camera["look_at"],
            "scene.camera.up": camera["up"],
            "scene.camera.fieldofview": camera["fov"],
            "scene.camera.screenwindow": [-1.0, 1.0, -1.0, 1.0],
            "scene.camera.cliphither": 0.001,
            "scene.camera.clipyon": 100.0,
        }

    def _materials(self) -> dict[str, Any]:
        properties: dict[str, Any] = {}
        for name, table in self.description["materials"].items():
            if table["kind"] != "diffuse" or table["picture"]:
                raise ValueError(f"material {name}: this driver knows plain diffuse ones only")
            properties[f"scene.materials.{name}.type"] = "matte"
            properties[f"scene.materials.{name}.kd"] = table["reflectance"]["rgb"]
        properties[f"scene.materials.{self.description['emitter']}.emission"] = self.description["emission"]["rgb"]
        return properties

    def _shapes(self) -> dict[str, Any]:
        properties: dict[str, Any] = {}
        for mesh in self.description["meshes"]:
            name = mesh["name"]
            properties[f"scene.shapes.{name}.type"] = "mesh"
            properties[f"scene.shapes.{name}.ply"] = str(Path(self.job["scene"]) / mesh["file"])
            properties[f"scene.objects.{name}.shape"] = name
            properties[f"scene.objects.{name}.material"] = mesh["material"]
        return properties

    def _properties(self, values: dict[str, Any]) -> Any:
        properties = self.lux.Properties()
        for key, value in values.items():
            properties.Set(self.lux.Property(key, list(value) if isinstance(value, list | tuple) else value))
        return properties


if __name__ == "__main__":
    drive(LuxCore)
