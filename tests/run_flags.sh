#!/bin/sh
# Exact arithmetic does not depend on compiler options. Options that would break it are refused when a file is compiled
# by hand, and overridden by the options of CMake.
# Usage: run_flags.sh SOURCE_ROOT WORK_DIR CMAKE C_COMPILER CXX_COMPILER
set -u
root=$1
work=$2
cmake=$3
cc=$4
cxx=$5
faults=0

fault() {
    echo "flags: $*"
    faults=$((faults + 1))
}

rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2

# --- by hand
compiles() { # compiles FILE OPTION...
    file=$1
    shift
    "$cc" -std=c11 -D_POSIX_C_SOURCE=200809L -I "$root" -I "$root/include" "$@" -c "$root/triangle/$file" -o by_hand.o 2>by_hand.log
}
evaluation() { "$cc" "$@" -dM -E -x c /dev/null 2>/dev/null | awk '$2 == "__FLT_EVAL_METHOD__" { print $3 }'; }

compiles geometry/predicates.c -O2 || fault "predicates.c does not compile: $(cat by_hand.log)"
for option in -ffast-math -Ofast -ffinite-math-only; do
    compiles geometry/predicates.c -O2 $option && fault "predicates.c compiles with $option"
    grep -q 'fast-math' by_hand.log || fault "$option is refused for another reason: $(head -n 3 by_hand.log)"
done
# The x87, if the compiler supports it. The evaluation method 1 of s390x compilers is acceptable.
if [ "$(evaluation -mfpmath=387)" = 2 ]; then
    compiles geometry/predicates.c -mfpmath=387 && fault "predicates.c compiles for the x87"
    grep -q 'rounded to double' by_hand.log || fault "the x87 is refused for another reason: $(head -n 3 by_hand.log)"
fi
for method in 0 1 2; do
    cat >arithmetic.c <<EOF
#include <float.h>
#undef FLT_EVAL_METHOD
#define FLT_EVAL_METHOD $method
#include "triangle/base/arithmetic.h"
EOF
    "$cc" -std=c11 -I "$root" -I "$root/include" -c arithmetic.c -o by_hand.o 2>by_hand.log
    [ $? -eq $((method == 2)) ] || fault "FLT_EVAL_METHOD $method: $(head -n 3 by_hand.log)"
done

# --- by CMake: options for compiling, and those added for linking
options="-Ofast -ffast-math -funsafe-math-optimizations -ffp-contract=fast"
"$cmake" -S "$root" -B build -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_C_FLAGS="$options" -DCMAKE_CXX_FLAGS="$options" >configure.log 2>&1 || fault "cmake: $(tail -n 3 configure.log)"
commands=$(grep '"command":' build/compile_commands.json)
[ "$(echo "$commands" | wc -l)" -gt 20 ] || fault "only $(echo "$commands" | wc -l) files are compiled"
loser=$(echo "$commands" | grep -vE ' -ffast-math .* -fno-fast-math .*-ffp-contract=off ' | head -n 1)
[ -z "$loser" ] || fault "options of the user win: $loser"
echo "$commands" | grep -q -e ' -Ofast ' && fault "-Ofast reaches the compiler"
# As in JSON: quotes and backslashes are escaped by a backslash.
command=$(echo "$commands" | sed -n 's/.*"command": "\(.*predicates\.c.*\)",*$/\1/p' | sed 's/\\\(["\\]\)/\1/g')
sh -c "cd build && $command" ||
    fault "predicates.c does not compile by CMake with $options"
link=build/CMakeFiles/checkerboard.dir/link.txt # for make builds
if [ -f $link ]; then
    grep -q -e ' -funsafe-math-optimizations .* -fno-fast-math -fno-unsafe-math-optimizations ' $link ||
        fault "options of the user win when linking: $(cat $link)"
fi

echo "flags: $faults faults"
[ "$faults" -eq 0 ]
