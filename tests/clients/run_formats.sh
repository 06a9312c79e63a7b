#!/bin/sh
# Opens meshes in formats of other programs with meshio, VTK, Gmsh, h5py and py2dm from PyPI. If PyPI cannot be reached,
# one line says so, and the exit code is 77.
# Usage: run_formats.sh BIN_DIR WORK_DIR PYTHON HDF5      HDF5 is 1 if the programs write .h5 files
set -eu
bin=$1
work=$2
python=$3
hdf5=$4
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$work"
cd "$work"

skip() {
    echo "skipped: $1 ($(tail -n 1 pip.log))"
    exit 77
}
if [ ! -e fetched_with_h5py ]; then
    rm -rf venv
    "$python" -m venv venv >pip.log 2>&1 || skip "python has no venv (Debian: python3-venv)"
    venv/bin/python -m pip --disable-pip-version-check --no-input --retries 2 install meshio==5.3.5 vtk==9.7.2 \
        gmsh==4.15.2 py2dm==0.2.2 h5py==3.16.0 >pip.log 2>&1 || skip "PyPI cannot be reached"
    touch fetched_with_h5py
fi

# A basin with a side open to the sea (marker 2), an island, and two regions separated by a line without a marker.
cat >basin.poly <<END
10 2 1 1
1 0 0 5 0
2 8 0 5.5 0
3 8 3 6 0
4 8 6 7 0
5 0 6 2.5 0
6 2 2 1 0
7 3 2 1 0
8 3 3 1 0
9 2 3 1 0
10 5 0 4 0
11 1
1 1 10 1
2 10 2 3
3 2 3 2
4 3 4 2
5 4 5 1
6 5 1 1
7 6 7 4
8 7 8 4
9 8 9 4
10 9 6 4
11 10 4 0
1
1 2.5 2.5
2
1 1 1 1 0.05
2 7.5 1 2 0.1
END
"$bin/ptriangle" -Qpq30aA --output a --output a.vtu --output a.msh --output a.2dm --output a.14 basin.poly
rm -f a.h5
if [ "$hdf5" = 1 ]; then
    "$bin/ptriangle" -Qpq30aA --output a.h5 basin.poly
    test -e a.h5
fi
for parts in 1 3 40; do
    "$bin/ptriangle" -Qpq30aA --output "a$parts.msh" --parts $parts basin.poly
done
"$bin/ptriangle" -Qpq30aAo2 --output b3.msh --parts 3 basin.poly
"$bin/ptriangle" -Qpq30aAo2 --output b --output b.vtu --output b.msh --output b.2dm basin.poly
venv/bin/python "$here/formats.py" a 1
venv/bin/python "$here/formats.py" b 2
