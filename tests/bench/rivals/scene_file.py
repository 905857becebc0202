"""Reads candela's scene files: the part of the format that the benchmark's scenes use."""

import json
import math
import re
import struct
import sys
from pathlib import Path
from typing import NamedTuple

# A string, which stays, or a comment, which becomes a space.
STRING_OR_COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)
SPHERE_ROWS = 64
BOX_SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))


class Mesh(NamedTuple):
    positions: list
    normals: list | None  # None: flat.
    triangles: list
    uvs: list | None = None  # Texture coordinates.


def read_scene(path):
    """The scene as JSON."""
    text = Path(path).read_text(encoding="utf-8")
    return json.loads(STRING_OR_COMMENT.sub(lambda match: match.group(1) or " ", text))


def vertical_fov(camera):
    """Full angle [rad]."""
    if "vertical_fov" in camera:
        return math.radians(camera["vertical_fov"])
    return 2 * math.atan(camera["film_size"][1] / (2 * camera["focal_length"]))


def two_triangles(a, b, c, d):
    return (a, b, c), (a, c, d)


def read_ply(path):
    """A mesh as make_suzanne.py, make_textured.py and make_street.py write it: floats for positions and normals, and
    perhaps texture coordinates."""
    header, _, data = path.read_bytes().partition(b"end_header\n")
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", header))
    floats = len(re.findall(rb"property float", header))
    end = 4 * floats * vertices
    rows = list(struct.iter_unpack(f"<{floats}f", data[:end]))
    triangles = [row[1:] for row in struct.iter_unpack("<B3i", data[end : end + 13 * faces])]
    uvs = [row[6:] for row in rows] if floats == 8 else None
    return Mesh([row[:3] for row in rows], [row[3:6] for row in rows], triangles, uvs)


def sphere(center, radius):
    """A sphere of triangles, whose corners lie on it."""
    columns = 2 * SPHERE_ROWS
    normals = [(0, -1, 0)]
    for row in range(1, SPHERE_ROWS):
        up = math.pi * (row / SPHERE_ROWS - 0.5)
        around = [2 * math.pi * column / columns for column in range(columns)]
        normals += [(math.cos(up) * math.cos(a), math.sin(up), -math.cos(up) * math.sin(a)) for a in around]
    normals.append((0, 1, 0))
    top = len(normals) - 1
    triangles = []
    for i in range(columns):
        j = (i + 1) % columns
        triangles += [(0, 1 + j, 1 + i), (top, top - columns + i, top - columns + j)]
        for first in range(1, top - columns, columns):
            triangles += two_triangles(first + i, first + j, first + columns + j, first + columns + i)
    positions = [[c + radius * n for c, n in zip(center, normal)] for normal in normals]
    return Mesh(positions, normals, triangles)


def turned(point, degrees):
    """The point after a rotation about +Y."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = point
    return c * x + s * z, y, c * z - s * x


def mesh(shape, folder):
    """The mesh of a shape; `folder` is the scene file's."""
    kind = shape["type"]
    if kind == "quad":
        made = Mesh(shape["vertices"], None, two_triangles(0, 1, 2, 3))
    elif kind == "box":
        ends = list(zip(shape["min"], shape["max"]))
        corners = [[end[i >> axis & 1] for axis, end in enumerate(ends)] for i in range(8)]
        made = Mesh(corners, None, [triangle for side in BOX_SIDES for triangle in two_triangles(*side)])
    elif kind == "mesh":
        made = Mesh(shape["positions"], shape.get("normals"), shape["triangles"])
    elif kind == "sphere":
        made = sphere(shape.get("center", (0, 0, 0)), shape.get("radius", 1))
    elif kind == "ply":
        made = read_ply(folder / shape["file"])
    else:
        sys.exit(f'scene_file.py knows no shape "{kind}" (known: quad, box, mesh, sphere, ply)')
    for step in shape.get("transform", []):
        made = moved(made, step)
    return made


def moved(mesh, step):
    """The mesh after a step of a transform."""
    positions, normals = mesh.positions, mesh.normals
    if "rotate" in step and step["axis"] == [0, 1, 0]:
        degrees = step["rotate"]
        normals = normals and [turned(n, degrees) for n in normals]
        return mesh._replace(positions=[turned(p, degrees) for p in positions], normals=normals)
    if "translate" in step:
        return mesh._replace(positions=[[a + b for a, b in zip(p, step["translate"])] for p in positions])
    sys.exit(f"scene_file.py knows no transform {step} (known: rotate about [0, 1, 0], translate)")
