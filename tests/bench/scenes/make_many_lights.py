#!/usr/bin/env python3
"""Makes made/many-lights.json: a hall of columns under 256 small lamps, the strongest 200 times as strong as the
weakest. From any point, columns hide most of the lamps. Seeds are fixed: the scene is always the same.
"""

import json
import math
import random
from pathlib import Path

MADE = Path(__file__).resolve().parent / "made"
SIDE, HEIGHT = 12, 3  # Of the hall [m].
LAMPS = 16  # Along each side.
LAMP = 0.06  # Half the edge of a lamp [m].
LAMP_HEIGHT = 2.9
FAINTEST, STRONGEST = 0.5, 100  # Radiance [W/(m^2 sr)], before the tint.
TINTS = ((1, 0.75, 0.5), (1, 1, 1), (0.6, 0.8, 1))
COLUMNS = 5  # Along each side.
COLUMN, COLUMN_HEIGHT = 0.3, 2.5  # Half the edge of a column, and how far it reaches up [m].


def quad(*vertices, **surface):
    return {"type": "quad", "vertices": vertices, **surface}


def hall():
    """Floor, ceiling and four walls, each with its front inside."""
    a, h = SIDE, HEIGHT
    yield quad((0, 0, a), (a, 0, a), (a, 0, 0), (0, 0, 0), material="floor")
    yield quad((0, h, 0), (a, h, 0), (a, h, a), (0, h, a), material="white")
    yield quad((0, 0, 0), (a, 0, 0), (a, h, 0), (0, h, 0), material="white")
    yield quad((a, 0, a), (0, 0, a), (0, h, a), (a, h, a), material="white")
    yield quad((0, 0, a), (0, 0, 0), (0, h, 0), (0, h, a), material="red")
    yield quad((a, 0, 0), (a, 0, a), (a, h, a), (a, h, 0), material="green")


def columns():
    for i in range(COLUMNS):
        for k in range(COLUMNS):
            x, z = ((n + 0.5) * SIDE / COLUMNS for n in (i, k))
            low, high = (x - COLUMN, 0, z - COLUMN), (x + COLUMN, COLUMN_HEIGHT, z + COLUMN)
            yield {"type": "box", "min": low, "max": high, "material": "white"}


def lamps():
    """One lamp in each cell of the ceiling, shining downwards."""
    for i in range(LAMPS):
        for k in range(LAMPS):
            chance = random.Random(LAMPS * i + k)
            x, z = ((n + chance.uniform(0.3, 0.7)) * SIDE / LAMPS for n in (i, k))
            radiance = FAINTEST * math.exp(chance.random() * math.log(STRONGEST / FAINTEST))
            emission = [round(radiance * c, 3) for c in chance.choice(TINTS)]
            x0, x1, z0, z1 = (round(v, 4) for v in (x - LAMP, x + LAMP, z - LAMP, z + LAMP))
            y = LAMP_HEIGHT
            yield quad((x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1), emission=emission)


def main():
    scene = {
        "cameras": {"main": {"position": [7.4, 1.7, 11.8], "look_at": [5.2, 1.4, 5], "vertical_fov": 60}},
        "film": {"size": [512, 512]},
        "integrator": {"max_depth": 5},
        "materials": {
            "white": {"type": "diffuse", "reflectance": [0.7, 0.7, 0.7]},
            "floor": {"type": "diffuse", "reflectance": [0.5, 0.45, 0.4]},
            "red": {"type": "diffuse", "reflectance": [0.6, 0.1, 0.1]},
            "green": {"type": "diffuse", "reflectance": [0.1, 0.5, 0.1]},
        },
        "shapes": [*hall(), *columns(), *lamps()],
    }
    MADE.mkdir(exist_ok=True)
    (MADE / "many-lights.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


main()
