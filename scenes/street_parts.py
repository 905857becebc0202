"""What the parts of make_street.py share: its size, the frames of its sides, and the collector of meshes and lights.

Needs NumPy (Debian: python3-numpy).
"""

import numpy as np

import street_pictures as pictures
import textures
from street_meshes import joined, placed, write_ply

FACADE, ROAD, KERB = 6.0, 3.5, 0.13  # From the middle to the houses, half the road, height of the pavement [m].
NEAR, FAR = 14.0, -66.0  # Ends of the street along z; the camera looks along -z.
SIDES = {-1: [[0, 0, -1], [0, 1, 0], [1, 0, 0]], 1: [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]}  # Axes of facades.
WORLD, BACK = np.eye(3), np.diag([-1, 1, -1])  # Axes of what faces the camera, and of what it sees from behind.


class Street:
    """Meshes by material, and what shines."""

    def __init__(self, folder):
        self.folder, self.parts, self.lights, self.images = folder, {}, [], set()

    def add(self, material, *meshes, axes=WORLD, origin=(0, 0, 0)):
        self.parts.setdefault(material, []).extend(placed(mesh, axes, origin) for mesh in meshes)

    def shine(self, kind, emission, mesh, axes=WORLD, origin=(0, 0, 0)):
        name = f"{kind}_{len(self.lights):03}.ply"
        write_ply(self.folder / name, placed(mesh, axes, origin))
        self.lights.append({"type": "ply", "file": name, "emission": emission})

    def shine_at(self, places, kind, emission, mesh):
        """The same light at many places, from one file."""
        self.shine(kind, emission, mesh)
        light = self.lights.pop()
        for place in places:
            self.lights.append(light | {"transform": [{"translate": [round(float(c), 4) for c in place]}]})

    def image(self, name, make, factor):
        """The emission by an image, which is made once."""
        if name not in self.images:
            self.images.add(name)
            textures.write_png(self.folder / name, pictures.srgb(make()))
        return {"image": name, "factor": factor}

    def shapes(self):
        made = []
        for material, meshes in self.parts.items():
            write_ply(self.folder / f"{material}.ply", joined(meshes))
            made.append({"type": "ply", "file": f"{material}.ply", "material": material})
        return made + self.lights
