#!/bin/sh
# What others say of our plates and surfaces: admesh, PrusaSlicer and manifold-3d beside `jali check`, CalculiX
# beside the analysis.
#
#     tools/judge.sh JALI WORK_FOLDER [DATA_FOLDER]
#
# Each judge has to find the file closed and manifold, in one part, with the volume that jali gives to 1e-4;
# manifold-3d the genus, too. Carved are the built-in samples at 70 and 40 mm and on a shape of each kind and, when the
# folder is there, every picture in it, the paper's three objects, which PrusaSlicer has to slice without a warning,
# and every mesh: carved so that all judges agree, or refused with a sentence.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
jali=$1 work=$2 data=${3:-$here/../../shared/data}
manifold_version=3.2.1
mkdir -p "$work/objects"
[ -d "$work/node_modules/manifold-3d" ] ||
    npm install --silent --no-fund --no-audit --prefix "$work" "manifold-3d@$manifold_version" >/dev/null
cp "$here/judge.mjs" "$work/"

key() { sed -n "s/^ *\"$2\": \([-0-9.a-z]*\),*\$/\1/p" "$1" | head -n 1; }
# "yes" when a volume agrees with another to 1e-4 and all other answers are as they should be.
agrees() { awk -v a="$1" -v b="$2" 'BEGIN { d = a - b; if (d < 0) d = -d; exit !(b > 0 && d <= 1e-4 * b) }'; }

ask_admesh() {
    admesh "$1" >"$work/admesh.txt" 2>&1 || return 1
    awk '/Number of parts/ { parts = $5 } /Total disconnected facets/ { open = $5; seen = 1 }
         /Degenerate facets|Facets reversed|Backwards edges/ { bad += $4 }
         END { exit !(seen && open == 0 && parts == 1 && bad == 0) }' "$work/admesh.txt" || return 1
    agrees "$(sed -n 's/.*Volume *: *\([-0-9.e+]*\).*/\1/p' "$work/admesh.txt")" "$2"
}
ask_prusa() {
    prusa-slicer --info "$1" >"$work/prusa.txt" 2>/dev/null || return 1
    grep -q '^manifold = yes' "$work/prusa.txt" && grep -q '^number_of_parts *= *1$' "$work/prusa.txt" &&
        ! grep -q '^\(open_edges\|facets_reversed\|backwards_edges\)' "$work/prusa.txt" &&
        agrees "$(sed -n 's/^volume = //p' "$work/prusa.txt")" "$2"
}
ask_manifold() {
    node "$work/judge.mjs" "$1" >"$work/manifold.txt" 2>&1 || return 1
    [ "$(sed -n 's/^genus //p' "$work/manifold.txt")" = "$3" ] &&
        agrees "$(sed -n 's/^volume //p' "$work/manifold.txt")" "$2"
}
# Large objects need a large bed; what the slicer finds wrong it says on either stream.
ask_slicer() {
    prusa-slicer --export-gcode --bed-shape 0x0,500x0,500x500,0x500 --max-print-height 500 --center 250,250 \
        --support-material --output "$work/objects/sliced.gcode" "$1" >"$work/slicer.txt" 2>&1 || return 1
    [ -s "$work/objects/sliced.gcode" ] && ! grep -qi 'warning\|repair\|error\|empty layer' "$work/slicer.txt"
}
verdict() { if "$@"; then echo agrees; else echo DIFFERS; fi; }

passed=0 failed=0 refused=0
# judge NAME PICTURE WIDTH [OPTION ...]: one row of the table.
judge() {
    name=$1 picture=$2 width=$3 object=$work/objects/object
    shift 3
    if ! "$jali" carve "$picture" --width "$width" --no-predict --quiet --force-overwrite -o "$object.stl" \
        -o "$object.3mf" "$@" 2>"$work/said.txt"; then
        code=$?
        if [ "${may_refuse:-no}" = yes ] && ! grep -q 'not kept' "$work/said.txt"; then
            refused=$((refused + 1))
            printf '%-24s %5s  refused: %s\n' "$name" "$width" "$(tail -n 1 "$work/said.txt" | cut -c 7-)"
        else
            failed=$((failed + 1))
            printf '%-24s %5s  jali itself says no: %s\n' "$name" "$width" "$(tail -n 1 "$work/said.txt")"
        fi
        return
    fi
    "$jali" check "$object.3mf" --quiet --force-overwrite --json "$object.json" || failed=$((failed + 1))
    volume=$(key "$object.json" volume_mm3 | cut -c 1-12)
    by_admesh=$(verdict ask_admesh "$object.stl" "$volume")
    by_prusa=$(verdict ask_prusa "$object.3mf" "$volume")
    by_manifold=$(verdict ask_manifold "$object.stl" "$volume" "$(key "$object.json" genus)")
    sliced=
    [ "${slice:-no}" = no ] || sliced=$(verdict ask_slicer "$object.3mf")
    for word in $by_admesh $by_prusa $by_manifold $sliced; do
        if [ "$word" = agrees ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
    done
    printf '%-24s %5s %9s %12s %6s %9s %9s %9s %s\n' "$name" "$width" "$(key "$object.json" triangles)" "$volume" \
        "$(key "$object.json" genus)" "$by_admesh" "$by_prusa" "$by_manifold" "${sliced:+sliced: $sliced}"
    rm -f "$object.stl" "$object.3mf"
}

printf '%-24s %5s %9s %12s %6s %9s %9s %9s\n' what mm triangles mm3 genus admesh prusa manifold
for name in $("$jali" list samples | awk '{ print $1 }'); do
    "$jali" sample "$name" -o "$work/$name.png" --force-overwrite --quiet
    for width in 70 40; do judge "$name" "$work/$name.png" "$width"; done
done
judge "girih on a tube" "$work/girih.png" 60 --surface cylinder:r=30,h=80
judge "girih around a tube" "$work/girih.png" 60 --surface cylinder:r=30,h=80 --repeat 3
judge "tree on a cone" "$work/tree.png" 50 --surface cone:r=45,top=20,h=90,floor=yes
judge "mask on a sphere" "$work/mask.png" 36 --surface sphere:r=30 --place project
judge "lettering on a vase" "$work/lettering.png" 60 --surface vase:h=150
judge "rings, a perspective" "$work/rings.png" 30 --surface vase:bottle,h=150 --place project \
    --camera from=60,-300,200,to=0,0,70
judge "spiral, backed by a film" "$work/spiral.png" 50 --surface cylinder:r=40,h=70 --backing 0.6
if [ -d "$data/images" ]; then
    for picture in "$data"/images/*.png; do
        case $picture in */photo-*) continue ;; esac
        # 70 and 40 mm for 1000 px; the width is bytes 17 to 20 of a PNG.
        px=$(od -An -tu1 -j16 -N4 "$picture" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }')
        for mm in 70 40; do
            judge "$(basename "$picture" .png)" "$picture" "$(awk -v px="$px" -v mm="$mm" 'BEGIN { print px * mm / 1000 }')"
        done
    done
fi
if [ -d "$data/meshes" ]; then
    slice=yes
    judge "paper: portrait, vase" "$data/images/portrait.png" 124 --surface vase:h=326,r=105
    judge "paper: plum, bunny" "$data/images/plum.png" 85 --surface "$data/meshes/bunny.obj:up=y,scale=145.2"
    judge "paper: monroe, cylinder" "$data/images/monroe-like.png" 70 --surface cylinder:r=35.5,h=74
    slice=no
    may_refuse=yes
    for mesh in "$data"/meshes/*; do
        options=height=120 width=30 view=
        case $mesh in
        *bunny* | *spot* | *teapot*) options=up=y,$options ;;
        *vase.obj) options=up=-y,$options ;;
        *plane.off) options=up=y,$options ;;
        *cylinder.stl) width=20 ;;
        *frog*) options=scale=2 view="--dir 0,0,-1" ;;
        *holes*) options=unit=m view="--dir 0,0,-1" ;;
        esac
        judge "$(basename "$mesh")" "$data/images/lion.png" "$width" --surface "$mesh:$options" $view
    done
fi
# What the shell analysis says of a lattice and of a sample, against CalculiX's solids (3 % and 5 %).
solids=$(dirname "$jali")/bench/solids
if command -v ccx >/dev/null && [ -x "$solids" ]; then
    verdict_of_solids() { if "$solids" --judge --across 4 "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi; }
    for thickness in 0.06 0.3 1; do verdict_of_solids --thickness "$thickness" --solid-across 2; done
    verdict_of_solids --picture girih --width 20 --phi-v 0.5 --solid-across 2
fi
echo "$passed passed, $failed failed, $refused refused with a sentence"
[ "$failed" = 0 ]
