#!/bin/sh
# Real ranks: runs the client tests/client/ranks.c under every installed MPI, with more ranks than cores, on inputs of
# several kinds. A hang is a failure: each run has a time limit.
# Usage: run_mpi.sh SOURCE_ROOT BUILD_DIR WORK_DIR C_COMPILER "RANKS..." [OPTIONS...]
# With a single number of ranks, only one input is tested.
set -u
root=$1
build=$2
work=$3
compiler=$4
counts=$5
shift 5
mkdir -p "$work"
failed=0
found=0
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1
OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl=self,vader,tcp OMPI_MCA_mpi_yield_when_idle=1
PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe # from OpenMPI 5 on
export PRTE_MCA_rmaps_default_mapping_policy
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMP_NUM_THREADS
OMPI_CC=$compiler MPICH_CC=$compiler # the compiler of the libraries, which matches their OpenMP
export OMPI_CC MPICH_CC OMPI_MCA_rmaps_base_oversubscribe OMPI_MCA_btl OMPI_MCA_mpi_yield_when_idle

# try WANTED_CODE RANKS FILE ANGLE AREA
try() {
    wanted=$1
    n=$2
    shift 2
    timeout 200 "$run" -n "$n" "$work/$mpi" "$@" >"$work/out" 2>&1
    code=$?
    echo "$mpi, $n ranks: $*: $(head -n 1 "$work/out")"
    if [ "$code" -ne "$wanted" ]; then
        echo "mpi: exit code $code instead of $wanted"
        cat "$work/out"
        failed=1
    fi
}

for mpi in openmpi mpich; do
    command -v "mpicc.$mpi" >/dev/null && command -v "mpirun.$mpi" >/dev/null || continue
    run=mpirun.$mpi
    found=$((found + 1))
    "mpicc.$mpi" -std=c11 -g -D_POSIX_C_SOURCE=200809L "$@" -I"$root" -I"$root/include" "$root/tests/client/ranks.c" \
        "$root/sched/ranks/mpi.c" -o "$work/$mpi" -L"$build" -lptriangle -lptriangle-files -ltriangle -lstdc++ -lm -fopenmp ||
        { failed=1; continue; }
    for n in $counts; do
        try 0 "$n" "$root/data/letter.poly" 30 0.0005
        [ "$counts" != "$n" ] || continue # a single number: a quick test
        try 0 "$n" "$root/data/coast/norway_sea.poly" 25 5e6
        try 0 "$n" "$root/data/square.poly" 33 0.00001
        try 0 "$n" "$root/data/section.poly" 30 0.005
        try 0 "$n" "$root/data/square.poly" 0 0
    done
    try 1 3 "$work/absent.poly" 30 0.01
done
if [ "$found" -eq 0 ]; then
    echo "mpi: neither mpicc.openmpi nor mpicc.mpich is here"
    exit 77
fi
exit "$failed"
