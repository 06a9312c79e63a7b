# trianglecheck: the files that it reads, and its promises.

denies() { # denies PATTERN WORDS...: expects faults, one of which matches PATTERN
    pattern=$1
    shift
    "$bin/trianglecheck" --quiet "$@" >.out 2>.err
    found=$?
    check "trianglecheck $*: exit code $found instead of 1" test "$found" -eq 1
    matches "$pattern"
}

# --- the argument that is not an option may stand anywhere, but only once
fresh letter.poly
run 0 -pq letter
for posix in "" 1; do
    [ -z "$posix" ] || export POSIXLY_CORRECT=1
    judge letter.1 --poly letter.poly
    judge --poly letter.poly letter.1
    judge --poly letter.poly -- letter.1
    for words in "" "letter.1 letter.1" "letter.1 -- letter.1" "-- letter.1 -q 20"; do
        # shellcheck disable=SC2086 # several words
        "$bin/trianglecheck" $words >.out 2>.err
        check "trianglecheck $words: exit code" test $? -eq 2
    done
done
unset POSIXLY_CORRECT

# --- coordinates that count as 0
fresh regress/denormal_coordinate.poly
run 0 -pc denormal_coordinate
judge denormal_coordinate.1 --poly denormal_coordinate.poly --keep-hull

# --- neighbours of an earlier run are not checked, and one line says so
fresh letter.poly
run 0 -pqn letter
judge letter.1 --poly letter.poly
run 0 -p letter
"$bin/trianglecheck" letter.1 --poly letter.poly >.out 2>.err
check "exit code" test $? -eq 0
matches "^-     neighbors"
complains "letter\.1\.neigh is of another mesh than \.ele"
check "one line" test "$(wc -l <.err)" -eq 1

# --- a mesh without triangles
fresh
printf '4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n1 0\n1 1 2\n0\n' >open.poly
run 0 -pj open
header open.1.node "0 2 0 1"
judge open.1 --poly open.poly --jettisoned
run 0 -pr open.1
judge open.2 --poly open.1.poly -r

# --- the mesh may end along the hull if an option allows it
fresh letter.poly
run 0 -pc letter
judge letter.1 --poly letter.poly --keep-hull
denies "^FAIL  boundary along the input" letter.1 --poly letter.poly

# --- markers of vertices
run 0 -p letter
judge letter.1 --poly letter.poly
awk 'NR == 2 { $NF = 7 } { print }' letter.1.node >changed && mv changed letter.1.node
denies "^FAIL  vertex markers: 1, first: vertex 1 has marker 7" letter.1 --poly letter.poly
judge letter.1 --poly letter.poly --no-markers

# --- overlapping input segments: exactly (markers and pieces are checked), and within rounding
# --- in the mesh, and where no triangles are left, with almost no memory
fresh
to_and_fro() { # to_and_fro N STEP: a path in a box that goes back and forth along one line, in steps of a lattice
    awk -v n="$1" -v step="$2" 'BEGIN { m = n + 5; print m, 2, 0, 0
        for (i = 0; i <= n; i++) {
            x = (i * 617 % 1009) / 1024
            printf "%d %.17g %.17g\n", i + 1, x, x / 2 + step * (i % 5)
        }
        print n + 2, -1, -1; print n + 3, 2, -1; print n + 4, 2, 2; print n + 5, -1, 2; print n + 4, 1
        for (i = 1; i <= n; i++) print i, i, i + 1, 5
        for (i = 1; i < 4; i++) print n + i, n + i + 1, n + i + 2, 1
        print n + 4, n + 5, n + 2, 1; print 0 }'
}
to_and_fro 500 0 >straight.poly
to_and_fro 500 1e-17 >nearly.poly
for path in straight nearly; do
    run 0 -p $path
    judge $path.1 --poly $path.poly
    cp $path.1.poly sound
    awk 'NF == 4 && $4 == 5 && ++n == 90 { $4 = 6 } { print }' sound >$path.1.poly
    denies "^FAIL  segment markers: 1, first: .* has marker 6" $path.1 --poly $path.poly --no-regions
done
cp straight.1.poly sound
awk 'NR == 2 { $1-- } NF == 4 && NR > 2 && ($4 == 5 || $4 == 6) && !gone { gone = 1; next } { print }' sound |
    awk 'NF == 4 && NR > 2 { $1 = ++n } { print }' >straight.1.poly
denies "^FAIL  input segments: [0-9]+, first: " straight.1 --poly straight.poly
awk 'BEGIN { n = 3000; print n + 1, 2, 0, 0
    for (i = 0; i <= n; i++) { x = i * 6170 % 30011; print i + 1, x, 2 * x }
    print n, 0; for (i = 1; i <= n; i++) print i, i, i + 1; print 0 }' >flat.poly
run 0 -p flat
if (ulimit -v 300000 && "$bin/trianglecheck" --help) >/dev/null 2>&1; then # sanitizers need more
    (ulimit -v 300000 && "$bin/trianglecheck" --quiet --threads 1 flat.1 --poly flat.poly >.out 2>.err)
    check "trianglecheck of overlapping segments without a mesh: exit code" test $? -eq 0
fi

# --- the same verdict for any number of threads
fresh letter.poly
full && area=0.0008 || area=0.002
run 0 -pq30a${area}n letter
awk 'NR > 1 && NR % 300 == 0 && NF == 4 && !/#/ { t = $2; $2 = $3; $3 = t } { print }' letter.1.ele >changed
for mesh in letter.1.ele changed; do
    mv $mesh letter.1.ele 2>/dev/null
    for threads in 1 2 5; do
        "$bin/trianglecheck" --threads $threads letter.1 --poly letter.poly -q 30 >verdict.$threads 2>&1
        check "verdict of $threads threads" cmp verdict.1 verdict.$threads
    done
    "$bin/trianglecheck" --json --threads 3 letter.1 -a 0.0007 >json.3 2>&1
    "$bin/trianglecheck" --json --threads 1 letter.1 -a 0.0007 >json.1 2>&1
    check "the same in JSON" cmp json.1 json.3
done
check "clockwise triangles are many" grep -q "^FAIL  orientation: [0-9][0-9]" verdict.1
for word in 0 -1 two; do
    "$bin/trianglecheck" --threads $word letter.1 >.out 2>.err
    check "--threads $word: exit code" test $? -eq 2
done

# --- the same verdict for any memory limit, also for text files: markers, neighbours, six nodes, a missing triangle
part_by_part() { # part_by_part WORDS...: expects the same verdict of trianglecheck WORDS with little memory
    "$bin/trianglecheck" "$@" >whole 2>whole.err
    found=$?
    for memory in 1 100K 1%; do
        "$bin/trianglecheck" "$@" --memory $memory --scratch . >parts 2>parts.err
        check "trianglecheck $* --memory $memory: exit code" test $? -eq $found
        check "trianglecheck $* --memory $memory: the same verdict" cmp whole parts
        check "trianglecheck $* --memory $memory: the same words" cmp whole.err parts.err
    done
    check "no scratch file is left" test -z "$(ls -d -- *-?????? 2>/dev/null)"
}
fresh section.poly letter.poly
for switches in -pq30aA -pq30aAzo2n -pq30Dnj; do
    every 3 || continue
    run 0 $switches section
    part_by_part section.1 --poly section.poly -q 30 --jettisoned
    part_by_part section.1 --poly letter.poly -q 33 -a 1 --json
done

# the last node is the midpoint of an edge; letter.poly has an attribute
run 0 -pq30o2 letter
part_by_part letter.1 --poly letter.poly -q 30
cp letter.1.node sound
last=$(awk '!/#/ { last = $1 } END { print last }' sound)
for change in '$2 += 0.01' '$5 += 1' '$4 += 1'; do
    awk -v last="$last" '!/#/ && NR > 1 && $1 == last { '"$change"' } { print }' sound >letter.1.node
    part_by_part letter.1 --poly letter.poly
    case $change in
    *4*) denies "^FAIL  vertex attributes: 1, first: attribute 0 of node $last" letter.1 ;;
    *) denies "^FAIL  midside nodes: 1, first: node $last" letter.1 ;;
    esac
done
awk 'NR > 1 && $1 == 2 { $4 = 9e9 } { print }' sound >letter.1.node
part_by_part letter.1 --poly letter.poly
denies "^FAIL  vertex attributes: [0-9]*, first: attribute 0 of vertex 2 is 9000000000; the input's is" \
    letter.1 --poly letter.poly

cp section.1.ele sound
sed -n '1,11p' sound | sed '1s/^[0-9]*/10/' >section.1.ele
part_by_part section.1 --poly section.poly
sed '2s/[0-9]*$/99999/' sound >section.1.ele
part_by_part section.1
sed 5d sound >section.1.ele
"$bin/trianglecheck" section.1 --memory 1 --scratch . >.out 2>.err
check "exit code" test $? -eq 2
complains "section\.1\.ele:[0-9]*: unexpected end of file"
part_by_part nothing

# faults of files are reported in the same words
one() { # one FILE TEXT: a mesh of one triangle, with FILE replaced by TEXT
    printf '3 2 0 0\n1 0 0\n2 1 0\n3 2 1\n' >one.node
    printf '1 3 0\n1 1 2 3\n' >one.ele
    rm -f one.poly one.neigh
    printf "%b" "$2" >"one.$1"
    part_by_part one
}
one ele ''
one ele '\n# nothing\n'
one ele '0 3 0\n'
one ele 'many\n'
one ele '-1 3 0\n1 1 2 3\n'
one ele '2 3 0\n1 1 2 3'
one ele '1 3 0\n1 1 2\n'
one ele '1 3 0\n1 1 2 x\n'
one ele '1 3 -1\n1 1 2 3\n'
one ele '1 3 500000\n1 1 2 3\n'
one node '4 2 0 0\n1 0 0\n2 1 0\n3 2 1\n\n'
one node '3 2 0 0\n1 0 0\n2 1\n3 2 1\n'
one node '3 2 0 0\n1 0 0\n2 nan 0\n3 2 1\n'
one node '3 2 -1 0\n1 0 0\n2 1 0\n3 2 1\n'
one poly '0 2 0 0\n2 0\n1 1 2\n#\n\n'
one poly '0 2 0 0\n1 0\n1 1\n0\n'
one neigh ''
one neigh '2\n1 -1 -1 -1\n'
one neigh '1\n'
"$bin/trianglecheck" section.1 --memory 3X >.out 2>.err
check "exit code" test $? -eq 2
"$bin/trianglecheck" section.1 --memory 1 --scratch /nowhere >.out 2>.err
check "exit code" test $? -eq 2
complains "/nowhere: cannot make a scratch file there"

# --- subsegments with a vertex in their circle are counted once, as in the mesher, for a vertex on either side
fresh regress/flat_on_both_sides.poly
run 0 -pq33D flat_on_both_sides
matches "^5 subsegments keep a vertex in the diametral circle"
denies "^FAIL  diametral circles: 5," flat_on_both_sides.1 -D
part_by_part flat_on_both_sides.1 -D

# --- HDF5, if this build writes it
fresh section.poly
if "$bin/ptriangle" -pq30aAQ --output section.h5 section.poly >.out 2>&1 && [ -f section.h5 ]; then
    judge section.h5 --poly section.poly -q 30
    part_by_part section.h5 --poly section.poly -q 33
    cp section.h5 damaged.h5 # the address of the first group, in the superblock
    printf '\377' | dd of=damaged.h5 bs=1 seek=60 conv=notrunc 2>/dev/null
    ASAN_OPTIONS=detect_leaks=0 "$bin/trianglecheck" damaged.h5 >.out 2>.err # HDF5 itself leaks memory in this case
    check "exit code" test $? -eq 2
    check "one line" test "$(wc -l <.err)" -eq 1
fi

# --- segments may be missing where faces flatter than rounding were removed: the checker reports it
"$bin/trianglecheck" --help >.out
matches 'outside the mesh or within rounding error of its boundary'
