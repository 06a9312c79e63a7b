# Swept meshes: the same files as for meshes in memory, refusals, checkpoints.
#
# PTRIANGLE_TEST_SWEEP sweeps meshes that would fit in memory, and PTRIANGLE_TEST_BLOCK gives a small mesh many columns.
# Runs write a checkpoint after each column and are stopped or killed after some time. Wherever that happens, the
# resumed run ends with the same bytes, so no test depends on speed.
h5() { "$bin/ptriangle" --version >/dev/null && "$bin/ptriangle" -Qp letter --output .try.h5 >/dev/null 2>&1; }

fresh letter.poly
if ! h5; then
    echo "cli sweep: a build without HDF5"
    checks=1
    return
fi
rm -f .try.*

# killed_and_on SECONDS WORDS...: runs with a checkpoint after each column, each run somewhat longer than the one
# before, until one ends. Every other run is killed, the rest stop at the time limit.
killed_and_on() {
    limit=$1
    shift
    what="ptriangle $*, killed and on"
    longer=$(full && echo 1.3 || echo 1.8)
    found=-1
    rounds=0
    until [ $found -eq 0 ] || [ $rounds -ge 60 ]; do # the file must exist, since a kill may happen between two renames
        rounds=$((rounds + 1))
        limit=$(echo "$limit $longer" | awk '{ print $1 * $2 }')
        if [ $((rounds % 2)) -eq 0 ]; then
            "$bin/ptriangle" "$@" --checkpoint state --resume state --every 0 --threads $((rounds % 3 + 1)) \
                >.out 2>.err &
            sleep "$limit"
            kill -KILL $! 2>/dev/null
            wait $! 2>/dev/null
        else
            "$bin/ptriangle" "$@" --checkpoint state --resume state --every 0 --time-limit "$limit" >.out 2>.err
        fi
        found=$?
        case $found in
        0 | 124 | 137) ;;
        *) fault "exit code $found: $(head -n 1 .err)" && break ;;
        esac
    done
    rm -rf state # a run may have been killed after its last rename
    find . -name '.tri-*' -delete
}
export PTRIANGLE_TEST_BLOCK=600

# --- swept and in memory, by any number of threads
fresh letter.poly section.poly nasty/spike.poly
for case in "-pq30a0.0001 spike" "-pq30Ya0.002 letter" "-pq20Aaa0.01 section" "-pq25a0.004D letter" \
    "-pq33a0.005YY letter"; do
    every 2 || continue
    # shellcheck disable=SC2086 # several words
    program 0 $case --output whole.h5
    grep '^.*the bounds[.:]' .out >.expected
    for threads in 1 3; do
        # shellcheck disable=SC2086
        PTRIANGLE_TEST_SWEEP=1 program 0 $case --output swept.h5 --threads $threads
        check "the same bytes, $threads threads" cmp whole.h5 swept.h5
        grep '^.*the bounds[.:]' .out | cmp -s - .expected || fault "bad triangles: $(cat .expected .out)"
    done
done
for case in "-pq30a0.002 letter" "-pcq20a0.01BN letter" "-pPq20Aaa0.01 section" "-zpq30Da0.01E letter"; do
    every 3 || continue
    rm -f whole* swept*
    # shellcheck disable=SC2086
    program 0 -Q $case --output whole --threads 2
    # shellcheck disable=SC2086
    PTRIANGLE_TEST_SWEEP=1 program 0 -Q $case --output swept --output swept.h5
    for suffix in node ele poly; do
        [ -e whole.$suffix ] || continue
        for which in whole swept; do
            grep -v '^#' $which.$suffix >.$which
        done
        check "the same .$suffix" cmp .whole .swept
    done
    rm -f swept.h5 swept.xdmf
    check "the same files" test "$(echo whole.*)" = "$(echo swept.* | sed 's/swept/whole/g')"
done
PTRIANGLE_TEST_SWEEP=1 program 0 -pq30a0.002 letter --output swept.h5 --report report.json
check "the report names the method" grep -q '"way": "swept"' report.json
check "no shapes are reported" grep -q '"smallest_angle": null' report.json
matches '^Sweeping: about [0-9.]+ (thousand|million) triangles'
sed -n '/^Statistics/,$p' .out >.expected
program 0 -pq30a0.002 letter --output whole.h5
sed -n '/^Statistics/,$p' .out | cmp -s - .expected || fault "the counts of a swept mesh: $(diff .out .expected | head -n 4)"
check "nothing is left" sh -c '! ls -A | grep -q "^\.tri-"'

rm -f .whole .swept

# --- formats that are written when all tiles are finished
fresh letter.poly section.poly
for case in "-pq30a0.002 letter" "-pq20Aaa0.01 section" "-pq33a0.005B letter"; do
    every 3 || continue
    # shellcheck disable=SC2086
    program 0 -Q $case --output whole.vtu --output whole.msh --output whole.2dm --output whole.14
    # shellcheck disable=SC2086
    PTRIANGLE_TEST_SWEEP=1 program 0 -Q $case --output swept.vtu --output swept.msh --output swept.2dm \
        --output swept.14 --scratch .
    check "the same .vtu" cmp whole.vtu swept.vtu
    check "the same .msh" cmp whole.msh swept.msh
    check "the same .2dm" cmp whole.2dm swept.2dm
    check "the same .14" cmp whole.14 swept.14
done
wrote swept.14 swept.2dm swept.msh swept.vtu whole.14 whole.2dm whole.msh whole.vtu
PTRIANGLE_TEST_SWEEP=1 program 1 -Qpq30a0.002 letter --output swept.vtu --output y.h5 --scratch nowhere
complains 'nowhere: cannot park'
rm -f swept* whole*

# --- a mesh that cannot be swept is made as a whole, and refused if it is too large for that
fresh square.poly
for words in "-e" "-n" "-v" "-o2" "-j" "--blocks b" "--write-partial"; do
    # shellcheck disable=SC2086
    program 1 -pqa square.poly --max-area 1e-9 --output x $words
    complains 'where it must be there as a whole, as for |less would do but for '
    wrote
done
program 0 -pqa square.poly --max-area 1e-7 --output x.h5 --memory 500M --checkpoint x --dry-run
matches '^  Way: swept'
matches '^  Disk: [1-9][0-9]{2} MB'
matches '^  Disk for the checkpoint: ([1-9][0-9]{2} M|[1-9][0-9.]* G)B'
wrote

# --- the folder for parked meshes is tested before the work
PTRIANGLE_TEST_SWEEP=1 program 1 -pq30a0.01 square.poly --output x.h5 --scratch nowhere
complains 'nowhere: cannot park a mesh in this directory: No such file or directory'
check "the line is printed before the work" sh -c '! grep -q "^Sweeping" .out'
wrote
program 0 -pq30a0.01 square.poly --output x.h5 --scratch nowhere
wrote x.h5 x.xdmf
rm -f x.h5 x.xdmf

# --- a checkpoint folder that contains other files
fresh letter.poly
mkdir x
cp letter.poly x/piece-3.poly
echo precious >x/tiles
echo p >x/piece-notes.txt
program 1 -Qpq30a0.01 x/piece-3.poly --output o --checkpoint x
complains '^x: holds a file tiles, but no checkpoint: choose another folder$'
check "all files exist" test "$(cat x/tiles x/piece-notes.txt | tr '\n' ' ')" = "precious p "
rm x/tiles
program 0 -Qpq30a0.01 x/piece-3.poly --output o --checkpoint x
check "they are kept" test "$(ls x | tr '\n' ' ')" = "piece-3.poly piece-notes.txt "
rm x/*
program 1 -Qpq30a0.01 x/absent.poly --checkpoint x
check "the folder stays" test -d x
program 1 -Qpq30a0.01 absent.poly --checkpoint y
check "one of its own does not" test ! -e y
rm -rf x o.*

# --- a checkpoint after each column; stopped, killed, and resumed
fresh letter.poly
program 0 -Qpq30a0.002 letter --output whole.h5
ls >.before
export PTRIANGLE_TEST_SWEEP=1
killed_and_on 0.05 -Qpq30a0.002 letter --output out.h5
check "the same bytes" cmp whole.h5 out.h5
wrote out.h5 out.xdmf

# --- counts from before a stop are included
fresh nasty/spike.poly
program 0 -pq30a0.0005 spike --output whole.h5
grep 'below the bounds' .out >.expected
killed_and_on 0.05 -pq30a0.0005 spike --output out.h5
check "the same bytes" cmp whole.h5 out.h5
check "bad triangles are reported" test -s .expected
grep 'below the bounds' .out | cmp -s - .expected || fault "bad triangles: $(cat .expected .out)"
fresh letter.poly
program 0 -Qpq30a0.002 letter --output whole.h5
ls >.before

# --- the printed line that resumes the run
rm -f out.*
ls >.before
limit=0.02
until [ -e state/state-0 ] || [ -e out.h5 ]; do
    rm -rf state
    limit=$(echo "$limit" | awk '{ print $1 * 1.3 }')
    "$bin/ptriangle" -Qpq30a0.002 letter --output=out.h5 --checkpoint state --every 0 --time-limit "$limit" >.out 2>.err
    in_time $? || break
done
if [ -e state/state-0 ]; then
    complains '^ptriangle: [0-9]+ triangles are kept; to go on: ptriangle -Qpq30a0.002 letter --output=out.h5 --every 0 --resume state$'
    cp -R state kept

    # --- refused with another input, other bounds, another directory, twice, or if damaged
    sed 's/^3 5 0\.75 /3 5 0.76 /' letter.poly >other.poly
    ls >.before
    program 1 -Qpq30a0.002 other --output out.h5 --resume state
    complains '^state: is the checkpoint of another run: of another input, or with other switches$'
    for words in -Qpq30a0.0006 "-Qpq30a0.002 --placement classic"; do
        # shellcheck disable=SC2086 # one word or more
        program 1 $words letter --output out.h5 --resume state
        complains '^state: is the checkpoint of another run'
    done
    program 1 -Qpq30a0.002 letter --output out.h5 --checkpoint state
    complains '^state: holds the checkpoint of a run already$'
    for words in "" --dry-run; do
        # shellcheck disable=SC2086 # none or one
        program 1 -Qpq30a0.002 letter --output out.h5 --resume nowhere $words
        complains '^nowhere: holds no checkpoint: '
    done
    program 0 -Qpq30a0.002 letter --output out.h5 --resume state --dry-run
    program 1 -Qpq30a0.002 letter --output out.h5 --resume letter.poly
    complains '^letter.poly: holds no checkpoint: '
    program 1 -Qpq30a0.002 letter --output out.h5 --resume state --checkpoint other
    complains 'two directories'
    for file in manifest state-0 state-1 tiles; do
        [ -e "state/$file" ] || continue
        rm -rf state
        cp -R kept state
        printf 'x' | dd of="state/$file" bs=1 seek=40 conv=notrunc 2>/dev/null
        "$bin/ptriangle" -Qpq30a0.002 letter --output out.h5 --resume state >.out 2>.err
        found=$?
        checks=$((checks + 1))
        if [ $found -eq 0 ]; then # the state that the manifest does not name
            check "the same bytes" cmp whole.h5 out.h5
            rm -f out.*
            continue
        fi
        complains '^state(/tiles)?: .*damaged'
        check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
        : >"state/$file"
        program 1 -Qpq30a0.002 letter --output out.h5 --resume state
        complains '^state(/tiles)?: .*damaged'
    done
    rm -rf state
    cp -R kept state
    ls >.before
    program 0 -Qpq30a0.002 letter --output out.h5 --resume state
    check "the same bytes" cmp whole.h5 out.h5
    rm -f out.*
fi

# --- a file that cannot be written: the current mesh is kept, and one line shows how to resume
fresh letter.poly
if [ -e /dev/full ] && (ulimit -f 600) 2>/dev/null; then
    program 0 -Qpq30a0.002 letter --output whole.h5
    what="ptriangle, a file too large"
    (
        ulimit -f 600 # more than the checkpoint's files need, less than all files
        "$bin/ptriangle" -Qpq30a0.002 letter --output out --checkpoint state --every 0 >.out 2>.err
    )
    check "exit code" test $? -eq 1
    complains 'cannot write'
    check "no more than two lines" sh -c 'test "$(wc -l <.err)" -le 2'
    check "no file" test -z "$(ls out* .tri-* 2>/dev/null)"
fi

# --- a mesh that is not swept also resumes from a state
unset PTRIANGLE_TEST_SWEEP
fresh letter.poly
program 0 -pq33a0.0005e letter --output whole --checkpoint state --every 0
silent_on 'checkpoint'
ls >.before
killed_and_on 0.05 -Qpq33a0.0005e letter --output out
for suffix in node ele edge poly; do
    for which in whole out; do
        grep -v '^#' $which.$suffix >.$which
    done
    check "the same .$suffix" cmp .whole .out
done
rm -f .whole
wrote out.edge out.ele out.node out.poly
for words in "--every -1" "--every 5" "--checkpoint" "--resume="; do
    # shellcheck disable=SC2086
    program 1 -Qp letter $words
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
done
unset PTRIANGLE_TEST_BLOCK
