#!/usr/bin/env python3
"""Scenes whose arrays `candela serve` gets through shared memory, and changes of what is in them.
usage: shared_test.py CANDELA [TEST...]"""
import glob
import json
import os
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy

from serve_client import ROOT, Client

sys.path.insert(0, str(ROOT / "integrations/python"))
from candela._shared import SharedArrays  # noqa: E402

CAMERA = {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}
# A tetrahedron around 0.
POINTS = [[-1, -1, -1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]]
FACES = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
UVS = [[0, 0], [1, 0], [0, 1], [1, 1]]
COLORS = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0.5]]
TURN = [0, 0, 1, 0.25, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1]


def scene_of(**mesh):
    mesh = {"type": "mesh", "name": "pot", "material": "clay", **mesh}
    return {"cameras": {"main": CAMERA}, "film": {"size": [16, 12]}, "environment": {"radiance": 1},
            "materials": {"clay": {"type": "diffuse", "reflectance": 0.5, "vertex_colors": "colors" in mesh}},
            "shapes": [mesh]}


def shared(**arrays):
    return SharedArrays({name: (numpy.asarray(array), None) for name, array in arrays.items()})


def load(client, description, arrays=None, **params):
    text = json.dumps(description)
    return client.call("load", text=text, folder="/", **({} if arrays is None else {"arrays": arrays}), **params)


def picture(client, scene="1", **params):
    client.call("render", scene=scene, spp=2, **params)
    return client.pixels(scene)


def runs(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def ours():
    return glob.glob(f"/dev/shm/candela-shared-{os.getpid()}-*")


class Arrays(unittest.TestCase):
    def test_a_scene_of_arrays_is_that_of_lists(self):
        lists = scene_of(positions=POINTS, triangles=FACES, normals=POINTS, uvs=UVS, uvs1=UVS, colors=COLORS)
        by_name = scene_of(**{key: {"array": key} for key in ("positions", "triangles", "normals", "uvs", "uvs1", "colors")})
        with Client() as client:
            load(client, lists)
            expected = picture(client)
            for floats in ("float32", "float64"):
                for integers in ("uint8", "uint16", "int32", "uint32", "int64"):
                    with shared(positions=numpy.array(POINTS, floats), triangles=numpy.array(FACES, integers),
                                normals=numpy.array(POINTS, floats), uvs=numpy.array(UVS, floats),
                                uvs1=numpy.array(UVS, floats), colors=numpy.array(COLORS, floats)) as arrays:
                        self.assertEqual(load(client, by_name, arrays, scene="1")["triangles"], 4)
                    self.assertEqual(ours(), [])
                    self.assertTrue(picture(client) == expected)
            with self.subTest("instances"):
                instance = {**lists, "objects": {"pot": [{k: v for k, v in lists["shapes"][0].items() if k != "name"}]}}
                steps = [[{"matrix": TURN}], [{"translate": [0, 1, 0]}]]
                load(client, {**instance, "shapes": [{"type": "instance", "object": "pot", "transforms": steps}]}, scene="1")
                expected = picture(client)
                moved = numpy.eye(4)
                moved[1, 3] = 1
                with shared(places=[numpy.reshape(TURN, (4, 4)), moved]) as arrays:
                    load(client, {**instance, "shapes": [{"type": "instance", "object": "pot", "transforms": {"array": "places"}}]},
                         arrays, scene="1")
                self.assertTrue(picture(client) == expected)

    def test_images_of_arrays_are_those_of_files(self):
        texels = numpy.arange(4 * 3 * 3).reshape(3, 4, 3).astype(numpy.uint8) * 7
        quad = {"type": "quad", "material": "clay", "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]}
        sky = numpy.linspace(0, 3, 4 * 8 * 3, dtype=numpy.float32).reshape(4, 8, 3)
        with tempfile.TemporaryDirectory() as folder, Client() as client:
            bmp = b"".join(row[:, ::-1].tobytes() for row in texels[::-1])  # Of 12 bytes a row, bottom up.
            Path(folder, "a.bmp").write_bytes(b"BM" + struct.pack("<IHHIIiiHHIIiiII", 54 + len(bmp), 0, 0, 54, 40, 4, 3, 1, 24, 0,
                                                                  len(bmp), 2835, 2835, 0, 0) + bmp)

            def of(image, environment=1):
                return {**scene_of(positions=POINTS, triangles=FACES), "environment": {"radiance": environment},
                        "materials": {"clay": {"type": "diffuse", "reflectance": {"image": image}}}, "shapes": [quad]}
            client.call("load", text=json.dumps(of("a.bmp")), folder=folder)
            expected = picture(client)
            with shared(a=texels) as arrays:
                load(client, of({"array": "a"}), arrays, scene="1")
                self.assertTrue(picture(client) == expected)
                client.call("set", scene="1", change={"materials": {"clay": {"reflectance": 0.5}}})
                self.assertTrue(picture(client) != expected)
                client.call("set", scene="1", change={"materials": {"clay": {"reflectance": {"image": {"array": "a"}}}}},
                            arrays=arrays)
                self.assertTrue(picture(client) == expected)
            # A map of one colour is the constant.
            with shared(a=texels, sky=numpy.full((4, 8, 3), 2.0), ramp=sky) as arrays:
                load(client, of({"array": "a"}, 2), arrays, scene="2")
                expected = picture(client, "2", camera={**CAMERA, "look_at": [0, 9, 0]})
                load(client, of({"array": "a"}, {"array": "sky"}), arrays, scene="2")
                got = picture(client, "2", camera={**CAMERA, "look_at": [0, 9, 0]})
                self.assertEqual(numpy.frombuffer(got, "f").tolist(), numpy.frombuffer(expected, "f").tolist())
                load(client, of({"array": "a"}, {"array": "ramp"}), arrays, scene="2")
                self.assertTrue(picture(client, "2", camera={**CAMERA, "look_at": [0, 9, 0]}) != expected)

    def test_refuses_arrays_that_are_wrong(self):
        good = {"positions": numpy.array(POINTS, "f4"), "triangles": numpy.array(FACES), "uvs": numpy.array(UVS, "f4"),
                "colors": numpy.array(COLORS, "f4"), "normals": numpy.array(POINTS, "f4")}

        def with_value(key, place, value):
            array = good[key].copy()
            array[place] = value
            return {key: array}
        scene = scene_of(**{key: {"array": key} for key in good})
        cases = [({"positions": numpy.zeros((4, 2), "f4")}, "expected rows of 3 numbers, found [4, 2]"),
                 ({"positions": numpy.zeros(4, "f4")}, "expected rows of 3 numbers, found [4]"),
                 ({"positions": numpy.zeros((0, 3), "f4")}, "expected at least one point"),
                 ({"positions": numpy.zeros((4, 3), "f2")}, "of the type float16, which only images may be"),
                 (with_value("positions", (2, 1), numpy.nan), "found nan in row 2"),
                 (with_value("positions", (3, 0), numpy.inf), "found inf in row 3"),
                 ({"positions": good["positions"].astype("f8") * 1e39}, "expected finite numbers that 32-bit floats can hold"),
                 (with_value("triangles", (1, 2), 4), "expected indices of positions, from 0 to 3, found 4 in row 1"),
                 (with_value("triangles", (0, 0), -1), "expected indices of positions, from 0 to 3, found -1 in row 0"),
                 ({"triangles": good["triangles"] + 0.5}, "expected indices of positions, from 0 to 3, found 0.5"),
                 ({"uvs": good["uvs"][:3]}, "expected 4 rows, one for each position, found [3, 2]"),
                 (with_value("uvs", (0, 0), 2e30), "expected numbers from -1e30 to 1e30"),
                 ({"normals": good["normals"][:2]}, "expected 4 rows, one for each position, found [2, 3]"),
                 (with_value("colors", (2, 2), 1.5), "expected numbers from 0 to 1, found 1.5 in row 2"),
                 ({"colors": numpy.zeros((4, 5), "f4")}, "expected rows of 3 or 4 numbers, found [4, 5]")]
        with Client() as client:
            for change, message in cases:
                with shared(**{**good, **change}) as arrays:
                    error = client.error("load", text=json.dumps(scene), folder="/", arrays=arrays)
                self.assertEqual(error["code"], -32000)
                key = next(iter(change))
                self.assertRegex(error["message"], f'^/scene:1:\\d+: (the array "{key}"|"{key}")')
                self.assertIn(message, error["message"])
            with shared(**good) as arrays:
                text = json.dumps(scene_of(positions={"array": "position"}, triangles={"array": "triangles"}))
                self.assertIn('unknown array "position" (did you mean "positions"?',
                              client.error("load", text=text, folder="/", arrays=arrays)["message"])
                self.assertIn("arrays come with a request to candela serve, and there is none here",
                              client.error("load", text=text, folder="/")["message"])
                for image, message in ((numpy.zeros((2, 2, 5), "u1"), "expected an image of height x width pixels, from 1 to 65536"),
                                       (numpy.zeros((0, 2), "u1"), "expected an image of height x width"),
                                       (numpy.zeros((2, 2), "f4"), "an image is of the type uint8, uint16 or float16"),
                                       (numpy.full((2, 2), -1, "f2"), "negative or not finite, at 0; clip it to 0 .. 65504")):
                    textured = {**scene_of(positions=POINTS, triangles=FACES, uvs=UVS),
                                "materials": {"clay": {"type": "diffuse", "reflectance": {"image": {"array": "a"}}}}}
                    with shared(a=image) as images:
                        self.assertIn(message, client.error("load", text=json.dumps(textured), folder="/", arrays=images)["message"])
                for sky, message in ((numpy.zeros((2, 2)), "expected a map of height x width x 3 numbers"),
                                     (numpy.full((2, 4, 3), -1.0), "expected radiance of at least 0, found -1 in row 0")):
                    lit = {**scene_of(positions=POINTS, triangles=FACES), "environment": {"radiance": {"array": "a"}}}
                    with shared(a=sky) as maps:
                        self.assertIn(message, client.error("load", text=json.dumps(lit), folder="/", arrays=maps)["message"])
                for places, message in ((numpy.zeros((1, 4, 4)), "expected an affine matrix"),
                                        (numpy.diag([1, 0, 1, 1])[None], "expected a matrix that does not flatten the object")):
                    copied = {**scene_of(), "objects": {"pot": [{"type": "mesh", "positions": POINTS, "triangles": FACES,
                                                                 "material": "clay"}]},
                              "shapes": [{"type": "instance", "object": "pot", "transforms": {"array": "a"}}]}
                    with shared(a=places) as matrices:
                        self.assertIn(message, client.error("load", text=json.dumps(copied), folder="/", arrays=matrices)["message"])
            load(client, scene_of(positions=POINTS, triangles=FACES))

    def test_refuses_memory_that_is_not_shared(self):
        text = json.dumps(scene_of(positions={"array": "a"}, triangles=FACES))
        with Client() as client, tempfile.TemporaryDirectory() as folder, shared(a=numpy.array(POINTS, "f4")) as arrays:
            good = arrays["a"]

            def error(**change):
                place = {key: value for key, value in {**good, **change}.items() if value is not None}
                client.count += 1
                client.write(json.dumps({"jsonrpc": "2.0", "id": client.count, "method": "load",
                                         "params": {"text": text, "folder": "/", "arrays": {"a": place}}}) + "\n")
                found = client.read()["error"]
                self.assertEqual(found["code"], -32602, found)
                return found["message"]
            link = "/dev/shm/candela-shared-link"
            pipe = f"/dev/shm/candela-shared-pipe-{os.getpid()}"
            inside = Path(folder, "candela-shared-1")
            inside.write_bytes(bytes(48))
            os.symlink(good["file"], link)
            os.mkfifo(pipe)
            try:
                for path in ("/etc/passwd", "/dev/shm/none", "/dev/shm/candela-shared-none", link, pipe, str(inside),
                             "/dev/shm/../shm/" + os.path.basename(good["file"]), "candela-shared-1", "/dev/shm/candela-shared-a\n"):
                    self.assertRegex(error(file=path), "^request:1:[0-9]+: no shared memory is called .*: it must be a file of this user "
                                                       "in /dev/shm or .*, whose name begins with \"candela-shared-\"")
            finally:
                os.unlink(link)
                os.unlink(pipe)
            self.assertIn("the array needs [6,3] numbers, and its file has 64 bytes from the offset 0 on; write all of it",
                          error(shape=[6, 3]))
            self.assertIn("the array needs", error(offset=60))
            self.assertIn("the array needs", error(offset=1 << 40))
            self.assertIn("the array needs", error(shape=[4294967295] * 4))
            self.assertIn("expected a whole number of bytes", error(offset=-4))
            self.assertIn("expected a whole number of bytes", error(offset=0.5))
            self.assertIn('unknown type "float6" (did you mean "float16"?', error(type="float6"))
            self.assertIn("expected one to four whole numbers", error(shape=[]))
            self.assertIn("expected a whole number from 0", error(shape=[-1, 3]))
            self.assertIn('the key "file" is missing', error(file=None))
            self.assertIn('unknown key "size"', error(size=3))
            client.count += 1
            client.write(json.dumps({"jsonrpc": "2.0", "id": client.count, "method": "load",
                                     "params": {"file": "/none.json", "arrays": {}}}) + "\n")
            self.assertIn('"arrays" go with "text"', client.read()["error"]["message"])
            load(client, json.loads(text), arrays)
            client.call("set", scene="1", change={})
            self.assertIn("the scene was made from arrays, and cannot be read at another time",
                          client.error("set", scene="1", time=None)["message"])
            with Client("--memory-limit", "64M") as small, shared(a=numpy.zeros((6 << 20, 3), "f4")) as much:
                refused = small.error("load", text=text, folder="/", arrays=much)
                self.assertEqual(refused["data"]["kind"], "out_of_memory", refused)
                self.assertIn("there is not enough memory for a scene of these arrays", refused["message"])

    def test_a_file_that_shrinks_while_it_is_read_is_an_error(self):
        count = 1 << 20
        points = numpy.random.default_rng(1).random((count, 3), "f4")
        triangles = numpy.arange(count // 3 * 3).reshape(-1, 3)
        text = json.dumps(scene_of(positions={"array": "a"}, triangles={"array": "t"}))
        with Client() as client:
            for rest in (0, 4096, 12 * count, 12 * count + 64):
                with shared(a=points, t=triangles) as arrays:
                    # The second array is not read before the first has been.
                    number = client.send("load", text=text, folder="/", arrays=arrays)
                    os.truncate(arrays["a"]["file"], rest)
                    answer = client.read()
                self.assertEqual(answer["id"], number)
                self.assertRegex(answer["error"]["message"], "the array needs .*write all of it|ends before byte [0-9]+; keep the file")
            load(client, scene_of(positions=POINTS, triangles=FACES))

    def test_whoever_dies_leaves_no_file(self):
        script = ("import sys, time; sys.path[:0] = sys.argv[1:3]\n"
                  "import numpy; from candela._shared import SharedArrays; from candela._connection import Connection\n"
                  "connection = Connection([])\n"
                  "with SharedArrays({'a': (numpy.zeros(9), None)}) as arrays:\n"
                  "    print(arrays['a']['file'], connection._process.pid, flush=True); time.sleep(1000)\n")
        client = subprocess.Popen([sys.executable, "-c", script, str(ROOT / "integrations/python"), str(ROOT / "tests/python")],
                                  stdout=subprocess.PIPE, text=True)
        path, program = client.stdout.readline().split()
        self.assertTrue(os.path.exists(path))
        client.kill()
        client.communicate()
        while runs(program):
            time.sleep(0.01)
        self.assertFalse(os.path.exists(path))
        with shared(a=numpy.zeros(9)) as arrays:  # The program, and another one.
            with Client() as client:
                client.send("version")
                client.read()
                client.process.kill()
                client.process.communicate()
            with Client() as another:
                another.call("version")
            self.assertTrue(os.path.exists(arrays["a"]["file"]))
        self.assertFalse(os.path.exists(arrays["a"]["file"]))


class Objects(unittest.TestCase):
    SHAPES = {"pot": {"type": "mesh", "positions": POINTS, "triangles": FACES},
              "wall": {"type": "quad", "vertices": [[-1, -1, -2], [1, -1, -2], [1, 1, -2], [-1, 1, -2]]},
              "ball": {"type": "sphere", "center": [0.5, 0.5, 0], "radius": 0.5},
              "plate": {"type": "disk", "normal": [0, 1, 1], "center": [0, -1, 0]},
              "box": {"type": "box", "min": [-1.5, -1, 0], "max": [-1, 0, 0.5]}}
    # A turn, with a mirror image that is half as large.
    PLACES = {"pot": TURN, "wall": [-0.5, 0, 0, 1, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1],
              "ball": [0, 0.5, 0, 1, -0.5, 0, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1], "plate": [-1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 2, 0, 0, 0, 0, 1],
              "box": [-1, 0.25, 0, 0, 0, 1, 0, 0.5, 0, 0, 1, 0, 0, 0, 0, 1]}

    def scene(self, placed=(), left_out=(), **more):
        shapes = [{"name": name, "material": "clay", **shape,
                   **({"transform": [{"matrix": self.PLACES[name]}]} if name in placed else {})}
                  for name, shape in self.SHAPES.items() if name not in left_out]
        return {"cameras": {"main": {**CAMERA, "position": [0.5, 1, 4]}}, "film": {"size": [24, 18]}, "environment": {"radiance": 1},
                "lights": [{"type": "point", "position": [2, 3, 4], "intensity": 9}],
                "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}}, "shapes": shapes, **more}

    def test_a_moved_object_is_that_of_a_scene_with_this_transform(self):
        with Client() as client, Client() as fresh:
            load(client, self.scene())
            at_first = picture(client)
            for name, matrix in self.PLACES.items():
                with self.subTest(name):
                    client.call("set", scene="1", change={"objects": {name: {"transform": [{"matrix": matrix}]}}})
                    load(fresh, self.scene([name]), scene="1")
                    moved = picture(client)
                    self.assertTrue(moved == picture(fresh))
                    self.assertTrue(moved != at_first)
                    described = client.call("object", scene="1", object=name)["instances"]
                    self.assertEqual(described[0]["transform"], matrix)
                    self.assertEqual((len(described), described[0]["visible"], described[0]["materials"]), (1, True, ["clay"]))
                    client.call("set", scene="1", change={"objects": {name: {"transform": []}}})
                    self.assertTrue(picture(client) == at_first)
            every = {name: {"transform": [{"matrix": matrix}]} for name, matrix in self.PLACES.items()}
            client.call("set", scene="1", change={"objects": every})
            load(fresh, self.scene(self.PLACES), scene="1")
            self.assertTrue(picture(client) == picture(fresh))
            load(client, self.scene(self.PLACES), scene="1")  # From there, too.
            client.call("set", scene="1", change={"objects": {name: {"transform": []} for name in self.PLACES}})
            self.assertTrue(picture(client) == at_first)

    def test_a_hidden_object_is_not_there(self):
        with Client() as client, Client() as fresh:
            load(client, self.scene(["pot"]))
            at_first = picture(client)
            for name in self.SHAPES:
                with self.subTest(name):
                    client.call("set", scene="1", change={"objects": {name: {"visible": False}}})
                    self.assertFalse(client.call("object", scene="1", object=name)["instances"][0]["visible"])
                    load(fresh, self.scene(["pot"], [name]), scene="1")
                    self.assertTrue(picture(client) == picture(fresh))
                    client.call("set", scene="1", change={"materials": {"clay": {"reflectance": 0.25}}})
                    client.call("set", scene="1", change={"objects": {name: {"visible": True}}, "materials": {"clay": {"reflectance": 0.5}}})
                    self.assertTrue(picture(client) == at_first)
            client.call("set", scene="1", change={"objects": {name: {"visible": False} for name in self.SHAPES}})
            self.assertEqual(set(picture(client)), set(struct.pack("f", 1.0)))
            client.call("set", scene="1", change={"objects": {name: {"visible": True} for name in self.SHAPES}})
            self.assertTrue(picture(client) == at_first)

    def test_instances_are_moved_one_by_one(self):
        parts = [{key: value for key, value in {"material": "clay", **shape}.items() if key != "name"} for shape in self.SHAPES.values()]
        half = [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]
        moved = [0, 0.5, 0, 1, -0.5, 0, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1]

        def scene(places):
            transforms = [[{"matrix": place}] for place in places]
            return self.scene(objects={"set": parts}, shapes=[{"type": "instance", "object": "set", "transforms": transforms}])
        with Client() as client, Client() as fresh:
            load(client, scene([half, TURN]))
            client.call("set", scene="1", change={"objects": {"set": {"instances": {"1": {"transform": [{"matrix": moved}]}}}}})
            load(fresh, scene([half, moved]))
            self.assertTrue(picture(client) == picture(fresh))
            client.call("set", scene="1", change={"objects": {"set": {"visible": False, "instances": {"0": {"visible": True}}}}})
            load(fresh, scene([half]), scene="1")
            self.assertTrue(picture(client) == picture(fresh))
            self.assertEqual([one["visible"] for one in client.call("object", scene="1", object="set")["instances"]], [True, False])

    def test_another_mesh_is_that_of_a_scene_with_it(self):
        smaller = {"positions": POINTS[:3], "triangles": [[0, 1, 2]]}
        larger = {"positions": [*POINTS, [2, 2, 0]], "triangles": [*FACES, [1, 4, 2]], "normals": [*POINTS, [2, 2, 0]],
                  "uvs": [*UVS, [0, 0]], "uvs1": [*UVS, [0, 0]], "colors": [*COLORS, [1, 1, 1]]}
        with Client() as client, Client() as fresh:
            load(client, self.scene(["pot"]))
            for lists in (smaller, larger, self.SHAPES["pot"]):
                lists = {key: value for key, value in lists.items() if key != "type"}
                names = {key: {"array": key} for key in lists}
                with shared(**lists) as arrays:
                    client.call("set", scene="1", change={"meshes": {"pot": names}}, arrays=arrays)
                place = {"name": "pot", "type": "mesh", "material": "clay", "transform": [{"matrix": TURN}]}
                shapes = [{**place, **lists}, *self.scene()["shapes"][1:]]
                load(fresh, self.scene(shapes=shapes), scene="1")
                self.assertTrue(picture(client) == picture(fresh))
            twice = {"type": "instance", "object": "pots", "transforms": [[], [{"translate": [1, 0, 0]}]]}
            load(client, self.scene(objects={"pots": [{"material": "clay", **self.SHAPES["pot"]}]}, shapes=[twice]), scene="1")
            client.call("set", scene="1", change={"meshes": {"pots": smaller}})
            load(fresh, self.scene(objects={"pots": [{"material": "clay", "type": "mesh", **smaller}]}, shapes=[twice]), scene="1")
            self.assertTrue(picture(client) == picture(fresh))

    def test_other_lights_take_the_place_of_all(self):
        lamps = [{"type": "directional", "direction": [0, -1, -1], "irradiance": 1}, self.scene()["lights"][0]]
        with Client() as client, Client() as fresh:
            load(client, self.scene())
            for lights in (lamps, lamps[:1], [], lamps):
                client.call("set", scene="1", change={"lights": lights})
                load(fresh, self.scene(lights=lights), scene="1")
                self.assertTrue(picture(client) == picture(fresh))
                self.assertEqual(len(client.call("scene", scene="1")["lights"]), len(lights))
            before = picture(client)
            self.assertIn('unknown type "lamp"', client.error("set", scene="1", change={"lights": [{"type": "lamp"}]})["message"])
            self.assertTrue(picture(client) == before)

    def test_a_short_latency_leaves_the_picture_as_it_is(self):
        with Client() as client:
            load(client, self.scene())
            before = picture(client)
            self.assertTrue(picture(client, latency=1e-6, seed=0) == before)
            self.assertTrue(picture(client, latency=1e-6, seed=1) != before)
            self.assertTrue(picture(client, latency=1e-6, seed=0) == before)

    def test_a_mesh_that_cannot_be_is_refused(self):
        clay = {"type": "diffuse", "reflectance": {"image": {"array": "image"}}}
        mesh = {"positions": POINTS, "triangles": FACES}
        with Client() as client, shared(image=numpy.full((2, 2, 3), 128, "u1")) as arrays:
            scene = self.scene(objects={"two": [{"material": "clay", **self.SHAPES["pot"]}, {"type": "sphere", "material": "clay"}]})
            scene["shapes"] += [{"type": "instance", "object": "two"}, {"type": "mesh", "name": "cloth", "material": "cloth", **mesh, "uvs": UVS}]
            scene["materials"]["cloth"] = clay
            load(client, scene, arrays)
            before = picture(client)
            for meshes, message in (({"vase": mesh}, 'unknown object "vase"'), ({"ball": mesh}, 'the object "ball" is not one mesh of its own'),
                                    ({"two": mesh}, 'the object "two" is not one mesh of its own'),
                                    ({"pot": {**mesh, "material": "clay"}}, 'unknown key "material"'),
                                    ({"pot": {"positions": POINTS}}, '"triangles"'),
                                    ({"pot": {**mesh, "triangles": [[0, 1, 4]]}}, "expected a whole number from 0 to 3"),
                                    ({"pot": {**mesh, "positions": [[0, 0, 0]] * 4}}, "the mesh has no triangle with an area"),
                                    ({"pot": {**mesh, "positions": [[0, 0, 0], [2e37, 0, 0], [0, 2e37, 0], [0, 0, 1]]}}, "the shape reaches beyond 1e37"),
                                    ({"cloth": mesh}, "has textures, but the mesh has no texture coordinates")):
                change = {"meshes": meshes, "materials": {"clay": {"reflectance": 0.1}}}
                error = client.error("set", scene="1", change=change)["message"]
                self.assertIn(message, error)
                self.assertRegex(error, "^change")
            self.assertTrue(picture(client) == before)
            flat = {**mesh, "triangles": [*FACES, [0, 0, 1]]}
            self.assertIn("left out 1 triangle without area", client.call("set", scene="1", change={"meshes": {"pot": flat}})["warnings"][0])

    def test_errors_leave_the_scene_as_it_was(self):
        with Client() as client:
            load(client, self.scene(objects={"set": [{"type": "sphere", "material": "clay"}]},
                                    shapes=self.scene()["shapes"] + [{"type": "instance", "object": "set", "transforms": [[], []]}]))
            before = picture(client)
            wrong = [({"vase": {}}, 'unknown object "vase" (defined: ball, box, plate, pot, set, wall)'),
                     ({"pot": {"visible": 1}}, '"visible": expected true or false'),
                     ({"pot": {"visibl": True}}, 'unknown key "visibl" (did you mean "visible"?'),
                     ({"pot": {"transform": [{"scale": 0}]}}, "the transform is singular"),
                     ({"pot": {"transform": [{"translate": [1e38, 0, 0]}]}}, 'the object "pot": the shape reaches beyond 1e37'),
                     ({"ball": {"transform": [{"scale": [1, 2, 1]}]}}, 'the object "ball" cannot be placed so: the transform flattens it'),
                     ({"set": {"transform": []}}, 'the object "set" is shown 2 times; give the transforms of its "instances"'),
                     ({"set": {"instances": {"2": {}}}}, 'expected the number of an instance, from 0 to 1, found "2"'),
                     ({"set": {"instances": {"a": {}}}}, 'expected the number of an instance, from 0 to 1, found "a"')]
            for objects, message in wrong:
                error = client.error("set", scene="1", change={"objects": objects, "materials": {"clay": {"reflectance": 0.1}}})
                self.assertIn(message, error["message"])
                self.assertRegex(error["message"], "^change")
            self.assertIn('unknown object "vase"', client.error("object", scene="1", object="vase")["message"])
            self.assertTrue(picture(client) == before)

    def test_values_of_materials_change_one_by_one(self):
        materials = {"clay": {"type": "principled", "base_color": [0.5, 0.4, 0.3], "coat": 1, "coat_roughness": 0.25},
                     "glass": {"type": "dielectric", "ior": 1.5}, "paint": {"type": "phong", "diffuse": 0.5, "specular": 0.25, "exponent": 9},
                     "tin": {"type": "conductor", "reflectance": 0.5, "alpha": 0.5}, "mirror": {"type": "mirror"},
                     "leaf": {"type": "diffuse_transmission", "reflectance": 0.5, "transmittance": 0.25},
                     "wall": {"type": "diffuse", "reflectance": 0.5}}
        changes = {"clay": {"base_color": 0.25, "roughness": 0.125, "vertex_colors": True}, "glass": {"ior": 1.25}, "paint": {"specular": 0.5},
                   "tin": {"alpha": 0.25}, "mirror": {"reflectance": 0.75}, "leaf": {"transmittance": 0.5}, "wall": {"reflectance": [0.25, 0.5, 0.75]}}
        shapes = [{"type": "sphere", "center": [i - 3, 0, 0], "radius": 0.5, "material": name} for i, name in enumerate(materials)]
        with Client() as client, Client() as fresh:
            load(client, {**self.scene(), "materials": materials, "shapes": shapes})
            for name, change in changes.items():
                client.call("set", scene="1", change={"materials": {name: change}})
                materials[name] = {**materials[name], **change}
                load(fresh, {**self.scene(), "materials": materials, "shapes": shapes}, scene="1")
                self.assertTrue(picture(client) == picture(fresh), name)
                values = client.call("material", scene="1", material=name)["values"]
                self.assertEqual(values["type"], materials[name]["type"])
                for key, value in materials[name].items():
                    if key != "type":
                        numpy.testing.assert_allclose(values[key], value, rtol=1e-7)
            for name, change, message in (("wall", {"alpha": 1}, 'unknown key "alpha"'), ("paint", {"diffuse": 0.75}, "diffuse + specular is 1.25 in red"),
                                          ("tin", {"alpha": 0}, 'a "conductor" needs some roughness'), ("glass", {"ior": 1e-9}, "differ by a factor above a million"),
                                          ("clay", {"dispersion": 1}, "a thin wall does not disperse light"),
                                          ("clay", {"absorption": {"transmittance": 0.5, "distance": 1}}, "no light would reach the medium inside"),
                                          ("clay", {"absorption": {"transmittance": 0.5, "distance": 1}, "thin_walled": True}, "a thin wall has no inside")):
                self.assertIn(message, client.error("set", scene="1", change={"materials": {name: change}})["message"])
            self.assertIn('unknown material "none"', client.error("material", scene="1", material="none")["message"])

    def test_layers_of_ids(self):
        scene = self.scene(objects={"set": [{"type": "sphere", "radius": 0.25, "material": "clay"}]})
        scene["shapes"] = [{"name": "wall", "material": "paint", **self.SHAPES["wall"]},
                           {"type": "instance", "object": "set", "transforms": [[{"translate": [0.5, 0, 0]}], [{"translate": [-0.5, 0, 0]}]]}]
        scene["materials"]["paint"] = {"type": "mirror"}
        with Client() as client:
            load(client, {**scene, "cameras": {"main": CAMERA}})
            client.call("render", scene="1", spp=1, layers=["object_id"])
            image = client.call("image", scene="1")
            data = Path(image["file"]).read_bytes()
            labels = client.call("labels", image=image["image"])

            def at(layer, x, y):
                return int(struct.unpack_from("f", data, image["layers"][layer]["offset"] + 4 * (y * 24 + x))[0])
            self.assertEqual(labels["objects"][at("object_id", 12, 9) - 1], "wall")
            self.assertEqual(labels["materials"][at("material_id", 12, 9) - 1], "paint")
            self.assertEqual(at("object_id", 0, 0), 0)
            for x, number in ((16, 0), (7, 1)):
                instance = labels["instances"][at("instance_id", x, 9) - 1]
                self.assertEqual((labels["objects"][instance["object"] - 1], instance["instance"]), ("set", number))
            client.call("render", scene="1", spp=1)
            plain = client.call("image", scene="1")
            self.assertIn("the image has no layers of ids; render it with the layer object_id",
                          client.error("labels", image=plain["image"])["message"])


if __name__ == "__main__":
    os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
