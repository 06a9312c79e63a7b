# Invalid input and options: one clear line, exit code 1, and no file is changed.
fresh letter.poly
run 1 -pa0 letter
complains "area"
matches "^Error:  "
run 1 -rI letter
complains "-I"
run 1 -p nothing
complains "^nothing\.poly: cannot open"
run 1 nothing.node
complains "^nothing\.node: "
run 1 ""
complains "^\.node: "
run 1 -r letter
wrote
run 0 -pa1e-6 letter
complains "a1e-6.*exponent"

# long options belong to ptriangle; dashes followed by other characters are ignored, as in Triangle
for word in --min-angle --min-angle=30 --versions --p; do
    run 1 $word -p letter
    complains "^triangle: --[a-z=0-9-]*: no such option"
done
for words in "--placement hexagons" --placement=hexagons --placement= "--placement Classic"; do
    # shellcheck disable=SC2086 # one word or two
    run 1 -pq30 letter $words
    complains '^triangle: --placement: "[A-Za-z]*" is neither front, lattice nor classic$'
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
done
run 1 -pq30 letter --placement
complains '^triangle: --placement needs a value$'
wrote letter.1.node letter.1.ele letter.1.poly letter.1.edge
# a file of another kind: the message lists the formats that are read
printf '{"type": "Polygon"}' >letter.json
run 1 -p letter.json
complains "^letter\.json\.poly: cannot open: .*what is read are Triangle's"
printf 'a\0b' >binary.poly
run 1 -p binary.poly
complains "^binary\.poly:1: .*what is read are Triangle's"
rm letter.json binary.poly
run 0 -- --3 -pQ letter
for program in triangle ptriangle trianglecheck meshplot; do
    [ -x "$bin/$program" ] || continue
    what=$program
    check "--version" sh -c '"$1" --version | grep -qE "^$2 [0-9]+\.[0-9]+\.[0-9]+$"' sh "$bin/$program" $program
    check "--help" sh -c '"$1" --help | grep -qi "^usage: $2 "' sh "$bin/$program" $program
done
# a mesh without triangles: one line gives the reason, even with -Q, using the numbers of the file
outline() { # outline BASE ENDS...: the square with numbers from BASE on, and a segment for each pair of ends
    base=$1
    shift
    printf '4 2 0 0\n%d 0 0\n%d 4 0\n%d 4 4\n%d 0 4\n%d 0\n' $base $((base + 1)) $((base + 2)) $((base + 3)) $(($# / 2))
    k=$base
    while [ $# -gt 0 ]; do
        echo "$k $1 $2"
        k=$((k + 1))
        shift 2
    done
}
tells() { # tells TEXT: expects one line, which ends with TEXT
    check "one line: $(cat .err)" sh -c 'test "$(wc -l <.err)" -eq 1'
    complains "riangle: warning: $1\$"
    silent_on "keep the bounds"
}
(outline 1 1 2 2 3 3 4; echo 0) >open.poly
(outline 0 0 1 1 2 2 3; echo 0) >zero.poly
(outline 0 1 2 2 3 3 4 4 1; echo 0) >shifted.poly
(outline 1 1 2 2 3 3 4 4 1; printf '1\n1 2 2\n') >hole.poly
(outline 1 1 2 2 3 3 4 4 1 3 9; echo 0) >skipped.poly
for program in triangle ptriangle; do
    [ -x "$bin/$program" ] || continue
    for switches in -pq20a1 -pQ -p; do
        mesher 0 $program $switches open.poly
        tells 'the mesh is empty: the outline is open at points 1 and 4'
        mesher 0 $program $switches zero.poly
        tells 'the mesh is empty: the outline is open at points 0 and 3'
        mesher 0 $program $switches shifted.poly
        tells 'the mesh is empty: segment 2 names point 4 of 4: numbers count from 0 here; 2 segments are skipped'
        mesher 0 $program $switches hole.poly
        tells 'the mesh is empty: hole 1 lies in the only face'
    done
    mesher 0 $program -pO hole.poly
    calm
    mesher 0 $program -p skipped.poly
    complains '^p?triangle: warning: segment 5 names point 9 of 4: numbers count from 1 here; it is skipped$'
    mesher 0 $program -pQ skipped.poly
    calm
done
if [ -x "$bin/ptriangle" ]; then
    program 0 -pq20a1 open.poly --dry-run
    tells 'the mesh is empty: the outline is open at points 1 and 4'
    program 0 -pq20a1 open.poly --output open.vtu --memory 200M
    tells 'the mesh is empty: the outline is open at points 1 and 4'
fi
rm -f open.* zero.* shifted.* hole.* skipped.*
what='a newline in a name'
"$bin/trianglecheck" 'no
y' >.out 2>.err
complains '^trianglecheck: no\\ny'
check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
mkdir "a
b"
cp letter.poly "a
b/"
run 0 -p "a
b/letter"
says 'Opening a\nb/letter.poly.'
says 'Writing a\nb/letter.1.node.'
"$bin/trianglecheck" "--no-
such" 2>.err
complains '^trianglecheck: --no-\\nsuch is not an option, or short for several$'
"$bin/trianglecheck" --poly 2>.err
complains '^trianglecheck: -p needs a value$'
rm -r "a
b"
if [ -x "$bin/meshplot" ]; then
    "$bin/meshplot" 'no
y.h5' -o a.png >.out 2>.err
    complains '^meshplot: no\\ny'
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
fi

fresh nasty/truncated.poly nasty/rubbish.poly nasty/nan.node nasty/identical.node nasty/region_no_value.poly \
    nasty/badindex.poly
run 1 -p truncated
complains "^truncated\.poly:[0-9]+: "
matches "^Error:  truncated\.poly:[0-9]+: "
check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
run 1 -p rubbish
complains "^rubbish\.poly:[0-9]+: "
run 1 nan
complains "^nan\.node:[0-9]+: "
run 1 -pA region_no_value
complains "^region_no_value\.poly:[0-9]+: "
run 1 -Q identical
complains "same place"
check "errors on standard output too" grep -q "^Error:  " .out
run 0 -p badindex
check "four warnings with file and line" sh -c 'test "$(grep -cE "^Warning:  badindex\.poly:[0-9]+: " .out)" -eq 4'
rm -f badindex.1.*
wrote

# both streams go to one place: the error is printed once
"$bin/triangle" -p truncated >.out 2>&1
check "reported once" sh -c 'test "$(grep -c truncated.poly: .out)" -eq 1'

# --- outputs that cannot be written
fresh letter.poly
mkdir letter.1.ele
run 1 -p letter
complains "^letter\.1\.ele: cannot create"
wrote letter.1.ele
fresh letter.poly
if [ -e /dev/full ]; then
    ln -s /dev/full letter.1.ele
    run 1 -p letter
    complains "/dev/full|letter\.1\.ele"
    wrote letter.1.ele
fi
fresh letter.poly
echo old >letter.1.node
what="ulimit -f"
(
    ulimit -f 20
    "$bin/triangle" -pqa.01 letter >.out 2>.err
)
check "a file too large is an error" test $? -eq 1
check "the old file is kept" grep -qx old letter.1.node
complains "cannot write"
wrote letter.1.node

# --- a signal while files are being written: no file remains. A pipe without a reader blocks the program there.
for signal in TERM INT HUP; do
    fresh letter.poly
    echo old >letter.1.node
    mkfifo letter.1.ele
    ls >.before
    what="SIG$signal"
    # a shell lets its background jobs ignore SIGINT, and nohup SIGHUP; env restores the default if it can
    if env --default-signal=$signal true 2>/dev/null; then
        env --default-signal=$signal "$bin/triangle" -p letter >.out 2>.err &
    elif [ $signal = TERM ]; then
        "$bin/triangle" -p letter >.out 2>.err &
    else
        continue
    fi
    job=$!
    tries=0
    until ls .tri-* >/dev/null 2>&1 || [ $tries -ge 2400 ]; do
        tries=$((tries + 1))
        sleep 0.05
    done
    check "a temporary file" ls .tri-*
    kill -$signal $job
    wait $job 2>/dev/null
    check "ended by the signal" test $? -gt 128
    wrote
    check "the old file is kept" grep -qx old letter.1.node
done

# --- standard output
fresh letter.poly
what="standard output closed"
"$bin/triangle" -pqV letter >&- 2>.err
check "exit code" test $? -eq 0
judge letter.1 --poly letter.poly --min-angle 20
fresh letter.poly
"$bin/triangle" -pqV letter >&- 2>&- <&-
check "all closed" test $? -eq 0
judge letter.1 --poly letter.poly --min-angle 20
if [ -e /dev/full ]; then
    fresh letter.poly
    what="standard output full"
    "$bin/triangle" -p letter >/dev/full 2>.err
    check "exit code" test $? -eq 1
    complains "standard output"
    check "one line" test "$(wc -l <.err)" -eq 1
    wrote
fi
# a reader that closes the pipe is no error
fresh letter.poly
what="standard output closed by its reader"
{ "$bin/triangle" -pqV letter 2>.err; echo $? >.code; } | true
check "exit code" test "$(cat .code)" -eq 0
judge letter.1 --poly letter.poly --min-angle 20
