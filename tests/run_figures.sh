#!/bin/sh
# The numbers that the README gives for its first picture are those of the mesh that tools/mesh-coast.sh makes.
# Usage: run_figures.sh SOURCE_ROOT BUILD_DIR WORK_DIR
set -eu
rm -rf "$3"
mkdir -p "$3"
cp "$1/data/coast/norway_sea.poly" "$3"
"$2/bin/triangle" -pq30Q "$3/norway_sea.poly"
"$2/bin/trianglecheck" "$3/norway_sea.1" --poly "$3/norway_sea.poly" --min-angle 30 --json >"$3/check.json"
told=$(tr '\n' ' ' <"$1/README.md" | sed 's/.*Of the \([0-9,]*\) triangles \([0-9,]*\) are below 30 degrees.*/\1 \2/; s/,//g')
found=$(sed 's/.*"triangles": \([0-9]*\).*"below_min_angle": \([0-9]*\).*/\1 \2/' "$3/check.json")
echo "triangles, and those below 30 degrees: README $told, mesh $found"
[ "$told" = "$found" ]
