#!/usr/bin/env python3
"""Reads the test files of Khronos' glTF-Validator, and prints what becomes of each kind of flaw as a table in Markdown:

    python3 tests/gltf/validator_files.py CANDELA CHECKOUT >tests/gltf/validator.md

CHECKOUT is a copy of https://github.com/KhronosGroup/glTF-Validator. A file is refused (an error), read with a warning
about it, or read without one: then the flaw shows in no picture, or lies in what the file's scene does not use. Ends
with 1 if the program crashes, hangs, or ends in another way, or if an error names neither the file nor a place in it.
"""
import collections
import json
import subprocess
import sys
from pathlib import Path

SEVERITIES = ("error", "warning", "information", "hint")
OUTCOMES = ("refused", "warning", "read")
OWN = ("there is no light;", "there is no camera;", "the scene has no surfaces")  # Of scenes that are fine.
HANG = 60  # Seconds.


def read(candela, file):
    """What became of a file, and what is wrong with that, or nothing."""
    try:
        result = subprocess.run([candela, "info", file], capture_output=True, text=True, errors="replace", timeout=HANG,
                                check=False)
    except subprocess.TimeoutExpired:
        return "refused", "hangs"
    lines = [line for line in result.stderr.splitlines() if not any(text in line for text in OWN)]
    if result.returncode == 0:
        return ("warning" if any("warning: " in line for line in lines) else "read"), None
    if result.returncode != 1:
        return "refused", f"exit code {result.returncode}"
    return "refused", None if any(str(file) in line for line in lines) else "an error that does not name the file"


def main(candela, checkout):
    files = sorted(path for path in Path(checkout, "test").rglob("*") if path.suffix in (".gltf", ".glb"))
    if not files:
        sys.exit(f"{checkout}/test has no glTF files; name a copy of glTF-Validator")
    table, wrong = collections.defaultdict(collections.Counter), []
    for file in files:
        outcome, problem = read(candela, file)
        if problem:
            wrong.append(f"{file}: {problem}")
        report = json.loads(Path(f"{file}.report.json").read_text(encoding="utf-8"))
        for code, severity in {(m["code"], m["severity"]) for m in report["issues"]["messages"]}:
            table[severity, code][outcome] += 1
    print(f"{len(files)} files of glTF-Validator's tests; how many files with a flaw of each code are refused, read with "
          "a warning,\nand read without one. (A file may have several flaws.)\n")
    print("| code | severity | " + " | ".join(OUTCOMES) + " |")
    print("|---|---|" + "---|" * len(OUTCOMES))
    for (severity, code), counts in sorted(table.items()):
        print(f"| `{code}` | {SEVERITIES[severity]} | " + " | ".join(str(counts[o] or "") for o in OUTCOMES) + " |")
    print("\n".join(wrong), file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
