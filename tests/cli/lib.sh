# Functions of the command line tests. run.sh sources each test script with these variables set, in an empty folder of
# its own: $bin (programs), $data (data/ of the tree), $shared (more inputs, or empty).

faults=0
checks=0
what=""

# With PTRIANGLE_TEST_FULL a test tries all of its cases, otherwise as many as fit into half a minute.
full() { [ -n "${PTRIANGLE_TEST_FULL:-}" ]; }

turn=-1
every() { # every N: succeeds each N-th time, or always when full
    turn=$((turn + 1))
    full || [ $((turn % $1)) -eq 0 ]
}

fault() {
    echo "cli: $what: $*"
    faults=$((faults + 1))
}

check() { # check DESCRIPTION COMMAND...: the command must succeed
    description=$1
    shift
    checks=$((checks + 1))
    "$@" >/dev/null 2>&1 || fault "$description"
}

fresh() { # makes an empty folder with the named inputs of data/ in it
    rm -rf ./* ./.tri-*
    for input; do
        cp "$data/$input" .
    done
    ls >.before
}

mesher() { # mesher CODE PROGRAM WORDS...: expects the exit code; the output is kept in .out and .err
    code=$1
    program=$2
    shift 2
    what="$program $*"
    checks=$((checks + 1))
    "$bin/$program" "$@" >.out 2>.err
    found=$?
    [ "$found" -eq "$code" ] || fault "exit code $found instead of $code: $(head -n 1 .err)"
}
run() { # run CODE WORDS...: the same for triangle
    code=$1
    shift
    mesher "$code" triangle "$@"
}
program() { # program CODE WORDS...: the same for ptriangle
    code=$1
    shift
    mesher "$code" ptriangle "$@"
}

in_time() { # in_time CODE: CODE, from a run with a time limit, must be 0 or the code of a stop
    checks=$((checks + 1))
    [ "$1" -eq 0 ] || [ "$1" -eq 124 ] || { fault "exit code $1: $(head -n 1 .err)" && return 1; }
}

says() { check "does not say: $1" grep -qxF -e "$1" .out; }      # the output must contain this whole line
matches() { check "no line matches: $1" grep -qE -e "$1" .out; } # a line must match this pattern
silent_on() { check "says: $1" sh -c "! grep -qE -e \"\$1\" .out" sh "$1"; }
complains() { check "no error matches: $1 but: $(head -n 1 .err)" grep -qE -e "$1" .err; }
calm() { check "standard error: $(head -n 1 .err)" test ! -s .err; }

new_files() { ls -A | grep -v '^\.\(before\|out\|err\|found\|expected\)$' | grep -vxF -f .before | tr '\n' ' '; }

wrote() { # wrote NAMES...: exactly these files are new
    expected=$(printf '%s\n' "$@" | grep . | LC_ALL=C sort | tr '\n' ' ')
    found=$(new_files | tr ' ' '\n' | grep . | LC_ALL=C sort | tr '\n' ' ')
    checks=$((checks + 1))
    [ "$found" = "$expected" ] || fault "wrote: $found instead of: $expected"
}

header() { # header FILE TEXT: the first record must be TEXT
    found=$(awk '!/^[ \t]*(#|$)/ { $1 = $1; print; exit }' "$1")
    checks=$((checks + 1))
    [ "$found" = "$2" ] || fault "$1 begins with $found instead of $2"
}

records() { awk '!/^[ \t]*(#|$)/ { $1 = $1; print }' "$1"; } # lines without comments, single blanks

judge() { check "trianglecheck $*" "$bin/trianglecheck" --quiet "$@"; }

counts() { # counts V T E EXTERIOR INTERIOR SUBSEGMENTS: compares the statistics; a dot is not compared
    found=$(awk '/Mesh vertices:/ { v = $NF } /Mesh triangles:/ { t = $NF } /Mesh edges:/ { e = $NF }
                 /exterior boundary/ { x = $NF } /interior boundary/ { i = $NF } /Mesh subsegments/ { s = $NF }
                 END { print v, t, e, x, i, s }' .out)
    checks=$((checks + 1))
    same=$(echo "$found" | awk -v expected="$*" '{ n = split(expected, e, " ")
        for (k = 1; k <= n; k++) if (e[k] != "." && e[k] != $k) { print "no"; exit } print "yes" }')
    [ "$same" = yes ] || fault "counts $found instead of $*"
}

# Two squares side by side, each with corners of its own, a point outside, and a segment in the first square that runs
# to the left. The rings have both directions. Markers of segments count from 1.
orphans() {
    printf '%s\n' "11 2 1 0" "1 0 0 1" "2 1 0 2" "3 1 1 3" "4 0 1 4" "5 1 0 5" "6 2 0 6" "7 2 1 7" "8 1 1 8" "9 5 5 9" \
        "10 .3 .4 10" "11 .7 .6 11" "9 1" "1 1 2 1" "2 2 3 2" "3 3 4 3" "4 4 1 4" "5 6 5 5" "6 7 6 6" "7 8 7 7" \
        "8 8 5 2" "9 11 10 9" 0
}
