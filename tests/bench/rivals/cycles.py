"""Renders a candela scene with Cycles, Blender 3.4's path tracer:

    blender -b --factory-startup -P cycles.py -- SCENE OUT.exr WIDTH SPP MAX_DEPTH SEED THREADS

Renders with one sample per pixel, twice, and then with SPP, and writes the last picture. Its last line is JSON: CPU
time and wall time [s] of the second rendering and of the last, each with preparing the scene.
"""

import json
import math
import resource
import sys
import time
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))

import scene_file  # noqa: E402 (needs the path)


class ToBlender:
    """World space, from candela's axes to Blender's: +Z is up, and the middle of a sky's image lies towards +X. The
    sky cannot be turned, so the world turns the other way."""

    def __init__(self, sky_rotation):
        axes = Matrix(((0, 0, -1), (-1, 0, 0), (0, 1, 0)))
        self.turn = axes @ Matrix.Rotation(math.radians(-sky_rotation), 3, "Y")

    def __call__(self, v):
        return self.turn @ Vector(v)


# --- Materials -------------------------------------------------------------------------------------------------------


def node_material(name, build):
    """A material whose surface is the output of the node that build(nodes, links) returns."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(build(nodes, links).outputs[0], output.inputs["Surface"])
    return material


def diffuse(material):
    def build(nodes, links):
        node = nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (*material["reflectance"], 1)
        return node

    return build


def dielectric(material):
    assert material["fresnel"] == "exact", "Cycles knows Fresnel's equations alone"

    def build(nodes, links):
        node = nodes.new("ShaderNodeBsdfGlass")
        node.distribution = "SHARP"
        node.inputs["Color"].default_value = (1, 1, 1, 1)
        node.inputs["IOR"].default_value = material["ior"]
        return node

    return build


def conductor(material):
    """GGX with Schlick's Fresnel term, but at the angle to the shading normal instead of to the facet's: Cycles' node
    has none of its own. Cycles multiplies the shadowing of both directions, as if they were independent."""

    def build(nodes, links):
        node = nodes.new("ShaderNodeBsdfGlossy")
        node.distribution = "GGX"
        node.inputs["Roughness"].default_value = math.sqrt(material["alpha"])
        facing = nodes.new("ShaderNodeLayerWeight")  # 1 - cosine, where "blend" is a half.
        facing.inputs["Blend"].default_value = 0.5
        power = nodes.new("ShaderNodeMath")
        power.operation = "POWER"
        power.inputs[1].default_value = 5
        mix = nodes.new("ShaderNodeMixRGB")
        mix.inputs["Color1"].default_value = (*material["reflectance"], 1)
        mix.inputs["Color2"].default_value = (1, 1, 1, 1)
        links.new(facing.outputs["Facing"], power.inputs[0])
        links.new(power.outputs[0], mix.inputs["Fac"])
        links.new(mix.outputs[0], node.inputs["Color"])
        return node

    return build


def emission(radiance):
    """Light from the front side alone."""

    def build(nodes, links):
        node = nodes.new("ShaderNodeEmission")
        node.inputs["Color"].default_value = (*radiance, 1)
        geometry = nodes.new("ShaderNodeNewGeometry")
        front = nodes.new("ShaderNodeMath")
        front.operation = "SUBTRACT"
        front.inputs[0].default_value = 1
        links.new(geometry.outputs["Backfacing"], front.inputs[1])
        links.new(front.outputs[0], node.inputs["Strength"])
        return node

    return build


MODELS = {"diffuse": diffuse, "dielectric": dielectric, "conductor": conductor}


# --- Scene -----------------------------------------------------------------------------------------------------------


def add_shapes(scene, folder, to_blender):
    materials = {name: node_material(name, MODELS[m["type"]](m)) for name, m in scene["materials"].items()}
    for i, shape in enumerate(scene["shapes"]):
        positions, normals, triangles = scene_file.mesh(shape, folder)
        mesh = bpy.data.meshes.new(f"shape {i}")
        mesh.from_pydata([to_blender(p) for p in positions], [], triangles)
        # Blender averages the normals itself, as it did for the meshes' files.
        mesh.polygons.foreach_set("use_smooth", [normals is not None] * len(triangles))
        if "emission" in shape:
            assert "material" not in shape, "Cycles' emission node does not reflect"
            mesh.materials.append(node_material(f"emission {i}", emission(shape["emission"])))
        else:
            mesh.materials.append(materials[shape["material"]])
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(f"shape {i}", mesh))


def add_camera(camera, to_blender):
    data = bpy.data.cameras.new("camera")
    data.angle = scene_file.vertical_fov(camera)  # Pictures are square.
    data.clip_start = 1e-3
    position, target = to_blender(camera["position"]), to_blender(camera["look_at"])
    backward = (position - target).normalized()
    right = to_blender(camera.get("up", [0, 1, 0])).cross(backward).normalized()
    pose = Matrix((right, backward.cross(right), backward)).transposed().to_4x4()
    pose.translation = position
    camera = bpy.data.objects.new("camera", data)
    camera.matrix_world = pose
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def add_environment(environment, folder):
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*environment.get("radiance", (0, 0, 0)), 1)
    background.inputs["Strength"].default_value = environment.get("intensity", 1)
    if "file" in environment:
        image = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        image.image = bpy.data.images.load(str((folder / environment["file"]).resolve()))
        image.image.colorspace_settings.name = "Linear"
        image.interpolation = "Closest"  # As candela's texels.
        world.node_tree.links.new(image.outputs["Color"], background.inputs["Color"])


def set_up(width, depth, seed, threads):
    """The same work as candela: depth, roulette, box filter; no denoiser, no adaptive sampling, no clamps."""
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x = render.resolution_y = width
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", threads
    render.use_compositing = render.use_sequencer = False
    render.dither_intensity = 0
    cycles.device = "CPU"
    cycles.seed = seed
    cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_auto_tile = False
    # Cycles counts the segments between surfaces. Its roulette begins where candela's does with --rr-depth 1.
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = depth - 1
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    settings = render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode, settings.exr_codec = "OPEN_EXR", "32", "RGB", "ZIP"


def render(spp):
    """CPU time and wall time [s], preparing the scene included."""
    bpy.context.scene.cycles.samples = spp
    usage = resource.getrusage(resource.RUSAGE_SELF)
    wall, cpu = time.perf_counter(), usage.ru_utime + usage.ru_stime
    bpy.ops.render.render()
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return {"cpu": usage.ru_utime + usage.ru_stime - cpu, "wall": time.perf_counter() - wall}


def main(path, output, width, spp, depth, seed, threads):
    scene, folder = scene_file.read_scene(path), Path(path).resolve().parent
    environment = scene.get("environment", {})
    to_blender = ToBlender(environment.get("rotation", 0))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_shapes(scene, folder, to_blender)
    add_camera(next(iter(scene["cameras"].values())), to_blender)
    add_environment(environment, folder)
    set_up(int(width), int(depth), int(seed), int(threads))
    render(1)  # Warms up.
    one, all_samples = render(1), render(int(spp))
    bpy.data.images["Render Result"].save_render(output, scene=bpy.context.scene)
    print(json.dumps({"one": one, "all": all_samples}))


main(*sys.argv[sys.argv.index("--") + 1 :])
