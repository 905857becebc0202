#!/usr/bin/env python3
"""Checks that each test which a document names exists: docs/files.md promises nothing without a test.

usage: promises.py DOCUMENT ROOT      Prints the names that no test has; exits 1 if there are any.
"""
import re
import sys
from pathlib import Path

NAMED = re.compile(r"`([A-Z]\w*)\.([A-Z]\w*)`")
TEST = re.compile(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", re.MULTILINE)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    named = set(NAMED.findall(Path(sys.argv[1]).read_text(encoding="utf-8")))
    tests = {name for path in Path(sys.argv[2], "tests").rglob("*_test.cpp")
             for name in TEST.findall(path.read_text(encoding="utf-8"))}
    missing = sorted(named - tests)
    for suite, name in missing:
        print(f"{sys.argv[1]} names {suite}.{name}, and there is no such test")
    print(f"{len(named)} tests named, {len(missing)} missing")
    sys.exit(1 if missing or not named else 0)


if __name__ == "__main__":
    main()
