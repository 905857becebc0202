"""Cars of make_street.py.

Needs NumPy (Debian: python3-numpy).
"""

import numpy as np

from street_meshes import box, joined, moved, pillow, sheet, turned
from street_parts import BACK, WORLD

# Of a car, tail at +z: z, height of the top, half widths at the belt and at the top [m].
CAR = np.array(
    [
        (-2.16, 0.56, 0.62, 0.50),
        (-2.12, 0.66, 0.72, 0.60),
        (-1.95, 0.73, 0.79, 0.68),
        (-1.30, 0.84, 0.84, 0.74),
        (-0.85, 0.91, 0.85, 0.74),
        (-0.55, 1.13, 0.85, 0.66),
        (-0.20, 1.35, 0.85, 0.60),
        (0.30, 1.42, 0.85, 0.60),
        (0.95, 1.37, 0.85, 0.60),
        (1.30, 1.20, 0.84, 0.63),
        (1.62, 0.99, 0.83, 0.68),
        (1.95, 0.95, 0.80, 0.68),
        (2.12, 0.90, 0.75, 0.64),
        (2.17, 0.78, 0.70, 0.56),
    ]
)
# Around the bulbs: kind, radiance, half of the size, and place of the right one.
LENSES = [
    ("headlens", [4, 3.6, 3], (0.13, 0.085, 0.05), (0.47, 0.6, -2.17)),
    ("taillens", [1.5, 0.05, 0.03], (0.16, 0.07, 0.04), (0.53, 0.74, 2.19)),
]


def bodywork():
    """The skin of a car, and of that the painted, the glazed and the dark triangles."""
    z = np.concatenate([np.linspace(a, b, 5, endpoint=False) for a, b in zip(CAR[:-1, 0], CAR[1:, 0])] + [[CAR[-1, 0]]])
    top, belt, roof = (np.interp(z, CAR[:, 0], column)[:, None] for column in CAR[:, 1:].T)
    for values in (top, belt, roof):  # Rounded.
        values[1:-1] = (values[:-2] + 2 * values[1:-1] + values[2:]) / 4
    shoulder = np.minimum(top - 0.06, 0.88)
    x = np.hstack([0 * belt, 0.9 * belt, belt, belt, 0.97 * belt, roof + 0.02, 0.82 * roof, 0 * roof])
    y = np.hstack([0 * top + 0.2, 0 * top + 0.2, 0 * top + 0.33, 0 * top + 0.6, shoulder, top - 0.05, top, top + 0.02])
    x, y = np.hstack([x, -x[:, -2::-1]]), np.hstack([y, y[:, -2::-1]])
    at = np.linspace(0, 14, 57)
    x, y = (np.array([np.interp(at, np.arange(15), row) for row in values]) for values in (x, y))
    points = np.stack([x, y, z[:, None] + 0 * x], axis=-1)
    ends = [
        [0.9 * (row - middle) + middle + [0, 0, d], 0 * row + middle + [0, 0, d]]
        for row, middle, d in ((points[0], [0, 0.42, CAR[0, 0]], -0.03), (points[-1], [0, 0.5, CAR[-1, 0]], 0.03))
    ]
    points = np.concatenate([ends[0][::-1], points, ends[1]])
    mesh = sheet(points, np.stack([at + 0 * points[..., 0], points[..., 2]], axis=-1))
    p, z = mesh[2][mesh[3]].mean(axis=1).T
    p = np.minimum(p, 14 - p)
    sides = (p > 4.2) & (p < 4.9) & (z > -0.55) & (z < 1.25) & (np.abs(z - 0.33) > 0.05)
    glass = sides | (p > 5.3) & ((z > -0.8) & (z < -0.24) | (z > 1.0) & (z < 1.6))
    dark = (p < 2.1) & (np.abs(z) < 2.1)
    return [(*mesh[:3], mesh[3][chosen]) for chosen in (~glass & ~dark, glass, dark)]


def car(street, x, z, away, paint):
    """A car; away: its tail is towards the camera."""
    axes = WORLD if away else BACK
    origin = (x, 0, z)
    for material, mesh in zip((paint, "panes", "board"), bodywork()):
        street.add(material, mesh, axes=axes, origin=origin)
    tyre = turned([(0.2, -0.1), (0.29, -0.1), (0.32, -0.06), (0.32, 0.06), (0.29, 0.1), (0.2, 0.1)], 28)
    arch = turned([(0.38, -0.06), (0.38, 0.06), (0.001, 0.061)], 28)
    hub = turned([(0.21, 0.08), (0.19, 0.1), (0.05, 0.09), (0.001, 0.1)], 28)
    for side in (-1, 1):
        for wheel in (-1.3, 1.3):
            turn = np.array([[0, 0, -side], [side, 0, 0], [0, -1, 0]])
            at = np.array([side * 0.78, 0.32, wheel]) @ axes + origin
            street.add("tyres", tyre, arch, axes=turn @ axes, origin=at)
            street.add("enamel", hub, axes=turn @ axes, origin=at)
        bulb = moved(pillow((0.06, 0.05, 0.02), 0.8, 6, 12), (side * 0.47, 0.6, -2.21))
        street.shine("headlight", [240, 220, 180], bulb, axes, origin)
        bars = [moved(pillow((0.1, 0.01, 0.01), 0.8, 6, 12), (side * 0.53, y, 2.235)) for y in (0.71, 0.77)]
        street.shine("taillight", [110, 3.5, 2], joined(bars), axes, origin)
    for kind, emission, size, at in LENSES:
        lenses = joined([moved(pillow(size, 0.65, 8, 16), at * np.array([side, 1, 1])) for side in (-1, 1)])
        street.shine(kind, emission, lenses, axes, origin)
    street.add("enamel", box((-0.26, 0.5, 2.15), (0.26, 0.62, 2.215)), axes=axes, origin=origin)
