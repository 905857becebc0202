#!/usr/bin/env python3
"""Compiles all of host/ for Windows with mingw-w64, to see its errors and warnings alone: no library is built for it, and
nothing is linked or run, as cmake/try_windows.sh does.

usage: windows.py BUILD        BUILD: a folder that CMake has configured, and built, for Linux
"""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

COMPILER = "x86_64-w64-mingw32-g++-posix"
SYSTEM = Path("/usr/include")
# The headers of libraries are those of Linux: they are the same, but for the one that says what libjpeg was built with.
HEADERS = ("CLI", "GLFW", "Imath", "OpenEXR", "draco", "glm", "imgui", "jerror.h", "jmorecfg.h", "jpeglib.h", "meshoptimizer.h",
           "nlohmann", "png.h", "pngconf.h", "pnglibconf.h", "stb", "vk_video", "volk.c", "volk.h", "vulkan", "webp",
           "x86_64-linux-gnu/jconfig.h")


def link_headers(folder):
    """Makes a folder of these headers, since the rest of /usr/include is not for Windows; returns the compiler's options."""
    for name in HEADERS:
        (folder / Path(name).name).symlink_to(SYSTEM / name)
    return [option for name in ("", "Imath", "OpenEXR", "imgui", "stb") for option in ("-isystem", str(folder / name))]


def commands(build, headers, folder):
    """The compiler's calls, as in the build for Linux, with host/os/windows for host/os/posix and host/os/linux."""
    root = Path(__file__).resolve().parents[2]
    for entry in json.loads((build / "compile_commands.json").read_text()):
        file = Path(entry["file"])
        library = next((part for part in file.parts if part.startswith("candela_") and part.endswith(".dir")), "")
        if not (library and "Unity" in file.parts or root / "host" in file.parents) or "kernels" in file.parts:
            continue
        if library == "candela_os.dir":
            sources = [*(root / "host/os").glob("*.cpp"), *(root / "host/os/windows").glob("*.cpp")]
            file = folder / "os.cpp"
            file.write_text("".join(f'#include "{source}"\n' for source in sorted(sources)))
        words = shlex.split(entry["command"])[1:]
        kept = [word for word in words if word.startswith(("-D", "-I", "-W", "-std=")) and word != "-Winvalid-pch"]
        basisu = [option for option in words if option.endswith("/transcoder")]
        yield [COMPILER, "-fsyntax-only", "-O1", "-Werror", "-D_USE_MATH_DEFINES", *kept, *headers,
               *(word for path in basisu for word in ("-isystem", path)), str(file)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.split("\n\n")[1])
    with tempfile.TemporaryDirectory() as name:
        calls = list(commands(Path(sys.argv[1]).resolve(), link_headers(Path(name)), Path(name)))
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            failed = sum(call.returncode != 0 for call in pool.map(subprocess.run, calls))
    print(f"{len(calls)} units of host/ for Windows: " + (f"{failed} with errors" if failed else "no error, no warning"))
    sys.exit(failed != 0)


if __name__ == "__main__":
    main()
