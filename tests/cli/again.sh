# Refining a finished mesh again with the same bounds adds almost nothing: triangles that were given up at corners and
# in narrow spaces are given up again. (From 33 degrees on, if points accumulated, a second run treats the short edges
# as features and continues from there.)

size_of() { # size_of BASE: number of triangles
    awk 'NR == 1 { print $1 }' "$1.ele"
}

again() { # again ANGLE FILE
    base=${2##*/}
    base=${base%.poly}
    fresh "$2"
    what="-rpq$1 $2"
    "$bin/triangle" "-pq$1Q" "$base.poly" >.out 2>.err || return # refused
    "$bin/triangle" "-rpq$1Q" "$base.1" >.out 2>.err || fault "exit code $?"
    first=$(size_of "$base.1")
    second=$(size_of "$base.2")
    check "$second triangles, before $first" test $((second * 10)) -le $((first * 11 + 1000))
}

for input in "$data"/*.poly "$data"/regress/*.poly "$data"/nasty/*.poly "$data"/coast/*.poly; do
    again 20 "${input#"$data"/}"
    again 30 "${input#"$data"/}"
done
