#!/usr/bin/env python3
"""Tests the tracer that candela is compared with: its pictures, its messages. usage: tracer_test.py CANDELA TRACER"""

import json
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

RIVALS = Path(__file__).resolve().parent / "rivals"
sys.path.insert(0, str(RIVALS))

import exr  # noqa: E402 (needs the path)
import pictures  # noqa: E402

ROOT = RIVALS.parents[2]
SIZE, SPP, DEPTH, SEEDS = 32, 64, 5, 16
# Critical value of Student's t with 15 degrees of freedom, the fewest that Welch's test of 16 seeds each can have:
# chance exceeds it in one of the six comparisons below with a probability of 1/1000.
CRITICAL_T = 5.0
CANDELA = TRACER = None  # The programs, from the command line.

# Every material and light that the tracer knows.
ALL_KINDS = {
    "cameras": {"main": {"position": [0, 2, 6], "look_at": [0, 0.7, 0], "vertical_fov": 40}},
    "environment": {"file": str(ROOT / "scenes" / "dusk.hdr"), "rotation": 70, "intensity": 0.2},
    "materials": {
        "clay": {"type": "diffuse", "reflectance": [0.5, 0.6, 0.7]},
        "gold": {"type": "conductor", "reflectance": [0.9, 0.7, 0.3], "alpha": 0.7},
        "glass": {"type": "dielectric", "ior": 1.5, "fresnel": "exact"},
    },
    "shapes": [
        {"type": "quad", "vertices": [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], "material": "gold"},
        {"type": "box", "min": [-1.9, 0.1, -1], "max": [-0.1, 1.6, 1], "material": "clay"},
        {"type": "box", "min": [0.4, 0.1, -0.8], "max": [1.6, 1.1, 0.3], "material": "glass"},
        {"type": "quad", "vertices": [[-1, 3, 0], [-1, 3, -1], [0, 3, -1], [0, 3, 0]], "emission": [20, 10, 5]},
        # Not a parallelogram: a lamp of two triangles that differ.
        {"type": "quad", "vertices": [[1, 2, 1], [1, 2, 0], [2, 2, 0], [1.5, 2, 1]], "emission": [3, 5, 9]},
    ],
}


def tracer(*words):
    return subprocess.run([TRACER, *map(str, words)], capture_output=True, text=True)


def trace(scene, output, seed):
    result = tracer(scene, output, SIZE, SPP, DEPTH, 1, seed, 2)
    assert result.returncode == 0, result.stderr


def render(scene, output, seed):
    command = [CANDELA, "render", scene, "-o", output, "--size", f"{SIZE}x{SIZE}", "--spp", SPP, "--seed", seed]
    command += ["--max-depth", DEPTH, "--rr-depth", 1, "--aov", "none", "--allow-any-folder", "--quiet"]
    subprocess.run([str(word) for word in command], check=True)


class Tracer(unittest.TestCase):
    def check_means(self, scene):
        """Means of candela's pictures and the tracer's, each from SEEDS seeds, must agree by Welch's t-test."""
        means = {}
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder, "picture.exr")
            for draw in (trace, render):
                means[draw] = []
                for seed in range(SEEDS):
                    draw(scene, output, seed)
                    means[draw].append(pictures.means(exr.read(output)))
        for channel, (ours, theirs) in enumerate(zip(zip(*means[render]), zip(*means[trace]))):
            error = ((statistics.variance(ours) + statistics.variance(theirs)) / SEEDS) ** 0.5
            t = (statistics.mean(ours) - statistics.mean(theirs)) / error
            self.assertLess(abs(t), CRITICAL_T, f"channel {'RGB'[channel]}: {ours} {theirs}")

    def refused(self, *words):
        """What the tracer says about words that it cannot use."""
        result = tracer(*words)
        self.assertNotEqual(result.returncode, 0)
        return result.stderr

    def refused_scene(self, **changes):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "scene.json")
            path.write_text(json.dumps(ALL_KINDS | changes), encoding="utf-8")
            return self.refused(path, Path(folder, "a.exr"), 8, 1, 5, 1, 0, 1)

    def test_the_cornell_box_has_candelas_mean(self):
        self.check_means(ROOT / "scenes" / "cornell-box.json")

    def test_all_kinds_of_materials_and_lights_have_candelas_mean(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "scene.json")
            path.write_text(json.dumps(ALL_KINDS), encoding="utf-8")
            self.check_means(path)

    def test_what_it_cannot_render_is_refused(self):
        def shape(**entries):
            return {"shapes": [{"material": "clay", **entries}]}

        remedy = "; give it a scene of quads, boxes and meshes"
        sphere = shape(type="sphere", center=[0, 0, 0], radius=1)
        self.assertIn("no round shapes" + remedy, self.refused_scene(**sphere))
        lamp = shape(type="box", min=[0, 0, 0], max=[1, 1, 1], emission=[1, 1, 1], two_sided=True)
        self.assertIn("no two-sided emission" + remedy, self.refused_scene(**lamp))
        water = {"clay": {"type": "dielectric", "ior": 1.3}}
        box = shape(type="box", min=[0, 0, 0], max=[1, 1, 1])
        self.assertIn('no material like "clay"' + remedy, self.refused_scene(materials=water, **box))
        clay = {"type": "diffuse", "reflectance": 0.5}
        image = {"image": str(ROOT / "scenes" / "cornell-box.png")}
        for entry, what in (
            ({"reflectance": image}, "textures"),
            ({"normal_map": image}, "normal maps"),
            ({"opacity": 0.5}, "opacity below 1"),
            ({"opacity": image}, "textures"),
            ({"vertex_colors": True}, "colours of vertices"),
        ):
            self.assertIn(f"no {what}" + remedy, self.refused_scene(materials={"clay": clay | entry}, **box))
        lamp = shape(type="quad", vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], emission=image)
        self.assertIn("no textures" + remedy, self.refused_scene(**lamp))
        hidden = {"radiance": [1, 1, 1], "visible": False}
        self.assertIn("no hidden environment" + remedy, self.refused_scene(environment=hidden))
        camera = ALL_KINDS["cameras"]["main"] | {"lens": {"radius": 0.1, "focal_distance": 1}}
        said = self.refused_scene(cameras={"main": camera})
        self.assertIn("the tracer's camera has no lens; set its radius to 0", said)

    def test_wrong_words_are_told(self):
        self.assertIn("usage: tracer SCENE OUT.exr WIDTH", self.refused("scene.json"))
        words = ["scene.json", "a.exr", 8, 0, 5, 1, 0, 1]
        self.assertIn('SPP: cannot use "0"; expected a whole number from 1', self.refused(*words))


if __name__ == "__main__":
    TRACER, CANDELA = sys.argv.pop(2), sys.argv.pop(1)
    unittest.main()
