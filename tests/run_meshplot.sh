#!/bin/sh
# Draws a mesh of two triangles in every way, and checks colours, sizes, refusals and exit codes.
# Usage: run_meshplot.sh BIN_DIR WORK_DIR
set -u
plot=$1/meshplot
work=$2
faults=0

fault() {
    echo "meshplot: $*"
    faults=$((faults + 1))
}

draws() { # draws OPTION...: expects exit code 0
    "$plot" mesh.1 "$@" >out.txt 2>&1 || fault "$*: exit code $?: $(head -n 1 out.txt)"
}

refuses() { # refuses CODE OPTION...: expects that exit code, a message on stderr, and no picture
    wanted=$1
    shift
    rm -f no.*
    "$plot" "$@" >out.txt 2>err.txt
    code=$?
    [ $code -eq "$wanted" ] || fault "$*: exit code $code instead of $wanted"
    [ -s err.txt ] || fault "$*: nothing on stderr"
    left=$(ls no.* 2>/dev/null)
    [ -z "$left" ] || fault "$*: left $left"
}

fills() { # fills FILE: number of different fill colours of the polygons in an SVG
    grep '<path' "$1" | grep -o 'fill[:=]"*rgb([^)]*)' | sort -u | wc -l
}

rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2
echo leak:libfontconfig >suppressions.txt # leaks that LeakSanitizer finds there are not ours
export LSAN_OPTIONS="suppressions=$work/suppressions.txt:print_suppressions=0"
printf '4 2 0 0\n1 0 0\n2 4 0\n3 4 1\n4 0 3\n' >mesh.1.node
printf '2 3 1\n1 1 2 3 7\n2 1 3 4 9\n' >mesh.1.ele
printf '0 2 0 1\n4 1\n1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 1\n0\n' >mesh.1.poly
printf '0 2\n1 -1\n' >blocks.txt
printf '0 2\n' >short.txt

for colour in quality area region none; do
    draws -o "$colour.png" --color $colour --size 300
    draws -o "$colour.svg" --color $colour --edges off --segments off --legend off
done
draws -o density.png --color density --size 300
draws -o density.svg --color density --size 300 --window 0,0,2,2
grep -q '<image' density.svg || fault "a picture of densities contains no image"
draws -o block.svg --color block --blocks blocks.txt --edges off --segments off --legend off
for colour in quality area region block; do
    [ "$(fills $colour.svg)" -eq 2 ] || fault "$colour.svg has $(fills $colour.svg) colours instead of 2"
done
[ "$(fills none.svg)" -eq 1 ] || fault "none.svg has $(fills none.svg) colours instead of 1"

# More triangles than are drawn one by one: densities, unless the window contains few enough.
export PTRIANGLE_TEST_TRIANGLES=1
draws -o many.png --size 300 --color area
grep -q '^meshplot: there are more than 1 triangles to show: a picture of densities' out.txt || fault "no message about densities"
cmp -s many.png density.png || fault "many.png is not a picture of densities"
draws -o one.svg --window 0.4,1.4,0.5,1.5 --edges off --segments off --legend off
[ -s out.txt ] && fault "one triangle is not too many"
unset PTRIANGLE_TEST_TRIANGLES

# The header of a PNG gives its width in bytes 16 to 19.
width=$(od -An -tu1 -j16 -N4 quality.png | awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 }')
[ "$width" = 300 ] || fault "quality.png is $width pixels wide instead of 300"

# A window deep inside the upper triangle.
draws -o window.svg --window 0.4,1.4,0.5,1.5 --edges off --segments off --legend off
[ "$(fills window.svg)" -eq 1 ] || fault "window.svg has $(fills window.svg) colours instead of 1"
draws -o deep.png --window 0.4,1.4,0.400000000001,1.400000000001 --edges on --mark 0,0,1,1 --title deep
cp mesh.1.node points.node
cp mesh.1.node loose.node
cp mesh.1.ele loose.ele
printf '0 2 0 1\n1 1\n1 -7 2 1\n0\n' >loose.poly # the coordinates of the missing vertex are not read
"$plot" loose -o loose.svg >out.txt 2>&1 || fault "a segment without a vertex: $(head -n 1 out.txt)"
"$plot" points -o points.png >out.txt 2>&1 || fault "points alone: $(head -n 1 out.txt)"

refuses 2 mesh.1
refuses 2 mesh.1 -o no.gif
refuses 2 mesh.1 -o no.png --window 1,0,0,1
refuses 2 mesh.1 -o no.png --color block
refuses 1 mesh.1 -o no.png --color block --blocks short.txt
refuses 1 mesh.1 -o no/where.png
refuses 1 missing -o no.png
printf '2 3 0\n1 1 2 3\n' >mesh.1.ele
refuses 1 mesh.1 -o no.png

# a signal while it reads its input from a pipe: exit code 128 + number, one line, no file
mkfifo held.node
cp mesh.1.ele held.ele
"$plot" held -o no.png >out.txt 2>err.txt &
job=$!
(sleep 60 && : <held.node) >/dev/null 2>&1 & # the next line waits for a reader
guard=$!
exec 3>held.node # returns once the program has begun to read
kill $guard
kill -TERM $job
wait $job
code=$?
exec 3>&-
[ $code -eq 143 ] || fault "SIGTERM: exit code $code instead of 143"
grep -q '^meshplot: stopped by SIGTERM' err.txt || fault "SIGTERM: $(head -n 1 err.txt)"
[ -z "$(ls no.* .tri-* 2>/dev/null)" ] || fault "SIGTERM: a file is left"

echo "meshplot: $faults faults"
[ "$faults" -eq 0 ]
