"""Meshes of make_models.py as arrays: sheets that are bent to spheres, tori, knots, vases and boxes.

A mesh has positions, normals, tangents (with the sign of the bitangent), texture coordinates and triangles.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Mesh:
    positions: np.ndarray
    normals: np.ndarray
    tangents: np.ndarray
    uvs: np.ndarray
    triangles: np.ndarray

    def moved(self, offset, scale=1.0):
        return Mesh(self.positions * scale + np.float32(offset), self.normals, self.tangents, self.uvs, self.triangles)


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def sheet(point, columns, rows, repeat=(1, 1)):
    """The surface point(u, v) over columns x rows cells, seen from where u goes to the right and v upwards; its images
    repeat so often."""
    v, u = (grid.ravel() for grid in np.meshgrid(*(np.linspace(0, 1, n + 1) for n in (rows, columns)), indexing="ij"))
    # Differences end a little inside, so that poles have directions, too.
    h, inside = 1e-4, np.clip(v, 1e-3, 1 - 1e-3)
    along = point(u + h, inside) - point(u - h, inside)
    across = point(u, inside + h) - point(u, inside - h)
    tangents = unit(along)
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    a, b, c, d = corner, corner + 1, corner + columns + 2, corner + columns + 1
    triangles = np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)
    positions = point(u, v)
    p, q, r = np.moveaxis(positions[triangles], 1, 0)
    triangles = triangles[np.linalg.norm(np.cross(q - p, r - p), axis=-1) > 1e-9]  # At a pole, half of them are lines.
    uvs = np.stack([u * repeat[0], (1 - v) * repeat[1]], -1)
    signed = np.concatenate([tangents, np.ones((len(u), 1))], -1)
    arrays = (positions, unit(np.cross(along, across)), signed, uvs)
    return Mesh(*(array.astype(np.float32) for array in arrays), triangles.astype(np.uint32))


def joined(meshes):
    first = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
    names = ("positions", "normals", "tangents", "uvs")
    parts = [np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in names]
    triangles = np.concatenate([mesh.triangles + np.uint32(offset) for mesh, offset in zip(meshes, first)])
    return Mesh(*parts, triangles)


def sphere(columns, rows):
    def point(u, v):
        around, up = 2 * np.pi * u, np.pi * v
        return np.stack([np.sin(up) * np.sin(around), -np.cos(up), np.sin(up) * np.cos(around)], -1)

    return sheet(point, columns, rows)


def torus(columns, rows, tube=0.35):
    return knot(columns, rows, 1, 0, tube)


def knot(columns, rows, turns=2, twists=3, tube=0.28):
    """A tube around a closed curve that winds `turns` times around the y axis."""

    def curve(u):
        angle = 2 * np.pi * turns * u
        far = 0.75 + 0.3 * np.cos(2 * np.pi * twists * u) * (twists > 0)
        return np.stack([far * np.sin(angle), 0.35 * np.sin(2 * np.pi * twists * u), far * np.cos(angle)], -1)

    def point(u, v):
        along = unit(curve(u + 1e-3) - curve(u - 1e-3))
        side = unit(np.cross(along, [0.0, 1.0, 0.0]))
        up, angle = np.cross(side, along), (2 * np.pi * v)[..., None]
        return curve(u) + tube * (np.cos(angle) * side + np.sin(angle) * up)

    return sheet(point, columns, rows, (4 * turns, 1))


def vase(columns, rows, waist=0.3):
    def point(u, v):
        around, radius = 2 * np.pi * u, 0.25 + waist * np.sin(np.pi * v) + 0.12 * np.sin(3 * np.pi * v)
        return np.stack([radius * np.sin(around), 2 * v - 1, radius * np.cos(around)], -1)

    return sheet(point, columns, rows, (2, 1))


def box(columns, rows, bulge=0.15):
    """Six sides with corners of their own, each a little round."""
    sides = []
    for axis in range(3):
        for sign in (1, -1):
            n = sign * np.eye(3)[axis]
            up = np.eye(3)[1] if axis != 1 else -sign * np.eye(3)[2]

            def point(u, v, n=n, up=up, right=np.cross(up, n)):
                s, t = (2 * u - 1)[..., None], (2 * v - 1)[..., None]
                return 0.7 * (s * right + t * up + (1 + bulge * (1 - s * s) * (1 - t * t)) * n)

            sides.append(sheet(point, max(1, columns // 4), max(1, rows // 2)))
    return joined(sides)


def ground(columns, rows, size, height):
    """Hills that repeat nowhere."""

    def point(u, v):
        x, z = size * (u - 0.5), size * (0.5 - v)
        y = height * (np.sin(1.3 * x) * np.cos(1.1 * z + 0.4 * x) + 0.3 * np.sin(5.1 * x + 2 * np.sin(z)))
        return np.stack([x, y, z], -1)

    return sheet(point, columns, rows, (size, size))
