#!/usr/bin/env python3
"""Makes a forest of instances: `python3 make_forest.py FOLDER` writes forest.json, its trees and its sky there: 71 MB.

Each kind of tree is an object of two meshes, wood and leaves; all trees are instances of these. The same seeds make the
same forest. Needs NumPy (Debian: python3-numpy).
"""

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

import radiance_picture
import textures

SIDES = 5  # Of the tubes of branches.
SPACING = 4.5  # Between trees, on average [m].
SUN_AZIMUTH, SUN_ELEVATION = math.radians(-62), math.radians(12)  # From -Z towards +X; above the horizon.
MAX_WOOD = 0.3  # Of a tree's triangles.


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def broadleaf(random, levels=4):
    """The branches of a tree, and its twigs: rows of both ends and of the radius at the first."""
    height = random.uniform(3.0, 4.0)
    level = np.array([[0, 0, 0, 0, height, 0, 0.06 * height]])
    branches = [level]
    for _ in range(levels):
        parents = np.repeat(level, 5, axis=0)
        start, end, radius = parents[:, :3], parents[:, 3:6], parents[:, 6:]
        at = start + random.uniform(0.45, 1.0, radius.shape) * (end - start)
        along = unit(unit(end - start) + 0.9 * unit(random.normal(size=at.shape)) + [0, 0.15, 0])
        length = 0.6 * np.linalg.norm(end - start, axis=1, keepdims=True)
        level = np.hstack([at, at + length * along, 0.5 * radius])
        branches.append(level)
    return np.vstack(branches), level


def conifer(random, whorls=64):
    """The same of a tree with level branches all along its stem."""
    height = random.uniform(9.0, 13.0)
    branches, twigs = [np.array([[0, 0, 0, 0, height, 0, 0.016 * height]])], []
    count = 7
    for i in range(whorls):
        fraction = (i + random.uniform(0, 1)) / whorls  # Of the way up the crown.
        turns = random.uniform(0, 1) + (np.arange(count) + random.uniform(-0.3, 0.3, count)) / count
        angle = 2 * math.pi * turns
        rise = -0.35 + 0.6 * fraction + random.uniform(-0.1, 0.1, count)
        out = np.stack([np.cos(angle), rise, np.sin(angle)], axis=1)
        length = (0.25 * height * (1 - fraction) ** 0.9 + 0.2) * random.uniform(0.75, 1.1, (count, 1))
        start = np.tile([0, height * (0.06 + 0.93 * fraction), 0], (count, 1))
        end = start + length * out
        branches.append(np.hstack([start, end, np.full((count, 1), 0.02)]))
        across = np.stack([-np.sin(angle), np.zeros(count), np.cos(angle)], axis=1)
        for side in (-1, 1):
            for part in (0.2, 0.35, 0.5, 0.65, 0.8):
                at = start + part * (end - start)
                tip = at + 0.45 * (1.1 - part) * length * (0.7 * unit(out) + side * across + [0, -0.15, 0])
                twigs.append(np.hstack([at, tip, np.zeros((count, 1))]))
        twigs.append(np.hstack([start + 0.2 * (end - start), end, np.zeros((count, 1))]))
    return np.vstack(branches), np.vstack(twigs)


def tubes(branches):
    """Vertices and triangles of tubes around branches, whose far ends are three fifths as thick."""
    start, end, radius = branches[:, :3], branches[:, 3:6], branches[:, 6]
    axis = unit(end - start)
    aside = np.where(np.abs(axis[:, 1:2]) < 0.9, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    x = unit(np.cross(axis, aside))
    y = np.cross(axis, x)
    angle = 2 * math.pi * np.arange(SIDES) / SIDES
    ring = np.cos(angle)[None, :, None] * x[:, None] + np.sin(angle)[None, :, None] * y[:, None]
    near = start[:, None] + radius[:, None, None] * ring
    far = end[:, None] + 0.6 * radius[:, None, None] * ring
    vertices = np.concatenate([near, far], axis=1).reshape(-1, 3)
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    sides = np.concatenate([np.stack([i, j, SIDES + j], 1), np.stack([i, SIDES + j, SIDES + i], 1)])
    triangles = sides[None] + 2 * SIDES * np.arange(len(branches))[:, None, None]
    return vertices, triangles.reshape(-1, 3)


def leaves(twigs, count, size, spread, random):
    """Vertices (four of each leaf) and triangles (two) of leaves size = (length, width) [m] around twigs."""
    twig = twigs[np.arange(count) % len(twigs)]
    at = twig[:, :3] + random.uniform(0, 1, (count, 1)) * (twig[:, 3:6] - twig[:, :3])
    at = at + spread * random.uniform(-1, 1, (count, 3))
    along = unit(unit(twig[:, 3:6] - twig[:, :3]) + 1.2 * unit(random.normal(size=(count, 3))))
    across = unit(np.cross(along, random.normal(size=(count, 3))))
    length, width = size
    middle, side = at + 0.5 * length * along, 0.5 * width * across
    vertices = np.stack([at, middle - side, at + length * along, middle + side], axis=1).reshape(-1, 3)
    first = 4 * np.arange(count)[:, None]
    triangles = np.concatenate([first + [0, 1, 2], first + [0, 2, 3]], axis=1)
    return vertices, triangles.reshape(-1, 3)


def write_ply(path, vertices, triangles, uvs=None):
    names = ["x", "y", "z"] + (["u", "v"] if uvs is not None else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header\n"]
    rows = vertices if uvs is None else np.hstack([vertices, uvs])
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    path.write_bytes("\n".join(header).encode() + rows.astype("<f4").tobytes() + faces.tobytes())


def leaf_picture(size=64):
    """A leaf from the lower left corner to the upper right one, cut out by alpha."""
    u, v = textures.grid(size, size)
    along, across = (u + v) / 2, (u - v) / math.sqrt(2)
    width = 0.5 * np.sin(math.pi * np.clip(along, 0, 1) ** 0.8) * (1 + 0.15 * np.sin(60 * along))
    alpha = (np.abs(across) < width).astype(float)
    return np.stack([np.ones_like(u), np.ones_like(u), np.ones_like(u), alpha], axis=-1)


def height_at(x, z):
    """The ground [m]."""
    return 12 * np.sin(x / 71 + 1.0) * np.sin(z / 83 + 0.4) + 4 * np.sin(x / 31 + z / 43)


def ground(edge, cells=200):
    x, z = np.meshgrid(np.linspace(-edge, edge, cells + 1), np.linspace(-edge, edge, cells + 1))
    vertices = np.stack([x, height_at(x, z), z], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(cells), np.arange(cells))
    a = (j * (cells + 1) + i).reshape(-1, 1)
    quads = np.hstack([a, a + cells + 1, a + cells + 2, a, a + cells + 2, a + 1])
    return vertices, quads.reshape(-1, 3)


def sky(width=512, height=256):
    """Rows of radiance [W/(m^2 sr)]: blue above, warm around the sun, which is a light of its own."""
    azimuth = 2 * math.pi * ((np.arange(width) + 0.5) / width - 0.5)
    elevation = math.pi * (0.5 - (np.arange(height) + 0.5) / height)[:, None]
    cosine = np.sin(elevation) * math.sin(SUN_ELEVATION)
    cosine = cosine + np.cos(elevation) * math.cos(SUN_ELEVATION) * np.cos(azimuth - SUN_AZIMUTH)
    angle = np.arccos(np.clip(cosine, -1, 1))[..., None]
    up = np.clip(elevation, 0, None)[..., None]
    air = np.array([0.20, 0.36, 0.70]) + np.array([0.45, 0.30, 0.12]) * np.exp(-up / 0.2)
    glow = np.array([2.2, 1.2, 0.45]) * np.exp(-((angle / 0.3) ** 2))
    glow = glow + np.array([0.8, 0.42, 0.14]) * np.exp(-((angle / 0.8) ** 2))
    return air + glow


def place_trees(count, edge, random):
    """Where trees stand: a jittered grid around the clearing before the camera, the nearest first."""
    rows = math.ceil(math.sqrt(1.05 * count))
    x, z = np.meshgrid(np.arange(rows), np.arange(rows))
    points = SPACING * (np.stack([x.ravel(), z.ravel()], axis=1) - 0.5 * rows + 0.5)
    points = points + SPACING * random.uniform(-0.4, 0.4, points.shape)
    clearing = np.hypot(points[:, 0], points[:, 1] - 0.42 * SPACING * rows) < min(26, 0.2 * SPACING * rows)
    return points[~clearing][:count], 0.5 * SPACING * rows


def make_kind(folder, kind, triangles, alpha):
    """Writes a kind of tree, and returns its object."""
    random = np.random.RandomState(kind + 1)
    is_conifer = kind % 5 < 2
    for fewer in range(5):
        branches, twigs = conifer(random, 64 >> fewer) if is_conifer else broadleaf(random, 4 - fewer)
        if 2 * SIDES * len(branches) <= MAX_WOOD * triangles or fewer == 4:
            break
    count = max((triangles - 2 * SIDES * len(branches)) // 2, 1)
    length, width, spread = (0.10, 0.018, 0.04) if is_conifer else (0.11, 0.055, 0.14)
    larger = 1.2 if alpha else 1.0  # As the image leaves some of it out.
    vertices, faces = leaves(twigs, count, (larger * length, larger * width), spread, random)
    uvs = np.tile([[0, 0], [1, 0], [1, 1], [0, 1]], (count, 1)) if alpha else None
    write_ply(folder / f"wood_{kind:02}.ply", *tubes(branches))
    write_ply(folder / f"leaves_{kind:02}.ply", vertices, faces, uvs)
    return [
        {"type": "ply", "file": f"wood_{kind:02}.ply", "material": "bark"},
        {"type": "ply", "file": f"leaves_{kind:02}.ply", "material": f"leaves_{kind:02}"},
    ]


def leaf_material(kind, alpha):
    random = np.random.RandomState(1000 + kind)
    if kind % 5 < 2:
        colour = np.array([0.06, 0.12, 0.045]) * random.uniform(0.8, 1.3)
    else:
        autumn = [[0.14, 0.23, 0.04], [0.38, 0.25, 0.04], [0.40, 0.15, 0.03], [0.22, 0.26, 0.05]]
        colour = np.array(autumn[random.randint(4)]) * random.uniform(0.8, 1.2)
    colour = [round(float(c), 4) for c in colour]
    material = {"type": "diffuse_transmission", "reflectance": colour, "transmittance": colour}
    if alpha:
        material["opacity"] = {"image": "leaf.png", "cutoff": 0.5}
    return material


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--trees", type=int, default=10_000, help="default: %(default)s")
    parser.add_argument("--kinds", type=int, default=20, help="default: %(default)s")
    parser.add_argument("--triangles", type=int, default=100_000, help="of a tree (default: %(default)s)")
    parser.add_argument("--alpha", action="store_true", help="leaves are cut out of an image")
    options = parser.parse_args()
    if min(options.trees, options.kinds, options.triangles // 100) < 1:
        sys.exit("make_forest.py: there must be a tree, a kind, and 100 triangles of each")

    options.folder.mkdir(parents=True, exist_ok=True)
    objects = {}
    for kind in range(options.kinds):
        objects[f"tree_{kind:02}"] = make_kind(options.folder, kind, options.triangles, options.alpha)
    if options.alpha:
        textures.write_png(options.folder / "leaf.png", leaf_picture())

    random = np.random.RandomState(0)
    points, edge = place_trees(options.trees, SPACING, random)
    heights = height_at(points[:, 0], points[:, 1])
    kinds = random.randint(options.kinds, size=len(points))
    turns, sizes = random.uniform(0, 360, len(points)), random.uniform(0.75, 1.25, len(points))
    shapes = []
    for kind in range(options.kinds):
        transforms = [
            [
                {"rotate": round(float(turns[i]), 1), "axis": [0, 1, 0]},
                {"scale": round(float(sizes[i]), 3)},
                {"translate": [round(float(c), 2) for c in (points[i, 0], heights[i] - 0.1, points[i, 1])]},
            ]
            for i in np.flatnonzero(kinds == kind)
        ]
        if transforms:
            shapes.append({"type": "instance", "object": f"tree_{kind:02}", "transforms": transforms})
    write_ply(options.folder / "ground.ply", *ground(edge + 30))
    shapes.append({"type": "ply", "file": "ground.ply", "material": "ground"})

    rows = [radiance_picture.encoded_row(row.tolist()) for row in sky()]
    head = radiance_picture.header("make_forest.py", 512, 256)
    (options.folder / "sky.hdr").write_bytes(head + b"".join(rows))

    towards_sun = (
        math.cos(SUN_ELEVATION) * math.sin(SUN_AZIMUTH),
        math.sin(SUN_ELEVATION),
        -math.cos(SUN_ELEVATION) * math.cos(SUN_AZIMUTH),
    )
    sun = {"type": "directional", "name": "sun", "direction": [round(-c, 6) for c in towards_sun]}
    eye_z = 0.84 * edge
    materials = {
        "bark": {"type": "diffuse", "reflectance": [0.16, 0.11, 0.08]},
        "ground": {"type": "diffuse", "reflectance": [0.13, 0.11, 0.05]},
    }
    materials.update({f"leaves_{kind:02}": leaf_material(kind, options.alpha) for kind in range(options.kinds)})
    scene = {
        "cameras": {
            "main": {
                "position": [0, float(height_at(0, eye_z)) + 17, eye_z],
                "look_at": [-6, float(height_at(0, 0)) - 14, 0],
                "vertical_fov": 42,
            }
        },
        "film": {"size": [960, 540]},
        "integrator": {"max_depth": 8},
        "materials": materials,
        "objects": objects,
        "shapes": shapes,
        "lights": [sun | {"irradiance": [16.0, 9.5, 4.2]}],
        "environment": {"file": "sky.hdr"},
    }
    (options.folder / "forest.json").write_text(json.dumps(scene))


if __name__ == "__main__":
    main()
