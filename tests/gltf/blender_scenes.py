"""Builds five scenes in Blender, exports each as .glb, .gltf with files beside it and .gltf with all within, and
renders it with Cycles:

    blender -b --factory-startup -P blender_scenes.py -- FOLDER SPP
    python3 blender_scenes.py -- FOLDER SPP    # The same with the module bpy instead of the program.

Tested with Blender 3.4 and 5.0.
FOLDER gets NAME.glb, NAME/NAME.gltf, NAME-embedded.gltf and, unless SPP is 0, NAME-cycles.exr. The world is black: glTF
has none.
"""

import math
import sys
from pathlib import Path

import bpy

WIDTH, HEIGHT = 320, 180
# What inputs of the Principled BSDF were called before Blender 4.
OLD_NAMES = {"Emission Color": "Emission", "Specular IOR Level": "Specular", "Transmission Weight": "Transmission"}


def reset():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    exporter = bpy.context.preferences.addons["io_scene_gltf2"].preferences
    if hasattr(exporter, "allow_embedded_format"):
        exporter.allow_embedded_format = True  # Blender 3.4 always does.
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    bpy.context.scene.world = world


def principled(name, color, metallic=0.0, roughness=0.5, **inputs):
    """A material of Blender's Principled BSDF, with multiple scattering."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    bsdf = material.node_tree.nodes["Principled BSDF"]
    bsdf.distribution = "MULTI_GGX"
    values = {"Base Color": (*color, 1), "Metallic": metallic, "Roughness": roughness, **inputs}
    for key, value in values.items():
        bsdf.inputs[key if key in bsdf.inputs else OLD_NAMES[key]].default_value = value
    return material


def matte(name, color):
    """Plastic, of which glTF and Blender since version 4 say the same. Blender 3.4 does not: its diffuse part is
    Disney's, and loses nothing to the reflection above it."""
    return principled(name, color, 0, 0.6)


def emitting(name, color, strength):
    light = {"Emission Color": (*color, 1), "Emission Strength": strength, "Specular IOR Level": 0}
    return principled(name, (0, 0, 0), 0, 1, **light)


def last(material=None, smooth=False):
    """The object that the last operator made."""
    made = bpy.context.object
    if material:
        made.data.materials.append(material)
    if smooth:
        bpy.ops.object.shade_smooth()
    return made


def floor(material, size=20):
    bpy.ops.mesh.primitive_plane_add(size=size)
    return last(material)


def dome(strength):
    """An even sky, as a file without an environment can have it: a sphere that emits. By it the mean radiance depends
    on how much light materials reflect in all, more than on where to."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=15)
    last(emitting("sky", (0.9, 0.95, 1), strength))


def lamp(kind, energy, location, rotation=(0, 0, 0), color=(1, 1, 1), **settings):
    """A light without size, as all of glTF's are."""
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy, data.color = energy, color
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    for key, value in settings.items():
        setattr(data, key, value)
    made = bpy.data.objects.new(kind.lower(), data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.collection.objects.link(made)


def camera(location, target, angle=0.7):
    data = bpy.data.cameras.new("camera")
    data.angle = angle
    made = bpy.data.objects.new("camera", data)
    made.location = location
    bpy.context.collection.objects.link(made)
    empty = bpy.data.objects.new("target", None)
    empty.location = target
    bpy.context.collection.objects.link(empty)
    bpy.context.view_layer.update()
    made.rotation_euler = (empty.location - made.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = made


def image(name, color_space, texel):
    """A packed image of 64 by 64: texel(x, y) gives red, green and blue from 0 to 1."""
    made = bpy.data.images.new(name, 64, 64)
    made.colorspace_settings.name = color_space
    made.pixels = [c for y in range(64) for x in range(64) for c in (*texel(x / 64, y / 64), 1)]
    made.pack()
    return made


def textured(material, made, slot, normal=False):
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = made
    target = tree.nodes["Principled BSDF"].inputs[slot]
    if normal:
        bump = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(node.outputs["Color"], bump.inputs["Color"])
        tree.links.new(bump.outputs["Normal"], target)
    elif slot in ("Roughness", "Metallic"):
        split = tree.nodes.new("ShaderNodeSeparateColor")
        tree.links.new(node.outputs["Color"], split.inputs[0])
        tree.links.new(split.outputs["Green" if slot == "Roughness" else "Blue"], target)
    else:
        tree.links.new(node.outputs["Color"], target)


def primitives():
    floor(matte("floor", (0.5, 0.5, 0.5)))
    bpy.ops.mesh.primitive_cube_add(size=1.2, location=(-2.2, 0, 0.6), rotation=(0, 0, 0.5))
    last(matte("red", (0.7, 0.1, 0.05)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.7, location=(-0.6, 0, 0.7))
    last(principled("gold", (1, 0.7, 0.3), 1, 0.3), smooth=True)
    bpy.ops.mesh.primitive_cone_add(vertices=48, radius1=0.7, depth=1.4, location=(0.9, 0, 0.7))
    last(matte("green", (0.1, 0.5, 0.15)))
    bpy.ops.mesh.primitive_torus_add(major_radius=0.6, minor_radius=0.22, location=(2.5, 0, 0.6), rotation=(1, 0, 0.4))
    last(principled("blue", (0.1, 0.2, 0.7), 1, 0.25), smooth=True)
    lamp("SUN", 3, (0, 0, 5), (0.7, 0.2, 0.3))
    dome(1)
    camera((0, -7, 3), (0.1, 0, 0.5))


def suzanne():
    floor(matte("floor", (0.6, 0.55, 0.5)))
    bpy.ops.mesh.primitive_monkey_add(size=2, location=(-0.9, 0, 1.1), rotation=(-0.3, 0, 0.3))
    head = last(matte("skin", (0.6, 0.35, 0.2)), smooth=True)
    head.modifiers.new("subdivision", "SUBSURF").render_levels = 2
    head.modifiers["subdivision"].levels = 2
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(1.0, 0.3, 0.25))
    box = last(principled("steel", (0.6, 0.6, 0.65), 1, 0.35))
    bevel = box.modifiers.new("bevel", "BEVEL")
    bevel.width, bevel.segments = 0.06, 3
    array = box.modifiers.new("array", "ARRAY")
    array.count, array.relative_offset_displace = 4, (0, 0, 1.1)
    lamp("POINT", 500, (3, -3, 4))
    dome(0.5)
    camera((0, -6, 2), (0, 0, 0.9))


def textures():
    ground = matte("tiles", (1, 1, 1))
    textured(ground, image("tiles", "sRGB", lambda x, y: (0.8, 0.7, 0.6) if (int(4 * x) + int(4 * y)) % 2 else (0.2, 0.3, 0.4)),
             "Base Color")
    floor(ground, 6)
    worn = principled("worn", (0.9, 0.6, 0.5), 1)
    textured(worn, image("wear", "Non-Color", lambda x, y: (0, 0.1 + 0.8 * x, 0)), "Roughness")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.5, location=(1.5, 0.2, 0.5))
    last(worn, smooth=True)
    bpy.ops.mesh.primitive_cube_add(size=1.4, location=(0, 0, 0.7), rotation=(0, 0, 0.6))
    block = matte("waves", (0.7, 0.7, 0.7))

    def wave(x, y):
        slope = 0.5 * math.cos(8 * math.pi * x)
        length = math.sqrt(1 + slope * slope)
        return (0.5 - 0.5 * slope / length, 0.5, 0.5 + 0.5 / length)

    textured(block, image("waves", "Non-Color", wave), "Normal", normal=True)
    last(block)
    lamp("POINT", 300, (2.5, -2.5, 3))
    dome(0.5)
    camera((0, -5, 2.6), (0, 0, 0.6))


def glass():
    floor(matte("floor", (0.55, 0.55, 0.6)))
    output = bpy.data.node_groups.new("glTF Material Output", "ShaderNodeTree")
    if bpy.app.version < (4, 0):
        output.inputs.new("NodeSocketFloat", "Thickness")
    else:
        output.interface.new_socket("Thickness", in_out="INPUT", socket_type="NodeSocketFloat")
    for i, rough in enumerate((0.0, 0.3)):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=0.7, location=(1.8 * i - 0.9, 0, 0.75))
        material = principled(f"glass {rough}", (1, 1, 1), 0, rough, **{"Transmission Weight": 1, "IOR": 1.45})
        group = material.node_tree.nodes.new("ShaderNodeGroup")
        group.node_tree = output
        group.inputs["Thickness"].default_value = 1.0  # A solid, not a thin wall.
        last(material, smooth=True)
    bpy.ops.mesh.primitive_plane_add(size=2, location=(0, 0.5, 3.5), rotation=(math.pi, 0, 0))
    last(emitting("lamp", (1, 0.95, 0.9), 8))
    dome(0.3)
    camera((0, -6, 2), (0, 0, 0.7))


def lights():
    floor(matte("floor", (0.6, 0.6, 0.6)))
    bpy.ops.mesh.primitive_plane_add(size=10, location=(0, 3, 0), rotation=(math.pi / 2, 0, 0))
    last(matte("wall", (0.6, 0.6, 0.6)))
    bpy.ops.mesh.primitive_cylinder_add(vertices=48, radius=0.5, depth=1.6, location=(0.3, 0.6, 0.8))
    last(matte("post", (0.5, 0.5, 0.5)))
    lamp("POINT", 100, (-2.5, 1, 1.2), color=(1, 0.3, 0.2))
    lamp("SPOT", 400, (2.6, 0, 3.5), (-0.2, 0.1, 0), color=(0.3, 1, 0.4), spot_size=0.8, spot_blend=0.0)
    lamp("SUN", 0.5, (0, 0, 5), (0.6, -0.4, 0), color=(0.4, 0.5, 1))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.25, location=(-0.9, 0.2, 0.3))
    last(emitting("bulb", (1, 0.8, 0.4), 10), smooth=True)
    camera((0, -6, 2.2), (0, 0.5, 0.9))


def set_up_cycles(spp):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = spp, False, False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    for key in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces"):
        setattr(cycles, key, 64)
    cycles.pixel_filter_type = "BOX"
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    settings = render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode, settings.exr_codec = "OPEN_EXR", "32", "RGB", "ZIP"


def main(folder, spp):
    for build in (primitives, suzanne, textures, glass, lights):
        name = build.__name__
        reset()
        build()
        if spp > 0:
            set_up_cycles(spp)
            bpy.context.scene.render.filepath = str(folder / f"{name}-cycles.exr")
            bpy.ops.render.render(write_still=True)
        (folder / name).mkdir(exist_ok=True)
        options = {"export_lights": True, "export_cameras": True, "export_apply": True}
        bpy.ops.export_scene.gltf(filepath=str(folder / f"{name}.glb"), export_format="GLB", **options)
        bpy.ops.export_scene.gltf(filepath=str(folder / name / f"{name}.gltf"), export_format="GLTF_SEPARATE", **options)
        bpy.ops.export_scene.gltf(filepath=str(folder / f"{name}-embedded.gltf"), export_format="GLTF_EMBEDDED", **options)


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1 :]
    main(Path(arguments[0]).resolve(), int(arguments[1]))
