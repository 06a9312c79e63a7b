# Files in other programs' formats, as --output names them.
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

# parts: the same on any number of threads, swept or not
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

# As many calls of the system for each file, however many there are. (Those that one process may not trace are not told.)
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

# all or nothing, and nothing where it cannot be
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

# Each is read again, and judged: the same vertices and triangles, with what the format keeps of markers and regions.
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

# A name is no format without a word about it.
fresh letter.poly
program 1 -p --output x.shp letter.poly
complains '--output: there is no format \.shp: there are \.h5, \.vtu, '
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
