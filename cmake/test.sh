#!/bin/sh
# Installs what is missing, builds candela, and runs all tests and checks except the slow ones, on the Vulkan device
# that it finds: one more at a time than there are processors, since some wait.
#   usage: sh cmake/test.sh [OPTIONS of cmake, such as -DCANDELA_VIEW=OFF]
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh

install_packages render test optional
cmake --preset ci "$@"
cmake --build --preset ci
ctest --preset ci --parallel "$(($(nproc) + 1))"
