"""Renders a scene of the survey by Cycles: ``python survey_driver.py JOB.json``, in Blender's own environment.

The job is a scene as AccuRay describes it, with arrays beside it for shapes of triangles; ``image.npy`` is what comes
back, linear Rec.709.
"""

import importlib
import json
import sys
from pathlib import Path
from typing import Any

import blender
import numpy as np

SPHERE_SEGMENTS, SPHERE_RINGS = 256, 128
BOUNCES = 1024


class Stage:
    """The scene in Blender."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.bpy: Any = importlib.import_module("bpy")
        self.bpy.ops.wm.read_factory_settings(use_empty=True)
        self.job, self.scene = job, self.bpy.context.scene
        film = self.job["film"]
        blender.configure(self.scene, film["width"], film["height"], job["threads"], BOUNCES)
        self.scene.cycles.samples, self.scene.cycles.seed = job["spp"], 1
        blender.place_camera(self.bpy, self.scene, job["camera"], "VERTICAL")
        self._sky()
        materials = {name: self._material(name, table) for name, table in job["materials"].items()}
        for name, shape in job["shapes"].items():
            self._shape(name, shape, materials[shape["material"]])

    def render(self) -> Any:
        """The picture, linear Rec.709 (H, W, 3)."""
        self.bpy.ops.render.render(write_still=False)
        return blender.read_result(self.bpy, Path(self.job["folder"]))

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
            shader = blender.emission(tree, material, table["emission"]["rgb"], table["emission"]["scale"])
        else:
            shader = getattr(self, f"_{table['type']}")(tree, table)
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
        if "transmission_color" in table:
            tree.links.new(self._absorption(tree, table).outputs[0], output.inputs["Volume"])
        return material

    def _diffuse(self, tree: Any, table: dict[str, Any]) -> Any:
        reflectance = table["reflectance"]
        textured = isinstance(reflectance, dict)
        shader = blender.diffuse(tree, None if textured else reflectance)
        if textured:
            picture = self._picture(tree, reflectance["texture"], "sRGB")
            tree.links.new(picture.outputs["Color"], shader.inputs["Color"])
        if "normal_map" in table:
            normals = tree.nodes.new("ShaderNodeNormalMap")
            picture = self._picture(tree, table["normal_map"], "Non-Color")
            tree.links.new(picture.outputs["Color"], normals.inputs["Color"])
            tree.links.new(normals.outputs["Normal"], shader.inputs["Normal"])
        return shader

    def _conductor(self, tree: Any, table: dict[str, Any]) -> Any:
        return blender.metal(tree, table["eta"], table["k"], table.get("roughness", 0.0), "MULTI_GGX")

    def _dielectric(self, tree: Any, table: dict[str, Any]) -> Any:
        return blender.glass(tree, table["ior"], table.get("roughness", 0.0), "MULTI_GGX")

    def _absorption(self, tree: Any, table: dict[str, Any]) -> Any:
        """Cycles' coefficient is density times 1 - colour; ours is such that the colour is left after the depth."""
        coefficients = -np.log(table["transmission_color"]) / table["transmission_depth"]
        shader = tree.nodes.new("ShaderNodeVolumeAbsorption")
        shader.inputs["Density"].default_value = coefficients.max()
        shader.inputs["Color"].default_value = (*(1.0 - coefficients / coefficients.max()), 1.0)
        return shader

    def _picture(self, tree: Any, name: str, space: str) -> Any:
        texture = self.job["textures"][name]
        path = Path(self.job["textures_folder"]) / texture["file"]
        return blender.picture(self.bpy, tree, path, space, tuple(texture["uv_scale"]))

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
