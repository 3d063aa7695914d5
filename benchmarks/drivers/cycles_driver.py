"""Drives Cycles through Blender's Python module."""

import importlib
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from common import Image, drive
from ply import read_ply


class Cycles:
    """Cycles with the scene in Blender; each render hands it to Cycles again.

    Blender could keep it there (``use_persistent_data``), but then it ignores a new seed or sample count.
    """

    def __init__(self, job: dict[str, Any], scene: dict[str, Any]) -> None:
        self.bpy: Any = importlib.import_module("bpy")
        self.bpy.ops.wm.read_factory_settings(use_empty=True)
        self.version = str(self.bpy.app.version_string)
        self.scene = self.bpy.context.scene
        self._settings(job, scene)
        self._camera(scene)
        materials = {name: self._material(name, scene) for name in scene["reflectances"]}
        for mesh in scene["meshes"]:
            self._mesh(Path(job["scene"]) / mesh["file"], mesh, materials[mesh["material"]])

    def render(self, spp: int, seed: int) -> float:
        self.scene.cycles.samples = spp
        self.scene.cycles.seed = seed
        if self.bpy.ops.render.render(write_still=False) != {"FINISHED"}:
            raise RuntimeError("Cycles did not finish")
        return float(spp)

    def image(self) -> Image:
        """The render result can only be saved, so it goes through a float EXR; Blender's rows start at the bottom."""
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "image.exr")
            self.write(path)
            saved = self.bpy.data.images.load(path)
            saved.colorspace_settings.name = "Linear Rec.709"
            pixels = np.empty(saved.size[0] * saved.size[1] * 4, dtype=np.float32)
            saved.pixels.foreach_get(pixels)
            image = pixels.reshape(saved.size[1], saved.size[0], 4)[::-1, :, :3].copy()
            self.bpy.data.images.remove(saved)
        return image

    def write(self, path: str) -> None:
        self.bpy.data.images["Render Result"].save_render(path)

    def _settings(self, job: dict[str, Any], scene: dict[str, Any]) -> None:
        render, cycles = self.scene.render, self.scene.cycles
        render.engine = "CYCLES"
        render.resolution_x, render.resolution_y, render.resolution_percentage = scene["width"], scene["height"], 100
        render.threads_mode, render.threads = "FIXED", job["threads"]
        render.use_compositing = render.use_sequencer = False
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        self.scene.view_settings.view_transform = "Raw"
        cycles.device = "CPU"
        cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_guiding = False
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
        cycles.light_sampling_threshold = 0.0
        cycles.pixel_filter_type = "BOX"
        cycles.min_light_bounces = scene["roulette_start"]
        for kind in ("max", "diffuse", "glossy", "transmission"):
            setattr(cycles, f"{kind}_bounces", scene["finite_depth"])

    def _camera(self, scene: dict[str, Any]) -> None:
        camera = scene["camera"]
        lens = self.bpy.data.cameras.new("camera")
        lens.sensor_fit, lens.clip_start, lens.clip_end = "HORIZONTAL", 0.001, 100.0
        lens.angle = np.radians(camera["fov"])
        forward = np.subtract(camera["look_at"], camera["position"])
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, camera["up"])
        right /= np.linalg.norm(right)
        to_world = np.eye(4)
        to_world[:3] = np.stack([right, np.cross(right, forward), -forward, camera["position"]], axis=1)
        placed = self.bpy.data.objects.new("camera", lens)
        placed.matrix_world = to_world.T.tolist()
        self.scene.collection.objects.link(placed)
        self.scene.camera = placed

    def _material(self, name: str, scene: dict[str, Any]) -> Any:
        """A diffuse material; the emitter's adds its emission."""
        material = self.bpy.data.materials.new(name)
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = (*scene["reflectances"][name]["rgb"], 1.0)
        surface = diffuse.outputs[0]
        if name == scene["emitter"]:
            emission, add = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
            peak = max(scene["emission"]["rgb"])
            emission.inputs["Color"].default_value = (*(value / peak for value in scene["emission"]["rgb"]), 1.0)
            emission.inputs["Strength"].default_value = peak
            links.new(surface, add.inputs[0])
            links.new(emission.outputs[0], add.inputs[1])
            surface = add.outputs[0]
            material.cycles.emission_sampling = "FRONT"
        links.new(surface, output.inputs["Surface"])
        return material

    def _mesh(self, path: Path, description: dict[str, Any], material: Any) -> None:
        vertices, triangles = read_ply(path)
        mesh = self.bpy.data.meshes.new(description["name"])
        mesh.vertices.add(len(vertices))
        mesh.vertices.foreach_set("co", np.ascontiguousarray(vertices[:, :3]).ravel())
        mesh.loops.add(triangles.size)
        mesh.loops.foreach_set("vertex_index", triangles.ravel())
        mesh.polygons.add(len(triangles))
        mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
        mesh.materials.append(material)
        mesh.update(calc_edges=True)
        if description["smooth"]:
            mesh.shade_smooth()
            mesh.normals_split_custom_set_from_vertices(vertices[:, 3:6].tolist())
            uvs = mesh.uv_layers.new(name="uv")
            uvs.data.foreach_set("uv", vertices[triangles.ravel(), 6:8].ravel())
        else:
            mesh.shade_flat()
        self.scene.collection.objects.link(self.bpy.data.objects.new(description["name"], mesh))


if __name__ == "__main__":
    drive(Cycles)
