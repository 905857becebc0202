#!/usr/bin/env python3
"""Checks that the skies of a folder are, in some rows, what the scripts beside them make: sky.py SCENES_DIR."""

import importlib
import sys
from pathlib import Path

sys.dont_write_bytecode = True

SKIES = {"sky.hdr": "make_sky", "dusk.hdr": "make_dusk", "materials/studio.hdr": "make_materials"}
CHECKED_ROWS = 16


def differences(path, maker):
    """How the file differs from what the script makes."""
    data = path.read_bytes()
    at = len(maker.header())
    if not data.startswith(maker.header()):
        return ["the header differs"]
    found_differences = []
    for row in range(0, maker.HEIGHT, maker.HEIGHT // CHECKED_ROWS):
        encoded = maker.encoded_row(row)
        found = data.find(encoded, at)
        # The first row follows the header, and each row those before it.
        if found < 0 or (row == 0 and found != at):
            found_differences.append(f"row {row} differs")
        else:
            at = found + len(encoded)
    return found_differences


def main(folder):
    sys.path.insert(0, str(folder))
    failures = 0
    for name, maker in SKIES.items():
        for difference in differences(folder / name, importlib.import_module(maker)):
            print(f"{folder / name}: {difference}; run {maker}.py", file=sys.stderr)
            failures += 1
    print(f"{len(SKIES)} skies checked, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: sky.py SCENES_DIR")
    sys.exit(main(Path(sys.argv[1])))
