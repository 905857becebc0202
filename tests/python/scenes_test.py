#!/usr/bin/env python3
"""Scenes that Python builds of arrays, and changes by attributes. usage: scenes_test.py CANDELA [TEST...]"""
import glob
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import types
import unittest
import warnings
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "integrations/python"))
import candela  # noqa: E402

POINTS = numpy.array([[-1, -1, -1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]], numpy.float64)
FACES = numpy.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
UVS = numpy.array([[0, 0], [1, 0], [0, 1], [1, 1]], numpy.float32)
CAMERA = candela.Camera((0, 0, 4), (0, 0, 0), 40)
MOVED = numpy.array([[0, 0, 1, 0.25], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]], float)
FOREVER = 1 << 24  # Samples per pixel that no test waits for.


def tetrahedron(**mesh):
    scene = candela.Scene(size=(24, 18))
    scene.add_camera(CAMERA)
    scene.add_material("clay", type="diffuse", reflectance=0.5, vertex_colors="colors" in mesh)
    scene.add_mesh(POINTS, FACES, name="pot", material="clay", **mesh)
    scene.environment = 1
    return scene


def file_of(**mesh):
    """The same as a dictionary."""
    return {"cameras": {"main": CAMERA.to_dict()}, "film": {"size": [24, 18]}, "environment": {"radiance": 1},
            "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
            "shapes": [{"type": "mesh", "name": "pot", "material": "clay", "positions": POINTS.tolist(),
                        "triangles": FACES.tolist(), **mesh}]}


def files():
    return glob.glob(f"/dev/shm/candela-shared-{os.getpid()}-*")


class Scenes(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("error")

    def same(self, a, b):
        numpy.testing.assert_array_equal(a.render(spp=2).rgb, b.render(spp=2).rgb)

    def test_a_built_scene_is_that_of_a_file(self):
        self.same(tetrahedron(), candela.load(file_of()))
        self.assertEqual(files(), [])
        self.same(tetrahedron(normals=POINTS.astype("f4"), uvs=UVS, transform=MOVED),
                  candela.load(file_of(normals=POINTS.tolist(), uvs=UVS.tolist(), transform=[{"matrix": MOVED.ravel().tolist()}])))
        views = tetrahedron()  # Arrays that are not contiguous, and lists.
        views.add_mesh(POINTS[::-1].astype("f4"), FACES.tolist(), name="again", material="clay", transform=numpy.diag([0.5, 0.5, 0.5, 1]))
        both = file_of()
        both["shapes"].append({**both["shapes"][0], "name": "again", "positions": POINTS[::-1].tolist(),
                               "transform": [{"scale": 0.5}]})
        self.same(views, candela.load(both))

    def test_all_kinds_of_parts(self):
        scene = tetrahedron(transforms=numpy.stack([MOVED, numpy.eye(4)]))
        scene.add_shape("sphere", name="ball", radius=0.5, center=numpy.array([1, 1, 0]), transform=MOVED)
        scene.add_shape("quad", vertices=numpy.array([[-1, -1, -2], [1, -1, -2], [1, 1, -2], [-1, 1, -2]]), emission=(1, 2, 3))
        scene.add_light("point", position=(2, 2, 2), intensity=5)
        self.assertEqual(list(scene.objects), ["pot", "ball", "quad 2"])
        self.assertEqual(sorted(scene.materials), ["(black)", "clay", "default"])
        self.assertEqual(len(scene.objects["pot"].instances), 2)
        expected = file_of()
        mesh = {key: value for key, value in expected["shapes"][0].items() if key != "name"}
        expected["objects"] = {"pot": [mesh]}
        expected["materials"]["default"] = {"type": "diffuse", "reflectance": 0.5}
        expected["lights"] = [{"type": "point", "position": [2, 2, 2], "intensity": 5}]
        matrix = [{"matrix": MOVED.ravel().tolist()}]
        expected["shapes"] = [{"type": "instance", "object": "pot", "transforms": [matrix, []]},
                              {"type": "sphere", "radius": 0.5, "center": [1, 1, 0], "material": "default", "transform": matrix},
                              {"type": "quad", "vertices": [[-1, -1, -2], [1, -1, -2], [1, 1, -2], [-1, 1, -2]], "emission": [1, 2, 3]}]
        self.same(scene, candela.load(expected))

    def test_images_and_colours(self):
        image = (numpy.arange(4 * 4 * 3).reshape(4, 4, 3) * 5).astype(numpy.uint8)
        scene = tetrahedron(uvs=UVS)
        plain = scene.render(spp=2).rgb
        scene.materials["clay"].reflectance = image
        textured = scene.render(spp=2).rgb
        self.assertTrue((plain != textured).any())
        again = candela.Scene(size=(24, 18))
        again.add_camera(CAMERA)
        again.add_material("clay", type="diffuse", reflectance=candela.Texture(image, encoding="srgb"))
        again.add_mesh(POINTS, FACES, name="pot", material="clay", uvs=UVS)
        again.environment = {"radiance": 1}
        numpy.testing.assert_array_equal(again.render(spp=2).rgb, textured)
        # Floats are linear light, and 16 bits are finer than 8.
        for floats in (numpy.full((2, 2, 3), 0.5, "f4"), numpy.full((2, 2, 3), 0.5)):
            scene.materials["clay"].reflectance = floats
            numpy.testing.assert_array_equal(scene.render(spp=2).rgb, plain)
        scene.materials["clay"].reflectance = candela.Texture(numpy.full((1, 1), 32768, "u2"), encoding="linear")
        numpy.testing.assert_allclose(scene.render(spp=2).rgb, plain, rtol=1e-3)
        self.assertEqual(scene.materials["clay"].reflectance["factor"], [1, 1, 1])
        colored = tetrahedron(colors=numpy.full((4, 3), 0.5, "f4"))
        colored.materials["clay"].reflectance = 1
        numpy.testing.assert_array_equal(colored.render(spp=2).rgb, plain)
        sky = tetrahedron()
        sky.environment = numpy.ones((4, 8, 3), "f4")
        numpy.testing.assert_allclose(sky.render(spp=64).rgb.mean(), plain.mean(), rtol=0.05)
        self.assertEqual(sky.environment["radiance"].shape, (4, 8, 3))

    def test_other_meshes_and_lights_are_those_of_a_new_scene(self):
        lamp = {"type": "point", "position": [2, 2, 2], "intensity": 5}
        scene, changed = tetrahedron(), tetrahedron(normals=POINTS, uvs=UVS)
        scene.render(spp=1)
        scene.change(meshes={"pot": {"vertices": POINTS, "faces": FACES, "normals": POINTS, "uvs": UVS}}, lights=[lamp])
        changed.add_light(**lamp)
        self.same(scene, changed)
        scene.add_shape("sphere", name="ball", radius=0.5)  # The scene is loaded again, and stays as it is.
        changed.add_shape("sphere", name="ball", radius=0.5)
        self.same(scene, changed)
        self.assertEqual(scene.lights, ("point 1",))
        with self.assertRaisesRegex(candela.Error, "pot: a mesh needs vertices and faces"):
            scene.change(meshes={"pot": {"faces": FACES}})
        self.same(scene, changed)

    def test_a_scene_follows_a_draft_by_changes(self):
        """By one message, without what is the same; and by a new scene where no change can say it."""
        def drafted(transform=MOVED, vertices=POINTS, reflectance=0.5, second=False, power=5, radiance=1.0):
            other = candela.Scene(size=(24, 18))
            other.add_camera(CAMERA)
            other.add_material("clay", type="diffuse", reflectance=reflectance)
            other.add_mesh(vertices, FACES, name="pot", material="clay", transform=transform)
            other.add_mesh(POINTS, FACES, name="pots", material="clay", transforms=numpy.stack([MOVED, transform]))
            if second:
                other.add_shape("sphere", name="ball", radius=0.5)
            other.add_light("point", position=(2, 2, 2), intensity=power)
            other.environment = radiance
            return other
        scene = drafted()
        scene.render(spp=1)
        sent, call = [], scene._connection.call
        scene._connection.call = lambda method, params, *rest, **more: sent.append((method, params)) or call(method, params, *rest, **more)
        self.addCleanup(setattr, scene._connection, "call", call)
        for values, keys in (({}, None), ({"transform": numpy.eye(4)}, ["objects"]), ({"vertices": POINTS * 2}, ["meshes", "objects"]),
                             ({"vertices": POINTS * 2, "power": 3}, ["lights"]), ({"reflectance": 0.3}, ["lights", "materials", "meshes"]),
                             ({"reflectance": 0.3, "radiance": 2.0}, ["environment"]), ({"second": True}, "load"), ({"second": True}, None)):
            with self.subTest(**values):
                scene._follow(drafted(**values)._draft)
                expected = [] if keys is None else [keys]
                self.assertEqual([sorted(params["change"]) if method == "set" else method for method, params in sent], expected)
                self.same(scene, drafted(**values))
                sent.clear()

    def test_says_what_is_wrong_with_an_array(self):
        for mesh, message in (({"normals": POINTS[:3]}, r'the array "pot.normals": expected 4 rows, one for each position, found \[3, 3\]'),
                              ({"normals": POINTS[:, :2]}, "pot.normals: expected an array of N x 3 numbers, found 4 x 2"),
                              ({"uvs": UVS.astype("c8")}, "pot.uvs: expected an array of numbers, found one of the type complex64"),
                              ({"uvs": 1}, "pot.uvs: expected an array of N x 2 numbers, found a number"),
                              ({"colors": numpy.full((4, 3), 255, "u1")}, "pot.colors: expected linear floats from 0 to 1, found uint8"),
                              ({"colors": numpy.full((4, 3), 2.0)}, "pot.colors.*expected numbers from 0 to 1, found 2 in row 0"),
                              ({"transform": numpy.eye(3)}, "pot.transform: expected a matrix of 4 x 4 numbers, found 3 x 3")):
            with self.assertRaisesRegex(candela.Error, message):
                tetrahedron(**mesh).render(spp=1)
        for vertices, faces, message in ((POINTS, FACES + 1, r'the array "pot.faces": expected indices of positions, from 0 to 3, found 4 in row 1'),
                                         (POINTS, FACES.astype(float), "pot.faces: expected indices, of an integer type, found float64"),
                                         (POINTS * numpy.nan, FACES, "pot.vertices.*found nan in row 0"),
                                         (POINTS * 0, FACES, "the mesh has no triangle with an area")):
            scene = candela.Scene()
            scene.add_mesh(vertices, faces, name="pot")
            with self.assertRaisesRegex(candela.Error, message):
                scene.render(spp=1)
        self.assertEqual(files(), [])
        scene = tetrahedron()
        with self.assertRaisesRegex(candela.Error, "an image is an array of uint8, uint16 or floats, not of int64"):
            scene.materials["clay"].reflectance = FACES
        with self.assertRaisesRegex(candela.Error, "there is an object 'pot' already"):
            scene.add_mesh(POINTS, FACES, name="pot")
        with self.assertRaisesRegex(candela.Error, "there is a material 'clay' already"):
            scene.add_material("clay")
        with self.assertRaisesRegex(candela.Error, "give either transform or transforms"):
            scene.add_mesh(POINTS, FACES, transform=MOVED, transforms=[MOVED])
        with self.assertRaisesRegex(candela.Error, "the scene is from a file, and nothing can be added"):
            candela.load(file_of()).add_mesh(POINTS, FACES)
        with self.assertRaisesRegex(candela.Error, 'unknown material "paint"'):
            other = candela.Scene()
            other.add_mesh(POINTS, FACES, material="paint")
            other.render(spp=1)
        self.same(scene, tetrahedron())

    def test_what_is_added_later_joins_what_was_changed(self):
        scene = tetrahedron()
        scene.render(spp=1)
        scene.materials["clay"].reflectance = 0.25
        scene.objects["pot"].transform = MOVED
        scene.camera.position = (0, 1, 4)
        scene.environment = (1, 2, 3)
        self.assertEqual(scene.environment, {"radiance": (1, 2, 3)})
        scene.add_shape("sphere", name="ball", radius=0.5)
        expected = file_of(transform=[{"matrix": MOVED.ravel().tolist()}])
        expected["materials"] = {"clay": {"type": "diffuse", "reflectance": 0.25}, "default": {"type": "diffuse", "reflectance": 0.5}}
        expected["cameras"]["main"]["position"] = [0, 1, 4]
        expected["environment"]["radiance"] = [1, 2, 3]
        expected["shapes"].append({"type": "sphere", "name": "ball", "radius": 0.5, "material": "default"})
        self.assertIn("not loaded yet", repr(scene))
        self.same(scene, candela.load(expected))

    def test_catchers_catch_before_nothing(self):
        floor = 100 * numpy.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]])
        alphas = []
        for catcher in (None, "catch", "holdout"):
            scene = tetrahedron(transform=[[1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]])
            scene.add_camera(candela.Camera((0, 6, 6), (0, 0, 0), 40), "above")
            scene.add_mesh(floor, [[0, 1, 2], [0, 2, 3]], material="clay", shadow_catcher=catcher)
            image = scene.render(spp=64, camera="above", transparent=True)
            self.assertEqual(image.alpha.max(), 1)  # The pot.
            alphas.append(image.alpha)
        shown, caught, held_out = alphas
        self.assertEqual(shown.min(), 1)
        self.assertLess(caught.min(), 0.2)  # Far from the pot.
        self.assertTrue((caught >= held_out - 1e-6).all())
        self.assertGreater(numpy.count_nonzero((caught > 0.2) & (held_out == 0)), 5)  # Its shadow.

    def test_a_camera_sees_all_if_nobody_places_one(self):
        scene = candela.Scene(size=(32, 32))
        scene.add_mesh(POINTS + 100, FACES)
        scene.environment = 1
        alpha = scene.render(spp=4, transparent=True).alpha
        self.assertTrue(0.1 < alpha.mean() < 0.9)
        self.assertEqual(max(alpha[0].max(), alpha[-1].max(), alpha[:, 0].max(), alpha[:, -1].max()), 0)
        scene.add_mesh(POINTS + [104, 100, 100], FACES)  # It goes on to do so.
        self.assertEqual(scene.render(spp=4, transparent=True).alpha[:, 0].max(), 0)
        scene.camera = candela.Camera((100, 100, 104), (100, 100, 100), 40)
        numpy.testing.assert_array_equal(scene.camera.position, (100, 100, 104))

    def test_objects_and_materials_by_name(self):
        scene = candela.load(file_of())
        pot, clay = scene.objects["pot"], scene.materials["clay"]
        numpy.testing.assert_array_equal(pot.transform, numpy.eye(4))
        before = scene.render(spp=2).rgb
        pot.transform = MOVED
        numpy.testing.assert_array_equal(pot.transform, MOVED)
        self.same(scene, candela.load(file_of(transform=[{"matrix": MOVED.ravel().tolist()}])))
        with self.assertRaises(ValueError):
            pot.transform[0, 3] = 1  # It would change a copy.
        scene.change(objects={"pot": {"transform": numpy.eye(4), "visible": False}})
        self.assertFalse(pot.visible)
        self.assertTrue((scene.render(spp=2, transparent=True).alpha == 0).all())
        pot.visible = True
        numpy.testing.assert_array_equal(scene.render(spp=2).rgb, before)
        clay.reflectance = 0.25
        numpy.testing.assert_array_equal(clay.reflectance, [0.25] * 3)
        self.assertTrue((scene.render(spp=2).rgb != before).any())
        clay.update(type="mirror", reflectance=(0.5, 0.25, 1))
        self.assertEqual((clay.type, pot.materials), ("mirror", ("clay",)))
        self.assertIn("reflectance", dir(clay))
        with self.assertRaisesRegex(AttributeError, "the material 'clay' has no 'roughness' .it has: type, reflectance"):
            clay.roughness
        with self.assertRaisesRegex(candela.Error, 'unknown key "roughness"'):
            clay.roughness = 1
        with self.assertRaisesRegex(KeyError, "no object 'vase'; there are: pot"):
            scene.objects["vase"]
        with self.assertRaisesRegex(KeyError, "no material 'paint'; there are: clay"):
            scene.materials["paint"]
        self.assertEqual(scene.environment, {})
        scene.change(sky={"sun_elevation": 30})
        self.assertIsNone(candela.load({key: value for key, value in file_of(emission=1).items() if key != "environment"}).environment)

    def test_ids_have_names(self):
        image = tetrahedron().render(spp=1, layers=["object_id"])
        middle = image.object_id[9, 12]
        self.assertEqual(image.names["object_id"][int(middle)], "pot")
        self.assertEqual(image.names["instance_id"][int(image.instance_id[9, 12])], ("pot", 0))
        self.assertEqual(image.names["material_id"][int(image.material_id[9, 12])], "clay")
        self.assertEqual((image.object_id[0, 0], image.names["object_id"][0]), (0, None))

    def test_time_outs(self):
        scene = candela.load(file_of())
        with self.assertRaisesRegex(candela.Error, "render: not done within 0.2 seconds") as caught:
            scene.render(spp=FOREVER, timeout=0.2)
        self.assertEqual((caught.exception.kind, caught.exception.code), ("timeout", 7))
        self.assertFalse(scene.image().complete)  # The picture so far.
        self.same(scene, candela.load(file_of(), timeout=1000))

    def test_progress_by_tqdm(self):
        bars = []

        class Bar:
            def __init__(self, total, unit, leave):
                self.n, self.total, self.is_open = 0, total, True
                bars.append(self)

            def update(self, by):
                assert by >= 0
                self.n += by

            def close(self):
                self.is_open = False
        package, auto = types.ModuleType("tqdm"), types.ModuleType("tqdm.auto")
        auto.tqdm = Bar
        scene = candela.load(file_of())
        known = {name: sys.modules.get(name) for name in ("tqdm", "tqdm.auto")}
        sys.modules.update({"tqdm": package, "tqdm.auto": auto})
        try:
            scene.render(spp=2, progress=True)
            self.assertEqual([(round(bar.n), bar.total, bar.is_open) for bar in bars], [(100, 100, False)])
            sys.modules.update({"tqdm": None, "tqdm.auto": None})  # As if it were not installed.
            scene.render(spp=3, progress=True)
        finally:
            for name, module in known.items():
                sys.modules.pop(name) if module is None else sys.modules.update({name: module})
        self.assertEqual(len(bars), 1)

    def test_selftest(self):
        found = candela.selftest()
        self.assertTrue(found and found.passed)
        self.assertIn("passed", str(found.report))

    def test_a_forked_worker_builds_scenes_of_its_own(self):
        expected = tetrahedron().render(spp=1).rgb
        with multiprocessing.get_context("fork").Pool(2) as pool:
            for rgb in pool.map(_render_in_worker, range(4)):
                numpy.testing.assert_array_equal(rgb, expected)
        numpy.testing.assert_array_equal(tetrahedron().render(spp=1).rgb, expected)

    def test_ctrl_c_ends_a_script_at_once(self):
        script = textwrap.dedent(f"""
            import sys; sys.path.insert(0, {str(ROOT / "integrations/python")!r})
            import candela
            scene = candela.Scene(size=(8, 8)); scene.add_shape("sphere"); scene.environment = 1
            try:
                scene.render(spp={FOREVER}, progress=lambda done: print("runs", flush=True))
            except KeyboardInterrupt:
                print("kept", scene.image().rgb.shape, flush=True)
            """)
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "runs\n")
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate()
        self.assertEqual((process.returncode, out.splitlines()[-1]), (0, "kept (8, 8, 3)"))
        self.assertEqual(glob.glob(f"/dev/shm/candela-shared-{process.pid}-*"), [])


def _render_in_worker(_):
    rgb = tetrahedron().render(spp=1).rgb.copy()
    candela._session.default_session().close()
    return rgb


class _Visual:
    def __init__(self, kind, **values):
        self.kind = kind
        self.__dict__.update(values)


class _Mesh:
    """What candela needs of a trimesh.Trimesh; tests/python/trimesh_test.py has the package itself."""

    def __init__(self, visual=None):
        self.vertices, self.faces, self.visual = POINTS, FACES, visual


class _Graph(dict):
    @property
    def nodes_geometry(self):
        return list(self)


class _Pbr:
    baseColorFactor = baseColorTexture = metallicFactor = roughnessFactor = metallicRoughnessTexture = None
    normalTexture = emissiveFactor = emissiveTexture = alphaMode = alphaCutoff = None
    doubleSided = False

    def __init__(self, **values):
        self.__dict__.update(values)


class Trimesh(unittest.TestCase):
    def picture(self, mesh, **options):
        scene = candela.from_trimesh(mesh, size=(24, 18), **options)
        scene.camera = CAMERA
        return scene, scene.render(spp=2).rgb

    def test_colours(self):
        _, plain = self.picture(_Mesh())
        code = numpy.array([188, 188, 188, 255], "u1")  # In sRGB, about 0.5 of the light.
        for visual in (_Visual("vertex", vertex_colors=numpy.tile(code, (4, 1))), _Visual("face", face_colors=numpy.tile(code, (4, 1)))):
            _, colored = self.picture(_Mesh(visual))
            numpy.testing.assert_allclose(colored, plain, rtol=0.01)

    def test_materials(self):
        image = numpy.full((2, 2, 4), 255, "u1")
        image[..., 3] = [[0, 255], [255, 0]]
        rough = numpy.full((2, 2, 3), 128, "u1")
        pbr = _Pbr(baseColorFactor=numpy.array([255, 128, 0, 255], "u1"), baseColorTexture=image, metallicFactor=0.5, roughnessFactor=0.25,
                   metallicRoughnessTexture=rough, normalTexture=numpy.full((1, 1, 3), [128, 128, 255], "u1"), emissiveFactor=[0.5, 0, 0],
                   alphaMode="MASK", alphaCutoff=0.25, doubleSided=True)
        scene, _ = self.picture(_Mesh(_Visual("texture", uv=UVS, material=pbr)))
        values = scene.materials["mesh material"].to_dict()
        numpy.testing.assert_allclose(values["base_color"]["factor"], [1, 128 / 255, 0], rtol=1e-6)
        self.assertEqual((values["metalness"]["factor"], values["roughness"]["factor"], values["emission"], values["double_sided"]),
                         (0.5, 0.25, [0.5, 0, 0], True))
        self.assertEqual((values["normal_map"]["scale"], values["opacity"]["factor"]), (1, 1))
        simple = _Visual("texture", uv=None, material=types.SimpleNamespace(to_pbr=lambda: _Pbr(baseColorFactor=[0.25, 0.5, 1.0, 0.5],
                                                                                                alphaMode="BLEND")))
        scene, _ = self.picture(_Mesh(simple))
        values = scene.materials["mesh material"].to_dict()
        self.assertEqual((values["base_color"], values["opacity"], values["metalness"]), ([0.25, 0.5, 1], 0.5, 1))

    def test_scenes(self):
        graph = _Graph({"a": (MOVED, "pot"), "b": (numpy.eye(4), "pot"), "c": (numpy.diag([0.5, 0.5, 0.5, 1]), "lid"), "d": (MOVED, "path")})
        mesh = types.SimpleNamespace(geometry={"pot": _Mesh(), "lid": _Mesh(), "path": types.SimpleNamespace()}, graph=graph)
        scene, _ = self.picture(mesh)
        self.assertEqual(list(scene.objects), ["pot", "lid"])
        numpy.testing.assert_array_equal(scene.objects["pot"].instances[0].transform, MOVED)
        numpy.testing.assert_array_equal(scene.objects["lid"].transform, numpy.diag([0.5, 0.5, 0.5, 1]))


if __name__ == "__main__":
    CANDELA = os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
