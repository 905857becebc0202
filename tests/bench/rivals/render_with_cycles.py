"""Renders a candela scene with Cycles, Blender's path tracer:

    blender -b --factory-startup -P render_with_cycles.py -- SCENE OUT.exr WIDTH SPP MAX_DEPTH SEED THREADS [denoise]
    python3 render_with_cycles.py -- SCENE ...    # The same with the module bpy instead of the program.

Renders with one sample per pixel, twice, and then with SPP, and writes the last picture, with `denoise` by Open Image
Denoise, with prefiltered albedo and normal. Its last line is JSON:
Blender's version, and CPU time and wall time [s] of the second rendering and of the last, each with preparing the
scene. Tested with Blender 3.4 and 5.0. (As `cycles.py`, the script would replace Blender's module `cycles`.)
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
from cycles_materials import emitting, reflecting  # noqa: E402

DARK_CORE = 0.998  # Radius of what is inside a sphere of light, of its own.


class ToBlender:
    """World space, from candela's axes to Blender's: +Z is up, and the middle of a sky's image lies towards +X. The
    sky cannot be turned, so the world turns the other way."""

    def __init__(self, sky_rotation):
        axes = Matrix(((0, 0, -1), (-1, 0, 0), (0, 1, 0)))
        self.turn = axes @ Matrix.Rotation(math.radians(-sky_rotation), 3, "Y")

    def __call__(self, v):
        return self.turn @ Vector(v)


def blender_mesh(name, made, to_blender):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([to_blender(p) for p in made.positions], [], made.triangles)
    mesh.polygons.foreach_set("use_smooth", [made.normals is not None] * len(made.triangles))
    if made.uvs:
        coordinates = [c for triangle in made.triangles for i in triangle for c in made.uvs[i]]
        mesh.uv_layers.new().data.foreach_set("uv", coordinates)
        # Blender's own averages would show a crease where coordinates break off, for there each point has two vertices.
        if bpy.app.version < (4, 1):  # Since then they need no switch.
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
        mesh.normals_split_custom_set_from_vertices([to_blender(n) for n in made.normals])
    return mesh


def add_object(name, data):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def add_sphere_light(name, shape, to_blender):
    """A point light with a radius, which is an exact sphere. Rays pass it, so a dark shape must be inside."""
    assert "transform" not in shape, "spheres that emit are not moved"
    light = bpy.data.lights.new(name, "POINT")
    light.shadow_soft_size, light.use_soft_falloff = shape["radius"], False
    light.color = shape["emission"]
    light.energy = 4 * math.pi**2 * shape["radius"] ** 2  # [W] for a radiance of 1.
    made = add_object(name, light)
    made.location = to_blender(shape["center"])
    made.visible_camera = True


def add_shapes(scene, folder, to_blender):
    materials = {name: reflecting(name, m, folder) for name, m in scene.get("materials", {}).items()}
    dark = emitting("dark", [0, 0, 0], folder)
    emitters = {}
    for i, shape in enumerate(scene.get("shapes", [])):
        name = f"shape {i}"
        if "emission" not in shape:
            material = materials[shape["material"]]
        else:
            assert "material" not in shape, "Cycles' emission node does not reflect"
            if shape["type"] == "sphere":
                add_sphere_light(f"light {i}", shape, to_blender)
                shape, material = shape | {"radius": DARK_CORE * shape["radius"]}, dark
            else:
                told = json.dumps(shape["emission"])
                if told not in emitters:
                    emitters[told] = emitting(f"emission {i}", shape["emission"], folder)
                material = emitters[told]
        mesh = blender_mesh(name, scene_file.mesh(shape, folder), to_blender)
        mesh.materials.append(material)
        add_object(name, mesh)


def add_model(path, to_blender):
    """A glTF file, by Blender's importer, which has its own axes: glTF's +Y is +Z, and +Z is -Y."""
    bpy.ops.import_scene.gltf(filepath=str(path))
    turn = to_blender.turn.to_4x4() @ Matrix.Rotation(math.radians(-90), 4, "X")
    for made in bpy.context.scene.objects:
        if not made.parent:
            made.matrix_world = turn @ made.matrix_world


def add_spot(name, light, to_blender):
    """Its power is that of a point as bright all around; where it fades, it is linear in another measure than candela's."""
    spot = bpy.data.lights.new(name, "SPOT")
    outer, inner = (math.radians(light[key]) for key in ("outer_angle", "inner_angle"))
    spot.spot_size = 2 * outer
    spot.spot_blend = (math.cos(inner) - math.cos(outer)) / (1 - math.cos(outer))
    spot.shadow_soft_size = 0
    spot.energy, spot.color = 4 * math.pi, light["intensity"]
    made = add_object(name, spot)
    made.location = to_blender(light["position"])
    direction = to_blender(light["look_at"]) - made.location
    made.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def add_lights(lights, to_blender):
    for i, light in enumerate(lights):
        if light["type"] == "spot":
            add_spot(f"spot {i}", light, to_blender)
            continue
        assert light["type"] == "directional", "lights without a surface must be directional, or spots"
        sun = bpy.data.lights.new(f"sun {i}", "SUN")
        sun.angle, sun.energy, sun.color = 0, 1, light["irradiance"]
        direction = to_blender(light["direction"])
        add_object(f"sun {i}", sun).rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def add_camera(camera, to_blender):
    data = bpy.data.cameras.new("camera")
    data.angle = scene_file.vertical_fov(camera)  # Pictures are square.
    data.clip_start = 1e-3
    position, target = to_blender(camera["position"]), to_blender(camera["look_at"])
    backward = (position - target).normalized()
    right = to_blender(camera.get("up", [0, 1, 0])).cross(backward).normalized()
    pose = Matrix((right, backward.cross(right), backward)).transposed().to_4x4()
    pose.translation = position
    camera = add_object("camera", data)
    camera.matrix_world = pose
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
        image.image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"
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
    cycles.volume_bounces = depth - 1
    cycles.min_light_bounces = 0
    # Candela's holes are neither bounces nor places of roulette. 1024 is the most that Cycles allows.
    cycles.transparent_max_bounces = cycles.min_transparent_bounces = 1024
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    settings = render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode, settings.exr_codec = "OPEN_EXR", "32", "RGB", "ZIP"


def timed(action):
    """CPU time of the process and wall time [s] of action()."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    wall, cpu = time.perf_counter(), usage.ru_utime + usage.ru_stime
    action()
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return {"cpu": usage.ru_utime + usage.ru_stime - cpu, "wall": time.perf_counter() - wall}


def render(spp):
    """The times of rendering, preparing the scene included."""
    bpy.context.scene.cycles.samples = spp
    return timed(bpy.ops.render.render)


def denoise():
    """The last picture is denoised as Blender does it by default."""
    cycles = bpy.context.scene.cycles
    cycles.use_denoising, cycles.denoiser = True, "OPENIMAGEDENOISE"
    cycles.denoising_input_passes, cycles.denoising_prefilter = "RGB_ALBEDO_NORMAL", "ACCURATE"


def main(path, output, width, spp, depth, seed, threads, *options):
    scene, folder = scene_file.read_scene(path), Path(path).resolve().parent
    environment = scene.get("environment", {})
    to_blender = ToBlender(environment.get("rotation", 0))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if "scene" in scene:
        add_model(folder / scene["scene"], to_blender)
    add_shapes(scene, folder, to_blender)
    add_lights(scene.get("lights", []), to_blender)
    add_camera(next(iter(scene["cameras"].values())), to_blender)
    add_environment(environment, folder)
    set_up(int(width), int(depth), int(seed), int(threads))
    render(1)  # Warms up.
    one = render(1)
    if "denoise" in options:
        denoise()
    all_samples = render(int(spp))
    bpy.data.images["Render Result"].save_render(output, scene=bpy.context.scene)
    print(json.dumps({"version": bpy.app.version_string, "one": one, "all": all_samples}))


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
