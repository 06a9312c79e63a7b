#!/bin/sh
# Runs the tests in a build that counts lines (preset coverage), and prints how many lines of triangle/ and sched/ they
# reach, file by file. Fails below 95% of all lines or 80% of a file. Needs gcovr (Debian: gcovr; PyPI: gcovr).
# Usage: tools/coverage.sh [CTEST_OPTION...]     default: -L 'full|ranks'
set -eu
cd "$(dirname "$0")/.."
folder=${PTRIANGLE_BUILD:-build}/coverage
least=80 # per cent of a file, since the rest is mostly failing reads and writes; 95 of all files
[ $# -gt 0 ] || set -- -L 'full|ranks'
command -v gcovr >/dev/null || {
    echo "coverage: gcovr is missing (Debian: apt-get install gcovr; or pip install gcovr)" >&2
    exit 2
}
tools/build.sh coverage
find "$folder" -name '*.gcda' -delete
# Clients outside the tree would have to link gcov's runtime as well, which crashes when memory runs out.
ctest --test-dir "$folder" --output-on-failure --no-tests=error --parallel "$(nproc 2>/dev/null || echo 2)" \
    -E '^(client|readme|clients_python|every_allocation_few)$' "$@"
# Programs that load HDF5 when needed contain a stub for it, which is used only in builds without HDF5.
gcovr --root . --filter triangle/ --filter sched/ --exclude triangle/hdf5/none.c --gcov-ignore-parse-errors "$folder" 2>/dev/null |
    tee "$folder/coverage.txt"
awk -v least="$least" '
    $1 == "TOTAL" { least = 95 }
    $4 ~ /%$/ { seen++; if ($4 + 0 < least) { print "coverage: " $1 " has " $4 ", below " least "%"; low++ } }
    END { if (!seen) print "coverage: nothing was counted"; exit low > 0 || !seen }' "$folder/coverage.txt"
