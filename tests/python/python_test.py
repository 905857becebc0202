#!/usr/bin/env python3
"""The Python package, with the program that it runs. usage: python_test.py CANDELA [TEST...]"""
import base64
import glob
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "integrations/python"))
import candela  # noqa: E402

SCENE = {"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40},
                     "side": {"position": [3, 0, 0], "look_at": [0, 0, 0], "vertical_fov": 40}},
         "film": {"size": [16, 12]}, "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
         "shapes": [{"type": "sphere", "radius": 1, "material": "clay"}], "environment": {"radiance": 1}}
FOREVER = 1 << 24  # Samples per pixel that no test waits for.


def command_line(scene, *options):
    """The layers that `candela render` writes, by way of the one reader of EXR files that is here: candela."""
    with tempfile.TemporaryDirectory() as folder:
        report = subprocess.run([CANDELA, "render", scene, "-q", "-o", f"{folder}/a.exr", "-o", f"{folder}/a.png",
                                 "--report", "-", *options], check=True, stdout=subprocess.PIPE).stdout
        return json.loads(report)["image_hash"], Path(f"{folder}/a.exr").read_bytes(), Path(f"{folder}/a.png").read_bytes()


def image_hash(rgb):
    """As reports have it: FNV-1a."""
    value = 0xCBF29CE484222325
    for byte in numpy.ascontiguousarray(rgb).tobytes():
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


class Python(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("error")

    def test_the_picture_is_that_of_the_command_line(self):
        path = ROOT / "scenes/cornell-box.json"
        expected, exr, png = command_line(path, "--size", "24x16", "--spp", "4", "--seed", "3")
        scene = candela.load(path)
        told = []
        image = scene.render(spp=4, size=(24, 16), seed=3, progress=told.append)
        self.assertEqual(told[-1:], [1.0])
        self.assertEqual(image_hash(image.rgb), expected)
        self.assertEqual((image.rgb.shape, image.rgb.dtype, image.alpha.shape), ((16, 24, 3), numpy.float32, (16, 24)))
        self.assertEqual((image.width, image.height, image.spp, image.complete), (24, 16, 4, True))
        with tempfile.TemporaryDirectory() as folder:
            image.save(f"{folder}/a.exr")
            image.save(f"{folder}/a.png")
            Path(f"{folder}/b.exr").write_bytes(exr)
            self.assertEqual(Path(f"{folder}/a.png").read_bytes(), png)
            self.assertEqual(image._repr_png_(), png)
            same = candela.compare(f"{folder}/a.exr", f"{folder}/b.exr")
            self.assertEqual((same.agree, same.relmse), (True, 0.0))
            self.assertTrue(candela.compare(image, f"{folder}/b.exr"))
        crop = scene.render(spp=4, size=(24, 16), seed=3, crop=(5, 2, 9, 8), layers=())
        self.assertEqual((crop.crop, crop.layers), ((5, 2, 9, 8), ("rgb", "alpha")))
        numpy.testing.assert_array_equal(crop.rgb, image.rgb[2:8, 5:9])
        with self.assertRaisesRegex(candela.Error, "the image has no layer 'albedo'"):
            crop.albedo

    def test_denoises_as_the_command_line_does(self):
        path = ROOT / "scenes/cornell-box.json"
        _, _, png = command_line(path, "--size", "24x16", "--spp", "4", "--denoise", "variance")
        scene = candela.load(path)
        image = scene.render(spp=4, size=(24, 16), denoise="variance")
        self.assertTrue(numpy.array_equal(image.rgb, scene.image().rgb))
        self.assertEqual(image.denoised.shape, (16, 24, 3))
        self.assertFalse(numpy.array_equal(image.denoised, image.rgb))
        with tempfile.TemporaryDirectory() as folder:
            image.save(f"{folder}/a.png")
            self.assertEqual(Path(f"{folder}/a.png").read_bytes(), png)
        with self.assertRaisesRegex(candela.Error, "denoise.*auto.*oidn.*variance"):
            scene.image(denoise="magic")
        with self.assertRaisesRegex(candela.Error, "no layer 'denoised'"):
            scene.image().denoised

    def test_layers_are_what_they_say(self):
        scene = candela.load(SCENE)
        image = scene.render(spp=4)
        # The middle of the picture looks at the sphere's nearest point, (0, 0, 1), from 2 m.
        y, x = 5, 7
        numpy.testing.assert_allclose(numpy.linalg.norm(image.position[y, x]), 1, atol=1e-6)
        numpy.testing.assert_allclose(image.position[y, x], image.normal[y, x], atol=0.1)
        numpy.testing.assert_allclose(image.depth[y, x], 3 - image.position[y, x, 2], atol=1e-6)
        numpy.testing.assert_allclose(image.distance[y, x], numpy.linalg.norm(image.position[y, x] - [0, 0, 3]), atol=1e-6)
        numpy.testing.assert_allclose(image.albedo[y, x], 0.5, atol=1e-6)
        self.assertTrue(numpy.isinf(image.depth[0, 0]))
        self.assertTrue((image.samples == 4).all())
        self.assertEqual(image.variance.shape, (12, 16, 3))
        clear = scene.render(spp=4, transparent=True)
        self.assertEqual((clear.alpha[y, x], clear.alpha[0, 0]), (1, 0))
        self.assertEqual((tuple(clear.rgb[0, 0]), tuple(image.rgb[0, 0])), ((0, 0, 0), (1, 1, 1)))

    def test_arrays_are_mapped_and_the_users_own(self):
        scene = candela.load(SCENE)
        image = scene.render(spp=1)
        self.assertFalse(image.rgb.flags.owndata)
        before = image.rgb.copy()
        rgb = image.rgb
        rgb[:] = 7
        numpy.testing.assert_array_equal(scene.image().rgb, before)
        alpha, expected = image.alpha, image.alpha.copy()
        del image
        scene.render(spp=2)  # Frees the image.
        numpy.testing.assert_array_equal(alpha, expected)
        self.assertTrue((rgb == 7).all())

    def test_changes(self):
        scene = candela.load(SCENE)
        first = scene.render(spp=2).rgb
        camera = scene.camera
        camera.position = numpy.array([0, 0, 2.5])
        camera.vertical_fov = 50
        self.assertEqual((tuple(scene.cameras["main"].position), camera.vertical_fov), ((0, 0, 2.5), 50))
        nearer = scene.render(spp=2).rgb
        self.assertTrue((nearer != first).any())
        other = candela.Camera((0, 0, 2.5), (0, 0, 0), 50)
        numpy.testing.assert_array_equal(candela.load(SCENE).render(spp=2, camera=other).rgb, nearer)
        with self.assertRaisesRegex(candela.Error, 'the vertical field of view must lie between 0 and 180') as caught:
            camera.vertical_fov = 400
        self.assertEqual((caught.exception.kind, caught.exception.code, camera.vertical_fov), ("failed", 1, 50))
        with self.assertRaises(ValueError):
            camera.position[0] = 1  # It would change a copy.
        scene.camera = candela.Camera((0, 0, 3), (0, 0, 0), 40)
        numpy.testing.assert_array_equal(scene.render(spp=2).rgb, first)
        self.assertEqual((camera.vertical_fov, list(scene.cameras)), (40, ["main", "side"]))
        scene.change(environment={"radiance": [2, 0, 0]})
        self.assertEqual(tuple(scene.render(spp=2).rgb[0, 0]), (2, 0, 0))
        numpy.testing.assert_array_equal(scene.render(camera="side", spp=2).rgb,
                                         scene.render(camera=scene.cameras["side"], spp=2).rgb)
        numpy.testing.assert_array_equal(scene.bounds, [[-1, -1, -1], [1, 1, 1]])
        self.assertEqual((list(scene.materials), scene.size, scene.lights), (["clay"], (16, 12), ()))

    def test_sources(self):
        by_bytes = candela.load(json.dumps(SCENE).encode())
        ply = (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        numpy.testing.assert_array_equal(candela.load(ply).bounds, [[0, 0, 0], [1, 1, 0]])
        numpy.testing.assert_array_equal(by_bytes.render(spp=1).rgb, candela.load(SCENE).render(spp=1).rgb)
        with self.assertRaisesRegex(candela.Error, 'cannot read "/none.glb"') as caught:
            candela.load("/none.glb")
        self.assertEqual((caught.exception.kind, caught.exception.code), ("failed", 1))
        warnings.simplefilter("always")
        with self.assertWarnsRegex(UserWarning, "the environment is black"):
            candela.load({**SCENE, "environment": {"radiance": 0}})

    def test_poses(self):
        numbers = numpy.array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 0, 0], "<f4").tobytes()
        views = [(0, 36), (36, 8), (44, 24)]  # Positions; times; places.
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64," +
                             base64.b64encode(numbers).decode()}],
                "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                               "max": [1, 1, 0]},
                              {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                              {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
                "animations": [{"samplers": [{"input": 1, "output": 2}],
                                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}
        warnings.simplefilter("ignore")  # It has no camera.
        scene = candela.load(json.dumps(gltf).encode())
        numpy.testing.assert_array_equal(scene.bounds, [[0, 0, 0], [1, 1, 0]])
        scene.pose(1)
        numpy.testing.assert_array_equal(scene.bounds, [[5, 0, 0], [6, 1, 0]])
        numpy.testing.assert_array_equal(candela.load(json.dumps(gltf).encode(), time=0.5).bounds, [[2.5, 0, 0], [3.5, 1, 0]])
        scene.pose(None)
        numpy.testing.assert_array_equal(scene.bounds, [[0, 0, 0], [1, 1, 0]])

    def test_views(self):
        scene = candela.load(SCENE)
        around = list(scene.turntable(4, elevation=0, size=(8, 8), spp=1))
        self.assertEqual([image.rgb.shape for image in around], [(8, 8, 3)] * 4)
        front, side = scene.views([(0, 0), (90, 0)], size=(8, 8), spp=1)
        self.assertGreater(front.position[4, 4, 2], 0.9)  # Azimuth 0 looks at the side of +Z, 90 at that of +X.
        self.assertGreater(side.position[4, 4, 0], 0.9)
        numpy.testing.assert_allclose(around[1].position[4, 4], side.position[4, 4], atol=1e-5)
        self.assertEqual(len(list(scene.dome(3, size=(4, 4), spp=1))), 3)

    def test_accumulates_to_the_same_bits(self):
        scene = candela.load(SCENE)
        pictures = list(scene.accumulate(spp=6))
        self.assertEqual([image.spp for image in pictures], [1, 2, 4, 6])
        numpy.testing.assert_array_equal(pictures[-1].rgb, candela.load(SCENE).render(spp=6).rgb)

    def test_ctrl_c_stops_and_keeps_the_picture(self):
        scene = candela.load(SCENE)
        told = []

        def interrupt(done):
            if not told:
                os.kill(os.getpid(), signal.SIGINT)
            told.append(done)
        with self.assertRaises(KeyboardInterrupt):
            scene.render(spp=FOREVER, progress=interrupt)
        image = scene.image()
        self.assertFalse(image.complete)
        spp = image.spp + 2
        numpy.testing.assert_array_equal(scene.render(spp=spp).rgb, candela.load(SCENE).render(spp=spp).rgb)

    def test_threads_share_a_scene(self):
        scene = candela.load(SCENE)
        expected = [scene.render(spp=2, seed=seed).rgb for seed in range(4)]
        found = {}

        def render(seed):
            found[seed] = scene.render(spp=2, seed=seed).rgb
        threads = [threading.Thread(target=render, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed in range(4):
            numpy.testing.assert_array_equal(found[seed], expected[seed])

    def test_a_forked_process_has_a_session_of_its_own(self):
        scene = candela.load(SCENE)
        expected = scene.render(spp=1).rgb
        child = os.fork()
        if child == 0:
            code = 1
            try:
                try:
                    scene.render(spp=1)
                except candela.Error as error:
                    fresh = candela.load(SCENE).render(spp=1).rgb
                    if "belongs to the process that was forked" in str(error) and (fresh == expected).all():
                        code = 0
                candela._session.default_session().close()
            finally:
                os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        numpy.testing.assert_array_equal(scene.render(spp=1).rgb, expected)

    def test_a_session_ends_and_its_images_stay(self):
        with candela.Session(memory_limit="256M") as session:
            process = session._connection._process
            with session.load(SCENE) as scene:
                image = scene.render(spp=1)
                self.assertEqual(len(files_of(process)), 1)
            with self.assertRaisesRegex(candela.Error, "unknown scene"):
                scene.render()
        self.assertEqual((process.returncode, files_of(process)), (0, []))
        self.assertEqual(image.rgb.shape, (12, 16, 3))
        for action in (scene.render, lambda: image.save("a.png"), lambda: session.load(SCENE)):
            with self.assertRaisesRegex(candela.Error, "the session is closed"):
                action()

    def test_a_crash_is_an_exception_and_leaves_no_file(self):
        session = candela.Session()
        process = session._connection._process
        scene = session.load(SCENE)
        image = scene.render(spp=1)

        def crash(_):
            process.kill()
        with self.assertRaisesRegex(candela.Error, "the program ended: signal 9"):
            scene.render(spp=FOREVER, progress=crash)
        self.assertEqual(files_of(process), [])
        self.assertEqual(image.rgb.shape, (12, 16, 3))
        session.close()

    def test_says_what_it_misses(self):
        named = os.environ["CANDELA"]
        try:
            os.environ["CANDELA"] = "/none"
            with self.assertRaisesRegex(candela.Error, "cannot run '/none', which the environment variable CANDELA names"):
                candela.Session()
            os.environ["CANDELA"] = "/bin/false"
            with self.assertRaisesRegex(candela.Error, "the program ended: exit code 1"):
                candela.Session()
            del os.environ["CANDELA"]
            path, os.environ["PATH"] = os.environ["PATH"], ""
            with self.assertRaisesRegex(candela.Error, "cannot find the program candela"):
                candela.Session()
            os.environ["PATH"] = path
        finally:
            os.environ["CANDELA"] = named
        with self.assertRaisesRegex(candela.Error, 'no device matches|no Vulkan device|"none"'):
            candela.Session(device="none").load(SCENE)

    def test_devices(self):
        self.assertEqual(sum(device.default for device in candela.devices()), 1)


def files_of(process):
    return glob.glob(f"/dev/shm/candela-shared-{process.pid}-*")


if __name__ == "__main__":
    CANDELA = os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
