"""Meshes of scenes, in the form of files that Mitsuba reads."""

import re

import numpy as np


def box(shape):
    """Corners and triangles; the front is outside."""
    low, high = np.array(shape["min"]), np.array(shape["max"])
    corners = [np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def write_ply(path, positions, triangles, normals=None, uvs=None):
    columns, names = positions, ["x", "y", "z"]
    if normals is not None:
        columns, names = np.hstack([columns, normals]), [*names, "nx", "ny", "nz"]
    if uvs is not None:
        columns, names = np.hstack([columns, uvs * [1, -1] + [0, 1]]), [*names, "u", "v"]
    lines = ["ply", "format ascii 1.0", f"element vertex {len(columns)}", *(f"property float {n}" for n in names)]
    lines += [f"element face {len(triangles)}", "property list uchar int vertex_index", "end_header"]
    lines += [" ".join(repr(float(x)) for x in row) for row in columns]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    path.write_text("\n".join(lines) + "\n")


def read_ply(path):
    """Positions, triangles and normals of a mesh as make_mesh.py writes it, which Mitsuba does not read: little-endian,
    positions and normals as floats, faces of three or four 16-bit indices."""
    header, _, data = path.read_bytes().partition(b"end_header\n")
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", header))
    columns = np.frombuffer(data, "<f4", 6 * vertices).reshape(-1, 6)
    at, triangles = columns.nbytes, []
    for _ in range(faces):
        corners = np.frombuffer(data, "<u2", data[at], at + 1)
        triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
        at += 1 + corners.nbytes
    return columns[:, :3], triangles, columns[:, 3:]
