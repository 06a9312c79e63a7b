#!/bin/sh
# What the documents show works: the README's C program compiles against the headers of the tree and runs, and each
# command of the README and of docs/ on files of data/ ends with exit code 0. Those that make a million triangles and
# more are tried with --dry-run, which leaves no state to resume, those for clusters without their launcher.
# Usage: run_readme.sh SOURCE_ROOT BUILD_DIR WORK_DIR C_COMPILER
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
cp "$root"/data/*.poly "$root"/data/coast/*.poly .
PATH=$build/bin:$PATH

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$root/README.md" >example.c
[ -s example.c ] || fault "no C program found"
"$cc" -std=c11 -Wall -Wextra -Werror -I "$root/include" example.c "$build/libtriangle.a" -lm -o example ||
    fault "the C program does not compile"
./example || fault "the program ends with exit code $?"

# Lines of code, with the next one where they end in a backslash, from the name of the program on.
sed -e :join -e '/\\$/{' -e N -e 's/ *\\\n */ /' -e 'b join' -e '}' "$root/README.md" "$root"/docs/*.md |
    sed -nE 's/^ {4,}((srun|mpirun) .* )?((triangle|ptriangle|trianglecheck|meshplot) .*)/\3/p' |
    sed -E 's/#.*//; /1\.73e-9|a0\.0001 /{ s/$/ --dry-run/; s/ --resume [a-z]+//; }' >commands.txt
[ "$(wc -l <commands.txt)" -ge 25 ] || fault "only $(wc -l <commands.txt) commands found"
while read -r program arguments; do
    [ -x "$build/bin/$program" ] || { echo "not built, not tested: $program"; continue; }
    # shellcheck disable=SC2086 # arguments are words
    "$program" $arguments >out.txt 2>&1 </dev/null && continue
    code=$?
    grep -qE 'this build has no|was built without' out.txt && { echo "not tested: $(tail -n 1 out.txt)"; continue; }
    fault "$program $arguments: exit code $code: $(tail -n 1 out.txt)"
done <commands.txt
echo "readme: $faults faults"
[ "$faults" -eq 0 ]
