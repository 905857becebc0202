#!/usr/bin/env python3
"""Makes the models of make_models.py, renders them, and says which of their claims do not hold.

usage: check_claims.py CANDELA [NAME]... [--keep FOLDER]
       check_claims.py --list       prints a line for each model: the label of its test, gltf or slow, and its name

Prints a line for each rendering, and one for each claim that fails, with the rectangle and the codes there; exits 1 if
any fails. --keep leaves models and pictures in a folder. A model is slow if a claim needs more than QUICK_SPP samples per pixel.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import make_models
import png
from stage import DARK

BLOCK = 4  # Pixels along each side of what is compared.
QUICK_SPP = 16


def means(picture, rect):
    """The mean codes of the blocks in a rectangle, in rows; what is left at the right and below belongs to the last."""
    width, _, channels, pixels = picture
    x0, y0, x1, y1 = (round(c) for c in rect)
    columns, rows = max((x1 - x0) // BLOCK, 1), max((y1 - y0) // BLOCK, 1)
    result = []
    for j in range(rows):
        for i in range(columns):
            left, top = x0 + i * BLOCK, y0 + j * BLOCK
            right = x1 if i == columns - 1 else left + BLOCK
            bottom = y1 if j == rows - 1 else top + BLOCK
            total = [0, 0, 0]
            for y in range(top, bottom):
                for x in range(left, right):
                    place = (y * width + x) * channels
                    for k in range(3):
                        total[k] += pixels[place + (k if channels > 2 else 0)]
            area = (right - left) * (bottom - top)
            result.append([t / area for t in total])
    return result


def furthest(picture, a, b):
    """The two blocks of two rectangles that differ most, and by how much."""
    pairs = zip(means(picture, a), means(picture, b))
    return max(((max(abs(p - q) for p, q in zip(x, y)), x, y) for x, y in pairs), key=lambda item: item[0])


def furthest_from(picture, rect, colour):
    """The block that differs most from a colour, after how much."""
    return max((max(abs(m - c) for m, c in zip(mean, colour)), mean) for mean in means(picture, rect))


def text(colour):
    return "(" + ", ".join(f"{c:.0f}" for c in colour) + ")"


def violations(claim, picture):
    """What a picture says against a claim, as lines."""
    most, lines = claim["tolerance"], []
    for a, b in claim["equal"]:
        gap, x, y = furthest(picture, a, b)
        if gap > most:
            lines.append(f"{a} and {b} differ by {gap:.1f}: {text(x)}, {text(y)}")
    for a, b in claim["differ"]:
        gap, _, _ = furthest(picture, a, b)
        if gap <= 4 * most:
            lines.append(f"{a} and {b} differ by {gap:.1f} alone")
    for rect, colour in claim["colours"]:
        gap, worst = furthest_from(picture, rect, colour)
        if gap > most:
            lines.append(f"{rect} is {text(worst)}, not {text(colour)}")
    for rect in claim["shown"]:
        gap, _ = furthest_from(picture, rect, DARK)
        if gap <= 4 * most:
            lines.append(f"{rect} shows only the backdrop")
    return lines


def render(candela, model, picture, claim):
    """Runs candela; what it said if it failed, otherwise None."""
    size = "x".join(map(str, claim["size"]))
    command = [candela, "render", str(model), "-o", str(picture), "--size", size, "--spp", str(claim["spp"]), "-q",
               *claim["arguments"]]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    return None if result.returncode == 0 else f"exit code {result.returncode}: {result.stderr.strip()}"


def labels(folder):
    """The label of each model's test, by name."""
    spp = {}
    for claim in make_models.make([], folder):
        spp[claim["model"]] = max(claim["spp"], spp.get(claim["model"], 0))
    return {name: "gltf" if most <= QUICK_SPP else "slow" for name, most in spp.items()}


def check(candela, names, folder):
    """Makes, renders and judges models; prints what it found, and returns whether all claims hold."""
    copy_state = True
    for number, claim in enumerate(make_models.make(names, folder)):
        file = folder / f"{number:02}-{claim['model']}.png"
        problem = render(candela, folder / claim["file"], file, claim)
        lines = [problem] if problem else violations(claim, png.read(file.read_bytes()))
        print(" ".join([claim["model"], *claim["arguments"]]) + (": holds" if not lines else ""), flush=True)
        for line in lines:
            print(f"    {line}", flush=True)
        copy_state = copy_state and not lines
    return copy_state


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("candela", nargs="?")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        if options.list:
            print("\n".join(f"{label} {name}" for name, label in labels(folder).items()))
            return 0
        if options.candela is None:
            parser.error("say which candela")
        return 0 if check(options.candela, options.names, folder) else 1


if __name__ == "__main__":
    sys.exit(main())
