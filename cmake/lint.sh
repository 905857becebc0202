#!/bin/sh
# Runs clang-tidy over the sources in host/, in the batches in which they are compiled: it reads every header that a
# file includes, and so a batch's headers only once.   usage: sh cmake/lint.sh
set -eu
cd "$(dirname "$0")/.."

# CMake writes the batches when it configures.
mkdir -p build
cmake --preset ci >build/lint.log || { cat build/lint.log; exit 1; }
sed -n 's/^ *"file": "\(.*\)",*$/\1/p' build/release/compile_commands.json |
    grep -E "^$PWD/(host|build/release/host/CMakeFiles)/" >build/lint.files
echo "clang-tidy: $(wc -l <build/lint.files) files"
# Only batches may include sources; the check that forbids that is off.
xargs -P "$(nproc)" -n 1 clang-tidy -quiet -checks=-bugprone-suspicious-include -p build/release <build/lint.files
