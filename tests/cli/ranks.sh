# ptriangle as several tasks of a launcher: the same files as one process writes, by the first task; errors in one voice.
# MPIEXEC is the launcher of the MPI that the program was built for; empty: it was built without.
# shellcheck disable=SC2154 # bin is of run.sh
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl=self,vader,tcp OMP_NUM_THREADS=1 PTRIANGLE_TEST_BLOCK=500
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe
export OMPI_MCA_mpi_yield_when_idle OMPI_MCA_btl OMP_NUM_THREADS PTRIANGLE_TEST_BLOCK

# ranks CODE N WORDS...: a hang is a failure
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

# --- tasks that are not of this MPI
fresh letter.poly
what="tasks of a launcher that is none"
checks=$((checks + 1))
SLURM_STEP_NUM_TASKS=3 SLURM_PROCID=0 "$bin/ptriangle" -Qpq30a0.01 letter >.out 2>.err </dev/null
[ $? -eq 1 ] || fault "not refused"
check "it is told once" grep -q 'started as 3 tasks' .err
check "nothing is written" test ! -e letter.1.ele
if [ -z "${MPIEXEC:-}" ]; then
    return
fi

# --- the same bytes
fresh letter.poly section.poly
for case in "-pq30a0.002 letter" "-pq28aA section" "-pq33a0.01 letter" "-pq30a0.01e section" "-p letter"; do
    file=${case##* }
    # shellcheck disable=SC2086 # several words
    program 0 -Q $case
    mkdir one
    mv "$file".1.* one/
    # shellcheck disable=SC2086
    ranks 0 3 -Q $case
    for name in one/*; do
        check "the same bytes: $case, $name" cmp "$name" "${name#one/}"
    done
    rm -rf one "$file".1.*
done

# --- one error, no file
ranks 1 3 -Qpq30a0.01 absent.poly
check "one line" test "$(grep -c 'absent.poly: cannot open' .err)" -eq 1
ranks 1 2 -Qpq30a0.002 letter.poly --output "$PWD/absent/letter"
ranks 1 2 -Qpq30a0.002 letter.poly --checkpoint state
check "nothing is written" test -z "$(ls ./*.ele .tri-* 2>/dev/null)"
