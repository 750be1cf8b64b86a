#!/bin/sh
# Draw the built-in pictures, carve some of them in every format, and show what came out.
#
#     tools/demo.sh JALI FOLDER
set -eu
jali=$1 out=$2
pictures="girih tree mask lettering sunflower"
mkdir -p "$out"

# The first number under a key of a figures file.
figure() { sed -n "s/^ *\"$2\": \([0-9.]*\),*\$/\1/p" "$1" | head -n 1; }
percent() { awk -v rate="$(figure "$1" "$2")" 'BEGIN { printf "%.1f %%", 100 * rate }'; }
# The row of a picture in the page.
row() {
    cat <<ROW
<figure><figcaption>$1: <span>$2</span></figcaption>
<img src="$1.png" alt="$1, the picture"><img src="$1-plate.png" alt="$1, the plate">
<p><a href="$1.html">report</a> <a href="$1.3mf">3mf</a> <a href="$1.stl">stl</a> <a href="$1.svg">svg</a>
<a href="$1.json">figures</a></p></figure>
ROW
}

cat > "$out/index.html" <<'PAGE'
<!doctype html><meta charset="utf-8"><title>jali: demo</title>
<meta name="viewport" content="width=device-width">
<style>body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;background:#f4efe6;color:#2b2420}
figure{margin:2rem 0}img{width:calc(50% - .5rem);margin-right:.5rem;box-shadow:0 1px 6px #0004}
figcaption{font-weight:600}figcaption span{font-weight:400}a{color:#8a3b12;margin-right:1rem}</style>
<h1>Pictures, and the plates they became</h1>
<p>Left the picture, right the plate: white is solid, black is cut through, and all of it holds together.</p>
PAGE

echo
echo "  A jali is a pierced screen: a picture carved right through stone. Carving five, 70 mm wide:"
echo
printf '  %-11s %-13s %-9s %-28s %s\n' picture 'loose parts' bridges 'wrong when printed' 'the solid'
printf '  %-11s %-13s %-9s %s\n' '' '' laid 'joined only -> jali'
for name in $pictures; do
    "$jali" sample "$name" -o "$out/$name.png" --force-overwrite --quiet
    # Ends this script (exit 3) when a promise is not kept, so what the table says is true of what it shows.
    "$jali" carve "$out/$name.png" --force-overwrite --quiet --hole 4 --corner 3 \
        -o "$out/$name.3mf" -o "$out/$name.stl" -o "$out/$name.svg" -o "$out/$name-plate.png" \
        --report "$out/$name.html" --json "$out/$name.json"
    printf '  %-11s %-13s %-9s %-28s %s triangles, closed, one piece\n' "$name" \
        "$(figure "$out/$name.json" white_components)" "$(figure "$out/$name.json" bridges)" \
        "$(percent "$out/$name.json" error_rate_connected) -> $(percent "$out/$name.json" error_rate_result)" \
        "$(figure "$out/$name.json" triangles)"
    row "$name" "$("$jali" list samples | sed -n "s/^$name  *//p")" >> "$out/index.html"
done

echo
echo "  And through surfaces, the widths true in mm on them:"
echo
printf '  %-26s %-34s %-14s %s\n' what surface 'stretched' 'the solid'
# carve_on NAME WIDTH SURFACE [OPTION ...]
carve_on() {
    name=$1 width=$2 surface=$3
    shift 3
    "$jali" carve "$out/$name.png" --surface "$surface" --width "$width" --force-overwrite --quiet \
        -o "$out/$name-object.3mf" --report "$out/$name-object.html" --json "$out/$name-object.json" "$@"
    printf '  %-26s %-34s %-14s %s triangles, closed, one piece\n' "$name, $width mm" "$surface $*" \
        "$(awk '/"stretch"/ { getline a; getline b; gsub(/[ ,]/, "", a); gsub(/[ ,]/, "", b); printf "%.2f .. %.2f", a, b }' \
            "$out/$name-object.json")" "$(figure "$out/$name-object.json" triangles)"
    cat >> "$out/index.html" <<ROW
<p>$name on $surface: <a href="$name-object.html">report</a> <a href="$name-object.3mf">3mf</a></p>
ROW
}
carve_on girih 50 cylinder:r=32,h=70 --repeat 3
carve_on tree 60 vase:h=150
carve_on mask 34 sphere:r=30 --place project

echo
echo "  And under a load, 20 N pressed against it, connectors where they relieve it most:"
echo
"$jali" carve "$out/tree.png" --width 60 --force 20 --force-overwrite -o "$out/tree-strong.3mf" \
    --json "$out/tree-strong.json" --report "$out/tree-strong.html" --map "$out/tree-stress.png" 2>&1 |
    sed -n '/stress\|connector/s/^/    /p'
cat >> "$out/index.html" <<ROW
<figure><figcaption>tree, under 20 N: <span>stress with connectors</span></figcaption><img src="tree-stress.png" alt="stress">
<p><a href="tree-strong.html">report</a> <a href="tree-strong.3mf">3mf</a></p></figure>
ROW

echo
echo "  And for your printer: the board to print and scan; edges moved for one whose voids print narrower still:"
echo
"$jali" board --force-overwrite --quiet -o "$out/board.3mf" -o "$out/board.png"
printf '    board.3mf: print it flat, scan it, then: jali calibrate --scan SCAN -o mine.json\n'
cat > "$out/narrow-voids.json" <<'PROFILE'
{"jali_printer": 1, "name": "narrow-voids", "inherits": "hori-z500",
 "phi_e_void_mm": {"value": 0.2, "source": "chosen, for the demo"}}
PROFILE
"$jali" carve "$out/mask.png" --width 50 --printer "$out/narrow-voids.json" --nudge 3 --force-overwrite \
    -o "$out/mask-nudged.3mf" 2>&1 | sed -n '/nudged\|predicted/s/^/    /p'
cat >> "$out/index.html" <<ROW
<figure><figcaption>board: <span>bars, holes and pins of stepped widths, to calibrate a printer</span></figcaption>
<img src="board.png" alt="reference board"><p><a href="board.3mf">3mf</a></p></figure>
ROW

echo
echo "  jali check, on the last plate as a slicer would read it:"
"$jali" check "$out/sunflower.3mf" 2>&1 | sed 's/^/    /'
here=$(cd "$out" && pwd)
cat <<END

  $out/index.html       all of them, before and after: open this first
  $out/NAME.3mf         the solid, ready for a slicer (millimetres, with a small picture of itself)
  $out/NAME.stl         the same for older programs
  $out/NAME.svg         the outlines, for a laser cutter
  $out/NAME.html        the report: bridges, details, conflicts, and where the print will differ
  $out/NAME.json        the figures, for programs
  $out/NAME-plate.png   what is carved; $out/NAME.png is the picture it came from

  Look:   file://$here/index.html
  Yours:  $jali carve PICTURE -o PLATE.3mf --width 70
END
