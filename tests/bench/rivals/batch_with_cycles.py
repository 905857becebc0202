"""Renders many pictures of glTF files with Cycles, Blender's path tracer, in one process:

    blender -b --factory-startup -P batch_with_cycles.py -- JOB.json
    python3 batch_with_cycles.py -- JOB.json    # The same with the module bpy instead of the program.

The job has `pictures`, each with `model`, `output` (.png or .exr) and either `camera`, the camera's matrix in glTF's
world, with `angle`, its vertical field of view [rad], or `frame` and the file's own camera; and for all of them `size`,
`spp`, `depth`, `seed`, `threads`, `fps` and `environment`, the image of a sky. A file is imported once for the pictures
that follow each other. The last line is JSON: Blender's version, and CPU time and wall time [s] of importing and of
rendering with writing, for each picture.
"""

import json
import math
import sys
from pathlib import Path

import bpy
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))

from render_with_cycles import set_up, timed  # noqa: E402 (needs the path)

TO_BLENDER = Matrix.Rotation(math.radians(90), 4, "X")  # As Blender's importer does.


def add_sky(file):
    """The middle of a sky's image lies towards -Z in glTF's world, which is Blender's +Y; in Blender, towards +X."""
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    image = nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(file)
    image.image.colorspace_settings.name = "Linear Rec.709"
    image.interpolation = "Closest"  # As candela's texels.
    turn = nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value[2] = math.radians(-90)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], image.inputs["Vector"])
    links.new(image.outputs["Color"], nodes["Background"].inputs["Color"])


def load(model, job):
    """An empty scene with that model."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = job["fps"]  # Before the importer counts frames.
    bpy.ops.import_scene.gltf(filepath=model)
    add_sky(job["environment"])
    set_up(job["size"], job["depth"], job["seed"], job["threads"])
    scene.cycles.samples = job["spp"]
    scene.render.use_persistent_data = True  # What frames and views share is kept.
    scene.view_settings.view_transform = "Standard"
    if scene.camera is None:
        scene.camera = next((thing for thing in scene.objects if thing.type == "CAMERA"), None)


def point_camera(picture):
    scene = bpy.context.scene
    if "camera" not in picture:
        scene.frame_set(picture["frame"])
        return
    camera = bpy.data.objects.get("view")
    if camera is None:
        camera = bpy.data.objects.new("view", bpy.data.cameras.new("view"))
        scene.collection.objects.link(camera)
    camera.data.angle = picture["angle"]  # Pictures are square.
    camera.data.clip_start, camera.data.clip_end = 1e-3, 1e4
    camera.matrix_world = TO_BLENDER @ Matrix(picture["camera"])
    scene.camera = camera


def render(picture):
    settings = bpy.context.scene.render.image_settings
    if picture["output"].endswith(".png"):
        settings.file_format, settings.color_depth = "PNG", "8"
    else:
        settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR", "32", "ZIP"
    point_camera(picture)
    bpy.context.scene.render.filepath = picture["output"]
    bpy.ops.render.render(write_still=True)


def main(file):
    job = json.loads(Path(file).read_text(encoding="utf-8"))
    pictures, loaded = [], None
    for picture in job["pictures"]:
        times = {"load": {"cpu": 0, "wall": 0}}
        if picture["model"] != loaded:
            loaded = picture["model"]
            times["load"] = timed(lambda: load(loaded, job))
        times["render"] = timed(lambda: render(picture))
        pictures.append(times)
    print("\n" + json.dumps({"version": bpy.app.version_string, "pictures": pictures}))


main(sys.argv[sys.argv.index("--") + 1])
