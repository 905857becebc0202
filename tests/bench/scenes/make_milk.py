#!/usr/bin/env python3
"""Makes made/milk.json: a glass of milk on a table, under a panel and an even sky. The milk reaches a little into the glass,
which has the higher priority."""

import json
import math
from pathlib import Path

MADE = Path(__file__).resolve().parent / "made"
COLUMNS = 96
# Radius and height [m] along the outlines, from the axis outwards and back to it; fronts are to the right.
GLASS = ((0, 0), (0.36, 0), (0.42, 1.0), (0.38, 1.0), (0.325, 0.08), (0, 0.08))
MILK = ((0, 0.07), (0.335, 0.07), (0.378, 0.75), (0, 0.75))


def turned_about_axis(outline, material):
    """A closed mesh: the outline, turned about +Y."""
    positions, triangles = [], []
    for radius, height in outline:
        for column in range(COLUMNS):
            angle = 2 * math.pi * column / COLUMNS
            positions.append((radius * math.cos(angle), height, -radius * math.sin(angle)))
    for row, (below, above) in enumerate(zip(outline, outline[1:])):
        for column in range(COLUMNS):
            a, b = row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS
            if below[0] > 0:
                triangles.append((a, b, b + COLUMNS))
            if above[0] > 0:
                triangles.append((a, b + COLUMNS, a + COLUMNS))
    return {"type": "mesh", "positions": positions, "triangles": triangles, "material": material}


def square(y, half, **surface):
    return {"type": "quad", "vertices": [(-half, y, half), (half, y, half), (half, y, -half), (-half, y, -half)]} | surface


def main():
    materials = {
        "table": {"type": "diffuse", "reflectance": (0.35, 0.2, 0.12)},
        "glass": {"type": "dielectric", "ior": 1.5, "fresnel": "exact", "priority": 1},
        "milk": {
            "type": "dielectric",
            "ior": 1.35,
            "fresnel": "exact",
            "scattering": {"coefficient": (40, 38, 35), "g": 0.6},
            "absorption": {"transmittance": (0.98, 0.95, 0.86), "distance": 1},
        },
    }
    panel = [(-1.5, 2.5, 0.5), (-1.5, 2.5, -1.5), (0.5, 2.5, -1.5), (0.5, 2.5, 0.5)]
    scene = {
        "cameras": {"main": {"position": (0.3, 1.5, 2.6), "look_at": (0, 0.5, 0), "vertical_fov": 32}},
        "film": {"size": (512, 512)},
        "environment": {"radiance": (0.3, 0.33, 0.38)},
        "materials": materials,
        "shapes": [
            {"type": "quad", "vertices": panel, "emission": (12, 12, 11)},
            square(-0.001, 6, material="table"),
            turned_about_axis(GLASS, "glass"),
            turned_about_axis(MILK, "milk"),
        ],
    }
    MADE.mkdir(exist_ok=True)
    (MADE / "milk.json").write_text(json.dumps(scene), encoding="utf-8")


main()
