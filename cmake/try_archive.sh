#!/bin/sh
# Makes the portable archive, twice, which must give the same bytes, and renders from it in a root folder that holds only
# glibc, the C++ run-time library and lavapipe; prints which versions of the first two it needs, and fails if they are
# newer than Debian 12's, or if the licence of a library in it is missing. Needs a build with the preset `release`, and
# root.
#   usage: sh cmake/try_archive.sh [again]     again: also builds all of it in another folder, to the same bytes
set -eu
cd "$(dirname "$0")/.."

GLIBC=2.36
GLIBCXX=3.4.30  # GCC 12

# The archive has no `candela view`: its window needs the system's own libraries, which no archive can bring along.
build=build/release
if ldd "$build/candela" | grep -q libglfw; then
    build=build/archive
    cmake --preset release -B "$build" -DCANDELA_VIEW=OFF
    cmake --build "$build"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || echo 0)
export SOURCE_DATE_EPOCH
# pack BUILD FOLDER: makes the archive of a build.
pack() {
    cpack --config "$1/CPackConfig.cmake" -B "$2" >"$folder/cpack.log" || { cat "$folder/cpack.log"; exit 1; }
}
pack "$build" "$folder/one"
pack "$build" "$folder/two"
archive=$(ls "$folder"/one/candela-*.tar.gz)
cmp "$archive" "$folder"/two/candela-*.tar.gz
if [ "${1:-}" = again ]; then
    mkdir "$folder/sources"
    git ls-files -z | xargs -0 cp --parents -t "$folder/sources"
    [ ! -d build/basisu ] || cp -r --parents build/basisu "$folder/sources"
    cmake -S "$folder/sources" --preset release -DCANDELA_VIEW=OFF >"$folder/build.log"
    cmake --build "$folder/sources/build/release" >>"$folder/build.log" || { tail -n 40 "$folder/build.log"; exit 1; }
    pack "$folder/sources/build/release" "$folder/three"
    cmp "$archive" "$folder"/three/candela-*.tar.gz
    echo "built again in another folder: the same bytes"
fi
root=$folder/root
mkdir -p "$root/opt" "$root/tmp" "$root/proc"
tar -C "$root/opt" -xzf "$archive"
home=$(cd "$root" && ls -d opt/candela-*)

# Every library is of a package that the SBOM names, with its licence.
for library in "$root/$home"/lib/lib*.so*; do
    package=$(dpkg-query -S "*/$(basename "$library")" | head -n 1 | cut -d : -f 1)
    grep -qx "PackageName: $package" "$root/$home/share/doc/candela/sbom.spdx"
    test -s "$root/$home/share/doc/candela/licenses/$package.txt"
done

# newest NAME: prints the highest version NAME_... that the program and its libraries need.
newest() {
    objdump -T "$root/$home/bin/candela" "$root/$home"/lib/lib*.so* |
        grep -o "[( ]$1_[0-9.]*" | sed "s/.*_//" | sort -uV | tail -n 1
}
# check_newest NAME VERSION: fails if they need a newer one.
check_newest() {
    found=$(newest "$1")
    echo "The archive asks for $1 $found; $2 is allowed"
    [ "$(printf '%s\n%s\n' "$found" "$2" | sort -V | tail -n 1)" = "$2" ]
}
check_newest GLIBC "$GLIBC"
check_newest GLIBCXX "$GLIBCXX"

# Nothing else builds a program without a window. (It fails, so that grep's result decides.)
"$build/candela" view scenes/cornell-box.json 2>&1 | grep -F 'view: this program was built without a window'

# bring FILE...: copies files, and the shared libraries that they need, to the same places in the root folder.
bring() {
    for file in "$@"; do
        cp -L --parents "$file" "$root"
        ldd "$file" 2>/dev/null | grep -o '/[^ ]*' | while read -r library; do cp -L --parents "$library" "$root"; done
    done
}
set -- /usr/share/vulkan/icd.d/lvp_icd*.json
manifest=$1
driver=$(grep -o '"library_path": *"[^"]*"' "$manifest" | cut -d '"' -f 4)
bring "$manifest" "$driver" "$(ldconfig -p | grep -o '/.*/libvulkan\.so\.1$' | head -n 1)"
# The program's own libraries are in the archive; these are the system's.
for library in libc.so.6 libm.so.6 libstdc++.so.6 libgcc_s.so.1; do
    bring "$(ldconfig -p | grep -o "/.*/$library\$" | head -n 1)"
done

# The dynamic loader asks /proc where the program is.
# shellcheck disable=SC2016  # The inner shell replaces these.
unshare --mount sh -c 'mount -t proc proc "$1/proc" && exec chroot "$@"' sh \
    "$root" "/$home/bin/candela" render "/$home/share/candela/scenes/cornell-box.json" \
    --spp 1 --size 64x64 -o /tmp/box.png -o /tmp/box.exr
test -s "$root/tmp/box.png"
test -s "$root/tmp/box.exr"
echo "$(basename "$archive"), $(du -h "$archive" | cut -f 1), rendered the Cornell box in a root folder of its own"
