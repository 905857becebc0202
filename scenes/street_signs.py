"""Signs of make_street.py that stand out from the facades: neon letters, and boxes of light.

Needs NumPy (Debian: python3-numpy).
"""

import numpy as np

import street_pictures as pictures
from street_meshes import box, front, letter_tubes, tube
from street_parts import FACADE

NEON = {
    "red": [26, 2.2, 1.2],
    "orange": [26, 8, 1.2],
    "yellow": [22, 14, 3],
    "green": [2, 20, 6],
    "cyan": [2, 16, 22],
    "blue": [3, 6, 30],
    "violet": [14, 3, 30],
    "pink": [28, 3.5, 14],
    "white": [17, 15, 12],
}
# Side of the street, z and height of the lower end [m], letters and their colours.
BLADES = [
    (-1, 1.2, 4.1, ["candle"] + list("CANDELA"), ["yellow"] + ["orange"] * 7),
    (1, -1.8, 4.4, ["bowl"] + list("RAMEN"), ["white"] + ["red"] * 5),
    (-1, -8.5, 4.3, list("HOTEL"), ["cyan"] * 5),
    (1, -9.5, 4.2, ["glass"] + list("BAR"), ["green"] + ["pink"] * 3),
    (-1, -17.5, 4.6, ["moon"] + list("CLUB"), ["yellow"] + ["violet"] * 4),
    (1, -18.5, 4.2, list("CINEMA"), ["red", "orange"] * 3),
    (-1, -27.5, 4.3, list("JAZZ") + ["arrow"], ["blue"] * 4 + ["pink"]),
    (1, -29.0, 4.5, list("KARAOKE"), ["pink", "violet", "cyan", "green", "yellow", "orange", "red"]),
    (-1, -38.0, 4.3, list("DINER"), ["green"] * 5),
    (1, -41.0, 4.5, list("GRILL"), ["orange"] * 5),
]
# The same of boxes of light: text, paper and ink.
PANELS = [
    (-1, -4.6, 4.0, "HOTEL", (0.95, 0.9, 0.8), (0.5, 0.02, 0.02)),
    (1, -5.4, 5.6, "BOOKS", (0.2, 0.55, 0.95), (1, 1, 1)),
    (-1, -13.2, 5.2, "TEA", (0.35, 0.8, 0.3), (0.02, 0.08, 0.02)),
    (1, -14.0, 4.6, "SAUNA", (0.95, 0.35, 0.1), (1, 0.95, 0.8)),
    (-1, -22.6, 4.2, "PIZZA", (0.95, 0.2, 0.15), (1, 0.95, 0.85)),
    (1, -24.0, 6.0, "OPTIK", (0.9, 0.95, 1), (0.02, 0.1, 0.5)),
    (1, -35.0, 4.2, "TAXI", (1.0, 0.7, 0.1), (0.02, 0.02, 0.02)),
    (-1, -33.0, 5.0, "SUSHI", (0.95, 0.95, 0.9), (0.7, 0.02, 0.05)),
]


def blades(street):
    """Neon letters and boxes of light, one letter below the other, facing along the street on both sides."""
    for side, z, low, letters, colors in BLADES:
        cell, width = 0.62, 0.52
        height = cell * len(letters) + 0.2
        x0 = -FACADE + 0.25 if side < 0 else FACADE - 0.25 - 0.86
        street.add("board", box((x0, low, z - 0.14), (x0 + 0.86, low + height, z)))
        for y in (low + 0.3, low + height - 0.3):
            beam = sorted([side * FACADE, x0 if side > 0 else x0 + 0.86])
            street.add("metal", box((beam[0], y, z - 0.1), (beam[1], y + 0.05, z - 0.05)))
        edge = [
            (x0 + 0.05, low + 0.05),
            (x0 + 0.81, low + 0.05),
            (x0 + 0.81, low + height - 0.05),
            (x0 + 0.05, low + height - 0.05),
        ]
        edge = [(*a, z + 0.045) for a in edge + edge[:1]]
        path = np.concatenate([np.linspace(a, b, 5, endpoint=False) for a, b in zip(edge, edge[1:])] + [[edge[0]]])
        street.shine("neon", NEON[colors[-1]], tube(path, 0.008, 6))
        for i, (letter, color) in enumerate(zip(letters, colors)):
            y = low + 0.17 + cell * (len(letters) - 1 - i)
            mesh = letter_tubes(letter, width, 0.46, 0.013, 7)
            street.shine("neon", NEON[color], mesh, origin=(x0 + 0.17, y, z + 0.05))
    for i, (side, z, low, text, paper, ink) in enumerate(PANELS):
        height, width = 0.62 * len(text), 0.66
        x0 = -FACADE + 0.2 if side < 0 else FACADE - 0.2 - width
        street.add("metal", box((x0 - 0.03, low - 0.03, z - 0.2), (x0 + width + 0.03, low + height + 0.03, z)))
        emission = street.image(
            f"panel_{i}.png", lambda t=text, p=paper, k=ink: pictures.panel(t, p, k, 80, 75 * len(t), True), 0.6
        )
        street.shine("panel", emission, front(x0, x0 + width, low, low + height, z + 0.005))
