#!/bin/sh
# report.py accepts correct meshes. It fails and names the input if a mesh is larger than before, is missing, or is
# invalid. Usage: fails.sh PYTHON BIN_DIR WORK_DIR
set -eu
report=$(cd "$(dirname "$0")" && pwd)/report.py
python=$1
bin=$2
work=$3
rm -rf "$work"
mkdir -p "$work/bin"
cd "$work"

report() { # report BIN_DIR: runs report.py on one input, with the baseline here; returns its exit code
    code=0
    "$python" "$report" "$1" --more= --only letter.poly --baseline baseline.txt >out.txt || code=$?
    return $code
}

fails() { # fails BIN_DIR PATTERN: expects report.py to fail with a line that matches
    if report "$1" || ! grep -qE "^WORSE data/letter.poly $2" out.txt; then
        echo "corpus: no line matches: $2" && cat out.txt && exit 1
    fi
}

"$python" "$report" "$bin" --more= --only letter.poly --baseline true.txt --renew
cp true.txt baseline.txt
report "$bin"
sed 's:[0-9][0-9]*/:10/:g' true.txt >baseline.txt
fails "$bin" "-q34: [0-9]+ triangles, 10 before"
ln -s "$bin/triangle" bin/triangle
cat >bin/trianglecheck <<'END'
#!/bin/sh
echo '{"checks": [{"name": "no overlap", "state": "failed", "count": 1}], "below_min_angle": 0}'
END
chmod +x bin/trianglecheck
fails bin "-q20: .*no overlap"
fails bin "-q20: no mesh, 10 triangles before"
