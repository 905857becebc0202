"""Meshes of make_street.py: tuples of positions, normals, texture coordinates and triangles, and PLY files of them.

Needs NumPy (Debian: python3-numpy).
"""

import math

import numpy as np

# Strokes of neon tubes: each letter's polylines, on a cell one wide and one high.
LETTERS = {
    "A": ["0,0 .5,1 1,0", ".2,.36 .8,.36"],
    "B": ["0,0 0,1 .7,1 .9,.77 .7,.54 0,.54", ".7,.54 1,.28 .75,0 0,0"],
    "C": ["1,.8 .8,1 .3,1 0,.75 0,.25 .3,0 .8,0 1,.2"],
    "D": ["0,0 0,1 .6,1 1,.7 1,.3 .6,0 0,0"],
    "E": ["1,0 0,0 0,1 1,1", "0,.53 .75,.53"],
    "F": ["0,0 0,1 1,1", "0,.53 .75,.53"],
    "G": ["1,.8 .8,1 .3,1 0,.75 0,.25 .3,0 .8,0 1,.2 1,.47 .6,.47"],
    "H": ["0,0 0,1", "1,0 1,1", "0,.52 1,.52"],
    "I": [".5,0 .5,1"],
    "J": ["1,1 1,.25 .75,0 .3,0 0,.25"],
    "K": ["0,0 0,1", "1,1 0,.45", ".3,.6 1,0"],
    "L": ["0,1 0,0 1,0"],
    "M": ["0,0 0,1 .5,.4 1,1 1,0"],
    "N": ["0,0 0,1 1,0 1,1"],
    "O": ["0,.5 0,.75 .3,1 .7,1 1,.75 1,.25 .7,0 .3,0 0,.25 0,.5"],
    "P": ["0,0 0,1 .7,1 1,.85 1,.6 .7,.46 0,.46"],
    "R": ["0,0 0,1 .7,1 1,.85 1,.62 .7,.48 0,.48", ".55,.48 1,0"],
    "S": ["1,.82 .75,1 .25,1 0,.82 .1,.6 .9,.42 1,.2 .75,0 .25,0 0,.18"],
    "T": ["0,1 1,1", ".5,1 .5,0"],
    "U": ["0,1 0,.25 .3,0 .7,0 1,.25 1,1"],
    "X": ["0,0 1,1", "0,1 1,0"],
    "Y": ["0,1 .5,.5 1,1", ".5,.5 .5,0"],
    "Z": ["0,1 1,1 0,0 1,0"],
    "candle": [".32,0 .32,.55 .68,.55 .68,0 .32,0", ".5,.55 .5,.66", ".5,1 .33,.78 .5,.66 .67,.78 .5,1"],
    "glass": ["0,1 .5,.5 1,1 0,1", ".5,.5 .5,.04", ".2,0 .8,0", ".3,.86 .7,.86"],
    "bowl": [
        "0,.5 .08,.2 .35,0 .65,0 .92,.2 1,.5 0,.5",
        ".3,.62 .38,.74 .28,.86 .36,1",
        ".65,.62 .73,.74 .63,.86 .71,1",
    ],
    "moon": [".75,.98 .3,.9 .05,.5 .3,.1 .75,.02 .45,.25 .35,.5 .45,.75 .75,.98"],
    "arrow": ["0,1 0,.35 .25,.2 .8,.2", ".55,.42 .9,.2 .55,0"],
}


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)


def strokes(letter):
    """The letter's polylines with rounded corners (Ref: Chaikin 1974)."""
    for text in LETTERS[letter]:
        line = np.array([[float(c) for c in point.split(",")] for point in text.split()])
        closed = bool(np.all(line[0] == line[-1]))
        for _ in range(3):
            a, b = line[:-1], line[1:]
            inner = np.stack([0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b], axis=1).reshape(-1, 2)
            line = np.vstack([inner, inner[:1]]) if closed else np.vstack([line[:1], inner, line[-1:]])
        yield line


def quad(*corners, size=None):
    """A rectangle, whose texture covers size = (u, v), by default the unit square."""
    p = np.array(corners, float)
    normals = np.tile(unit(np.cross(p[1] - p[0], p[3] - p[0])), (4, 1))
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * (size if size is not None else 1)
    return p, normals, uvs, np.array([[0, 1, 2], [0, 2, 3]])


def front(x0, x1, y0, y1, z):
    """A rectangle that faces +z, with the whole texture."""
    return quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))


def wall(x0, x1, y0, y1, z, unit_of_texture):
    """The same with the texture of the place."""
    p, n, _, t = front(x0, x1, y0, y1, z)
    return p, n, p[:, :2] / unit_of_texture, t


def box(low, high, unit_of_texture=1.0):
    (x0, y0, z0), (x1, y1, z1) = low, high
    w, h, d = (np.subtract(high, low) / unit_of_texture).tolist()
    return joined(
        [
            quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1), size=(w, h)),
            quad((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0), size=(w, h)),
            quad((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1), size=(d, h)),
            quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0), size=(d, h)),
            quad((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0), size=(w, d)),
            quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1), size=(w, d)),
        ]
    )


def sheet(points, uvs=None, round_columns=False):
    """A smooth surface through rows of points, whose front sees columns go right where rows go up."""
    rows, columns, _ = points.shape
    across = np.gradient(points, axis=1)
    if round_columns:  # The last column is the first.
        across[:, 0] = across[:, -1] = points[:, 1] - points[:, -2]
    normals = unit(np.cross(across, np.gradient(points, axis=0)))
    if uvs is None:
        uvs = np.stack(np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows)), axis=-1)
    j, i = np.meshgrid(np.arange(columns - 1), np.arange(rows - 1))
    a = (i * columns + j).reshape(-1, 1)
    triangles = np.hstack([a, a + 1, a + columns + 1, a, a + columns + 1, a + columns]).reshape(-1, 3)
    corners = points.reshape(-1, 3)[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return points.reshape(-1, 3), normals.reshape(-1, 3), uvs.reshape(-1, 2), triangles[areas > 1e-8]


def turned(profile, sides):
    """A surface of revolution about +y, of a profile (radius, y) that goes up where the outside is its front."""
    radius, y = np.array(profile, float).T[:, :, None]
    angle = np.linspace(0, 2 * math.pi, sides + 1)[None]
    return sheet(
        np.stack([radius * np.cos(angle), y + 0 * angle, -radius * np.sin(angle)], axis=-1), round_columns=True
    )


def ball(radius, sides, rows, stretch=1.0):
    angle = np.linspace(-math.pi / 2, math.pi / 2, rows + 1)
    profile = np.stack([radius * np.cos(angle), stretch * radius * np.sin(angle)], axis=1)
    return turned(profile, sides)


def tube(path, radius, sides=8, plane=(0, 0, 1)):
    """A tube along a path in a plane of that normal, with pointed ends unless it is closed."""
    path = np.asarray(path, float)
    closed = np.allclose(path[0], path[-1])
    along = np.gradient(path, axis=0)
    if closed:
        along[0] = along[-1] = path[1] - path[-2]
    along = unit(along)
    radii = np.full(len(path), float(radius))
    if not closed:
        ends = [path[:1] - 0.7 * radius * along[:1], path[-1:] + 0.7 * radius * along[-1:]]
        path = np.vstack([ends[0], path, ends[1]])
        along = np.vstack([along[:1], along, along[-1:]])
        radii = np.concatenate([[0.02 * radius], radii, [0.02 * radius]])
    a = np.tile(np.array(plane, float), (len(path), 1))
    b = np.cross(along, a)
    angle = np.linspace(0, 2 * math.pi, sides + 1)[None, :, None]
    ring = np.cos(angle) * a[:, None] + np.sin(angle) * b[:, None]
    return sheet(path[:, None] + radii[:, None, None] * ring, round_columns=True)


def letter_tubes(letter, width, height, radius, sides=8):
    """A letter of neon, from (0, 0, 0) to (width, height, 0)."""
    size = np.array([width, height])
    lines = [np.hstack([line * size, np.zeros((len(line), 1))]) for line in strokes(letter)]
    return joined([tube(line, radius, sides) for line in lines])


def pillow(size, exponent, rows=16, columns=32):
    """A superellipsoid: exponent 1 is an ellipsoid, 0 a box. Ref: Barr 1981."""
    v = np.linspace(-math.pi / 2, math.pi / 2, rows + 1)[:, None]
    u = np.linspace(0, 2 * math.pi, columns + 1)[None]

    def power(x):
        return np.where(np.abs(x) < 1e-9, 0, np.sign(x) * np.abs(x) ** exponent)

    x, y, z = power(np.cos(v)) * power(np.cos(u)), power(np.sin(v)) + 0 * u, -power(np.cos(v)) * power(np.sin(u))
    return sheet(np.stack([x, y, z], axis=-1) * size, round_columns=True)


def joined(meshes):
    first, triangles = 0, []
    for mesh in meshes:
        triangles.append(mesh[3] + first)
        first += len(mesh[0])
    return (*(np.vstack([mesh[i] for mesh in meshes]) for i in range(3)), np.vstack(triangles))


def moved(mesh, offset):
    return (mesh[0] + np.array(offset, float), *mesh[1:])


def placed(mesh, axes, origin):
    """The mesh in another frame: axes are the unit vectors along x, y and z."""
    axes = np.array(axes, float)
    return mesh[0] @ axes + np.array(origin, float), mesh[1] @ axes, *mesh[2:]


def write_ply(path, mesh):
    positions, normals, uvs, triangles = mesh
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header\n"]
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    rows = np.hstack([positions, normals, uvs]).astype("<f4")
    path.write_bytes("\n".join(header).encode() + rows.tobytes() + faces.tobytes())
