#!/bin/sh
# What others say of our plates: admesh, PrusaSlicer and manifold-3d beside `jali check`.
#
#     tools/judge.sh JALI WORK_FOLDER [PICTURES_FOLDER]
#
# Each judge has to find the file closed and manifold, in one part, with the volume that jali gives to 1e-4. Carved
# are the built-in samples at 70 and 40 mm and, when the folder is there, every picture in it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
jali=$1 work=$2 pictures=${3:-$here/../../shared/data/images}
manifold_version=3.2.1
mkdir -p "$work/plates"
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
    agrees "$(sed -n 's/^volume //p' "$work/manifold.txt")" "$2"
}
verdict() { if "$@"; then echo agrees; else echo DIFFERS; fi; }

passed=0 failed=0
# judge NAME PICTURE WIDTH: one row of the table.
judge() {
    plate=$work/plates/$1-$3
    if ! "$jali" carve "$2" --width "$3" --no-predict --quiet --force-overwrite -o "$plate.stl" -o "$plate.3mf" ||
        ! "$jali" check "$plate.3mf" --quiet --force-overwrite --json "$plate.json"; then
        failed=$((failed + 1))
        printf '%-16s %5s  jali itself says no\n' "$1" "$3"
        return
    fi
    volume=$(key "$plate.json" volume_mm3 | cut -c 1-12)
    by_admesh=$(verdict ask_admesh "$plate.stl" "$volume")
    by_prusa=$(verdict ask_prusa "$plate.3mf" "$volume")
    by_manifold=$(verdict ask_manifold "$plate.stl" "$volume")
    for word in $by_admesh $by_prusa $by_manifold; do
        if [ "$word" = agrees ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
    done
    printf '%-16s %5s %9s %12s %9s %9s %9s\n' "$1" "$3" "$(key "$plate.json" triangles)" "$volume" \
        "$by_admesh" "$by_prusa" "$by_manifold"
    rm -f "$plate.stl" "$plate.3mf"
}

printf '%-16s %5s %9s %12s %9s %9s %9s\n' picture mm triangles mm3 admesh prusa manifold
for name in $("$jali" list samples | awk '{ print $1 }'); do
    "$jali" sample "$name" -o "$work/$name.png" --force-overwrite --quiet
    for width in 70 40; do judge "$name" "$work/$name.png" "$width"; done
done
if [ -d "$pictures" ]; then
    for picture in "$pictures"/*.png; do
        name=$(basename "$picture" .png)
        # 70 and 40 mm for 1000 px; the width is bytes 17 to 20 of a PNG.
        px=$(od -An -tu1 -j16 -N4 "$picture" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }')
        for mm in 70 40; do judge "$name" "$picture" "$(awk -v px="$px" -v mm="$mm" 'BEGIN { print px * mm / 1000 }')"; done
    done
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
