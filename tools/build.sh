#!/bin/sh
# Configures and builds a preset of CMakePresets.json on all cores, into build/<preset>.
# Usage: tools/build.sh PRESET [CMAKE_OPTION...]
# PTRIANGLE_BUILD: another folder for the builds. PTRIANGLE_TARGET: the target to build; default: all.
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift
folder=${PTRIANGLE_BUILD:-build}/$preset
cmake --preset "$preset" -B "$folder" "$@"
cmake --build "$folder" --parallel "$(nproc 2>/dev/null || echo 2)" --target "${PTRIANGLE_TARGET:-all}"
