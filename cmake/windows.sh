#!/bin/sh
# Builds candela for Windows 10 and newer on x86-64, on Debian, in build/windows: candela.exe, which needs no library
# but the system's, and the archive candela-VERSION-windows-x86_64.zip with it and the scenes. Its libraries are built
# from Debian's sources.
# usage: sh cmake/windows.sh [OPTION OF CMAKE...], or: sh cmake/windows.sh quick [OPTION OF CMAKE...]
# quick: nothing is optimized, for tests
set -eu
cd "$(dirname "$0")/.."
type=Release optimize=-O2
if [ "${1-}" = quick ]; then
    type=None optimize=-O0  # None has no options, and so no -g either.
    shift
fi
. cmake/setup.sh
. cmake/sources.sh
install_packages render wheel windows
folder=$PWD/build/windows
root=$folder/root
toolchain=-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/mingw.cmake
mkdir -p "$folder"
sh cmake/basisu.sh

if [ "$type" != "$(cat "$root/complete" 2>/dev/null)" ]; then
    rm -rf "$root"
    mkdir -p "$root/include"
    source_of imath openexr libpng1.6 libjpeg-turbo libwebp draco meshoptimizer glfw3 imgui
    archive imath "$root" "$toolchain"
    archive openexr "$root" "$toolchain" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF \
        -DOPENEXR_INSTALL_EXAMPLES=OFF
    archive libpng1.6 "$root" "$toolchain" -DPNG_SHARED=OFF -DPNG_TESTS=OFF -DPNG_EXECUTABLES=OFF
    archive libjpeg-turbo "$root" "$toolchain" -DENABLE_SHARED=OFF -DWITH_TURBOJPEG=OFF
    archive libwebp "$root" "$toolchain" -DWEBP_BUILD_ANIM_UTILS=OFF -DWEBP_BUILD_CWEBP=OFF -DWEBP_BUILD_DWEBP=OFF \
        -DWEBP_BUILD_GIF2WEBP=OFF -DWEBP_BUILD_IMG2WEBP=OFF -DWEBP_BUILD_VWEBP=OFF -DWEBP_BUILD_WEBPINFO=OFF \
        -DWEBP_BUILD_WEBPMUX=OFF -DWEBP_BUILD_EXTRAS=OFF
    archive draco "$root" "$toolchain"
    archive meshoptimizer "$root" "$toolchain" -DMESHOPT_BUILD_SHARED_LIBS=OFF -DMESHOPT_BUILD_GLTFPACK=OFF
    archive glfw3 "$root" "$toolchain" -DGLFW_BUILD_EXAMPLES=OFF -DGLFW_BUILD_TESTS=OFF -DGLFW_BUILD_DOCS=OFF
    make -C "$folder/source/imgui" CXX=x86_64-w64-mingw32-g++-posix AR=llvm-ar PKG_CONFIG=true \
        CPPFLAGS="-I. -I$root/include" CXXFLAGS=$optimize PREFIX="$root" LIBDIR=lib VERSION=1.86 \
        SRCS="imgui.cpp imgui_draw.cpp imgui_tables.cpp imgui_widgets.cpp backends/imgui_impl_glfw.cpp" \
        install >"$folder/imgui.log"
    # Headers, which are the same for all systems, and what CMake has to know of them.
    for header in glm nlohmann CLI stb volk.h volk.c vulkan vk_video; do ln -s "/usr/include/$header" "$root/include/"; done
    mkdir -p "$root/share/cmake"
    for name in glm nlohmann_json CLI11; do cp -r "/usr/share/cmake/$name" "$root/share/cmake/"; done
    echo "$type" >"$root/complete"
fi

# Without optimization, functions are so many that the linker of binutils takes a minute, LLVM's half a second.
linker=
if [ "$type" = None ]; then
    # shellcheck disable=SC2016  # Its own arguments.
    printf '#!/bin/sh\nexec ld.lld "$@"\n' >"$folder/collect2"
    chmod +x "$folder/collect2"
    linker="-B$folder/ -fno-use-linker-plugin"
fi
cmake --preset windows -DCANDELA_VIEW=ON "-DCMAKE_BUILD_TYPE=$type" "-DCMAKE_EXE_LINKER_FLAGS=$linker" \
    "-DCANDELA_LICENSES=$folder/licenses" "$@"
cmake --build --preset windows
(cd "$folder/release" && cpack -B "$folder")
ls -l "$folder"/candela-*.zip

# What the program needs must be the system's.
others=$(x86_64-w64-mingw32-objdump -p "$folder/release/candela.exe" | sed -n 's/^.*DLL Name: //p' |
    grep -Eiv '^(kernel32|user32|gdi32|shell32|advapi32|msvcrt)\.dll$' || true)
[ -z "$others" ] || { echo "The program needs $others, which should be inside." >&2; exit 1; }
