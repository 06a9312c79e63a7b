#!/bin/sh
# Builds the package in the forms that users need: static from an existing build, shared from a build of its own, and as
# a subproject. Clients are a project in pure C++, the C clients of tests/client/, and commands built from pkg-config's
# output.
# Usage: run_package.sh SOURCE_ROOT BUILD_DIR WORK_DIR CMAKE C_COMPILER CXX_COMPILER
set -eu
root=$1
build=$2
work=$3
cmake=$4
cc=$5
cxx=$6
client=$root/tests/client
version=$(sed -n 's/^project(ptriangle VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")

fail() { echo "package: $*" >&2; exit 1; }

# errors LOG: prints the errors of a parallel build, whose last lines may belong to a job that succeeded
errors() { grep -iE -A 2 'error|undefined' "$1" | head -n 20; tail -n 5 "$1"; }

configure() { # configure FOLDER OPTION...
    folder=$1
    shift
    "$cmake" -S "$root" -B "$folder" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Debug "$@" \
        >"$folder.log" 2>&1 || fail "$folder: $(tail -n 5 "$folder.log")"
}

use() { # use PREFIX FOLDER: builds and runs all clients with the package installed there
    "$cmake" -S "$client/cxx" -B "$2/cxx" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$1" >"$2.cxx.log" 2>&1 ||
        fail "find_package in C++: $(tail -n 5 "$2.cxx.log")"
    "$cmake" --build "$2/cxx" >>"$2.cxx.log" 2>&1 || fail "clients in C++: $(tail -n 20 "$2.cxx.log")"
    for std in 11 20; do
        "$2/cxx/client_triangle_$std"
        "$2/cxx/client_ptriangle_$std"
    done
    "$cmake" -S "$client" -B "$2/c" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$1" >"$2.c.log" 2>&1 ||
        fail "find_package in C: $(tail -n 5 "$2.c.log")"
    "$cmake" --build "$2/c" >>"$2.c.log" 2>&1 || fail "clients in C: $(tail -n 20 "$2.c.log")"
    "$2/c/client" "$root/data/square.poly"
    "$2/c/dropin" >"$2.sequential"
    "$2/c/dropin_parallel" | cmp - "$2.sequential"
}

rm -rf "$work"
mkdir -p "$work"
cd "$work"

echo "== static"
"$cmake" --install "$build" --prefix "$work/static" >install.log
mkdir static_clients
use "$work/static" static_clients

echo "== shared, under another prefix of names"
configure shared -DBUILD_SHARED_LIBS=ON -DPTRIANGLE_PROGRAMS=OFF -DPTRIANGLE_PREFIX=pt-
"$cmake" --build shared --parallel 2 >shared.log 2>&1 || fail "shared: $(errors shared.log)"
"$cmake" --install shared --prefix "$work/staged" >install.log
mv staged prefix # an installed tree can be moved
[ -z "$(find prefix -name '*.a')" ] || fail "static libraries in the shared package"
ln -s pt-triangle.h prefix/include/triangle.h # the clients include it by this name
libraries=$(dirname "$(find prefix -name libptriangle.so)")
mkdir shared_clients
use "$work/prefix" shared_clients
for name in pt-triangle ptriangle-files ptriangle-check ptriangle ptriangle-mpi; do
    [ "$name" != ptriangle-mpi ] || [ -e "$libraries/lib$name.so" ] || continue # skipped without MPI
    [ -e "$libraries/lib$name.so.$version" ] || fail "no lib$name.so.$version"
    readelf -d "$libraries/lib$name.so" | grep -q "SONAME.*\[lib$name\.so\.${version%.*}\]" || fail "soname of $name"
    nm -D --defined-only "$libraries/lib$name.so" | awk '{ print $3 }'
done | sort -u >exported.txt
absent=none
[ -e "$libraries/libptriangle-mpi.so" ] || absent=par_stream_on # the one extra name that the library for MPI exports
sed -n 's/^ *\([a-z0-9_]*\);.*$/\1/p' "$root/cmake/exports.map" | grep -vx $absent | sort >listed.txt
diff listed.txt exported.txt || fail "exported names differ from the list"
for name in $(sed -n 's/^ *\(\(tri\|par\)_[a-z0-9_]*\);$/\1/p' "$root/cmake/exports.map" | grep -vx $absent); do
    grep -rqE "\b$name\(" prefix/include || fail "$name is exported, but in no public header"
done
PKG_CONFIG_PATH=$work/$libraries/pkgconfig
LD_LIBRARY_PATH=$work/$libraries
export PKG_CONFIG_PATH LD_LIBRARY_PATH
[ "$(pkg-config --modversion pt-triangle)" = "$version" ] || fail "version of pt-triangle.pc"
for package in pt-triangle ptriangle; do
    eval "set -- $(pkg-config --cflags --libs $package)" # split into words by a shell
    "$cc" -std=c11 "$client/dropin.c" "$@" -o by_hand
    ./by_hand | cmp - shared_clients.sequential
done
unset PKG_CONFIG_PATH LD_LIBRARY_PATH

echo "== threads of the system; names of programs; the C++ runtime of the system"
configure own_threads -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON -DPTRIANGLE_PREFIX=pt- -DPTRIANGLE_STATIC_RUNTIME=OFF
"$cmake" --build own_threads --parallel 2 >own_threads.log 2>&1 || fail "own_threads: $(errors own_threads.log)"
"$cmake" --install own_threads --prefix "$work/alone" >install.log
! readelf -d alone/bin/ptriangle | grep -q 'NEEDED.*lib[gi]*omp' || fail "ptriangle needs OpenMP's library"
for name in pt-triangle pt-trianglecheck; do
    "alone/bin/$name" --version | grep -q "^$name " || fail "$name prints another name"
    readelf -d "alone/bin/$name" | grep -q 'NEEDED.*libstdc++' || fail "$name contains the C++ runtime"
    ! readelf -d "static/bin/${name#pt-}" | grep -q 'NEEDED.*libstdc++' || fail "${name#pt-} needs a C++ runtime"
done
cp "$root/data/square.poly" .
alone/bin/pt-triangle -pq30Q square.poly
alone/bin/pt-trianglecheck square.1 --poly square.poly --min-angle 30 --quiet
PKG_CONFIG_PATH=$(dirname "$(find "$work/alone" -name pt-triangle.pc)")
export PKG_CONFIG_PATH
mkdir alone/as_triangle
cp alone/include/pt-triangle.h alone/as_triangle/triangle.h # the client includes it by this name
for package in pt-triangle ptriangle; do
    eval "set -- $(pkg-config --cflags --libs $package)"
    "$cc" -std=c11 "$client/dropin.c" -Ialone/as_triangle "$@" -o by_hand
    ./by_hand | cmp - static_clients.sequential
done
unset PKG_CONFIG_PATH
configure own_threads_tests -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON -DPTRIANGLE_TESTS=ON

echo "== subproject"
"$cmake" -S "$client/cxx" -B sub -DSUBPROJECT="$root" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" >sub.log 2>&1 ||
    fail "subproject: $(tail -n 5 sub.log)"
"$cmake" --build sub --parallel 2 >sub.log 2>&1 || fail "subproject: $(errors sub.log)"
sub/triangle
built=$(find sub -name '*.a' -exec basename {} +)
[ "$built" = libtriangle.a ] || fail "the subproject builds" $built
(cd sub && "${cmake%cmake}ctest" -N | grep -q 'Total Tests: 0') || fail "the subproject has tests"
! grep -rq -e -Werror sub/*/ptriangle-build/CMakeFiles/*/flags.make || fail "the subproject has warnings as errors"
! grep -q '^MPI_C' sub/CMakeCache.txt || fail "the subproject looks for MPI"
"$cmake" --install sub --prefix "$work/sub_installed" >install.log
[ "$(find sub_installed -type f | wc -l)" -eq 1 ] || fail "the subproject installs files of its own"
echo "package: passed"
