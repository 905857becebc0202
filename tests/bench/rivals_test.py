#!/usr/bin/env python3
"""Tests what rivals/compare.py and batches.py compute themselves: pictures, scenes, times, messages.
usage: rivals_test.py CANDELA"""

import array
import itertools
import json
import math
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

RIVALS = Path(__file__).resolve().parent / "rivals"
sys.path[:0] = [str(RIVALS), str(RIVALS.parent)]

import batches  # noqa: E402 (needs the path)
import compare as comparison  # noqa: E402
import exr  # noqa: E402
import pictures  # noqa: E402
import renderers  # noqa: E402
import scene_file  # noqa: E402

ROOT = RIVALS.parents[2]
CANDELA = None  # The program, from the command line.


def candela(*words):
    return subprocess.run([CANDELA, *map(str, words)], capture_output=True, text=True, check=True).stdout


def compare(*words):
    """The last line that compare.py prints when it fails."""
    result = subprocess.run([sys.executable, RIVALS / "compare.py", *words], capture_output=True, text=True)
    assert result.returncode != 0, result.stdout
    return result.stderr.strip().splitlines()[-1]


def grey(width, height, value):
    """A picture of that value everywhere, or of value(x, y)."""
    values = [value(x, y) if callable(value) else value for y, x in itertools.product(range(height), range(width))]
    return width, height, [array.array("f", values) for _ in "RGB"]


def area_and_volume(mesh):
    """The area of a mesh [m^2], and the volume that it encloses [m^3], above 0 if its fronts are outside; Gauss's
    theorem says which."""
    area = volume = 0
    for a, b, c in (map(mesh.positions.__getitem__, triangle) for triangle in mesh.triangles):
        (x, y, z), (u, v, w) = ([q - p for p, q in zip(a, end)] for end in (b, c))
        normal = (y * w - z * v, z * u - x * w, x * v - y * u)
        area += sum(n * n for n in normal) ** 0.5 / 2
        volume += sum(p * n for p, n in zip(a, normal)) / 6
    return area, volume


def ply(rows):
    """A binary file of one triangle, whose vertices have six floats each, or eight with texture coordinates."""
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")[: len(rows[0])]
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
    header += "".join(f"property float {name}\n" for name in names)
    header += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    return header.encode() + struct.pack(f"<{3 * len(names)}f", *sum(rows, ())) + struct.pack("<B3i", 3, 0, 1, 2)


class Pictures(unittest.TestCase):
    def test_exr_files_are_read_as_candela_reads_them(self):
        # The last block of 37 rows is a short one; `compare` prints six digits of its own error measure.
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder, f"{seed}.exr") for seed in range(2)]
            for seed, path in enumerate(paths):
                options = ("--size", "24x37", "--spp", 1, "--seed", seed, "--aov", "none", "--quiet")
                candela("render", ROOT / "scenes/cornell-box.json", "-o", path, *options)
            (width, height, a), (_, _, b) = (exr.read(path) for path in paths)
            said = float(re.search(r"relMSE +(\S+)", candela("compare", *paths, "--relmse", 1e9))[1])
        self.assertEqual((width, height), (24, 37))
        terms = [(x - r) ** 2 / (r * r + 0.01) for p, q in zip(a, b) for x, r in zip(p, q)]
        self.assertGreater(said, 0)
        self.assertAlmostEqual(sum(terms) / len(terms), said, delta=1e-5 * said)
        self.assertTrue(sum(a[0]) > sum(a[1]) > sum(a[2]))  # The lamp's radiance is 17, 12, 4.

    def test_relmse_is_relative_to_the_reference_and_to_its_mean(self):
        self.assertAlmostEqual(pictures.relmse(grey(2, 3, 3), grey(2, 3, 2)), 1 / (4 + 0.04), places=6)
        halves = grey(2, 2, lambda x, y: 4 * x)  # Of mean 2: black pixels count (1 - 0)^2 / 0.04.
        self.assertAlmostEqual(pictures.relmse(grey(2, 2, 1), halves), (1 / 0.04 + 9 / 16.04) / 2, places=5)

    def test_differences_are_those_of_the_whole_and_of_blocks(self):
        even = grey(80, 40, 1)  # Blocks: 32 + 32 + 16 columns, 32 + 8 rows.
        spot = grey(80, 40, lambda x, y: 3 if x >= 64 and y >= 32 else 1)
        whole, blocks = pictures.differences(spot, even)
        self.assertAlmostEqual(whole, 2 * 16 * 8 / (80 * 40), places=6)
        self.assertAlmostEqual(blocks, (2**2 / 6) ** 0.5, places=6)


class Scenes(unittest.TestCase):
    def check(self, path):
        """Bounds and number of triangles must be those that candela finds."""
        told = json.loads(candela("info", path, "--json"))
        meshes = [scene_file.mesh(shape, path.parent) for shape in scene_file.read_scene(path)["shapes"]]
        self.assertEqual(sum(len(mesh.triangles) for mesh in meshes), told["primitives"])
        points = [mesh.positions[i] for mesh in meshes for triangle in mesh.triangles for i in triangle]
        for axis in range(3):
            self.assertAlmostEqual(min(p[axis] for p in points), told["bounds"][0][axis], places=5)
            self.assertAlmostEqual(max(p[axis] for p in points), told["bounds"][1][axis], places=5)

    def test_the_cornell_box_is_the_one_that_candela_reads(self):
        self.check(ROOT / "scenes/cornell-box.json")

    def check_closed(self, mesh):
        edges = [(t[i - 1], t[i]) for t in mesh.triangles for i in range(3)]
        self.assertEqual(sorted(edges), sorted({(b, a) for a, b in edges}))  # Each once, and once in reverse.

    def test_a_box_is_closed_and_has_the_area_and_the_volume_of_a_box(self):
        box = scene_file.mesh({"type": "box", "min": [-1, 2, 5], "max": [1, 5, 9]}, None)
        self.check_closed(box)
        area, volume = area_and_volume(box)
        self.assertAlmostEqual(area, 2 * (2 * 3 + 3 * 4 + 4 * 2))
        self.assertAlmostEqual(volume, 2 * 3 * 4)

    def test_a_sphere_is_closed_and_has_nearly_the_area_and_the_volume_of_a_sphere(self):
        center, radius = (1, -2, 3), 2
        sphere = scene_file.mesh({"type": "sphere", "center": center, "radius": radius}, None)
        self.check_closed(sphere)
        for position, normal in zip(sphere.positions, sphere.normals):
            for p, c, n in zip(position, center, normal):
                self.assertAlmostEqual(p, c + radius * n)
            self.assertAlmostEqual(sum(n * n for n in normal), 1)
        # No point of a facet is farther from a corner than half its diagonal, steps of pi / 64 both ways. So the mesh
        # is between the sphere and one of cos(pi / 64 / sqrt 2) = 0.9994 of its radius.
        area, volume = area_and_volume(sphere)
        self.assertTrue(0.9994**2 < area / (4 * math.pi * radius**2) < 1, area)
        self.assertTrue(0.9994**3 < volume / (4 / 3 * math.pi * radius**3) < 1, volume)

    def test_boxes_and_turned_meshes_are_those_that_candela_reads(self):
        turn = [{"rotate": 30, "axis": [0, 1, 0]}, {"translate": [5, 1, -2]}]
        scene = {
            "cameras": {"main": {"position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40}},
            "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
            "shapes": [
                {"type": "box", "min": [-3, -2, -1], "max": [0.5, 1, 2], "material": "clay"},
                {"type": "ply", "file": "m.ply", "material": "clay", "transform": turn},
            ],
        }
        corners = ((0, 0, 0), (4, 0, 1), (0, 3, 2))
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "m.ply").write_bytes(ply([(*corner, 0, 0, 1) for corner in corners]))
            path = Path(folder, "scene.json")
            path.write_text("// A comment.\n" + json.dumps(scene), encoding="utf-8")
            self.check(path)

    def test_texture_coordinates_are_read_where_a_file_has_them(self):
        rows = [(0, 0, 0, 0, 0, 1, 0.25, 0.5), (4, 0, 1, 0, 1, 0, 2, -1), (0, 3, 2, 1, 0, 0, 0, 7)]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "m.ply")
            for columns, uvs in ((6, None), (8, [(0.25, 0.5), (2, -1), (0, 7)])):
                path.write_bytes(ply([row[:columns] for row in rows]))
                mesh = scene_file.mesh({"type": "ply", "file": "m.ply"}, path.parent)
                self.assertEqual(mesh.positions, [(0, 0, 0), (4, 0, 1), (0, 3, 2)])
                self.assertEqual(mesh.normals, [(0, 0, 1), (0, 1, 0), (1, 0, 0)])
                self.assertEqual(mesh.triangles, [(0, 1, 2)])
                self.assertEqual(mesh.uvs, uvs)


class Runs(unittest.TestCase):
    def test_the_time_of_the_first_sample_and_of_starting_counts_for_none(self):
        # 3 s to start, 2 s for each of five samples.
        times = renderers.without_start({"cpu": 5, "wall": 4}, {"cpu": 13, "wall": 8}, 5)
        self.assertEqual(times, {"cpu": 10, "wall": 5})

    def test_candelas_time_is_that_of_its_further_samples(self):
        job = renderers.Job(ROOT / "scenes/cornell-box.json", depth=1, width=16, threads=1)
        reports = []
        run = renderers.run

        def recorded(command):
            text = run(command)
            reports.append(json.loads(text))
            return text

        with tempfile.TemporaryDirectory() as folder, mock.patch.object(renderers, "run", recorded):
            figures = renderers.Candela(CANDELA).render(job, 64, 0, Path(folder, "a.exr"))
            self.assertEqual(exr.read(Path(folder, "a.exr"))[:2], (16, 16))
        self.assertEqual([report["spp"] for report in reports], [1, 64])
        for what, key in (("cpu", "cpu_seconds"), ("wall", "render_seconds")):
            first, all_samples = (report[key] for report in reports)
            self.assertGreater(first, 0)
            self.assertAlmostEqual(figures[what], 64 / 63 * (all_samples - first))
        self.assertTrue(1 < figures["rays"] < 3, figures)  # A camera ray; where there are walls, two more.

    def test_another_light_sampler_is_another_renderer(self):
        job = renderers.Job(ROOT / "scenes/cornell-box.json", depth=1, width=16, threads=1)
        figures = {"version": 1, "device": 2, "driver": 3, "cpu_seconds": 4, "render_seconds": 5, "rays_per_sample": 6}
        for sampler, name in ((None, "candela"), ("power", "candela-power")):
            with mock.patch.object(renderers, "run", return_value=json.dumps(figures)) as run:
                renderer = renderers.Candela(CANDELA, sampler)
                renderer.render(job, 2, 0, "a.exr")
            self.assertEqual(renderer.name, name)
            for (command,), _ in run.call_args_list:
                self.assertEqual(["--light-sampler", "power"] == command[-2:], sampler == "power")

    def test_what_is_unknown_or_missing_is_told_with_its_remedy(self):
        known = "cornell-box, suzannes, many-lights, sky, textured, principled, street, room, wax, milk, haze, "
        known += "lit-primitives, lit-suzanne, lit-textures, lit-glass, lit-lights"
        self.assertIn(f"unknown scene teapot (known: {known})", compare(CANDELA, "teapot"))
        self.assertIn("cannot run /no/candela: build it, or give", compare("/no/candela"))
        remedy = "install Blender, or name it by --blender: its program, or a Python with the module bpy, or use --without"
        self.assertIn(f"cannot run /no/blender: {remedy} Cycles", compare(CANDELA, "--blender", "/no/blender"))
        missing = compare(CANDELA, "--without", "Cycles", "--tracer", "/no/tracer", "sky")
        self.assertIn("cannot run /no/tracer: build the target `tracer` with -DCANDELA_EMBREE=ON", missing)
        self.assertIn("--runs, --seconds and --reference must be above 0", compare(CANDELA, "--seconds", "0"))

    def test_blender_is_a_program_or_a_python(self):
        # A stand-in, which prints its arguments as the version of Blender.
        figures = '{"version": "\'"$*"\'", "one": {"cpu": 1, "wall": 1}, "all": {"cpu": 2, "wall": 2}}'
        job = renderers.Job(Path("s.json"), depth=5, width=16, threads=1)
        words = f"{RIVALS / 'render_with_cycles.py'} -- s.json a.exr 16 2 5 0 1"
        with tempfile.TemporaryDirectory() as folder:
            program = "-b --factory-startup --python-exit-code 1 -P "
            for name, options in (("blender", program), ("blender-5.0", program), ("python3.11", "")):
                path = Path(folder, name)
                path.write_text(f"#!/bin/sh\necho '{figures}'\n", encoding="utf-8")
                path.chmod(0o755)
                cycles = renderers.Cycles(path)
                self.assertEqual(cycles.render(job, 2, 0, "a.exr"), {"cpu": 2, "wall": 2, "rays": None})
                self.assertEqual(cycles.version, f"Cycles of Blender {options}{words}")

    def test_converged_pictures_are_kept_for_each_version(self):
        job = renderers.Job(ROOT / "scenes/cornell-box.json", depth=1, width=16, threads=1)
        renderer = mock.Mock()
        renderer.name = "Cycles"
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(exr, "read"):
            for version, renderings in (("3.4.1", 1), ("3.4.1", 1), ("5.0.1", 2), ("3.4.1", 2)):
                renderer.version = f"Cycles of Blender {version}"
                self.assertEqual(comparison.converged(renderer, job, 0.5, 4, Path(folder))[1], 8)
                self.assertEqual(renderer.render.call_count, renderings)

    def test_a_program_that_fails_is_quoted(self):
        with self.assertRaisesRegex(SystemExit, "(?s)candela nonsense\nended with 2:.*nonsense"):
            renderers.run([CANDELA, "nonsense"])


class Batches(unittest.TestCase):
    def test_the_overhead_of_a_scene_is_that_of_all_its_pictures(self):
        lines = [{"scene": scene, "overhead_cpu_seconds": {"scene": 2, "host": host}}
                 for scene, host in (("a", 1), ("a", 3), ("b", 5))]
        self.assertEqual(batches.overhead(lines), {"scene": 4, "host": 9})

    def test_noise_is_the_variance_of_one_picture(self):
        # Values 1 and 3 have the mean 2 and, as their unbiased variance, 2.
        with mock.patch.object(exr, "read", side_effect=[grey(2, 2, 1), grey(2, 2, 3)]):
            noise, means = batches.noise_between("a", "b")
        self.assertAlmostEqual(noise, 2 / (4 + 0.01 * 4))
        self.assertEqual(means, [2, 2, 2])

    def test_cycles_has_the_cameras_that_candela_has(self):
        with tempfile.TemporaryDirectory() as folder:
            options = mock.Mock(work=ROOT / "scenes", spp=1)
            told = {"files": ["trefoil.obj"], "count": 2, "size": 8, "spp": 1}
            with mock.patch.dict(batches.BATCHES, {"views": told}):
                batch = batches.Batch("views", options, None)
            batches.render_by_candela(CANDELA, batch, Path(folder))
            found = list(batches.cameras(batch, Path(folder)))
        self.assertEqual([camera["model"] for camera in found], 2 * [str(ROOT / "scenes/trefoil.obj")])
        for camera in found:
            self.assertAlmostEqual(camera["angle"], 2 * math.atan(18 / 50))  # A lens of 50 mm.
        # The second camera is opposite to the first, with the same elevation.
        (a, b) = ([row[2] for row in camera["camera"][:3]] for camera in found)
        for x, y in zip(a, (-b[0], b[1], -b[2])):
            self.assertAlmostEqual(x, y, 5)


if __name__ == "__main__":
    CANDELA = sys.argv.pop(1)
    unittest.main()
