#!/bin/sh
# Builds without MPI, HDF5, cairo, jansson, OpenMP and Python: hides one of them at a time, configures, builds and runs
# the fast tests. Takes a quarter of an hour on two cores, so it is meant for once a week.
# Usage: tools/without.sh [NAME...]       default: mpi hdf5 cairo jansson openmp python
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- mpi hdf5 cairo jansson openmp python

hide() { # prints the CMake option that hides the library, as on a machine without it
    case $1 in
    mpi) echo -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON ;;
    hdf5) echo -DHDF5_LIBRARY=OFF ;;
    cairo) echo -DCAIRO_LIBRARY=OFF ;;
    jansson) echo -DJANSSON_LIBRARY=OFF ;;
    openmp) echo -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON ;;
    python) echo -DPTRIANGLE_PYTHON=OFF ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2; return 2 ;;
    esac
}

for name; do
    hide "$name" >/dev/null
done
builds=${PTRIANGLE_BUILD:-build}
failed=""
for name; do
    echo "==== without $name"
    log=$builds/without-$name.log
    mkdir -p "$builds"
    rm -rf "$builds/without-$name"
    PTRIANGLE_BUILD=$builds/without-$name tools/build.sh debug "$(hide "$name")" >"$log" 2>&1 ||
        { tail -n 30 "$log"; failed="$failed $name"; continue; }
    grep -i "^-- no $name" "$log" || { echo "without: $name is not hidden"; failed="$failed $name"; continue; }
    ctest --test-dir "$builds/without-$name/debug" -L fast --output-on-failure --no-tests=error \
        --parallel "$(nproc 2>/dev/null || echo 2)" >"$log" 2>&1 || { cat "$log"; failed="$failed $name"; continue; }
    grep 'tests passed' "$log"
    rm -rf "$builds/without-$name" "$log"
done
[ -z "$failed" ] || { echo "without:$failed: failed"; exit 1; }
