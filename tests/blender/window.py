"""Run by Blender in a window, by window.sh: switches the viewport to candela as a user would, changes the scene, and leaves
screenshots.   usage: blender --factory-startup --python window.py -- FOLDER MODULE
"""
import gc
import subprocess
import sys
import traceback

import bpy
import mathutils

FOLDER, MODULE = sys.argv[sys.argv.index("--") + 1:]
SAMPLES = 8
PATIENCE = 1200  # Looks, of 0.1 s each.


def viewport():
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            return area
    raise RuntimeError("there is no viewport")


def accumulator():
    kind = sys.modules[MODULE + ".accumulator"].Accumulator
    return next((found for found in gc.get_objects() if isinstance(found, kind) and not found._is_closed), None)


def begin():
    bpy.ops.preferences.addon_enable(module=MODULE)
    scene = bpy.context.scene
    scene.render.engine = "CANDELA"
    scene.candela.preview_samples = SAMPLES
    material = bpy.data.materials["Material"]
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.1, 0.4, 0.8, 1)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=viewport()):
        bpy.ops.mesh.primitive_plane_add(size=12, location=(0, 0, -1))
        bpy.ops.mesh.primitive_monkey_add(size=2, location=(-2.5, 0, 0.2), rotation=(0, 0, 0.6))
    viewport().spaces.active.shading.type = "RENDERED"


def move():
    bpy.data.objects["Cube"].location.x = 1.5
    bpy.data.objects["Cube"].rotation_euler.z = 0.5


def paint():
    bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.8, 0.2, 0.1, 1)


def turn():
    view = viewport().spaces.active.region_3d
    view.view_rotation = view.view_rotation @ mathutils.Quaternion((0, 1, 0), 0.6)


def look_through():
    viewport().spaces.active.region_3d.view_perspective = "CAMERA"


def border():
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.2, 0.7, 0.3, 0.9


def see_parallel():
    bpy.context.scene.render.use_border = False
    viewport().spaces.active.region_3d.view_perspective = "ORTHO"


def see_through():
    viewport().spaces.active.region_3d.view_perspective = "PERSP"
    bpy.context.scene.render.film_transparent = True


STEPS = [begin, move, paint, turn, look_through, border, see_parallel, see_through]


class Tour:
    """Takes a step, waits until its picture is there, and takes a screenshot."""

    def __init__(self):
        self.steps = list(STEPS)
        self.name = ""
        self.looks = 0

    def __call__(self):
        try:
            return self.go_on()
        except BaseException:
            traceback.print_exc()
            self.end()

    def go_on(self):
        if self.name:
            found = accumulator()
            is_done = found is not None and found.latest is not None and found.latest.spp >= SAMPLES and self.looks > 15 and \
                found.latest.look is found._look and found.latest.draft is found._draft
            self.looks += 1
            if not is_done and self.looks < PATIENCE:
                return 0.1
            subprocess.run(["import", "-window", "root", f"{FOLDER}/{self.name}.png"], check=True)  # Blender's own may be black.
            print(f"{self.name}: {found.message if found else 'no viewport'}{'' if is_done else ', which is too late'}", flush=True)
        if not self.steps:
            self.end()
            return None
        step = self.steps.pop(0)
        self.name, self.looks = step.__name__, 0
        step()
        return 0.1

    def end(self):
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.wm.quit_blender()


bpy.app.timers.register(Tour(), first_interval=2.0)
