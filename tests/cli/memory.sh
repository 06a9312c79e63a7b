# --memory bounds the process: a run keeps within it, or is refused early, with figures and without a file.
#
# The true size of blocks, so that what is held is what users see; inputs just large enough that budgets matter.
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
kept=0
refused=0
for switches in q20a0.000003 q33a0.000004 q20a0.000003S200000; do # swept, parked, one sequential call
    rm -f whole.h5 out.h5
    program 0 "-Qp$switches" s --output whole.h5
    for budget in 20 40 50 70 100; do
        what="ptriangle -p$switches --memory ${budget}000000"
        rm -f out.h5 out.xdmf
        "$python" "$data/../tests/cli/peak.py" "$budget"000000 "$bin/ptriangle" "-p$switches" s --output out.h5 \
            --memory "$budget"000000 --threads 2 >.out 2>.err
        found=$?
        checks=$((checks + 1))
        case $found in
        0) kept=$((kept + 1)) && check "the same bytes" cmp whole.h5 out.h5 ;;
        1)
            refused=$((refused + 1))
            complains 'which take [0-9.]+ [kMG]B of memory; [0-9.]+ [kMG]B are left'
            check "no file" sh -c '! ls out* .tri-* 2>/dev/null'
            ;;
        *) fault "exit code $found: $(head -n 1 .err)" ;;
        esac
    done
done
check "some runs are kept within ($kept), others refused ($refused)" test $kept -ge 6 -a $refused -ge 3
