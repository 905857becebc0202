"""Houses of make_street.py: facades with windows, of which some are lit, and shops below.

Needs NumPy (Debian: python3-numpy).
"""

import math

import numpy as np

import street_pictures as pictures
from street_meshes import ball, box, front, joined, moved, quad, sheet, tube, turned, wall
from street_parts import FACADE, KERB, SIDES

STOREY, GROUND = 3.1, 3.7  # Heights [m].
REVEAL = 0.14  # Depth of windows in their wall.
# Above shops: text, paper and ink.
SIGNS = [
    ("BOOKS", (0.9, 0.75, 0.5), (0.05, 0.02, 0.01)),
    ("RAMEN", (0.9, 0.1, 0.05), (1.0, 0.85, 0.6)),
    ("CAFE", (0.1, 0.3, 0.25), (1.0, 0.8, 0.5)),
    ("TOYS", (0.95, 0.6, 0.1), (0.5, 0.02, 0.05)),
    ("FLORIST", (0.75, 0.9, 0.7), (0.02, 0.15, 0.05)),
    ("RECORDS", (0.08, 0.08, 0.3), (0.4, 0.8, 1.0)),
    ("BAKERY", (1.0, 0.7, 0.4), (0.2, 0.05, 0.01)),
    ("TAILOR", (0.7, 0.75, 0.9), (0.02, 0.02, 0.1)),
    ("NOODLES", (0.95, 0.85, 0.6), (0.6, 0.03, 0.02)),
    ("PHARMACY", (0.8, 0.95, 0.9), (0.0, 0.3, 0.1)),
    ("TEA", (0.3, 0.5, 0.15), (0.95, 0.95, 0.7)),
]


def pierced(width, height, holes, texture):
    """A wall with holes (x0, x1, y0, y1), and their sides."""
    xs = sorted({0, width, *(x for hole in holes for x in hole[:2])})
    ys = sorted({0, height, *(y for hole in holes for y in hole[2:])})
    meshes = []
    for x0, x1 in zip(xs, xs[1:]):
        for y0, y1 in zip(ys, ys[1:]):
            x, y = (x0 + x1) / 2, (y0 + y1) / 2
            if not any(a < x < b and c < y < d for a, b, c, d in holes):
                meshes.append(wall(x0, x1, y0, y1, 0, texture))
    for a, b, c, d in holes:
        e = -REVEAL
        size = (REVEAL / texture, (d - c) / texture)
        meshes += [
            quad((a, c, 0), (a, c, e), (a, d, e), (a, d, 0), size=size),
            quad((b, c, e), (b, c, 0), (b, d, 0), (b, d, e), size=size),
            quad((a, d, e), (b, d, e), (b, d, 0), (a, d, 0), size=size),
            quad((a, c, 0), (b, c, 0), (b, c, e), (a, c, e), size=size),
        ]
    return joined(meshes)


def frame(x0, x1, y0, y1, bars=(1, 1), thick=0.06):
    """The frame of a window, with bars upright and across."""
    z0, z1 = -REVEAL, -REVEAL + 0.06
    thin = 0.66 * thick
    meshes = [box((x, y0, z0), (x + thick, y1, z1)) for x in (x0, x1 - thick)]
    meshes += [box((x0, y, z0), (x1, y + thick, z1 - 0.005)) for y in (y0, y1 - thick)]
    for i in range(bars[0]):
        x = x0 + (x1 - x0) * (i + 1) / (bars[0] + 1) - thin / 2
        meshes.append(box((x, y0, z0), (x + thin, y1, z1)))
    for i in range(bars[1]):
        y = y0 + (y1 - y0) * (0.68 if bars[1] == 1 else (i + 1) / (bars[1] + 1))
        meshes.append(box((x0, y, z0), (x1, y + thin, z1 - 0.005)))
    return joined(meshes)


def lit_window(street, hole, random, axes, origin):
    """A window with a curtain that shines: a wavy sheet with one of 16 pictures."""
    x0, x1, y0, y1 = hole
    s, t = np.meshgrid(np.linspace(0, 1, 13), np.linspace(0, 1, 7))
    wave = 0.012 * np.sin(2 * math.pi * 3 * s + 2 * t + random.uniform(0, 6))
    points = np.stack([x0 + (x1 - x0) * s, y0 + (y1 - y0) * t, wave - REVEAL + 0.013], axis=-1)
    cell = random.randint(16)
    uvs = np.stack([(cell % 4 + 0.02 + 0.96 * s) / 4, (cell // 4 + 0.02 + 0.96 * t) / 4], axis=-1)
    if random.uniform() < 0.5:
        uvs[..., 0] = (cell % 4 + 0.02 + 0.96 * (1 - s)) / 4
    strength = round(float(random.choice([0.2, 0.4, 0.65])), 2)
    emission = street.image("rooms.png", lambda: pictures.atlas([pictures.room(i) for i in range(16)], 4), strength)
    street.shine("window", emission, sheet(points, uvs), axes, origin)


def upper_storeys(street, width, storeys, random, axes, origin, texture):
    """Windows above the shop; returns their holes."""
    columns = max(2, round((width - 0.8) / random.uniform(1.7, 2.2)))
    w, h = random.uniform(0.95, 1.15), random.uniform(1.45, 1.85)
    bars = [(1, 1), (1, 0), (0, 1), (1, 2)][random.randint(4)]
    share = random.uniform(0.25, 0.6)
    holes = []
    for floor in range(storeys):
        for column in range(columns):
            x = 0.4 + (width - 0.8) * (column + 0.5) / columns
            y = GROUND + 0.75 + STOREY * floor
            hole = (x - w / 2, x + w / 2, y, y + h)
            holes.append(hole)
            street.add("frames", frame(*hole, bars), axes=axes, origin=origin)
            street.add(
                "stone", box((hole[0] - 0.08, y - 0.09, -0.02), (hole[1] + 0.08, y, 0.12)), axes=axes, origin=origin
            )
            if random.uniform() < share:
                lit_window(street, hole, random, axes, origin)
            else:
                street.add("panes", wall(*hole, -REVEAL + 0.01, 1), axes=axes, origin=origin)
            if random.uniform() < 0.1:
                at = (x - 0.35, y - 0.62, 0.0)
                street.add("metal", box(at, np.add(at, (0.75, 0.5, 0.32))), axes=axes, origin=origin)
    return holes


def awning(street, x0, x1, y, kind, axes, origin):
    """Striped cloth above a shop, sagging between its ribs, with a hem."""
    s, t = np.meshgrid(np.linspace(0, 1, 33), np.linspace(0, 1, 9))
    sag = 0.03 * np.abs(np.sin(4 * math.pi * s)) * np.sin(math.pi * t)
    top = np.stack([x0 + (x1 - x0) * s, y - 0.62 + 0.62 * t - sag, 1.25 * (1 - t) + 0.02], axis=-1)
    hem = np.stack(
        [x0 + (x1 - x0) * s, y - 0.82 + 0.2 * t - 0.04 * np.abs(np.sin(12 * math.pi * s)) * (1 - t), 1.26 + 0 * s],
        axis=-1,
    )
    uvs = np.stack([s * round((x1 - x0) / 0.6), t], axis=-1)
    street.add(f"awning_{kind}", sheet(top, uvs), sheet(hem, uvs), axes=axes, origin=origin)


def shop(street, width, index, random, axes, origin):
    """The ground floor: a window on the shop, a door, a sign above; returns holes."""
    door_left = random.uniform() < 0.5
    door = (0.5, 1.5) if door_left else (width - 1.5, width - 0.5)
    left, right = (2.0, width - 0.5) if door_left else (0.5, width - 2.0)
    hole, entry = (left, right, 0.55, 2.75), (*door, 0.0, 2.75)
    bright = round(float(random.uniform(0.2, 0.32)), 2)
    picture = index % 8
    emission = street.image(f"shop_{picture}.png", lambda: pictures.shop(picture), bright)
    street.shine("shop", emission, front(*hole, -REVEAL + 0.01), axes, origin)
    street.add("frames", frame(*hole, (max(1, round((right - left) / 1.3) - 1), 0), 0.08), axes=axes, origin=origin)
    street.add("stone", box((left - 0.1, 0.45, -0.02), (right + 0.1, 0.55, 0.14)), axes=axes, origin=origin)
    positions, normals, uvs, triangles = front(*door, 0.9, 2.75, -REVEAL + 0.01)
    uvs = uvs * [0.2, 0.75] + [random.uniform(0.1, 0.7), 0.25]
    street.shine("door", emission, (positions, normals, uvs, triangles), axes, origin)
    street.add(
        "frames",
        box((door[0], 0.0, -REVEAL), (door[1], 0.9, -REVEAL + 0.05)),
        frame(*door, 0.9, 2.75, (0, 0), 0.1),
        axes=axes,
        origin=origin,
    )
    text, paper, ink = SIGNS[index % len(SIGNS)]
    sign = street.image(
        f"sign_{index % len(SIGNS)}.png", lambda: pictures.panel(text, paper, ink, 64 * len(text), 64, False), 0.5
    )
    middle, half = (left + right) / 2, min(0.27 * len(text), (right - left) / 2)
    street.add(
        "metal", box((middle - half - 0.05, 2.97, 0), (middle + half + 0.05, 3.55, 0.16)), axes=axes, origin=origin
    )
    street.shine("sign", sign, front(middle - half, middle + half, 3.02, 3.5, 0.165), axes, origin)
    for x in (middle, sum(door) / 2):
        spot(street, np.array([x, 3.85, 0.5]), axes, origin)
    lamp = np.array([left - 0.25 if door_left else right + 0.25, 2.2, 0.16])
    street.add("metal", box(lamp + [-0.04, 0.1, -0.16], lamp + [0.04, 0.13, 0.04]), axes=axes, origin=origin)
    street.shine("walllamp", [110, 72, 34], moved(ball(0.045, 8, 6, 1.4), lamp), axes, origin)
    if index % 3 != 1:
        awning(street, left - 0.2, right + 0.2, 2.95, index % 4, axes, origin)
    elif random.uniform() < 0.8:
        count = int((right - left) / 0.62)
        for i in range(count):
            hang(street, np.array([left + (i + 0.5) * (right - left) / count, 2.6, 0.45]), 0.15, index, axes, origin)
    return [hole, entry]


def spot(street, at, axes, origin):
    """A small spotlight on an arm, which shines downwards."""
    street.add("metal", tube([at * [1, 1, 0], at + [0, 0.03, 0]], 0.012, 6, (1, 0, 0)), axes=axes, origin=origin)
    street.add("metal", moved(turned([(0.05, -0.016), (0.05, 0.1), (0.001, 0.12)], 12), at), axes=axes, origin=origin)
    bulb = turned([(0.001, -0.002), (0.04, 0.0)], 12)
    street.shine("spot", [240, 190, 135], moved(bulb, at), axes, origin)


def hang(street, at, radius, kind, axes, origin):
    """A paper lantern on a string."""
    colors = [(1.0, 0.13, 0.04), (1.0, 0.34, 0.07), (1.0, 0.6, 0.26)]
    name = f"lantern_{kind % 3}.png"
    emission = street.image(name, lambda: pictures.lantern(kind % 3, colors[kind % 3]), 1.5)
    angle = np.linspace(-1.25, 1.25, 15)
    ribbed = radius * np.cos(angle) ** 0.8 * (1 + 0.02 * (np.arange(15) % 2))
    profile = np.stack([ribbed, 1.15 * radius * np.sin(angle) / math.sin(1.25)], axis=1)
    profile = np.vstack([[[1e-3, profile[0, 1]]], profile, [[1e-3, profile[-1, 1]]]])
    street.shine("lantern", emission, moved(turned(profile, 12), at), axes, origin)
    top = at + [0, 1.15 * radius, 0]
    street.add("metal", tube([top, top + [0, 0.35, 0]], 0.006, 5), axes=axes, origin=origin)


def house(street, side, z, width, storeys, index, random):
    """A house whose facade begins at z and goes on away from the camera."""
    axes = SIDES[side]
    origin = np.array([side * FACADE, KERB, z if side < 0 else z - width])
    height = GROUND + storeys * STOREY + 0.5
    material = f"wall_{random.randint(6)}"
    texture = 1.6 if material in ("wall_0", "wall_1", "wall_2") else 3.0
    holes = upper_storeys(street, width, storeys, random, axes, origin, texture)
    holes += shop(street, width, index, random, axes, origin)
    street.add(material, pierced(width, height, holes, texture), axes=axes, origin=origin)
    body = box((0, -0.2, -9), (width, height - 0.01, -REVEAL - 0.01), texture)
    ends = [
        quad((0, 0, -REVEAL - 0.02), (0, 0, 0), (0, height, 0), (0, height, -REVEAL - 0.02)),
        quad((width, 0, 0), (width, 0, -REVEAL - 0.02), (width, height, -REVEAL - 0.02), (width, height, 0)),
    ]
    street.add(material, body, *ends, axes=axes, origin=origin)
    street.add(
        "stone",
        box((-0.04, height - 0.1, -0.4), (width + 0.04, height + 0.14, 0.28)),
        box((0, GROUND - 0.02, -0.05), (width, GROUND + 0.16, 0.13)),
        axes=axes,
        origin=origin,
    )
    if random.uniform() < 0.75:
        x = random.choice([0.14, width - 0.14])
        street.add("metal", tube([(x, 0, 0.09), (x, height, 0.09)], 0.045, 8), axes=axes, origin=origin)
