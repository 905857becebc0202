"""Tests textures in space: their values beside those of Cycles, and where on meshes they are.

usage: python tests/blender/textures_test.py FOLDER PROGRAM [unittest's options]     See scenes.py.
"""
import unittest
import unittest.mock

import bpy
import numpy
from scenes import SceneTest, add, add_camera, addon, centre, principled, run

procedural, surface = addon.procedural, addon.surface
SIZE = 96
SHIFT = (0.13, -0.4, 0.37)
PLACE = numpy.float32(SHIFT) + numpy.stack(
    [*numpy.meshgrid(*[(numpy.arange(SIZE, dtype=numpy.float32) + 0.5) / SIZE] * 2), numpy.zeros((SIZE, SIZE))], -1)


class Pixels:
    """Points at the middles of the pixels of a square."""
    side = SIZE

    @staticmethod
    def uv(name=None):
        return PLACE - numpy.float32(SHIFT)


def set_up(node, values):
    for key, value in values.items():
        if key in node.inputs:
            node.inputs[key].default_value = value
        else:
            setattr(node, key, value)


def textured(kind, socket="Base Color", output=0, coordinates=None, **values):
    """A material whose values of a socket are those of a texture."""
    material = principled(kind, Specular_IOR_Level=0.0)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture = nodes.new("ShaderNodeTex" + kind)
    set_up(texture, values)
    if coordinates is not None:
        links.new(nodes.new("ShaderNodeTexCoord").outputs[coordinates], texture.inputs["Vector"])
    links.new(texture.outputs[output], nodes["Principled BSDF"].inputs[socket])
    return material


def clear():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)


class ValuesTest(SceneTest):
    """Cycles shows a square from above whose emission is a texture, and looks at the middle of each pixel."""

    def setUp(self):
        super().setUp()
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.render.resolution_x = scene.render.resolution_y = SIZE
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.filter_width = 1, False, 0.01

    def shown(self, node, output):
        """What a node makes of texture coordinates that are shifted: (SIZE, SIZE, 3), from the bottom; and its socket."""
        clear()
        add_camera((0.5, 0.5, 1), (0.5, 0.5, 0), type="ORTHO", ortho_scale=1)
        tree = node.id_data
        place, moved, emission = (tree.nodes.new("ShaderNode" + name) for name in ("UVMap", "Mapping", "Emission"))
        moved.inputs["Location"].default_value = SHIFT
        tree.links.new(place.outputs[0], moved.inputs["Vector"])
        tree.links.new(moved.outputs[0], next(s for s in node.inputs if s.type == "VECTOR" and not s.is_linked))
        tree.links.new(node.outputs[output], emission.inputs["Color"])
        tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        add("plane", self.material, size=1, location=(0.5, 0.5, 0))
        return self.render()[::-1, :, :3], emission.inputs["Color"]

    def new_node(self, kind, **values):
        self.material = principled()
        node = self.material.node_tree.nodes.new("ShaderNode" + kind)
        set_up(node, values)
        return node

    def by_cycles(self, kind, output, values):
        return self.shown(self.new_node("Tex" + kind, **values), output)[0]

    def expect_read(self, node, output=0):
        """The add-on reads the node's values as Cycles does, at points that are the middles of pixels."""
        expected, socket = self.shown(node, output)
        notices = addon.notices.Notices()
        reader = addon.nodes.Reader("", notices)
        reader.points = Pixels
        found = reader.read(socket).pixels[..., :3]
        self.assertEqual(list(notices), [])
        self.assertGreater(numpy.ptp(expected), 0.1)
        numpy.testing.assert_allclose(found, expected, rtol=0, atol=2e-4)

    def test_mappings(self):
        for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
            with self.subTest(kind):
                node = self.new_node("Mapping", vector_type=kind, Scale=(1.5, 0.7, 2), Rotation=(0.3, -0.5, 0.9))
                if kind in {"POINT", "TEXTURE"}:
                    node.inputs["Location"].default_value = (0.1, 0.2, -0.3)
                self.expect_read(node)

    def test_mappings_may_be_linked(self):
        node = self.new_node("Mapping")
        nodes, links = node.id_data.nodes, node.id_data.links
        for name, numbers in (("Location", (0.1, 0.2, -0.3)), ("Rotation", (0.3, -0.5, 0.9)), ("Scale", (1.5, 0.7, 2))):
            source = nodes.new("ShaderNodeCombineXYZ")
            for socket, number in zip(source.inputs, numbers):
                socket.default_value = number
            links.new(source.outputs[0], node.inputs[name])
        self.expect_read(node)

    def test_vector_math(self):
        for operation in ("ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "SCALE", "MINIMUM", "MAXIMUM", "ABSOLUTE", "FLOOR", "FRACTION",
                          "LENGTH", "DISTANCE", "DOT_PRODUCT"):
            with self.subTest(operation):
                node = self.new_node("VectorMath", operation=operation)
                if len([s for s in node.inputs if s.enabled and s.type == "VECTOR"]) > 1:
                    node.inputs[1].default_value = (0.4, -0.3, 0.7)
                if operation == "SCALE":
                    node.inputs["Scale"].default_value = 1.7
                self.expect_read(node, next(i for i, s in enumerate(node.outputs) if s.enabled))

    def test_images_go_on_beyond_their_edges(self):
        image = bpy.data.images.new("Image", 8, 4, float_buffer=True)
        image.pixels[:] = numpy.random.default_rng(1).uniform(0, 1, 8 * 4 * 4).tolist()
        image.alpha_mode = "NONE"
        for extension in ("REPEAT", "EXTEND", "MIRROR", "CLIP"):
            with self.subTest(extension):
                self.expect_read(self.new_node("TexImage", image=image, extension=extension))

    def expect(self, found, kind, output="Color", **values):
        """Coordinates are rounded by 1e-7; the steepest texture rises by a few hundred."""
        expected = self.by_cycles(kind, output, values)
        found = numpy.asarray(found)
        found = found[..., None] if found.ndim == 2 else found
        self.assertGreater(numpy.ptp(expected), 0.1)
        numpy.testing.assert_allclose(numpy.broadcast_to(found, expected.shape), expected, rtol=0, atol=2e-4)

    def test_checkers(self):
        self.expect(procedural.checker(PLACE * 5), "Checker", Scale=5.0, Color1=(1, 1, 1, 1), Color2=(0, 0, 0, 1))

    def test_gradients(self):
        for kind in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "SPHERICAL", "QUADRATIC_SPHERE"):
            with self.subTest(kind):
                self.expect(procedural.gradient(PLACE, kind), "Gradient", gradient_type=kind)

    def test_noises(self):
        place = [7 * PLACE[..., i] for i in range(3)]
        for dimensions in (2, 3):
            with self.subTest(dimensions):
                found = procedural.noise(place[:dimensions], 2.5, 0.6, 2.2, 0.7, True, True)
                self.expect(found, "Noise", noise_dimensions=f"{dimensions}D", Scale=7.0, Detail=2.5, Roughness=0.6,
                            Lacunarity=2.2, Distortion=0.7)

    def test_noises_that_are_not_normalized(self):
        found = procedural.noise([7 * PLACE[..., i] for i in range(3)], 3.0, 0.5, 2.0, 0.0, False, True)
        self.expect(found, "Noise", normalize=False, Scale=7.0, Detail=3.0)

    def test_magic(self):
        for depth in range(11):
            with self.subTest(depth):
                self.expect(procedural.magic(PLACE * 2, depth, 1.3), "Magic", turbulence_depth=depth, Scale=2.0,
                            Distortion=1.3)

    def test_waves(self):
        for kind, direction, profile in (("BANDS", "X", "SIN"), ("BANDS", "DIAGONAL", "SAW"), ("RINGS", "Z", "TRI"),
                                         ("RINGS", "SPHERICAL", "SIN"), ("RINGS", "X", "SAW")):
            with self.subTest(f"{kind} {direction}"):
                found = procedural.wave(PLACE * 3, kind, direction, profile, 0.3, 1.5, 2.0, 1.5, 0.4)
                self.expect(found, "Wave", wave_type=kind, wave_profile=profile, Scale=3.0, Distortion=1.5, Detail=2.0,
                            **{f"{kind.lower()}_direction": direction, "Phase Offset": 0.3, "Detail Scale": 1.5,
                               "Detail Roughness": 0.4})

    def test_bricks(self):
        mortar, tint = (v[..., None] for v in procedural.brick(PLACE * 4, 0.04, 0.3, 0.1, 0.6, 0.3, 0.3, 3, 1.4, 2))
        red, green, blue = numpy.eye(3)
        found = (red * (1 - tint) + green * tint) * (1 - mortar) + blue * mortar
        self.expect(found, "Brick", offset=0.3, offset_frequency=3, squash=1.4, squash_frequency=2, Color1=(1, 0, 0, 1),
                    Color2=(0, 1, 0, 1), Mortar=(0, 0, 1, 1), Scale=4.0, Bias=0.1,
                    **{"Mortar Size": 0.04, "Mortar Smooth": 0.3, "Brick Width": 0.6, "Row Height": 0.3})


    def test_voronoi_cells(self):
        by_pcg = bpy.app.version >= (5, 0, 0)
        place = [5 * PLACE[..., i] for i in range(3)]
        for dimensions, feature, metric, normalize, output in (
                (3, "F1", "EUCLIDEAN", False, "Distance"), (3, "F1", "MANHATTAN", True, "Distance"),
                (3, "F2", "CHEBYCHEV", True, "Distance"), (2, "F1", "MINKOWSKI", False, "Distance"),
                (2, "F2", "EUCLIDEAN", True, "Distance"), (3, "F1", "EUCLIDEAN", False, "Color"),
                (2, "F2", "EUCLIDEAN", False, "Color"), (2, "F1", "EUCLIDEAN", False, "Color"),
                (3, "DISTANCE_TO_EDGE", "EUCLIDEAN", True, "Distance"), (2, "DISTANCE_TO_EDGE", "EUCLIDEAN", False, "Distance")):
            with self.subTest((dimensions, feature, metric, output)):
                if feature == "DISTANCE_TO_EDGE":
                    found = procedural.voronoi_edge(place[:dimensions], 0.8, normalize, by_pcg)
                else:
                    values = procedural.voronoi(place[:dimensions], feature == "F2", metric, 1.5, 0.8, normalize, by_pcg)
                    found = values[output == "Color"]
                exponent = {"Exponent": 1.5} if metric == "MINKOWSKI" else {}
                self.expect(found, "Voronoi", output, voronoi_dimensions=f"{dimensions}D", feature=feature, distance=metric,
                            normalize=normalize, Scale=5.0, Randomness=0.8, **exponent)


class RememberedTest(unittest.TestCase):
    def test_the_same_points_are_asked_for_once(self):
        def noise_at(shift, detail=2.0):
            return procedural.noise([PLACE[..., i] + numpy.float32(shift) for i in range(3)], detail, 0.5, 2.0, 0.0, True)

        first = noise_at(0)
        self.assertIs(noise_at(0), first)
        self.assertIsNot(noise_at(0, detail=3.0), first)
        self.assertIs(noise_at(0), first)
        with unittest.mock.patch.object(procedural, "_KEPT", 2 * first.nbytes):
            for i in range(1, 4):
                self.assertFalse(numpy.array_equal(noise_at(i), first))
        again = noise_at(0)
        self.assertIsNot(again, first, "it was kept for ever")
        numpy.testing.assert_array_equal(again, first)


class PlacesTest(SceneTest):
    def test_texels_are_what_is_at_the_points_of_triangles(self):
        """By a bilinear look-up at the corners and inside of triangles of all sizes."""
        random = numpy.random.default_rng(1)
        for count in (1, 2, 3, 12, 1000, 30000, 100000):
            with self.subTest(count):
                corners = random.normal(size=(count, 3, 3)) * random.uniform(0.01, 1, (count, 1, 1)) ** 3
                made = surface.Surface(corners.astype(numpy.float32), 512)
                weights = random.dirichlet((1, 1, 1), count)
                weights[::3] = numpy.eye(3)[random.integers(0, 3, len(weights[::3]))]
                place = (made.uvs * weights[..., None]).sum(1)
                found = addon.images.looked_up(made.of(corners), place, "EXTEND", False)
                numpy.testing.assert_allclose(found, (corners * weights[..., None]).sum(1), atol=2e-3)

    def test_too_many_triangles_have_no_texels(self):
        with self.assertRaises(surface.TooManyTriangles):
            surface.Surface(numpy.zeros((200000, 3, 3), numpy.float32), 512)

    def test_a_material_is_another_on_each_mesh(self):
        """The halves of two boxes of different sizes, by their own Generated and Object coordinates."""
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        for coordinates, split in (("Generated", 0.5), ("Object", 0.0)):
            with self.subTest(coordinates):
                clear()
                material = textured("Gradient", coordinates=coordinates)
                tree = material.node_tree
                step = tree.nodes.new("ShaderNodeMath")
                step.operation = "GREATER_THAN"
                step.inputs[1].default_value = split
                gradient = next(node for node in tree.nodes if node.type == "TEX_GRADIENT")
                tree.links.new(gradient.outputs[0], step.inputs[0])
                tree.links.new(step.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
                for size, x in ((2, -2), (1, 2)):
                    add("cube", material, size=size, location=(x, 0, 0))
                add_camera((0, 0, 10), (0, 0, 0), type="ORTHO", ortho_scale=8)
                self.assertEqual(self.notices(), "")
                row = self.render()[32, :, 0]  # Eight pixels are a metre.
                for size, x in ((2, -2), (1, 2)):
                    middle, half = 32 + 8 * x, 4 * size
                    numpy.testing.assert_allclose(row[middle - half + 1:middle - 1], 0, atol=1e-6)
                    numpy.testing.assert_allclose(row[middle + 1:middle + half - 1], 1, rtol=1e-3)

    def test_an_image_beside_a_texture_keeps_its_pixels(self):
        """Only the socket that needs it is computed at points."""
        material = textured("Noise", "Roughness")
        nodes = material.node_tree.nodes
        image = nodes.new("ShaderNodeTexImage")
        image.image = bpy.data.images.new("Image", 2, 2)
        material.node_tree.links.new(image.outputs[0], nodes["Principled BSDF"].inputs["Base Color"])
        add("plane", material, size=2)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        mesh = bpy.context.object.evaluated_get(depsgraph).data
        part, = addon.geometry.parts_of(mesh, None, lambda slot: True)
        made = addon.materials.read_material(material, addon.notices.Notices(), part.points)
        self.assertEqual(made.values["base_color"].image.shape[:2], (2, 2))
        self.assertEqual(made.values["roughness"].image.shape[:2], (1024, 1024))

    def test_what_moves_an_image_may_be_linked(self):
        """A constant does so without points, and a texture at them."""
        material = textured("Image", coordinates="UV")
        nodes, links = material.node_tree.nodes, material.node_tree.links
        texture, mapping, source, noise = (nodes.new("ShaderNode" + name) for name in (
            "TexImage", "Mapping", "CombineXYZ", "TexNoise"))
        texture.image = bpy.data.images.new("Image", 2, 2)
        source.inputs[0].default_value, source.inputs[1].default_value = 0.25, -0.5
        links.new(mapping.outputs[0], texture.inputs["Vector"])
        links.new(texture.outputs[0], nodes["Principled BSDF"].inputs["Base Color"])
        links.new(source.outputs[0], mapping.inputs["Location"])
        made = addon.materials.read_material(material, addon.notices.Notices())
        self.assertFalse(made.in_space)
        self.assertEqual(made.values["base_color"].keys["uv_offset"], [0.25, -0.5])
        links.new(noise.outputs["Color"], mapping.inputs["Location"])
        self.assertTrue(addon.materials.read_material(material, addon.notices.Notices()).in_space)

    def test_an_image_may_be_where_an_object_is(self):
        """By Object coordinates, of which an image takes two: it repeats each metre."""
        self.background.inputs["Color"].default_value = (1, 1, 1, 1)
        material = textured("Image", coordinates="Object", interpolation="Closest")
        image = bpy.data.images.new("Image", 2, 1, float_buffer=True)
        image.pixels[:] = [0, 0, 0, 1, 1, 1, 1, 1]
        next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE").image = image
        add("plane", material, size=4)
        add_camera((0, 0, 10), (0, 0, 0), type="ORTHO", ortho_scale=4)
        row = self.render()[20, :, 0]  # A half of the image is eight pixels wide.
        numpy.testing.assert_allclose(row.reshape(8, 8)[::2, 1:-1], 0, atol=1e-6)
        numpy.testing.assert_allclose(row.reshape(8, 8)[1::2, 1:-1], 1, rtol=1e-3)

    def test_a_bump_of_a_texture_is_steep_where_it_rises(self):
        """A plane that rises evenly reflects the light as if it were turned."""
        material = principled(Specular_IOR_Level=0.0, Roughness=1.0)
        nodes, links = material.node_tree.nodes, material.node_tree.links
        gradient, bump = nodes.new("ShaderNodeTexGradient"), nodes.new("ShaderNodeBump")
        links.new(gradient.outputs[0], bump.inputs["Height"])
        links.new(bump.outputs[0], nodes["Principled BSDF"].inputs["Normal"])
        bump.inputs["Distance"].default_value = 2.0  # Over the two metres of the plane: 45 degrees.
        add("plane", material, size=2)
        light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        bpy.context.collection.objects.link(light)
        light.rotation_euler = (0, -numpy.pi / 4, 0)  # From the side to which the plane falls.
        add_camera()
        lit = centre(self.render())[0]
        light.rotation_euler = (0, 0, 0)
        self.assertGreater(lit, 1.3 * centre(self.render())[0])


if __name__ == "__main__":
    run()
