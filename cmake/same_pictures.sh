#!/bin/sh
# Renders the gallery, small, by build/release/candela and by another program, and fails if any picture has other bits.
# usage: sh cmake/same_pictures.sh PROGRAM
set -eu
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# hash PROGRAM SCENE: prints that of its picture.
hash() {
    "$1" render "$2" --size 64x48 --spp 4 --quiet -o "$folder/picture.png" --report "$folder/report.json"
    sed -n 's/^.*"image_hash": "\([0-9a-f]*\)".*$/\1/p' "$folder/report.json"
}

for scene in scenes/*.json; do
    [ "$scene" != scenes/scene.schema.json ] || continue
    ours=$(hash build/release/candela "$scene")
    others=$(hash "$1" "$scene")
    echo "$scene: $ours, $others"
    if [ -z "$ours" ] || [ "$ours" != "$others" ]; then
        echo "$scene: other bits by $1" >&2
        exit 1
    fi
done
