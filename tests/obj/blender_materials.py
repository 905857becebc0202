"""Exports materials of Blender 5.0 as OBJ files, with its PBR extensions and without, and compares candela's pictures of
them with those of Cycles: a sphere in an even sky of 1, and in a sun of 3 W/m². Prints the mean of each channel over the
sphere, by Cycles, and candela's relative to it (their difference, where Cycles has less than 0.02).

    pip install bpy==5.0.1                          # Python 3.11
    python3 blender_materials.py CANDELA FOLDER     # the program; where files go
"""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import bpy
import mathutils
import numpy

SIDE, SPP, FOV, DISTANCE = 64, 256, 30, 5
SUN = 3
MATERIALS = {
    "diffuse": {"Base Color": (0.8, 0.3, 0.1, 1), "Specular IOR Level": 0},
    "plastic": {"Base Color": (0.8, 0.1, 0.1, 1), "Roughness": 0.4},
    "metal": {"Base Color": (1, 0.7, 0.2, 1), "Metallic": 1, "Roughness": 0.4},
    "metal 0.3": {"Base Color": (0.7, 0.7, 0.7, 1), "Metallic": 0.3, "Roughness": 0.3},
    "glass": {"Base Color": (1, 1, 1, 1), "Transmission Weight": 1, "Roughness": 0},
    "lamp": {"Base Color": (0.5, 0.5, 0.5, 1), "Emission Color": (1, 0.5, 0.2, 1), "Emission Strength": 2},
    "alpha 0.5": {"Base Color": (0.8, 0.1, 0.1, 1), "Alpha": 0.5},
    "coat": {"Base Color": (0.8, 0.1, 0.1, 1), "Coat Weight": 1, "Coat Roughness": 0.1},
}


def build():
    """The sphere, the camera, and a sun that is turned; returns the sphere, and where the sun shines, y upwards."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = SPP, False, False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 32
    scene.cycles.transmission_bounces = scene.cycles.transparent_max_bounces = 32
    scene.cycles.blur_glossy = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
    sphere = bpy.context.object
    bpy.ops.object.shade_smooth()
    bpy.ops.object.camera_add(location=(0, -DISTANCE, 0), rotation=(math.pi / 2, 0, 0))
    bpy.context.object.data.angle = math.radians(FOV)
    scene.camera = bpy.context.object
    bpy.ops.object.light_add(type="SUN", rotation=(math.radians(60), 0, math.radians(30)))
    sun = bpy.context.object
    sun.name, sun.data.angle = "sun", 0
    x, y, z = sun.rotation_euler.to_matrix() @ mathutils.Vector((0, 0, -1))
    return sphere, [x, z, -y]


def means(picture):
    """Of the channels over the middle of the sphere."""
    image = bpy.data.images.load(str(picture))
    image.colorspace_settings.name = "Non-Color"
    pixels = numpy.array(image.pixels[:]).reshape(SIDE, SIDE, 4)[..., :3]
    bpy.data.images.remove(image)
    y, x = (numpy.mgrid[0:SIDE, 0:SIDE] + 0.5) / SIDE * 2 - 1
    radius = math.tan(math.asin(1 / DISTANCE)) / math.tan(math.radians(FOV / 2))
    return pixels[x * x + y * y < (0.9 * radius) ** 2].mean(axis=0)


def by_cycles(light, picture):
    scene = bpy.context.scene
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (1, 1, 1, 1), float(light == "sky")
    bpy.data.objects["sun"].data.energy = SUN * (light == "sun")
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    return means(picture)


def by_candela(program, light, direction, obj, picture):
    scene = {
        "cameras": {"main": {"position": [0, 0, DISTANCE], "look_at": [0, 0, 0], "vertical_fov": FOV}},
        "film": {"size": [SIDE, SIDE]},
        "shapes": [{"type": "obj", "file": str(obj)}],
    }
    if light == "sky":
        scene["environment"] = {"radiance": 1}
    else:
        scene["lights"] = [{"type": "directional", "direction": direction, "irradiance": SUN}]
    file = picture.with_suffix(".json")
    file.write_text(json.dumps(scene))
    subprocess.run([program, "render", file, "-o", picture, "--spp", str(SPP), "-q", "--aov", "none"], check=True)
    return means(picture)


def main():
    program, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    sphere, direction = build()
    rows = ["| material | light | Cycles | default export | PBR export |", "|---|---|---|---|---|"]
    for name, values in MATERIALS.items():
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        for key, value in values.items():
            material.node_tree.nodes["Principled BSDF"].inputs[key].default_value = value
        sphere.data.materials.clear()
        sphere.data.materials.append(material)
        for light in ("sky", "sun"):
            stem = f"{name}-{light}".replace(" ", "-")
            expected = by_cycles(light, folder / f"{stem}-cycles.exr")
            cells = [" ".join(f"{value:.3f}" for value in expected)]
            for pbr in (False, True):
                obj = folder / f"{name.replace(' ', '-')}-{'pbr' if pbr else 'default'}.obj"
                bpy.ops.wm.obj_export(filepath=str(obj), export_pbr_extensions=pbr)
                found = by_candela(program, light, direction, obj, folder / f"{stem}-{int(pbr)}.exr")
                pairs = zip(found, expected)
                cells.append(" ".join(f"{f / e:.3f}" if e > 0.02 else f"{f - e:+.3f}" for f, e in pairs))
            rows.append(f"| {name} | {light} | " + " | ".join(cells) + " |")
    print("\n".join(rows), flush=True)
    os._exit(0)  # bpy may crash when it is torn down.


main()
