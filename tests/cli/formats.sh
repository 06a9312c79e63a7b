# Files in formats of other programs, selected by --output.
fresh section.poly
program 0 -pq30aAQ --output x.vtu --output sub.d.msh section.poly
wrote x.vtu sub.d.msh
check "a .vtu" sh -c 'head -n 2 x.vtu | grep -q "<VTKFile type=\"UnstructuredGrid\""'
check "a .msh" sh -c 'head -n 2 sub.d.msh | grep -q "^4.1 1 8$"'
cp x.vtu 1.vtu
cp sub.d.msh 1.msh
PTRIANGLE_TEST_BLOCK=60 "$bin/ptriangle" -pq30aAQ --threads 1 --output s.vtu --output s.msh section.poly
PTRIANGLE_TEST_BLOCK=60 "$bin/ptriangle" -pq30aAQ --threads 3 --output t.vtu --output t.msh section.poly
check "the same .vtu on three threads" cmp s.vtu t.vtu
check "the same .msh on three threads" cmp s.msh t.msh
fresh letter.poly
program 0 -pq30 --output base --output fort.14 --output x.2dm --output x.grd letter.poly
wrote base.node base.ele base.poly fort.14 x.2dm x.grd
says "Writing fort.14."
judge base --poly letter.poly --min-angle 30
check "ADCIRC's two suffixes" cmp fort.14 x.grd

fresh letter.poly
program 0 -p --output X.MSH --output y.2DM --parts 2 letter.poly
wrote X_1.MSH X_2.MSH y.2DM

# parts: the same for any number of threads, swept or not
fresh section.poly letter.poly
PTRIANGLE_TEST_BLOCK=60
export PTRIANGLE_TEST_BLOCK
for way in one three swept; do
    case $way in
    one) program 0 -pq30aAQ --threads 1 --output one.msh --parts 3 section.poly ;;
    three) program 0 -pq30aAQ --threads 3 --output three.msh --parts=3 section.poly ;;
    swept) PTRIANGLE_TEST_SWEEP=1 program 0 -pq30aAQ --output swept.msh --parts 3 section.poly ;;
    esac
    for part in 1 2 3; do
        check "the same part $part" cmp "one_$part.msh" "${way}_$part.msh"
    done
done
unset PTRIANGLE_TEST_BLOCK
wrote one_1.msh one_2.msh one_3.msh swept_1.msh swept_2.msh swept_3.msh three_1.msh three_2.msh three_3.msh
fresh letter.poly
program 0 -p --output x.msh --output x.vtu --parts 1 letter.poly
says "Writing x_1.msh."
wrote x_1.msh x.vtu
rm -f x_1.msh x.vtu
program 1 -p --output a.b/x.msh --output x.vtu --parts 1 letter.poly
complains 'a\.b/x_1\.msh: cannot create'
program 1 -p --output x.msh --parts 513 letter.poly
complains '--parts: "513" is not a whole number from 1 to 512'
program 1 -p --output x.msh --output y.msh --parts 257 letter.poly
complains '--parts: 257 parts of each of 2 \.msh files are more than 512$'
program 1 -p --parts 2 letter.poly
complains '--parts is for \.msh files'
echo old >x_1.msh
ln -s . x_2.msh
program 1 -pq30 --output x.msh --parts 2 letter.poly
complains 'x_2\.msh: '
check "the old file" grep -qx old x_1.msh
rm -f x_1.msh x_2.msh
if [ -e /dev/full ]; then
    ln -s /dev/full x_2.msh
    program 1 -pq30 --output x.msh --parts 2 letter.poly
    complains 'x_2\.msh: cannot write'
    wrote x_2.msh
fi

# The number of system calls per file does not depend on the number of files. (Skipped if a process may not be traced.)
calls() {
    strace -f -qq -e trace=%file,link,linkat -o .found "$bin/ptriangle" -pQ --threads 1 --output x.msh --parts "$1" \
        letter.poly && wc -l <.found
}
if command -v strace >/dev/null && strace -o .found true 2>/dev/null; then
    fresh letter.poly
    few=$(calls 20)
    more=$(calls 40)
    most=$(calls 80)
    check "$few, $more and $most calls for 20, 40, 80 files" test $((most - more)) -le $((2 * (more - few) + 20))
fi

# all files or none, and none if an output cannot be written
fresh letter.poly
echo old >x.vtu
program 1 -pq30 --output x.vtu --output nowhere/x.msh letter.poly
complains '^nowhere/x\.msh: cannot create'
check "the old file" grep -qx old x.vtu
wrote x.vtu
fresh letter.poly
program 1 -pq30o2 --output x.vtu --output fort.14 letter.poly
complains '^fort\.14: files of ADCIRC cannot hold second-order triangles'
program 1 -pq30o2 --output x.vtu --output x.h5 letter.poly
complains '^x\.h5: files of HDF5 cannot hold second-order triangles'
program 1 -pq30 --output x.vtu --output ./x.vtu letter.poly
complains 'would be written twice'
program 1 -p --output 1.vtu --output 2.vtu --output 3.vtu --output 4.vtu --output 5.vtu letter.poly
complains 'no more than 4'
if [ -e /dev/full ]; then
    ln -s /dev/full x.14
    program 1 -pq30 --output y.vtu --output x.14 letter.poly
    complains 'cannot write'
    wrote x.14
fi

# Each file is read again and checked: the same vertices and triangles, with the markers and regions that the format
# keeps.
fresh section.poly
program 0 -pq30aAQ --output x --output x.vtu --output x.msh --output x.2dm --output x.14 section.poly
wrote x.node x.ele x.poly x.vtu x.msh x.2dm x.14
for file in x x.vtu x.msh x.2dm x.14; do
    "$bin/trianglecheck" --poly section.poly --min-angle 30 "$file" >".$file.verdict" 2>&1 ||
        fault "$file: $(grep -v '^ok' ".$file.verdict" | head -n 1)"
    check "the shapes of $file" sh -c "grep '^info' '.$file.verdict' | cut -c -60 >.this; grep '^info' .x.verdict |
        cut -c -60 | cmp -s - .this"
done
rm -f .*.verdict .this
program 0 -pq30aAQo2 --output x.vtu --output x.msh --output x.2dm section.poly
for file in x.vtu x.msh x.2dm; do
    check "six nodes in $file" "$bin/trianglecheck" --quiet --poly section.poly --min-angle 30 "$file"
done
head -c 3000 x.vtu >short.vtu
check "a truncated .vtu" sh -c "! '$bin/trianglecheck' short.vtu 2>.said && [ \$(wc -l <.said) -eq 1 ]"
rm -f .said

# A name that selects no format gives a message.
fresh letter.poly
program 1 -p --output x.shp letter.poly
complains '--output: there is no format \.shp: there are \.h5, \.vtkhdf, \.vtu, '
program 1 -p --output mesh.fine letter.poly
complains 'no format \.fine: .*for a name with a dot add \.node$'
program 0 -pQ --output mesh.fine.poly letter.poly
wrote mesh.fine.node mesh.fine.ele mesh.fine.poly
rm -f mesh.fine.*
program 0 -pQ --output run.1 letter.poly
wrote run.1.node run.1.ele run.1.poly
rm -f run.1.*
program 0 -pQ --output mesh.v2 letter.poly
wrote mesh.v2.node mesh.v2.ele mesh.v2.poly
program 0 -pQ --output mesh.14.node letter.poly
check "a base that looks like ADCIRC's" "$bin/trianglecheck" --quiet mesh.14
rm -f mesh.14.*

# --- points that no triangle uses: never in files for solvers, always in Triangle's files
fresh
orphans >two.poly
PTRIANGLE_TEST_BLOCK=60
export PTRIANGLE_TEST_BLOCK
program 0 -pq30a0.002 two.poly --output x --output x.vtu --output x.msh --output x.2dm --output x.14
says "Warning:  3 points are in no triangle: -j leaves them out."
for file in x.vtu x.msh x.2dm x.14 x; do
    what="trianglecheck $file"
    "$bin/trianglecheck" "$file" >.out 2>.err || fault "a fault"
    case $file in
    x) says "warn  vertices in no triangle: 3 (-j of ptriangle leaves them out)" ;;
    *) matches '^vertices ([0-9]+) \(\1 used\)' ;;
    esac
done
what="trianglecheck --json"
"$bin/trianglecheck" --json x >.out
matches '"unused_vertices": 3,'
program 0 -pq30a0.002o2 two.poly --output y.msh
says "Warning:  3 points are in no triangle: left out."
what="trianglecheck y.msh"
"$bin/trianglecheck" y.msh >.out 2>.err || fault "a fault"
silent_on "^(warn|FAIL)"
program 0 -pj two.poly --output z
silent_on "in no triangle"
program 0 -p two.poly --output z.vtu
check "one that is not refined" sh -c '"$1" z.vtu | grep -q "^vertices 8 (8 used)"' sh "$bin/trianglecheck"
PTRIANGLE_TEST_SWEEP=1 program 0 -pq30a0.002 two.poly --output s --output s.vtu --output s.msh --output s.2dm --output s.14
says "Warning:  3 points are in no triangle: -j leaves them out."
for suffix in vtu msh 2dm 14; do
    check "the same .$suffix, swept" cmp x.$suffix s.$suffix
done
for suffix in node ele poly; do
    check "the same .$suffix, swept" sh -c 'grep -v "^#" "x.$1" >.found; grep -v "^#" "s.$1" | cmp -s - .found' sh $suffix
done
if "$bin/ptriangle" -pq30a0.002Q two.poly --output x.h5 2>.err; then
    check "x.h5" sh -c '"$1" x.h5 | grep -q "^vertices \([0-9]*\) (\1 used)"' sh "$bin/trianglecheck"
    PTRIANGLE_TEST_SWEEP=1 program 0 -pq30a0.002Q two.poly --output s.h5
    check "the same .h5, swept" cmp x.h5 s.h5
    program 0 -pq30a0.002Q two.poly --output v.vtkhdf
    check "the same .vtkhdf" cmp x.h5 v.vtkhdf
    check "trianglecheck reads it" "$bin/trianglecheck" --quiet v.vtkhdf
    # the segments 2 4 and 4 5 are not edges, and no triangle uses point 5
    printf '5 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n5 .5 2\n' >loose.node
    printf '2 3 0\n1 1 2 3\n2 1 3 4\n' >loose.ele
    printf '0 2 0 1\n3 1\n1 1 3 5\n2 2 4 6\n3 4 5 7\n0\n' >loose.poly
    program 0 -rp loose --output loose.h5
    check "2 4 is copied" sh -c '"$1" loose.h5 | grep -q "subsegments 6$"' sh "$bin/trianglecheck"
    rm loose.*
fi
unset PTRIANGLE_TEST_BLOCK

# --- pieces of a segment have its direction
runs_its_way() { # runs_its_way BASE POLY: compares directions; such segments of POLY have unique markers
    check "pieces of $1 have the direction of their segments" awk '/^#/ { next } FNR == 1 { file++; n = $1; next }
        file == 1 { if (FNR <= n + 1) { x[$1] = $2; y[$1] = $3 } else if (NF == 4) { a[$4] = $2; b[$4] = $3 } }
        file == 2 { X[$1] = $2; Y[$1] = $3 }
        file == 3 && NF == 4 && ($4 in a) { p = a[$4]; q = b[$4]; k++
            if ((x[q] - x[p]) * (X[$3] - X[$2]) + (y[q] - y[p]) * (Y[$3] - Y[$2]) <= 0) bad++ }
        END { exit k < 20 || bad > 0 }' "$2" "$1.node" "$1.poly"
}
fresh
orphans >two.poly
sed 's/^8 8 5 2$/8 8 5 0/' two.poly >own.poly # if segments overlap, the first determines the direction
program 0 -Qpq30a0.002 own.poly --output x
runs_its_way x own.poly
run 0 -Qpq30a0.002 own.poly
runs_its_way own.1 own.poly
run 0 -Qrpq33a0.001 own.1
runs_its_way own.2 own.poly

# --- refining a mesh in a format of another program: the same bounds, markers, attributes
fresh section.poly
program 0 -pq20aAQ section.poly --output x --output x.vtu --output x.msh --output x.2dm --output x.grd
for suffix in msh vtu 2dm grd; do
    program 0 -q30 x.$suffix --output r
    says "Opening x.$suffix."
    case $suffix in
    msh | vtu) judge --refined --poly section.poly -q 30 r ;;
    *) judge -q 30 r ;; # the format does not keep segments inside the domain
    esac
    [ $suffix = grd ] || check "regions of x.$suffix" test "$(awk 'NR == 1 { print $3 }' r.ele)" -eq 1
done
program 0 -rpq30Q x --output own
program 0 -q30Q x.vtu --output again
for suffix in node ele poly; do # holes come from the input, since the format has none
    check "the same .$suffix as of .node and .ele" \
        sh -c 'grep -v "^#" "again.$1" | sed "\$d" >.found; grep -v "^#" "own.$1" | head -n "$(wc -l <.found)" |
            cmp -s - .found' sh $suffix
done
program 1 -q30 x.msh --output x.msh
complains '^x\.msh: would be overwritten, a file of the input'
program 1 -q30 absent.msh
complains '^absent\.msh: '

# --- names of regions and boundaries; types of land
fresh section.poly
program 0 -pq20aAQ section.poly --output x.msh
check "names without blanks" sh -c 'grep -aq "^2 1 \"region_1\"$" x.msh && grep -aq "^1 1 \"marker_1\"$" x.msh &&
    grep -aq "^\"attribute_0\"$" x.msh'
fresh
printf '%s\n' "8 2 0 0" "1 0 0" "2 9 0" "3 9 9" "4 0 9" "5 3 3" "6 6 3" "7 6 6" "8 3 6" "8 1" "1 1 2 2" "2 2 3 20" \
    "3 3 4 22" "4 4 1 7" "5 5 6 20" "6 6 7 20" "7 7 8 20" "8 8 5 20" 1 "1 4 4" >sea.poly
program 0 -pQ sea.poly --output fort.14
check "types of land" test "$(sed -n '/land boundaries/,$p' fort.14 | awk 'NF == 2 { print $2 }' | sort -n | tr '\n' ' ')" \
    = "0 20 21 22 "

# --- faults are reported with the file's own numbers
awk 'NF == 5 && $2 == 3 && !done { t = $3; $3 = $4; $4 = t; done = $1 } { print }' fort.14 >turned.14
what="trianglecheck turned.14"
"$bin/trianglecheck" turned.14 >.out 2>.err && fault "no fault"
matches '^FAIL  orientation: 1, first: triangle 1 '

# --- a Voronoi diagram of triangles that are not Delaunay
fresh
printf '%s\n' "6 2 0 0" "1 0 0" "2 8 0" "3 8 6" "4 0 6" "5 4 2.9" "6 4 3.1" "5 0" "1 1 2" "2 2 3" "3 3 4" "4 4 1" \
    "5 1 3" 0 >thin.poly
run 0 -pv thin
matches '^Warning:  Voronoi vertices beyond a segment, .*: [1-9][0-9]*\. -D prevents that\.$'
run 0 -pvD thin
silent_on "Voronoi vertices beyond"
sed -n 1,7p thin.poly >bare.node
run 0 -v bare
silent_on "Voronoi vertices beyond"
