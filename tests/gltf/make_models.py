#!/usr/bin/env python3
"""Makes glTF files that prove what a reader of glTF 2.0 claims, in the layout and with the names of Khronos' samples.

usage: make_models.py FOLDER [NAME]...      All models, or those named.

Writes FOLDER/Models/NAME/glTF-Binary/NAME.glb (some also as glTF and glTF-Embedded), and FOLDER/claims.md, a table of
what one must see.
"""

import importlib
import sys
from pathlib import Path

import stage

for module in sorted(Path(__file__).parent.glob("models_*.py")):
    importlib.import_module(module.stem)


def table(claims):
    lines = ["| model | what one must see |", "|---|---|"]
    claim_of = {claim["model"]: claim["claim"] for claim in claims}
    return "\n".join(lines + [f"| {name} | {text} |" for name, text in sorted(claim_of.items())]) + "\n"


def make(names, folder):
    """Writes the models of these names, or all, and returns their claims."""
    names = names or sorted(stage.MODELS)
    unknown = [name for name in names if name not in stage.MODELS]
    if unknown:
        sys.exit(f"there is no model {unknown[0]} (there are: {', '.join(sorted(stage.MODELS))})")
    return [claim for name in names for claim in stage.make(name, folder)]


def main(arguments):
    if not arguments:
        sys.exit(__doc__.split("\n\n")[1])
    folder = Path(arguments[0])
    claims = make(arguments[1:], folder)
    (folder / "claims.md").write_text(table(claims), encoding="ascii")
    print(f"{len({claim['model'] for claim in claims})} models in {folder}")


if __name__ == "__main__":
    main(sys.argv[1:])
