# The schedule's mesh has about as many triangles as that of one sequential call: within a tenth with cells of the
# default size, within a half with cells of 60 triangles, where every block is a seam.

size_of() { # size_of PROGRAM BLOCK SWITCHES BASE: number of triangles
    rm -f "$4".1.*
    PTRIANGLE_TEST_BLOCK=$2 "$bin/$1" "$3" "$4.poly" >.out 2>.err || return
    awk 'NR == 1 { print $1 }' "$4.1.ele"
}

about() { # about SWITCHES FILE
    base=${2##*/}
    base=${base%.poly}
    fresh "$2"
    what="$1 $2"
    sequential=$(size_of triangle "" "$1" "$base")
    [ -n "$sequential" ] || return # refused
    own=$(size_of ptriangle "" "$1" "$base")
    tiny=$(size_of ptriangle 60 "$1" "$base")
    check "$own triangles, sequentially $sequential" test $((own * 10)) -le $((sequential * 11 + 1000))
    check "$tiny triangles in tiny cells, sequentially $sequential" test "$tiny" -le $((sequential * 3 / 2 + 100))
}

for input in "$data"/*.poly "$data"/regress/*.poly "$data"/nasty/*.poly; do
    about -pcq20Q "${input#"$data"/}"
    about -pq30Q "${input#"$data"/}"
done
