#!/usr/bin/env python3
"""Compiles every file of the shader library alone: it must include what it uses, and compile without a warning.
Probes are kernels: they, and what they share, are not part of the library.

usage: shaders_alone.py GLSLANG ROOT      Prints what the compiler says; exits 1 if it says anything.
"""
import subprocess
import sys
from pathlib import Path

KERNEL = """#version 460
#extension GL_GOOGLE_include_directive : require
#include "{name}"
layout(local_size_x = 8, local_size_y = 8) in;
void main() {{}}
"""


def complaint(glslang, shaders, name):
    """What the compiler says about a kernel that includes that file and nothing else; empty if it accepts it."""
    command = [glslang, "--quiet", "--stdin", "-S", "comp", "--target-env", "vulkan1.2", f"-I{shaders}", "-o", "/dev/null"]
    result = subprocess.run(command, input=KERNEL.format(name=name), capture_output=True, text=True, check=False)
    said = (result.stdout + result.stderr).strip()
    return said or (f"{glslang} exits with {result.returncode}" if result.returncode else "")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    glslang, shaders = sys.argv[1], Path(sys.argv[2], "shaders")
    names = [path.relative_to(shaders).as_posix() for pattern in ("*.glsl", "*.h")
             for path in sorted(shaders.rglob(pattern))
             if not path.name.endswith(".comp.glsl") and path.parent.name != "probes"]
    problems = 0
    for name in names:
        said = complaint(glslang, shaders, name)
        if said:
            problems += 1
            print(f"shaders/{name} alone:\n{said}")
    print(f"{len(names)} files, {problems} problems")
    sys.exit(1 if problems or not names else 0)


if __name__ == "__main__":
    main()
