#!/bin/sh
# Runs one script of command line tests. Usage: run.sh NAME BIN_DIR DATA_DIR SHARED_DATA_DIR|"" WORK_DIR
set -u
here=$(cd "$(dirname "$0")" && pwd)
name=$1
bin=$2
data=$3
shared=$4
work=$5
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2
LC_ALL=C
export LC_ALL
. "$here/lib.sh"
. "$here/$name.sh"
echo "cli $name: $checks checks, $faults faults"
[ "$checks" -gt 0 ] && [ "$faults" -eq 0 ]
