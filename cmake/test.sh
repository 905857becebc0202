#!/bin/sh
# Installs what is missing, builds candela, and runs all tests and checks except the slow ones, on the Vulkan device
# that it finds: one more at a time than there are processors, since some wait.
#   usage: sh cmake/test.sh [OPTIONS of cmake, such as -DCANDELA_VIEW=OFF]
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh

install_packages render test optional
sh cmake/basisu.sh || echo "Without Basis Universal, which cannot be had here: textures in KTX 2 are neither read nor tested."
cmake --preset ci "$@"
cmake --build --preset ci
ctest --preset ci --parallel "$(($(nproc) + 1))"
