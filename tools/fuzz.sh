#!/bin/sh
# Builds the fuzz targets (preset fuzz) and runs each for the given number of seconds, as many at a time as there are
# processors. Findings are written to build/fuzz/found.
# Usage: tools/fuzz.sh [SECONDS [TARGET...]]     default: 60, all of read sizes triangulate mesh schedule
# To repeat one finding: build/fuzz/bin/fuzz_TARGET build/fuzz/found/TARGET-crash-..
# PTRIANGLE_FUZZ_IGNORE="area,angle" ignores kinds of faults of the mesh (see tests/fuzz/fuzz_mesh.c).
# PTRIANGLE_FUZZ_SEED=N makes runs repeatable, so that a failure is due to the change. Default: a new seed each time.
# If the compiler has no libFuzzer, the script says so and succeeds.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-60}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- read sizes triangulate mesh schedule
folder=${PTRIANGLE_BUILD:-build}/fuzz

probe=$(mktemp -d)
printf '#include <stddef.h>\n#include <stdint.h>\n%s\n' \
    'int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return data && size > 9; }' >"$probe/probe.c"
if ! clang -fsanitize=fuzzer,address,undefined "$probe/probe.c" -o "$probe/probe" 2>/dev/null; then
    rm -rf "$probe"
    echo "fuzz: skipped: clang has no libFuzzer here (Debian: libclang-rt-14-dev, or that of another version)"
    exit 0
fi
rm -rf "$probe"

cmake --preset fuzz -B "$folder" >/dev/null
# shellcheck disable=SC2046 # one word a target
cmake --build "$folder" --parallel "$(nproc 2>/dev/null || echo 2)" --target $(printf 'fuzz_%s ' "$@")
tests/fuzz/seeds.sh data "$folder/corpus"
mkdir -p "$folder/found"
rm -f "$folder/failed"

fuzz() { # fuzz TARGET
    target=$1
    dictionary=""
    [ ! -f "tests/fuzz/$target.dict" ] || dictionary="-dict=tests/fuzz/$target.dict"
    log=$folder/$target.log
    # shellcheck disable=SC2086 # one word or none
    if OMP_NUM_THREADS=3 "$folder/bin/fuzz_$target" -max_total_time="$seconds" \
        -seed="${PTRIANGLE_FUZZ_SEED:-0}" -timeout=120 \
        -rss_limit_mb=4096 -max_len=4096 -artifact_prefix="$folder/found/$target-" $dictionary "$folder/corpus/$target" \
        >"$log" 2>&1; then
        echo "fuzz: $target: $(tail -n 1 "$log")"
    else
        : >"$folder/failed"
        echo "fuzz: $target: FAILED, see $log"
        grep -E '^fuzz_|ERROR|runtime error|Assertion|SUMMARY|Test unit' "$log" | head -n 6 || true
    fi
}

jobs=$(nproc 2>/dev/null || echo 2)
started=0
for target; do
    fuzz "$target" &
    started=$((started + 1))
    [ $((started % jobs)) -ne 0 ] || wait
done
wait
[ ! -e "$folder/failed" ]
