#!/bin/sh
# Real clients from PyPI, with this library in place of Triangle: the package `triangle` with libtriangle.a, MeshPy with
# libptriangle.a and its own tests, FloPy with the program. The copies of Triangle in the first two are not unpacked. If
# PyPI cannot be reached, or Python's headers are missing, one line says so, and the exit code is 77.
# Usage: run_python.sh BUILD_DIR WORK_DIR CMAKE PYTHON C_COMPILER CXX_COMPILER
set -eu
build=$1
work=$2
cmake=$3
python=$4
CC=$5
CXX=$6
export CC CXX
here=$(cd "$(dirname "$0")" && pwd)
prefix=$work/prefix
mkdir -p "$work"
work=$(cd "$work" && pwd)
prefix=$work/prefix

skip() {
    echo "skipped: $1"
    exit 77
}
skip_pip() { skip "$1 ($(tail -n 1 "$work/pip.log"))"; }
pip() { "$work/venv/bin/python" -m pip --disable-pip-version-check --no-input "$@" >"$work/pip.log" 2>&1; }
must_pip() { pip "$@" || { cat "$work/pip.log"; exit 1; }; }
PATH=$work/venv/bin:$PATH # meson is found by name

"$python" -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' ||
    skip "no headers of Python (Debian: python3-dev)"

# Downloads, done once: versions that are known to exist.
if [ ! -e "$work/fetched" ]; then
    rm -rf "$work/venv" "$work/sources"
    "$python" -m venv "$work/venv" >"$work/pip.log" 2>&1 || skip_pip "python has no venv (Debian: python3-venv)"
    pip --retries 2 install numpy pytest || skip_pip "PyPI cannot be reached"
    must_pip install setuptools cython wheel meson-python ninja pybind11 flopy==3.11.0 shapely geojson
    must_pip download --no-deps --no-build-isolation --no-binary :all: -d "$work/sources" triangle==20200424 \
        meshpy==2026.1.1
    touch "$work/fetched"
fi
rm -rf "$prefix" "$work/triangle" "$work/meshpy" "$work/run"
mkdir "$work/triangle" "$work/meshpy" "$work/run"
"$cmake" --install "$build" --prefix "$prefix" >"$work/install.log"
libraries=$(dirname "$(find "$prefix" -name libtriangle.a)")
python=$work/venv/bin/python

echo "== triangle 20200424, libtriangle.a"
tar xzf "$work/sources/triangle-20200424.tar.gz" -C "$work/triangle" --strip-components 1 --exclude '*/c' \
    --exclude core.c
cat >"$work/triangle/setup.py" <<END
from setuptools import setup, Extension
setup(name='triangle', packages=['triangle'], ext_modules=[Extension('triangle.core', ['triangle/core.pyx'],
      include_dirs=['$prefix/include'], extra_objects=['$libraries/libtriangle.a'])])
END
cd "$work/triangle"
"$python" setup.py -q build_ext --inplace >"$work/triangle.log" 2>&1 || { cat "$work/triangle.log"; exit 1; }
cd "$work/run"
PYTHONPATH=$work/triangle "$python" -B -m pytest -q -p no:cacheprovider "$here/pypi_triangle.py"

echo "== FloPy 3.11.0, bin/triangle"
PTRIANGLE_PROGRAM=$prefix/bin/triangle "$python" -B -m pytest -q -p no:cacheprovider "$here/flopy_triangle.py"

[ -e "$libraries/libptriangle.a" ] || exit 0
echo "== MeshPy 2026.1.1, libptriangle.a"
tar xzf "$work/sources/meshpy-2026.1.1.tar.gz" -C "$work/meshpy" --strip-components 1 --exclude triangle.cpp \
    --exclude triangle.h
cd "$work/meshpy"
[ -e src/cpp/wrap_triangle.cpp ] && [ ! -e src/cpp/triangle.cpp ]
sed -i "/src\/cpp\/triangle\./d
s|dependencies *: *\[pybind11_dep\]|dependencies: [pybind11_dep, declare_dependency(compile_args: ['-I$prefix/include'], \
link_args: ['-L$libraries', '-lptriangle', '-ltriangle', '-lm', '-fopenmp'])]|" meson.build
grep -q lptriangle meson.build
# The header of MeshPy's own copy defines REAL and a vertex type; Triangle's public header does not.
sed -i 's|#include "triangle.h"|#define REAL double\n&\ntypedef REAL *vertex;|' src/cpp/wrap_triangle.cpp
must_pip install --no-deps --no-build-isolation --no-cache-dir --force-reinstall .
cd "$work/run"
"$python" -B -m pytest -q -p no:cacheprovider -k "triangle or point_attributes" "$work/meshpy/test/test_meshpy.py"
"$python" -B -m pytest -q -p no:cacheprovider "$here/meshpy_triangle.py"
