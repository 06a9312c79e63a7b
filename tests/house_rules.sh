#!/bin/sh
# House rules that a command can check (CONTRIBUTING.md). Usage: house_rules.sh SOURCE_ROOT C_COMPILER
# [FOLDER_OF_HDF5_H]
# Prints one line per breach. Exit code 1 if there is any.
set -u
root=$1
cc=$2
hdf5=${3:-}
cd "$root" || exit 2
breaches=0

breach() {
    echo "house rules: $*"
    breaches=$((breaches + 1))
}

# Code without comments, as "FILE:LINE: CODE", which is what the compiler sees. Strings are kept, so a /* inside a
# string would be mistaken for a comment.
code=$(mktemp)
trap 'rm -f "$code"' EXIT
awk '{
    if (FNR == 1) inside = 0
    line = $0; out = ""
    while (line != "") {
        if (inside) {
            end = index(line, "*/")
            if (!end) break
            line = substr(line, end + 2); inside = 0
        } else {
            start = index(line, "/*"); slashes = index(line, "//")
            if (slashes && (!start || slashes < start)) { out = out substr(line, 1, slashes - 1); break }
            if (!start) { out = out line; break }
            out = out substr(line, 1, start - 1) " "; line = substr(line, start + 2); inside = 1
        }
    }
    print FILENAME ":" FNR ": " out
}' triangle/*/*.[ch] triangle/*/*.cpp sched/*/*.[ch] drivers/*.[ch] drivers/*/*.[ch] >"$code"

# refuse PATTERN REASON FILE...
refuse() {
    pattern=$1
    reason=$2
    shift 2
    found=$(grep -E "$pattern" "$code" | grep -v "format(printf" |
        awk -F: -v files=" $* " 'index(files, " " $1 " ")' | head -n 3)
    [ -z "$found" ] || breach "$reason: $found"
}

# 1. Every source file is in a list, and every list entry is a file.
for file in triangle/*/*.c triangle/*/*.cpp sched/*/*.c; do
    [ -f "$file" ] || continue
    grep -qE "(^|[ (])$file([ )]|\$)" cmake/sources.cmake || breach "$file is in no list of cmake/sources.cmake"
done
for file in tests/test_*.c; do
    [ -f "$file" ] || continue
    name=${file#tests/test_}
    grep -qE "ptriangle_test\(${name%.c}[ )]" tests/CMakeLists.txt || breach "$file is not registered in tests/CMakeLists.txt"
done

# ... and has a test program of its name, unless the test of another name covers it.
tested_by() {
    case $1 in
    triangle/check/*) echo check ;;
    triangle/hdf5/*) echo hdf5 ;;
    triangle/base/system_*_process.c) echo system_process ;;
    triangle/base/system_*) echo system ;;
    triangle/api/* | sched/schedule/library.c) echo api ;;
    triangle/dropin/switches.c) echo switches ;;
    triangle/dropin/*) echo triangulate ;;
    triangle/text/names.c) echo read ;;
    triangle/text/output.c | triangle/text/layouts.c) echo write ;;
    triangle/text/stream.c) echo text_stream ;;
    triangle/text/boundary.c | triangle/text/gmsh.c) echo formats ;;
    triangle/text/read_raster.c | triangle/text/read_jigsaw.c | triangle/text/read_view.c) echo size_file ;;
    triangle/text/words.c) echo size_file ;;
    triangle/text/read_*.c | triangle/text/reading.c) echo read_formats ;;
    triangle/text/hydro.c | triangle/text/parts.c | triangle/text/vtu.c) echo formats ;;
    triangle/mesh/parents.c) echo groundwork ;;
    triangle/size/gap.c) echo hopeless ;;
    triangle/size/candidates.c | triangle/size/near.c | triangle/size/raster.c) echo lengths ;;
    triangle/size/figure_sizes.c | triangle/size/spread.c | triangle/size/sampled.c | triangle/size/background.c) echo lengths ;;
    triangle/refine/place.c) echo inside ;;
    triangle/refine/star.c | triangle/refine/degrees.c) echo smooth ;;
    triangle/refine/feed.c | triangle/refine/treat.c) echo refine ;;
    sched/schedule/par_triangulate.c) echo par_triangulate ;;
    sched/checkpoint/*) echo checkpoint ;;
    sched/schedule/deal.c) echo numbering ;;
    sched/tiles/finds.c | sched/tiles/numbering.c | sched/tiles/pipeline.c | sched/tiles/queue.c) basename "$1" .c ;;
    sched/schedule/collect.c) echo phase ;;
    sched/schedule/smoothing.c) echo smooth ;;
    sched/schedule/prerefine.c) echo theory ;;
    sched/schedule/threads.c) echo team ;;
    sched/tiles/*) echo schedule ;;
    sched/ranks/*) echo ranks ;;
    *) basename "${1%.*}" ;;
    esac
}
for file in triangle/*/*.c triangle/*/*.cpp sched/*/*.c; do
    [ -f "tests/test_$(tested_by "$file").c" ] || breach "$file has no test program"
done

# 2. Calls go from drivers/ to sched/ to triangle/, never back, and only sched/ uses threads. Folders in triangle/ may
# include the mesher. The mesher includes none of them, and they do not include each other. Exceptions: api/ includes
# them all, dropin/ runs the stages of api/ (generate.h), and the files of hdf5/ are outputs of text/.
refuse '#[[:space:]]*include[[:space:]]*"(sched|drivers|tests)/' 'includes an upper folder' \
    triangle/*/*.[ch] triangle/*/*.cpp
refuse '#[[:space:]]*include[[:space:]]*"(drivers|tests)/' 'includes an upper folder' sched/*/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(api|text|hdf5|dropin|check)/' 'includes a folder of the mesher' \
    triangle/base/*.[ch] triangle/geometry/*.[ch] triangle/mesh/*.[ch] triangle/cdt/*.[ch] triangle/refine/*.[ch] \
    triangle/size/*.[ch]
# In the mesher base/ <- geometry/ <- mesh/ <- cdt/ <- size/ <- refine/.
refuse '#[[:space:]]*include[[:space:]]*"triangle/(geometry|mesh|cdt|refine|size)/' 'includes an upper folder' \
    triangle/base/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(mesh|cdt|refine|size)/' 'includes an upper folder' \
    triangle/geometry/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(cdt|refine|size)/' 'includes an upper folder' \
    triangle/mesh/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(refine|size)/' 'includes an upper folder' triangle/cdt/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/refine/' 'includes an upper folder' triangle/size/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(api|hdf5|dropin|check)/' 'includes another folder' triangle/text/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(api|dropin|check)/' 'includes another folder' triangle/hdf5/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"triangle/(text|hdf5|check)/' 'includes another folder' triangle/dropin/*.[ch]
refuse '#[[:space:]]*include[[:space:]]*"(triangle|sched|drivers)/' 'is public, and includes a private header' \
    include/ptriangle/*.h
# shellcheck disable=SC2046 # one word a file
refuse '#[[:space:]]*pragma[[:space:]]+omp|<(omp|threads)\.h>|tri_(thread_(start|join)|monitor_)' 'uses threads' \
    $(ls triangle/*/*.[ch] triangle/*/*.cpp | grep -v '^triangle/base/system')

# The interface to the system is triangle/base/system.h: no other file uses names beyond those of C's own library. The
# exceptions and their reasons are in CONTRIBUTING.md ("The door to the system").
# shellcheck disable=SC2046 # one word a file
refuse '#[[:space:]]*include[[:space:]]*<((sys|net|netinet|arpa|mach)/|(aio|dirent|dlfcn|fcntl|getopt|malloc|netdb|poll|pthread|pwd|sched|semaphore|signal|spawn|strings|syslog|termios|ucontext|unistd|utime|windows|io)\.h>)|_(POSIX_C|GNU|DEFAULT|XOPEN|DARWIN_C)_SOURCE|(^|[^a-z_>.])(open_memstream|posix_memalign|strerror_r|fileno|fdopen|dprintf|popen|setenv|mkstemp|strdup|clock_gettime|nanosleep|ssize_t|off_t)([^a-z_]|$)' \
    'calls the system past triangle/base/system.h' \
    $(ls triangle/*/*.[ch] triangle/*/*.cpp sched/*/*.[ch] drivers/*.[ch] drivers/*/*.[ch] |
        grep -v -e '^triangle/base/system_' -e '^drivers/start\.c$' -e '^drivers/words\.h$')

# The sweep and the ranks are built on the headers of the schedule. Only sched/schedule/*.c, which choose between them,
# include both.
refuse '#[[:space:]]*include[[:space:]]*"sched/(tiles|checkpoint|ranks)/' 'includes a header of a higher layer' sched/schedule/*.h
refuse '#[[:space:]]*include[[:space:]]*"sched/ranks/' 'includes a header of a higher layer' sched/tiles/*.[ch] \
    sched/checkpoint/*.[ch]

# The sequential program includes no schedule, nor do the stages that it shares with the parallel program
# (drivers/mesh/stages.h).
# shellcheck disable=SC2046 # one word a file
refuse '#[[:space:]]*include[[:space:]]*"sched/' 'is part of triangle, and includes the schedule' drivers/mesh/triangle.c \
    $(sed -n '/^set(PTRIANGLE_RUN_SOURCES/,/)/p' cmake/sources.cmake | grep -oE 'drivers/[a-z_/]+' | sed 's/$/.c/; p; s/c$/h/')

# Only one file runs work in parallel. All other files pass tasks to an executor.
others=$(ls sched/*/*.[ch] drivers/*.[ch] drivers/*/*.[ch] | grep -vxE 'sched/schedule/(threads|team)\.c' | tr '\n' ' ')
# shellcheck disable=SC2086 # one word a file
refuse '#[[:space:]]*pragma[[:space:]]+omp|<omp\.h>' 'does not leave threads to sched/schedule/team.c' $others

# All arrays grow by the same function. Arrays of the mesh lie in a storage, or are aligned to a cache line.
others=$(ls triangle/*/*.[ch] triangle/*/*.cpp sched/*/*.[ch] drivers/*.[ch] drivers/*/*.[ch] |
    grep -vx -e triangle/base/grow.h -e triangle/mesh/mesh.c | tr '\n' ' ')
# shellcheck disable=SC2086 # one word a file
refuse '[^a-z_]realloc\(' 'grows an array without triangle/base/grow.h' $others

# Only one file includes MPI, so that all others can be compiled and tested without it.
others=$(ls triangle/*/*.[ch] sched/*/*.[ch] | grep -vx sched/ranks/mpi.c | tr '\n' ' ')
# shellcheck disable=SC2086 # one word a file
refuse '#[[:space:]]*include[[:space:]]*[<"](ptriangle/)?mpi\.h' 'includes MPI' $others

# The checker uses nothing of the mesher except input, predicates and tools, since it must be independent of the code
# that it checks.
for file in triangle/check/*.[ch]; do
    strange=$("$cc" -std=c11 -I . -I include -MM -x c "$file" | tr ' \\' '\n\n' | grep '^triangle/' |
        grep -vE '^triangle/(check/[a-z_]+\.[ch]|mesh/pslg\.h|geometry/(predicates|expansion|point)\.h|base/(status|arithmetic|executor|grow|order|system)\.h)$')
    [ -z "$strange" ] || breach "$file includes" $strange
done

# The schedule controls refinement through its hooks. Judging triangles and inserting points are internal to the mesher.
# (api/ and dropin/ are the library's interfaces, and sched/ has its own versions of them.)
hooks='mesh/(mesh|fence|surface)|refine/(refine|census|smooth)|size/estimate|api/(generate|opaque_mesh)|dropin/(triangle|call)'
tools='base/[a-z_]+|geometry/(hilbert|point|shape)'
strange=$(grep -E '^sched/.*#[[:space:]]*include[[:space:]]*"triangle/' "$code" |
    grep -vE '"triangle/('"$hooks|$tools"')\.h"' | head -n 3)
[ -z "$strange" ] || breach "sched/ includes headers that are not hooks: $strange"

# 3. Libraries do not print, end the process or change the locale. The only exception is the one line of triangulate().
others=$(ls triangle/*/*.[ch] triangle/*/*.cpp sched/*/*.[ch] |
    grep -vx triangle/dropin/aloud.c | tr '\n' ' ')
# shellcheck disable=SC2086 # one word a file
refuse '(^|[^_a-zA-Z0-9])(printf|puts|putchar|perror|exit|_exit|abort|setlocale|std(out|err))([^_a-zA-Z0-9]|$)' \
    'prints, exits or touches the locale' $others

# 4. No line of code is longer than 120 characters. (Lines of scripts and of CMake may contain a longer word or
# pattern.)
long=$(LC_ALL=C.UTF-8 grep -nE '^.{121,}$' triangle/*/*.[ch] triangle/*/*.cpp sched/*/*.[ch] \
    drivers/*.[ch] drivers/*/*.[ch] tests/*.[ch] tests/*/*.[ch] tests/*/*/*.c* include/*/*.h \
    bench/*.py python/*/*.py tests/*.py tests/*/*.py tools/*.py | head -n 3)
[ -z "$long" ] || breach "lines of more than 120 characters: $long"

# ... and no line of the documents, except rows of tables.
long=$(LC_ALL=C.UTF-8 grep -nE '^[^|].{120,}' ./*.md docs/*.md data/*.md | head -n 3)
[ -z "$long" ] || breach "lines of more than 120 characters: $long"

# ... and no struct of sched/ and drivers/ has more than 20 fields, including the fields of structs inside it. Options
# and reports may have more.
crowded=$(grep -E '^(sched|drivers)/' "$code" | awk '
    name == "" && /^[^ ]* (typedef |static |const )*(struct|union)( [a-z0-9_]+)? \{ *$/ { name = $0; fields = 0; next }
    name != "" && /^[^ ]* \}/ { if (fields > 20) print name " " fields " fields"; name = "" }
    name != "" && !/^[^ ]* +\} *;/ {
        while (gsub(/\([^()]*\)|\[[^][]*\]/, "")) { }
        fields += gsub(/[;,]/, "")
    }' | grep -vE ' struct (par_options|par_report|long_options) ')
[ -z "$crowded" ] || breach "more than 20 fields: $crowded"

# 5. Each header compiles alone. Headers of hdf5/ are compiled if HDF5 is installed. The header for MPI is compiled in
# its client (tests/client/ranks.c).
for file in include/*/*.h triangle/*/*.h sched/*/*.h; do
    [ -f "$file" ] || continue
    case $file in triangle/hdf5/*) [ -n "$hdf5" ] || continue ;; include/ptriangle/mpi.h) continue ;; esac
    "$cc" -std=c11 -Wall -Wextra -Wno-unused -I . -I include ${hdf5:+-isystem "$hdf5"} \
        -fsyntax-only -x c -include "$file" /dev/null || breach "$file does not compile alone"
done

# 6. The top folder contains only the entries listed here. Files left by a run must not be committed.
known='\.(ci|clang-format|clang-tidy|gitattributes|github|gitignore)|[A-Z]+(\.md)?|CITATION\.cff|CMake(Lists\.txt|Presets\.json)'
known="$known|Makefile\.bench|pyproject\.toml|bench|cmake|data|debian|docs|drivers|examples|include|packaging|python|sched|tests|tools|triangle|web"
if [ -e .git ] && command -v git >/dev/null; then
    strange=$(git ls-files | cut -d / -f 1 | sort -u | grep -vxE "$known")
    [ -z "$strange" ] || breach "unexpected files in the top folder:" $strange
fi

[ "$breaches" -eq 0 ] && echo "house rules: kept"
[ "$breaches" -eq 0 ]
