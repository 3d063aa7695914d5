"""What the drivers of Cycles share: settings for a fair comparison, camera, shader nodes, the way back."""

from pathlib import Path
from typing import Any

import numpy as np

SCENE_LINEAR = "Linear Rec.709"


def configure(scene: Any, width: int, height: int, threads: int, depth: int) -> None:
    """Path tracing on the processor with nothing that trades truth for looks; box filter; ``depth`` bounces."""
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.threads_mode, render.threads = "FIXED", threads
    render.use_compositing = render.use_sequencer = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    cycles.device = "CPU"
    cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_guiding = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", depth)


def place_camera(bpy: Any, scene: Any, camera: dict[str, Any], fit: str) -> None:
    """A perspective camera; ``fov`` in degrees along ``fit``, HORIZONTAL or VERTICAL."""
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.clip_start, lens.clip_end = fit, 0.001, 100.0
    lens.angle = np.radians(camera["fov"])
    forward = np.subtract(camera["look_at"], camera["position"])
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.get("up", [0.0, 1.0, 0.0]))
    right /= np.linalg.norm(right)
    to_world = np.eye(4)
    to_world[:3] = np.stack([right, np.cross(right, forward), -forward, camera["position"]], axis=1)
    placed = bpy.data.objects.new("camera", lens)
    placed.matrix_world = to_world.T.tolist()
    scene.collection.objects.link(placed)
    scene.camera = placed


def save_result(bpy: Any, path: Path) -> None:
    """The last render as OpenEXR: Blender can only save it."""
    bpy.data.images["Render Result"].save_render(str(path))


def read_result(bpy: Any, folder: Path) -> Any:
    """The last render, linear Rec.709 (H, W, 3), by way of a float EXR in ``folder``; Blender's rows start below."""
    path = folder / "image.exr"
    save_result(bpy, path)
    saved = bpy.data.images.load(str(path))
    saved.colorspace_settings.name = SCENE_LINEAR
    pixels = np.empty(saved.size[0] * saved.size[1] * 4, dtype=np.float32)
    saved.pixels.foreach_get(pixels)
    image = pixels.reshape(saved.size[1], saved.size[0], 4)[::-1, :, :3].copy()
    bpy.data.images.remove(saved)
    return image


def diffuse(tree: Any, rgb: list[float] | None) -> Any:
    """Lambert's law; None leaves the colour to a picture."""
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    if rgb is not None:
        shader.inputs["Color"].default_value = (*rgb, 1.0)
    return shader


def metal(tree: Any, eta: float, k: float, roughness: float, facets: str) -> Any:
    """The same eta and k for every colour. ``facets``: MULTI_GGX with compensation, or GGX without."""
    shader = tree.nodes.new("ShaderNodeBsdfMetallic")
    shader.distribution, shader.fresnel_type = facets, "PHYSICAL_CONDUCTOR"
    shader.inputs["IOR"].default_value = [eta] * 3
    shader.inputs["Extinction"].default_value = [k] * 3
    shader.inputs["Roughness"].default_value = roughness
    return shader


def glass(tree: Any, ior: float, roughness: float, facets: str) -> Any:
    """Reflection and refraction without tint; ``facets`` as for ``metal``."""
    shader = tree.nodes.new("ShaderNodeBsdfGlass")
    shader.distribution = facets
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    shader.inputs["IOR"].default_value = ior
    shader.inputs["Roughness"].default_value = roughness
    return shader


def emission(tree: Any, material: Any, rgb: list[float], strength: float) -> Any:
    """Light of the front side."""
    shader = tree.nodes.new("ShaderNodeEmission")
    shader.inputs["Color"].default_value = (*rgb, 1.0)
    shader.inputs["Strength"].default_value = strength
    material.cycles.emission_sampling = "FRONT"
    return shader


def front_only(tree: Any, shader: Any) -> Any:
    """The shader in front, nothing on the back."""
    side, mix = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(side.outputs["Backfacing"], mix.inputs["Fac"])
    tree.links.new(shader.outputs[0], mix.inputs[1])
    return mix


def surroundings(bpy: Any, scene: Any, path: Path) -> None:
    """A map with its middle at -Z, its right half towards +X and its top at +Y; sampled at its own resolution.

    Blender has the middle at +X, the right half towards -Y and the top at +Z.
    """
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    tree = world.node_tree
    picture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    place = tree.nodes.new("ShaderNodeTexCoord")
    picture.image = bpy.data.images.load(str(path))
    picture.image.colorspace_settings.name = SCENE_LINEAR
    mapping.vector_type = "VECTOR"
    mapping.inputs["Rotation"].default_value = ROTATION_TO_BLENDER
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", picture.image.size[0]
    scene.world = world


ROTATION_TO_BLENDER = (np.pi / 2, 0.0, -np.pi / 2)
"""Euler angles XYZ that turn (x, y, z) into (-z, -x, y)."""


def picture(bpy: Any, tree: Any, path: Path, space: str, scale: tuple[float, float] = (1.0, 1.0)) -> Any:
    """An image file over the surface's coordinates times ``scale``; ``space`` is Blender's name, such as sRGB."""
    node, mapping = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeMapping")
    place = tree.nodes.new("ShaderNodeUVMap")
    node.image = bpy.data.images.load(str(path))
    node.image.colorspace_settings.name = space
    mapping.inputs["Scale"].default_value = (*scale, 1.0)
    tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    return node
