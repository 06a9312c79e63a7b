# ptriangle as several tasks of a launcher: the first task writes the same files as one process, and errors are printed
# once. MPIEXEC is the launcher of the MPI that the program was built for; empty if it was built without MPI.
# shellcheck disable=SC2154 # bin is of run.sh
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl=self,vader,tcp OMP_NUM_THREADS=1 PTRIANGLE_TEST_BLOCK=500
PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe # from OpenMPI 5 on
export PRTE_MCA_rmaps_default_mapping_policy
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe
export OMPI_MCA_mpi_yield_when_idle OMPI_MCA_btl OMP_NUM_THREADS PTRIANGLE_TEST_BLOCK

# ranks CODE N WORDS...: expects the exit code; a hang is a failure
ranks() {
    code=$1
    n=$2
    shift 2
    what="$n ranks: $*"
    checks=$((checks + 1))
    timeout 100 "$MPIEXEC" -n "$n" "$bin/ptriangle" "$@" >.out 2>.err
    found=$?
    [ "$found" -eq "$code" ] || fault "exit code $found instead of $code: $(head -n 3 .out)"
}

# with_one RANK DO CODE WORDS...: two ranks, or $of; DO is applied to one of them first. CODE any: 0, or a failure that
# is not a hang
with_one() {
    one=$1
    first=$2
    code=$3
    shift 3
    what="${of:-2} ranks, rank $one after $first: $*"
    checks=$((checks + 1))
    RANK=$one DO=$first timeout 100 "$MPIEXEC" -n "${of:-2}" sh -c \
        '[ "${OMPI_COMM_WORLD_RANK:-$PMI_RANK}" -ne "$RANK" ] || eval "$DO"; exec "$0" "$@"' \
        "$bin/ptriangle" "$@" >.out 2>.err
    found=$?
    case $code:$found in
    any:124) fault "it hangs" ;;
    any:* | "$code:$code") ;;
    *) fault "exit code $found instead of $code: $(head -n 3 .out .err)" ;;
    esac
}

# spread N: N numbers, evenly spaced, up to the number in the file .count
spread() { awk -v most="$1" '{ for (i = 0; i < most; i++) print 1 + int(i * $1 / most) }' .count; }

# --- tasks of another MPI
fresh letter.poly
what="tasks of a launcher that is none"
checks=$((checks + 1))
SLURM_STEP_NUM_TASKS=3 SLURM_PROCID=0 "$bin/ptriangle" -Qpq30a0.01 letter >.out 2>.err </dev/null
[ $? -eq 1 ] || fault "not refused"
check "it is reported once" grep -q 'started as 3 tasks' .err
check "nothing is written" test ! -e letter.1.ele
if [ -z "${MPIEXEC:-}" ]; then
    return
fi

# --- the same bytes
fresh letter.poly section.poly
for case in "-pq30a0.002 letter" "-pq33a0.01 letter" "-p letter"; do
    file=${case##* }
    # shellcheck disable=SC2086 # several words
    program 0 -Q $case
    mkdir one
    mv "$file".1.* one/
    # shellcheck disable=SC2086
    ranks 0 3 -Q $case
    for made in one/*; do
        check "the same bytes: $case, $made" cmp "$made" "${made#one/}"
    done
    rm -rf one "$file".1.*
done

# --- only one task reads and writes: the others need neither the input nor the folder
fresh section.poly
same_but_for_comments() { # A B
    grep -av '^#' "$1" >.one
    grep -av '^#' "$2" >.two
    cmp .one .two
}
program 0 -Qpq10aA section
for case in "-pq28aA section.poly" "-rpq20a0.01e section.1"; do
    # shellcheck disable=SC2086 # several words
    program 0 -Q $case --output one
    # shellcheck disable=SC2086
    with_one 1 'cd /' 0 -Q $case --output two
    for file in one.*; do
        check "the same except for the command: $case, $file" same_but_for_comments "$file" "two${file#one}"
    done
    rm -f one.* two.*
done

# --- a field of lengths is not needed either
fresh letter.poly
printf 'ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 14\n.3 .2\n.05 .1\n' >field.asc
for case in "-p letter --size field.asc" "-p letter --size-near 1:0.05 --max-size 0.3"; do
    # shellcheck disable=SC2086 # several words
    program 0 -Q $case --output one
    # shellcheck disable=SC2086
    with_one 1 'cd /' 0 -Q $case --output two
    # shellcheck disable=SC2086
    ranks 0 3 -Q $case --output three
    for file in one.*; do
        check "the same except for the command: $case, $file" same_but_for_comments "$file" "two${file#one}"
        check "the same of three: $case, $file" same_but_for_comments "$file" "three${file#one}"
    done
    rm -f one.* two.* three.*
done
ranks 1 2 -Qp letter --size absent.asc
complains '^absent\.asc: cannot open'

# --- points that no triangle uses are not in HDF5 files, but in Triangle's files
fresh
orphans >pair.poly
program 0 -Qpq30a0.0005 pair.poly --output one
ranks 0 3 -pq30a0.0005 pair.poly --output two
says "Warning:  3 points are in no triangle: -j leaves them out."
for suffix in node ele poly; do
    check "the same .$suffix" same_but_for_comments one.$suffix two.$suffix
done
program 0 -Qpq30a0.0005 pair.poly --output one.msh
ranks 0 3 -Qpq30a0.0005 pair.poly --output two.msh
check "the same .msh" cmp one.msh two.msh
if "$bin/ptriangle" -Qpq30a0.0005 pair.poly --output one.h5 2>.err; then
    ranks 0 3 -Qpq30a0.0005 pair.poly --output two.h5
    check "the same .h5" cmp one.h5 two.h5
    ranks 0 3 -Qpq30a0.0005 pair.poly --output three.h5 --output three.vtu
    check "the same .h5, of one rank" cmp one.h5 three.h5
fi
fresh section.poly

# --- amounts of data sent, by reason and rank
ranks 0 3 -Qpq30a0.01 section.poly --output one.vtu --report report.json
for word in '"borders": [1-9]' '"tiles": [1-9]' '"input": [1-9]'; do
    check "the report has no $word" grep -q "$word" report.json
done
check "three ranks" test "$(grep -c '"waiting_seconds"' report.json)" -eq 3
program 0 -Qpq30a0.01 section.poly --output one.h5 --report report.json
check "one process has no ranks" grep -q '"ranks": null' report.json

# --- each rank writes its own rows, so no rows are sent; if a second format needs the whole mesh, one rank writes all
fresh letter.poly
outputs="--output two"
files="one.node one.ele one.poly"
program 0 -Qpq30a0.001 letter --output one
if "$bin/ptriangle" -Qpq30a0.001 letter --output one.h5 >.out 2>&1; then
    outputs="--output two --output two.h5"
    files="$files one.h5"
fi
for others in "" "--output two.vtu"; do
    # shellcheck disable=SC2086 # several words, or none
    ranks 0 3 -Qpq30a0.001 letter $outputs $others --report report.json
    check "tiles moved if and only if they had to: $others" test \
        "$(grep -q '"tiles": [0-9]\{6\}' report.json && echo moved)" = "${others:+moved}"
    for file in $files; do
        check "the same except for the command: $others, $file" same_but_for_comments "$file" "two${file#one}"
    done
    rm -f two.*
done

# --- a bound on the memory of each task
fresh letter.poly
program 0 -Qpq30a0.001 letter --output one
ranks 0 3 -Qpq30a0.001 letter --output two --memory 400M
check "the same bytes within a bound" same_but_for_comments one.ele two.ele
ranks 1 2 -Qpq20a0.000001 letter --output two --memory 60M
check "refused in one line" test "$(grep -c ' triangles, which take .* [MG]B of memory' .err)" -eq 1
case "${LD_PRELOAD:-}$(ldd "$bin/ptriangle")" in
*libasan* | *libtsan* | *libubsan*) ;; # have memory of their own
*)
    fresh square_random1000.poly
    for how in q20a0.0000004 q33a0.0000006; do
        what="three ranks, -p$how, each within 145 MB"
        checks=$((checks + 1))
        PTRIANGLE_TEST_BLOCK='' timeout 100 "$MPIEXEC" -n 3 python3 "$data/../tests/cli/peak.py" 145000000 \
            "$bin/ptriangle" "-Qp$how" square_random1000 --output two.h5 --memory 145M >.out 2>.err
        found=$?
        [ "$found" -eq 0 ] || fault "exit code $found: $(head -n 3 .err)"
        rm -f two.h5
    done
    ;;
esac

# --- a network that fails for one task: all tasks end, one line gives the reason, and there is no file. (If the
# launcher
# ends the first task, that task may print a different line.)
if [ -n "${PTRIANGLE_LOST:-}" ]; then
    fresh letter.poly
    cp "$PTRIANGLE_LOST" .lost.so # a copy, since the path may contain blanks, at which LD_PRELOAD splits
    for one in 0 1; do
        for k in 1 40; do
            # shellcheck disable=SC2086 # several words
            with_one $one "export LD_PRELOAD=./.lost.so PTRIANGLE_LOST_AT=$k" 1 -Qpq30a0.01 letter $outputs
            check "look $k of task $one: one line" test "$(grep -c '^ptriangle: .* cannot reach' .err)" -eq 1
            check "look $k of task $one: no file" sh -c '! ls two.* 2>/dev/null'
        done
    done
    what="three ranks, two of which are lost"
    checks=$((checks + 1))
    # shellcheck disable=SC2086
    timeout 100 "$MPIEXEC" -n 3 sh -c '[ "${OMPI_COMM_WORLD_RANK:-$PMI_RANK}" -eq 0 ] ||
        export LD_PRELOAD=./.lost.so PTRIANGLE_LOST_AT=40; exec "$0" "$@"' "$bin/ptriangle" -Qpq30a0.01 letter $outputs \
        >.out 2>.err
    check "a failure" test $? -eq 1
    check "one line" test "$(grep -c '^ptriangle: .* cannot reach' .err)" -eq 1
fi

# --- memory runs out anywhere in one task: exit code 1, one line, no file; or all files
fresh letter.poly
program 0 -Qpq30a0.01 letter --output one
if [ -n "${PTRIANGLE_SHIM:-}" ]; then
    cp "$PTRIANGLE_SHIM" .shim.so
    shim="export LD_PRELOAD=./.shim.so PTRIANGLE_FAIL_OWN=1"
    with_one 1 "$shim PTRIANGLE_COUNT=.count" 0 -Qpq30a0.01 letter --output two
    for k in $(spread "${PTRIANGLE_SHORT_RUNS:-2}"); do
        rm -f two.*
        with_one 1 "$shim PTRIANGLE_FAIL_AT=$k" any -Qpq30a0.01 letter --output two
        if [ "$found" -eq 0 ]; then
            check "allocation $k: the same bytes" same_but_for_comments one.node two.node
        else
            check "allocation $k: exit code $found" test "$found" -eq 1
            check "allocation $k: one line: $(head -n 3 .err)" test "$(grep -c '^ptriangle: .*memory' .err)" -eq 1
            check "allocation $k: no file" test -z "$(ls two.* .tri-* 2>/dev/null)"
        fi
    done

    # --- the disk is full for the last of three tasks, in any of its writes: the same
    for output in two "${outputs##* }"; do
        for k in 1 4 16 64; do
            rm -f two.*
            of=3 with_one 2 "export LD_PRELOAD=./.shim.so PTRIANGLE_FAIL_WRITE=$k" any -Qpq30a0.001 letter \
                --output "$output"
            [ "$found" -ne 0 ] || break
            check "$output, write $k: exit code $found" test "$found" -eq 1
            check "$output, write $k: one line: $(head -n 3 .err)" test "$(grep -c 'No space left' .err)" -eq 1
            check "$output, write $k: no file" test -z "$(ls two.* .tri-* 2>/dev/null)"
        done
        check "$output: a write has failed" test "$k" -gt 1
    done

    # --- one task is killed there: all tasks end, and no file has its final name; other tasks, or one, resume to the
    # same bytes
    kept="--checkpoint state --resume state --every 0"
    n=1
    for k in $(spread "${PTRIANGLE_SHORT_RUNS:-2}"); do
        rm -f two.*
        # shellcheck disable=SC2086 # several words
        with_one $((k % 2)) "$shim PTRIANGLE_FAIL_KILL=1 PTRIANGLE_FAIL_AT=$k" any -Qpq30a0.01 letter --output two $kept
        check "killed at allocation $k: a failure" test "$found" -ne 0
        check "killed at allocation $k: no file" sh -c '! ls two.* 2>/dev/null'
        n=$((4 - n)) # 3, or 1 without a launcher
        [ -e state/piece-0-0 ] || n=3
        tries=0      # a task may outlive its launcher by a second, and locks the folder
        while [ $tries -lt 100 ]; do
            # shellcheck disable=SC2086
            if [ "$n" -gt 1 ]; then
                timeout 100 "$MPIEXEC" -n "$n" "$bin/ptriangle" -Qpq30a0.01 letter --output two $kept >.out 2>.err
            else
                timeout 100 "$bin/ptriangle" -Qpq30a0.01 letter --output two $kept >.out 2>.err
            fi
            found=$?
            grep -q 'in use by another process' .err || break
            sleep 0.1
            tries=$((tries + 1))
        done
        check "killed at allocation $k: $n go on" test "$found" -eq 0
        check "the same bytes afterwards" same_but_for_comments one.node two.node
        check "the same triangles afterwards" same_but_for_comments one.ele two.ele
        check "no checkpoint is left" test ! -e state
    done
    ranks 0 2 -Qpq30a0.01 letter --output two
    tries=0 # a task may outlive its launcher by seconds; the next run in the folder removes its files
    while ls .tri-* >/dev/null 2>&1 && [ $tries -lt 40 ]; do
        tries=$((tries + 1))
        sleep 0.5
        "$bin/ptriangle" -Qpq30a0.01 letter --output two >.out 2>.err
    done
    check "files of killed tasks are removed" test -z "$(ls .tri-* 2>/dev/null)"
fi

# --- stopped and resumed by other numbers of tasks: one task from the state of three, two from the state of one
program 0 -Qpq30a0.001 letter --output one
goes_on="-Qpq30a0.001 letter --output two --checkpoint state --resume state --every 0 --time-limit"
rm -f two.*
found=124
tries=0
while [ "$found" -eq 124 ] && [ $tries -lt 40 ]; do
    limit=$(awk -v n=$tries 'BEGIN { print 0.2 * 1.3 ^ n }')
    n=$(((tries + 1) % 3 + 1))
    [ -e state/piece-0-0 ] || n=3 # a single task would write a state of its own kind
    # shellcheck disable=SC2086
    if [ $n -gt 1 ]; then
        timeout 100 "$MPIEXEC" -n $n "$bin/ptriangle" $goes_on "$limit" >.out 2>.err
    else
        timeout 100 "$bin/ptriangle" $goes_on "$limit" >.out 2>.err
    fi
    found=$?
    what="$n ranks, for $limit s"
    in_time "$found"
    tries=$((tries + 1))
done
check "the same bytes by any number of resuming tasks" same_but_for_comments one.node two.node

# --- the owner of a checkpoint is checked before its run: the state of one task, swept or not, is refused by several
leave_state() { # N WORDS...: stops a run with a state, unless it finishes before
    n=$1
    shift
    limit=0.1
    until [ -e kept/state-0 ] || [ -e three.node ]; do
        rm -rf kept
        limit=$(echo "$limit" | awk '{ print $1 * 1.3 }')
        if [ "$n" -gt 1 ]; then
            timeout 100 "$MPIEXEC" -n "$n" "$bin/ptriangle" "$@" --output three --checkpoint kept --every 0 \
                --time-limit "$limit" >.out 2>.err
        else
            timeout 100 "$bin/ptriangle" "$@" --output three --checkpoint kept --every 0 --time-limit "$limit" \
                >.out 2>.err
        fi
        in_time $? || break
    done
}
for sweep in "" 1; do
    [ -z "$sweep" ] || export PTRIANGLE_TEST_SWEEP=1
    leave_state 1 -Qpq30a0.001 letter
    unset PTRIANGLE_TEST_SWEEP
    if [ -e kept ]; then
        ranks 1 2 -Qpq30a0.001 letter --output two --resume kept
        complains 'kept: is the checkpoint of one task$'
    fi
    rm -rf kept three.*
done
leave_state 2 -Qpq30a0.001 letter
if [ -e kept ]; then
    program 1 -Qpq30a0.001e letter --output two --resume kept
    complains '^kept: is the checkpoint of several tasks, but this run keeps the mesh as a whole$'
fi
rm -rf kept three.*

# --- outputs that need the whole mesh: the first task keeps it, like a single process; no task reads another's standard
# input
echo precious >.stdin
for output in "-e --output two" "--output two.vtu" "--output two.msh" "--output two.msh --parts 3"; do
    # shellcheck disable=SC2086 # several words
    program 0 -Qpq30a0.01 letter $output
    mkdir one
    mv two* one/
    # shellcheck disable=SC2086
    with_one 1 'exec <>.stdin' 0 -Qpq30a0.01 letter $output --checkpoint state --every 0
    for file in one/*; do
        grep -av '^#' "$file" >.one
        grep -av '^#' "${file#one/}" >.two
        check "the same except for the command: $output, $file" cmp .one .two
    done
    check "the standard input is whole" test "$(cat .stdin)" = precious
    check "no checkpoint is left" test ! -e state
    rm -rf one two*
done
program 0 -Qpq30a0.001e letter --output one
goes_on="-Qpq30a0.001e letter --output two --checkpoint state --resume state --every 0 --time-limit"
found=124
tries=0
while [ "$found" -eq 124 ] && [ $tries -lt 40 ]; do
    limit=$(awk -v n=$tries 'BEGIN { print 0.1 * 1.3 ^ n }')
    what="the whole, try $tries"
    if [ $((tries % 2)) -eq 0 ]; then
        # shellcheck disable=SC2086
        timeout 100 "$MPIEXEC" -n 2 "$bin/ptriangle" $goes_on "$limit" >.out 2>.err
    else
        # shellcheck disable=SC2086
        timeout 100 "$bin/ptriangle" $goes_on "$limit" >.out 2>.err
    fi
    found=$?
    tries=$((tries + 1))
done
check "exit code $found: $(head -n 3 .err)" test "$found" -eq 0
for suffix in node ele edge poly; do
    check "the same .$suffix by any number of resuming tasks" same_but_for_comments one.$suffix two.$suffix
done
rm -rf state two.*

# --- one task alone is asked to end: all tasks return its exit code
what="two ranks, one of them with a limit"
checks=$((checks + 1))
timeout 100 "$MPIEXEC" -n 2 sh -c 'rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}
    [ "$rank" -eq 0 ] || set -- "$@" --time-limit 0.001
    "$0" "$@"
    echo $? >".code$rank"' "$bin/ptriangle" -Qpq30a0.001 letter --output two --checkpoint state \
    >.out 2>.err
check "exit code of the first task" test "$(cat .code0)" -eq 124
check "exit code of the other task" test "$(cat .code1)" -eq 124
check "the checkpoint stays, as after any stop" test -e state/manifest
rm -rf state

# --- a signal to a task that waits for the first one, which would work for long: the first one is notified
what="a signal to the task that waits"
checks=$((checks + 1))
timeout 100 "$MPIEXEC" -n 2 sh -c 'rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}
    "$0" "$@" &
    echo $! >".pid$rank"
    wait $!
    echo $? >".code$rank"' "$bin/ptriangle" -Qpq30a0.00001e letter --output two --checkpoint state --every 0 \
    >.out 2>.err &
launcher=$!
while [ ! -e state/state-0 ] && kill -0 $launcher; do
    sleep 0.05
done
kill -TERM "$(cat .pid1)"
wait $launcher
check "exit code of the first task" test "$(cat .code0)" -eq 143
check "exit code of the other task" test "$(cat .code1)" -eq 143
check "it is reported once" test "$(grep -c 'stopped by SIGTERM after .* no file was written' .err)" -eq 1
check "the state is kept" grep -q 'to go on: ptriangle -Qpq30a0.00001e letter --output two --every 0 --resume state' .err
rm -rf state

# --- the same if each task refines its part: the triangles of all tasks count
what="a signal to one of two that refine"
checks=$((checks + 1))
timeout 100 "$MPIEXEC" -n 2 sh -c 'rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}
    "$0" "$@" &
    echo $! >".pid$rank"
    wait $!' "$bin/ptriangle" -Qpq30a0.00001 letter --output two --checkpoint state --every 0 >.out 2>.err &
launcher=$!
while [ ! -e state/piece-0-0 ] && kill -0 $launcher; do
    sleep 0.05
done
kill -TERM "$(cat .pid1)"
wait $launcher
complains 'stopped by .* while [a-z]+: about [0-9]+ triangles; no file was written'
check "both lines report the same number" test "$(grep -Eo '[0-9]+ triangles' .err | uniq | wc -l)" -eq 1
rm -rf state two.*

# --- stopped by the time limit, the first task writes the current mesh
ranks 124 2 -Qpq30a0.000003 letter --output two --write-partial --time-limit 2
check "it reports this" grep -q 'the mesh so far is written' .err
check "once" test "$(grep -c 'stopped by' .err)" -eq 1
check "the mesh exists" test -s two.ele
rm -f two.*

# --- one error, no file
fresh letter.poly
ranks 1 3 -Qpq30a0.01 absent.poly
check "one line" test "$(grep -c 'absent.poly: cannot open' .err)" -eq 1
ranks 1 2 -Qpq30a0.002 letter.poly --output "$PWD/absent/letter"
ranks 1 2 -Qpq30a0.002 letter.poly --resume absent
check "nothing is written" test -z "$(ls ./*.ele .tri-* 2>/dev/null)"
