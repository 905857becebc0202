#!/bin/sh
# Renders the gallery, small, by build/release/candela and by another program, or by the same on another driver; prints
# both hashes of each picture, and fails if they differ.
# usage: sh cmake/same_pictures.sh PROGRAM, or: sh cmake/same_pictures.sh env VARIABLE=VALUE... PROGRAM
set -eu
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# hash SCENE PROGRAM: prints that of its picture.
hash() {
    scene=$1
    shift
    "$@" render "$scene" --size 64x48 --spp 4 --quiet -o "$folder/picture.png" --report "$folder/report.json"
    sed -n 's/^.*"image_hash": "\([0-9a-f]*\)".*$/\1/p' "$folder/report.json"
}

for scene in scenes/*.json; do
    [ "$scene" != scenes/scene.schema.json ] || continue
    ours=$(hash "$scene" build/release/candela)
    others=$(hash "$scene" "$@")
    echo "$scene: $ours, $others"
    if [ -z "$ours" ] || [ "$ours" != "$others" ]; then
        echo "$scene: other bits by $*" >&2
        exit 1
    fi
done
