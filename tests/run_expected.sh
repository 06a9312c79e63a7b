#!/bin/sh
# Runs `triangle` on every line of data/expected.txt and compares its output with the facts given there. Every mesh is
# checked by `trianglecheck`. Usage: run_expected.sh BIN_DIR DATA_DIR WORK_DIR
set -u
bin=$1
data=$2
work=$3
faults=0
runs=0

fault() {
    echo "expected: $*"
    faults=$((faults + 1))
}

first_count() { awk '!/^[[:space:]]*(#|$)/ { print $1; exit }' "$1"; }

refused() { # refused FILE SWITCHES: one line on stderr, exit code 1, nothing written
    "$bin/triangle" "$2" "$1" >out.txt 2>err.txt
    code=$?
    [ $code -eq 1 ] || fault "$1 $2: exit code $code instead of 1"
    [ -s err.txt ] || fault "$1 $2: nothing on stderr"
    written=$(ls ./*.1.* 2>/dev/null)
    [ -z "$written" ] || fault "$1 $2: wrote $written"
}

meshed() { # meshed FILE SWITCHES VERTICES TRIANGLES
    "$bin/triangle" "$2" "$1" >out.txt 2>err.txt
    code=$?
    [ $code -eq 0 ] || { fault "$1 $2: exit code $code: $(head -n 1 err.txt)"; return; }
    base=${1%.*}.1
    found="$(first_count "$base.node") $(first_count "$base.ele")"
    [ "$found" = "$3 $4" ] || fault "$1 $2: vertices, triangles $found instead of $3 $4"
    convex=""
    case $2:$4 in *:0) ;; *c*:* | -Q:*) convex=--convex ;; esac # an empty mesh has no hull
    # shellcheck disable=SC2086 # one word or none
    "$bin/trianglecheck" --poly "$1" $convex "$base" >out.txt 2>&1 || fault "$1 $2: trianglecheck: $(tail -n 1 out.txt)"
}

rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2
while read -r file switches vertices triangles rest; do
    case $file in "" | "#"*) continue ;; esac
    runs=$((runs + 1))
    rm -f ./*
    cp "$data/${file%.*}".* .
    name=$(basename "$file")
    if [ "$triangles" = -1 ]; then
        refused "$name" "$switches"
    else
        meshed "$name" "$switches" "$vertices" "$triangles"
    fi
done <"$data/expected.txt"
echo "expected: $runs runs, $faults faults"
[ "$runs" -gt 0 ] && [ "$faults" -eq 0 ]
