"""Meshes as lists: sheets, spheres, boxes. What a mesh does not have is None; (0, 0) of uvs is up on the left."""

import math
from dataclasses import dataclass, field, replace

import matrices


@dataclass
class Mesh:
    positions: list
    indices: list
    normals: list = None
    tangents: list = None
    uvs: list = None
    colours: list = None
    others: dict = field(default_factory=dict)  # Further attributes, by glTF's names.

    def attributes(self):
        """What a primitive takes, by glTF's names."""
        named = {"POSITION": self.positions, "NORMAL": self.normals, "TANGENT": self.tangents, "TEXCOORD_0": self.uvs,
                 "COLOR_0": self.colours}
        return {name: rows for name, rows in named.items() if rows is not None} | self.others

    def moved(self, matrix):
        """The mesh under a matrix; one that mirrors keeps the front the front."""
        flips = determinant(matrix) < 0
        indices = [i for a, b, c in triples(self.indices) for i in ((a, c, b) if flips else (a, b, c))]
        positions = [matrices.point(matrix, p) for p in self.positions]
        normals = self.normals and [matrices.normal(matrix, n) for n in self.normals]
        tangents = self.tangents and [
            (*matrices.unit(matrices.direction(matrix, t)), -t[3] if flips else t[3]) for t in self.tangents]
        return replace(self, positions=positions, indices=indices, normals=normals, tangents=tangents)

    def flat(self):
        """The mesh without its normals."""
        return replace(self, normals=None)


def triples(indices):
    return [tuple(indices[i:i + 3]) for i in range(0, len(indices), 3)]


def determinant(m):
    return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))


def cells(columns, rows):
    """Two triangles for each cell of a grid whose points stand in rows from the top."""
    indices = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            c = a + columns + 1
            indices += [a, c, c + 1, a, c + 1, a + 1]
    return indices


def sheet(x0, y0, x1, y1, z=0, n=1, uv=None, normal=None, tangent=None, colour=None):
    """An upright rectangle that faces +Z, of n by n cells.

    The functions uv, normal, tangent and colour get (s, t): s from 0 on the left to 1, t from 0 at the top to 1.
    """
    places = [(column / n, row / n) for row in range(n + 1) for column in range(n + 1)]
    return Mesh(
        positions=[(x0 + (x1 - x0) * s, y1 + (y0 - y1) * t, z) for s, t in places],
        indices=cells(n, n),
        normals=[normal(s, t) if normal else (0, 0, 1) for s, t in places],
        tangents=[tangent(s, t) for s, t in places] if tangent else None,
        uvs=[uv(s, t) if uv else (s, t) for s, t in places],
        colours=[colour(s, t) for s, t in places] if colour else None,
    )


def sphere(radius=1, around=48, along=24):
    """A sphere about the origin, with poles on the y axis; u goes counter-clockwise seen from above."""
    positions, normals, uvs, tangents = [], [], [], []
    for row in range(along + 1):
        for column in range(around + 1):
            # The seam's two sides are the same points, and so are those of a pole.
            phi, theta = 2 * math.pi * (column % around) / around, math.pi * row / along
            ring = 0.0 if row in (0, along) else math.sin(theta)
            n = (ring * math.sin(phi), math.cos(theta), ring * math.cos(phi))
            normals.append(n)
            positions.append(tuple(radius * c for c in n))
            uvs.append((column / around, row / along))
            tangents.append((math.cos(phi), 0, -math.sin(phi), 1))
    triangles = triples(cells(around, along))
    first, last = 2 * around, len(triangles) - 2 * around
    kept = [t for i, t in enumerate(triangles) if first <= i < last or i % 2 == (i >= last)]  # At poles, every other.
    return Mesh(positions, [i for t in kept for i in t], normals, tangents, uvs)


def box(low, high):
    """A box with six sides of their own corners: +X, -X, +Y, -Y, +Z, -Z."""
    mesh = Mesh([], [], [], None, [])
    for axis in range(3):
        for sign in (1, -1):
            n = tuple(sign if k == axis else 0 for k in range(3))
            up = (0, 0, -sign) if axis == 1 else (0, 1, 0)
            right = (up[1] * n[2] - up[2] * n[1], up[2] * n[0] - up[0] * n[2], up[0] * n[1] - up[1] * n[0])
            first = len(mesh.positions)
            for s, t in ((-1, 1), (-1, -1), (1, -1), (1, 1)):
                corner = [(n[k] + s * right[k] + t * up[k] + 1) / 2 for k in range(3)]
                mesh.positions.append(tuple(low[k] + (high[k] - low[k]) * corner[k] for k in range(3)))
                mesh.normals.append(n)
                mesh.uvs.append(((s + 1) / 2, (1 - t) / 2))
            mesh.indices += [first, first + 1, first + 2, first, first + 2, first + 3]
    return mesh


def joined(*meshes):
    """One mesh of several that have the same attributes."""
    result = Mesh([], [], *([] if getattr(meshes[0], name) else None for name in
                            ("normals", "tangents", "uvs", "colours")))
    for mesh in meshes:
        result.indices += [len(result.positions) + i for i in mesh.indices]
        result.positions += mesh.positions
        for name in ("normals", "tangents", "uvs", "colours"):
            if getattr(result, name) is not None:
                getattr(result, name).extend(getattr(mesh, name))
    return result


def bump(s, t, steepest=35):
    """The normal of a round bump in a square, which is flat in the middle and outside, for NORMAL and normal maps."""
    x, y = 2 * s - 1, 1 - 2 * t
    r = math.hypot(x, y)
    if r < 1e-9 or r >= 1:
        return (0.0, 0.0, 1.0)
    tilt = math.radians(steepest) * math.sin(math.pi * r)
    return (math.sin(tilt) * x / r, math.sin(tilt) * y / r, math.cos(tilt))
