#!/bin/sh
# What the README shows works: its C program compiles against the headers of the tree and runs, and each of its commands
# on files of data/ ends with exit code 0, but for those that make hundreds of millions of
# triangles. Usage: run_readme.sh SOURCE_ROOT BUILD_DIR WORK_DIR C_COMPILER
set -u
root=$1
build=$2
work=$3
cc=$4
faults=0

fault() {
    echo "readme: $*"
    faults=$((faults + 1))
}

rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2
cp "$root"/data/*.poly .
PATH=$build/bin:$PATH

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$root/README.md" >example.c
[ -s example.c ] || fault "no C program found"
"$cc" -std=c11 -Wall -Wextra -Werror -I "$root/include" example.c "$build/libtriangle.a" -lm -o example ||
    fault "the C program does not compile"
./example || fault "the program ends with exit code $?"

grep -E '^    (triangle|ptriangle|trianglecheck|meshplot) ' "$root/README.md" | grep -v 1.73e-9 | sed 's/#.*//' >commands.txt
[ "$(wc -l <commands.txt)" -ge 8 ] || fault "only $(wc -l <commands.txt) commands found"
while read -r program arguments; do
    [ -x "$build/bin/$program" ] || { echo "not built, not tested: $program"; continue; }
    # shellcheck disable=SC2086 # arguments are words
    "$program" $arguments >out.txt 2>&1 </dev/null || fault "$program $arguments: exit code $?: $(tail -n 1 out.txt)"
done <commands.txt
echo "readme: $faults faults"
[ "$faults" -eq 0 ]
