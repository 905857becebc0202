#!/bin/sh
# Makes build/blender/candela-VERSION.zip: the add-on for Blender 4.2 and newer, with the Python package that speaks to the
# program, and with the program itself if there is one in build/release (sh cmake/demo.sh) or it is named.
#   usage: sh cmake/blender.sh [PROGRAM | none]
set -eu
cd "$(dirname "$0")/.."
program=${1:-build/release/candela}
folder=build/blender/candela_blender
rm -rf build/blender
mkdir -p "$folder"
cp integrations/blender/*.py integrations/blender/blender_manifest.toml LICENSE "$folder"
mkdir "$folder/candela"
cp integrations/python/candela/*.py integrations/python/candela/py.typed "$folder/candela"
if [ "$program" != none ] && [ -x "$program" ]; then
    cp "$program" "$folder/candela/candela"
elif [ $# -gt 0 ] && [ "$program" != none ]; then
    echo "There is no program $program; build one with sh cmake/demo.sh." >&2
    exit 1
fi
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' integrations/blender/blender_manifest.toml)
python3 - "$folder" "build/blender/candela-$version.zip" <<'PYTHON'
import pathlib, sys, zipfile
folder = pathlib.Path(sys.argv[1])
with zipfile.ZipFile(sys.argv[2], "w", zipfile.ZIP_DEFLATED) as archive:
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            archive.write(file, file.relative_to(folder))
PYTHON
echo "build/blender/candela-$version.zip"
