#!/bin/sh
# Builds candela with Clang and libc++, as macOS has them, in build/libcxx; runs the unit tests, and the gallery, whose
# pictures must have the bits of those of build/release/candela. The libraries in C++ are built from Debian's sources,
# since Debian's own have the names of libstdc++ inside.
# Needs build/release (sh cmake/test.sh) and Debian 12; on other systems it says so and exits with 3.
# usage: sh cmake/libcxx.sh [OPTION OF CMAKE...]
set -eu
cd "$(dirname "$0")/.."
if ! grep -qs '^VERSION_CODENAME=bookworm$' /etc/os-release; then
    echo "Nothing was tried: the compiler comes with Debian 12, and this is another system."
    exit 3
fi
[ -x build/release/candela ] || { echo "There is no build/release/candela; run sh cmake/test.sh first." >&2; exit 1; }
. cmake/setup.sh
. cmake/sources.sh
install_packages render test wheel libcxx
folder=$PWD/build/libcxx
root=$folder/root
compilers="-DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_CXX_FLAGS=-stdlib=libc++"
mkdir -p "$folder"

if [ ! -f "$root/complete" ]; then
    rm -rf "$root"
    source_of imath openexr draco meshoptimizer googletest tinyobjloader tinygltf
    # shellcheck disable=SC2086  # The compilers are words.
    {
        archive imath "$root" $compilers
        archive openexr "$root" $compilers -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF \
            -DOPENEXR_INSTALL_EXAMPLES=OFF
        archive draco "$root" $compilers
        archive meshoptimizer "$root" $compilers -DMESHOPT_BUILD_SHARED_LIBS=OFF -DMESHOPT_BUILD_GLTFPACK=OFF
        archive googletest "$root" $compilers
        archive tinyobjloader "$root" $compilers
        archive tinygltf "$root" $compilers -DTINYGLTF_BUILD_LOADER_EXAMPLE=OFF
    }
    touch "$root/complete"
fi

cmake --preset libcxx "$@"
cmake --build --preset libcxx
seq 0 7 | CANDELA_VALIDATION=1 GTEST_BRIEF=1 GTEST_TOTAL_SHARDS=8 \
    xargs -P "$(nproc)" -I {} env GTEST_SHARD_INDEX={} "$folder/release/tests/unit_tests"
# "bad fde" is no fault: Mesa's compiler announces its code as libgcc wants it, and libc++ brings LLVM's libunwind.
sh cmake/same_pictures.sh "$folder/release/candela"
