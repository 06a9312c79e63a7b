#!/bin/sh
# The Python package as users get it: builds the wheel, installs it in an environment without a compiler, runs its
# tests, mypy --strict on a client, and every Python example of README and docs/ without changes. Compares
# ptriangle.compat with the package `triangle` from PyPI. If PyPI cannot be reached, one line says so.
# Usage: tools/python.sh [FOLDER]     scratch folder; default: build/python
set -eu
cd "$(dirname "$0")/.."
root=$(pwd)
work=${1:-${PTRIANGLE_BUILD:-build}/python}
rm -rf "$work"
mkdir -p "$work"
work=$(cd "$work" && pwd)

skip() {
    echo "python: skipped: $1 ($(tail -n 1 "$work/log"))"
    exit 0
}
pip() { "$work/venv/bin/python" -m pip --disable-pip-version-check --no-input --retries 2 "$@" >"$work/log" 2>&1; }
must() { "$@" || { cat "$work/log"; exit 1; }; }

python3 -m venv "$work/venv" >"$work/log" 2>&1 || skip "python3 has no venv (Debian: python3-venv)"
pip install numpy pytest scikit-build-core mypy || skip "PyPI cannot be reached"
for package in matplotlib ipython shapely geopandas h5py meshio numba pyvista scipy rasterio scikit-fem; do
    pip install "$package" ||
        echo "python: without $package, which cannot be installed here ($(tail -n 1 "$work/log"))"
done

must pip wheel --no-build-isolation --no-deps --wheel-dir "$work/wheels" "$root"
wheel=$(echo "$work"/wheels/ptriangle-*-py3-none-*.whl)
[ -f "$wheel" ] || { echo "python: no wheel py3-none-PLATFORM: $(ls "$work/wheels")"; exit 1; }
must pip install "$wheel"
"$work/venv/bin/python" -m zipfile -l "$wheel" >"$work/contents"
grep -q 'licenses/.*THIRD-PARTY' "$work/contents" || { echo "python: the wheel does not list its third-party parts"; exit 1; }

cd "$work"
mkdir none # the only folder in the path: there is no compiler
PATH=$work/none "$work/venv/bin/python" -m pytest -q -rs -p no:cacheprovider "$root/python/tests" -o testpaths=
cp "$root/python/tests/typed_client.py" "$work"
"$work/venv/bin/python" -m mypy --strict typed_client.py
"$work/venv/bin/python" typed_client.py
"$work/venv/bin/python" -m mypy --strict -p ptriangle >mypy.log || { cat mypy.log; exit 1; }
# Files that the examples of docs/formats.md read.
mkdir -p examples/formats
cp "$root/data/section.poly" examples/formats
"$work/venv/bin/ptriangle" -pq30aAQ --output examples/formats/section.msh --output examples/formats/section.vtu \
    examples/formats/section.poly
"$work/venv/bin/python" -c 'import sys, ptriangle
ptriangle.mesh(**ptriangle.read(sys.argv[1] + "section.msh")).write(sys.argv[1] + "section.h5")
square = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
open(sys.argv[1] + "map.geojson", "w").write(str(square).replace(chr(39), chr(34)))' examples/formats/
for document in $(cd "$root" && grep -l '^```python' README.md docs/*.md); do
    MPLBACKEND=Agg PYVISTA_OFF_SCREEN=true "$work/venv/bin/python" "$root/python/tests/run_examples.py" \
        "$root/$document" "$work/examples/$(basename "$document" .md)"
done
if pip install triangle==20250106; then
    PATH=$work/none "$work/venv/bin/python" "$root/python/tests/against_pypi.py"
else
    echo "python: not compared: the package triangle cannot be installed here ($(tail -n 1 "$work/log"))"
fi
