#!/bin/sh
# Formats every C++ file as .clang-format says; the test `format` checks it.   usage: sh cmake/format.sh
set -eu
cd "$(dirname "$0")/.."
find host tests shaders/shared \( -name '*.cpp' -o -name '*.h' \) -exec clang-format-14 -i {} +
