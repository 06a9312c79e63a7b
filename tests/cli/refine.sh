# -r: a mesh refined repeatedly, with the files, lines and errors of Triangle. ptriangle gives the same mesh for any
# number of threads.

rows() { records "$1" | tail -n +2; }
same_file() { grep -v '^#' "$1" >.expected; grep -v '^#' "$2" | cmp -s - .expected; }

# --- without bounds: the mesh is unchanged
fresh letter.poly
run 0 -pqa.3Q letter
ls >.before
run 0 -r letter.1
wrote letter.2.node letter.2.ele
says "Opening letter.1.node."
says "Opening letter.1.ele."
silent_on "Opening letter.1.poly|Delaunay mill|Quality|Hole|Recovering|Input segments"
matches "^Mesh reconstruction milliseconds:  [0-9]+$"
matches "^  Input triangles: [0-9]+$"
matches "^  Mesh subsegments \(constrained edges\): [0-9]+$"
check "same nodes" same_file letter.1.node letter.2.node
check "same triangles" same_file letter.1.ele letter.2.ele
ls >.before
run 0 -rp letter.1
wrote letter.2.poly # the other files were there before
says "Opening letter.1.poly."
matches "^  Input segments: [0-9]+$"
silent_on "Input holes"
check "same nodes" same_file letter.1.node letter.2.node
check "same triangles" same_file letter.1.ele letter.2.ele
check "same segments, holes copied" same_file letter.1.poly letter.2.poly
check "a hole" test "$(records letter.2.poly | tail -n 2 | head -n 1)" = 1
fresh letter.poly
run 0 -pqa.3Q letter
ls >.before
run 0 -rc letter.1 # the boundary becomes segments
wrote letter.2.node letter.2.ele letter.2.poly
check "boundary" test "$(rows letter.2.poly | head -n 1)" = "$(rows letter.1.poly | head -n 1)"
check "no hole" test "$(records letter.2.poly | tail -n 1)" = 0
rm letter.2.*
run 0 -rpc letter.1
wrote letter.2.node letter.2.ele letter.2.poly
rm letter.2.*
run 0 -rNEP letter.1
wrote
says "NOT writing a .node file."
matches "^  Mesh triangles: [0-9]+$"
run 0 -rpNEP letter.1
wrote
run 0 -rpenvgC letter.1
wrote letter.2.node letter.2.ele letter.2.poly letter.2.edge letter.2.neigh letter.2.off letter.2.v.node letter.2.v.edge
matches "^  Topology: consistent"
silent_on "!! !!"
run 0 -rQ letter.1
check "quiet" test ! -s .out

# --- a mesh without triangles
fresh nasty/hole_eats_all.poly
run 0 -pjQ hole_eats_all
check "no vertex" test "$(records hole_eats_all.1.node | head -n 1)" = "0 2 0 1"
for switches in -rpq30 -rpqDj -rqa.1; do
    run 0 "$switches" hole_eats_all.1
    check "no vertex" test "$(records hole_eats_all.2.node | head -n 1)" = "0 2 0 1"
    check "no triangle" test "$(records hole_eats_all.2.ele | head -n 1)" = "0 3 0"
    rm hole_eats_all.2.*
done

# --- iterations, each finer; implied -r
fresh box_hole.poly
cp box_hole.poly box.poly
run 0 -pqa.5Q box
run 0 -rpqa.1 box.1
says "All triangles keep the bounds."
judge box.2 --poly box.poly --min-angle 20 --max-area .1 --refined
run 0 -pqa.02D box.2.ele
says "Opening box.2.ele."
judge box.3 --poly box.poly --min-angle 20 --max-area .02 --conforming --refined
run 0 -q30 box.3.ele
says "Opening box.3.node."
silent_on "Opening box.3.poly"
check "no .poly" test ! -e box.4.poly
judge box.4 --min-angle 30
cp box.3.poly box.4.poly
run 0 -rpq25YYa.001 box.4
check "no vertex on a segment" test "$(rows box.5.poly | head -n 1)" = "$(rows box.4.poly | head -n 1)"
run 0 -rpqS7a.001 box.3
check "seven vertices" test "$(($(records box.4.node | head -n 1 | cut -d " " -f 1) - 7))" -eq \
    "$(records box.3.node | head -n 1 | cut -d " " -f 1)"

# --- area bounds of triangles
fresh square.poly
printf '5 2 0 0\n1 0 0\n2 2 0\n3 2 2\n4 0 2\n5 1 1\n' >four.node
printf '4 3 2\n1 1 2 5 7 -1.5\n2 2 3 5 8 1e300\n3 3 4 5 7 -1.5\n4 4 1 5 9 0\n' >four.ele
printf '4\n1 .05\n2 -1\n3\n4 .002\n' >four.area
printf '0 2 0 1\n4 1\n1 1 5 11\n2 2 5 12\n3 3 5 0\n4 4 5 13\n1\n1 5 5\n1\n1 1 .5 3 3\n' >four.poly
run 0 -rpa four # bounds apply within the segments
says "Opening four.area."
header four.1.ele "$(records four.1.ele | head -n 1 | cut -d ' ' -f 1) 3 2"
check "attributes and areas are unchanged" awk '
    /^#/ { next } FNR == 1 { next }
    FILENAME ~ /node/ { x[$1] = $2; y[$1] = $3; next }
    { mx = (x[$2] + x[$3] + x[$4]) / 3 - 1; my = (y[$2] + y[$3] + y[$4]) / 3 - 1
      side = my < -mx ? (my < mx ? 1 : 4) : (my < mx ? 2 : 3)
      area = ((x[$3] - x[$2]) * (y[$4] - y[$2]) - (x[$4] - x[$2]) * (y[$3] - y[$2])) / 2
      if (($5 " " $6) != (side == 2 ? "8 1.0000000000000001e+300" : side == 4 ? "9 0" : "7 -1.5")) bad++
      if ((side == 1 && area > .05) || (side == 4 && area > .002)) bad++
      seen[side]++ }
    END { exit bad > 0 || seen[4] < 500 || seen[1] < 20 || !seen[2] || !seen[3] }' four.1.node four.1.ele
check "markers" test "$(rows four.1.poly | awk 'NF == 4 { print $4 }' | sort -nu | tr '\n' ' ')" = "0 1 11 12 13 "
check "hole copied, regions not" test "$(records four.1.poly | tail -n 2 | tr '\n' ' ')" = "1 1 5 5 "
run 0 -A four.area # implies -ra; -A has no effect
check "two columns" test "$(records four.1.ele | head -n 1 | cut -d ' ' -f 3)" = 2
check "values are copied" test "$(rows four.1.ele | cut -d ' ' -f 5,6 | sort -u | wc -l)" -eq 3
run 0 -ra.4 four
silent_on "four.area"
header four.1.ele "$(records four.1.ele | head -n 1 | cut -d ' ' -f 1) 3 2"
cp four.1.node five.node
cp four.1.ele five.ele
run 0 -r five
check "same triangles" same_file five.ele five.1.ele

# A sliver that meets its bound, beside a triangle without a bound: the edge between them is flipped.
printf '4 2 0 0\n1 0 0\n2 1 0\n3 .5 1e-9\n4 .5 -1\n' >sliver.node
printf '2 3 0\n1 1 2 3\n2 1 4 2\n' >sliver.ele
for bound in 1e-4 1e-6 1e-10; do
    printf '2\n1 %s\n2 -1\n' $bound >sliver.area
    run 0 -ra sliver
    header sliver.1.ele "2 3 0"
done

# --- clockwise triangles, six nodes, segments that are not edges
printf '4 3 0\n1 1 5 2\n2 2 3 5\n3 5 4 3\n4 4 1 5\n' >four.ele
run 0 -rC four
matches "^  Topology: consistent"
check "turned" test "$(rows four.1.ele | head -n 1)" = "1 1 2 5"
run 0 -ro2 four
header four.1.node "13 2 0 1"
cp four.1.node six.node
cp four.1.ele six.ele
run 0 -r six
header six.1.node "5 2 0 1"
run 0 -rj six
header six.1.node "5 2 0 1"
printf '6 2 0 0\n1 0 0\n2 2 0\n3 2 2\n4 0 2\n5 1 1\n6 1 0\n' >loose.node
cp four.ele loose.ele
printf '0 2 0 1\n3 1\n1 1 3 5\n2 1 5 6\n3 1 6 7\n0\n' >loose.poly
run 0 -rp loose
header loose.1.node "6 2 0 1"
matches "^Warning:  2 segments are no edges of the mesh"
says "  Mesh subsegments (constrained edges): 7"
says "  Mesh interior boundary edges: 3"
check "copied" test "$(rows loose.1.poly | grep -cE ' (1 3 5|1 6 7)$')" -eq 2
run 0 -rp loose.1
check "copied" test "$(rows loose.2.poly | grep -cE ' (1 3 5|1 6 7)$')" -eq 2

# --- errors
fresh square.poly
cp "$data/nasty/badindex_mesh.node" "$data/nasty/badindex_mesh.ele" .
printf '5 2 0 0\n1 0 0\n2 2 0\n3 2 2\n4 0 2\n5 1 0\n' >bad.node
printf '2 3 0\n1 1 2 3\n2 1 3 4\n' >bad.ele
ls >.before
bad() { # bad TEXT ELEMENTS: expects -r to report TEXT for these triangles
    printf '%s' "$2" >bad.ele
    run 1 -rq bad
    complains "^bad\.ele: $1"
    matches "^Error:  bad\.ele: $1"
}
run 1 -rI bad
complains "I cannot be used when refining"
run 1 -ra bad
complains "^bad\.area: cannot open"
run 1 -rp bad
complains "^bad\.poly: cannot open"
run 1 -r nothing
complains "^nothing\.node: cannot open"
run 1 -r badindex_mesh
complains "^badindex_mesh\.ele:[0-9]+: triangle .* not the number of a vertex"
bad "triangle 2 has no area" "2 3 0
1 1 2 3
2 1 5 2
"
bad "triangle 2 has two equal corners" "2 3 0
1 1 2 3
2 1 3 3
"
bad "triangle 2 lies on the same side of an edge" "2 3 0
1 1 2 3
2 2 3 4
"
bad "triangle 3 has an edge that two other triangles have" "3 3 0
1 1 2 3
2 1 3 4
3 1 5 3
"
for base in 0 1; do # an invalid area bound is reported with its number in the file
    printf '3 2 0 0\n%s 0 0\n%s 1 0\n%s 0 1\n' $base $((base + 1)) $((base + 2)) >bad.node
    printf '1 3 0\n%s %s %s %s\n' $base $base $((base + 1)) $((base + 2)) >bad.ele
    printf '1\n%s nan\n' $base >bad.area
    run 1 -ra bad
    complains "^bad\.area:2: area bound $base is not a finite number"
done
rm bad.area
wrote

# --- the same mesh for any number of threads
threads_agree() { # threads_agree SWITCHES JUDGE_OPTIONS: big.1 refined by 1, 2 and 3 threads
    first=
    for threads in 1 2 3; do
        what="ptriangle $1 big.1, $threads threads"
        OMP_NUM_THREADS=$threads "$bin/ptriangle" "$1" --progress big.1 >.out 2>.err || fault "exit code $?"
        found=$(cat big.2.* | cksum)
        [ -n "$first" ] || first=$found
        checks=$((checks + 1))
        [ "$found" = "$first" ] || fault "another mesh"
    done
    complains "refining: round 1, phase 1 of 4"
    # shellcheck disable=SC2086 # several words
    judge big.2 --poly letter.poly $2
    rm big.2.*
}

if [ -x "$bin/ptriangle" ]; then
    fresh letter.poly
    cp letter.poly big.poly
    run 0 -pqa.011Q big
    PTRIANGLE_TEST_BLOCK=500 # many blocks in a mesh of this size
    export PTRIANGLE_TEST_BLOCK
    threads_agree -rpq30a.003 "--min-angle 30 --max-area .003 --refined"
    awk '!/^#/ { if (n++) print $1, ($1 % 5 ? .004 : -1); else print $1 }' big.1.ele >big.1.area
    threads_agree -rpqa "--min-angle 20 --refined"
fi
