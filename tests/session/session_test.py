#!/usr/bin/env python3
"""A program that links the library candela_session alone renders the bits of the command line.

usage: session_test.py RENDER_SCENE CANDELA SCENES
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path


def main():
    render_scene, candela, scenes = sys.argv[1:]
    scene = Path(scenes) / "cornell-box.json"
    with tempfile.TemporaryDirectory() as folder:
        report = subprocess.run(
            [candela, "render", scene, "-o", f"{folder}/a.png", "--size", "32x24", "--spp", "4", "--report", "-", "-q"],
            check=True, stdout=subprocess.PIPE).stdout
    lines = scene.read_text().splitlines()
    cameras = json.loads("\n".join(line for line in lines if not line.lstrip().startswith("//")))["cameras"]
    (name, camera), *_ = cameras.items()
    moved = camera | {"position": [x + 10 for x in camera["position"]]}
    hash_of_session = subprocess.run(
        [render_scene, scene, json.dumps({"cameras": {name: moved}}), json.dumps({"cameras": {name: camera}})],
        check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    hash_of_program = json.loads(report)["image_hash"]
    if hash_of_session != hash_of_program:
        sys.exit(f"the session's picture has the hash {hash_of_session}, that of candela render {hash_of_program}")


if __name__ == "__main__":
    main()
