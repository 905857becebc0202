#!/usr/bin/env python3
"""The program `candela serve`, as any client sees it. usage: serve_test.py CANDELA [TEST...]"""
import json
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from serve_client import FOREVER, ROOT, SCENE, SCHEMA, Client


class Serve(unittest.TestCase):
    def test_describes_itself_and_its_scenes(self):
        with Client() as client:
            self.assertEqual(client.call("version", protocol=1)["protocol"], 1)
            error = client.error("version", protocol=2)
            self.assertRegex(error["message"], "the client speaks version 2 of the protocol, and candela .* speaks version 1; "
                                               "update the older of the two")
            self.assertEqual(error["data"], {"kind": "usage", "exit_code": 2})
            self.assertTrue(any(device["default"] for device in client.call("devices")["devices"]))
            loaded = client.call("load", text=SCENE, folder="/")
            self.assertEqual((loaded["scene"], loaded["size"], loaded["materials"]), ("1", [16, 12], ["clay"]))
            self.assertEqual(list(loaded["cameras"]), ["main", "side"])
            self.assertEqual(loaded["cameras"]["side"]["position"], [3, 0, 0])
            self.assertEqual(loaded["bounds"], [[-1, -1, -1], [1, 1, 1]])
            described = client.call("scene", scene="1")
            self.assertEqual(described, {key: loaded[key] for key in described})
            self.assertEqual(client.end(), (0, ""))

    def test_a_picture_depends_on_nothing_before_it(self):
        near = {"position": [0, 0, 2], "look_at": [0, 0, 0], "vertical_fov": 40}
        clay = {"type": "diffuse", "reflectance": 0.5}
        with Client() as client, Client() as fresh:
            client.load()
            client.call("render", scene="1", spp=8)
            self.assertEqual(client.call("render", scene="1", spp=2)["spp"], 2)
            few = client.pixels()
            client.call("render", scene="1", spp=4, layers="all", target_error=1e-9)
            self.assertEqual(client.call("render", scene="1", spp=8, layers="all")["spp"], 8)
            image = client.call("image", scene="1")
            known = SCHEMA["$defs"]["methods"]["render"]["params"]["properties"]["layers"]["oneOf"][1]["items"]["enum"]
            self.assertEqual(list(image["layers"]),
                             [layer for layer in known if not layer.endswith("_id") and not layer.startswith("crypto_")])
            self.assertEqual(struct.unpack_from("f", Path(image["file"]).read_bytes(), image["layers"]["samples"]["offset"]),
                             (8.0,))
            on = client.pixels()
            client.call("set", scene="1", change={"cameras": {"main": near}, "materials": {"clay": {"type": "mirror"}}})
            client.call("render", scene="1", spp=8, camera="main")
            moved = client.pixels()
            client.call("set", scene="1", change={"materials": {"clay": clay}})
            client.call("render", scene="1", spp=8, camera={**near, "position": [0, 0, 3]})
            back = client.pixels()
            fresh.load()
            fresh.call("render", scene="1", spp=2)
            self.assertTrue(fresh.pixels() == few)
            fresh.call("render", scene="1", spp=8)
            whole = fresh.pixels()
            self.assertTrue(whole == on)
            self.assertTrue(whole == back)
            self.assertTrue(whole != moved)

    def test_a_time_limit_is_that_of_the_request(self):
        with Client() as client:
            client.load()
            client.call("render", scene="1", spp=1)
            short = client.call("render", scene="1", spp=FOREVER, time_limit=0.1)  # Goes on from the first sample.
            self.assertFalse(short["complete"])
            more = short["spp"] + 10000  # For longer than that.
            self.assertTrue(client.call("render", scene="1", spp=more)["complete"])

    def test_cancels_a_rendering_and_goes_on(self):
        with Client() as client, Client() as fresh:
            client.load()
            first = client.send("render", scene="1", spp=FOREVER, progress=True)
            waiting = client.send("render", scene="1", spp=1)
            while not client.told:
                client.told.append(json.loads(client.process.stdout.readline())["params"])
            self.assertEqual(client.told[0]["request"], first)
            self.assertEqual(client.call("cancel")["cancelled"], 2)
            answer = client.read()
            self.assertEqual((answer["id"], answer["result"]["complete"], answer["result"]["cancelled"]), (first, False, True))
            refused = client.read()
            self.assertEqual((refused["id"], refused["error"]["code"]), (waiting, -32800))
            self.assertEqual(refused["error"]["data"], {"kind": "cancelled", "exit_code": 130})
            spp = answer["result"]["spp"] + 3
            self.assertEqual(client.call("render", scene="1", spp=spp)["spp"], spp)
            fresh.load()
            fresh.call("render", scene="1", spp=spp)
            self.assertTrue(client.pixels() == fresh.pixels())

    def test_with_a_latency_what_is_cancelled_leaves_the_picture_before(self):
        with Client() as client, Client() as fresh:
            for one in (client, fresh):
                one.load()
                one.call("render", scene="1", spp=2)
            hurried = client.send("render", scene="1", spp=FOREVER, latency=1e-3, progress=True)
            while not client.told:
                client.told.append(json.loads(client.process.stdout.readline())["params"])
            client.call("cancel")
            answer = client.read()
            self.assertEqual((answer["id"], answer["result"]["cancelled"], answer["result"]["spp"]), (hurried, True, 2))
            self.assertTrue(client.pixels() == fresh.pixels())
            for one in (client, fresh):
                self.assertEqual(one.call("render", scene="1", spp=3)["spp"], 3)
            self.assertTrue(client.pixels() == fresh.pixels())
            self.assertIn("leave one out", client.error("render", scene="1", latency=1, time_limit=1)["message"])

    def test_cancels_loading(self):
        many = SCENE.replace('"shapes": [', '"shapes": [' + '{"type": "sphere", "material": "clay"}, ' * 200000)
        with Client() as client:
            loading = client.send("load", text=many, folder="/")
            stop = client.send("cancel", request=loading)
            answers = {message["id"]: message for message in (client.read(), client.read())}
            self.assertEqual(answers[stop]["result"], {"cancelled": 1})
            self.assertEqual(answers[loading]["error"]["code"], -32800)
            self.assertIn("scene", client.call("load", text=SCENE, folder="/"))

    def test_keeps_several_scenes(self):
        with Client() as client:
            self.assertEqual([client.load(), client.load(scene="b"), client.load()], ["1", "b", "2"])
            for scene in ("1", "b"):
                client.call("render", scene=scene, spp=2, camera="main" if scene == "b" else "side", seed=len(scene))
            client.call("set", scene="b", change={"materials": {"clay": {"type": "mirror"}}})
            client.call("render", scene="b", spp=2, seed=1)
            self.assertTrue(client.pixels("1") != client.pixels("b"))
            client.call("close", scene="b")
            self.assertRegex(client.error("image", scene="b")["message"], r'unknown scene "b" \(known: 1, 2\)')
            client.call("render", scene="2", spp=2, seed=1, camera="side")
            self.assertTrue(client.pixels("1") == client.pixels("2"))

    def test_errors_leave_the_session_alive(self):
        with Client("--memory-limit", "64M") as client:
            client.load()
            wrong = [("render", {"scene": "1", "sp": 4}, 'unknown key "sp" (did you mean "spp"?'),
                     ("render", {"scene": "1", "layers": ["colour"]}, 'unknown layer "colour"'),
                     ("render", {"scene": "1", "layers": "some"}, 'expected "all" or an array of names'),
                     ("render", {"scene": "1", "size": [0, 4]}, "expected a whole number from 1 to 65536"),
                     ("render", {"scene": "1", "crop": [0, 0, 17, 12]}, "expected a whole number from 1 to 16"),
                     ("render", {"scene": "1", "crop": [0, 0, 3]}, "expected four whole numbers"),
                     ("render", {"scene": "1", "size": [4]}, "expected two whole numbers"),
                     ("render", {"scene": "1", "camera": "top"}, 'unknown camera "top" (defined: main, side)'),
                     ("views", {"scene": "1", "elevation": 5}, '"elevation" goes with "turntable"'),
                     ("set", {"scene": "1"}, 'give either "change" or "time"'),
                     ("set", {"scene": "1", "change": {}, "animation": "a"}, '"animation" goes with "time"'),
                     ("load", {}, 'give either "file", or "text" and "folder"'),
                     ("save", {"image": "7", "file": "a.png"}, 'unknown image "7"')]
            for method, params, message in wrong:
                client.count += 1
                client.write(json.dumps({"jsonrpc": "2.0", "id": client.count, "method": method, "params": params}) + "\n")
                error = client.read()["error"]
                self.assertIn(message, error["message"])
                self.assertEqual(error["code"], -32602, error)
            failing = [("load", {"file": "/none.json"}, "failed", 'cannot read "/none.json"'),
                       ("load", {"text": "{", "folder": "/"}, "failed", "/scene:1:2: "),
                       ("image", {"scene": "1"}, "usage", "nothing of this scene has been rendered yet"),
                       ("set", {"scene": "1", "change": {"materials": {"x": {}}}}, "failed", 'unknown material "x"'),
                       ("load", {"text": SCENE.replace('"shapes": [', '"shapes": [' + '{"type": "sphere", "material": "clay"}, '
                                                       * 200000), "folder": "/"}, "out_of_memory", "not enough memory")]
            for method, params, kind, message in failing:
                error = client.error(method, **params)
                self.assertIn(message, error["message"])
                self.assertEqual((error["code"], error["data"]["kind"]), (-32000, kind), error)
            client.write(json.dumps({"jsonrpc": "2.0", "id": 99, "method": "nothing"}) + "\ngarbage\n\xff\n")
            answers = [client.read() for _ in range(3)]  # Lines that are not requests are answered at once.
            self.assertEqual([a["error"]["code"] for a in answers if a["id"] is None], [-32700, -32700])
            unknown = [a["error"]["message"] for a in answers if a["id"] == 99]
            self.assertIn('unknown method "nothing" (known: version, ', unknown[0])
            client.write("x" * ((64 << 20) + 1) + "\n")
            self.assertIn("a line has more than 67108864 bytes", client.read()["error"]["message"])
            self.assertEqual(client.call("render", scene="1", spp=1)["spp"], 1)

    def test_images_stay_until_they_are_released(self):
        with Client() as client:
            client.load()
            client.call("render", scene="1", spp=1)
            images = [client.call("image", scene="1") for _ in range(2)]
            self.assertEqual(sorted(client.files()), sorted(image["file"] for image in images))
            self.assertEqual(os.stat(images[0]["file"]).st_mode & 0o777, 0o600)
            client.call("release", image=images[0]["image"])
            self.assertEqual(client.files(), [images[1]["file"]])
            client.call("close")
            self.assertEqual(client.end(), (0, ""))
            self.assertEqual(client.files(), [])

    def test_whoever_dies_leaves_no_file(self):
        def begin(client):
            client.load()
            client.call("render", scene="1", spp=1)
            client.call("image", scene="1")
            client.send("render", scene="1", spp=FOREVER, progress=True)
            client.process.stdout.readline()
            self.assertEqual(len(client.files()), 1)
        with Client() as client:  # The client: its ends of the pipes are closed.
            begin(client)
            client.process.stdin.close()
            client.process.stdout.close()
            self.assertEqual(client.process.wait(), 0)
            self.assertEqual(client.files(), [])
            client.process.stdin = client.process.stdout = None
        with Client() as client:  # The program, by a signal that it can answer.
            begin(client)
            client.process.send_signal(signal.SIGTERM)
            client.process.communicate()
            self.assertEqual(client.process.returncode, 130)
            self.assertEqual(client.files(), [])
        with Client() as client:  # The program, at once: the next one removes its files.
            begin(client)
            client.process.kill()
            client.process.communicate()
            self.assertEqual(len(client.files()), 1)
            with Client() as another:
                another.call("version")
            self.assertEqual(client.files(), [])

    def test_answers_all_that_a_file_asks(self):
        text = (ROOT / "docs/protocol.md").read_text(encoding="utf-8")
        example = re.search("```json\n(.*?)```", text, re.DOTALL)[1]
        with tempfile.TemporaryDirectory() as folder:
            example = example.replace("scenes/", f"{ROOT}/scenes/")
            done = subprocess.run([CANDELA, "serve", "--stdio"], input=example.encode(), cwd=folder, check=True,
                                  stdout=subprocess.PIPE)
            answers = [json.loads(line) for line in done.stdout.splitlines()]
            self.assertEqual([answer["id"] for answer in answers if "result" in answer], [1, 2, 3, 4, 5])
            self.assertTrue((Path(folder) / "box.png").exists())

    def test_needs_to_know_where_requests_come_from(self):
        done = subprocess.run([CANDELA, "serve"], stderr=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"--stdio is required", done.stderr)


if __name__ == "__main__":
    CANDELA = os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
