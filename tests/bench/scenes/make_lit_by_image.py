"""Makes made/lit-*.json and .glb: the five scenes of tests/gltf/blender_scenes.py, exported by Blender as glTF without
their lights and lit by an image of a sky: `blender -b --factory-startup -P make_lit_by_image.py`, or `python3
make_lit_by_image.py` with the module bpy.
"""

import json
import math
import sys
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
MADE = HERE / "made"
sys.path.insert(0, str(HERE.parents[1] / "gltf"))

import blender_scenes  # noqa: E402 (needs the path)


def candela_axes(point):
    x, y, z = point
    return [x, z, -y]


def main():
    MADE.mkdir(exist_ok=True)
    cameras = {}

    def camera(location, target, angle=0.7):
        place = {"position": candela_axes(location), "look_at": candela_axes(target)}
        cameras["main"] = place | {"vertical_fov": math.degrees(angle)}

    blender_scenes.camera = camera
    blender_scenes.lamp = blender_scenes.dome = lambda *_, **__: None
    for name in ("primitives", "suzanne", "textures", "glass", "lights"):
        blender_scenes.reset()
        getattr(blender_scenes, name)()
        model = f"lit-{name}.glb"
        bpy.ops.export_scene.gltf(filepath=str(MADE / model), export_format="GLB", export_apply=True)
        sky = {"file": "../../../../scenes/sky.hdr", "rotation": 100}
        scene = {"scene": model, "cameras": cameras, "environment": sky}
        (MADE / f"lit-{name}.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


main()
