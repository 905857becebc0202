#!/usr/bin/env python3
"""Translates every kernel into Metal's language, as MoltenVK does on macOS: once with Metal's own texel buffers, once
with textures in their place. Nothing here compiles the result.

usage: metal.py SPIRV_CROSS KERNEL.spv...      Prints what the translator says; exits 1 if it says anything.
"""
import subprocess
import sys
from pathlib import Path

LANGUAGE = ["--msl", "--msl-version", "20300"]  # 2.3, of macOS 11.
FORMS = {"native": ["--msl-texture-buffer-native"], "emulated": []}


def complaint(translator, kernel, options):
    """What the translator says about a kernel; empty if it accepts it."""
    result = subprocess.run([translator, *LANGUAGE, *options, kernel], capture_output=True, text=True, check=False)
    said = result.stderr.strip()
    return said or ("" if result.returncode == 0 and result.stdout else f"exits with {result.returncode}, prints nothing")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    translator, kernels = sys.argv[1], sys.argv[2:]
    problems = 0
    for kernel in kernels:
        for form, options in FORMS.items():
            said = complaint(translator, kernel, options)
            if said:
                problems += 1
                print(f"{Path(kernel).stem}, {form} texel buffers: {said}")
    print(f"{len(kernels)} kernels in {len(FORMS)} forms, {problems} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
