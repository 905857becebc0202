#!/bin/sh
# Gets Open Image Denoise, a library by Intel under the Apache licence, and unpacks it where candela looks for it: the
# folder lib beside a program that was built here. It comes from PyPI's package pyoidn, for x86-64, and nothing is
# installed. candela builds and runs without it.
#   usage: sh cmake/denoiser.sh [FOLDER]       FOLDER of the program candela; default: build/release
set -eu
cd "$(dirname "$0")/.."
folder=${1:-build/release}
version=2.5.1.0
wheel=pyoidn-$version-py3-none-manylinux2014_x86_64.whl
sha256=32ad13368f8de1ef63001942ad05b02a00cd732d1206d97f352d3a3f606d823e

if [ "$(uname -s)" != Linux ] || [ "$(uname -m)" != x86_64 ]; then
    echo "The package is for Linux on x86-64. Get Open Image Denoise 2 for this system, and name the file of its library" \
        "in CANDELA_OIDN." >&2
    exit 3
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m pip download --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    --platform manylinux2014_x86_64 --dest "$work" "pyoidn==$version"
if ! echo "$sha256  $work/$wheel" | sha256sum --check --status; then
    echo "$wheel is not the file that candela was tested with: its SHA-256 differs from $sha256." >&2
    exit 1
fi
# The libraries look for each other in ../lib, so the folder must have this name.
mkdir -p "$folder/lib"
python3 - "$work/$wheel" "$folder/lib" <<'END'
import sys, zipfile, pathlib

wanted = ("libOpenImageDenoise.so.2", "libOpenImageDenoise_core.so.", "libOpenImageDenoise_device_cpu.so.",
          "libtbb.so.12")
with zipfile.ZipFile(sys.argv[1]) as wheel:
    for name in wheel.namelist():
        file = pathlib.PurePosixPath(name).name
        exact = file in wanted or any(w.endswith(".") and file.startswith(w) for w in wanted)
        if exact and "/lib/" in name:
            pathlib.Path(sys.argv[2], file).write_bytes(wheel.read(name))
END
echo "Open Image Denoise is in $folder/lib; $folder/candela finds it there. For other programs: CANDELA_OIDN=$(realpath "$folder/lib")/libOpenImageDenoise.so.2"
