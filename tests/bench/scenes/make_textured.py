"""Makes made/textured.json with its meshes and images: `python3 make_textured.py` with NumPy, which Blender's Python
has, too: `blender -b --factory-startup -P make_textured.py`.

A loggia that is open to the sky on two sides: planks, bricks, cloth, pottery, metals, and a plant whose leaves are cut
out of cards by the alpha of their images. Seeds are fixed: the scene is always the same.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import textured_images as images  # noqa: E402 (needs the path)

MADE = Path(__file__).resolve().parent / "made"
FOLDER = MADE / "textured"
EARTH = ((60, 40, 30), (150, 90, 60), (205, 150, 110))
# Name: pattern, seed, texels along each side, depth of the normal map, palette.
DIFFUSE = {
    "floor": (images.planks, 1, 2048, 0.006, ((30, 18, 10), (120, 76, 42), (190, 140, 90))),
    "bricks": (images.bricks, 2, 2048, 0.008, ((150, 145, 135), (120, 50, 35), (190, 105, 75))),
    "plaster": (images.plaster, 3, 2048, 0.001, ((150, 135, 110), (215, 205, 185), (240, 235, 225))),
    "ceiling": (lambda n, seed: images.planks(n, seed, 12, 1), 4, 1024, 0.004, ((130, 120, 105), (235, 228, 215))),
    "rug": (images.weave, 5, 1024, 0.004, ((70, 15, 20), (160, 45, 40), (220, 190, 140))),
    "curtain": (
        lambda n, seed: images.weave(n, seed, 64, 4), 6, 1024, 0.003, ((25, 45, 75), (80, 120, 160), (220, 225, 230))
    ),
    "legs": (lambda n, seed: images.planks(n, seed, 3, 1), 7, 1024, 0.004, ((40, 22, 12), (105, 62, 35))),
    "pot": (images.bricks, 8, 1024, 0.006, EARTH),
    "vase": (images.stripes, 9, 1024, 0.004, ((20, 40, 110), (60, 90, 170), (235, 235, 225))),
    "jar": (images.mosaic, 10, 1024, 0.004, ((50, 45, 40), (30, 110, 100), (220, 180, 70), (190, 70, 50))),
    "urn": (images.spots, 11, 1024, 0.004, ((200, 190, 170), (110, 60, 35), (60, 30, 20))),
    "cup": (images.hammered, 12, 1024, 0.006, ((60, 110, 90), (150, 190, 160), (225, 235, 215))),
}
# The same with the range of the roughness.
METALS = {
    "brass": (images.hammered, 20, 1024, 0.012, ((190, 150, 70), (235, 205, 120)), (0.12, 0.35)),
    "copper": (images.brushed, 21, 1024, 0.0006, ((180, 95, 70), (235, 160, 130)), (0.1, 0.4)),
    "steel": (images.plaster, 22, 1024, 0.0008, ((130, 130, 135), (205, 205, 210)), (0.15, 0.5)),
    "gold": (images.stripes, 23, 1024, 0.003, ((160, 110, 50), (250, 210, 120)), (0.15, 0.45)),
}
# Colours alone.
PLAIN = {
    "marble": (images.marble, 30, 2048, ((90, 90, 95), (205, 200, 195), (245, 243, 238))),
    "book-a": (images.weave, 31, 1024, ((40, 70, 45), (110, 140, 90))),
    "book-b": (images.marble, 32, 1024, ((30, 30, 60), (130, 60, 60), (200, 160, 120))),
    "painting": (images.marble, 33, 1024, ((240, 200, 90), (200, 80, 60), (40, 60, 110), (30, 130, 130))),
}
# Seed, whether there are lobes, palette.
LEAVES = {
    "broad": (40, 1, ((20, 60, 20), (60, 120, 40), (160, 190, 90))),
    "slim": (41, 0, ((50, 70, 20), (110, 140, 40), (190, 200, 110))),
}


# --- Materials -------------------------------------------------------------------------------------------------------


def image_file(name, image):
    images.write_png(FOLDER / f"{name}.png", image)
    return {"image": f"textured/{name}.png"}


def diffuse(name, pattern, seed, n, depth, palette):
    height, tint = pattern(n, seed)
    return {
        "type": "diffuse",
        "reflectance": image_file(name, images.colors(tint, palette)),
        "normal_map": image_file(f"{name}-normal", images.normals(height, depth)),
    }


def metal(name, pattern, seed, n, depth, palette, roughness):
    height, tint = pattern(n, seed)
    return {
        "type": "conductor",
        "reflectance": image_file(name, images.colors(tint, palette)),
        "alpha": image_file(f"{name}-alpha", images.numbers(1 - tint, *roughness)),
        "normal_map": image_file(f"{name}-normal", images.normals(height, depth)),
    }


def plain(name, pattern, seed, n, palette):
    return {"type": "diffuse", "reflectance": image_file(name, images.colors(pattern(n, seed)[1], palette))}


def leaf(name, seed, lobes, palette, n=1024):
    height, tint, opacity = images.leaf(n, seed, lobes)
    color = image_file(name, np.dstack([images.colors(tint, palette), images.codes(opacity)]))
    return {
        "type": "diffuse_transmission",
        "reflectance": color | {"factor": 0.6},
        "transmittance": color | {"factor": 0.35},
        "normal_map": image_file(f"{name}-normal", images.normals(height, 0.006)),
        "opacity": color | {"cutoff": 0.5},
    }


def materials():
    return {
        **{name: diffuse(name, *what) for name, what in DIFFUSE.items()},
        **{name: metal(name, *what) for name, what in METALS.items()},
        **{name: plain(name, *what) for name, what in PLAIN.items()},
        **{name: leaf(name, *what) for name, what in LEAVES.items()},
        "soil": {"type": "diffuse", "reflectance": [0.08, 0.05, 0.035]},
    }


# --- Shapes ----------------------------------------------------------------------------------------------------------


def write_ply(path, positions, normals, uvs, triangles):
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    faces = np.zeros(len(triangles), [("corners", "u1"), ("indices", "<i4", 3)])
    faces["corners"], faces["indices"] = 3, triangles
    vertices = np.hstack([positions, normals, uvs]).astype("<f4")
    path.write_bytes("\n".join(header).encode() + b"\n" + vertices.tobytes() + faces.tobytes())


def sheet(point, columns, rows, repeat=(1, 1)):
    """Positions, normals, texture coordinates and triangles of point(u, v), an array of x, y, z, over the unit square;
    its front is where u and v run counter-clockwise."""
    v, u = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, columns + 1), indexing="ij"))
    h = 1e-4
    along = point(u + h, v) - point(u - h, v)
    across = point(u, v + h) - point(u, v - h)
    normal = np.cross(along, across, axis=0)
    normal /= np.maximum(np.linalg.norm(normal, axis=0), 1e-30)
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    a, b, c, d = corner, corner + 1, corner + columns + 2, corner + columns + 1
    triangles = np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)
    return point(u, v).T, normal.T, np.stack([u * repeat[0], v * repeat[1]], -1), triangles


def flat(origin, u_end, v_end, density=0.5):
    """A rectangle as a sheet of two triangles; the images repeat `density` times a metre."""
    o, p, q = (np.array(x, float)[:, None] for x in (origin, u_end, v_end))
    repeat = [np.linalg.norm(end - o) * density for end in (p, q)]
    return sheet(lambda u, v: o + u * (p - o) + v * (q - o), 1, 1, repeat)


def box(low, high, density):
    (a, b, c), (x, y, z) = low, high
    sides = [((a, b, z), (x, b, z), (a, y, z)), ((x, b, c), (a, b, c), (x, y, c)), ((x, b, z), (x, b, c), (x, y, z))]
    sides += [((a, b, c), (a, b, z), (a, y, c)), ((a, y, z), (x, y, z), (a, y, c)), ((a, b, c), (x, b, c), (a, b, z))]
    return joined([flat(*side, density) for side in sides])


def joined(meshes):
    first = np.cumsum([0] + [len(m[0]) for m in meshes])
    parts = [np.concatenate([m[i] for m in meshes]) for i in range(3)]
    return (*parts, np.concatenate([m[3] + offset for m, offset in zip(meshes, first)]))


def turned(base, heights, radii, columns, rows, repeat, ridges=0, depth=0.0):
    """A vessel: its radius between those given at heights, with ridges all around that are `depth` deep."""
    x, y, z = base
    fit = np.polynomial.Polynomial.fit(heights, radii, len(heights) - 1)

    def point(u, v):
        level = heights[0] + (heights[-1] - heights[0]) * v
        angle = -2 * np.pi * u
        radius = fit(level) + depth * np.cos(ridges * angle + 6 * v) * np.sin(np.pi * v) ** 2
        return np.stack([x + radius * np.cos(angle), y + level, z + radius * np.sin(angle)])

    return sheet(point, columns, rows, repeat)


def ring(center, radius, tube, columns, rows, repeat):
    """A wavy torus that stands on the floor."""
    x, y, z = center

    def point(u, v):
        a, b = 2 * np.pi * u, -2 * np.pi * v
        r = tube * (1 + 0.15 * np.sin(5 * a + 2 * b))
        far = radius + r * np.cos(b)
        return np.stack([x + far * np.cos(a), y + far * np.sin(a), z + r * np.sin(b)])

    return sheet(point, columns, rows, repeat)


def cards(base, count, length, width, seed):
    """Leaves on cards that rise from `base` in all directions and bend down."""
    chance = np.random.default_rng(seed)
    meshes = []
    for i in range(count):
        turn = 2.4 * i + chance.uniform(-0.2, 0.2)  # The golden angle, nearly.
        rise, size = chance.uniform(0.3, 1.3), chance.uniform(0.7, 1.0)
        stem = chance.uniform(0.0, 0.6)
        out, side = np.array([np.cos(turn), 0, np.sin(turn)]), np.array([-np.sin(turn), 0, np.cos(turn)])
        start = np.array(base) + np.array([0, stem, 0]) + 0.12 * stem * out

        def point(u, v, out=out, side=side, rise=rise, size=size, start=start):
            far = length * size * v
            up = np.sin(rise) * far - 1.1 * far * far / length
            fold = 0.25 * width * size * np.abs(u - 0.5)
            sideways = np.outer(side, (0.5 - u) * width * size)
            return start[:, None] + np.outer(out, np.cos(rise) * far) + sideways + np.outer((0, 1, 0), up + fold)

        meshes.append(sheet(point, 4, 8))
    return joined(meshes)


def cloth(x, z, width, height, waves, depth):
    """A curtain before the wall at x."""

    def point(u, v):
        fold = depth * np.sin(2 * np.pi * waves * u + np.sin(3 * v)) * (1 - 0.6 * v)
        return np.stack([x + fold, 0.03 + height * v, z - width * u])

    return sheet(point, 200, 60, (2 * width, height))


def rug(x, z, width, length):
    def point(u, v):
        return np.stack([x + width * u, 0.012 + 0.006 * np.sin(17 * u + 5 * np.sin(4 * v)), z - length * v])

    return sheet(point, 80, 80, (2 * width, 2 * length))


def meshes():
    """By material."""
    table = [((x - 0.04, 0, z - 0.04), (x + 0.04, 0.7, z + 0.04)) for x in (-0.1, 1.4) for z in (-1.5, -0.8)]
    books = [((0.98, 0.76, -1.25), (1.28, 0.81, -0.85)), ((-0.12, 0.76, -1.5), (0.1, 0.8, -1.2))]
    vase = (0, 0.12, 0.3, 0.42, 0.5), (0.07, 0.15, 0.09, 0.05, 0.09)
    return {
        "floor": flat((-2, 0, 2.5), (3, 0, 2.5), (-2, 0, -2)),
        "bricks": flat((-2, 0, 2.5), (-2, 0, -2), (-2, 2.6, 2.5), 0.7),
        "plaster": flat((-2, 0, -2), (3, 0, -2), (-2, 2.6, -2)),
        "ceiling": flat((-2, 2.6, -2), (3, 2.6, -2), (-2, 2.6, 2.5), 1.0),
        "rug": rug(-0.9, 1.2, 2.2, 1.6),
        "curtain": cloth(-1.85, 0.2, 1.6, 2.4, 7, 0.07),
        "legs": joined([box(*leg, 2.0) for leg in table]),
        "marble": box((-0.2, 0.7, -1.6), (1.5, 0.76, -0.7), 0.8),
        "book-a": joined([box(*book, 2.5) for book in books]),
        "book-b": box((1.0, 0.81, -1.22), (1.26, 0.85, -0.88), 2.5),
        "painting": flat((-0.4, 1.3, -1.98), (1.0, 1.3, -1.98), (-0.4, 2.1, -1.98), 0.9),
        "pot": turned((-1.2, 0, -1.2), (0, 0.2, 0.42), (0.17, 0.25, 0.27), 128, 60, (4, 1.4)),
        "soil": turned((-1.2, 0.38, -1.2), (0, 0.004), (0.26, 0.001), 32, 1, (1, 1)),
        "vase": turned((0.25, 0.76, -1.2), *vase, 128, 90, (2, 2), 8, 0.006),
        "jar": turned((1.9, 0, -0.9), (0, 0.25, 0.6, 0.75), (0.14, 0.27, 0.2, 0.14), 128, 90, (2, 1)),
        "urn": turned((-0.75, 0, -0.4), (0, 0.12, 0.3, 0.36), (0.08, 0.16, 0.1, 0.11), 128, 90, (3, 1), 12, 0.006),
        "cup": turned((0.05, 0.76, -0.9), (0, 0.08, 0.13), (0.04, 0.065, 0.07), 96, 40, (2, 1)),
        "brass": turned((0.72, 0.76, -1.05), (0, 0.06, 0.14), (0.06, 0.16, 0.2), 160, 60, (3, 1)),
        "copper": turned((2.1, 0, -0.1), (0, 0.15, 0.33, 0.46), (0.08, 0.2, 0.12, 0.16), 128, 90, (2, 1)),
        "steel": ring((0.65, 0.45, -0.1), 0.3, 0.1, 192, 96, (6, 2)),
        "gold": turned((1.28, 0.76, -1.4), (0, 0.15, 0.3, 0.38), (0.05, 0.1, 0.06, 0.075), 128, 80, (1, 1), 6, 0.008),
        "broad": cards((-1.2, 0.4, -1.2), 60, 0.75, 0.34, 50),
        "slim": cards((1.9, 0.55, -0.9), 90, 0.7, 0.09, 51),
    }


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    shapes = []
    for name, mesh in meshes().items():
        write_ply(FOLDER / f"{name}.ply", *mesh)
        shapes.append({"type": "ply", "file": f"textured/{name}.ply", "material": name})
    lamp = [[0.2, 2.55, -0.9], [0.9, 2.55, -0.9], [0.9, 2.55, -0.2], [0.2, 2.55, -0.2]]
    shapes.append({"type": "quad", "vertices": lamp, "emission": [20, 16, 12]})
    scene = {
        "cameras": {"main": {"position": [1.3, 1.45, 3.2], "look_at": [0.2, 0.85, -0.8], "vertical_fov": 46}},
        "film": {"size": [512, 512]},
        "integrator": {"max_depth": 5},
        "environment": {"file": "../../../../scenes/sky.hdr", "rotation": 300, "intensity": 0.5},
        "materials": materials(),
        "shapes": shapes,
    }
    (MADE / "textured.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


main()
