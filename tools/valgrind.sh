#!/bin/sh
# Runs the programs under valgrind on a few small inputs, to find reads of uninitialised memory, which no sanitizer of
# gcc detects. (AddressSanitizer finds leaks.) Usage: tools/valgrind.sh
set -eu
cd "$(dirname "$0")/.."
folder=${PTRIANGLE_BUILD:-build}/debug
tools/build.sh debug >/dev/null
bin=$PWD/$folder/bin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp data/letter.poly data/section.poly data/nasty/*.poly data/regress/*.poly "$work"
cd "$work"

run() { # run PROGRAM WORD...: ignores all exit codes except valgrind's
    code=0
    valgrind --quiet --leak-check=no --error-exitcode=99 "$@" >log 2>&1 || code=$?
    [ "$code" -ne 99 ] || {
        echo "valgrind: $*"
        cat log
        exit 1
    }
}
# shellcheck disable=SC2016 # for the shells that run beside each other
printf '%s\n' *.poly | xargs -P "$(nproc 2>/dev/null || echo 2)" -I FILE sh -c '
    valgrind --quiet --leak-check=no --error-exitcode=99 "$1" -pcAaQ "$2" >"$2.log" 2>&1
    [ $? -ne 99 ] || { echo "valgrind: $*"; cat "$2.log"; exit 1; }' sh "$bin/triangle" FILE
run "$bin/triangle" -pq30a0.05enVC letter.poly
run "$bin/triangle" -rpq33a0.02D letter.1
run "$bin/triangle" -pq30aADvjo2 section.poly
run "$bin/trianglecheck" letter.2 --poly letter.poly
run env OMP_NUM_THREADS=2 PTRIANGLE_TEST_BLOCK=250 "$bin/ptriangle" -pq32a0.01 letter.poly
echo "valgrind: no fault"
