#!/usr/bin/env python3
"""Makes the meshes of lemons.json: `python3 make_lemon_meshes.py` writes PLY files into lemons/.

They are the same each time, and in metres. Needs NumPy (Debian: python3-numpy). make_lemon_cloth.py makes the cloth.
"""

import math
from pathlib import Path

import numpy as np

from make_mesh import spline

FOLDER = Path(__file__).parent / "lemons"


def write_ply(name, positions, normals, uvs, faces, colours=None):
    """Writes rows of positions, normals, texture coordinates and sRGB colours (or none), and of faces' indices."""
    properties = [f"property float {c}" for c in ("x", "y", "z", "nx", "ny", "nz", "u", "v")]
    vertices = np.hstack([positions, normals, uvs]).astype("<f4").view(np.uint8).reshape(len(positions), -1)
    if colours is not None:
        vertices = np.hstack([vertices, np.round(255 * np.asarray(colours)).astype(np.uint8)])
        properties += [f"property uchar {c}" for c in ("red", "green", "blue")]
    corners = np.asarray(faces, dtype="<u2")
    counts = np.full((len(corners), 1), corners.shape[1], dtype=np.uint8)
    rows = np.hstack([counts, corners.view(np.uint8).reshape(len(corners), -1)])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}", *properties]
    header += [f"element face {len(corners)}", "property list uchar ushort vertex_indices", "end_header\n"]
    (FOLDER / name).write_bytes("\n".join(header).encode() + vertices.tobytes() + rows.tobytes())


def grid_faces(rows, columns):
    """Quads of a grid of vertices, seen from where rows go up and columns to the right."""
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    return np.stack([first, first + 1, first + columns + 1, first + columns], axis=1)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def lathe(points, around=64, steps=3):
    """What the profile `points` (r, y) sweeps about the y axis: u goes around it, v along the profile."""
    curve = spline(points, steps)
    profile, tangent = (np.array([part[k] for part in curve]) for k in (0, 1))
    profile[:, 0] = np.maximum(profile[:, 0], 1e-5)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(profile, axis=0), axis=1))])
    u = np.arange(around + 1) / around
    x, z = np.cos(2 * np.pi * u), -np.sin(2 * np.pi * u)
    shape = (len(curve), around + 1)
    r, y, dr, dy = (np.broadcast_to(c[:, None], shape) for c in (*profile.T, *tangent.T))
    positions = np.stack([r * x, y, r * z], axis=-1).reshape(-1, 3)
    normals = np.stack([dy * x, -dr, dy * z], axis=-1).reshape(-1, 3)
    uvs = np.stack(np.broadcast_arrays(u[None, :], (length / length[-1])[:, None]), axis=-1).reshape(-1, 2)
    return positions, normals, uvs, grid_faces(*shape)


# Profiles from the foot up the outside, over the lip and down the inside, in centimetres.
JUG = [
    *[(0, 0.25), (3.2, 0.2), (3.6, 0), (3.95, 0.12), (4.3, 0.9), (5.6, 3.6), (6.35, 6.6), (6.1, 9.4), (4.9, 12.0)],
    *[(3.3, 14.2), (2.45, 16.2), (2.3, 18.0), (2.65, 19.6), (2.95, 20.25), (2.85, 20.45), (2.6, 20.25), (2.2, 19.3)],
    *[(1.95, 18.0), (2.1, 16.2), (2.9, 14.0), (3.2, 12), (0, 11)],
]
BOWL = [
    *[(0, 0.35), (2.5, 0.3), (2.9, 0), (3.2, 0.1), (3.25, 0.6), (4.0, 1.05), (5.9, 2.1), (7.6, 3.8), (8.6, 5.8)],
    *[(8.9, 6.9), (9.15, 7.15), (9.1, 7.35), (8.85, 7.3), (8.6, 6.9), (8.3, 5.8), (7.3, 3.95), (5.7, 2.4), (3.9, 1.4)],
    (0, 0.9),
]
BEAKER = [
    *[(0, 0.3), (2.3, 0.25), (2.65, 0), (2.85, 0.15), (2.9, 0.7), (2.95, 2.5), (3.1, 5.0), (3.4, 7.6), (3.62, 8.7)],
    *[(3.66, 8.85), (3.58, 8.9), (3.5, 8.75), (3.28, 7.6), (2.98, 5.0), (2.8, 2.5), (2.5, 1.2), (0, 1.0)],
]


def metres(profile):
    return [(r / 100, y / 100) for r, y in profile]


def lemon_radius(t):
    """Of a lemon at t from 0 (stalk) to 1 (tip) of its length."""
    body = math.sqrt(max(0.0, 1 - ((t - 0.47) / 0.43) ** 2))
    tip = 0.27 * math.sqrt(max(0.0, 1 - ((t - 0.86) / 0.14) ** 2))
    stalk = 0.2 * math.sqrt(max(0.0, 1 - ((t - 0.08) / 0.075) ** 2))
    return 0.031 * (body**4 + tip**4 + stalk**4) ** 0.25


def lemon_colours(t):
    """At shares of its length: greenish towards the ends, brown where the stalk was."""
    green = np.clip((0.17 - t) / 0.15, 0, 1) * 0.55 + np.clip((t - 0.86) / 0.12, 0, 1) * 0.4
    colours = np.array([1.0, 0.80, 0.07]) * (1 - green[..., None]) + np.array([0.78, 0.74, 0.14]) * green[..., None]
    brown = np.clip((0.022 - t) / 0.012, 0, 1)[..., None]
    return colours * (1 - brown) + np.array([0.38, 0.3, 0.16]) * brown


def lemon(steps, length=0.082, around=48):
    """A lemon along +y, a little bent and uneven, up to the last of `steps`, which are shares of its length."""
    u = np.arange(around + 1) / around
    uneven = 1 + 0.025 * np.cos(2 * np.pi * (2 * u + 0.1)) + 0.012 * np.cos(2 * np.pi * 3 * u)
    r = np.array([lemon_radius(t) for t in steps])[:, None] * uneven
    t = np.broadcast_to(steps[:, None], r.shape)
    y = t * length
    surface = np.stack([r * np.cos(2 * np.pi * u), y, -r * np.sin(2 * np.pi * u)], axis=-1)
    surface[..., 0] += 0.05 * (y - 0.5 * length) ** 2 / length
    dv = np.gradient(surface, axis=0)
    du = np.roll(surface[:, :-1], -1, 1) - np.roll(surface[:, :-1], 1, 1)
    du = np.concatenate([du, du[:, :1]], axis=1)
    uvs = np.stack([np.broadcast_to(u, r.shape), t], axis=-1)
    rows = [part.reshape(-1, part.shape[-1]) for part in (surface, unit(np.cross(du, dv)), uvs, lemon_colours(t))]
    return *rows[:3], grid_faces(*r.shape), rows[3]


# Shares of a lemon's length, closest at its ends, whose vertices nearly meet but span triangles.
WHOLE = 0.00502 + 0.99298 * (0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 44)))
HALF = 0.00502 + 0.46498 * (1 - np.cos(0.5 * np.pi * np.linspace(0, 1, 22)))


def frame(tangent, up=(0.0, 1.0, 0.0)):
    """Unit vectors at right angles to tangents and to each other, the second as near to `up` as it can be."""
    side = unit(np.cross(tangent, up))
    return side, np.cross(side, tangent)


def curve(knots, steps):
    """Points on a curve through `knots`.   Ref: Catmull and Rom 1974, A Class of Local Interpolating Splines."""
    knots = np.array(knots)
    knots = np.vstack([2 * knots[0] - knots[1], knots, 2 * knots[-1] - knots[-2]])
    s = np.linspace(0, 1, steps, endpoint=False)[:, None]
    parts = [
        0.5 * (2 * b + (c - a) * s + (2 * a - 5 * b + 4 * c - d) * s**2 + (3 * (b - c) + d - a) * s**3)
        for a, b, c, d in zip(knots, knots[1:], knots[2:], knots[3:])
    ]
    return np.vstack([*parts, knots[-2:-1]])


def tube(points, radii, around=6):
    """A tube along points."""
    tangents = unit(np.gradient(points, axis=0))
    side, up = frame(tangents, (0.13, 0.2, 0.97))
    phi = 2 * np.pi * np.arange(around + 1) / around
    normals = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * up[:, None]
    positions = points[:, None] + radii[:, None, None] * normals
    u, v = np.broadcast_arrays(phi / (2 * np.pi), np.linspace(0, 1, len(points))[:, None])
    uvs = np.stack([u, v], axis=-1)
    return *(part.reshape(-1, part.shape[-1]) for part in (positions, normals, uvs)), grid_faces(*u.shape)[:, ::-1]


def joined(parts):
    """Several meshes as one."""
    offsets = np.cumsum([0] + [len(part[0]) for part in parts])
    columns = [np.vstack([part[k] for part in parts]) for k in range(len(parts[0])) if k != 3]
    faces = np.vstack([part[3] + offset for part, offset in zip(parts, offsets)])
    return *columns[:3], faces, *columns[3:]


def leaf(base, direction, face, length, bend, fold, tint):
    """A card for leaf.png from `base` along `direction`, whose upper side looks towards `face`."""
    s, t = np.meshgrid(np.linspace(-1, 1, 5), np.linspace(0, 1, 9))
    forward = unit(np.asarray(direction))
    side = unit(np.cross(forward, face))
    up = np.cross(side, forward)
    angle = bend * t
    along, down = length * np.sin(angle) / bend, length * (1 - np.cos(angle)) / bend
    half = 0.235 * length
    across, rise = half * s * math.cos(fold), half * abs(s) * math.sin(fold)
    wave = 0.025 * length * np.sin(7 * t + 2 * s) * abs(s)
    surface = np.asarray(base) + along[..., None] * forward + across[..., None] * side
    surface = surface + (rise - down + wave * (1 - t))[..., None] * up
    normals = unit(np.cross(np.gradient(surface, axis=1), np.gradient(surface, axis=0)))
    uvs = np.stack([0.5 + 0.5 * s, t], axis=-1).reshape(-1, 2)
    colours = np.broadcast_to(tint, (s.size, 3))
    return surface.reshape(-1, 3), normals.reshape(-1, 3), uvs, grid_faces(*s.shape), colours


# Twigs of laurel: knots, from inside the jug, whose mouth is at (0, 0.2, 0).
TWIGS = [
    [(0.004, 0.12, 0), (-0.006, 0.20, 0.004), (-0.025, 0.255, 0.012), (-0.032, 0.31, 0.01), (-0.02, 0.355, -0.005)],
    [(-0.006, 0.12, 0), (0.012, 0.20, 0.006), (0.045, 0.24, 0.02), (0.09, 0.268, 0.035), (0.14, 0.27, 0.03)],
    [(0, 0.12, 0.004), (0.004, 0.20, -0.01), (0.025, 0.26, -0.03), (0.042, 0.305, -0.04), (0.075, 0.335, -0.045)],
    [(0.006, 0.12, 0), (-0.014, 0.20, 0.006), (-0.055, 0.23, 0.03), (-0.09, 0.237, 0.05), (-0.12, 0.225, 0.06)],
]
LEAVES = (14, 14, 12, 10)  # Of each twig.
# Leaves that fell: the place of the stalk, beside the jug, and the angle from +x towards -z.
FALLEN = [((-0.005, 0.0012, 0.265), 0.35), ((-0.055, 0.0012, 0.215), 2.6)]


def leaves_on(points, count, random):
    """Leaves all around a twig, the youngest, small and pale, at its end."""
    tangents = unit(np.gradient(points, axis=0))
    places = np.linspace(int(0.36 * len(points)), len(points) - 1, count).round().astype(int)
    for k, place in enumerate(places):
        tangent = tangents[place]
        side, up = frame(tangent)
        turn = 2.4 * k + random.uniform(-0.4, 0.4)
        outward = math.cos(turn) * side + math.sin(turn) * up
        spread = 0.15 if k == count - 1 else random.uniform(0.85, 1.25)
        direction = tangent * math.cos(spread) + outward * math.sin(spread) + [0, 0.12, 0]
        face = unit(tangent * 0.5 - outward * 0.2 + [-0.35, 0.5, 0.7])
        young = k / count
        length = random.uniform(0.052, 0.070) * (1 - 0.35 * young**2)
        tint = np.array([0.72, 0.78, 0.72]) * (1 - young) + np.array([1, 1, 0.85]) * young
        bend, fold, shade = random.uniform(0.3, 0.9), random.uniform(0.15, 0.4), random.uniform(0.8, 1.1)
        yield leaf(points[place], direction, face, length, bend, fold, np.clip(tint * shade, 0, 1))


def sprig():
    """The twigs; and their leaves, with those that fell."""
    random = np.random.RandomState(12)
    stems, leaves = [], []
    for knots, count in zip(TWIGS, LEAVES):
        points = curve(knots, 6)
        stems.append(tube(points, np.linspace(0.0022, 0.0009, len(points))))
        leaves += leaves_on(points, count, random)
    for base, angle in FALLEN:
        leaves.append(leaf(base, (math.cos(angle), 0, -math.sin(angle)), (0, 1, 0), 0.058, -0.5, 0.2, (0.9, 0.85, 0.6)))
    return joined(stems), joined(leaves)


def plank(z, width, u_offset, strip, mirrored):
    """A board along x with rounded edges, its top at y = 0; `strip` counts the boards of wood.png."""
    bevel, thick = 0.004, 0.035
    angles = np.radians([0, 22.5, 45, 67.5, 90])
    rounding = [(z + width - bevel + bevel * math.sin(a), -bevel + bevel * math.cos(a)) for a in angles]
    profile = [(z + width, -thick), *rounding[::-1], *[(2 * z + width - p, y) for p, y in rounding], (z, -thick)]
    turned = [math.pi / 2, *angles[::-1], *-angles, -math.pi / 2]
    length = np.concatenate([[0], np.cumsum([math.dist(a, b) for a, b in zip(profile, profile[1:])])])
    v = (length - length[5]) / (length[6] - length[5])
    v = (strip + np.clip(np.where(mirrored, 1 - v, v), 0.02, 0.98)) / 3
    x = np.array([-0.9, 0.9])
    positions = np.array([[[c, y, p] for c in x] for p, y in profile])
    normals = np.array([[[0, math.cos(a), math.sin(a)]] * 2 for a in turned])
    uvs = np.array([[[u_offset + c / 0.9, row] for c in x] for row in v])
    return positions.reshape(-1, 3), normals.reshape(-1, 3), uvs.reshape(-1, 2), grid_faces(len(profile), 2)


FRONT = 0.27  # z of the table's front edge.


def table():
    """Six boards side by side, the first at the front."""
    widths, offsets = (0.115, 0.14, 0.125, 0.14, 0.13, 0.14), (0.1, 0.55, 0.3, 0.8, 0.2, 0.6)
    strips, mirrored = (1, 0, 2, 1, 0, 2), (False, False, False, True, True, True)
    parts, edge = [], FRONT
    for board in zip(widths, offsets, strips, mirrored):
        edge -= board[0] + 0.0006
        parts.append(plank(edge, *board))
    return joined(parts)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    write_ply("table.ply", *table())
    write_ply("jug.ply", *lathe(metres(JUG)))
    write_ply("bowl.ply", *lathe(metres(BOWL), around=80))
    write_ply("beaker.ply", *lathe(metres(BEAKER)))
    write_ply("lemon.ply", *lemon(WHOLE))
    write_ply("half.ply", *lemon(HALF))
    twigs, leaves = sprig()
    write_ply("twigs.ply", *twigs)
    write_ply("leaves.ply", *leaves)
