"""Renders scenes by the add-on and by Cycles, and prints the means of candela's pictures over those of Cycles, of the whole and
of its quarters; the relMSE between them, most of which is noise; and the noise of candela's over that of Cycles', each from two
pictures of its own, as if both had taken the same CPU time for their samples.

usage: python tests/blender/judge.py FOLDER PROGRAM [SCENE...]      FOLDER: build/blender/candela_blender. Needs PyPI's bpy.
"""
import math
import os
import resource
import sys
import tempfile
import warnings
from pathlib import Path

import bpy
import mathutils
import numpy

SIZE, SAMPLES = (96, 72), 256
FOLDER = Path(sys.argv[1])
os.environ["CANDELA"] = os.path.abspath(sys.argv[2])
sys.path.insert(0, str(FOLDER.parent.resolve()))
addon = __import__(FOLDER.name)


def principled(name="Material", **values):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    for key, value in values.items():
        material.node_tree.nodes["Principled BSDF"].inputs[key.replace("_", " ")].default_value = value
    return material


def shader(kind, **values):
    material = principled()
    tree = material.node_tree
    node = tree.nodes.new("ShaderNode" + kind)
    for key, value in values.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return material


def textured():
    material = principled(Roughness=0.4)
    tree = material.node_tree
    image = bpy.data.images.new("Grid", 64, 64)
    image.generated_type = "COLOR_GRID"
    texture, mapping, place = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexImage", "Mapping", "TexCoord"))
    texture.image = image
    mapping.inputs["Scale"].default_value = (2, 3, 1)
    mapping.inputs["Rotation"].default_value = (0, 0, 0.4)
    tree.links.new(place.outputs["UV"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], texture.inputs[0])
    tree.links.new(texture.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
    return material


def in_space(kind, socket, **values):
    material = principled(Roughness=0.5)
    tree = material.node_tree
    texture, bump = (tree.nodes.new("ShaderNode" + name) for name in ("Tex" + kind, "Bump"))
    for key, value in values.items():
        texture.inputs[key].default_value = value
    if socket == "Normal":
        bump.inputs["Distance"].default_value = 0.1
        tree.links.new(texture.outputs[0], bump.inputs["Height"])
    tree.links.new((bump if socket == "Normal" else texture).outputs[0], tree.nodes["Principled BSDF"].inputs[socket])
    return material


def add_light(kind, location=(2, -2, 4), target=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind, kind)
    for key, value in values.items():
        setattr(data, key, value)
    light = bpy.data.objects.new(kind, data)
    bpy.context.collection.objects.link(light)
    look(light, location, target)


def look(thing, location, target):
    thing.location = location
    thing.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(location)).to_track_quat("-Z", "Y").to_euler()


def add(kind, material, **values):
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**values)
    if kind == "uv_sphere":
        bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(material)


def glow():
    add("plane", shader("Emission", Strength=12), size=2, location=(-2, -2, 4), rotation=(math.pi, 0, 0))


def sky_image():
    image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
    pixels = numpy.full((32, 64, 4), 0.1, numpy.float32)
    pixels[16:, :, :3] = (0.3, 0.5, 1)
    pixels[22:26, 40:46, :3] = 20
    pixels[20:24, 10:13, :3] = (8, 2, 1)
    image.pixels.foreach_set(pixels.ravel())
    tree = bpy.context.scene.world.node_tree
    texture, mapping, place = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexEnvironment", "Mapping", "TexCoord"))
    texture.image = image
    mapping.inputs["Rotation"].default_value = (0, 0, 0.7)
    tree.links.new(place.outputs["Generated"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], texture.inputs[0])
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs["Color"])
    world(1.0)


def world(strength):
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = strength


def room():
    add_light("AREA", energy=300, size=2)
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    world(0.3)


LIGHTS = {
    "point": lambda: add_light("POINT", energy=400, shadow_soft_size=0),
    "soft point": lambda: add_light("POINT", energy=400, shadow_soft_size=0.5, use_soft_falloff=False),
    "sun": lambda: add_light("SUN", energy=3, angle=0),
    "soft sun": lambda: add_light("SUN", energy=3, angle=math.radians(10)),
    "spot": lambda: add_light("SPOT", energy=800, shadow_soft_size=0, spot_size=1.0, spot_blend=0.5),
    "soft spot": lambda: add_light("SPOT", energy=800, shadow_soft_size=0.5, spot_size=1.0, spot_blend=0.5,
                                   use_soft_falloff=False),
    "area": lambda: add_light("AREA", energy=300, size=2),
    "spread": lambda: add_light("AREA", energy=300, size=2, spread=math.radians(60)),
    "disk": lambda: add_light("AREA", energy=300, size=2, shape="DISK"),
    "ellipse": lambda: add_light("AREA", energy=300, size=2, size_y=0.7, shape="ELLIPSE"),
    "emission": glow,
    "image of a sky": sky_image,
}
MATERIALS = {
    "image": textured,
    "noise": lambda: in_space("Noise", "Base Color", Scale=4.0),
    "cells": lambda: in_space("Voronoi", "Base Color", Scale=4.0),
    "bump": lambda: in_space("Noise", "Normal", Scale=4.0),
    "plastic": lambda: principled(Base_Color=(0.8, 0.1, 0.1, 1), Roughness=0.2),
    "gold, 0.2": lambda: principled(Base_Color=(1, 0.77, 0.34, 1), Metallic=1, Roughness=0.2),
    "gold, 0.5": lambda: principled(Base_Color=(1, 0.77, 0.34, 1), Metallic=1, Roughness=0.5),
    "glass": lambda: principled(Base_Color=(0.8, 0.95, 0.9, 1), Transmission_Weight=1, Roughness=0),
    "Glass": lambda: shader("BsdfGlass", Roughness=0.1),
    "Translucent": lambda: shader("BsdfTranslucent"),
    "wax": lambda: principled(Base_Color=(0.8, 0.4, 0.2, 1), Subsurface_Weight=1, Subsurface_Scale=0.5, Roughness=0.5),
    "coat": lambda: principled(Base_Color=(0.6, 0.1, 0.05, 1), Coat_Weight=1, Roughness=0.6),
    "sheen": lambda: principled(Base_Color=(0.1, 0.1, 0.3, 1), Sheen_Weight=1, Roughness=0.8),
    "film": lambda: principled(Base_Color=(0.1, 0.1, 0.1, 1), Thin_Film_Thickness=400, Roughness=0.2),
    "alpha": lambda: principled(Base_Color=(0.8, 0.1, 0.1, 1), Alpha=0.4),
}


def begin(material):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.world = bpy.data.worlds.new("World")
    bpy.context.scene.world.use_nodes = True
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    matte = {"Base_Color": (0.5, 0.5, 0.5, 1), "Roughness": 1.0, "Specular_IOR_Level": 0.0}
    made = principled(**matte) if material is None else material()
    add("plane", principled("Floor", **matte), size=12)
    add("uv_sphere", made, radius=1, location=(-1.1, 0, 1), segments=64, ring_count=32)
    add("cube", made, size=1.5, location=(1.2, 0, 0.76))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    look(camera, (0, -7, 3.2), (0, 0, 0.7))
    bpy.context.scene.camera = camera


def cpu_seconds():
    """Of this process, and of the programs that it has started."""
    usages = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    total = sum(usage.ru_utime + usage.ru_stime for usage in usages)
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # It has ended.
            continue
        if int(fields[1]) == os.getpid():
            total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return total


def render(engine, folder, samples=SAMPLES, seed=0):
    """The picture (height, width, 3), and the CPU time that it took [s]."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = f"{folder}/{engine}.exr"
    if engine == "CYCLES":
        for key, value in {"samples": samples, "seed": seed, "use_denoising": False, "use_adaptive_sampling": False,
                           "max_bounces": 64, "diffuse_bounces": 64, "glossy_bounces": 64, "transmission_bounces": 64,
                           "blur_glossy": 0,
                           "sample_clamp_indirect": 0, "pixel_filter_type": "BOX", "filter_width": 1}.items():
            setattr(scene.cycles, key, value)
    else:
        scene.candela.samples, scene.candela.seed = samples, seed
        scene.candela.pixel_filter, scene.candela.filter_width = "box", 1.0
    before = cpu_seconds()
    bpy.ops.render.render(write_still=True)
    seconds = cpu_seconds() - before
    image = bpy.data.images.load(scene.render.filepath)
    pixels = numpy.empty(SIZE[0] * SIZE[1] * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(SIZE[1], SIZE[0], 4)[::-1, :, :3].astype(float), seconds


def relative_square(difference, picture):
    return (difference ** 2 / (picture ** 2 + 0.01 * picture.mean() ** 2)).mean()


def two_pictures(engine, folder):
    """The mean of two pictures, and the noise that each would have after a second of CPU time for samples."""
    render(engine, folder, samples=1)  # Compiles kernels.
    start = render(engine, folder, samples=1)[1]
    (first, seconds), (second, _) = (render(engine, folder, seed=seed) for seed in (0, 1))
    noise = relative_square(first - second, first) / 2
    return (first + second) / 2, noise * (seconds - start)


def judge(name, folder):
    (cycles, of_cycles), (ours, of_ours) = (two_pictures(engine, folder) for engine in ("CYCLES", "CANDELA"))
    halves = [(slice(0, n // 2), slice(n // 2, n)) for n in SIZE[::-1]]
    quarters = [ours[y, x].mean() / cycles[y, x].mean() for y in halves[0] for x in halves[1]]
    print(f"| {name} | {ours.mean() / cycles.mean():.3f} | {min(quarters):.3f} to {max(quarters):.3f} "
          f"| {relative_square(ours - cycles, cycles):.4f} | {of_ours / of_cycles:.2f} |", flush=True)


def main():
    warnings.simplefilter("ignore")
    addon.register()
    wanted = sys.argv[3:] or [*LIGHTS, *MATERIALS]
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            begin(MATERIALS.get(name))
            LIGHTS.get(name, room)()
            judge(name, folder)
    os._exit(0)


if __name__ == "__main__":
    main()
