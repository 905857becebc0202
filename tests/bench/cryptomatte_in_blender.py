#!/usr/bin/env python3
"""Opens a picture by candela in Blender's compositor, picks the matte of each object and material by its name with the
Cryptomatte node, and compares it with the ranks in the file. Prints a line for each matte; exits 1 if one differs.

usage: python3 cryptomatte_in_blender.py CANDELA [SCENE]     where Python has Blender 5 as the module bpy
"""
import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy

from rivals import exr

ROOT = Path(__file__).resolve().parents[2]
LAYERS = {"CryptoObject": "3ae39a5", "CryptoMaterial": "be359d6"}
RANKS = [(f"0{number}.{ident}", f"0{number}.{coverage}") for number in range(3) for ident, coverage in ("RG", "BA")]


def matte_by_blender(picture, size, layer, name, folder):
    """The matte of a name, row by row from the top, as Blender's node makes it."""
    tree = bpy.data.node_groups.new("mattes", "CompositorNodeTree")
    tree.interface.new_socket(name="Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source = "IMAGE"
    node.image = picture
    node.layer_name = layer
    node.matte_id = name
    tree.links.new(node.outputs["Matte"], tree.nodes.new("NodeGroupOutput").inputs[0])
    scene = bpy.context.scene
    scene.compositing_node_group = tree
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    render.filepath = str(folder / "matte.exr")
    bpy.ops.render.render(write_still=True)
    bpy.data.node_groups.remove(tree)
    return exr.read_all(render.filepath)[3]["R"]


def bits(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def main():
    candela = sys.argv[1]
    scene = sys.argv[2] if len(sys.argv) > 2 else ROOT / "scenes/lemons.json"
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        file = folder / "picture.exr"
        subprocess.run([candela, "render", scene, "--size", "96x64", "--spp", "1", "-o", file, "--aov", "cryptomatte",
                        "--quiet"], check=True)
        width, height, attributes, planes = exr.read_all(file)
        picture = bpy.data.images.load(str(file))
        for layer, key in LAYERS.items():
            for name, text in json.loads(attributes[f"cryptomatte/{key}/manifest"]).items():
                expected = [0.0] * (width * height)
                for ident, coverage in RANKS:
                    for i, value in enumerate(planes[layer + ident]):
                        if bits(value) == int(text, 16):
                            expected[i] += planes[layer + coverage][i]
                shown = matte_by_blender(picture, (width, height), layer, name, folder)
                worst = max(abs(a - b) for a, b in zip(shown, expected))
                failures += worst > 1e-6
                print(f"{layer} {name}: {sum(expected):.2f} pixels, greatest difference {worst:.1e}", flush=True)
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
