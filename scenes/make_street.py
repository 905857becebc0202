#!/usr/bin/env python3
"""Makes a wet street at night: `python3 make_street.py FOLDER` writes street.json, its meshes and its images there.

114 000 triangles of 586 objects shine: neon, bulbs and lamps in one colour; windows, shops, paper lanterns, signs,
screens and towers by images. Small, bright ones give most of the light in the street. Most are hidden from any one
place, or too far away to matter; towers behind the houses have 99.8 % of the power. The same seeds make the same
street. Needs NumPy (Debian: python3-numpy).
"""

import argparse
import json
import math
from pathlib import Path

import numpy as np

import radiance_picture
import street_pictures as pictures
import textures
from street_cars import car
from street_houses import hang, house
from street_meshes import ball, box, front, joined, moved, placed, quad, sheet, tube, turned
from street_signs import blades
from street_parts import BACK, FACADE, FAR, KERB, NEAR, ROAD, SIDES, WORLD, Street

# Strings of bulbs: z at the left, how much farther the right end is, height [m]; strings of lanterns: z, colour.
BULBS = [(3.4, 1.0, 4.6), (-3.5, -1.5, 5.0), (-11.2, 1.4, 4.9), (-15.6, -1.0, 5.1), (-25.5, 1.5, 5.0)]
BULBS += [(-31.5, -1.5, 5.1), (-43.0, 1.0, 5.0), (-49.0, -1.0, 5.2)]
LANTERNS = [(-6.8, 0), (-20.5, 1), (-36.0, 2)]
# Cars: x, z, whether they go away from the camera, paint.
CARS = [
    (2.45, 0.9, True, "paint_red"),
    (2.5, -6.2, True, "paint_blue"),
    (-1.7, -15.0, False, "paint_taxi"),
    (1.7, -27.0, True, "paint_white"),
    (-1.7, -40.0, False, "paint_blue"),
]
# Screens: x, y, width, height, z; towers: x, z, width, height.
SCREENS = [(-3.6, 5.2, 7.2, 4.8, FAR), (FACADE, 7.6, 4.2, 2.8, -12.2), (-FACADE, 8.4, 3.6, 2.4, -22.0)]
TOWERS = [(-15, -82, 13, 47), (5, -95, 15, 62), (24, -86, 14, 40), (-32, -70, 14, 38)]
POST = [(0, 0), (0, 4.8), (0.08, 5.15), (0.3, 5.38), (0.7, 5.42), (1.0, 5.35)]  # Of a lamp.
BOLLARD = [(0.055, 0), (0.055, 0.8), (0.075, 0.82), (0.075, 0.9), (0.04, 0.95), (0.001, 0.96)]
POT = [(0.14, 0), (0.2, 0.36), (0.22, 0.36), (0.22, 0.41), (0.18, 0.41), (0.17, 0.36), (0.001, 0.36)]
WALLS = [
    ("bricks_0", (0.50, 0.22, 0.15)),
    ("bricks_1", (0.55, 0.42, 0.32)),
    ("bricks_0", (0.30, 0.28, 0.30)),
    ("plaster_0", (0.60, 0.52, 0.40)),
    ("plaster_1", (0.42, 0.44, 0.50)),
    ("plaster_1", (0.58, 0.36, 0.27)),
]
CLOTHS = [(0.5, 0.03, 0.03), (0.03, 0.2, 0.09), (0.04, 0.08, 0.35), (0.5, 0.24, 0.03)]
# Everything of one colour, and its roughness.
PLAIN = {
    "stone": (0.35, 0.7),
    "frames": ([0.10, 0.07, 0.05], 0.7),
    "panes": (0.012, 0.35),
    "board": ([0.02, 0.022, 0.03], 0.7),
    "metal": (0.035, 0.7),
    "enamel": (0.7, 0.7),
    "tyres": (0.02, 0.7),
    "paint_red": ([0.45, 0.02, 0.02], 0.35),
    "paint_blue": ([0.02, 0.06, 0.22], 0.35),
    "paint_white": (0.65, 0.35),
    "paint_taxi": ([0.8, 0.42, 0.03], 0.35),
    "pots": ([0.4, 0.16, 0.08], 0.7),
    "towers": ([0.06, 0.065, 0.08], 0.7),
}


def cable(a, b, sag, count):
    t = np.linspace(0, 1, count)[:, None]
    return np.add(a, t * np.subtract(b, a)) - sag * 4 * t * (1 - t) * [0, 1, 0]


def hung(street, path, radius):
    """A cable along a path across the street."""
    across = np.cross(path[-1] - path[0], (0, 1, 0))
    street.add("metal", tube(path, radius, 5, across / np.linalg.norm(across)))


def overhead(street, random):
    """Strings of bulbs and lanterns across the street, and wires."""
    bulbs = []
    for z, slant, y in BULBS:
        path = cable((-FACADE, y, z), (FACADE, y + random.uniform(-0.4, 0.4), z + slant), 0.75, 49)
        hung(street, path, 0.009)
        for at in path[2:-1:3]:
            street.add("metal", tube([at - [0, 0.05, 0], at], 0.014, 6))
            bulbs.append(at)
    street.shine_at(bulbs, "bulb", [110, 59, 22], moved(ball(0.03, 8, 6, 1.2), (0, -0.075, 0)))
    for z, kind in LANTERNS:
        path = cable((-FACADE, 5.5, z), (FACADE, 5.4, z), 0.6, 21)
        hung(street, path, 0.008)
        for i, at in enumerate(path[2:-1:2]):
            hang(street, at - [0, 0.55, 0], 0.21, kind + i % 2, WORLD, np.zeros(3))
    for _ in range(14):
        z, y = random.uniform(FAR + 15, 4), random.uniform(6.5, 10)
        end = (FACADE, y + random.uniform(-1, 1), z + random.uniform(-5, 5))
        hung(street, cable((-FACADE, y, z), end, random.uniform(0.2, 0.6), 17), 0.011)


def street_lamps(street):
    """Posts with a bright light deep in a shade, so that few places see it from aside, on both sides in turns."""
    for i, z in enumerate(np.arange(7.0, FAR, -9.5)):
        side = -1 if i % 2 else 1
        x = side * (ROAD + 0.4)
        arm = np.array([(x - side * a, KERB + b, z) for a, b in POST])
        for _ in range(2):  # Rounded.
            inner = np.stack([0.75 * arm[:-1] + 0.25 * arm[1:], 0.25 * arm[:-1] + 0.75 * arm[1:]], axis=1)
            arm = np.vstack([arm[:1], inner.reshape(-1, 3), arm[-1:]])
        street.add("metal", tube(arm, 0.05, 10), moved(turned([(0.13, 0), (0.13, 0.5), (0.06, 0.8)], 12), (x, KERB, z)))
        head = np.array([x - side * 1.0, KERB + 5.18, z])
        shade = [(0.34, 0), (0.30, 0.07), (0.16, 0.17), (0.05, 0.2), (0.001, 0.24)]
        street.add("metal", moved(turned(shade, 24), head))
        inside = [(0.001, 0.1), (0.16, 0.09), (0.29, 0.065), (0.33, 0.001)]
        street.shine("reflector", [5, 3.8, 2.3], moved(turned(inside, 24), head))
        led = [(0.001, 0.06), (0.03, 0.065), (0.04, 0.08)]
        street.shine("lamp", [4400, 3300, 2000], moved(turned(led, 16), head))


def along_road(v):
    """Where the row v of the road is: rows are narrower near the camera [m]."""
    d = 8.0
    return NEAR + d - d * np.exp(v * math.log(1 + (NEAR - FAR) / d))


def road(street):
    """Asphalt with ruts that hold water, and paint on it."""
    u, v = np.meshgrid(np.linspace(0, 1, 73), np.linspace(0, 1, 500))
    x, z = ROAD * (2 * u - 1), along_road(v)
    wet = puddles(x, z)
    rough = pictures.noise_at(6 * x, 6 * z, 31, 2) - 0.5 + 0.8 * (pictures.noise_at(1.7 * x, 1.7 * z, 32, 2) - 0.5)
    height = 0.008 * rough * (1 - wet)
    street.add("road", sheet(np.stack([x, height, z], axis=-1), np.stack([u, v], axis=-1)))

    u, v = textures.grid(768, 1536)
    x, z = ROAD * (2 * u - 1), along_road(v)
    wet = puddles(x, z)
    grain = pictures.noise_at(30 * x, 30 * z, 33, 2)
    cloud = pictures.noise_at(0.8 * x, 0.8 * z, 34)
    textures.write_png(street.folder / "road_roughness.png", 0.75 - 0.43 * wet)
    tint = (0.17 + 0.12 * cloud + 0.12 * (grain - 0.5))[..., None] * np.array([1.0, 0.98, 0.97])
    worn = 0.35 + 0.65 * textures.smoothstep(0.38, 0.55, pictures.noise_at(5 * x, 5 * z, 35))
    dashes = (np.abs(x) < 0.07) & (z % 6 < 2.6) & ((z < -1.2) | (z > 6.0))
    bars = (z > 0.4) & (z < 3.4) & (np.abs(x) < 3.2) & ((x + 3.2) % 0.9 < 0.46)
    edge = np.abs(np.abs(x) - 3.2) < 0.05
    tint += ((dashes | bars | edge) * worn)[..., None] * (np.array([0.72, 0.7, 0.66]) - tint)
    textures.write_png(street.folder / "road.png", tint * (1 - 0.45 * wet[..., None]))


def puddles(x, z):
    """1 where water stands."""
    rut = np.exp(-(((np.abs(x) - 1.75) / 0.7) ** 2)) + 1.3 * np.exp(-(((np.abs(x) - 3.4) / 0.35) ** 2))
    return textures.smoothstep(0.61, 0.69, pictures.noise_at(0.75 * x, 0.45 * z, 36, 5) + 0.13 * rut)


def pavements(street):
    for side in (-1, 1):
        low, high = sorted((side * (ROAD + 0.16), side * (FACADE + 0.3)))
        kerb = sorted((side * ROAD, side * (ROAD + 0.16)))
        for z in np.arange(FAR, NEAR, 4.0):
            top = [(low, KERB, z + 4), (high, KERB, z + 4), (high, KERB, z), (low, KERB, z)]
            street.add("slabs", quad(*top, size=((high - low) / 2, 2)))
            street.add("stone", box((kerb[0], -0.1, z + 0.004), (kerb[1], KERB + 0.003, z + 3.996)))
        for z in np.arange(9, FAR, -4.1):
            if abs(z - 2) > 2.5:
                street.add("metal", moved(turned(BOLLARD, 16), (side * (ROAD + 0.32), KERB, z)))


def plants(street, random):
    """Pots with round shrubs before the shops."""
    for _ in range(26):
        side, z = random.choice([-1, 1]), random.uniform(-45, 6)
        at = np.array([side * (FACADE - 0.45), KERB, z])
        street.add("pots", moved(turned(POT, 20), at))
        count, spread = 260, random.uniform(0.24, 0.34)
        centre = at + [0, 0.45 + spread, 0]
        out = random.normal(size=(count, 3))
        out /= np.linalg.norm(out, axis=1, keepdims=True)
        leaf = centre + out * spread * random.uniform(0.55, 1.05, (count, 1))
        aside = np.cross(out, random.normal(size=(count, 3)))
        aside *= 0.055 / np.linalg.norm(aside, axis=1, keepdims=True)
        up = 0.07 * out + 0.06 * random.normal(size=(count, 3))
        street.add("leaves", joined([quad(p - a, p - 0.5 * b, p + a, p + b) for p, a, b in zip(leaf, aside, up)]))


def tower(street, seed):
    return street.image(f"tower_{seed}.png", lambda: pictures.tower(seed), 0.55)


def ends(street):
    """The house across the far end, screens, and towers behind the houses."""
    street.add("wall_4", box((-16, -0.1, FAR - 10), (16, 15, FAR), 3.0))
    corner = [(-16, 0.01, FAR + 3), (16, 0.01, FAR + 3), (16, 0.01, FAR), (-16, 0.01, FAR)]
    street.add("slabs", quad(*corner, size=(16, 1.5)))
    for i, (x, y, width, height, z) in enumerate(SCREENS):
        emission = street.image(f"screen_{i}.png", lambda seed=i: pictures.screen(seed), 0.9)
        axes = WORLD if i == 0 else SIDES[1 if x > 0 else -1]
        origin = (x, y, z + 0.25) if i == 0 else (x - math.copysign(0.25, x), y, z)
        street.add("metal", box((-0.1, -0.1, -0.25), (width + 0.1, height + 0.1, -0.01)), axes=axes, origin=origin)
        street.shine("screen", emission, front(0, width, 0, height, 0), axes, origin)
    for i, (x, z, width, height) in enumerate(TOWERS):
        street.add("towers", box((x, 0, z - 12), (x + width, height, z)))
        street.shine("tower", tower(street, i), front(x + 0.5, x + width - 0.5, 2, height - 1, z + 0.05))


def city(street, random):
    """Blocks of towers on both sides, with lit windows all around. They have most of the power, but the houses hide
    them."""
    side = front(-21, 21, 2, 139, 22.05)
    around = joined([placed(side, axes, (0, 0, 0)) for axes in (WORLD, BACK, *SIDES.values())])
    for i, (x, z) in enumerate((x, z) for x in (-1700, -1200, -700, 700, 1200, 1700) for z in (-100, -400, -700)):
        lit = []
        for dx, dz in ((dx, dz) for dx in range(-160, 161, 80) for dz in range(-120, 121, 60)):
            at = (x + dx, random.uniform(-60, 0), z + dz)
            street.add("towers", box((-22, 0, -22), (22, 140, 22)), origin=at)
            lit.append(moved(around, at))
        street.shine("city", tower(street, i % len(TOWERS)), joined(lit))


def sky(width=256, height=128):
    """Rows of radiance [W/(m^2 sr)]: clouds in the light of the city, darker above."""
    u, v = textures.grid(width, height)
    up = np.clip(2 * v - 1, 0, 1)[..., None]
    clouds = textures.fractal_noise(u, v, (8, 10), 50, 5)[..., None]
    air = np.array([0.010, 0.014, 0.034]) + np.array([0.050, 0.030, 0.034]) * np.exp(-up / 0.16)
    return air * (0.45 + 1.1 * clouds)


def materials(street):
    for i in range(2):
        textures.write_png(street.folder / f"bricks_{i}.png", pictures.bricks(i))
        textures.write_png(street.folder / f"plaster_{i}.png", pictures.plaster(i))
    textures.write_png(street.folder / "slabs.png", pictures.slabs(0))
    made = {}

    def plastic(name, color, roughness):
        made[name] = {"type": "principled", "base_color": color, "roughness": roughness}

    for name, (color, roughness) in PLAIN.items():
        plastic(name, color, roughness)
    for i, (image, tint) in enumerate(WALLS):
        plastic(f"wall_{i}", {"image": f"{image}.png", "factor": list(tint)}, 0.8)
    plastic("slabs", {"image": "slabs.png", "factor": [0.32, 0.31, 0.30]}, 0.7)
    plastic("road", {"image": "road.png"}, {"image": "road_roughness.png"})
    made["road"]["ior"] = 1.33
    u, _ = textures.grid(64, 8)
    stripes = textures.smoothstep(0.24, 0.26, np.abs(u - 0.5))[..., None]
    for i, dark in enumerate(CLOTHS):
        cloth = textures.mix(np.array([0.75, 0.7, 0.6]), dark, stripes)
        textures.write_png(street.folder / f"awning_{i}.png", pictures.srgb(cloth))
        sheet_of = {"reflectance": 0.6, "transmittance": 0.3}
        made[f"awning_{i}"] = {"type": "diffuse_transmission"}
        made[f"awning_{i}"] |= {key: {"image": f"awning_{i}.png", "factor": f} for key, f in sheet_of.items()}
    leaf = {"reflectance": [0.08, 0.2, 0.05], "transmittance": [0.06, 0.15, 0.02]}
    made["leaves"] = {"type": "diffuse_transmission"} | leaf
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    street, random = Street(options.folder), np.random.RandomState(3)

    index = 0
    for side in (-1, 1):
        z = NEAR
        while z > FAR + 5:
            width = min(random.uniform(6.0, 9.0), z - FAR)
            house(street, side, z, width, random.randint(3, 6), index, random)
            z, index = z - width, index + 1
    blades(street)
    overhead(street, random)
    street_lamps(street)
    for place in CARS:
        car(street, *place)
    road(street)
    pavements(street)
    plants(street, random)
    ends(street)
    city(street, random)

    rows = [radiance_picture.encoded_row(row.tolist()) for row in sky()]
    (options.folder / "sky.hdr").write_bytes(radiance_picture.header("make_street.py", 256, 128) + b"".join(rows))
    scene = {
        "cameras": {"main": {"position": [-0.9, 1.55, 9.6], "look_at": [0.1, 2.95, -10], "vertical_fov": 50}},
        "film": {"size": [960, 540]},
        "integrator": {"max_depth": 6},
        "materials": materials(street),
        "shapes": street.shapes(),
        "environment": {"file": "sky.hdr"},
    }
    (options.folder / "street.json").write_text(json.dumps(scene))


if __name__ == "__main__":
    main()
