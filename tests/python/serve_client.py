"""A client of `candela serve`, which checks each message against integrations/protocol.schema.json."""
import glob
import json
import os
import subprocess
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "integrations/protocol.schema.json").read_text(encoding="utf-8"))
MESSAGE = jsonschema.Draft202012Validator(SCHEMA)
METHODS = {name: {part: jsonschema.Draft202012Validator({"$defs": SCHEMA["$defs"], **method[part]})
                  for part in ("params", "result")} for name, method in SCHEMA["$defs"]["methods"].items()}
SCENE = json.dumps({
    "cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40},
                "side": {"position": [3, 0, 0], "look_at": [0, 0, 0], "vertical_fov": 40}},
    "film": {"size": [16, 12]}, "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
    "shapes": [{"type": "sphere", "radius": 1, "material": "clay"}], "environment": {"radiance": 1}})
FOREVER = 1 << 24  # Samples per pixel that no test waits for.


class Client:
    def __init__(self, *options):
        self.process = subprocess.Popen([os.environ["CANDELA"], "serve", "--stdio", *options], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.count = 0
        self.methods = {}
        self.told = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def write(self, text):
        self.process.stdin.write(text.encode())
        self.process.stdin.flush()

    def send(self, method, **params):
        self.count += 1
        self.methods[self.count] = method
        message = {"jsonrpc": "2.0", "id": self.count, "method": method, "params": params}
        MESSAGE.validate(message)
        METHODS[method]["params"].validate(params)
        self.write(json.dumps(message) + "\n")
        return self.count

    def read(self):
        """The next message that is not about progress."""
        while True:
            line = self.process.stdout.readline()
            if not line:
                return None
            message = json.loads(line)
            MESSAGE.validate(message)
            if "method" not in message:
                break
            self.told.append(message["params"])
        if "result" in message:
            METHODS[self.methods[message["id"]]]["result"].validate(message["result"])
        return message

    def call(self, method, **params):
        number = self.send(method, **params)
        message = self.read()
        assert message["id"] == number, message
        assert "result" in message, message
        return message["result"]

    def error(self, method, **params):
        self.send(method, **params)
        return self.read()["error"]

    def load(self, **params):
        return self.call("load", text=SCENE, folder="/", **params)["scene"]

    def pixels(self, scene="1"):
        """The bytes of the layer rgb of the picture so far."""
        image = self.call("image", scene=scene)
        data = Path(image["file"]).read_bytes()
        assert len(data) == image["bytes"]
        offset = image["layers"]["rgb"]["offset"]
        return data[offset:offset + 12 * image["width"] * image["height"]]

    def files(self):
        return glob.glob(f"/dev/shm/candela-shared-{self.process.pid}-*")

    def end(self):
        self.process.stdin.close()
        self.process.stdin = None
        errors = self.process.communicate()[1]
        return self.process.returncode, errors.decode()
