"""A server for tests of pictures over HTTP (python -m candela.serve), and what clients send to it.

All connections are to this machine."""
import contextlib
import glob
import http.client
import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
SCENE = json.dumps({"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}},
                    "film": {"size": [16, 12]}, "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
                    "shapes": [{"type": "sphere", "radius": 1, "material": "clay"}],
                    "environment": {"radiance": 1}}).encode()
FOREVER = 1 << 24  # Samples per pixel that no test waits for.
HANG = 120  # Seconds after which something hangs.
MODEL = {"Content-Type": "model/gltf+json"}


class Server:
    """A server with a folder of its own for temporary files."""

    def __init__(self, *options, code=None):
        """code: Python that changes constants of the server before it begins."""
        self.folder = tempfile.TemporaryDirectory()
        environment = {**os.environ, "TMPDIR": self.folder.name, "PYTHONPATH": str(ROOT / "integrations/python")}
        arguments = ["--port", "0", "-q", *options]
        start = ["-m", "candela.serve"] if code is None else [
            "-c", f"{code}\nimport runpy\nrunpy.run_module('candela.serve.__main__')"]
        self.process = subprocess.Popen([sys.executable, *start, *arguments], env=environment, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        if not line:
            raise AssertionError(self.process.communicate()[1])
        self.port = int(re.fullmatch(r"candela\.serve: http://127\.0\.0\.1:(\d+)/render\n", line)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()
        self.folder.cleanup()

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port), HANG)

    def ask(self, method, path, body=None, headers=None):
        """The status, headers and body of the answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=HANG)
        try:
            connection.request(method, path, body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def send(self, data):
        """What is answered to these bytes."""
        with self.connect() as connection:
            connection.sendall(data)
            return receive(connection)

    def picture(self, query="", scene=SCENE):
        status, _, data = self.ask("POST", f"/render?size=16x12&{query}", scene, MODEL)
        assert status == 200, data
        return data

    def metrics(self):
        text = self.ask("GET", "/metrics")[2].decode()
        return {name: float(value) for name, value in re.findall(r"^(candela_\S+) (\S+)$", text, re.MULTILINE)}

    def wait_until(self, name, value):
        """Waits until a figure has a value."""
        end = time.monotonic() + HANG
        while self.metrics()[name] != value:
            assert time.monotonic() < end, f"{name} is never {value}"
            time.sleep(0.02)

    def program(self):
        """The process that renders."""
        children = []
        for thread in glob.glob(f"/proc/{self.process.pid}/task/*/children"):
            with contextlib.suppress(FileNotFoundError):  # The thread has ended.
                children += Path(thread).read_text().split()
        return int(children[0])

    def files(self):
        """What requests have left."""
        shared = [file for file in glob.glob("/dev/shm/candela-shared-*") if f"-{self.program()}-" in file]
        return glob.glob(f"{self.folder.name}/candela-http-*/*") + shared

    def wait_until_nothing_is_left(self):
        """Waits until the files of requests are gone: the program frees an image after its picture is answered."""
        end = time.monotonic() + HANG
        while left := self.files():
            assert time.monotonic() < end, f"requests have left {left}"
            time.sleep(0.02)


def receive(connection):
    """All that comes until the end."""
    parts = []
    while data := connection.recv(1 << 16):
        parts.append(data)
    return b"".join(parts)


def status_of(data):
    """The status of an answer; 0 if there is none."""
    found = re.match(rb"HTTP/1.1 (\d+) ", data)
    return int(found[1]) if found else 0


def head(size, kind="model/gltf+json", path="/render"):
    return f"POST {path} HTTP/1.1\r\nHost: x\r\nContent-Type: {kind}\r\nContent-Length: {size}\r\n\r\n".encode()


def form(parts, boundary="b"):
    """A form, of (name, file name or None, content)."""
    data = b""
    for name, file, content in parts:
        line = f'Content-Disposition: form-data; name="{name}"' + (f'; filename="{file}"' if file else "")
        data += f"--{boundary}\r\n{line}\r\n\r\n".encode() + content + b"\r\n"
    return data + f"--{boundary}--\r\n".encode(), {"Content-Type": f"multipart/form-data; boundary={boundary}"}


def png_of(data):
    """The size of a PNG of 8 bits without filters, as `serve` writes it for labels, and its pixels."""
    size, at, packed = struct.unpack(">LL", data[16:24]), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">L4s", data[at:at + 8])
        assert zlib.crc32(data[at + 4:at + 8 + length]) == struct.unpack(">L",
                          data[at + 8 + length:at + 12 + length])[0]
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += length + 12
    rows = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(size[1], 1 + 3 * size[0])
    return size, rows[:, 1:].reshape(size[1], size[0], 3)


class HttpCase(unittest.TestCase):
    """Tests that share a server, which must live and keep nothing after each."""

    @classmethod

    def setUpClass(cls):
        cls.root = tempfile.TemporaryDirectory()
        root = Path(cls.root.name)
        (root / "below/deep").mkdir(parents=True)
        (root / "below/deep/scene.json").write_bytes(SCENE)
        (root / "secret.json").write_bytes(SCENE)
        (root / "below/link.json").symlink_to(root / "secret.json")
        (root / "below/out").symlink_to(root)
        (root / "below/in.json").symlink_to("deep/scene.json")
        cls.server = Server("--root", str(root / "below"), "--memory-limit", "1G", "--max-body", "64MiB")

    @classmethod

    def tearDownClass(cls):
        cls.server.__exit__()
        cls.root.cleanup()

    def tearDown(self):
        """Whatever a test did: the server lives, renders, and keeps nothing."""
        self.assert_fine(self.server)

    def assert_fine(self, server):
        self.assertEqual(server.picture("spp=1")[:4], b"\x89PNG")
        server.wait_until("candela_requests_pending", 0)
        server.wait_until_nothing_is_left()
        self.assertIsNone(server.process.poll())

    def assert_refused(self, status, message, answer):
        self.assertEqual(answer[0], status, answer[2])
        self.assertRegex(answer[2].decode(), message)
        self.assertEqual(answer[1]["Content-Type"], "text/plain; charset=utf-8")


def main():
    """Runs the tests of a file. usage: FILE CANDELA [TEST...]"""
    os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
