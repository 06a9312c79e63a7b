#!/bin/sh
# Builds the Debian packages from the tracked files of the tree in their current state, and prints lintian's findings if
# lintian is installed.
# Usage: tools/deb.sh [OUTPUT_FOLDER]     default: out/deb
# Needs: apt-get install build-essential debhelper, and apt-get build-dep . in this folder.
set -eu
here=$(pwd)
cd "$(dirname "$0")/.."
case ${1:-} in
"") out=$(pwd)/out/deb ;;
/*) out=$1 ;;
*) out=$here/$1 ;;
esac
dpkg-checkbuilddeps
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/ptriangle"
git ls-files -z | tar --null -T - -cf - | tar -xf - -C "$work/ptriangle"
(cd "$work/ptriangle" && DEB_BUILD_OPTIONS="parallel=$(nproc) ${DEB_BUILD_OPTIONS:-}" dpkg-buildpackage --build=binary -us -uc)
mkdir -p "$out"
rm -f "$out"/*ptriangle*
mv "$work"/*.deb "$work"/*.changes "$work"/*.buildinfo "$out/"
if command -v lintian >/dev/null; then
    lintian --fail-on error "$out"/*.changes
fi
ls -l "$out"/*.deb
