#!/usr/bin/env python3
"""Makes the meshes of the scenes: `python3 make_mesh.py` writes trefoil.obj, backdrop.obj, knot.ply, vase.ply and
bowl.ply beside this file."""

import math
import struct
from pathlib import Path

FOLDER = Path(__file__).parent


def write_obj(name, title, vertices, normals, faces):
    """Writes lists of points, unit normals (or none) and faces (indices from 0; a corner's normal has its index)."""
    lines = [f"# {title} Made by make_mesh.py.", f"o {Path(name).stem}"]
    lines += ["v " + " ".join(f"{c:.4f}" for c in v) for v in vertices]
    lines += ["vn " + " ".join(f"{c:.3f}" for c in n) for n in normals]
    corner = "{0}//{0}" if normals else "{0}"
    lines += ["f " + " ".join(corner.format(i + 1) for i in face) for face in faces]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def write_ply(name, title, vertices, normals, faces):
    """Writes the same with the full precision of floats, which refraction shows, in less space."""
    header = ["ply", "format binary_little_endian 1.0", f"comment {title} Made by make_mesh.py."]
    header += [f"element vertex {len(vertices)}"] + [f"property float {c}" for c in ("x", "y", "z", "nx", "ny", "nz")]
    header += [f"element face {len(faces)}", "property list uchar ushort vertex_indices", "end_header\n"]
    rows = [struct.pack("<6f", *v, *n) for v, n in zip(vertices, normals)]
    rows += [struct.pack(f"<B{len(face)}H", len(face), *face) for face in faces]
    (FOLDER / name).write_bytes("\n".join(header).encode() + b"".join(rows))


def add(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def trefoil(along, around, radius=0.62):
    """Points, normals and quads of a tube along the trefoil knot, near the xy plane within |x|, |y| < 3 + radius."""

    def center(t):
        return [math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -math.sin(3 * t)]

    def tangent(t):
        return normalize([math.cos(t) + 4 * math.cos(2 * t), -math.sin(t) + 4 * math.sin(2 * t), -3 * math.cos(3 * t)])

    vertices, normals, quads = [], [], []
    for i in range(along):
        t = 2 * math.pi * i / along
        # The tube's cross-section: one axis towards +z as far as the tangent allows, so that it closes up untwisted.
        side = normalize(cross([0, 0, 1], tangent(t)))
        up = cross(tangent(t), side)
        for j in range(around):
            phi = 2 * math.pi * j / around
            normal = add([math.cos(phi) * x for x in side], up, math.sin(phi))
            vertices.append(add(center(t), normal, radius))
            normals.append(normal)
            i1, j1 = (i + 1) % along, (j + 1) % around
            quads.append([i * around + j, i * around + j1, i1 * around + j1, i1 * around + j])
    return vertices, normals, quads


def backdrop(width=8.0, front=4.0, back=-2.0, height=5.0, radius=1.2, steps=16):
    """A floor (y = 0) that bends up into a wall (z = back), without normals."""
    profile = [(0.0, front)]
    for i in range(steps + 1):
        angle = 0.5 * math.pi * i / steps
        profile.append((radius * (1 - math.cos(angle)), back + radius * (1 - math.sin(angle))))
    profile.append((height, back))
    vertices = [[x, y, z] for y, z in profile for x in (-width / 2, width / 2)]
    quads = [[2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2] for i in range(len(profile) - 1)]
    return vertices, [], quads


def spline(points, steps):
    """Points (r, y) and unit tangents on a curve through `points`, which leaves and meets the axis at right angles.

    Ref: Catmull and Rom 1974, A Class of Local Interpolating Splines.
    """
    ahead, behind = (-points[1][0], points[1][1]), (-points[-2][0], points[-2][1])
    knots = [ahead, *points, behind]
    curve = []
    for i in range(len(points) - 1):
        for k in range(steps + (i == len(points) - 2)):
            s = k / steps
            weights = (-s + 2 * s**2 - s**3, 2 - 5 * s**2 + 3 * s**3, s + 4 * s**2 - 3 * s**3, -(s**2) + s**3)
            slopes = (-1 + 4 * s - 3 * s**2, -10 * s + 9 * s**2, 1 + 8 * s - 9 * s**2, -2 * s + 3 * s**2)
            point = [sum(w * p[c] for w, p in zip(weights, knots[i : i + 4])) / 2 for c in (0, 1)]
            curve.append((point, normalize([sum(w * p[c] for w, p in zip(slopes, knots[i : i + 4])) for c in (0, 1)])))
    return curve


def lathe(points, around=96, steps=8):
    """The solid that the profile `points` (r, y) sweeps about the y axis, from the axis below to the axis above."""
    curve = spline(points, steps)
    rings = curve[1:-1]
    vertices, normals, faces = [[0.0, curve[0][0][1], 0.0]], [[0.0, -1.0, 0.0]], []
    for (r, y), (dr, dy) in rings:
        for j in range(around):
            x, z = math.cos(2 * math.pi * j / around), math.sin(2 * math.pi * j / around)
            vertices.append([r * x, y, r * z])
            normals.append([dy * x, -dr, dy * z])
    vertices.append([0.0, curve[-1][0][1], 0.0])
    normals.append([0.0, 1.0, 0.0])
    last = len(vertices) - 1
    for j in range(around):
        j1 = (j + 1) % around
        faces.append([0, 1 + j, 1 + j1])
        for i in range(len(rings) - 1):
            lower, upper = 1 + i * around, 1 + (i + 1) * around
            faces.append([lower + j, upper + j, upper + j1, lower + j1])
        faces.append([last - around + j, last, last - around + j1])
    return vertices, normals, faces


# Profiles from the foot up the outside, over the lip and down the inside, in centimetres.
VASE = [
    *[(0, 0), (2.6, 0), (3.1, 0.25), (4.6, 3), (5.6, 6.5), (5.2, 10), (3.6, 13.2), (2.1, 15.6), (1.55, 18.5)],
    *[(1.6, 21.5), (2.1, 23.6), (2.25, 23.95), (2.1, 24.1), (1.85, 23.8), (1.3, 21.5), (1.25, 18.5), (1.1, 16)],
    (0, 15.5),
]
BOWL = [
    *[(0, 0), (2.0, 0), (2.4, 0.15), (2.6, 0.6), (4.6, 1.9), (6.2, 3.9), (7.0, 6.2), (7.1, 6.6), (6.95, 6.75)],
    *[(6.75, 6.55), (5.9, 4.2), (4.3, 2.2), (2.2, 1.1), (0, 0.85)],
]


if __name__ == "__main__":
    write_obj("trefoil.obj", "A tube along the trefoil knot.", *trefoil(along=192, around=16))
    write_obj("backdrop.obj", "A floor that bends up into a wall.", *backdrop())
    write_ply("knot.ply", "A tube along the trefoil knot, fine enough for glass.", *trefoil(along=384, around=40))
    write_ply("vase.ply", "A vase with a slender neck.", *lathe(VASE))
    write_ply("bowl.ply", "A bowl on a foot.", *lathe(BOWL))
