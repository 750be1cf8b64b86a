#!/bin/sh
# `jali analyse --solver petsc` against the solver at home, on 1 and 2 processes, on a plate and on a cylinder: stresses
# and displacement to 1e-6, one process that writes and speaks, and failures of one process that end them all.
#
#     cli.sh JALI
set -eu
jali=$1
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cd "$work"
"$jali" sample rings -o rings.png --size 200

# Figures of the last round, a line each.
figures() {
    sed -n 's/^ *"\(max_stress_mpa\|raw_max_stress_mpa\|max_displacement_mm\|nodes\)": \([^,]*\),*$/\1 \2/p' "$1" | tail -4
}

compare() { # HOME.json OTHER.json
    figures "$1" >home
    figures "$2" >other
    paste home other | awk '
        { apart = $2 - $4; if (apart < 0) apart = -apart; if (apart > most * $2) most = apart / $2; lines++ }
        END { printf "  apart by %.1e\n", most; exit !(lines == 4 && most < 1e-6) }'
}

fails() { # EXIT_CODE WORDS COMMAND...
    wanted=$1 words=$2 code=0
    shift 2
    "$@" >out 2>err || code=$?
    if [ $code != "$wanted" ] || [ "$(grep -c '^jali: ' err)" != 1 ] || ! grep -q "^jali: .*$words" err; then
        echo "$*: exit $code, wanted $wanted and one sentence with \"$words\":"
        cat err
        exit 1
    fi
}

options="--width 20 --force 5 --limit 1000 --threads 1"
for surface in plate cylinder:r=15,h=40; do
    "$jali" analyse rings.png --surface $surface $options --quiet --json home.json --map home.vtu --force-overwrite
    for processes in 1 2; do
        echo "$surface, $processes processes"
        mpirun --oversubscribe -n $processes "$jali" analyse rings.png --surface $surface $options --solver petsc \
            --json - --map other.vtu --force-overwrite >other.json 2>words
        grep -q '"solver": "petsc"' other.json
        [ "$(grep -c '"version"' other.json)" = 1 ] && [ "$(grep -c 'largest stress' words)" = 1 ]
        [ "$(head -n 5 home.vtu)" = "$(head -n 5 other.vtu)" ]
        compare home.json other.json
    done
done

petsc="$jali analyse rings.png $options --solver petsc"
fails 1 "No such file" mpirun --oversubscribe -n 1 $petsc : -n 1 "$jali" analyse missing.png $options --solver petsc
fails 5 "memory limit" mpirun --oversubscribe -n 1 $petsc : -n 1 $petsc --max-memory 5
fails 1 "cannot write" mpirun --oversubscribe -n 2 $petsc --limit 0.001 --json missing/folder.json
fails 2 "did you mean" mpirun --oversubscribe -n 2 $petsc --forse 3
fails 2 "stdin" mpirun --oversubscribe -n 2 "$jali" analyse - $options --solver petsc
echo "failures of one process end all of them, with one sentence"
