"""Makes made/principled.json with its mesh and images: `python3 make_principled.py` with NumPy, which Blender's Python
has, too: `blender -b --factory-startup -P make_principled.py`.

Forty balls on a floor, each of another principled material that Blender's Principled BSDF can express, too: plastics,
metals, glass, lacquers, cloth and mixtures, seven of them with images. Seeds are fixed: the scene is always the same.
"""

import json
import math
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import textured_images as images  # noqa: E402 (needs the path)

MADE = Path(__file__).resolve().parent / "made"
FOLDER = MADE / "principled"
COLUMNS, ROWS, DEPTH = 8, 5, 1.3  # Balls are 1 m apart from left to right, DEPTH from the back to the front.
RADIUS = 0.42
SEGMENTS, RINGS = 96, 48  # Of a ball.
TEXELS = 512  # Along each side of an image.


def ball(columns=SEGMENTS, rows=RINGS):
    """Vertices, each position, normal and texture coordinates, and triangles; u runs around +Y, the front is outside.
    Where u ends, points have a vertex for each end, and a pole has one for each triangle."""
    vertices, triangles = [], []
    for k in range(rows + 1):
        for i in range(columns + 1):
            # Exact where points meet: at the poles, and where u ends.
            u = (i + 0.5) / columns if k in (0, rows) else i / columns
            turn, rise = 2 * math.pi * (i % columns) / columns, math.pi * (k / rows - 0.5)
            y, r = (math.copysign(1, rise), 0) if k in (0, rows) else (math.sin(rise), math.cos(rise))
            n = (r * math.cos(turn), y, -r * math.sin(turn))
            vertices.append((*(RADIUS * c for c in n), *n, 4 * u, 2 * k / rows))
    for k in range(rows):
        for i in range(columns):
            a = k * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, c, d)] if k == 0 else [(a, b, d)] if k == rows - 1 else [(a, b, c), (a, c, d)]
    return vertices, triangles


def write_ply(path, vertices, triangles):
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v")]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    data = b"".join(struct.pack("<8f", *vertex) for vertex in vertices)
    data += b"".join(struct.pack("<B3i", 3, *triangle) for triangle in triangles)
    path.write_bytes("\n".join(header).encode() + b"\n" + data)


def image(name, texels):
    images.write_png(FOLDER / f"{name}.png", texels)
    return {"image": f"principled/{name}.png"}


def plastic(color, roughness, ior=1.5, **more):
    return {"base_color": color, "roughness": roughness, "ior": ior, **more}


def metal(color, roughness, **more):
    return {"base_color": color, "metalness": 1, "roughness": roughness, **more}


def glass(color, roughness, ior, **more):
    return {"base_color": color, "roughness": roughness, "ior": ior, "transmission": 1, "thin_walled": False, **more}


def pattern(name, make, seed, palette):
    """Images of colours and of numbers, both from the tint of a pattern."""
    tint = make(TEXELS, seed)[1]
    numbers = image(f"{name}-roughness", images.numbers(tint, 0.15, 0.6))
    return image(name, images.colors(tint, palette)), numbers


def materials():
    """The balls', from the back to the front, and from left to right."""
    planks, varnish = pattern("planks", images.planks, 1, ((60, 36, 20), (130, 86, 50), (190, 140, 90)))
    spots, worn = pattern("spots", images.spots, 2, ((200, 190, 170), (110, 60, 35)))
    marble, polish = pattern("marble", images.marble, 3, ((90, 90, 95), (205, 200, 195), (245, 243, 238)))
    brass, hammered = pattern("brass", images.hammered, 4, ((190, 150, 70), (235, 205, 120)))
    steel, brushed = pattern("steel", images.brushed, 5, ((150, 150, 155), (215, 215, 220)))
    weave, _ = pattern("weave", images.weave, 6, ((70, 15, 20), (160, 45, 40), (220, 190, 140)))
    return [
        # Plastics.
        plastic([0.8, 0.8, 0.8], 0.5),
        plastic([0.7, 0.1, 0.08], 0.2),
        plastic([0.1, 0.3, 0.7], 0.35, 1.4),
        plastic([0.05, 0.05, 0.05], 0.1, 1.6),
        plastic([0.15, 0.55, 0.2], 0.7),
        plastic([0.8, 0.6, 0.1], 0, 1.45),
        plastic([0.6, 0.25, 0.6], 0.9, 1.33),
        plastic([0.85, 0.8, 0.7], 0.05, 1.8),
        plastic(planks, varnish),
        plastic(spots, worn, 1.6),
        plastic(marble, 0.15),
        # Metals.
        metal([0.95, 0.93, 0.88], 0.05),
        metal([0.9, 0.7, 0.3], 0.3),
        metal([0.95, 0.64, 0.54], 0.2),
        metal([0.56, 0.57, 0.58], 0.6),
        metal([0.91, 0.92, 0.92], 0),
        metal([0.66, 0.61, 0.53], 0.45),
        metal(brass, hammered),
        metal(steel, brushed),
        metal([0.8, 0.8, 0.8], 0.3, anisotropy=0.5),
        metal([0.9, 0.75, 0.5], 0.35, anisotropy=0.4),
        metal([0.7, 0.75, 0.8], 0.25, anisotropy=0.3),
        # Glass.
        glass([1, 1, 1], 0, 1.5),
        glass([1, 1, 1], 0.2, 1.5),
        glass([0.9, 0.95, 1], 0.4, 1.33),
        glass([0.6, 0.9, 0.7], 0.1, 1.5),
        glass([0.95, 0.7, 0.4], 0, 1.6),
        glass([1, 1, 1], 0.6, 1.45),
        glass([0.8, 0.6, 0.9], 0.3, 1.8),
        # Lacquers: under a clear coat.
        plastic([0.5, 0, 0.02], 0.5, coat=1, coat_roughness=0.03),
        plastic([0.02, 0.1, 0.35], 0.6, coat=1, coat_roughness=0.1),
        metal([0.5, 0.05, 0.05], 0.4, coat=1, coat_roughness=0.05),
        metal([0.1, 0.4, 0.2], 0.35, coat=0.8, coat_roughness=0.2),
        plastic(marble, polish, coat=0.5, coat_roughness=0.1),
        {"base_color": [0.3, 0.35, 0.6], "metalness": 0.6, "roughness": 0.4, "coat": 1, "coat_roughness": 0.04},
        # Cloth, and mixtures.
        plastic(weave, 0.8, fuzz=0.4, fuzz_roughness=0.5),
        plastic([0.1, 0.05, 0.2], 1, fuzz=0.5, fuzz_roughness=0.4),
        {"base_color": [0.7, 0.5, 0.3], "metalness": 0.5, "roughness": 0.3},
        glass([0.9, 0.8, 0.7], 0.3, 1.4) | {"transmission": 0.5},
        glass([0.7, 0.9, 0.85], 0.1, 1.5) | {"transmission": 0.8},
    ]


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    write_ply(FOLDER / "ball.ply", *ball())
    floor = [[-12, 0, 12], [12, 0, 12], [12, 0, -12], [-12, 0, -12]]
    lamp = [[-2.5, 6, 0.5], [-2.5, 6, -2], [2.5, 6, -2], [2.5, 6, 0.5]]
    shapes = [
        {"type": "quad", "vertices": floor, "material": "floor"},
        {"type": "quad", "vertices": lamp, "emission": [10, 9.5, 9]},
    ]
    made = {"floor": {"type": "principled", "base_color": [0.45, 0.45, 0.45], "roughness": 0.6}}
    for i, material in enumerate(materials()):
        place = [i % COLUMNS - (COLUMNS - 1) / 2, RADIUS + 0.005, DEPTH * (i // COLUMNS - (ROWS - 1) / 2)]
        made[f"ball {i}"] = {"type": "principled", **material}
        shape = {"type": "ply", "file": "principled/ball.ply", "material": f"ball {i}"}
        shapes.append(shape | {"transform": [{"translate": place}]})
    scene = {
        "cameras": {"main": {"position": [0, 10.5, 8], "look_at": [0, 0, 0.2], "vertical_fov": 37}},
        "film": {"size": [512, 512]},
        "integrator": {"max_depth": 8},
        "environment": {"radiance": [0.3, 0.35, 0.4]},
        "materials": made,
        "shapes": shapes,
    }
    (MADE / "principled.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


main()
