#!/bin/sh
# The Python package as users get it: builds the wheel, installs it where there is no compiler to be found, runs its
# tests, and compares ptriangle.compat with the package `triangle` from PyPI. Where PyPI cannot be reached, one line
# says so.
# Usage: tools/python.sh [FOLDER]   a scratch folder; build/python without
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
pip install numpy pytest matplotlib scikit-build-core || skip "PyPI cannot be reached"

must pip wheel --no-build-isolation --no-deps --wheel-dir "$work/wheels" "$root"
wheel=$(echo "$work"/wheels/ptriangle-*-py3-none-*.whl)
[ -f "$wheel" ] || { echo "python: no wheel py3-none-PLATFORM: $(ls "$work/wheels")"; exit 1; }
must pip install "$wheel"

cd "$work"
mkdir none # is all there is in the path: no compiler
PATH=$work/none "$work/venv/bin/python" -m pytest -q -p no:cacheprovider "$root/python/tests" -o testpaths=
if pip install triangle==20250106; then
    PATH=$work/none "$work/venv/bin/python" "$root/python/tests/against_pypi.py"
else
    echo "python: not compared: the package triangle does not install here ($(tail -n 1 "$work/log"))"
fi
