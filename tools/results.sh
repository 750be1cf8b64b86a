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
    printf '\n## Surfaces\n\n'
    printf 'The paper'"'"'s three objects with pictures of ours, and the dense pictures; walls of 2 mm, two threads, prediction and report\n'
    printf 'left out (`build/release/bench/surfaces DATA_FOLDER --threads 2`). s: from the files to the bytes of a 3MF, median of three. Added a vertex:\n'
    printf 'triangles less the two skins'"'"' own, for each vertex of a contour (one on either skin). The same cuts as booleans by native\n'
    printf 'Manifold took 10 s (dense through a tube or the bunny) and 106 to 110 s (scenery); here that is "trace, carve".\n\n'
    "$bench/surfaces" "${data%/images}" --runs 3 --threads 2
} >"$kept.page"
mv "$kept.page" "$page"
