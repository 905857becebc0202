#!/bin/sh
# Runs clang-tidy over the sources in host/: in the batches in which they are compiled, since it looks at every header
# that a file includes, and at each batch's once; or, four times as long, each on its own.
#   usage: sh cmake/lint.sh [alone]
set -eu
cd "$(dirname "$0")/.."
preset=ci
[ "${1:-}" != alone ] || preset=debug

# CMake writes the batches when it configures.
mkdir -p build
cmake --preset $preset >build/lint.log || { cat build/lint.log; exit 1; }
sed -n 's/^ *"file": "\(.*\)",*$/\1/p' build/$preset/compile_commands.json |
    grep -E "^$PWD/(host|build/$preset/host/CMakeFiles)/" >build/lint.files
echo "clang-tidy: $(wc -l <build/lint.files) files"
# A batch includes sources, and is the only file that may.
xargs -P "$(nproc)" -n 1 clang-tidy -quiet -checks=-bugprone-suspicious-include -p build/$preset <build/lint.files
