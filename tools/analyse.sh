#!/bin/sh
# Static analysis of triangle/, sched/ and drivers/: cppcheck (tools/cppcheck.txt lists accepted findings and the
# reasons) and clang-tidy (.clang-tidy). Exit code 1 if there is a finding. clang-tidy skips files that its build does
# not compile: poisson.c, since PETSc uses a different MPI, and the system interface of Windows.
# Usage: tools/analyse.sh
set -eu
cd "$(dirname "$0")/.."
folder=${PTRIANGLE_BUILD:-build}/clang-werror
jobs=$(nproc 2>/dev/null || echo 2)
for program in cppcheck clang-tidy; do
    command -v $program >/dev/null || {
        echo "analyse: $program is missing (Debian: apt-get install $program)" >&2
        exit 2
    }
done
cppcheck --std=c11 --enable=warning,performance,portability --inline-suppr --suppressions-list=tools/cppcheck.txt \
    --error-exitcode=1 --quiet -j "$jobs" -I . -I include -D_POSIX_C_SOURCE=200809L \
    -DH5E_BEGIN_TRY= -DH5E_END_TRY= \
    --template='{file}:{line}: {severity}: {message} [{id}]' triangle/*/*.c sched/*/*.c drivers/*.c drivers/*/*.c
cmake --preset clang-werror -B "$folder" >/dev/null # writes the commands that compile each file
printf '%s\n' triangle/*/*.c sched/*/*.c drivers/*.c drivers/*/*.c | grep -vE '(report|geojson)_none\.c|system_windows' |
    xargs -n 4 -P "$jobs" clang-tidy -p "$folder" --quiet 2>/dev/null
echo "analyse: no finding"
