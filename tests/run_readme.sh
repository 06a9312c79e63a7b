#!/bin/sh
# Runs the examples of README.md, which may have at most 9,000 characters, and of docs/*.md without changes:
# - Lines indented by four blanks that begin with one of the programs run on the files of data/ and must return 0. Runs
# that make a million triangles or more get --dry-run and no --resume. Launchers (srun, mpirun) are removed.
# - Blocks ```sh run as scripts. Those of one document share a folder, with the files of data/ in it and in data/ below.
# If a block ```text follows, each of its lines must occur in the output, in this order, except lines `...`.
# - Blocks whose first line names a file (```c plate.c) are written to that file in the folder of the document.
# Usage: run_readme.sh SOURCE_ROOT BUILD_DIR WORK_DIR C_COMPILER [CMAKE]
set -u
root=$1
build=$2
work=$3
CC=$4
cmake=${5:-cmake}
export CC
faults=0

fault() {
    echo "readme: $*"
    faults=$((faults + 1))
}

rm -rf "$work"
mkdir -p "$work/commands"
cd "$work/commands" || exit 2
cp "$root"/data/*.poly "$root"/data/coast/*.poly .
PATH=$build/bin:$PATH

[ "$(wc -m <"$root/README.md")" -le 9000 ] || fault "README.md has more than 9,000 characters"

# Lines of code from the name of the program on, joined with the next line if they end in a backslash.
sed -e :join -e '/\\$/{' -e N -e 's/ *\\\n */ /' -e 'b join' -e '}' "$root/README.md" "$root"/docs/*.md |
    sed -nE 's/^ {4,}((srun|mpirun) .* )?((triangle|ptriangle|trianglecheck|meshplot) .*)/\3/p' |
    sed -E 's/#.*//; /1\.73e-9|a0\.0001 /{ s/$/ --dry-run/; s/ --resume [a-z]+//; }' >commands.txt
[ "$(wc -l <commands.txt)" -ge 25 ] || fault "only $(wc -l <commands.txt) commands found"
while read -r program arguments; do
    [ -x "$build/bin/$program" ] || { echo "not built, not tested: $program"; continue; }
    # shellcheck disable=SC2086 # arguments are words
    "$program" $arguments >out.txt 2>&1 </dev/null && continue
    code=$?
    grep -qE 'this build has no|was built without|are left there' out.txt && { echo "not tested: $(tail -n 1 out.txt)"; continue; }
    fault "$program $arguments: exit code $code: $(tail -n 1 out.txt)"
done <commands.txt

# blocks DOCUMENT: writes its files, and N.sh and N.txt for each script and its expected output.
blocks() {
    awk '
        /^```/ && inside { close(file); inside = 0; next }
        /^```/ {
            inside = 1
            file = "/dev/null"
            language = substr($1, 4)
            if (NF > 1) {
                file = $2
                after_script = 0
            } else if (language == "sh") {
                file = sprintf("%02d.sh", ++n)
                after_script = 1
            } else if (language == "text" && after_script) {
                file = sprintf("%02d.txt", n)
                after_script = 0
            } else
                after_script = 0
            next
        }
        inside { print >file }' "$1"
}

# shows OUTPUT EXPECTED: prints the first line of EXPECTED that is missing from OUTPUT or occurs too early
shows() {
    awk 'NR == FNR { have[++n] = $0; next }
        $0 == "..." || $0 == "" { next }
        { for (i++; i <= n && have[i] != $0; i++); if (i > n) { print; exit } }' "$1" "$2"
}

# needed SCRIPT: prints the first program that the script runs and that this machine or build does not have
needed() {
    for program in triangle ptriangle trianglecheck meshplot; do
        ! grep -qE "^$program " "$1" || [ -x "$build/bin/$program" ] || { echo "$program"; return; }
    done
    for program in pkg-config cmake; do
        ! grep -q "$program" "$1" || command -v "$program" >/dev/null || { echo "$program"; return; }
    done
}

# The installed package, for blocks that build a client.
prefix=$work/prefix
"$cmake" --install "$build" --prefix "$prefix" >"$work/install.log" 2>&1 || fault "install: $(tail -n 1 "$work/install.log")"
libraries=$(dirname "$(find "$prefix" -name pkgconfig -type d | head -n 1)")
export PKG_CONFIG_PATH="$libraries/pkgconfig" CMAKE_PREFIX_PATH="$prefix" LD_LIBRARY_PATH="$libraries"

n_scripts=0
for document in "$root/README.md" "$root"/docs/*.md; do
    name=$(basename "$document" .md)
    mkdir "$work/$name"
    cd "$work/$name" || exit 2
    blocks "$document"
    cp -n "$root"/data/*.poly "$root"/data/coast/*.poly .
    mkdir -p data/coast
    cp "$root"/data/*.poly data
    cp "$root"/data/coast/*.poly data/coast
    for script in [0-9][0-9].sh; do
        [ -f "$script" ] || continue
        lacks=$(needed "$script")
        [ -z "$lacks" ] || { echo "not tested: $name.md, script ${script%.sh}: no $lacks here"; continue; }
        n_scripts=$((n_scripts + 1))
        sh -eu "$script" >"$script.out" 2>&1 </dev/null || {
            code=$?
            grep 'was built without' "$script.out" ||
                fault "$name.md: script ${script%.sh}: exit code $code: $(tail -n 1 "$script.out")"
            continue
        }
        [ -f "${script%.sh}.txt" ] || continue
        line=$(shows "$script.out" "${script%.sh}.txt")
        [ -z "$line" ] || fault "$name.md: script ${script%.sh} does not print: $line"
    done
done
[ "$n_scripts" -ge 5 ] || [ ! -x "$build/bin/ptriangle" ] || fault "only $n_scripts scripts found"
echo "readme: $(wc -l <"$work/commands/commands.txt") commands, $n_scripts scripts, $faults faults"
[ "$faults" -eq 0 ]
