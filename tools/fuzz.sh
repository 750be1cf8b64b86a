#!/bin/sh
# Run every fuzzer for a while, each on a corpus of its own that is kept from run to run.
#
#     tools/fuzz.sh BUILD_FOLDER CORPUS_FOLDER SECONDS
set -eu
build=$1 corpus=$2 seconds=$3
passed=0 failed=0
mkdir -p "$corpus"

# A few small files that a blind search would need long to find.
seeds=$corpus/seeds
mkdir -p "$seeds"
for name in rings checkerboard lettering; do
    "$build/jali" sample "$name" --size 48 -o "$seeds/$name.png" --force-overwrite --quiet
    "$build/jali" carve "$seeds/$name.png" --width 4 --pixel 0.1 --no-predict --quiet --force-overwrite \
        -o "$seeds/$name.stl" -o "$seeds/$name.3mf" || [ $? = 3 ]
done

for fuzzer in "$build"/fuzz/fuzz_*; do
    if [ ! -f "$fuzzer" ] || [ ! -x "$fuzzer" ]; then continue; fi
    name=${fuzzer##*/}
    mkdir -p "$corpus/$name"
    for seed in "$seeds"/*."${name#fuzz_}" "${0%/*}/../fuzz/corpus/${name#fuzz_}"/*; do
        [ ! -e "$seed" ] || cp "$seed" "$corpus/$name/"
    done
    if "$fuzzer" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 -artifact_prefix="$corpus/$name-" \
        "$corpus/$name" >"$corpus/$name.log" 2>&1; then
        passed=$((passed + 1))
        printf '%-14s %s\n' "$name" "$(grep '^Done' "$corpus/$name.log")"
    else
        failed=$((failed + 1))
        printf '%-14s FAILED, see %s\n' "$name" "$corpus/$name.log"
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
