#!/bin/sh
# Builds and runs tests; installs missing packages first.
# Usage: tools/test.sh [PRESET [CTEST_OPTION...]]
#   tools/test.sh                       debug, the fast tests: at most three minutes on two cores including the build;
#                                       lists at the end the tests that were not run
#   tools/test.sh debug                 all tests of that build
#   tools/test.sh asan -L full          the tests with a label
set -eu
cd "$(dirname "$0")/.."
chosen=$#
preset=${1:-debug}
[ $# -eq 0 ] || shift
[ "$chosen" -ne 0 ] || set -- -L fast
folder=${PTRIANGLE_BUILD:-build}/$preset
tools/setup.sh tests
tools/build.sh "$preset"
code=0
ctest --test-dir "$folder" --output-on-failure --no-tests=error --parallel "$(nproc 2>/dev/null || echo 2)" "$@" || code=$?

slower() { ctest --test-dir "$folder" -N -LE fast "$@" | sed -n 's/^Total Tests: //p'; }
if [ "$chosen" -eq 0 ]; then
    cmake "$folder" | sed -n 's/^-- no /test.sh: not built, so not tested: no /p'
    echo "test.sh: not run: $(slower) slower tests: all cases of some of the above, random figures, failing allocations,"
    echo "test.sh:     clients of the installed package, Triangle and others from PyPI. They take ten minutes:"
    echo "test.sh:         tools/test.sh debug -LE fast"
    echo "test.sh: not run: sanitizers, clang, static analysis, other processors. They install more, and take half an hour:"
    echo "test.sh:         .ci/run"
fi
exit $code
