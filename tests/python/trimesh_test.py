#!/usr/bin/env python3
"""candela.from_trimesh() with the package trimesh itself. usage: trimesh_test.py CANDELA

Runs at night, with trimesh, networkx and pillow from PyPI; tests/python/scenes_test.py has what needs no package."""
import io
import os
import sys
import unittest
import warnings
from pathlib import Path

import numpy
import trimesh
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "integrations/python"))
import candela  # noqa: E402

CAMERA = candela.Camera((2, 1.5, 4), (0, 0, 0), 40)


def picture(scene):
    scene.camera = CAMERA
    return scene.render(spp=4, size=(32, 24)).rgb


class Trimesh(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("error", UserWarning)

    def test_bodies(self):
        for mesh in (trimesh.creation.box((1, 1, 1)), trimesh.creation.icosphere(2), trimesh.creation.torus(1, 0.25)):
            scene = candela.from_trimesh(mesh)
            numpy.testing.assert_allclose(scene.bounds, mesh.bounds, atol=1e-6)
            self.assertTrue(0 < picture(scene).min())

    def test_colours_are_seen(self):
        for by in ("vertex_colors", "face_colors"):
            mesh = trimesh.creation.box((1, 1, 1))
            setattr(mesh.visual, by, [255, 0, 0, 255])
            scene = candela.from_trimesh(mesh)
            scene.camera = candela.Camera((0, 0, 4), (0, 0, 0), 40)
            red, green, _ = scene.render(spp=4, size=(33, 33)).rgb[16, 16]
            self.assertAlmostEqual(red, 1, places=5)
            self.assertEqual(green, 0)

    def test_textures_and_materials_agree_with_gltf(self):
        image = Image.fromarray((numpy.indices((8, 8)).sum(0) % 2 * 200 + 50).astype("u1")).convert("RGB")
        material = trimesh.visual.material.PBRMaterial(baseColorTexture=image, baseColorFactor=[255, 128, 255, 255], metallicFactor=0.5,
                                                       roughnessFactor=0.5, doubleSided=True)
        mesh = trimesh.Trimesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
        mesh.visual = trimesh.visual.TextureVisuals([[0, 0], [1, 0], [1, 1], [0, 1]], material=material)
        scene = trimesh.Scene()
        scene.add_geometry(mesh, "a")
        scene.add_geometry(mesh.copy(), "b", transform=trimesh.transformations.translation_matrix([0.5, 0.5, -1]))
        ours = picture(candela.from_trimesh(scene))
        warnings.simplefilter("ignore")  # It has no camera.
        file = candela.load(scene.export(file_type="glb"))
        file.change(environment={"radiance": 1}, cameras={next(iter(file.cameras)): CAMERA.to_dict()})
        theirs = file.render(spp=4, size=(32, 24)).rgb
        numpy.testing.assert_allclose(ours, theirs, rtol=1e-4, atol=1e-5)

    def test_a_scene_from_a_file(self):
        mesh = trimesh.creation.icosphere(1)
        loaded = trimesh.load(io.BytesIO(mesh.export(file_type="ply")), file_type="ply")
        numpy.testing.assert_array_equal(picture(candela.from_trimesh(loaded)), picture(candela.from_trimesh(mesh)))


if __name__ == "__main__":
    os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
