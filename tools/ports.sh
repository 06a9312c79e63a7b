#!/bin/sh
# Builds for other processors and another C library, runs the fast tests there, and compares the meshes of a list of
# runs, byte by byte, with those of this machine's own build.
# Usage: tools/ports.sh [quick|resume] [PORT...]
#   arm64   64 bits, with fused multiply-add; runs in qemu-user
#   s390x   big-endian, FLT_EVAL_METHOD 1; runs in qemu-user
#   i386    32 bits, with the x87; runs on x86-64 kernels
#   musl    static, with musl and libc++, by the compiler zig of PyPI; only the sequential programs and the tests of the
#           command line
# Without a name: the first three. quick: programs and meshes, no tests. resume: with unchanged sources, runs the tests
# that an interrupted run has not finished. Needs x86-64, Debian 12 or newer, and hours for everything (quick: some
# minutes). Libraries for the other processors are unpacked below build/ports. Only qemu-user and compilers are
# installed on the machine itself.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
work=${PTRIANGLE_BUILD:-$root/build}/ports
jobs=$(nproc 2>/dev/null || echo 2)

quick=no
resume=""
case ${1:-} in
quick) quick=yes; shift ;;
resume) resume=-F; shift ;;
esac
[ $# -gt 0 ] || set -- arm64 s390x i386
for port; do
    case $port in
    arm64 | s390x | i386 | musl) ;;
    *) sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2; exit 2 ;;
    esac
done

# --- differences between ports

triplet() { # name of the port in compilers
    case $1 in
    arm64) echo aarch64-linux-gnu ;;
    i386) echo i686-linux-gnu ;;
    s390x) echo s390x-linux-gnu ;;
    esac
}

library_folder() { # name of the port's library folder in Debian
    case $1 in
    i386) echo i386-linux-gnu ;;
    *) triplet "$1" ;;
    esac
}

emulator() { # command that runs a port's programs; empty: the kernel runs them
    case $1 in
    arm64) echo qemu-aarch64 -L /usr/aarch64-linux-gnu ;;
    s390x) echo qemu-s390x -L /usr/s390x-linux-gnu ;;
    esac
}

# --- libraries that the tests and the report need, unpacked into $work/PORT/root; nothing is installed

sysroot() {
    port=$1
    apt=$work/$port/apt
    [ ! -e "$work/$port/root/complete" ] || return 0
    rm -rf "$apt" "$work/$port/root"
    mkdir -p "$apt/packages" "$work/$port/root"
    tools/private_apt.sh "$work/$port" deb "$port"
    (cd "$apt/packages" && APT_CONFIG=$apt/conf apt-get -qq download \
        libcmocka0 libcmocka-dev libgmp10 libgmp-dev libjansson4 libjansson-dev)
    for package in "$apt"/packages/*.deb; do
        dpkg-deb -x "$package" "$work/$port/root"
    done
    touch "$work/$port/root/complete"
}

zig() {
    [ -x "$work/zig/bin/zig-cc" ] && return 0
    python3 -m venv "$work/zig"
    "$work/zig/bin/pip" -q install ziglang
    for driver in cc c++ ar ranlib; do
        target=""
        case $driver in c*) target="-target x86_64-linux-musl" ;; esac
        printf '#!/bin/sh\nexec "%s" -m ziglang %s %s "$@"\n' "$work/zig/bin/python" "$driver" "$target" \
            >"$work/zig/bin/zig-$driver"
        chmod +x "$work/zig/bin/zig-$driver"
    done
}

# --- building

toolchain() {
    port=$1
    triplet=$(triplet "$port")
    libraries=$work/$port/root/usr/lib/$(library_folder "$port")
    link="-Wl,-rpath,$libraries"
    # the C library of cross compilers is not where the kernel searches for it
    [ -n "$(emulator "$port")" ] ||
        link="$link -Wl,-rpath,/usr/$triplet/lib -Wl,--dynamic-linker=/usr/$triplet/lib/ld-linux.so.2"
    cat <<EOF
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${triplet%%-*})
set(CMAKE_C_COMPILER $triplet-gcc)
set(CMAKE_CXX_COMPILER $triplet-g++)
set(CMAKE_LIBRARY_ARCHITECTURE $(library_folder "$port"))
set(CMAKE_FIND_ROOT_PATH $work/$port/root /usr/$triplet)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT "$link")
set(CMAKE_CROSSCOMPILING_EMULATOR "$(emulator "$port" | tr ' ' ';')")
EOF
}

# build FOLDER TESTS OPTION...: assertions are compiled in if tests run
build() {
    folder=$1
    flags=-O2
    [ "$2" = ON ] || flags="-O2 -DNDEBUG"
    shift
    cmake -S . -B "$folder" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags" \
        -DPTRIANGLE_TESTS="$@" >"$folder.configure.log" 2>&1 || { cat "$folder.configure.log"; exit 1; }
    cmake --build "$folder" --parallel "$jobs" >"$folder.build.log" 2>&1 || { tail -n 40 "$folder.build.log"; exit 1; }
}

# Scripts that run the emulator replace the programs, so that the command line tests need no change.
wrap() {
    port=$1
    folder=$2
    emulator=$(emulator "$port")
    [ -n "$emulator" ] || return 0
    mkdir -p "$folder/programs"
    for program in "$folder"/bin/*; do
        name=${program##*/}
        if [ "$(head -c 2 "$program")" != '#!' ]; then
            mv "$program" "$folder/programs/$name"
            printf '#!/bin/sh\nexec %s -0 "$0" "%s" "$@"\n' "$emulator" "$folder/programs/$name" >"$program"
            chmod +x "$program"
        fi
    done
}

build_port() {
    port=$1
    folder=$work/$port/build
    tests=ON
    [ "$quick" = no ] || { tests=OFF; folder=$work/$port/quick; }
    mkdir -p "$work/$port"
    if [ "$port" = musl ]; then
        zig
        build "$folder" OFF -DCMAKE_C_COMPILER="$work/zig/bin/zig-cc" -DCMAKE_CXX_COMPILER="$work/zig/bin/zig-c++" \
            -DCMAKE_AR="$work/zig/bin/zig-ar" -DCMAKE_RANLIB="$work/zig/bin/zig-ranlib" -DPTRIANGLE_OPENMP=OFF
    else
        sysroot "$port"
        toolchain "$port" >"$work/$port/toolchain.cmake"
        build "$folder" $tests -DCMAKE_TOOLCHAIN_FILE="$work/$port/toolchain.cmake"
        wrap "$port" "$folder"
    fi
}

# --- meshes

# Runs: program, switches, input. Files are compared without comments, which quote the command line.
runs() {
    for input in data/*.poly data/nasty/*.poly data/nasty/*.node data/regress/*.poly; do
        echo "triangle -pq30Q $input"
        [ "$quick" = yes ] || echo "triangle -penvgcDq33Q $input"
    done
    echo "triangle -pq20aADQ data/section.poly"
    echo "triangle -pqo2jYYQ data/gear.poly"
    echo "triangle -pq33a0.001Q data/letter.poly"
    echo "ptriangle -pq30a0.001Q data/letter.poly"
    echo "ptriangle -qa0.00002Q data/square_random1000.poly"
    [ "$quick" = yes ] && return
    echo "triangle -pq30Q data/coast/norway_sea.poly"
    echo "ptriangle -pq30a6000000Q data/coast/norway_sea.poly"
    echo "ptriangle -pq25aAQ data/coast/borders.poly"
    echo "ptriangle -pqDa0.00001Q data/koch_lake.poly"
}

# mesh BIN LIST: one line per run: the run, its exit code, a checksum of all files, and a checksum after refining the
# mesh again. Runs of programs that were not built are skipped.
mesh() {
    bin=$1
    list=$2
    scratch=$(mktemp -d)
    runs | while read -r program switches input; do
        [ -x "$bin/$program" ] || continue
        rm -rf "${scratch:?}"/*
        cp "${input%.*}".* "$scratch/"
        (
            cd "$scratch" || exit 2
            code=0
            export OMP_NUM_THREADS=3
            timeout 600 "$bin/$program" "$switches" "${input##*/}" >/dev/null 2>&1 || code=$?
            base=${input##*/}
            base=${base%.*}
            first=$(cat "$base".1.* 2>/dev/null | grep -v '^#' | sha256sum | cut -c1-16)
            again=0
            [ $code -ne 0 ] || timeout 600 "$bin/triangle" -rpq32Q "$base.1" >/dev/null 2>&1 || again=$?
            echo "$program $switches $input $code $first $again" \
                "$(cat "$base".2.* 2>/dev/null | grep -v '^#' | sha256sum | cut -c1-16)"
        )
    done >"$list"
    rm -rf "$scratch"
}

compare() { # compare PORT BIN
    mesh "$2" "$work/$1.meshes"
    grep -E "^($(ls "$2" | tr '\n' '|' | sed 's/|$//')) " "$work/native.meshes" >"$work/$1.expected"
    if cmp -s "$work/$1.meshes" "$work/$1.expected"; then
        echo "ports: $1: the same bytes in all $(wc -l <"$work/$1.meshes") runs"
    else
        diff "$work/$1.expected" "$work/$1.meshes" || true
        echo "ports: $1: MESHES DIFFER from this machine's" >&2
        failed="$failed $1"
    fi
}

tests() { # tests PORT FOLDER
    if [ "$1" = musl ]; then
        mkdir -p "$work/musl/tests"
        sh tests/run_expected.sh "$2/bin" "$root/data" "$work/musl/tests/expected" || failed="$failed $1"
        for topic in switches names errors refine layouts regress; do
            sh tests/cli/run.sh $topic "$2/bin" "$root/data" "" "$work/musl/tests/$topic" || failed="$failed $1"
        done
    else
        log=$work/$1.tests.log # log of all parts of a run
        [ -n "$resume" ] || rm -f "$log"
        # shellcheck disable=SC2086
        ctest $resume --test-dir "$2" -L fast --parallel "$jobs" --output-on-failure --no-tests=error | tee -a "$log"
        if ! tail -n 300 "$log" | grep -q 'tests passed' ||
            grep -qE '\*\*\*(Failed|Timeout|Exception|Not Run)' "$log"; then
            failed="$failed $1"
        fi
    fi
}

failed=""
mkdir -p "$work/native"
tools/setup.sh ports
build "$work/native/build" OFF
mesh "$work/native/build/bin" "$work/native.meshes"
for port; do
    echo "==== $port"
    build_port "$port"
    compare "$port" "$folder/bin"
    [ "$quick" = yes ] || tests "$port" "$folder"
done
[ -z "$failed" ] || { echo "ports: failed:$failed" >&2; exit 1; }
echo "ports: passed"
