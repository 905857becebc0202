"""Drives what a viewport shows without a window: scenes that change, views that are moved, and the messages that go over.

usage: python tests/blender/viewport_test.py FOLDER PROGRAM [unittest's options]     See scenes.py.
"""
import math
import os
import signal
import threading
import types

import bpy
import mathutils
import numpy
from scenes import SIZE, SceneTest, add, add_camera, add_light, addon, glowing, link, matte, principled, run, spot_of

Viewport, View = addon.viewport.Viewport, addon.viewport.View
PATIENCE = 60.0  # Seconds after which a picture does not come any more.
SPP = 4


def sockets_of(material):
    return material.node_tree.nodes["Principled BSDF"].inputs


class ViewportTest(SceneTest):
    def setUp(self):
        super().setUp()
        bpy.context.scene.candela.preview_samples = SPP
        self.session = addon.program.session()
        self.viewport = self.new_viewport()
        self.sent = []
        send = self.session._connection._send

        def spy(number, method, params, answers=None):
            self.sent.append((method, params))
            send(number, method, params, answers)
        self.session._connection._send = spy
        self.view = None

    def new_viewport(self):
        viewport = Viewport(lambda: None)
        self.addCleanup(viewport.close)
        return viewport

    def follow(self):
        """From now on, the viewport learns what changes, as Blender would tell it."""
        self.update(bpy.context.evaluated_depsgraph_get())

        def updated(scene, depsgraph):
            self.update(depsgraph)
        bpy.app.handlers.depsgraph_update_post.append(updated)
        self.addCleanup(lambda: updated in bpy.app.handlers.depsgraph_update_post and
                        bpy.app.handlers.depsgraph_update_post.remove(updated))

    def update(self, depsgraph):
        self.viewport.update(depsgraph, self.session)

    def look_through(self, camera, size=(SIZE, SIZE), zoom=1.0, offset=(0.0, 0.0)):
        """Looks through the camera as a viewport does, enlarged and shifted by parts of the view."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        projection = camera.evaluated_get(depsgraph).calc_matrix_camera(depsgraph, x=size[0], y=size[1])
        moved = mathutils.Matrix.Translation((*offset, 0)) @ mathutils.Matrix.Diagonal((zoom, zoom, 1, 1))
        self.view = View(size, camera.matrix_world.normalized().inverted(), moved @ projection, camera)
        self.viewport.look(self.view, depsgraph)

    def picture(self, spp=SPP):
        """(H, W, 4): the picture as it is to be, rows from the top."""
        bpy.context.view_layer.update()
        found = self.viewport.accumulator.wait_for(spp, PATIENCE)
        self.assertIsNotNone(found, self.viewport.accumulator.message)
        return found.pixels[::-1]

    def messages(self):
        """Those since the last call that change the scene."""
        found = [(method, params) for method, params in self.sent if method in {"load", "set"}]
        self.sent.clear()
        return found

    def expect_change(self, *keys, arrays=()):
        """One message has changed these parts of the scene, with these arrays, and the picture is that of a new viewport."""
        picture = self.picture()
        (method, params), = self.messages()
        self.assertEqual(method, "set")
        self.assertEqual(sorted(params["change"]), sorted(keys))
        self.assertEqual(sorted(params.get("arrays", {})), sorted(arrays))
        self.expect_new(picture)
        return params["change"]

    def expect_new(self, picture):
        other = self.new_viewport()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        other.update(depsgraph, self.session)
        other.look(self.view, depsgraph)
        numpy.testing.assert_array_equal(picture, other.accumulator.wait_for(SPP, PATIENCE).pixels[::-1])
        other.close()
        self.sent.clear()

    def room(self):
        """A ball and a cube on a floor, under a lamp and a grey world; the viewport shows it."""
        self.background.inputs["Color"].default_value = (0.2, 0.2, 0.2, 1)
        self.floor = add("plane", matte("Floor"), size=8)
        self.ball = add("uv_sphere", principled("Ball"), radius=1, location=(-1.2, 0, 1))
        self.cube = add("cube", principled("Cube"), size=1.5, location=(1.2, 0, 0.8))
        self.lamp = add_light("POINT", location=(2, -2, 4), energy=300, shadow_soft_size=0)
        self.area = add_light("AREA", location=(-3, -2, 4), energy=200, size=1)
        camera = add_camera(location=(0, -8, 4), target=(0, 0, 0.5))
        self.follow()
        self.look_through(camera)
        self.picture()
        (method, params), = self.messages()
        self.assertEqual(method, "load")
        self.assertEqual(len(params["arrays"]), 3 * 4)  # Vertices, faces, normals and texture coordinates of each.
        return camera

    # What is sent.

    def test_a_material_goes_over_without_meshes(self):
        self.room()
        sockets_of(self.ball.data.materials[0])["Base Color"].default_value = (0.8, 0.1, 0.1, 1)
        change = self.expect_change("materials")
        self.assertEqual(list(change["materials"]), ["Ball"])

    def test_an_object_that_moves_sends_its_place(self):
        self.room()
        self.ball.location.x = -1.5
        self.ball.scale = (1, 1, 0.5)
        change = self.expect_change("objects")
        self.assertEqual(list(change["objects"]), ["Sphere"])

    def test_a_mesh_that_is_edited_goes_over_alone(self):
        self.room()
        self.cube.data.vertices[0].co.x = -1.5
        self.cube.data.update()
        change = self.expect_change("meshes", arrays=[f"Cube.{key}" for key in ("vertices", "faces", "normals", "uvs")])
        self.assertEqual(list(change["meshes"]), ["Cube"])
        self.cube.modifiers.new("Bevel", "BEVEL").width = 0.2
        self.expect_change("meshes", arrays=[f"Cube.{key}" for key in ("vertices", "faces", "normals", "uvs")])

    def test_lights_and_the_world_go_over_alone(self):
        self.room()
        self.lamp.data.energy = 600
        self.expect_change("lights")
        self.lamp.location.x = 0
        self.expect_change("lights")
        self.area.data.energy = 100
        self.expect_change("materials")
        self.area.location.x = -2
        self.area.data.size = 2
        self.expect_change("materials", "objects")  # The radiance of a larger one is less.
        self.background.inputs["Color"].default_value = (0.1, 0.1, 0.4, 1)
        self.expect_change("environment")

    def test_instances_are_moved_one_by_one(self):
        twin = link(bpy.data.objects.new("Twin", None))
        self.room()
        twin = link(bpy.data.objects.new("Twin", self.ball.data))
        twin.location = (0, 2, 1)
        self.picture()
        self.messages()
        twin.location = (0, 3, 1)
        change = self.expect_change("objects")
        self.assertEqual(list(change["objects"]["Sphere"]["instances"]), ["1"])

    def test_what_is_renamed_stays_the_same(self):
        self.room()
        before = self.picture()
        self.ball.name, self.cube.name = "Cube", "Sphere"
        self.ball.data.materials[0].name = "Other"
        numpy.testing.assert_array_equal(self.picture(), before)
        self.assertEqual(self.messages(), [])
        self.ball.location.x = -1.5
        self.expect_change("objects")

    def test_what_comes_and_goes_loads_the_scene(self):
        self.room()
        ball = add("uv_sphere", self.ball.data.materials[0], radius=0.5, location=(0, -2, 0.5))
        self.expect_new(self.picture())
        bpy.data.objects.remove(ball)
        self.expect_new(self.picture())
        self.lamp.hide_set(True)
        self.expect_new(self.picture())

    def test_a_material_that_wants_other_meshes_loads_the_scene(self):
        self.room()
        material = self.ball.data.materials[0]
        image = bpy.data.images.new("Slope", 1, 1, float_buffer=True)
        image.pixels = [0.6, 0.5, 1, 1]
        texture, normal = (material.node_tree.nodes.new("ShaderNode" + kind) for kind in ("TexImage", "NormalMap"))
        texture.image = image
        material.node_tree.links.new(texture.outputs[0], normal.inputs["Color"])
        material.node_tree.links.new(normal.outputs[0], sockets_of(material)["Normal"])
        picture = self.picture()
        self.assertEqual([method for method, _ in self.messages()], ["set", "load"])
        self.expect_new(picture)

    def test_a_texture_in_space_goes_over_without_meshes(self):
        self.room()
        material = self.ball.data.materials[0]
        checker = material.node_tree.nodes.new("ShaderNodeTexChecker")
        material.node_tree.links.new(checker.outputs[0], sockets_of(material)["Base Color"])
        self.expect_new(self.picture())
        checker.inputs["Scale"].default_value = 3.0
        change = self.expect_change("materials", arrays=["materials.Ball on Sphere.base_color"])
        self.assertEqual(list(change["materials"]), ["Ball on Sphere"])
        self.ball.data.vertices[0].co.z += 0.1
        self.ball.data.update()
        self.expect_new(self.picture())

    def test_an_armature_moves_its_mesh_at_each_frame(self):
        self.room()
        bones = link(bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones")))
        bpy.context.view_layer.objects.active = bones
        bpy.ops.object.mode_set(mode="EDIT")
        bone = bones.data.edit_bones.new("Bone")
        bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.cube.vertex_groups.new(name="Bone").add(range(8), 1.0, "ADD")
        self.cube.modifiers.new("Bones", "ARMATURE").object = bones
        pose = bones.pose.bones["Bone"]
        pose.rotation_mode = "XYZ"
        self.picture()
        self.messages()
        pose.rotation_euler = (0, 0, 0.5)
        self.expect_change("meshes", arrays=[f"Cube.{key}" for key in ("vertices", "faces", "normals", "uvs")])

    # What is seen.

    def see_balls(self):
        """Small lights, one of which is the last."""
        self.background.inputs["Strength"].default_value = 0
        settings = bpy.context.scene.candela
        settings.preview_samples = 256
        settings.pixel_filter, settings.filter_width = "gaussian", 3.0  # So smooth that pixels say where the middle is.
        ball = add("uv_sphere", glowing(), radius=0.03, location=(0.3, 0.2, 0.5))
        self.follow()
        return ball

    def expect_at(self, ball, spp=256):
        """The light is where the view's own matrices have it."""
        world = self.view.window_matrix @ self.view.view_matrix @ ball.location.to_4d()
        width, height = self.view.size
        expected = [(world.x / world.w + 1) / 2 * width, (1 - world.y / world.w) / 2 * height]
        self.assertLess(numpy.abs(spot_of(self.picture(spp)) - expected).max(), 0.1)

    def test_views_are_blenders(self):
        ball = self.see_balls()
        for values in ({}, {"shift_x": 0.1, "shift_y": -0.1}, {"type": "ORTHO", "ortho_scale": 3},
                       {"type": "ORTHO", "ortho_scale": 3, "shift_x": 0.1}):
            for size, zoom, offset in (((64, 64), 1.0, (0, 0)), ((96, 48), 1.0, (0, 0)), ((48, 64), 1.4, (0.2, -0.1))):
                with self.subTest(size=size, zoom=zoom, **values):
                    self.look_through(add_camera(location=(1, -4, 2), target=(0.4, 0, 0.2), **values), size, zoom, offset)
                    self.expect_at(ball)

    def test_an_orthographic_view_shows_what_is_behind_it(self):
        ball = self.see_balls()
        camera = add_camera(location=(0.2, 0.1, -3), target=(0.2, 0.1, -10), type="ORTHO", ortho_scale=3)
        self.look_through(camera)
        view = View(self.view.size, self.view.view_matrix, self.view.window_matrix)
        self.assertEqual(self.picture(256)[..., :3].max(), 0)
        self.view = view
        self.viewport.look(view, bpy.context.evaluated_depsgraph_get())
        self.expect_at(ball)

    def test_a_camera_with_a_lens_blurs(self):
        ball = self.see_balls()
        camera = add_camera(location=(0, 0, 5))
        self.look_through(camera)
        sharp = (self.picture(256)[..., 0] > 0).sum()
        camera.data.dof.use_dof = True
        camera.data.dof.aperture_fstop = 0.1
        camera.data.dof.focus_distance = 2
        self.look_through(camera)
        self.assertGreater((self.picture(256)[..., 0] > 0).sum(), 4 * sharp)
        self.assertIsNotNone(ball)

    def test_a_border_is_a_part_of_the_camera_s_frame(self):
        camera = self.room()
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = 64, 48
        self.look_through(camera)
        whole = self.picture()
        scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
        scene.render.border_min_y, scene.render.border_max_y = 0.0, 0.5
        self.view.border = self.view.part_of_frame(scene)
        self.viewport.look(self.view, bpy.context.evaluated_depsgraph_get())
        # The frame is as wide as the view, and three quarters as high.
        numpy.testing.assert_array_equal(self.picture(), whole[32:56, 16:48])
        latest = self.viewport.accumulator.latest
        self.assertEqual((latest.size, latest.crop), ((64, 64), (16, 32, 48, 56)))

    def test_a_transparent_film_shows_what_is_behind_the_picture(self):
        camera = self.room()
        bpy.context.scene.render.film_transparent = True
        self.look_through(camera)
        self.assertEqual(self.picture()[0, 0, 3], 0)

    # When.

    def test_another_view_cancels_what_is_rendered(self):
        camera = self.room()
        bpy.context.scene.candela.preview_samples = 1 << 24
        self.look_through(camera)
        self.picture(64)
        camera.location.x += 1
        bpy.context.view_layer.update()
        self.look_through(camera)
        self.picture(1)
        self.assertIn("cancel", [method for method, _ in self.sent])
        self.assertEqual(self.messages(), [])

    def test_nothing_waits_for_the_program(self):
        camera = self.room()
        call, reached, free = self.session._connection.call, threading.Event(), threading.Event()

        def wait(*args, **keys):
            reached.set()
            free.wait()
            return call(*args, **keys)
        self.session._connection.call = wait
        before = self.viewport.accumulator.latest
        self.ball.location.x = -2
        bpy.context.view_layer.update()
        reached.wait()
        self.look_through(camera, zoom=2)
        self.cube.location.x = 2
        bpy.context.view_layer.update()
        self.assertIs(self.viewport.accumulator.latest, before)
        free.set()
        self.expect_new(self.picture())

    def test_large_pictures_are_coarse_first(self):
        camera = self.room()
        seen = []
        accumulator = self.viewport.accumulator
        accumulator._tell = lambda: seen.append(accumulator.latest.pixels.shape[:2])
        accumulator._rate = 1.0
        self.look_through(camera, (320, 240))
        self.picture()
        self.assertEqual((seen[0], seen[-1]), ((30, 40), (240, 320)))

    def test_a_program_that_dies_is_replaced(self):
        self.room()
        before = self.picture()
        os.kill(self.session._connection._process.pid, signal.SIGKILL)
        self.session._connection._reader.join()
        self.ball.location.x = -2
        bpy.context.view_layer.update()
        self.assertTrue(self.viewport.accumulator.needs_session)
        self.session = addon.program.session()
        self.viewport.begin_again(self.session)
        self.assertFalse(self.viewport.accumulator.needs_session)
        self.assertTrue((self.picture() != before).any())

    def test_an_error_is_told_and_forgotten(self):
        self.room()
        before = self.picture()
        self.cube.data.vertices[0].co.x = math.nan
        self.cube.data.update()
        bpy.context.view_layer.update()
        with self.viewport.accumulator._lock:
            self.assertTrue(self.viewport.accumulator._lock.wait_for(
                lambda: "Cube.vertices" in self.viewport.accumulator._message, PATIENCE))
        self.cube.data.vertices[0].co.x = -0.75
        self.cube.data.update()
        numpy.testing.assert_array_equal(self.picture(), before)

    def test_a_program_that_does_not_start_is_told(self):
        def fails():
            raise addon.candela.Error("it does not start")
        start, addon.engine.session = addon.engine.session, fails
        self.addCleanup(setattr, addon.engine, "session", start)
        engine = types.SimpleNamespace(viewport=self.viewport)
        context = types.SimpleNamespace(space_data=types.SimpleNamespace(local_view=None))
        addon.engine.CandelaEngine.view_update(engine, context, bpy.context.evaluated_depsgraph_get())
        self.assertEqual(self.viewport.accumulator.message, "it does not start")

    def test_closing_frees_the_scene(self):
        self.room()
        self.viewport.close()
        self.viewport.accumulator._thread.join(PATIENCE)
        self.assertIn("close", [method for method, _ in self.sent])


if __name__ == "__main__":
    run()
