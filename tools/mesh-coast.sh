#!/bin/sh
# Builds the programs and meshes a real coastline: the sea off Norway, with no angle below 30 degrees except where the
# coast itself is sharper. Then the checker verifies the mesh, and it is drawn. A missing compiler, make, CMake or cairo
# is installed first (tools/setup.sh explains how to avoid that).
# Usage: tools/mesh-coast.sh [OUTPUT_FOLDER]     default: out
set -eu
here=$(pwd)
cd "$(dirname "$0")/.."
case ${1:-} in
"") out=out ;;
/*) out=$1 ;;
*) out=$here/$1 ;;
esac
angle=30
programs=${PTRIANGLE_BUILD:-build}/release/bin

tools/setup.sh coast
tools/build.sh release
mkdir -p "$out"
cp data/coast/norway_sea.poly "$out/"

echo
echo "triangle -pq$angle $out/norway_sea.poly"
"$programs/triangle" "-pq$angle" "$out/norway_sea.poly"
echo
echo "trianglecheck $out/norway_sea.1 --poly $out/norway_sea.poly --min-angle $angle"
"$programs/trianglecheck" "$out/norway_sea.1" --poly "$out/norway_sea.poly" --min-angle "$angle"

if [ -x "$programs/meshplot" ]; then
    echo
    echo "meshplot $out/norway_sea.1 -o $out/norway_sea.1.png"
    "$programs/meshplot" "$out/norway_sea.1" -o "$out/norway_sea.1.png"
fi

echo
echo "Wrote a mesh of $(awk '!/^#/ { print $1; exit }' "$out/norway_sea.1.ele") triangles and" \
    "$(awk '!/^#/ { print $1; exit }' "$out/norway_sea.1.node") vertices:"
ls -l "$out"/norway_sea.1.*
