#!/bin/sh
# Runs clang-tidy over the sources in host/, in the batches in which they are compiled: it looks at every header that a
# file includes, and so at each batch's once.   usage: sh cmake/lint.sh
set -eu
cd "$(dirname "$0")/.."

# CMake writes the batches when it configures.
mkdir -p build
cmake --preset ci >build/lint.log || { cat build/lint.log; exit 1; }
sed -n 's/^ *"file": "\(.*\)",*$/\1/p' build/ci/compile_commands.json |
    grep -E "^$PWD/(host|build/ci/host/CMakeFiles)/" >build/lint.files
echo "clang-tidy: $(wc -l <build/lint.files) files"
# A batch includes sources, and is the only file that may.
xargs -P "$(nproc)" -n 1 clang-tidy -quiet -checks=-bugprone-suspicious-include -p build/ci <build/lint.files
