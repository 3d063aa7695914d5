"""Drives Cycles through Blender's Python module."""

import importlib
import tempfile
from pathlib import Path
from typing import Any

import blender
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
        blender.configure(self.scene, scene["width"], scene["height"], job["threads"], scene["finite_depth"])
        self.scene.cycles.min_light_bounces = scene["roulette_start"]
        blender.place_camera(self.bpy, self.scene, scene["camera"], "HORIZONTAL")
        folder = Path(job["scene"])
        materials = {name: self._material(folder, name, scene) for name in scene["materials"]}
        for mesh in scene["meshes"]:
            self._mesh(folder, mesh, materials[mesh["material"]])
        if scene["sky"]:
            blender.surroundings(self.bpy, self.scene, folder / scene["sky"]["file"])

    def render(self, spp: int, seed: int) -> float:
        self.scene.cycles.samples = spp
        self.scene.cycles.seed = seed
        if self.bpy.ops.render.render(write_still=False) != {"FINISHED"}:
            raise RuntimeError("Cycles did not finish")
        return float(spp)

    def image(self) -> Image:
        with tempfile.TemporaryDirectory() as folder:
            image: Image = blender.read_result(self.bpy, Path(folder))
        return image

    def write(self, path: str) -> None:
        blender.save_result(self.bpy, Path(path))

    def _material(self, folder: Path, name: str, scene: dict[str, Any]) -> Any:
        """One of the scene's materials; the emitter's adds its emission."""
        material, table = self.bpy.data.materials.new(name), scene["materials"][name]
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        surface = self._surface(tree, folder, table).outputs[0]
        if name == scene["emitter"]:
            add, peak = tree.nodes.new("ShaderNodeAddShader"), max(scene["emission"]["rgb"])
            emission = blender.emission(tree, material, [value / peak for value in scene["emission"]["rgb"]], peak)
            light = blender.front_only(tree, emission) if scene["lamp_backs"] else emission
            tree.links.new(surface, add.inputs[0])
            tree.links.new(light.outputs[0], add.inputs[1])
            surface = add.outputs[0]
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(surface, output.inputs["Surface"])
        return material

    def _surface(self, tree: Any, folder: Path, table: dict[str, Any]) -> Any:
        if table["kind"] == "conductor":
            return blender.metal(tree, table["eta"], table["k"], table["roughness"], "GGX")
        if table["kind"] == "dielectric":
            return blender.glass(tree, table["eta"], table["roughness"], "GGX")
        if not table["picture"]:
            return blender.diffuse(tree, table["reflectance"]["rgb"])
        shader = blender.diffuse(tree, None)
        picture = blender.picture(self.bpy, tree, folder / table["picture"], "sRGB")
        tree.links.new(picture.outputs["Color"], shader.inputs["Color"])
        return shader

    def _mesh(self, folder: Path, description: dict[str, Any], material: Any) -> None:
        """The mesh, shown where it lies or by its copies."""
        vertices, triangles = read_ply(folder / description["file"])
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
        transforms = np.load(folder / description["copies"]) if description["copies"] else np.eye(4)[None, :3]
        for rows in transforms:
            shown = self.bpy.data.objects.new(description["name"], mesh)
            shown.matrix_world = np.vstack([rows, [0.0, 0.0, 0.0, 1.0]]).T.tolist()
            self.scene.collection.objects.link(shown)


if __name__ == "__main__":
    drive(Cycles)
