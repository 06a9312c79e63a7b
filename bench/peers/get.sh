#!/bin/sh
# Downloads and builds the other mesh generators for the benchmark, into WORK. All are optional: if one is not
# available, a line says so and it is left out. Usage: bench/peers/get.sh WORK
set -u
work=$1
peers=$(dirname "$0")
python=${PYTHON:-python3}
mkdir -p "$work"

without() { echo "bench: without $1: $2"; }

pip_get() { # pip_get PACKAGE VERSION PROBE: installs without dependencies; it works if Python runs PROBE
    [ -e "$work/python/$1-$2" ] && return
    { [ -x "$work/python/bin/pip" ] || "$python" -m venv "$work/python"; } >"$work/pip.log" 2>&1 &&
        "$work/python/bin/pip" install --quiet --disable-pip-version-check --no-deps --retries 1 --timeout 20 \
            "$1==$2" >>"$work/pip.log" 2>&1 &&
        "$work/python/bin/python" -c "$3" >>"$work/pip.log" 2>&1 &&
        touch "$work/python/$1-$2" ||
        without "$1" "$1==$2 cannot be installed from PyPI, or does not run ($work/pip.log)"
}

# triangle/__init__.py needs numpy, but only the library inside is called, so its files are enough.
pip_get triangle 20250106 "import glob, sysconfig; glob.glob(sysconfig.get_path('platlib') + '/triangle/core*.so')[0]"
pip_get gmsh 4.15.2 "import gmsh; gmsh.initialize()"
pip_get numpy 2.4.6 "import numpy"           # for the parts `calls` and `sizes`
pip_get scipy 1.17.1 "import scipy.spatial" # for the part `sizes`

if [ ! "$work/cgal_mesh" -nt "$peers/cgal_mesh.cpp" ]; then
    rm -f "$work/cgal_mesh"
    c++ -std=c++17 -O3 -DNDEBUG -o "$work/cgal_mesh" "$peers/cgal_mesh.cpp" -lgmp -lmpfr >"$work/cgal.log" 2>&1 ||
        without CGAL "no libcgal-dev, or too old for bench/peers/cgal_mesh.cpp ($work/cgal.log)"
fi

if ! command -v cargo >/dev/null; then
    without spade "no cargo"
else
    CARGO_NET_RETRY=0 CARGO_HTTP_TIMEOUT=20 cargo build --quiet --locked --release --target-dir "$work/spade" \
        --manifest-path "$peers/spade/Cargo.toml" >"$work/spade.log" 2>&1 ||
        without spade "cargo cannot build bench/peers/spade ($work/spade.log)"
fi
exit 0
