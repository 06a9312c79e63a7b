#!/bin/sh
# Builds the mesher as WebAssembly, the npm package and the page, and tests them in node and in headless Chromium.
# Usage: tools/web.sh [WORKDIR]      default: build/web
# Writes ptriangle.wasm, package/ (the npm package) and ptriangle.html (the page, one file that works offline) into
# WORKDIR. PTRIANGLE_BIN: a folder with a native `triangle` for comparison; without it one is built.
# Needs Debian's clang-19 with its parts for wasm32, node, npm, chromium, and installs them if permitted. If they are
# not available, it says so in one line and ends with exit code 0.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
work=${1:-${PTRIANGLE_BUILD:-$root/build}/web}
mkdir -p "$work/objects"
work=$(cd "$work" && pwd)
llvm=/usr/lib/llvm-19

skip() { echo "web: skipped: $*"; exit 0; }

# --- tools

missing=""
need() { # need PACKAGE FILE
    command -v "$2" >/dev/null 2>&1 || [ -e "$2" ] || missing="$missing $1"
}
need clang-19 clang-19
need lld-19 wasm-ld-19
need libclang-rt-19-dev-wasm32 $llvm/lib/clang/19/lib/wasm32-unknown-unknown/libclang_rt.builtins.a
need libc++-19-dev-wasm32 $llvm/lib/wasm32-wasi/libc++.a
need libc++abi-19-dev-wasm32 $llvm/lib/wasm32-wasi/libc++abi.a
need wasi-libc /usr/lib/wasm32-wasi/libc.a
need nodejs node
need npm npm
need chromium chromium
if [ -n "$missing" ] && command -v apt-get >/dev/null && [ "$(id -u)" -eq 0 ]; then
    # shellcheck disable=SC2086 # one word a package
    { apt-get -qq update && DEBIAN_FRONTEND=noninteractive apt-get -y -qq install --no-install-recommends $missing; } \
        >"$work/apt.log" 2>&1 || skip "cannot install$missing ($work/apt.log)"
    missing=""
fi
[ -z "$missing" ] || skip "needs the packages$missing"
mkdir -p "$work/npm"
cp web/package.json "$work/npm/package.json"
(cd "$work/npm" && npm install --no-audit --no-fund --no-package-lock --loglevel=error) >"$work/npm.log" 2>&1 ||
    skip "npm cannot install web/package.json ($work/npm.log)"

# --- the module

# Compiled for size, most of all outside the hot code of refinement; web/c/left_out.c takes the place of what cannot be
# reached. Without a 128-bit integer, decimal.cpp has no table.
version=$(sed -n 's/^project(.*VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt | head -n 1)
flags="--target=wasm32-wasi -flto -DNDEBUG -mbulk-memory -mnontrapping-fptoint -msign-ext -ffp-contract=off
    -fno-tree-slp-vectorize -Wall -Wextra -Werror -Wno-unused-function -U__SIZEOF_INT128__ -I$root -I$root/include"
sources=$(sed -n '/^set(PTRIANGLE_\(MESHER\|TEXT\)_SOURCES/,/)/p' cmake/sources.cmake |
    grep -oE 'triangle/[a-z_0-9/]+\.c(pp)?' |
    grep -vE '/dropin/|/system[_.]|text/(read_[a-z0-9]+|reading|size_file|words|stream)\.' |
    grep -vE 'size/(background|sampled|raster)\.|cdt/reconstruct\.')
objects=""
cache=$(command -v ccache || true)
compile() {
    object=$work/objects/$(echo "$1" | tr / _).o
    objects="$objects $object"
    size=-Oz
    case $1 in
    triangle/geometry/predicates.c | triangle/mesh/cavity.c | triangle/mesh/surface.c | \
        triangle/mesh/locate.c | triangle/refine/treat.c | triangle/refine/bad_queue.c) size="-Os -fno-unroll-loops" ;;
    triangle/text/formats.c) size="-Oz -Dtri_write_msh_parts=tri_no_parts" ;;
    esac
    # shellcheck disable=SC2086 # one word an option
    case $1 in
    *.cpp) $cache clang++-19 $flags $size -std=c++17 -fno-exceptions -fno-rtti \
        -isystem $llvm/include/wasm32-wasi/c++/v1 -c "$1" -o "$object" ;;
    *) $cache clang-19 $flags $size -std=c11 "-DPTRIANGLE_VERSION=\"$version\"" -c "$1" -o "$object" ;;
    esac
}
for source in $sources web/c/glue.c web/c/left_out.c web/c/system_memory.c; do
    compile "$source"
done
# shellcheck disable=SC2086
clang-19 --target=wasm32-wasi -mexec-model=reactor -O2 -flto -Wl,--lto-O2 $objects -L$llvm/lib/wasm32-wasi \
    -lc++ -lc++abi -Wl,-z,stack-size=1048576 -Wl,--initial-memory=16777216 -Wl,--max-memory=4294967296 \
    -Wl,--export=malloc,--export=free,--strip-all -o "$work/ptriangle.wasm"
zipped=$(gzip -9 <"$work/ptriangle.wasm" | wc -c)
echo "web: ptriangle.wasm: $(wc -c <"$work/ptriangle.wasm") bytes, $zipped gzipped"

# --- the npm package and the page

rm -rf "$work/package"
mkdir -p "$work/package"
cp web/package/* "$work/package/"
sed -i "s/@VERSION@/$version/" "$work/package/package.json"
cp LICENSE "$work/ptriangle.wasm" "$work/package/"
rm -rf "$work/npm/web" # beside the packages that it imports
cp -r web "$work/npm/web"
export PATH="$work/npm/node_modules/.bin:$PATH"
cd "$work/npm/web"
esbuild src/mesher.ts --format=esm --target=es2022 --log-level=warning --outfile="$work/package/mesher.js"
tsc --project . --noEmit false --emitDeclarationOnly --declaration --outDir "$work/package" >"$work/tsc.log" ||
    { cat "$work/tsc.log"; exit 1; }
find "$work/package" -name '*.d.ts' ! -name mesher.d.ts ! -name index.d.ts -delete
WASM=$work/ptriangle.wasm DATA=$root/data node build.mjs "$work/ptriangle.html"
cd "$root"

# --- tests

bin=${PTRIANGLE_BIN:-$root/build/release/bin}
if command -v cc >/dev/null && [ -e /usr/include/cmocka.h ]; then # decimal.cpp in the variant for libc++ 19
    c++ -O1 -std=c++17 -DPTRIANGLE_NO_CHARCONV -I. -c triangle/text/decimal.cpp -o "$work/objects/native_decimal.o"
    cc -std=c11 -I. -Iinclude -Itests tests/test_decimal.c "$work/objects/native_decimal.o" -lcmocka -lstdc++ -lm \
        -o "$work/objects/test_decimal"
    "$work/objects/test_decimal" >"$work/decimal.log" 2>&1 || { cat "$work/decimal.log"; exit 1; }
fi
[ -x "$bin/triangle" ] || tools/build.sh release >"$work/native.log" 2>&1 || { tail "$work/native.log"; exit 1; }
PACKAGE=$work/package NATIVE=$bin DATA=$root/data node --test --test-reporter=spec web/test/mesher.test.mjs
PAGE=$work/ptriangle.html PACKAGE=$work/package DATA=$root/data SHOTS=$work/shots node --test --test-reporter=spec \
    "$work/npm/web/test/page.test.mjs"
