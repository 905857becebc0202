#!/usr/bin/env python3
"""Makes glTF files that prove what a reader of glTF 2.0 claims, in the layout and with the names of Khronos' samples.

usage: make_models.py FOLDER [NAME]...      All models, or those named.

Writes FOLDER/Models/NAME/glTF-Binary/NAME.glb (some also as glTF and glTF-Embedded), FOLDER/claims.md, a table of what
one must see, and FOLDER/claims.json: an array of renderings, each with

    model, file, claim    the file relative to FOLDER
    size                  pixels of the picture in which the rectangles [left, top, right, bottom] are
    arguments             further arguments of `candela render`
    spp                   samples per pixel that suffice for the tolerance
    tolerance             in 8-bit codes of sRGB, for means over blocks of 4 by 4 pixels
    equal                 pairs of rectangles: no block differs by more than the tolerance
    differ                pairs of rectangles: some block differs by more than four times the tolerance
    shown                 rectangles of which some block differs from the backdrop's colour by more than four times
                          the tolerance
    colours               rectangles whose blocks must have this colour (codes), within the tolerance
"""

import importlib
import json
import sys
from pathlib import Path

import stage

for module in ("textures", "geometry", "scene", "normals", "slots", "spheres", "transmission", "lights", "motion",
               "skins"):
    if (Path(__file__).parent / f"models_{module}.py").exists():
        importlib.import_module(f"models_{module}")


def table(claims):
    lines = ["| model | what one must see |", "|---|---|"]
    claim_of = {claim["model"]: claim["claim"] for claim in claims}
    return "\n".join(lines + [f"| {name} | {text} |" for name, text in sorted(claim_of.items())]) + "\n"


def main(arguments):
    if not arguments:
        sys.exit(__doc__.split("\n\n")[1])
    folder, names = Path(arguments[0]), arguments[1:] or sorted(stage.MODELS)
    unknown = [name for name in names if name not in stage.MODELS]
    if unknown:
        sys.exit(f"make_models.py: no model {unknown[0]} (there are: {', '.join(sorted(stage.MODELS))})")
    claims = [claim for name in names for claim in stage.make(name, folder)]
    (folder / "claims.json").write_text(json.dumps(claims, indent=1) + "\n", encoding="ascii")
    (folder / "claims.md").write_text(table(claims), encoding="ascii")
    print(f"{len(names)} models in {folder}")


if __name__ == "__main__":
    main(sys.argv[1:])
