#!/usr/bin/env python3
"""Checks that what runs within Blender says that it is under the GPL, and that nothing else that users get imports bpy.

usage: licences.py ROOT
"""
import re
import sys
from pathlib import Path

GPL = "# SPDX-License-Identifier: GPL-3.0-or-later\n"
IMPORT = re.compile(r"^\s*(import|from)\s+(bpy|bpy_extras|mathutils)\b", re.M)


def problems(root):
    for file in sorted(root.glob("integrations/blender/**/*.py")):
        if not file.read_text().startswith(GPL):
            yield f"{file.relative_to(root)}: its first line is not {GPL.strip()!r}, as Blender's API demands"
    for file in sorted(root.glob("integrations/python/**/*.py")):
        text = file.read_text()
        if IMPORT.search(text):
            yield f"{file.relative_to(root)}: imports Blender's modules, and would be under the GPL; move it to integrations/blender"
        if "SPDX" in text:
            yield f"{file.relative_to(root)}: names a licence of its own; it is under that of the project"
    manifest = (root / "integrations/blender/blender_manifest.toml").read_text()
    if '"SPDX:GPL-3.0-or-later"' not in manifest:
        yield "integrations/blender/blender_manifest.toml: does not say that the add-on is under GPL-3.0-or-later"


def main():
    found = list(problems(Path(sys.argv[1])))
    for problem in found:
        print(problem)
    print(f"licences: {len(found)} problems")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
