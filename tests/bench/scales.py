#!/usr/bin/env python3
"""One room, scaled, moved and turned: how much the mean of its picture changes.

The room is 1 m wide: diffuse walls, a lamp 1 mm under the ceiling, a glass sphere with absorption, a metal box, a smooth
mesh and a disk that glows; through a thin lens. Samples are independent, and every picture has the same seed: so what
differs is rounding, and the few paths that it sends elsewhere. Coordinates are written with all digits of a double.

usage: scales.py CANDELA [--spp N] [--size N]       Prints a table in Markdown.
"""
import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from rivals import exr  # noqa: E402

SCALES = [1e7, 1e3, 1.0, 0.1, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6]
SHIFTS = [0.0, 1e2, 3e2, 1e3, 3e3, 1e4, 1e5, 1e6, 1e7]


def smooth_mesh():
    """A ring of squares, bent into a wave; with the normals of the wave."""
    positions, normals, triangles = [], [], []
    for i in range(13):
        for k in range(5):
            x = 0.1 + 0.8 * i / 12
            y = 0.05 + 0.03 * math.sin(9 * x)
            positions.append([x, y, 0.1 + 0.05 * k])
            normals.append([-0.27 * math.cos(9 * x), 1.0, 0.0])
    for i in range(12):
        for k in range(4):
            a = 5 * i + k
            triangles += [[a, a + 1, a + 6], [a, a + 6, a + 5]]
    return positions, normals, triangles


def room(scale, shift):
    """The scene at `scale`, moved by `shift` times its size along each axis."""
    def at(*p):
        return [scale * (c + shift) for c in p]

    def quad(material, *corners, **more):
        return {"type": "quad", "material": material, "vertices": [at(*c) for c in corners], **more}

    positions, normals, triangles = smooth_mesh()
    return {
        "cameras": {"main": {"position": at(0.5, 0.5, 2.2), "look_at": at(0.5, 0.45, 0.5), "vertical_fov": 35,
                             "lens": {"radius": 0.01 * scale, "focal_distance": 1.7 * scale}}},
        "materials": {
            "white": {"type": "diffuse", "reflectance": 0.7},
            "red": {"type": "diffuse", "reflectance": [0.6, 0.1, 0.1]},
            "glass": {"type": "dielectric", "ior": 1.5, "absorption": {"transmittance": [0.4, 0.8, 0.6], "distance": 0.4 * scale}},
            "metal": {"type": "conductor", "reflectance": [0.9, 0.7, 0.4], "alpha": 0.2},
            "black": {"type": "diffuse", "reflectance": 0},
        },
        "shapes": [
            quad("white", (0, 0, 1), (1, 0, 1), (1, 0, 0), (0, 0, 0)),
            quad("white", (0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)),
            quad("white", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
            quad("red", (0, 0, 1), (0, 0, 0), (0, 1, 0), (0, 1, 1)),
            quad("white", (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)),
            quad("black", (0.3, 0.999, 0.3), (0.7, 0.999, 0.3), (0.7, 0.999, 0.7), (0.3, 0.999, 0.7),
                 emission=[8, 7, 6]),
            {"type": "disk", "material": "black", "center": at(0.5, 0.7, 0.02), "normal": [0.1, -0.3, 1],
             "radius": 0.1 * scale, "emission": 2},
            {"type": "sphere", "material": "glass", "center": at(0.7, 0.2, 0.6), "radius": 0.2 * scale},
            {"type": "sphere", "material": "black", "center": at(0.15, 0.8, 0.3), "radius": 0.04 * scale, "emission": 9},
            {"type": "box", "material": "metal", "min": at(0.15, 0.0, 0.4), "max": at(0.4, 0.35, 0.65)},
            {"type": "mesh", "material": "white", "positions": [at(*p) for p in positions], "normals": normals,
             "triangles": triangles},
        ],
        "environment": {"radiance": [0.2, 0.3, 0.5]},
    }


def mean(candela, scene, arguments, folder):
    """The mean of R, G and B over the picture."""
    (folder / "room.json").write_text(json.dumps(scene))
    subprocess.run([candela, "render", folder / "room.json", "-o", folder / "room.exr", "--aov", "none", "--quiet",
                    "--size", f"{arguments.size}x{arguments.size}", "--spp", str(arguments.spp), "--seed", "1",
                    "--sampler", "independent"], check=True)
    width, height, planes = exr.read(folder / "room.exr")
    return math.fsum(map(math.fsum, planes)) / (3 * width * height)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("candela")
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--size", type=int, default=64)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = mean(arguments.candela, room(1.0, 0.0), arguments, folder)
        print("| scaled to | mean |\n|---|---|")
        for scale in SCALES:
            change = mean(arguments.candela, room(scale, 0.0), arguments, folder) / first - 1
            print(f"| {scale:g} m | {100 * change:+.4f} % |", flush=True)
        print("\n| moved by its size times | mean |\n|---|---|")
        for shift in SHIFTS:
            change = mean(arguments.candela, room(1.0, shift), arguments, folder) / first - 1
            print(f"| {shift:g} | {100 * change:+.4f} % |", flush=True)


if __name__ == "__main__":
    main()
