#!/bin/sh
# Tests the add-on in Blender, as PyPI has it: each version in a virtual environment of its own below build/, which stays.
# Needs build/release, Python 3.11, which these versions are made for, and PyPI; elsewhere it says so and exits with 3.
#   usage: sh tests/blender/run.sh [VERSION...]   (4.2.0 4.5.15 5.0.1)
set -eu
cd "$(dirname "$0")/../.."
python3 -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' ||
    { echo "Nothing was tested: Blender's modules need Python 3.11."; exit 3; }
. cmake/setup.sh
install_packages blender wheel
[ $# -gt 0 ] || set -- 4.2.0 4.5.15 5.0.1
sh cmake/blender.sh none
for version in "$@"; do
    environment=build/blender-$version
    [ -x "$environment/bin/python" ] || python3 -m venv "$environment"
    "$environment/bin/python" -c 'import bpy' 2>/dev/null || "$environment/bin/pip" install --quiet "bpy==$version" ||
        { echo "Nothing was tested in Blender $version: no index of Python packages has it for this system."; exit 3; }
    echo "== Blender $version"
    for test in blender_test textures_test viewport_test; do
        "$environment/bin/python" tests/blender/$test.py build/blender/candela_blender build/release/candela
    done
done
