#!/bin/sh
# Builds and runs the tests; installs what is missing first.
# Usage: tools/test.sh [PRESET [CTEST_OPTION...]]     default: debug, all tests
#   tools/test.sh asan -L full
set -eu
cd "$(dirname "$0")/.."
preset=${1:-debug}
[ $# -eq 0 ] || shift
tools/setup.sh tests
tools/build.sh "$preset"
ctest --test-dir "${PTRIANGLE_BUILD:-build}/$preset" --output-on-failure --no-tests=error \
    --parallel "$(nproc 2>/dev/null || echo 2)" "$@"
