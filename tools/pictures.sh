#!/bin/sh
# Draw the pictures of the README again: a built-in sample, the plate that comes of it, the solid.
#
#     tools/pictures.sh JALI FOLDER    (needs unzip)
set -eu
jali=$1 out=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
for name in tree girih; do
    "$jali" sample "$name" --size 1000 -o "$out/$name.png" --force-overwrite --quiet
    "$jali" carve "$out/$name.png" --width 70 --corner 3 --quiet --force-overwrite \
        -o "$out/$name-plate.png" -o "$work/$name.3mf"
    unzip -q -p "$work/$name.3mf" Metadata/thumbnail.png >"$out/$name-solid.png"
done
