#!/usr/bin/env python3
"""Makes made/room.json and its sky: a room with lights of all kinds, most of which most of it does not see.

A sun and a sky shine through a window, small spheres shine in a lamp's shade, and outside stands a dim sphere 100 m
wide, which fills three tenths of the view from the window. It has far more power than the lamp, but hardly lights the
room. A sphere around the whole scene would hide the sun and the sky, which are infinitely far away.
"""

import json
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
MADE = HERE / "made"
sys.path.insert(0, str(HERE.parents[2] / "scenes"))

import radiance_picture  # noqa: E402 (needs the path)

X, Y, Z = 5.0, 2.8, 4.0  # Of the room [m]; its window is in the wall at x = 0.
WINDOW = (0.9, 2.3, 1.0, 3.0)  # Lower and upper end, and the ends along z [m].
WALL = 0.25  # How thick the wall around the window is [m].
SUN = (-0.709, 0.5, 0.497)  # Where it is.
LAMP = (3.9, 1.13, 0.6)  # The middle of its bulbs [m].


def quad(*vertices, **surface):
    return {"type": "quad", "vertices": vertices, **surface}


def box(x, y, z, width, height, depth, material):
    """A box that stands on (x, y, z)."""
    low = (x - width / 2, y, z - depth / 2)
    return {"type": "box", "min": low, "max": (x + width / 2, y + height, z + depth / 2), "material": material}


def sphere(center, radius, **surface):
    return {"type": "sphere", "center": center, "radius": radius, **surface}


def walls():
    """Floor, ceiling and walls, with their fronts inside; that at x = 0 has the window."""
    yield quad((0, 0, Z), (X, 0, Z), (X, 0, 0), (0, 0, 0), material="floor")
    yield quad((0, Y, 0), (X, Y, 0), (X, Y, Z), (0, Y, Z), material="white")
    yield quad((0, 0, 0), (X, 0, 0), (X, Y, 0), (0, Y, 0), material="blue")
    yield quad((X, 0, Z), (0, 0, Z), (0, Y, Z), (X, Y, Z), material="white")
    yield quad((X, 0, 0), (X, 0, Z), (X, Y, Z), (X, Y, 0), material="white")
    low, high, left, right = WINDOW
    for y0, y1, z0, z1 in ((0, Y, 0, left), (0, Y, right, Z), (0, low, left, right), (high, Y, left, right)):
        yield {"type": "box", "min": (-WALL, y0, z0), "max": (0, y1, z1), "material": "white"}


def furniture():
    yield box(-WALL / 2, 0.9, 2, WALL * 0.3, 1.4, 0.06, "wood")  # The window's bar.
    yield box(3.7, 0.7, 0.65, 1.7, 0.05, 0.9, "wood")
    for x in (2.95, 4.45):
        for z in (0.3, 1.0):
            yield box(x, 0, z, 0.07, 0.7, 0.07, "wood")
    yield box(2.6, 0, 2.6, 0.5, 0.45, 0.5, "red")
    yield box(0.35, 0, 0.5, 0.5, 1.1, 0.8, "wood")
    yield sphere((0.35, 1.3, 0.5), 0.2, material="gold")
    yield sphere((3.25, 0.87, 0.75), 0.12, material="glazed")
    yield sphere((2.6, 0.65, 2.6), 0.2, material="glazed")
    yield sphere((1.5, 0.3, 1.2), 0.3, material="clay")
    for i, height in enumerate((0.3, 0.24, 0.34, 0.28)):
        yield box(3.0 + 0.09 * i, 0.75, 0.4, 0.06, height, 0.2, ("red", "clay", "blue", "white")[i])


def lamp():
    """Seven bulbs in a shade of paper, which is open above and below."""
    x, y, z = LAMP
    yield box(x, 0.75, z, 0.2, 0.03, 0.2, "wood")
    yield box(x, 0.78, z, 0.025, 0.3, 0.025, "wood")
    ring = [(math.cos(i * math.pi / 6), math.sin(i * math.pi / 6)) for i in range(12)]
    for (c, s), (d, t) in zip(ring, ring[1:] + ring[:1]):
        (a, b), low, high = (0.2, 0.13), y - 0.12, y + 0.14
        corners = [(a * c, low, -a * s), (a * d, low, -a * t), (b * d, high, -b * t), (b * c, high, -b * s)]
        yield quad(*((round(x + p, 5), h, round(z + q, 5)) for p, h, q in corners), material="paper")
    for i in range(7):
        at = (x, y + 0.06, z) if i == 6 else (x + 0.07 * ring[2 * i][0], y, z + 0.07 * ring[2 * i][1])
        yield sphere([round(c, 4) for c in at], 0.018, emission=[210, 130, 62])


def sky(width=64, height=32):
    """Rows of radiance, bluer above and brighter towards the sun's side."""
    for row in range(height):
        up = math.sin(math.pi * (0.5 - (row + 0.5) / height))
        colours = []
        for column in range(width):
            azimuth = 2 * math.pi * ((column + 0.5) / width - 0.5)
            towards = math.sqrt(1 - up * up) * (math.sin(azimuth) * SUN[0] - math.cos(azimuth) * SUN[2]) + up * SUN[1]
            glow = 1.6 * max(towards, 0) ** 6
            haze = math.exp(-3 * max(up, 0))
            colours.append([glow + c + haze * h for c, h in zip((0.5, 0.9, 1.9), (0.9, 0.8, 0.4))])
        yield colours


def main():
    MADE.mkdir(exist_ok=True)
    rows = [radiance_picture.encoded_row(row) for row in sky()]
    (MADE / "room-sky.hdr").write_bytes(radiance_picture.header("make_room.py", 64, 32) + b"".join(rows))
    colours = {
        "white": 0.75,
        "floor": [0.45, 0.33, 0.24],
        "blue": [0.3, 0.4, 0.5],
        "red": [0.55, 0.1, 0.08],
        "clay": [0.5, 0.3, 0.2],
        "wood": [0.35, 0.2, 0.1],
    }
    materials = {name: {"type": "diffuse", "reflectance": colour} for name, colour in colours.items()}
    materials["paper"] = {"type": "diffuse_transmission", "reflectance": 0.4, "transmittance": 0.4}
    materials["gold"] = {"type": "conductor", "reflectance": [0.9, 0.7, 0.3], "alpha": 0.2}
    materials["glazed"] = {"type": "principled", "base_color": [0.1, 0.35, 0.4], "roughness": 0.3}
    scene = {
        "cameras": {"main": {"position": [4.75, 1.6, 3.7], "look_at": [1.6, 1.0, 1.2], "vertical_fov": 62}},
        "film": {"size": [512, 512]},
        "integrator": {"max_depth": 6},
        "materials": materials,
        "shapes": [*walls(), *furniture(), *lamp(), sphere((-65, 0, -25), 50, emission=[0.10, 0.08, 0.06])],
        "lights": [{"type": "directional", "direction": [-c for c in SUN], "irradiance": [24, 21, 16]}],
        "environment": {"file": "room-sky.hdr"},
    }
    (MADE / "room.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


main()
