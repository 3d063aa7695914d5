"""Drives Mitsuba 3. ``variant`` and ``sampler`` of the job are Mitsuba's names."""

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from common import Image, drive


class Mitsuba:
    """Mitsuba with the scene loaded; ``render`` waits for the pixels."""

    def __init__(self, job: dict[str, Any], scene: dict[str, Any]) -> None:
        self.drjit: Any = importlib.import_module("drjit")
        self.mitsuba: Any = importlib.import_module("mitsuba")
        self.mitsuba.set_variant(job["variant"])
        self.drjit.set_thread_count(job["threads"])
        self.spectral = "spectral" in job["variant"]
        self.version = f"{self.mitsuba.__version__} {job['variant']} {job['sampler']}"
        self.scene = self.mitsuba.load_dict(self._description(job, scene))
        self.pixels: Any = None

    def render(self, spp: int, seed: int) -> float:
        self.pixels = self.mitsuba.render(self.scene, spp=spp, seed=seed)
        self.drjit.eval(self.pixels)
        self.drjit.sync_thread()
        return float(self.scene.sensors()[0].sampler().sample_count())

    def image(self) -> Image:
        return np.array(self.pixels, dtype=np.float32)[:, :, :3]

    def write(self, path: str) -> None:
        self.mitsuba.util.write_bitmap(path, self.pixels, write_async=False)

    def _description(self, job: dict[str, Any], scene: dict[str, Any]) -> dict[str, Any]:
        folder = Path(job["scene"])
        materials = {name: self._bsdf(folder, table) for name, table in scene["materials"].items()}
        shapes: dict[str, Any] = {}
        for mesh in scene["meshes"]:
            shape: dict[str, Any] = {
                "type": "ply",
                "filename": str(folder / mesh["file"]),
                "face_normals": not mesh["smooth"],
                "bsdf": materials[mesh["material"]],
            }
            if mesh["material"] == scene["emitter"]:
                shape["emitter"] = {"type": "area", "radiance": self._spectrum(scene["emission"])}
            if mesh["copies"]:
                shapes[f"{mesh['name']}-group"] = {"type": "shapegroup", mesh["name"]: shape}
                shapes |= self._copies(mesh["name"], np.load(folder / mesh["copies"]))
            else:
                shapes[mesh["name"]] = shape
        if scene["sky"]:
            shapes["sky"] = self._sky(folder / scene["sky"]["from_pole_to_pole"])
        integrator = {"type": "path", "max_depth": -1, "rr_depth": scene["roulette_start"]}
        return {"type": "scene", "integrator": integrator, "sensor": self._sensor(job, scene), **shapes}

    def _copies(self, name: str, transforms: Any) -> dict[str, Any]:
        """An instance of the group for each of the transforms (N, 3, 4)."""
        last = np.array([[0.0, 0.0, 0.0, 1.0]])
        return {
            f"{name}-{number}": {
                "type": "instance",
                "group": {"type": "ref", "id": f"{name}-group"},
                "to_world": self.mitsuba.ScalarTransform4f(np.vstack([rows, last])),
            }
            for number, rows in enumerate(transforms)
        }

    def _sky(self, path: Path) -> dict[str, Any]:
        """Mitsuba has the middle of a map at +Z, the scenes have it at -Z."""
        turned = self.mitsuba.ScalarTransform4f().rotate([0, 1, 0], 180)
        return {"type": "envmap", "filename": str(path), "to_world": turned}

    def _bsdf(self, folder: Path, table: dict[str, Any]) -> dict[str, Any]:
        """Mitsuba's roughness, alpha, is the square of the perceived one."""
        rough = {"distribution": "ggx", "alpha": table["roughness"] ** 2}
        if table["kind"] == "conductor":
            return {"type": "roughconductor", "eta": table["eta"], "k": table["k"], **rough}
        if table["kind"] == "dielectric":
            return {"type": "roughdielectric", "int_ior": table["eta"], "ext_ior": 1.0, **rough}
        if table["picture"]:
            reflectance: dict[str, Any] = {"type": "bitmap", "filename": str(folder / table["picture"])}
        else:
            reflectance = self._spectrum(table["reflectance"])
        return {"type": "diffuse", "reflectance": reflectance}

    def _sensor(self, job: dict[str, Any], scene: dict[str, Any]) -> dict[str, Any]:
        camera = scene["camera"]
        to_world = self.mitsuba.ScalarTransform4f().look_at(
            origin=camera["position"], target=camera["look_at"], up=camera["up"]
        )
        film = {
            "type": "hdrfilm",
            "width": scene["width"],
            "height": scene["height"],
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        }
        sampler = {"type": job["sampler"], "sample_count": job["passes"][0]["spp"]}
        field = {"fov": camera["fov"], "fov_axis": "x", "near_clip": 0.001, "far_clip": 100.0}
        return {"type": "perspective", "to_world": to_world, "film": film, "sampler": sampler, **field}

    def _spectrum(self, spectrum: dict[str, Any]) -> dict[str, Any]:
        """The measured table (Mitsuba has 0 outside it), a plain number for a flat one, or the RGB."""
        if not self.spectral:
            return {"type": "rgb", "value": list(spectrum["rgb"])}
        if len(set(spectrum["values"])) == 1:
            return {"type": "uniform", "value": spectrum["values"][0]}
        return {"type": "spectrum", "value": list(zip(spectrum["wavelengths"], spectrum["values"], strict=True))}


if __name__ == "__main__":
    drive(Mitsuba)
