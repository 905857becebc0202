#!/usr/bin/env python3
"""Renders all models of a folder, and draws them side by side, with their names.

usage: contact_sheet.py CANDELA MODELS OUT.png [--spp N] [--columns N] [--only NAME]... [--keep PICTURES]

MODELS is a folder in the layout of Khronos' sample assets, or one that holds such a folder as `Models`: of each NAME
the first of glTF-Binary, glTF and glTF-Embedded that is there is rendered. Prints a line per model: seconds, exit
code, and the first warning or error; a model that fails is a red tile. Exits 1 if any fails.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import png
from stage import INK, LETTERS, Canvas, LINE

TILE = (320, 240)
GAP = 4
CONTAINERS = ("glTF-Binary", "glTF", "glTF-Embedded")
FAILED = (170, 30, 25)


def models(folder):
    """The file of each model by name, in the order of names."""
    root = folder / "Models" if (folder / "Models").is_dir() else folder
    found = {}
    for model in sorted(path for path in root.iterdir() if path.is_dir()):
        files = (sorted(path for path in (model / container).glob("*.gl*") if path.suffix in (".glb", ".gltf"))
                 for container in CONTAINERS)
        first = next((file for group in files for file in group), None)
        if first:
            found[model.name] = first
    return found


def render(candela, model, picture, spp):
    """Runs candela: seconds, exit code, and the first line that is a warning or an error."""
    start = time.monotonic()
    command = [candela, "render", str(model), "-o", str(picture), "--size", "{}x{}".format(*TILE), "--spp", str(spp),
               "-q"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    said = [line for line in result.stderr.splitlines() if "warning" in line or "error" in line]
    said += result.stderr.splitlines() if result.returncode else []
    return time.monotonic() - start, result.returncode, said[0].strip() if said else ""


def label(text):
    """Letters that the font has; others are left out."""
    return "".join(c if c in LETTERS else " " for c in text.lower())


def paste(sheet, picture, x, y):
    width, height, channels, pixels = picture
    for row in range(min(height, TILE[1])):
        for column in range(min(width, TILE[0])):
            place = (row * width + column) * channels
            colour = pixels[place:place + 3] if channels > 2 else bytes(pixels[place:place + 1] * 3)
            target = ((y + row) * sheet.width + x + column) * 3
            sheet.pixels[target:target + 3] = colour


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("candela")
    parser.add_argument("models", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--only", action="append", help="this model alone; may be repeated")
    parser.add_argument("--keep", type=Path, help="leave the pictures in this folder")
    options = parser.parse_args()
    found = {name: file for name, file in models(options.models).items() if not options.only or name in options.only}
    if not found:
        sys.exit(f"contact_sheet.py: no models in {options.models} (it needs NAME/glTF-Binary/NAME.glb or the like)")

    columns = min(options.columns, len(found))
    across, down = TILE[0] + GAP, TILE[1] + LINE + 2 * GAP
    sheet = Canvas(columns * across + GAP, -(-len(found) // columns) * down + GAP, (24, 24, 28))
    failed = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for number, (name, file) in enumerate(found.items()):
            picture = folder / f"{name}.png"
            seconds, code, said = render(options.candela, file, picture, options.spp)
            print(f"{name:32} {seconds:6.1f} s  {code:3}  {said}", flush=True)
            x, y = GAP + number % columns * across, GAP + number // columns * down
            if code == 0:
                paste(sheet, png.read(picture.read_bytes()), x, y)
            else:
                failed += 1
                sheet.fill((x, y, x + TILE[0], y + TILE[1]), FAILED)
            sheet.text(x + 2, y + TILE[1] + GAP, label(name), INK)
    options.out.write_bytes(sheet.png())
    print(f"{len(found) - failed} of {len(found)} models rendered: {options.out}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
