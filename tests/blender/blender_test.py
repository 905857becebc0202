"""Renders scenes with the add-on in Blender, without a window, and checks what must be seen in closed form.

usage: python tests/blender/blender_test.py FOLDER PROGRAM [unittest's options]
FOLDER: that of the add-on, build/blender/candela_blender (sh cmake/blender.sh). Needs PyPI's bpy.
"""
import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import bpy
import numpy
from scenes import RHO, SIZE, SceneTest, add, add_camera, add_light, addon, centre, glowing, link, look, matte, principled, run, spot_of


class BlenderTest(SceneTest):
    """Final renders."""

    # Lights: the radiance of a matte floor below them is RHO / pi times its irradiance. What is left is how the floor's
    # irradiance varies over the four pixels, and for those with an area, the noise of 1024 samples.

    def floor_below(self, samples=16):
        add("plane", matte(), size=4)
        add_camera(location=(6, -6, 6), lens=200)  # The lights are not in the way.
        bpy.context.scene.candela.samples = samples
        return centre(self.render())[1] * math.pi / RHO

    def test_a_point_light_sends_its_power_evenly(self):
        add_light("POINT", location=(1, 0, 2), energy=100, shadow_soft_size=0)
        self.expect_close(self.floor_below(), 100 / (4 * math.pi) * 2 / 5 ** 1.5, 0.005)

    def test_a_soft_point_light_is_a_sphere(self):
        add_light("POINT", location=(0, 0, 2), energy=100, shadow_soft_size=0.5)
        self.expect_close(self.floor_below(1024), 100 / (4 * math.pi) / 4, 0.005)

    def test_a_sun_has_the_irradiance_that_it_says(self):
        add_light("SUN", location=(0, 3, 4), energy=2, angle=0)
        self.expect_close(self.floor_below(), 2 * 0.8, 1e-4)

    def test_a_sun_has_a_disk(self):
        add_light("SUN", location=(0, 3, 4), energy=2, angle=0.3)
        self.expect_close(self.floor_below(1024), 2 * 0.8, 0.005)

    def test_a_spot_is_a_part_of_a_point_light(self):
        add_light("SPOT", location=(0, 0, 2), energy=100, shadow_soft_size=0, spot_size=1.0, spot_blend=0.2)
        self.expect_close(self.floor_below(), 100 / (4 * math.pi) / 4, 0.005)

    def test_a_soft_spot_is_a_sphere(self):
        spot = add_light("SPOT", location=(0, 0, 2), energy=100, shadow_soft_size=0.3, spot_size=1.0, spot_blend=0.2)
        spot.scale = (3, 3, 3)  # Which changes neither its size nor its cone.
        self.expect_close(self.floor_below(1024), 100 / (4 * math.pi) / 4, 0.005)

    def test_a_turned_soft_spot_lights_where_it_points(self):
        spot = add_light("SPOT", location=(2, 0, 2), target=(2, 0, 0), energy=100, shadow_soft_size=0.1, spot_size=0.4,
                         spot_blend=0)
        self.assertEqual(self.floor_below(1024), 0)
        look(spot, spot.location, (0, 0, 0))
        self.expect_close(centre(self.render())[1] * math.pi / RHO, 100 / (4 * math.pi) / 8 * math.sqrt(0.5), 0.01)

    def test_all_of_the_power_leaves_in_the_spread(self):
        # At half of the tangent of the spread's edge, so that half of the radiance is left.
        edge = math.tan(math.radians(30))
        add_light("AREA", location=(edge, 0, 2), target=(edge, 0, 0), energy=100, size=0.03, spread=math.radians(60))
        peak = edge / (edge - math.radians(30))
        self.expect_close(self.floor_below(1024), 100 / (math.pi * 4) * peak / 2 / (1 + edge ** 2 / 4) ** 2, 0.01)

    def test_a_holdout_is_a_hole_before_a_transparent_film(self):
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        add("plane", matte(), size=100)
        ball = add("uv_sphere", matte(), radius=1)
        add_camera()
        bpy.context.scene.render.film_transparent = True
        self.assertEqual(self.render()[SIZE // 2, SIZE // 2, 3], 1)
        ball.is_holdout = True
        image = self.render()
        self.assertEqual(image[SIZE // 2, SIZE // 2].tolist(), [0, 0, 0, 0])
        self.assertEqual(image[0, 0, 3], 1)

    def test_a_shadow_catcher_shows_its_shadow_alone(self):
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        floor = add("plane", matte(), size=100)
        add("uv_sphere", matte(), radius=1, location=(0, 0, 1))
        add_camera()
        bpy.context.scene.render.film_transparent = True
        floor.is_shadow_catcher = True
        bpy.context.scene.candela.samples = 64
        image = self.render()
        self.assertEqual(image[SIZE // 2, SIZE // 2, 3], 1)
        self.assertLess(image[0, 0, 3], 0.1)  # Far from the ball.
        beside = image[SIZE // 2, :, 3]
        self.assertGreater(beside[(beside > 0.2) & (beside < 0.9)].size, 2)
        self.assertEqual(image[0, 0, :3].max(), 0)

    def test_areas_shine_by_their_shape_and_scale(self):
        # Small ones, 2 m away: irradiance = power / (pi d²).
        for shape, scale in (("SQUARE", 1), ("RECTANGLE", 1), ("DISK", 1), ("ELLIPSE", 1), ("SQUARE", 3)):
            with self.subTest(shape=shape, scale=scale):
                bpy.ops.object.select_all(action="SELECT")
                bpy.ops.object.delete()
                light = add_light("AREA", location=(0, 0, 2), energy=100, shape=shape, size=0.03, size_y=0.02)
                light.scale = (scale, scale, 1)
                self.expect_close(self.floor_below(1024), 100 / (math.pi * 4), 0.01)

    def test_a_constant_world_lights_evenly(self):
        self.background.inputs["Color"].default_value = (0.5, 0.25, 1, 1)
        self.background.inputs["Strength"].default_value = 2
        add("uv_sphere", principled(Base_Color=(1, 1, 1, 1), Roughness=1.0, Specular_IOR_Level=0.0), radius=1)
        add_camera()
        image = self.render()
        for x, y in ((0, 0), (SIZE // 2, SIZE // 2)):
            numpy.testing.assert_allclose(image[y, x, :3], (1, 0.5, 2), rtol=0.05)

    def test_an_image_of_the_world_is_where_blender_has_it(self):
        image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
        pixels = numpy.zeros((32, 64, 4), numpy.float32)
        pixels[15:17, 31:33] = 1  # The middle is +X, and turned by 90 degrees about Z the picture is turned by -90: -Y.
        image.pixels.foreach_set(pixels.ravel())
        tree = bpy.context.scene.world.node_tree
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = image
        mapping = tree.nodes.new("ShaderNodeMapping")
        tree.links.new(texture.outputs[0], self.background.inputs["Color"])
        camera = add_camera(location=(0, 0, 0), target=(1, 0, 0), lens=36)
        self.assertLess(numpy.abs(spot_of(self.render()) - SIZE / 2).max(), 0.5)
        mapping.inputs["Rotation"].default_value = (0, 0, math.pi / 2)
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
        look(camera, (0, 0, 0), (0, -1, 0))
        self.assertLess(numpy.abs(spot_of(self.render()) - SIZE / 2).max(), 0.5)
        self.assertEqual(self.notices(), "")
        tree.links.new(tree.nodes.new("ShaderNodeCombineXYZ").outputs[0], mapping.inputs["Rotation"])
        self.assertIn("does not know what turns a world", self.notices())

    # Cameras.

    def test_cameras_see_things_where_blender_does(self):
        ball = add("uv_sphere", glowing(), radius=0.02, location=(0.7, 0.3, 0.5))
        views = ({}, {"lens": 35, "sensor_fit": "VERTICAL", "sensor_height": 20}, {"shift_x": 0.1, "shift_y": -0.2},
                 {"type": "ORTHO", "ortho_scale": 4}, {"type": "ORTHO", "ortho_scale": 4, "shift_x": 0.1})
        bpy.context.scene.render.resolution_x = 96
        for values in views:
            with self.subTest(**values):
                add_camera(location=(1, -4, 2), target=(0.4, 0, 0.2), **values)
                bpy.context.scene.candela.samples = 64
                self.expect_spot(self.render(), ball)

    def test_a_border_is_a_part_of_the_picture(self):
        add("plane", glowing(), size=1, location=(1, 1, 0))
        add_camera(type="ORTHO", ortho_scale=4)
        whole = self.render()
        render = bpy.context.scene.render
        render.use_border, render.use_crop_to_border = True, True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.5, 1.0, 0.25, 1.0
        numpy.testing.assert_array_equal(self.render(), whole[:SIZE * 3 // 4, SIZE // 2:])

    def test_a_filter_spreads_samples(self):
        """Of an edge through the middle of a pixel: a box of the pixel's width is nowhere else, a wider one is."""
        scene = bpy.context.scene
        scene.candela.samples = 256
        add("plane", glowing(), size=2, location=(1 + 0.5 / SIZE, 0, 0))
        add_camera(type="ORTHO", ortho_scale=1)
        scene.candela.pixel_filter, scene.candela.filter_width = "box", 1.0
        numpy.testing.assert_allclose(self.render()[8, SIZE // 2 - 1:SIZE // 2 + 2, 0], (0, 0.5, 1), atol=0.01)
        scene.candela.filter_width = 3.0
        numpy.testing.assert_allclose(self.render()[8, SIZE // 2 - 1:SIZE // 2 + 2, 0], (1 / 6, 0.5, 5 / 6), atol=0.01)

    def test_what_is_out_of_focus_is_blurred(self):
        add("uv_sphere", glowing(), radius=0.02)
        camera = add_camera(location=(0, 0, 5), lens=50)
        sharp = (self.render()[..., 0] > 0).sum()
        camera.data.dof.use_dof = True
        camera.data.dof.aperture_fstop = 0.1
        focus = link(bpy.data.objects.new("Focus", None))
        focus.location = (0.3, 0.2, 0)
        camera.data.dof.focus_object = focus
        self.assertLess((self.render()[..., 0] > 0).sum(), sharp + 8)
        focus.location = (0, 0, 2.5)
        # The circle of confusion of a radius of 0.25 m, from 5 m, focused at 2.5 m: as large as the aperture there.
        bpy.context.scene.candela.samples = 256
        radius = 0.25 / 5 * 50 / 36 * SIZE
        blurred = (self.render()[..., 0] > 0).sum()
        self.expect_close(blurred, math.pi * radius ** 2, 0.2)

    # Materials and textures.

    def test_images_are_upright(self):
        image = bpy.data.images.new("Corners", 2, 2)
        image.pixels = [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1]  # From the lower left.
        material = glowing()
        texture = material.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image, texture.interpolation = image, "Closest"
        material.node_tree.links.new(texture.outputs[0], material.node_tree.nodes["Principled BSDF"].inputs["Emission Color"])
        add("plane", material, size=2)
        add_camera(type="ORTHO", ortho_scale=2)
        found = self.render()
        quarter = SIZE // 4
        for (y, x), color in (((3, 1), (1, 0, 0)), ((3, 3), (0, 1, 0)), ((1, 1), (0, 0, 1)), ((1, 3), (1, 1, 1))):
            numpy.testing.assert_allclose(found[y * quarter, x * quarter, :3], color, atol=1e-6)

    def test_nodes_compute_on_images(self):
        image = bpy.data.images.new("Half", 1, 1, float_buffer=True)
        image.pixels = [0.5, 0.25, 0.125, 1]
        material = glowing()
        tree = material.node_tree
        texture, ramp = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeValToRGB")
        multiply, separate = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeSeparateColor")
        texture.image, multiply.operation = image, "MULTIPLY"
        multiply.inputs[1].default_value = 2
        ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0, 0, 1, 1), (1, 0, 0, 1)
        tree.links.new(texture.outputs["Color"], separate.inputs[0])
        tree.links.new(separate.outputs[1], multiply.inputs[0])
        tree.links.new(multiply.outputs[0], ramp.inputs[0])
        tree.links.new(ramp.outputs[0], tree.nodes["Principled BSDF"].inputs["Emission Color"])
        add("plane", material, size=20)
        add_camera()
        numpy.testing.assert_allclose(centre(self.render())[:3], (0.5, 0, 0.5), atol=1e-3)

    def test_shaders_are_read(self):
        """Of each shader below a world of radiance 1: white ones are as bright as the world, whatever they are."""
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        self.background.inputs["Strength"].default_value = 1
        for kind in ("BsdfDiffuse", "BsdfGlossy", "BsdfGlass", "BsdfTranslucent", "BsdfTransparent"):
            with self.subTest(kind=kind):
                bpy.ops.object.select_all(action="SELECT")
                bpy.ops.object.delete()
                material = principled()
                tree = material.node_tree
                shader = tree.nodes.new("ShaderNode" + kind)
                shader.inputs["Color"].default_value = (1, 1, 1, 1)
                tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
                add("uv_sphere", material, radius=1)
                add_camera()
                self.assertEqual(self.notices(), "")
                self.expect_close(centre(self.render())[1], 1.0, 0.1)

    def test_light_is_scattered_below_surfaces(self):
        add("uv_sphere", principled("Wax", Base_Color=(0.9, 0.1, 0.1, 1), Subsurface_Weight=1.0, Subsurface_Scale=0.5,
                                    Subsurface_Anisotropy=0.5), radius=1)
        add_light("POINT", location=(3, 0, 6), energy=1000, shadow_soft_size=0.5)
        add_camera()
        self.assertEqual(self.notices(), "")
        red, green, _ = centre(self.render())[:3]
        self.assertGreater(red, 3 * green)

    def test_what_candela_does_not_know_is_named(self):
        material = principled("Rim", Anisotropic=0.5)
        fresnel = material.node_tree.nodes.new("ShaderNodeFresnel")
        material.node_tree.links.new(fresnel.outputs[0], material.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
        ball = add("uv_sphere", material, radius=1)
        ball.modifiers.new("Hair", "PARTICLE_SYSTEM")
        ball.particle_systems[0].settings.type = "HAIR"
        link(bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke")))
        add_camera()
        found = self.notices()
        for text in ('Material "Rim", node "Fresnel": candela does not know', "its anisotropy is left out",
                     '"Sphere": candela has no hair', 'Object "Smoke": candela has no volumes'):
            self.assertIn(text, found)
        self.render()

    # Scenes.

    def test_instances_of_collections_and_geometry_nodes_are_shown(self):
        collection = bpy.data.collections.new("Balls")
        ball = add("uv_sphere", glowing(), radius=0.3)
        bpy.context.collection.objects.unlink(ball)
        collection.objects.link(ball)
        for x in (-1.5, 0, 1.5):
            empty = link(bpy.data.objects.new("Instance", None))
            empty.instance_type, empty.instance_collection = "COLLECTION", collection
            empty.location = (x, 1, 0)
        grid = add("grid", glowing(), x_subdivisions=2, y_subdivisions=2, size=3)
        grid.location = (0, -2, 0)
        group = bpy.data.node_groups.new("Points", "GeometryNodeTree")
        group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        begin, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        instances, cube = group.nodes.new("GeometryNodeInstanceOnPoints"), group.nodes.new("GeometryNodeMeshCube")
        material = group.nodes.new("GeometryNodeSetMaterial")
        material.inputs["Material"].default_value = bpy.data.materials["Glow"]
        cube.inputs["Size"].default_value = (0.3, 0.3, 0.3)
        group.links.new(begin.outputs[0], instances.inputs["Points"])
        group.links.new(cube.outputs[0], material.inputs["Geometry"])
        group.links.new(material.outputs[0], instances.inputs["Instance"])
        group.links.new(instances.outputs[0], end.inputs[0])
        grid.modifiers.new("Points", "NODES").node_group = group
        add_camera(type="ORTHO", ortho_scale=8)
        image = self.render()[..., 0]
        pixel = (8 / SIZE) ** 2
        self.expect_close(image[:SIZE // 2].sum() * pixel, 3 * math.pi * 0.09, 0.03)
        self.expect_close(image.sum() * pixel, 3 * math.pi * 0.09 + 9 * 0.09, 0.03)

    def test_a_library_override_is_where_it_is_put(self):
        add("plane", glowing(), size=0.5)
        thing = bpy.context.object
        library = Path(self.file).with_name("library.blend")
        bpy.data.libraries.write(str(library), {thing})
        bpy.data.objects.remove(thing)
        with bpy.data.libraries.load(str(library), link=True) as (_, here):
            here.objects = ["Plane"]
        thing = link(here.objects[0].override_create())
        thing.location = (2, -1, 0)
        add_camera()
        bpy.context.view_layer.update()
        self.expect_spot(self.render(), thing)

    def test_the_sun_of_a_sky_is_where_blender_has_it(self):
        tree = bpy.context.scene.world.node_tree
        sky = tree.nodes.new("ShaderNodeTexSky")
        sky.sun_elevation, sky.sun_rotation = math.radians(20), math.radians(50)
        tree.links.new(sky.outputs[0], self.background.inputs["Color"])
        add_camera((0, 0, 0), (math.sin(0.7), math.cos(0.7), 0.4))
        spots = []
        for engine in ("CANDELA", "CYCLES"):
            bpy.context.scene.render.engine = engine
            bpy.context.scene.cycles.samples = 64
            image = self.render()
            spots.append(spot_of(image * (image > 0.5 * image[..., :1].max())))
        self.assertLess(numpy.abs(spots[0] - spots[1]).max(), 1)

    def test_animations_move_objects_and_bones(self):
        bpy.context.scene.candela.samples = 256
        ball = add("uv_sphere", glowing(), radius=0.05)
        for frame, x in ((1, -1), (11, 1)):
            ball.location = (x, 0, 0)
            ball.keyframe_insert("location", frame=frame)
        add_camera()
        for frame in (1, 4, 11):
            bpy.context.scene.frame_set(frame)
            self.expect_spot(self.render(), ball)
        bpy.data.objects.remove(ball)
        armature = link(bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones")))
        bpy.context.view_layer.objects.active = armature
        bpy.ops.object.mode_set(mode="EDIT")
        bone = armature.data.edit_bones.new("Bone")
        bone.head, bone.tail = (0, 0, 0), (0, 1, 0)
        bpy.ops.object.mode_set(mode="OBJECT")
        ball = add("uv_sphere", glowing(), radius=0.05, location=(0, 1, 0))
        bpy.ops.object.transform_apply()
        ball.vertex_groups.new(name="Bone").add(range(len(ball.data.vertices)), 1.0, "ADD")
        ball.modifiers.new("Bones", "ARMATURE").object = armature
        pose = armature.pose.bones["Bone"]
        pose.rotation_mode = "XYZ"
        for angle in (0, 0.5, 1.0):
            pose.rotation_euler = (0, 0, angle)
            bpy.context.view_layer.update()
            self.expect_spot(self.render(), armature, (-math.sin(angle), math.cos(angle), 0))

    def test_a_transparent_film_has_no_world_in_it(self):
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        self.background.inputs["Strength"].default_value = 1
        bpy.context.scene.render.film_transparent = True
        add("uv_sphere", matte(), radius=1)
        add_camera()
        image = self.render()
        numpy.testing.assert_array_equal(image[0, 0], 0)
        self.assertEqual(centre(image)[3], 1)
        self.assertGreater(centre(image)[0], 0.3)

    def test_denoises(self):
        bpy.context.scene.candela.samples = 4
        add("plane", matte(), size=20)
        add_light("AREA", location=(0, 0, 3), energy=100, size=3)
        add_camera(location=(0, -5, 5))
        noisy = self.render()
        bpy.context.scene.candela.denoise = "variance"
        smooth = self.render()
        # Half of the differences between pixels beside each other are noise, or more.
        roughness = [numpy.abs(numpy.diff(image[SIZE // 2:, :, 1])).mean() for image in (noisy, smooth)]
        self.assertLess(roughness[1], roughness[0] / 2)

    def test_passes_are_blenders(self):
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
        add("plane", matte(), size=2, location=(0, 0, 1), rotation=(0.5, 0, 0))
        add_camera(location=(0, 0, 5))
        read = {}
        show = addon.engine.CandelaEngine._show

        def spy(engine, image, view_layer, settings):
            show(engine, image, view_layer, settings)
            read.update({name: values(image) for name, _, _, _, values in addon.engine._passes(view_layer, settings)})
        addon.engine.CandelaEngine._show = spy
        self.addCleanup(setattr, addon.engine.CandelaEngine, "_show", show)
        self.render()
        self.expect_close(centre(read["Depth"])[0], 4, 1e-3)
        # Normals of vertices have 16 bits a coordinate.
        numpy.testing.assert_allclose(centre(read["Normal"]), (0, -math.sin(0.5), math.cos(0.5)), atol=1e-4)
        numpy.testing.assert_allclose(centre(read["Position"]), (0, 0, 1), atol=1e-3)

    def test_mattes_are_those_of_the_names(self):
        """The ids of Cryptomatte are hashes of Blender's names, which Blender's own metadata would have, too."""
        layer = bpy.context.view_layer
        layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
        add("plane", matte("Paint"), size=20).name = "Wall"
        add_camera()
        read, told = {}, {}
        show, metadata = addon.engine.CandelaEngine._show, addon.engine.metadata

        def spy(engine, image, view_layer, settings):
            show(engine, image, view_layer, settings)
            read.update({name: values(image) for name, _, _, _, values in addon.engine._passes(view_layer, settings)})
        addon.engine.CandelaEngine._show = spy
        self.addCleanup(setattr, addon.engine.CandelaEngine, "_show", show)
        addon.engine.metadata = lambda *args: told.update(metadata(*args)) or metadata(*args)
        self.addCleanup(setattr, addon.engine, "metadata", metadata)
        self.render()
        for kind, name in (("Object", "Wall"), ("Material", "Paint")):
            expected = numpy.array([addon.cryptomatte.id_of(name)], numpy.uint32).view(numpy.float32)[0]
            numpy.testing.assert_array_equal(read[f"Crypto{kind}00"][0, 0].astype(numpy.float32)[:2], [expected, 1])
        manifests = [value for key, value in told.items() if key.endswith("/manifest")]
        self.assertEqual(manifests[0], '{"Wall":"%08x"}' % addon.cryptomatte.id_of("Wall"))
        # As the specification has it.
        self.assertEqual(addon.cryptomatte.murmur_hash(b"hello"), 0x248BFA47)
        self.assertEqual(addon.cryptomatte.murmur_hash(b""), 0)

    def test_the_command_line_renders_files_of_blender(self):
        add("plane", glowing(), size=20)
        add_camera()
        scene = Path(self.file).with_name("a scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=str(scene))
        done = subprocess.run([os.environ["CANDELA"], "render", scene, "--size", "8x8", "--spp", "1", "--quiet", "-o", self.file],
                              env={**os.environ, "CANDELA_BLENDER": sys.executable}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        image = bpy.data.images.load(self.file)
        numpy.testing.assert_allclose(numpy.array(image.pixels[:3]), 1, rtol=1e-3)

    # What goes wrong.

    def test_what_candela_refuses_is_an_error_with_blenders_names(self):
        plane = add("plane", matte())
        plane.name = "Broken"
        plane.data.vertices[0].co.x = math.nan
        add_camera()
        with self.assertRaisesRegex(RuntimeError, "Broken.vertices.*finite"):
            self.render()

    def test_a_cancelled_rendering_keeps_its_picture(self):
        add("plane", glowing(), size=20)
        add_camera()
        bpy.context.scene.candela.samples = 1 << 20
        engine = addon.engine.CandelaEngine
        tell = engine._tell

        def stop(self, done, began):
            if done > 0:
                raise addon.engine._Cancelled
            tell(self, done, began)
        engine._tell = stop
        self.addCleanup(setattr, engine, "_tell", tell)
        numpy.testing.assert_allclose(centre(self.render())[:3], 1, rtol=1e-6)

    def test_a_program_that_dies_is_an_error_and_the_next_picture_begins_another(self):
        add("plane", glowing(), size=20)
        add_camera()
        bpy.context.scene.candela.samples = 1 << 20
        engine = addon.engine.CandelaEngine
        tell = engine._tell

        def kill(self, done, began):
            os.kill(addon.program.session()._connection._process.pid, signal.SIGKILL)
        engine._tell = kill
        with self.assertRaisesRegex(RuntimeError, "the program ended: signal 9"):
            self.render()
        engine._tell = tell
        bpy.context.scene.candela.samples = 4
        numpy.testing.assert_allclose(centre(self.render())[:3], 1, rtol=1e-6)

    def test_the_program_in_the_zip_can_be_run(self):
        """Blender unpacks it without leave to run it."""
        inside = Path(addon.program.candela.__file__).with_name("candela")
        self.assertFalse(inside.exists(), "make the add-on by sh cmake/blender.sh none")
        self.addCleanup(inside.unlink)
        inside.write_text("#!/bin/sh\n")
        inside.chmod(0o644)
        addon.program.make_executable()
        self.assertTrue(os.access(inside, os.X_OK))

    def test_presets_keep_the_settings(self):
        settings = bpy.context.scene.candela
        settings.samples, settings.denoise = 77, "variance"
        bpy.ops.candela.sampling_preset_add(name="Quick")
        settings.samples, settings.denoise = 5, "none"
        preset = Path(bpy.utils.user_resource("SCRIPTS")) / "presets/candela/sampling/Quick.py"
        bpy.ops.script.execute_preset(filepath=str(preset), menu_idname="CANDELA_MT_sampling_presets")
        self.assertEqual((settings.samples, settings.denoise), (77, "variance"))

    def test_objects_are_hidden_from_the_camera(self):
        """What is hidden from it still lights; other kinds of rays cannot be told apart."""
        ball = add("uv_sphere", glowing(), radius=1)
        floor = add("plane", matte(), size=20)
        floor.location.z = -1
        add_camera()
        seen = self.render()[..., 0]
        ball.visible_camera = ball.visible_shadow = False
        self.assertIn('Object "Sphere": candela hides objects from the camera or from all rays; it is shown to shadow', self.notices())
        hidden = self.render()[..., 0]
        self.assertLess(hidden.max(), 0.6 * seen.max())
        self.assertGreater(hidden.min(), 0)
        ball.visible_diffuse = ball.visible_glossy = ball.visible_transmission = False
        self.assertEqual(self.notices(), "")
        self.assertEqual(self.render()[..., 0].max(), 0)

    def test_lamps_are_hidden_from_the_camera(self):
        """As they are in Blender, until someone shows them."""
        lamp = add_light("AREA", (0, 0, -1), (0, 0, 10), energy=100, size=2)
        add_camera()
        self.assertEqual(self.render()[..., 0].max(), 0)
        lamp.visible_camera = True
        self.assertGreater(self.render()[..., 0].max(), 0)

    def test_registers_again(self):
        addon.unregister()
        with self.assertRaises(TypeError):
            bpy.context.scene.render.engine = "CANDELA"
        addon.register()
        bpy.context.scene.render.engine = "CANDELA"


if __name__ == "__main__":
    run()
