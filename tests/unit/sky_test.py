#!/usr/bin/env python3
"""Checks that scenes/sky.hdr is what scenes/make_sky.py makes, in some of its rows: sky_test.py SCENES_DIR."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True


def main(folder):
    sys.path.insert(0, str(folder))
    import make_sky

    data = (folder / "sky.hdr").read_bytes()
    failures = []
    if not data.startswith(make_sky.header()):
        failures.append("the header differs")
    at, rows = len(make_sky.header()), range(0, make_sky.HEIGHT, 32)
    for row in rows:
        encoded = make_sky.encoded_row(row)
        found = data.find(encoded, at)
        # The first row follows the header, and each row those before it.
        if found < 0 or (row == 0 and found != at):
            failures.append(f"row {row} differs")
        else:
            at = found + len(encoded)
    for failure in failures:
        print(f"{folder / 'sky.hdr'}: {failure}; run make_sky.py", file=sys.stderr)
    print(f"{len(rows)} rows of {make_sky.HEIGHT} checked, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: sky_test.py SCENES_DIR")
    sys.exit(main(Path(sys.argv[1])))
