"""Scenes by script, for the tests of the add-on. The module that imports this one is called with FOLDER PROGRAM: the add-on's
folder, build/blender/candela_blender (sh cmake/blender.sh), and the program. Needs PyPI's bpy.
"""
import os
import shutil
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

# Presets of users are not the tests'.
os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="candela-blender-")

import bpy
import mathutils
import numpy
from bpy_extras.object_utils import world_to_camera_view

FOLDER = Path(sys.argv.pop(1))
os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, str(FOLDER.parent.resolve()))
addon = __import__(FOLDER.name)
writer_of = addon.engine.SceneWriter

SIZE = 64
RHO = 0.5


def link(thing):
    bpy.context.collection.objects.link(thing)
    return thing


def look(thing, location, target):
    thing.location = location
    thing.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(location)).to_track_quat("-Z", "Y").to_euler()
    return thing


def add_camera(location=(0, 0, 10), target=(0, 0, 0), **values):
    data = bpy.data.cameras.new("Camera")
    for key, value in values.items():
        setattr(data, key, value)
    camera = look(link(bpy.data.objects.new("Camera", data)), location, target)
    bpy.context.scene.camera = camera
    return camera


def add_light(kind, location=(0, 0, 2), target=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind, kind)
    for key, value in values.items():
        setattr(data, key, value)
    return look(link(bpy.data.objects.new(kind, data)), location, target)


def principled(name="Material", **values):
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    for key, value in values.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return material


def matte(name="Matte"):
    return principled(name, Base_Color=(RHO, RHO, RHO, 1), Roughness=1.0, Specular_IOR_Level=0.0)


def glowing(strength=1.0, name="Glow"):
    return principled(name, Base_Color=(0, 0, 0, 1), Specular_IOR_Level=0.0, Emission_Color=(1, 1, 1, 1),
                      Emission_Strength=strength)


def add(kind, material, **values):
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**values)
    thing = bpy.context.object
    thing.data.materials.append(material)
    return thing


def centre(image):
    """The mean of the four pixels in the middle."""
    half = image.shape[0] // 2
    return image[half - 1:half + 1, half - 1:half + 1].mean((0, 1))


def spot_of(image):
    """Where the light in a picture is on average: (x, y) in pixels from the top left."""
    weight = image[..., 0]
    y, x = numpy.mgrid[0:weight.shape[0], 0:weight.shape[1]] + 0.5
    return numpy.array([(x * weight).sum(), (y * weight).sum()]) / weight.sum()


class SceneTest(unittest.TestCase):
    """Each begins with an empty scene, black all around, and 16 samples."""

    @classmethod
    def setUpClass(cls):
        warnings.simplefilter("ignore", DeprecationWarning)

    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        addon.register()
        self.addCleanup(addon.unregister)
        scene = bpy.context.scene
        scene.render.engine = "CANDELA"
        scene.render.resolution_x = scene.render.resolution_y = SIZE
        scene.candela.samples = 16
        scene.candela.pixel_filter, scene.candela.filter_width = "box", 1.0  # What pixels show is what is in them.
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.view_settings.view_transform = "Raw"
        world = bpy.data.worlds.new("World")
        scene.world = world
        if bpy.app.version < (5, 0, 0):
            world.use_nodes = True
        self.background = world.node_tree.nodes["Background"]
        self.background.inputs["Color"].default_value = (0, 0, 0, 1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = str(Path(folder.name) / "picture.exr")

    def render(self):
        """(H, W, 4): the picture, rows from the top."""
        bpy.context.scene.render.filepath = self.file
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.file)
        pixels = numpy.empty(image.size[0] * image.size[1] * 4, numpy.float32)
        image.pixels.foreach_get(pixels)
        width, height = image.size
        bpy.data.images.remove(image)
        return pixels.reshape(height, width, 4)[::-1].astype(float)

    def notices(self):
        writer = writer_of(bpy.context.evaluated_depsgraph_get(), addon.program.session(), (SIZE, SIZE))
        writer.write().close()
        return "\n".join(writer.notices)

    def expect_spot(self, image, thing, point=(0, 0, 0)):
        """A small light is where Blender itself projects it, within a tenth of a pixel."""
        world = thing.matrix_world @ mathutils.Vector(point)
        x, y, _ = world_to_camera_view(bpy.context.scene, bpy.context.scene.camera, world)
        expected = numpy.array([x * image.shape[1], (1 - y) * image.shape[0]])
        self.assertLess(numpy.abs(spot_of(image) - expected).max(), 0.1)

    def expect_close(self, found, expected, tolerance):
        self.assertLess(abs(found / expected - 1), tolerance, f"{found}, not {expected}")


def run():
    """Runs the tests of the program, which ends without what Blender does then."""
    outcome = unittest.main(exit=False).result
    shutil.rmtree(os.environ["BLENDER_USER_RESOURCES"], ignore_errors=True)
    sys.stdout.flush()
    os._exit(0 if outcome.wasSuccessful() and outcome.testsRun else 1)
