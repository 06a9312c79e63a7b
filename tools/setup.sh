#!/bin/sh
# Installs packages that building needs and this machine lacks, through apt. Without apt, it prints what is needed.
# Usage: tools/setup.sh [coast|build|tests|ci|ports|windows|docs]
#   coast    C and C++ compiler, make, CMake (for the programs), and cairo (for meshplot)
#   build    coast, jansson (for ptriangle --report and GeoJSON), HDF5 (for .h5 files), pkg-config (for programs that
#            call the libraries)
#   tests    build, cmocka, GMP (for tools/test.sh)
#   ci       tests, clang with its OpenMP library, fuzzer and clang-tidy, cppcheck, valgrind, gcovr, MPI, Python (for
#            .ci/run)
#   ports    build, compilers for other processors and their emulator (for tools/ports.sh)
#   windows  build, compiler and emulator for Windows (for tools/windows.sh)
#   docs     build, Doxygen and Python's venv (for tools/docs.sh)
# Works as root or with sudo and asks no questions. It prints each package and its purpose, and changes nothing on a
# machine that has all of them. cairo, jansson, HDF5 and, for `build`, pkg-config are optional: PTRIANGLE_SETUP=least
# leaves them out. PTRIANGLE_SETUP=no installs nothing.
set -eu
wanted=${1:-build}
how=${PTRIANGLE_SETUP:-all}
missing=""

need() { # need PACKAGE CHECK...: PACKAGE is missing unless the check succeeds
    package=$1
    shift
    "$@" >/dev/null 2>&1 || missing="$missing $package"
}

links() { # links HEADER LIBRARY: a C program with this header and library can be built
    probe=$(mktemp)
    printf '#include <stdarg.h>\n#include <stddef.h>\n#include <stdint.h>\n#include <setjmp.h>\n#include <%s>\n%s\n' \
        "$1" 'int main(void) { return 0; }' | cc -x c - "-l$2" -o "$probe"
    result=$?
    rm -f "$probe"
    return $result
}

hdf5() { # the header may be in a folder of its own (Debian) or not
    probe=$(mktemp)
    program='#include <hdf5.h>
int main(void) { return 0; }'
    echo "$program" | cc -x c - -I/usr/include/hdf5/serial -lhdf5_serial -o "$probe" ||
        echo "$program" | cc -x c - -lhdf5 -o "$probe"
    result=$?
    rm -f "$probe"
    return $result
}

python_headers() {
    python3 -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))'
}

openmp_with_clang() {
    probe=$(mktemp)
    printf '#include <omp.h>\nint main(void) { return omp_get_max_threads() < 1; }\n' |
        clang -fopenmp -x c - -o "$probe"
    result=$?
    rm -f "$probe"
    return $result
}

fuzzer_with_clang() {
    probe=$(mktemp)
    printf '#include <stddef.h>\nint LLVMFuzzerTestOneInput(const char *a, size_t n) { return a && n > 9; }\n' |
        clang -fsanitize=fuzzer -x c - -o "$probe"
    result=$?
    rm -f "$probe"
    return $result
}

# Debian's package of clang's runtime libraries has the version in its name.
fuzzer_package() {
    echo "libclang-rt-$(clang --version 2>/dev/null | sed -n 's/.*version \([0-9]*\).*/\1/p' | head -n 1 | grep . || echo 14)-dev"
}

cmake_is_new_enough() {
    cmake --version | head -n 1 |
        awk '{ split($3, v, "."); exit !(v[1] > 3 || (v[1] == 3 && v[2] >= 22)) }'
}

compilers() { command -v cc && command -v c++ && links stdio.h c; }

wish() { # wish PACKAGE CHECK...: like need, for optional packages
    package=$1
    shift
    [ "$how" = least ] || "$@" >/dev/null 2>&1 || wished="${wished:+$wished }$package"
}

list_missing() {
    missing=""
    wished=""
    wish libcairo2-dev links cairo/cairo.h cairo
    [ "$wanted" = coast ] || wish libjansson-dev links jansson.h jansson
    [ "$wanted" = coast ] || wish libhdf5-dev hdf5
    [ "$wanted" != build ] || wish pkg-config command -v pkg-config
    need "gcc g++ libc6-dev" compilers
    need make command -v make
    need cmake command -v cmake
    case $wanted in coast | build) return ;; esac
    if [ "$wanted" = ports ]; then
        for triplet in aarch64 i686 s390x; do
            need g++-$triplet-linux-gnu command -v $triplet-linux-gnu-g++
        done
        need qemu-user command -v qemu-s390x
        need python3-venv python3 -c 'import ensurepip, venv'
        return
    fi
    if [ "$wanted" = windows ]; then
        need g++-mingw-w64-x86-64-posix command -v x86_64-w64-mingw32-g++-posix
        need wine64 test -x /usr/lib/wine/wine64
        need libz-mingw-w64-dev test -e /usr/x86_64-w64-mingw32/include/zlib.h
        need zip command -v zip
        need unzip command -v unzip
        return
    fi
    if [ "$wanted" = docs ]; then
        need doxygen command -v doxygen
        need python3-venv python3 -c 'import ensurepip, venv'
        return
    fi
    need libcmocka-dev links cmocka.h cmocka
    need libgmp-dev links gmp.h gmp
    need pkg-config command -v pkg-config
    [ "$wanted" = tests ] && return
    need "libopenmpi-dev openmpi-bin" command -v mpicc.openmpi
    need "libmpich-dev mpich" command -v mpicc.mpich
    need clang command -v clang++
    need python3-venv python3 -c 'import ensurepip, venv'
    need python3-dev python_headers
    need libomp-dev openmp_with_clang
    need "$(fuzzer_package)" fuzzer_with_clang
    need cppcheck command -v cppcheck
    need clang-tidy command -v clang-tidy
    need valgrind command -v valgrind
    need gcovr command -v gcovr
}

purposes() { # prints the purpose of each package
    for package; do
        case $package in
        gcc | g++ | libc6-dev | make | cmake) purpose="to build the programs" ;;
        libcairo2-dev) purpose="meshplot, which draws meshes (optional)" ;;
        libjansson-dev) purpose="ptriangle --report, GeoJSON (optional)" ;;
        libhdf5-dev) purpose=".h5 files (optional)" ;;
        pkg-config) purpose="programs that call the libraries" ;;
        libcmocka-dev | libgmp-dev) purpose="the tests" ;;
        *) purpose="the checks of tools/setup.sh $wanted" ;;
        esac
        printf 'setup:   %-16s %s\n' "$package" "$purpose"
    done
}

amount() { # number and disk size of all packages that apt would install
    as_root env LC_ALL=C apt-get install --download-only --no-install-recommends --assume-no "$@" 2>/dev/null | awk '
        / newly installed/ { packages = $3 } # "0 upgraded, 64 newly installed, ..."
        /^After this operation/ { size = $4 " " $5 }
        END { if (packages > 0) print "in all " packages " packages, " size }'
}

consequence() { # consequence of leaving out $wished
    case $wished in *cairo*) printf 'meshplot, which draws meshes, is not built; ' ;; esac
    case $wished in *jansson*) printf 'the programs have no --report and read no GeoJSON; ' ;; esac
    case $wished in *hdf5*) printf '.h5 files are neither written nor read; ' ;; esac
    echo "everything else works"
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        return 1
    fi
}

apt() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@"; }

case $wanted in
coast | build | tests | ci | ports | windows | docs) ;;
*)
    echo "usage: tools/setup.sh [coast|build|tests|ci|ports|windows|docs]" >&2
    exit 2
    ;;
esac

list_missing
# Optional packages alone must not cause a request for a password.
if [ -n "$wished" ] && [ -z "$missing" ] && [ "$(id -u)" -ne 0 ] && ! sudo -n true 2>/dev/null; then
    echo "setup: without $wished: $(consequence)" >&2
    wished=""
fi
if [ -n "$missing$wished" ] && [ "$how" != no ] && command -v apt-get >/dev/null; then
    apt update || echo "setup: apt-get update failed; trying with the existing package lists" >&2
    echo "setup: installing through apt:"
    # shellcheck disable=SC2086 # one word a package
    purposes $missing $wished
    # shellcheck disable=SC2086
    echo "setup: $(amount $missing $wished). PTRIANGLE_SETUP=least leaves out optional packages;" \
        "PTRIANGLE_SETUP=no installs nothing"
    # shellcheck disable=SC2086 # one word a package
    [ -z "$missing" ] || apt install -y --no-install-recommends $missing || true
    # shellcheck disable=SC2086
    [ -z "$wished" ] || apt install -y --no-install-recommends $wished ||
        echo "setup: without $wished: $(consequence)" >&2
    list_missing
fi
if [ -n "$missing" ]; then
    echo "setup: still missing (Debian and Ubuntu package names):$missing" >&2
    echo "setup: needed are a C11 and C++17 compiler (GCC 11 or newer, or clang), make, CMake 3.22 or newer;" >&2
    echo "setup: for the tests cmocka, GMP and pkg-config; for the full checks clang with libomp." >&2
    exit 1
fi
if ! cmake_is_new_enough; then
    echo "setup: $(cmake --version | head -n 1) is too old: 3.22 or newer is needed" >&2
    exit 1
fi
