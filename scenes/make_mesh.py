#!/usr/bin/env python3
"""Makes the meshes of mesh.json: `python3 make_mesh.py` writes trefoil.obj and backdrop.obj beside this file."""

import math
from pathlib import Path

FOLDER = Path(__file__).parent


def write_obj(name, title, vertices, normals, quads):
    """Writes lists of points, unit normals (or none) and quads (indices from 0; a corner's normal has its index)."""
    lines = [f"# {title} Made by make_mesh.py.", f"o {Path(name).stem}"]
    lines += ["v " + " ".join(f"{c:.4f}" for c in v) for v in vertices]
    lines += ["vn " + " ".join(f"{c:.3f}" for c in n) for n in normals]
    corner = "{0}//{0}" if normals else "{0}"
    lines += ["f " + " ".join(corner.format(i + 1) for i in quad) for quad in quads]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def add(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def trefoil(along=192, around=16, radius=0.62):
    """A tube along the trefoil knot, which lies near the xy plane within |x|, |y| < 3 + radius."""

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
    write_obj("trefoil.obj", "A tube along the trefoil knot.", vertices, normals, quads)


def backdrop(width=8.0, front=4.0, back=-2.0, height=5.0, radius=1.2, steps=16):
    """A floor (y = 0) that bends up into a wall (z = back), without normals."""
    profile = [(0.0, front)]
    for i in range(steps + 1):
        angle = 0.5 * math.pi * i / steps
        profile.append((radius * (1 - math.cos(angle)), back + radius * (1 - math.sin(angle))))
    profile.append((height, back))
    vertices = [[x, y, z] for y, z in profile for x in (-width / 2, width / 2)]
    quads = [[2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2] for i in range(len(profile) - 1)]
    write_obj("backdrop.obj", "A floor that bends up into a wall.", vertices, [], quads)


if __name__ == "__main__":
    trefoil()
    backdrop()
