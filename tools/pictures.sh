#!/bin/sh
# Draw the pictures of the README again: a built-in sample, the plate that comes of it, the solid; a vase.
#
#     tools/pictures.sh JALI FOLDER
set -eu
jali=$1 out=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
for name in tree girih; do
    "$jali" sample "$name" --size 1000 -o "$out/$name.png" --force-overwrite --quiet
    "$jali" carve "$out/$name.png" --width 70 --corner 3 --quiet --force-overwrite --no-predict \
        -o "$out/$name-plate.png" --render "$out/$name-solid.png" --size 400
done
"$jali" analyse "$out/tree.png" --width 60 --force 20 --quiet --force-overwrite --map "$out/tree-stress-before.png" || test $? = 3
"$jali" carve "$out/tree.png" --width 60 --force 20 --quiet --no-predict -o "$work/strong.stl" --force-overwrite \
    --map "$out/tree-stress.png"
"$jali" carve "$out/girih.png" --surface vase:h=120 --repeat 3 --frame 0 --quiet --no-predict -o "$work/vase.stl"
"$jali" board --quiet --force-overwrite -o "$out/board.png"
"$jali" sample tree --size 300 -o "$work/tree.png" --quiet
"$jali" predict "$work/tree.png" --width 40 --quiet --force-overwrite -o "$out/tree-predicted.png"
for light in "" --lamp; do
    "$jali" render "$work/vase.stl" $light --view 0,1,-0.3 --size 560 --quiet --force-overwrite \
        -o "$out/vase${light#-}.png"
done
# The page, where there is a browser to draw it.
if [ -d web/node_modules/playwright-core ] && CHROMIUM=$(command -v chromium); then
    CHROMIUM=$CHROMIUM node web/picture.mjs "$jali" "$out/page.png"
fi
