#!/bin/sh
# Formats C++ and GLSL as .clang-format and shaders/.clang-format say; the test `format` checks it.
#   usage: sh cmake/format.sh
set -eu
cd "$(dirname "$0")/.."
find host tests shaders \( -name '*.cpp' -o -name '*.h' -o -name '*.glsl' \) -exec clang-format-14 -i {} +
