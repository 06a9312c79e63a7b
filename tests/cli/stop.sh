# Stopped runs: exit code, one line, all files or none. The next run removes the files of a killed run.
#
# A pipe without a reader or writer blocks a program at a chosen point, so that no test depends on speed.
await() { # await COMMAND...: repeats the command until it succeeds
    tries=0
    until "$@" 2>/dev/null || [ $tries -ge 2400 ]; do
        tries=$((tries + 1))
        sleep 0.05
    done
    check "condition not met in time: $*" "$@"
}

# Outputs are opened once, empty, before the mesh is made, to check that they can be written.
is_there() { find . -name '.tri-*.tmp' -size +0c | grep -q .; }

if ! env --default-signal=INT true 2>/dev/null; then
    echo "cli stop: env cannot reset signals"
    checks=1
    return
fi

start() { # start PROGRAM WORDS...: in the background; a shell lets such jobs ignore some signals, which env undoes
    program=$1
    shift
    : >.out
    : >.err
    env --default-signal "$bin/$program" "$@" >.out 2>.err &
    job=$!
}

ended() { # ended CODE: the job ends with this code and prints one line, and no file is left
    wait $job 2>/dev/null
    found=$?
    checks=$((checks + 1))
    [ "$found" -eq "$1" ] || fault "exit code $found instead of $1: $(head -n 1 .err)"
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
}

# --- every signal, while files are written and while the program waits for input
for signal in HUP:1 INT:2 QUIT:3 TERM:15 ALRM:14 USR1:10 USR2:12 XCPU:24 VTALRM:26 PROF:27; do
    number=${signal#*:} # on Linux
    signal=${signal%:*}
    every 3 || continue
    for program in triangle ptriangle; do
        [ -x "$bin/$program" ] || continue
        fresh letter.poly
        echo old >letter.1.node
        mkfifo letter.1.ele
        ls >.before
        what="$program, SIG$signal while writing"
        start $program -p letter
        await is_there
        kill -s $signal $job
        ended $((128 + number))
        complains "stopped by SIG$signal (after [0-9.]+ s )?while writing(: [0-9]+ triangles)?; nothing was written"
        wrote
        check "the old file is kept" grep -qx old letter.1.node
    done
    fresh letter.poly
    mkfifo pipe.node
    what="triangle, SIG$signal while reading"
    ls >.before
    start triangle pipe.node
    exec 9>pipe.node # returns when the other end is also open
    kill -s $signal $job
    ended $((128 + number))
    exec 9>&-
    complains "stopped by SIG$signal (after [0-9.]+ s )?while reading; nothing was written"
    wrote
done

# --- a time limit
if [ -x "$bin/ptriangle" ]; then
    fresh letter.poly
    mesher 124 ptriangle -Qpq30a0.000005 letter --threads 1 --time-limit 0.3
    complains "stopped by the time limit( after [0-9.]+ s)? while [a-zA-Z ]+"
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
    wrote

    # --- writing the current mesh
    what="ptriangle --write-partial"
    report="--report report.json"
    "$bin/ptriangle" -p none $report 2>&1 | grep -q 'without the library jansson' && report=""
    # shellcheck disable=SC2086 # two words or none
    start ptriangle -pq30a0.000005 letter --threads 1 --write-partial $report --progress
    await grep -q 'refining' .err
    kill -s TERM $job
    wait $job 2>/dev/null
    check "exit code" test $? -eq 143
    complains "stopped by SIGTERM .* while refining: [0-9]+ triangles, [0-9]+ of them below the bounds; the mesh so far is written"
    counted=$(sed -n 's/.*while refining: \([0-9]*\) triangles.*/\1/p' .err)
    check "all triangles are counted, including those of running blocks" sh -c "head -1 letter.1.ele | grep -q '^$counted '"
    wrote letter.1.node letter.1.ele letter.1.poly ${report:+report.json}
    judge letter.1 --poly letter.poly
    [ -z "$report" ] || check "the report contains it" grep -q '"stopped": "SIGTERM"' report.json
    fresh letter.poly
    mesher 0 ptriangle -Qpq30a0.01 letter --time-limit 2h --write-partial
    judge letter.1 --poly letter.poly --min-angle 30 --max-area 0.01
    for limit in 0 -1 x 1x 1mm nan 1e99; do
        mesher 1 ptriangle -p letter --time-limit "$limit"
        complains 'time-limit: '
    done

    # --- the content of a checkpoint in the middle of a sweep's first column
    fresh letter.poly
    ls >.before
    what="ptriangle --checkpoint, stopped amid a column"
    export PTRIANGLE_TEST_SWEEP=1
    start ptriangle -pq30a0.000005 letter --threads 2 --output out --checkpoint state --progress
    unset PTRIANGLE_TEST_SWEEP
    await grep -q 'refining: column 1 of ' .err
    kill -s TERM $job
    wait $job 2>/dev/null
    check "exit code" test $? -eq 143
    complains '^ptriangle: stopped by SIGTERM after .* while refining: about [1-9][0-9]* triangles; no file was written$'
    check "the last line lists the kept files" sh -c 'tail -n 1 .err | grep -Eq \
        "^ptriangle: [1-9][0-9]* triangles are kept; to go on: ptriangle -pq30a0.000005 .*--progress --resume state\$"'
    check "it is not reported as refined" sh -c '! grep -Eq "refined to|-[0-9]+/s" .err'
    check "the state is there" test -s state/state-0
    check "no file" test -z "$(ls out* .tri-* 2>/dev/null)"
    rm -rf state

    # --- a program that is asked to end does not wait for a blocked output: a pipe without a reader
    for area in "" q30a0.01; do
        fresh letter.poly
        mkfifo letter.1.ele
        ls >.before
        what="ptriangle -p$area --checkpoint, while a pipe is opened"
        PTRIANGLE_TEST_BLOCK=60 start ptriangle "-p$area" letter --checkpoint state --every 0
        await grep -q 'Writing letter.1.ele' .out # as soon as the line is printed
        kill -s TERM $job
        wait $job 2>/dev/null
        check "exit code" test $? -eq 143
        if [ -n "$area" ]; then
            complains 'stopped by SIGTERM while writing(: [0-9]+ triangles)?; no file was written$'
            complains '^ptriangle: [1-9][0-9]* triangles are kept; to go on: '
            rm letter.1.ele
            PTRIANGLE_TEST_BLOCK=60 mesher 0 ptriangle "-Qp$area" letter --resume state
            PTRIANGLE_TEST_BLOCK=60 mesher 0 ptriangle "-Qp$area" letter --output again
            check "the same mesh" sh -c 'grep -v "^#" letter.1.ele >.one; grep -v "^#" again.ele | cmp -s - .one'
            rm -f .one again.*
            wrote letter.1.node letter.1.poly
        else
            complains 'stopped by SIGTERM while writing(: [0-9]+ triangles)?; nothing was written, and nothing is kept$'
            rm -rf state
            wrote
        fi
    done

    # --- no file is written twice, and no input is overwritten
    fresh letter.poly
    cksum letter.poly >.expected
    ln -s letter.poly link
    ln letter.poly second
    ln -s nowhere dangling
    ls >.before
    for words in "--report letter.poly" "--report link" "--blocks second" "--report ./letter.1.node" "--report a --blocks a" \
        "--report dangling --blocks nowhere" "--report ../${PWD##*/}/b --blocks b" "--output letter"; do
        case $words in --report*) [ -n "$report" ] || continue ;; esac
        # shellcheck disable=SC2086 # several words
        mesher 1 ptriangle -p letter $words
        complains 'would be (overwritten|written twice)'
        wrote
    done
    cksum letter.poly | cmp -s - .expected || fault "the input has changed"
    mesher 0 ptriangle -pQ letter ${report:+--report /dev/null} --blocks /dev/null
    if [ -e /dev/full ]; then
        fresh letter.poly
        for words in "--report /dev/full" "--blocks /dev/full"; do
            case $words in --report*) [ -n "$report" ] || continue ;; esac
            # shellcheck disable=SC2086
            mesher 1 ptriangle -pq letter $words
            complains '^/dev/full: cannot write'
            wrote
        done
    fi

    # --- more threads than the system allows
    fresh letter.poly
    OMP_NUM_THREADS=100000 mesher 0 ptriangle -pqQ letter
    judge letter.1 --poly letter.poly --min-angle 20

    # --- estimates
    fresh letter.poly
    mesher 0 ptriangle -pq30a0.001 letter --dry-run
    matches '^  Triangles: 7[0-9][.][0-9] thousand$'
    matches '^  Memory: [0-9.]+ MB'
    matches '^  Disk: [0-9.]+ [kM]B'
    matches '^  Time: (under )?[0-9.]+ s on [0-9]+ thread'
    wrote
    mesher 0 ptriangle -pq30a0.1 letter --dry-run
    matches '^  Triangles: [1-9][0-9]+$'
    matches '^  Vertices: [1-9][0-9]+$'
    mesher 1 ptriangle -pna0.0000001 letter --dry-run
    matches '^  Triangles: [0-9.]+ [mb]illion$'
    complains 'triangles, and a mesh holds 537 million where it must be there as a whole, as for -n .neighbours.$'
    wrote
    # certainly 0.93 times the limit on triangles, likely 1.06 times
    fresh square.poly
    mesher 1 ptriangle -pna0.000000002 square.poly --dry-run
    complains '^ptriangle: the bounds ask for about 5[67][0-9] million triangles, and a mesh holds 537 million where it must '
    wrote

    # --- a bound on memory
    fresh square.poly
    for words in "" --dry-run; do
        # shellcheck disable=SC2086 # none or one
        mesher 1 ptriangle -pqna0.00000003 square --memory 200M $words
        complains 'the bounds ask for about [0-9.]+ [mb]illion triangles, which take [0-9.]+ [MG]B of memory; [1-9][0-9]+ MB are left; --memory [0-9]+M would do$'
        wrote
    done
    mesher 1 ptriangle -p square --memory 4GB
    complains '^ptriangle: --memory: "4GB" is not a size such as 500M, 4G or 60%, from 1M on$'
fi
# area divided by bound is 1.03 times the limit on triangles; without the lattice, 0.83 times is already too much
fresh square.poly
mesher 1 triangle -pa.0000000018 square
complains 'the area bounds ask for at least [0-9.]+ [mb]illion triangles, and a mesh holds 537 million'
mesher 1 triangle -pa.00000000226 square --placement classic
complains 'the area bounds ask for at least [0-9.]+ [mb]illion triangles, and a mesh holds 537 million'
wrote
# far above the limit, the number is still readable
mesher 1 triangle -pa.00000000000000000000000000000000000000001 square
complains 'the area bounds ask for at least over 1000 trillion triangles, and a mesh holds 537 million'
wrote
if (ulimit -v 400000 && "$bin/triangle" -h) >/dev/null 2>&1; then
    what="little memory"
    (
        ulimit -v 400000
        "$bin/triangle" -pqa0.00000003 square >.out 2>.err
    )
    check "exit code" test $? -eq 1
    complains 'the bounds ask for about [0-9.]+ [mb]illion triangles, which take [0-9.]+ GB of memory; [0-9.]+ [kMG]?B are left'
    wrote
fi

# --- a name with a line break
fresh
mesher 1 triangle -p "a
b"
complains '^a\\nb\.poly: cannot open'
check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'

# --- files of a killed process
fresh letter.poly
mkfifo letter.1.ele
ls >.before
what="killed outright"
start triangle -p letter
await is_there
kill -9 $job
wait $job 2>/dev/null
check "something is left" is_there
rm letter.1.ele
host=$(ls .tri-*-$job-0.tmp | sed "s/^\.tri-//; s/-$job-0\.tmp\$//")
: >".tri-$host-$$-0.tmp"            # of a running process
: >".tri-another-host-99999999-0.tmp"
: >".tri-$host-99999999-x.tmp"      # not one of our files
ls -A | grep -v "^\.tri-$host-$job-" | grep -v '^\.before$' >.keep
mv .keep .before
mesher 0 triangle -p letter
wrote letter.1.node letter.1.ele letter.1.poly
check "another program's file is kept" test -f ".tri-$host-$$-0.tmp" -a -f .tri-another-host-99999999-0.tmp
rm -f .tri-*
