#!/bin/sh
# Write docs/results.md anew: 24 runs over the pictures in DATA, judged twice.
#
#     tools/results.sh BENCH_FOLDER [DATA]
set -eu
bench=$1
data=${2:-../shared/data/images}
page=docs/results.md
kept=$(mktemp)
trap 'rm -f "$kept"' EXIT
# Everything up to the first table is written by hand.
sed '/^<!-- tables -->$/q' "$page" >"$kept"
{
    cat "$kept"
    echo
    "$bench/results" "$data"
    printf '\n## Widths, by an independent judge\n\n'
    printf 'Exact distances, discs of phi_s and phi_v less one working pixel (`build/release/bench/widths`).\n\n'
    "$bench/widths" "$data"
    printf '\n## Contours: how few points, how true\n\n'
    printf 'Of the picture without its plate, the default way (`build/release/bench/contours`). Outline: the length of the\n'
    printf 'smooth curve. Deviation: the largest distance of that curve, traced to one lattice unit, from the contour.\n\n'
    "$bench/contours" "$data"
} >"$kept.page"
mv "$kept.page" "$page"
