# --memory limits the process: a run stays within the bound, or is refused early with figures and without writing a
# file.
#
# Blocks have their normal size, so that the memory is that of real runs. Inputs are just large enough for the bounds to
# matter.
python=$(command -v python3) || { echo "cli memory: no Python"; checks=1; return; }
fresh square_random1000.poly
mv square_random1000.poly s.poly
if ! "$bin/ptriangle" -Qp s --output .try.h5 >/dev/null 2>&1; then
    echo "cli memory: a build without HDF5"
    checks=1
    return
fi
rm -f .try.*
case $(file -b "$bin/ptriangle" 2>/dev/null; ldd "$bin/ptriangle" 2>/dev/null) in
*libasan* | *libtsan* | *libubsan*) echo "cli memory: sanitizers have memory of their own"; checks=1; return ;;
esac
# BUDGET CODE MESSAGE COMMAND...: runs within this many MB, counted by `kept`, or is refused with this code and message
within() {
    budget=${1}000000
    code=$2
    message=$3
    shift 3
    "$python" "$data/../tests/cli/peak.py" "$budget" "$@" --memory "$budget" --threads 2 >.out 2>.err
    found=$?
    checks=$((checks + 1))
    case $found in
    0) kept=$((kept + 1)) ;;
    "$code") refused=$((refused + 1)) && complains "$message" ;;
    *) fault "exit code $found: $(head -n 1 .err)" ;;
    esac
}

kept=0
refused=0
for switches in q20a0.000003 q33a0.000004 q20a0.000003S200000; do # swept, parked, one sequential call
    every 3 || continue
    rm -f whole.h5 out.h5
    program 0 "-Qp$switches" s --output whole.h5
    for budget in 20 40 50 70 75 100; do
        what="ptriangle -p$switches --memory ${budget}000000"
        rm -f out.h5 out.xdmf
        within $budget 1 'which take [0-9.]+ [kMG]?B of memory; [0-9.]+ [kMG]?B are left' \
            "$bin/ptriangle" "-p$switches" s --output out.h5
        case $found in
        0) check "the same bytes" cmp whole.h5 out.h5 ;;
        *) check "no file" test -z "$(ls out* .tri-* 2>/dev/null)" ;;
        esac
    done
done

# --- outputs that need the whole mesh get it, in files as far as it does not fit in memory. A refusal names a bound
# --- that is enough, and that bound works
for switches in "q20a0.000003 --write-partial" q20a0.000003evn q33a0.000004o2 "q20a0.000003C --output out.h5"; do
    every 2 || continue
    rm -f out*
    # shellcheck disable=SC2086 # several words
    program 0 -Qp$switches s --output out --threads 2
    sed '/^# Generated/d' out* | cksum >.whole
    for budget in 30 50 60; do
        what="ptriangle -p$switches --memory ${budget}000000"
        rm -f out*
        # shellcheck disable=SC2086
        "$python" "$data/../tests/cli/peak.py" "$budget"000000 "$bin/ptriangle" -Qp$switches s --output out \
            --memory "$budget"000000 --threads 2 >.out 2>.err
        found=$?
        checks=$((checks + 1))
        if [ $found -eq 1 ]; then
            complains 'which take [0-9.]+ [kMG]?B of memory; [0-9.]+ [kMG]?B are left; --memory [0-9]+M would do$'
            check "no file" test -z "$(ls out* .tri-* 2>/dev/null)"
            enough=$(sed -n 's/.*--memory \([0-9]*M\) would do.*/\1/p' .err)
            # shellcheck disable=SC2086
            program 0 -Qp$switches s --output out --threads 2 --memory "$enough"
            found=$?
        fi
        [ $found -eq 0 ] || fault "exit code $found: $(head -n 1 .err)"
        check "the same bytes" sh -c "sed '/^# Generated/d' out* | cksum | cmp -s - .whole"
    done
done
# If only writing parks the mesh, because of the lists beside it, this is also reported.
what="ptriangle -o2j -S --memory"
rm -f out*
program 0 -Qpq20a0.000002o2jS260000 s --output out --threads 2 --memory 55M --report out.json
check "parking is reported" grep -q '"way": "parked"' out.json
full && least=3 || least=1
check "some runs are kept within ($kept), others refused ($refused)" \
    test $kept -ge $((2 * least)) -a $refused -ge $least

# --- a small mesh needs less memory than the buffers of a sweep
cp "$data/coast/borders.poly" .
what="ptriangle --memory as the dry run says"
"$bin/ptriangle" -Qpq20 borders --output b.h5 --dry-run >.out
enough=$(sed -n 's/^  Memory: \([0-9]*\)[.0-9]* MB .*/\1/p' .out)
program 0 -Qpq20 borders --output b.h5 --memory "$((enough + 2))000000"

# --- a limit of the process works like the option: a run that would exceed it is refused before the work
if (ulimit -v 300000 && "$bin/ptriangle" -h) >/dev/null 2>&1; then
    what="ulimit -v, much to do"
    rm -f out.h5
    (
        ulimit -s 8192
        ulimit -v 300000
        "$bin/ptriangle" -Qpq20a0.0000002S100000000 s --output out.h5 --threads 2 >.out 2>.err
    )
    check "exit code" test $? -eq 1
    complains 'the bounds ask for about [0-9.]+ [a-z]+ triangles, which take [0-9.]+ [kMG]?B of memory; [0-9.]+ [kMG]?B are left'
    what="ulimit -v, little to do"
    (
        ulimit -s 8192
        ulimit -v 300000
        "$bin/ptriangle" -Qpq20a0.000003S200000 s --output out.h5 --threads 2 >.out 2>.err
    )
    check "exit code" test $? -eq 0
    full || program 0 -Qpq20a0.000003S200000 s --output whole.h5
    check "the same bytes" cmp whole.h5 out.h5
fi

# --- input without refinement, or a mesh that is read, is in memory: it fits, or is refused beforehand
rm -f ./*
awk 'BEGIN { n = 100000; print n, 2, 0, 0; srand(1); for (i = 1; i <= n; i++) print i, rand(), rand() }' >p.node
awk 'BEGIN { n = 200; print n * n, 2, 0, 0; for (i = 0; i < n * n; i++) print i + 1, i % n, int(i / n)
    print 2 * n * (n - 1), 0
    for (i = 1; i <= n * n; i++) { if (i % n) print ++s, i, i + 1; if (i + n <= n * n) print ++s, i, i + n }
    print 0 }' >g.poly
program 0 -Q p --output q
kept=0
refused=0
for input in "-Qe p" "-Qp g.poly" "-QrI q"; do
    for budget in 18 44; do
        what="ptriangle $input --memory ${budget}000000"
        message=' takes about [0-9.]+ [kMG]?B of memory; there are [0-9.]+ [kMG]?B$'
        message="$message|the input has [0-9.]+ [kMG]?B of text, which is read into memory; "
        # shellcheck disable=SC2086 # several words
        within $budget 1 "$message" "$bin/ptriangle" $input --output out
        [ $found -eq 0 ] || check "no file" test -z "$(ls out* .tri-* 2>/dev/null)"
        rm -f out.*
    done
done
check "with much memory runs are kept within ($kept), with little refused ($refused)" test $kept -eq 3 -a $refused -eq 3
program 1 p --output out --memory 1M
complains '^ptriangle: the input has [0-9.]+ [kM]?B of text, which is read into memory; 0 B are left$'

# --- the self check uses only memory that the mesh leaves free, even if all subsegments are boundary
awk 'BEGIN { n = 30000; print n + 2, 2, 0, 0; for (i = 0; i < n; i++) print i + 1, i, 2 + i % 2
    print n + 1, n - 1, 0; print n + 2, 0, 0; print n + 2, 0
    for (i = 1; i <= n + 2; i++) print i, i, i % (n + 2) + 1; print 0 }' >z.poly
for budget in 24 28; do
    what="ptriangle -pqC, --memory ${budget}000000"
    "$python" "$data/../tests/cli/peak.py" "$budget"000000 "$bin/ptriangle" -Qpq20C z --output z1 \
        --memory "$budget"000000 --threads 2 >.out 2>.err
    found=$?
    check "within the bound, or refused: exit code $found" test $found -le 1
    [ $found -eq 0 ] || complains '--memory [0-9]+M would do$'
done

# --- HDF5's memory also counts if nothing is refined, or if refinement adds no points
cp "$data/square.poly" t.poly
for run in "p g" "pD t"; do
    for budget in 20 33 60; do
        what="ptriangle -$run, nothing refined"
        # shellcheck disable=SC2086 # two words
        "$python" "$data/../tests/cli/peak.py" "$budget"000000 "$bin/ptriangle" -Q$run.poly --output g1.h5 \
            --memory "$budget"000000 --threads 2 >.out 2>.err
        found=$?
        check "within ${budget}000000, or refused: exit code $found" test $found -le 1
    done
done
rm -f g1.h5 g1.xdmf

# --- the checker: memory needed beside the parts of a mesh fits, or the run is refused beforehand
program 0 -Qp g.poly --output g1
what="trianglecheck of many subsegments"
"$python" "$data/../tests/cli/peak.py" 40000000 "$bin/trianglecheck" --quiet g1 --poly g.poly --memory 40000000 \
    --threads 2 >.out 2>.err
check "with enough memory: exit code" test $? -eq 0
"$bin/trianglecheck" --quiet g1 --poly g.poly --memory 12M >.out 2>.err
check "with little memory: exit code" test $? -eq 2
complains '^trianglecheck: to judge 40 thousand vertices .* takes about [0-9.]+ MB of memory; 12 MB may be used$'

# --- if all subsegments are boundary, the checker also keeps its bound, or prints how much it needs
program 0 -Qp z.poly --output z2
kept=0
refused=0
for words in "" "--poly z.poly"; do
    for budget in 11 14 18 30; do
        what="trianglecheck $words of a boundary, --memory ${budget}000000"
        # shellcheck disable=SC2086 # several words
        within $budget 2 '^trianglecheck: to judge 30 thousand vertices .* takes about [0-9.]+ MB of memory; ' \
            "$bin/trianglecheck" --quiet z2 $words
    done
done
check "with much memory trials are kept within ($kept), with little refused ($refused)" \
    test $kept -ge 2 -a $refused -ge 2

# --- without a list of the boundary, the checker finds it while reading: holes make the boundary three times as long
rm z2.poly
within 18 2 none "$bin/trianglecheck" --quiet z2
check "a mesh without a list is judged in little memory" test $found -eq 0
cp q.node q3.node # every third triangle is a hole
awk '!/#/ && NF > 3 && $1 % 3 { print ++n, $2, $3, $4 }' q.ele >rows
{ echo "$(wc -l <rows) 3 0" && cat rows; } >q3.ele
kept=0
refused=0
for budget in 20 40 60 100; do
    what="trianglecheck of many holes, --memory ${budget}000000"
    within $budget 2 '^trianglecheck: to judge .* takes about [0-9.]+ MB of memory; ' "$bin/trianglecheck" --quiet q3
done
check "with much memory trials are kept within ($kept), with little refused ($refused)" \
    test $kept -ge 1 -a $refused -ge 1

# --- the bound of a control group (a container) of less than 100 MB: kept or refused; the kernel kills no process
group=/sys/fs/cgroup/memory/ptriangle-test-$$
if (ulimit -v 400000 && "$bin/ptriangle" -h) >/dev/null 2>&1 && mkdir "$group" 2>/dev/null; then
    for bound in 40 60; do
        fresh letter.poly
        what="ptriangle in a group of $bound MB"
        echo ${bound}M >"$group/memory.limit_in_bytes"
        sh -c 'echo $$ >"$1/cgroup.procs" && exec "$2/ptriangle" -Qpq30a0.0001 letter --output o' sh "$group" "$bin" \
            >.out 2>.err
        found=$?
        check "exit code $found" test $found -le 1
        [ $found -eq 0 ] || complains 'triangles, which take [0-9.]+ MB of memory; [0-9.]+ MB are left'
    done
    rmdir "$group"
fi
