#!/bin/sh
# Builds the site build/site from docs/, the headers, the docstrings and the help texts. Warnings are errors. Open
# build/site/index.html; the site needs no web server. Sphinx and its extensions come from PyPI into a separate virtual
# environment, Doxygen from the system. If PyPI or Doxygen is not available, one line says so, and nothing is built.
# Usage: tools/docs.sh [FOLDER]     default: build/site
set -eu
cd "$(dirname "$0")/.."
root=$PWD
build=${PTRIANGLE_BUILD:-build}
site=${1:-$build/site}
mkdir -p "$build/docs" "$site"
work=$(cd "$build/docs" && pwd)
site=$(cd "$site" && pwd)

skip() {
    echo "docs: skipped: $1"
    exit 0
}
pip() { "$work/venv/bin/python" -m pip --disable-pip-version-check --no-input --retries 2 "$@" >"$work/log" 2>&1; }
must() { "$@" || { cat "$work/log"; exit 1; }; }

tools/setup.sh docs >"$work/log" 2>&1 || skip "$(tail -n 1 "$work/log")"
[ -x "$work/venv/bin/python" ] || python3 -m venv "$work/venv" || skip "python3 has no venv (Debian: python3-venv)"
pip install numpy scikit-build-core sphinx furo myst-parser breathe || skip "PyPI cannot be reached ($(tail -n 1 "$work/log"))"

# The wheel of tools/python.sh, if it is not older than the sources.
wheel=$(find "$build/python/wheels" -name 'ptriangle-*.whl' 2>/dev/null | head -n 1)
if [ -z "$wheel" ] || [ -n "$(find CMakeLists.txt cmake include python/ptriangle sched triangle -newer "$wheel" -type f | head -n 1)" ]; then
    must pip wheel --no-build-isolation --no-deps --wheel-dir "$work/wheels" "$root"
    wheel=$(echo "$work"/wheels/ptriangle-*.whl)
fi
must pip install --force-reinstall --no-deps "$wheel"

programs=$build/release/bin
[ -x "$programs/ptriangle" ] || programs=$work/venv/bin

cat >"$work/Doxyfile" <<END
PROJECT_NAME = ptriangle
INPUT = include/ptriangle triangle/dropin/triangle.h
INPUT_FILTER = "python3 docs/site/comments.py"
OUTPUT_DIRECTORY = $work/doxygen
OPTIMIZE_OUTPUT_FOR_C = YES
EXTRACT_ALL = YES
EXTRACT_STATIC = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
MARKDOWN_SUPPORT = NO
AUTOLINK_SUPPORT = NO
JAVADOC_AUTOBRIEF = NO
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
PREDEFINED = EXTERNAL_TEST
WARN_IF_UNDOCUMENTED = NO
WARN_AS_ERROR = FAIL_ON_WARNINGS
QUIET = YES
END
rm -rf "$work/doxygen"
mkdir -p "$work/doxygen"
doxygen "$work/Doxyfile"

python3 docs/site/make_source.py "$work/source" "$programs"
version=$(sed -n 's/^project(.*VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt | head -n 1)
PTRIANGLE_VERSION=$version PTRIANGLE_DOXYGEN=$work/doxygen/xml \
    "$work/venv/bin/python" -m sphinx -W --keep-going -q -E -b html -d "$work/doctrees" "$work/source" "$site"
echo "docs: $(find "$site" -name '*.html' | wc -l) pages in $site"
