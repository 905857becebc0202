#!/bin/sh
# Gets the decoder of Basis Universal, by Binomial under the Apache licence, into build/basisu: with it, candela reads
# the KTX 2 textures of KHR_texture_basisu. PyPI's source package opengl-basisu carries its files, of which one is mended
# here. The next configuration finds them; candela builds without them, too.
#   usage: sh cmake/basisu.sh
set -eu
cd "$(dirname "$0")/.."
version=0.1.0a2
archive=opengl_basisu-$version.tar.gz
sha256=7364dc63ac0e65f1d32306236514b834e06a22081d1019e8241d8f0a2a6cfeb5
folder=build/basisu
state="$sha256, mended"
[ "$(cat "$folder/complete" 2>/dev/null)" != "$state" ] || exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m pip download --quiet --disable-pip-version-check --no-deps --no-binary opengl-basisu --dest "$work" \
    "opengl-basisu==$version"
if ! echo "$sha256  $work/$archive" | sha256sum --check --status; then
    echo "$archive is not the file that candela was tested with: its SHA-256 differs from $sha256." >&2
    exit 1
fi
tar -xzf "$work/$archive" -C "$work"
rm -rf "$folder"
mkdir -p build
mv "$work/opengl_basisu-$version/vendor/basis_universal" "$folder"
mv "$work/opengl_basisu-$version/tests/fixtures" "$folder/"
# Of a Huffman code with one symbol, the decoder makes a tree without ends if the symbol has more than ten bits, and reads
# beyond it. The encoder gives such a symbol one bit.
header=$folder/transcoder/basisu_transcoder_internal.h
sed -i 's|(used_syms != 1U))$|((used_syms != 1U) \|\| (syms_using_codesize[1] != 1U)))  // Changed for candela.|' "$header"
if ! grep -q 'Changed for candela' "$header"; then
    echo "$header is not what candela mends." >&2
    exit 1
fi
{
    echo 'candela uses it with one line changed, which says so.'
    echo
    cat "$folder/NOTICE" "$folder/LICENSE"
    printf '\nThe decoder of Zstandard in it:\n\n'
    cat "$folder/zstd/LICENSE"
} >"$folder/copyright"
echo "$state" >"$folder/complete"
echo "Basis Universal is in $folder; configure and build again."
