#!/bin/sh
# Installs what is missing, builds candela and renders the Cornell box.
#   usage: sh cmake/demo.sh [OPTIONS of cmake, such as -DCANDELA_VIEW=OFF]
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh

install_packages render
cmake --preset release "$@"
cmake --build --preset release
build/release/candela render scenes/cornell-box.json -o cornell-box.png -o cornell-box.exr
echo "The picture: $PWD/cornell-box.png"
echo "Its radiance and more: $PWD/cornell-box.exr"
