#!/bin/sh
# Installs a build into a scratch prefix, moves the prefix, and builds and runs tests/client/ against it: as a C project
# through find_package, and by hand through pkg-config.
# A client of Triangle's interface is linked to the sequential and to the parallel library, and must print the same.
# MPIEXEC, MPI_C_COMPILER: launcher and compiler of the build's MPI; empty if it has none.
# PTRIANGLE_MODULE_DIR: path from the folder of the programs to that of the modules; empty if there are none.
# Usage: run_client.sh BUILD_DIR WORK_DIR CMAKE C_COMPILER
set -eu
build=$1
work=$2
cmake=$3
cc=$4
client=$(cd "$(dirname "$0")/client" && pwd)
square=$client/../../data/square.poly

rm -rf "$work"
mkdir -p "$work"
"$cmake" --install "$build" --prefix "$work/staged" >"$work/install.log"
mv "$work/staged" "$work/prefix"

echo "== find_package"
"$cmake" -S "$client" -B "$work/cmake" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCMAKE_BUILD_TYPE=Release ${MPI_C_COMPILER:+"-DMPI_C_COMPILER=$MPI_C_COMPILER"}
"$cmake" --build "$work/cmake"
"$work/cmake/client" "$square"

echo "== pkg-config"
if ! command -v pkg-config >/dev/null; then
    echo "pkg-config is not installed: this part was not tested" >&2
    exit 1
fi
if "$cc" -std=c11 "$client/client.c" -o "$work/unaided" 2>/dev/null; then
    echo "the client compiles without pkg-config: this part would test nothing" >&2
    exit 1
fi
pc=$(find "$work/prefix" -name ptriangle.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
eval "set -- $(pkg-config --cflags --libs ptriangle)" # split into words by a shell, since blanks in a path are quoted
"$cc" -std=c11 "$client/client.c" -o "$work/by_hand" "$@"
"$work/by_hand" "$square"

echo "== a client of Triangle, relinked"
directory=$(dirname "$(dirname "$pc")") # the folder of the libraries
# takes PROGRAM yes|no: was the parallel triangulate() linked?
takes() {
    if nm "$1" | grep -q ' par_refine$'; then found=yes; else found=no; fi
    [ "$found" = "$2" ] || { echo "$1: parallel: $found, expected $2" >&2; exit 1; }
}
"$work/cmake/dropin" >"$work/sequential.txt"
takes "$work/cmake/dropin" no
eval "set -- $(pkg-config --cflags triangle)"
"$cc" -std=c11 -c "$client/dropin.c" "$@" -o "$work/dropin.o"
"$cc" "$work/dropin.o" -L "$directory" -ltriangle -lm -o "$work/relinked"
takes "$work/relinked" no
"$work/relinked" | diff - "$work/sequential.txt"
if [ -x "$work/cmake/dropin_parallel" ]; then
    "$work/cmake/dropin_parallel" | diff - "$work/sequential.txt"
    takes "$work/cmake/dropin_parallel" yes
    "$cc" "$work/dropin.o" -L "$directory" -lptriangle -ltriangle -lm -fopenmp -o "$work/relinked"
    takes "$work/relinked" yes
    "$work/relinked" | diff - "$work/sequential.txt"
    for threads in 1 2 5; do
        OMP_NUM_THREADS=$threads "$work/relinked" pcqa0.0001zQ
    done | uniq >"$work/sizes.txt"
    cat "$work/sizes.txt"
    [ "$(wc -l <"$work/sizes.txt")" -eq 1 ]
fi

echo "== a stream"
if [ -x "$work/cmake/stream" ]; then
    for memory in 0 30; do # no limit, and less memory than the mesh needs
        "$work/cmake/stream" "$square" 20 0.000003 $memory "$work"
    done | uniq >"$work/streams.txt"
    cat "$work/streams.txt"
    grep -Eq 'area (1\.0000000000|0\.9999999999)' "$work/streams.txt"
    [ "$(sed 's/ in .* tiles//' "$work/streams.txt" | uniq | wc -l)" -eq 1 ]
fi

echo "== ranks"
if [ -n "${MPIEXEC:-}" ]; then
    OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 \
        PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe \
        timeout 100 "$MPIEXEC" -n 2 "$work/cmake/ranks" "$square" 30 0.00002
fi

echo "== executables"
for program in "$build/bin/"*; do
    installed=$work/prefix/bin/$(basename "$program")
    [ ! -x "$program" ] || [ -x "$installed" ] || { echo "not installed: $program" >&2; exit 1; }
    page=$work/prefix/share/man/man1/$(basename "$program").1
    module=${PTRIANGLE_MODULE_DIR:-none}/$(basename "$program").so
    [ ! -f "$build/bin/$module" ] || [ -f "$work/prefix/bin/$module" ] || { echo "not installed: $module" >&2; exit 1; }
    [ ! -d "$build/documents" ] || [ -f "$page" ] || { echo "not installed: $page" >&2; exit 1; }
done
cp "$square" "$work/"
"$work/prefix/bin/triangle" -pQ "$work/square.poly"
"$work/prefix/bin/trianglecheck" "$work/square.1" --poly "$work/square.poly"
if "$build/bin/ptriangle" -pQ "$work/square.poly" --output "$work/square.h5" 2>/dev/null; then
    "$work/prefix/bin/ptriangle" -pQ "$work/square.poly" --output "$work/moved.h5"
    "$work/prefix/bin/trianglecheck" "$work/moved.h5" --poly "$work/square.poly"
fi
