#!/bin/sh
# Builds the programs and the library for Windows on x86-64 with mingw-w64, packs them into one zip, and runs the
# contents of the zip under wine. Files are compared with those of this machine's own build, byte by byte. Then stops,
# kills, checkpoints, names and errors are tested.
# Usage: tools/windows.sh [quick] [FOLDER]     default: build/windows-port
#   quick  some of the inputs, and without meshplot, whose library cairo is built from Debian's sources (3 minutes)
# Installs compiler and emulator through apt (tools/setup.sh windows). If they are not available, it says so and ends
# with success. The zip is FOLDER/ptriangle-VERSION-windows-x86_64.zip.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
quick=no
[ "${1:-}" != quick ] || { quick=yes; shift; }
work=${1:-${PTRIANGLE_BUILD:-$root/build}/windows-port}
case ${PTRIANGLE_BUILD:-} in
"") native=$root/build/release ;;
/*) native=$PTRIANGLE_BUILD/release ;;
*) native=$root/$PTRIANGLE_BUILD/release ;;
esac
jobs=$(nproc 2>/dev/null || echo 2)
triplet=x86_64-w64-mingw32
version=$(sed -n 's/^project(ptriangle VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
name=ptriangle-$version-windows-x86_64
[ $quick = no ] || name=$name-without-meshplot
mkdir -p "$work"
work=$(cd "$work" && pwd)

if ! tools/setup.sh windows; then
    echo "windows: skipped: mingw-w64 and wine cannot be installed here"
    exit 0
fi

# --- cairo with libpng and pixman, static, from Debian's sources

cairo() {
    [ ! -e "$work/cairo/complete" ] || return 0
    rm -rf "$work/cairo"
    tools/private_apt.sh "$work/cairo" deb-src "$(dpkg --print-architecture)"
    cd "$work/cairo"
    for package in libpng1.6 pixman cairo; do # Debian's patches of these packages are not needed
        APT_CONFIG=$PWD/apt/conf apt-get -qq source --download-only "$package" || true
        tar xf "$package"_*.orig.tar.*z
    done
    export CC=$triplet-gcc-posix CFLAGS="-O2 -DNDEBUG"
    export PKG_CONFIG_LIBDIR="$PWD/root/lib/pkgconfig:/usr/$triplet/lib/pkgconfig"
    set -- --host=$triplet --prefix="$PWD/root" --disable-shared --quiet
    (cd libpng*/ && ./configure "$@" --disable-tools && make -s -j"$jobs" install)
    (cd pixman*/ && ./configure "$@" --disable-libpng --disable-openmp && make -s -j"$jobs" -C pixman install &&
        make -s install-pkgconfigDATA)
    (cd cairo*/ && ./configure "$@" --disable-ft --disable-fc --disable-gobject --disable-interpreter --disable-trace \
        --disable-ps --disable-pdf CPPFLAGS="-I$work/cairo/root/include" LDFLAGS="-L$work/cairo/root/lib" &&
        make -s -j"$jobs" -C src install)
    unset CC CFLAGS PKG_CONFIG_LIBDIR
    cd "$root"
    touch "$work/cairo/complete"
}

# --- building and packing

build() { # build FOLDER OPTION...
    folder=$1
    shift
    cmake -S . -B "$folder" -DCMAKE_BUILD_TYPE=Release -DPTRIANGLE_HDF5=OFF -DJANSSON_LIBRARY="" \
        "$@" >"$folder.configure.log" 2>&1 || { cat "$folder.configure.log"; exit 1; }
    cmake --build "$folder" --parallel "$jobs" >"$folder.build.log" 2>&1 || { tail -n 40 "$folder.build.log"; exit 1; }
}

pack() {
    rm -rf "${work:?}/$name" "$work/$name.zip"
    mkdir -p "$work/$name/lib" "$work/$name/include/ptriangle" "$work/$name/data"
    cp "$work"/windows/bin/*.exe "$work/windows/bin/ptriangle.dll" "$work/$name/"
    cp "$work/windows/libptriangle.dll.a" "$work/windows/ptriangle.def" "$work/$name/lib/"
    cp include/ptriangle/*.h "$work/$name/include/ptriangle/"
    rm "$work/$name/include/ptriangle/mpi.h"
    cp triangle/dropin/triangle.h "$work/$name/include/"
    cp data/letter.poly data/section.poly data/coast/norway_sea.poly "$work/$name/data/"
    cp LICENSE "$work/$name/LICENSE.txt"
    cp docs/windows.md "$work/$name/README.md"
    (cd "$work" && zip -qr9 "$name.zip" "$name")
    echo "windows: $name.zip, $(wc -c <"$work/$name.zip") bytes"
}

# --- running

wine=/usr/lib/wine/wine64
export WINEPREFIX="$work/wine" WINEDEBUG=-all
unset DISPLAY

start_wine() { # uses one server for all programs; otherwise a server would end and start in between
    mkdir -p "$WINEPREFIX"
    /usr/lib/wine/wineserver64 -p
    trap '/usr/lib/wine/wineserver64 -k' EXIT
    [ ! -e "$WINEPREFIX/complete" ] || return 0
    $wine wineboot -i </dev/null >"$work/wine.log" 2>&1 || true
    $wine reg add 'HKCU\Software\Wine' /v Version /d win10 /f </dev/null >>"$work/wine.log" 2>&1
    touch "$WINEPREFIX/complete"
}

failed=0
passed=0
check() { # check WHAT COMMAND...
    what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        echo "windows: FAILED: $what" >&2
        failed=$((failed + 1))
    fi
}

there() { # there PROGRAM ARGUMENT...
    program=$1
    shift
    timeout 300 $wine "$work/unpacked/$name/$program.exe" "$@" </dev/null
}

# Files without the name of their program; output without times, memory, the way programs are called, and errors of
# wine's own connection to its server ("wine client error:340: sendmsg: Socket operation on non-socket" at an exit).
plain() {
    for f in *; do
        case $f in
        out | err) echo "$f" && sed -e 's/[^ ]*\(triangle[a-z]*\)\.exe/\1/g' -e '/milliseconds/d' \
            -e '/^wine client error:/d' -e 's/[0-9.]* [kMGT]B/... B/g' "$f" ;;
        *) echo "$f $(grep -av '^# Generated by' "$f" | sha256sum)" ;;
        esac
    done
}

# One run on each side, in separate folders.
same() { # same INPUT PROGRAM ARGUMENT...
    input=$1
    program=$2
    shift 2
    code_here=0
    code_there=0
    rm -rf "$work/here" "$work/there"
    mkdir -p "$work/here" "$work/there"
    cp "${input%.*}".* "$work/here/"
    cp "${input%.*}".* "$work/there/"
    cd "$work/here"
    timeout 300 "$native/bin/$program" "$@" "${input##*/}" >out 2>err </dev/null || code_here=$?
    plain >"$work/here.plain"
    cd "$work/there"
    there "$program" "$@" "${input##*/}" >out 2>err || code_there=$?
    plain >"$work/there.plain"
    cd "$root"
    is $code_there $code_here && diff "$work/here.plain" "$work/there.plain" >&2
}

corpus() {
    ls data/*.poly data/nasty/*.poly data/nasty/*.node data/regress/*.poly
    [ "$quick" = yes ] || ls data/coast/*.poly
    [ "$quick" = yes ] || find "$root/../shared/data" -name '*.poly' -size -1024k 2>/dev/null | sort
}

compare() {
    n=0
    for input in $(corpus); do
        n=$((n + 1))
        [ "$quick" = no ] || [ $((n % 8)) -eq 1 ] || continue
        check "triangle -pq30 $input" same "$input" triangle -pq30
        check "ptriangle, 1 thread, $input" same "$input" ptriangle -pq28A --threads 1
        check "ptriangle, 2 threads, $input" same "$input" ptriangle -pq30a --threads 2
    done
    for thread in 1 2; do
        check "a large mesh, $thread threads" same data/letter.poly ptriangle -pq30a0.0005 --threads $thread
        check "formats, $thread threads" same data/letter.poly ptriangle -pq30a0.01 --threads $thread \
            --output letter.vtu --output letter.msh --output letter.2dm --output letter.14
    done
    check "switches" same data/section.poly triangle -penvgcDq33
    check "sweeping" same data/square_random1000.poly ptriangle -qa0.0000004 --memory 125M --threads 2
}

# --- stops, names, errors

fresh() { # makes an empty folder with an input
    rm -rf "$work/there"
    mkdir -p "$work/there"
    cp data/letter.poly "$work/there/"
    cd "$work/there"
}

poke() { # poke HOW MILLISECONDS PROGRAM ARGUMENT...: stores the exit code in $code
    how=$1
    after=$2
    program=$3
    shift 3
    code=0
    timeout 120 $wine "$work/poke.exe" "$how" "$after" "$work/unpacked/$name/$program.exe" "$@" </dev/null >out 2>err ||
        code=$?
}

is() { [ "$1" = "$2" ] || { echo "windows: $1, not $2" >&2 && return 1; }; }
no_mesh() { ! ls -A | grep -qE '^letter\.1|^\.tri-'; }
holds() { grep -qF -- "$1" "$2" || { echo "windows: not in $2: $1" >&2 && return 1; }; }
like_here() {
    for suffix in node ele poly; do
        grep -v '^#' "letter.1.$suffix" >"$work/there.plain"
        grep -v '^#' "$work/here/letter.1.$suffix" | cmp - "$work/there.plain" || return 1
    done
}

stopping() {
    fresh
    poke c 700 ptriangle -pq30a0.000002 letter.poly
    check "Ctrl-C ends a run with 130" is $code 130
    check "Ctrl-C is named" holds "stopped by Ctrl-C" err
    check "Ctrl-C leaves nothing" no_mesh
    for after in 500 1200; do
        poke kill $after ptriangle -pq30a0.000002 letter.poly
        check "a kill ends a run" is $code 137
        there triangle -pq letter.poly >/dev/null 2>&1
        rm -f letter.1.*
        check "what a kill has left goes with the next run" no_mesh
    done
    cd "$root"
}

checkpoints() {
    for how in kill c limit; do
        for memory in "" "--memory 100M"; do
            rm -rf "$work/here"
            mkdir -p "$work/here"
            cp data/letter.poly "$work/here/"
            # shellcheck disable=SC2086 # options
            (cd "$work/here" && "$native/bin/ptriangle" -pq30a0.00015 letter.poly >/dev/null)
            fresh
            # shellcheck disable=SC2086
            case $how in
            limit) code=0
                there ptriangle -pq30a0.00015 --checkpoint kept --every 0.01 --time-limit 1 $memory letter.poly \
                    >out 2>err || code=$? ;;
            *) poke $how 2500 ptriangle -pq30a0.00015 --checkpoint kept --every 0.01 $memory letter.poly ;;
            esac
            # shellcheck disable=SC2086
            { [ -e letter.1.ele ] && [ ! -e kept ]; } || # otherwise a checkpoint may or may not exist
                there ptriangle -pq30a0.00015 --resume kept --checkpoint kept $memory letter.poly >out 2>err || true
            check "$how $memory: the mesh of a run without stop" like_here
            check "$how: no checkpoint is left" test ! -e kept
            cd "$root"
        done
    done
}

naming() {
    fresh
    mkdir -p 'Ünï çödé 網'
    cp letter.poly 'Ünï çödé 網/Brücke.poly'
    there triangle -pq30Q 'Ünï çödé 網\Brücke.poly' >out 2>err || true
    check "a name in UTF-8 behind a backslash" test -s 'Ünï çödé 網/Brücke.1.ele'
    drive=$($wine winepath -w "$PWD" </dev/null 2>/dev/null | tr -d '\r')
    there ptriangle -pq30Q --output "$drive\\far.vtu" "$drive\\letter.poly" >out 2>err || true
    check "a path with a drive" test -s far.vtu
    sed 's/$/\r/' letter.poly >crlf.poly
    there triangle -pq30Q letter.poly >out 2>err
    there triangle -pq30Q crlf.poly >out 2>err
    grep -v '^#' letter.1.ele >here.plain
    grep -v '^#' crlf.1.ele >there.plain
    check "lines that end in CR LF" cmp here.plain there.plain
    cd "$root"
}

telling() {
    fresh
    code=0
    there triangle -pq30 nothing.poly >out 2>err || code=$?
    check "a file that is not there: 1" is $code 1
    check "in one clear line" is "$(cat err)" "nothing.poly: cannot open: No such file or directory"
    mkdir folder.poly
    there triangle -pq30 folder.poly >out 2>err || code=$?
    check "a folder" holds "this is a directory" err
    there triangle -pq30 'no\folder\x.poly' >out 2>err || code=$?
    check "a path that is not there" is "$(cat err)" 'no\folder\x.poly: cannot open: No such file or directory'
    there ptriangle -pq30 --output letter.h5 letter.poly >out 2>err || code=$?
    check "HDF5" is "$(wc -l <err)" 1
    check "no line ends in CR" is "$(cat out err | tr -dc '\r' | wc -c)" 0
    cd "$root"
}

library() { # a C program that is linked with the import library and finds the DLL in its own folder
    cd "$work/there"
    cp "$work/unpacked/$name/ptriangle.dll" .
    $triplet-gcc-posix -O1 -I"$work/unpacked/$name/include" "$root/examples/checkerboard.c" -o board.exe \
        "$work/unpacked/$name/lib/libptriangle.dll.a"
    timeout 60 $wine board.exe </dev/null 2>err | tr -d '\r' >out
    "$native/examples/checkerboard" >here.out 2>/dev/null || true
    check "a client of the DLL" cmp -s here.out out
    cd "$root"
}

# --- all tests

tools/build.sh release >"$work/native.log" 2>&1 || { tail -n 40 "$work/native.log"; exit 1; }
set -- -DCMAKE_TOOLCHAIN_FILE="$root/cmake/windows/mingw64.cmake" -DBUILD_SHARED_LIBS=ON -DPTRIANGLE_OPENMP=OFF
[ "$quick" = yes ] || cairo
libraries=$work/cairo/root/lib
[ ! -e "$work/cairo/complete" ] ||
    set -- "$@" -DCMAKE_C_FLAGS=-DCAIRO_WIN32_STATIC_BUILD -DCAIRO_INCLUDE="$work/cairo/root/include/cairo" \
        "-DCAIRO_LIBRARY=$libraries/libcairo.a;$libraries/libpixman-1.a;$libraries/libpng.a;z;gdi32;msimg32;user32;ssp"
build "$work/windows" "$@"
pack
rm -rf "$work/unpacked"
(mkdir "$work/unpacked" && cd "$work/unpacked" && unzip -q "$work/$name.zip")
$triplet-gcc-posix -Wall -O1 -static tests/windows/poke.c -o "$work/poke.exe"
start_wine
compare
stopping
checkpoints
naming
telling
library
echo "windows: $passed passed, $failed failed"
[ $failed -eq 0 ]
