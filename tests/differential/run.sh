#!/bin/sh
# Compares our `triangle` and our triangulate() with Triangle 1.6 on generated inputs (differential.py). Triangle is not
# part of this project. It is installed as the Python package `triangle` from PyPI into a virtual environment in the
# work folder, which later runs reuse. PTRIANGLE_ORACLE_PYTHON may name a Python that has it already. Without either:
# one line and exit code 77.
# Usage: run.sh BIN_DIR WORK_DIR C_COMPILER LIBTRIANGLE.a|"" (without it only the program is compared)
set -u
here=$(cd "$(dirname "$0")" && pwd)
bin=$1
work=$2
cc=$3
archive=$4
python=${PTRIANGLE_ORACLE_PYTHON:-$work/venv/bin/python}
PYTHONDONTWRITEBYTECODE=1
export PYTHONDONTWRITEBYTECODE

skip() {
    echo "differential: skipped: $*"
    exit 77
}

install_oracle() {
    python3 -m venv "$work/venv" >"$work/install.log" 2>&1 || skip "no python3 with venv"
    "$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --timeout 20 --retries 1 triangle numpy \
        >>"$work/install.log" 2>&1 || skip "the package triangle cannot be had from PyPI, see $work/install.log"
}

works() { "$python" -c "import triangle.core" >/dev/null 2>&1; }

# The archive hides its names from other programs. This command exports one of them.
share_library() {
    cat >"$work/entry.c" <<'END'
int triangulate(const char *switches, void *in, void *out, void *vorout);
int run(const char *switches, void *in, void *out, void *vorout);
int run(const char *switches, void *in, void *out, void *vorout) { return triangulate(switches, in, out, vorout); }
END
    "$cc" -shared -fPIC "$work/entry.c" "$archive" -lm -o "$work/entry.so"
}

command -v python3 >/dev/null || skip "no python3"
mkdir -p "$work"
if [ -z "${PTRIANGLE_ORACLE_PYTHON:-}" ] && ! works; then
    install_oracle
fi
works || skip "$python has no package triangle"
shared=""
if [ -n "$archive" ]; then
    share_library || exit 1
    shared=$work/entry.so
fi
python3 "$here/differential.py" "$bin" "$work/cases" "$python" "$shared"
