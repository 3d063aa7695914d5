"""Renders a scene of the survey by Cycles: ``python survey_driver.py JOB.json``, in Blender's own environment.

The job is a scene as AccuRay describes it, with arrays beside it for shapes of triangles; ``image.npy`` is what comes
back, linear Rec.709.
"""

import importlib
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

SPHERE_SEGMENTS, SPHERE_RINGS = 256, 128
BOUNCES = 1024


class Stage:
    """The scene in Blender."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.bpy: Any = importlib.import_module("bpy")
        self.bpy.ops.wm.read_factory_settings(use_empty=True)
        self.job, self.scene = job, self.bpy.context.scene
        self._settings()
        self._camera()
        self._sky()
        materials = {name: self._material(name, table) for name, table in job["materials"].items()}
        for name, shape in job["shapes"].items():
            self._shape(name, shape, materials[shape["material"]])

    def render(self) -> Any:
        """The picture (H, W, 3) by way of a float EXR; Blender's rows start at the bottom."""
        path = str(Path(self.job["folder"]) / "image.exr")
        self.bpy.ops.render.render(write_still=False)
        self.bpy.data.images["Render Result"].save_render(path)
        saved = self.bpy.data.images.load(path)
        saved.colorspace_settings.name = "Linear Rec.709"
        pixels = np.empty(saved.size[0] * saved.size[1] * 4, dtype=np.float32)
        saved.pixels.foreach_get(pixels)
        return pixels.reshape(saved.size[1], saved.size[0], 4)[::-1, :, :3].copy()

    def _settings(self) -> None:
        render, cycles, film = self.scene.render, self.scene.cycles, self.job["film"]
        render.engine = "CYCLES"
        render.resolution_x, render.resolution_y, render.resolution_percentage = film["width"], film["height"], 100
        render.threads_mode, render.threads = "FIXED", self.job["threads"]
        render.use_compositing = render.use_sequencer = False
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        self.scene.view_settings.view_transform = "Raw"
        cycles.device, cycles.samples, cycles.seed = "CPU", self.job["spp"], 1
        cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_guiding = False
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
        cycles.light_sampling_threshold = 0.0
        cycles.caustics_reflective = cycles.caustics_refractive = True
        cycles.pixel_filter_type = "BOX"
        for kind in ("max", "diffuse", "glossy", "transmission"):
            setattr(cycles, f"{kind}_bounces", BOUNCES)

    def _camera(self) -> None:
        camera = self.job["camera"]
        lens = self.bpy.data.cameras.new("camera")
        lens.sensor_fit, lens.clip_start, lens.clip_end = "VERTICAL", 0.001, 100.0
        lens.angle = np.radians(camera["fov"])
        forward = np.subtract(camera["look_at"], camera["position"])
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        to_world = np.eye(4)
        to_world[:3] = np.stack([right, np.cross(right, forward), -forward, camera["position"]], axis=1)
        placed = self.bpy.data.objects.new("camera", lens)
        placed.matrix_world = to_world.T.tolist()
        self.scene.collection.objects.link(placed)
        self.scene.camera = placed

    def _sky(self) -> None:
        world = self.bpy.data.worlds.new("world")
        world.use_nodes = True
        radiance = self.job["lights"]["sky"]["radiance"]
        background = world.node_tree.nodes["Background"]
        background.inputs["Color"].default_value = (*radiance["rgb"], 1.0)
        background.inputs["Strength"].default_value = radiance["scale"]
        self.scene.world = world

    def _material(self, name: str, table: dict[str, Any]) -> Any:
        material = self.bpy.data.materials.new(name)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        if "emission" in table:
            shader = tree.nodes.new("ShaderNodeEmission")
            shader.inputs["Color"].default_value = (*table["emission"]["rgb"], 1.0)
            shader.inputs["Strength"].default_value = table["emission"]["scale"]
            material.cycles.emission_sampling = "FRONT"
        else:
            shader = getattr(self, f"_{table['type']}")(tree, table)
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
        if "transmission_color" in table:
            tree.links.new(self._absorption(tree, table).outputs[0], output.inputs["Volume"])
        return material

    def _diffuse(self, tree: Any, table: dict[str, Any]) -> Any:
        shader, reflectance = tree.nodes.new("ShaderNodeBsdfDiffuse"), table["reflectance"]
        if isinstance(reflectance, dict):
            picture = self._picture(tree, reflectance["texture"], "sRGB")
            tree.links.new(picture.outputs["Color"], shader.inputs["Color"])
        else:
            shader.inputs["Color"].default_value = (*reflectance, 1.0)
        if "normal_map" in table:
            normals = tree.nodes.new("ShaderNodeNormalMap")
            picture = self._picture(tree, table["normal_map"], "Non-Color")
            tree.links.new(picture.outputs["Color"], normals.inputs["Color"])
            tree.links.new(normals.outputs["Normal"], shader.inputs["Normal"])
        return shader

    def _conductor(self, tree: Any, table: dict[str, Any]) -> Any:
        shader = tree.nodes.new("ShaderNodeBsdfMetallic")
        shader.distribution, shader.fresnel_type = "MULTI_GGX", "PHYSICAL_CONDUCTOR"
        shader.inputs["IOR"].default_value = [table["eta"]] * 3
        shader.inputs["Extinction"].default_value = [table["k"]] * 3
        shader.inputs["Roughness"].default_value = table.get("roughness", 0.0)
        return shader

    def _dielectric(self, tree: Any, table: dict[str, Any]) -> Any:
        shader = tree.nodes.new("ShaderNodeBsdfGlass")
        shader.distribution = "MULTI_GGX"
        shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        shader.inputs["IOR"].default_value = table["ior"]
        shader.inputs["Roughness"].default_value = table.get("roughness", 0.0)
        return shader

    def _absorption(self, tree: Any, table: dict[str, Any]) -> Any:
        """Cycles' coefficient is density times 1 - colour; ours is such that the colour is left after the depth."""
        coefficients = -np.log(table["transmission_color"]) / table["transmission_depth"]
        shader = tree.nodes.new("ShaderNodeVolumeAbsorption")
        shader.inputs["Density"].default_value = coefficients.max()
        shader.inputs["Color"].default_value = (*(1.0 - coefficients / coefficients.max()), 1.0)
        return shader

    def _picture(self, tree: Any, name: str, space: str) -> Any:
        texture = self.job["textures"][name]
        node, mapping = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeMapping")
        place = tree.nodes.new("ShaderNodeUVMap")
        node.image = self.bpy.data.images.load(str(Path(self.job["textures_folder"]) / texture["file"]))
        node.image.colorspace_settings.name = space
        mapping.inputs["Scale"].default_value = (*texture["uv_scale"], 1.0)
        tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
        return node

    def _shape(self, name: str, shape: dict[str, Any], material: Any) -> None:
        if shape["type"] == "rectangle":
            corner, u, v = (np.array(shape[key], dtype=np.float32) for key in ("corner", "edge_u", "edge_v"))
            positions, faces = np.stack([corner, corner + u, corner + u + v, corner + v]), np.array([[0, 1, 2, 3]])
            self._mesh(name, material, positions, faces, None, np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32))
        elif shape["type"] == "sphere":
            directions, faces = sphere()
            positions = np.array(shape["center"]) + shape["radius"] * directions
            self._mesh(name, material, positions.astype(np.float32), faces, directions, None)
        else:
            with np.load(Path(self.job["folder"]) / f"{name}.npz") as mesh:
                self._mesh(name, material, mesh["positions"], mesh["faces"], mesh["normals"], None)

    def _mesh(self, name: str, material: Any, positions: Any, faces: Any, normals: Any, uvs: Any) -> None:
        mesh = self.bpy.data.meshes.new(name)
        mesh.from_pydata(positions.tolist(), [], faces.tolist())
        mesh.materials.append(material)
        if normals is not None:
            mesh.shade_smooth()
            mesh.normals_split_custom_set_from_vertices(normals.tolist())
        if uvs is not None:
            mesh.uv_layers.new(name="uv").data.foreach_set("uv", uvs[faces.ravel()].ravel())
        mesh.update(calc_edges=True)
        self.scene.collection.objects.link(self.bpy.data.objects.new(name, mesh))


def sphere() -> tuple[Any, Any]:
    """Unit directions (N, 3) and quads (M, 4) of a sphere; those at the poles have no area."""
    theta = np.linspace(0.0, np.pi, SPHERE_RINGS + 1)[:, None]
    phi = np.linspace(0.0, 2.0 * np.pi, SPHERE_SEGMENTS, endpoint=False)[None, :]
    grid = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.sin(phi)], axis=-1)
    ring, column = np.meshgrid(np.arange(SPHERE_RINGS), np.arange(SPHERE_SEGMENTS), indexing="ij")
    right = (column + 1) % SPHERE_SEGMENTS
    above, below = ring * SPHERE_SEGMENTS, (ring + 1) * SPHERE_SEGMENTS
    quads = np.stack([above + column, below + column, below + right, above + right], axis=-1)
    return grid.reshape(-1, 3), quads.reshape(-1, 4)


def main() -> None:
    """Reads the job and leaves the picture in its folder."""
    job = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    np.save(Path(job["folder"]) / "image.npy", Stage(job).render())


if __name__ == "__main__":
    main()
