#!/usr/bin/env python3
"""Shows that the three forms in which blender_scenes.py exports a scene give one picture.

usage: check_forms.py CANDELA FOLDER

Renders FOLDER/NAME.glb, NAME/NAME.gltf and NAME-embedded.gltf of each scene, and compares the images' blocks bit by
bit: all channels, the variance included. Ends with 1 if they differ.
"""

import hashlib
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import exr_header

OPTIONS = ("--size", "160x90", "--spp", "4", "-q")


def blocks(data):
    """The digest of an image's blocks, without the header and without their places in the file."""
    header, place = exr_header.attributes(data)
    _, y0, _, y1 = struct.unpack("<4i", header["dataWindow"])
    count = -(-(y1 - y0 + 1) // exr_header.ZIP_LINES[header["compression"][0]])
    digest = hashlib.sha256(header["channels"])
    for offset in struct.unpack_from(f"<{count}Q", data, place):
        size = struct.unpack_from("<4xi", data, offset)[0]
        digest.update(data[offset:offset + 8 + size])
    return digest.hexdigest()


def rendered(candela, scene):
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder, "image.exr")
        run = subprocess.run([candela, "render", scene, "-o", image, *OPTIONS], capture_output=True, text=True,
                             check=False)
        if run.returncode != 0:
            sys.exit(f"{scene}: {run.stderr.strip()}")
        return blocks(image.read_bytes())


def main(candela, folder):
    failed, scenes = False, sorted(Path(folder).glob("*.glb"))
    for scene in scenes:
        name = scene.stem
        forms = [scene, scene.parent / name / f"{name}.gltf", scene.parent / f"{name}-embedded.gltf"]
        digests = [rendered(candela, form) for form in forms]
        same = len(set(digests)) == 1
        print(f"{name}: {'one picture' if same else 'pictures that differ'}, {', '.join(d[:12] for d in digests)}")
        failed = failed or not same
    return 1 if failed or not scenes else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
