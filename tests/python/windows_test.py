#!/usr/bin/env python3
"""What a Python on Linux asks candela for Windows, under Wine, by the protocol.
usage: windows_test.py CANDELA FOR_LINUX"""
import os
import sys
import unittest

from serve_client import Client

PROGRAMS = sys.argv[1:3]


def client_of(program):
    os.environ["CANDELA"] = program
    return Client()


def unix_path(path):
    """Wine shows the folder / as drive Z, and its own drives below the folder that WINEPREFIX names."""
    drive, rest = path[0].lower(), path[2:].replace("\\", "/")
    return rest if drive == "z" else f"{os.environ['WINEPREFIX']}/drive_{drive}{rest}"


class Protocol(unittest.TestCase):
    def test_pictures_have_the_bits_of_linux(self):
        pictures = []
        for program in PROGRAMS:
            with client_of(program) as client:
                scene = client.load()
                self.assertTrue(client.call("render", scene=scene, spp=4)["complete"])
                image = client.call("image", scene=scene)
                path = image["file"] if program == PROGRAMS[1] else unix_path(image["file"])
                with open(path, "rb") as file:
                    pictures.append(file.read())
                self.assertEqual(len(pictures[-1]), image["bytes"])
                self.assertEqual(client.error("render", scene="none", spp=1)["data"]["kind"], "usage")
                self.assertEqual(client.end()[0], 0)
                self.assertFalse(os.path.exists(path))
        self.assertEqual(pictures[0], pictures[1])

    def test_close_ends_the_program_though_the_client_goes_on(self):
        with client_of(PROGRAMS[0]) as client:
            client.call("close")
            self.assertEqual(client.process.wait(60), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
