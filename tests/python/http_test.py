#!/usr/bin/env python3
"""Pictures over HTTP, as any client gets them. usage: http_test.py CANDELA [TEST...]"""
import base64
import hashlib
import json
import os
import socket
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

from http_server import HANG, MODEL, ROOT, SCENE, HttpCase, Server, form, main, png_of, receive


class Http(HttpCase):
    """What is answered."""

    def test_pictures_are_those_of_the_command_line(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene").write_bytes(SCENE)
            subprocess.run([os.environ["CANDELA"], "render", f"{folder}/scene", "-q", "--spp", "3", "--seed", "5",
                            "--size", "24x16", "-o", f"{folder}/a.png", "-o", f"{folder}/a.jpg", "-o",
                            f"{folder}/a.webp"], check=True)
            for kind, form_of in (("png", "image/png"), ("jpg", "image/jpeg"), ("webp", "image/webp")):
                expected = (Path(folder) / f"a.{kind}").read_bytes()
                query = f"/render?spp=3&seed=5&size=24x16&format={kind}"
                status, headers, data = self.server.ask("POST", query, SCENE, MODEL)
                self.assertEqual((status, headers["Content-Type"]), (200, form_of))
                self.assertEqual((headers["Candela-Spp"], headers["Candela-Complete"]), ("3", "true"))
                self.assertTrue(data == expected)
        options = {"spp": 3, "seed": 5, "size": [24, 16], "format": "webp"}
        by_name = self.server.ask("POST", "/render", json.dumps({**options, "file": "deep/scene.json"}),
                                  {"Content-Type": "application/json"})
        self.assertEqual((by_name[0], by_name[2]), (200, expected))
        self.assertEqual(self.server.ask("POST", query + "&file=/in.json")[2], expected)
        fields = [(name, None, json.dumps(value).encode()) for name, value in options.items() if name != "format"]
        body, headers = form([*fields, ("format", None, b"webp"), ("scene", "../../a.glb", SCENE)])
        self.assertEqual(self.server.ask("POST", "/render", body, headers)[2], expected)
        status, headers, exr = self.server.ask("POST", "/render?spp=2&format=exr&layers=all", SCENE, MODEL)
        self.assertEqual((status, headers["Content-Type"], exr[:4]), (200, "image/x-exr", b"\x76\x2f\x31\x01"))
        self.assertIn(b"Albedo.R", exr)

    def test_scenes_stay_loaded(self):
        scene = SCENE.replace(b"0.5", b"0.25")
        before = self.server.metrics()
        first = self.server.picture("spp=2", scene)
        self.server.picture("spp=1", scene)
        self.assertEqual(self.server.picture("spp=2", scene), first)
        after = self.server.metrics()
        self.assertEqual(after["candela_scenes_loaded_total"] - before["candela_scenes_loaded_total"], 1)
        self.assertEqual(after["candela_scenes_reused_total"] - before["candela_scenes_reused_total"], 2)
        for shade in range(5):  # More than stay loaded.
            self.server.picture("spp=1", SCENE.replace(b"0.5", f"0.{shade + 1}5".encode()))
        self.assertEqual(self.server.picture("spp=2", scene), first)

    def test_health_and_metrics(self):
        status, headers, data = self.server.ask("GET", "/health")
        self.assertEqual((status, headers["Content-Type"], json.loads(data)["status"]), (200, "application/json", "ok"))
        status, headers, data = self.server.ask("HEAD", "/health")
        self.assertEqual((status, data), (200, b""))
        before = self.server.metrics()
        self.server.picture("spp=1")
        self.server.ask("GET", "/nothing")
        status, headers, data = self.server.ask("GET", "/metrics")
        self.assertEqual(headers["Content-Type"], "text/plain; version=0.0.4; charset=utf-8")
        self.server.wait_until("candela_requests_pending", 0)  # An answer may arrive before its request has ended.
        after = self.server.metrics()
        for name in ('candela_http_requests_total{code="200"}', "candela_pictures_total", "candela_sent_bytes_total",
                     "candela_render_seconds_total", "candela_received_bytes_total"):
            self.assertGreater(after[name], before[name])
        self.assertEqual(after['candela_http_requests_total{code="404"}'] -
                         before.get('candela_http_requests_total{code="404"}', 0), 1)
        for line in data.decode().splitlines():  # The format, by its grammar.
            self.assertRegex(line, r'^(# (HELP \w+ .+|TYPE \w+ (counter|gauge))|\w+(\{\w+="\w+"\})? [0-9.e+-]+)$')

    def test_methods_and_addresses(self):
        for method, path, status in (("GET", "/render", 405), ("HEAD", "/render", 405), ("POST", "/health", 405),
                                     ("PUT", "/render", 405), ("DELETE", "/metrics", 405), ("OPTIONS", "/render", 405),
                                     ("GET", "/", 404), ("POST", "/renderer", 404), ("PUT", "/x", 404),
                                     ("GET", "/health/../render", 404), ("BREW", "/render", 501),
                                     ("GET", "/" + 70000 * "a", 414)):
            answer = self.server.ask(method, path)
            self.assertEqual(answer[0], status, (method, path[:20]))
            self.assertEqual("Allow" in answer[1], status == 405)
        self.assertEqual(self.server.ask("GET", "/render")[1]["Allow"], "POST")
        for garbage, expected in ((b"\r\n\r\n", b""), (b"\0\1\2\r\n\r\n", b"Bad request syntax"), (b"", b""),
                                  (b"GET / HTTP/9.9\r\n\r\n", b"Invalid HTTP version"),
                                  (b"GET /health HTTP/1.1\r\n" + 200 * b"a: b\r\n" + b"\r\n", b"HTTP/1.1 431 ")):
            with self.server.connect() as connection:
                connection.sendall(garbage)
                connection.shutdown(socket.SHUT_WR)
                self.assertIn(expected, receive(connection))

    def test_options_that_are_wrong(self):
        for query, message in (("spp=0", "spp"), ("spp=many", "spp"), ("samples=4", "unknown option 'samples'"),
                               ("format=gif", "unknown format 'gif'"), ("spp=1&spp=2", "an option twice"),
                               ("camera=none", '"none"'), ("size=0x12", "size"), ("size=70000x1", "size"),
                               ("crop=0,0,99,99", "crop"), ("layers=nothing", "layers"), ("tonemap=x", "tonemap"),
                               ("file=deep/scene.json", "either a scene, or"), ("%FF=1", "not a list of"),
                               ("spp", "not a list of"), ("time_limit=-1", "time_limit"), ("spp=" + 5000 * "[", "spp"),
                               ("&".join(f"a{i}=1" for i in range(99)), "at most 64 options")):
            self.assert_refused(400, message, self.server.ask("POST", "/render?" + query, SCENE, MODEL))
        for body, message in ((b"", "not JSON"), (b"[1]", "not an object"), (b"{", "not JSON"), (b"\xff", "not JSON"),
                              (b'{"file": 7}', '"file" is not the name'), (b"{}", "either a scene, or"),
                              (b"[" * 200000, "not JSON"),
                              (b'{"file": "deep/scene.json", "size": "x"}', "size")):
            self.assert_refused(400, message, self.server.ask(
                "POST", "/render", body, {"Content-Type": "application/json"}))
        self.assert_refused(400, "is in the address and in the request", self.server.ask(
            "POST", "/render?spp=1", b'{"file": "in.json", "spp": 1}', {"Content-Type": "application/json"}))
        self.assert_refused(413, "options have 2000000 bytes", self.server.ask(
            "POST", "/render", 2000000 * b" ", {"Content-Type": "application/json"}))
        for scene, message in ((b"", "either a scene, or"), (b"glTF", "cut off|too short|bytes"), (b"{}", "scene"),
                               (b"\x00" * 99, "scene"), (SCENE[:-9], "scene")):
            answer = self.server.ask("POST", "/render", scene, MODEL)
            self.assertIn(answer[0], (400, 422))
            self.assertRegex(answer[2].decode(), message)

    def test_no_path_leaves_the_root(self):
        secret = f"{self.root.name}/secret.json"
        for name in ("../secret.json", "deep/../../secret.json", secret, "link.json", "out/secret.json", "deep", "",
                     "/", "\0", "a" * 5000, "/proc/self/environ", "..", "deep/scene.json/x", "%2e%2e/secret.json"):
            answer = self.server.ask("POST", "/render", json.dumps({"file": name}),
                                     {"Content-Type": "application/json"})
            self.assert_refused(404, "there is no file", answer)
        self.assertEqual(self.server.ask("POST", "/render?spp=1&file=%2e%2e/secret.json")[0], 404)
        names = json.loads(SCENE)
        for name in (secret, "../../secret.ply", "/etc/passwd", "../scene"):  # A scene that names files.
            names["shapes"] = [{"type": "ply", "file": name, "material": "clay"}]
            answer = self.server.ask("POST", "/render", json.dumps(names), MODEL)
            self.assertEqual(answer[0], 422, answer[2])
            self.assertNotIn(b"root:", answer[2])
        with Server() as other:
            answer = other.ask("POST", "/render?file=x.json")
            self.assert_refused(403, "the server has no --root", answer)

    def test_drakes_requests(self):
        corners = struct.pack("<9f", -1, 0, -1, 1, 0, -1, 0, 0, 1)  # In a world with +Z up, seen along +Y from 4 m.
        gltf = {"asset": {"version": "2.0", "generator": "VTK"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
                "nodes": [{"mesh": 0}, {"camera": 0, "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -4, 0, 1]}],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01, "aspectRatio": 2}}],
                "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [3 / 255, 1 / 255, 0, 1]}}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,"
                             + base64.b64encode(corners).decode()}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, 0, -1],
                               "max": [1, 0, 1]}]}
        scene = json.dumps(gltf).encode()
        fields = {"scene_sha256": hashlib.sha256(scene).hexdigest(), "image_type": "color", "width": "32",
                  "height": "16", "near": "0.01", "far": "10", "focal_x": "16", "focal_y": "16", "fov_x": "1.57",
                  "fov_y": "0.93", "center_x": "8", "center_y": "8", "submit": "Render"}

        def post(query="", scene=scene, **changed):
            values = {name: value for name, value in {**fields, **changed}.items() if value is not None}
            parts = [(name, None, value.encode()) for name, value in values.items()]
            body, headers = form([*parts, ("scene", "0-color.gltf", scene)])
            return self.server.ask("POST", "/render" + query, body, headers)

        status, headers, png = post("?spp=1")
        self.assertEqual((status, headers["Content-Type"], png_of(png)[0]), (200, "image/png", (32, 16)))
        status, headers, tiff = post(image_type="depth", min_depth="0.1", max_depth="10")
        self.assertEqual((status, headers["Content-Type"]), (200, "image/tiff"), tiff)
        depth = numpy.frombuffer(tiff[-32 * 16 * 4:], "<f4").reshape(16, 32)
        # The triangle spans 8 pixels, whose middle is the principal point: (8, 8), not the picture's middle.
        x, y = numpy.arange(32) + 0.5 - 8, 8 - numpy.arange(16)[:, None] - 0.5
        inside = (y > -4) & (abs(x) < (4 - y) / 2)
        numpy.testing.assert_array_equal(depth[inside], 4)  # Along the axis, not along the ray.
        self.assertTrue(numpy.isinf(depth[~inside]).all())
        near = numpy.frombuffer(post(image_type="depth", min_depth="5", max_depth="10")
                                [2][-2048:], "<f4").reshape(16, 32)
        self.assertTrue((near[inside] == 0).all() and numpy.isinf(near[~inside]).all())
        far = numpy.frombuffer(post(image_type="depth", min_depth="0.1", max_depth="3.9")[2][-2048:], "<f4")
        self.assertTrue(numpy.isinf(far).all())
        status, headers, png = post(image_type="label")
        self.assertEqual((status, headers["Content-Type"]), (200, "image/png"))
        size, pixels = png_of(png)
        self.assertEqual(size, (32, 16))
        self.assertTrue((pixels[inside] == (3, 1, 0)).all() and (pixels[~inside] == 255).all())
        before = self.server.metrics()
        post(image_type="label")
        self.assertEqual(self.server.metrics()["candela_scenes_loaded_total"], before["candela_scenes_loaded_total"])

        for changed, message in (({"image_type": "normal"}, "image_type is 'normal'"), ({"width": "0"}, "width is '0'"),
                                 ({"width": None}, "it has no field width"), ({"focal_x": "x"}, "focal_x is 'x'"),
                                 ({"focal_y": "-1"}, "focal_y is '-1'"), ({"center_x": "nan"}, "center_x is 'nan'"),
                                 ({"scene_sha256": 64 * "0"}, "send it again"), ({"image_type": "depth"},
                                                                                 "no field min_depth"),
                                 ({"query": "?size=4x4"}, "'size' in the address contradicts the form"),
                                 ({"query": "?spp=0"}, "spp"), ({"query": "?sp=1"}, "unknown option 'sp'")):
            self.assert_refused(400, message, post(**changed))
        self.assert_refused(413, "need at least", post(width="65536", height="65536"))
        for bad in (b"{}", b"[]", b"glTF", b"[" * 200000, json.dumps({**gltf, "nodes": 3}).encode(),
                    json.dumps({**gltf, "scene": 7}).encode(), json.dumps({**gltf, "materials": 3}).encode()):
            sha256 = hashlib.sha256(bad).hexdigest()
            self.assert_refused(422, "scene|world|glTF", post(scene=bad, scene_sha256=sha256, image_type="label"))
        body, headers = form([(name, None, value.encode()) for name, value in fields.items()])
        self.assert_refused(400, "it has no scene", self.server.ask("POST", "/render", body, headers))

    def test_its_command_line(self):
        def run(*options, **more):
            environment = {**os.environ, "PYTHONPATH": str(ROOT / "integrations/python"), **more}
            done = subprocess.run([sys.executable, "-m", "candela.serve", *options], env=environment,
                                  text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=HANG)
            return done.returncode, done.stdout + done.stderr
        for options, message in ((("--port", "70000"), "no port from 0 to 65535"), (("--root", "/none"),
                                                                                    "no folder '/none'"),
                                 (("--memory-limit", "much"), "no size"), (("--time-limit", "0"), "no time above 0"),
                                 (("--por", "1"), "unrecognized"), (("--queue", "-1"), "no number|expected one")):
            code, text = run(*options)
            self.assertEqual(code, 2)
            self.assertRegex(text, message)
        code, text = run("--help")
        self.assertEqual(code, 0)
        self.assertIn("--memory-limit", text)
        code, text = run("--port", str(self.server.port))
        self.assertEqual(code, 1)
        self.assertRegex(text, f"cannot listen at 127.0.0.1:{self.server.port}: .*; choose another --port")
        code, text = run("--port", "0", CANDELA="/none")
        self.assertEqual(code, 3)
        self.assertIn("cannot run '/none'", text)
        code, text = run("--port", "0", VK_DRIVER_FILES="/none", VK_ICD_FILENAMES="/none")
        self.assertEqual(code, 3)
        self.assertRegex(text, "no Vulkan device|install")


if __name__ == "__main__":
    main()
