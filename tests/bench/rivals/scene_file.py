"""Reads candela's scene files: the part of the format that the benchmark's scenes use."""

import json
import math
import re
import struct
import sys
from pathlib import Path

# A string, which stays, or a comment, which becomes a space.
STRING_OR_COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)
BOX_SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))


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
    """Positions, normals and triangles of a mesh as make_suzanne.py writes it."""
    header, _, data = path.read_bytes().partition(b"end_header\n")
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", header))
    rows = list(struct.iter_unpack("<6f", data[: 24 * vertices]))
    triangles = [row[1:] for row in struct.iter_unpack("<B3i", data[24 * vertices : 24 * vertices + 13 * faces])]
    return [row[:3] for row in rows], [row[3:] for row in rows], triangles


def turned(point, degrees):
    """The point after a rotation about +Y."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = point
    return c * x + s * z, y, c * z - s * x


def mesh(shape, folder):
    """Positions, normals (None: flat) and triangles of a shape; `folder` is the scene file's."""
    kind, normals = shape["type"], None
    if kind == "quad":
        positions, triangles = shape["vertices"], two_triangles(0, 1, 2, 3)
    elif kind == "box":
        ends = list(zip(shape["min"], shape["max"]))
        positions = [[end[i >> axis & 1] for axis, end in enumerate(ends)] for i in range(8)]
        triangles = [triangle for side in BOX_SIDES for triangle in two_triangles(*side)]
    elif kind == "mesh":
        positions, normals, triangles = shape["positions"], shape.get("normals"), shape["triangles"]
    elif kind == "ply":
        positions, normals, triangles = read_ply(folder / shape["file"])
    else:
        sys.exit(f'scene_file.py knows no shape "{kind}" (known: quad, box, mesh, ply)')
    for step in shape.get("transform", []):
        if "rotate" in step and step["axis"] == [0, 1, 0]:
            positions = [turned(p, step["rotate"]) for p in positions]
            normals = normals and [turned(n, step["rotate"]) for n in normals]
        elif "translate" in step:
            positions = [[a + b for a, b in zip(p, step["translate"])] for p in positions]
        else:
            sys.exit(f"scene_file.py knows no transform {step} (known: rotate about [0, 1, 0], translate)")
    return positions, normals, triangles
