# ptriangle: the same bytes for any number of threads. Tiny cells give small meshes many blocks. threads_large.sh runs
# the same test with cells and meshes of realistic size.
if [ "$name" = threads ]; then
    PTRIANGLE_TEST_BLOCK=500
    export PTRIANGLE_TEST_BLOCK
    coarser=16 # factor for areas
    counts="1 8 3"
else
    coarser=1
    counts="1 8 2 4 3 2"
fi

sums() { cat ./*.node ./*.ele ./*.poly | cksum; }

# same AREA SWITCHES JUDGE_OPTIONS INPUT: all files, including the comment that quotes the command line, are the same
# for any number of threads and for repeated runs. There are several blocks. The mesh meets the area bound and the
# options.
same() {
    [ "$name" != threads ] || every 4 || return 0
    area=$(echo "$1" | awk -v n=$coarser '{ printf "%.17g", n * $1 }')
    input=$4
    base=$(basename "${input%.*}")
    fresh "$input"
    first=
    for threads in $counts; do
        OMP_NUM_THREADS=$threads program 0 "$2Q" --max-area "$area" --report report.json "$base"
        found=$(sums)
        [ -n "$first" ] || first=$found
        checks=$((checks + 1))
        [ "$found" = "$first" ] || fault "another mesh with $threads threads"
        [ "$found" = "$first" ] || return
        check "threads in the report" grep -qx " \"threads\": $threads,\?" report.json
    done
    blocks=$(grep -c '"block":' report.json)
    checks=$((checks + 1))
    [ "$blocks" -gt 4 ] || fault "$blocks blocks are no schedule"
    # shellcheck disable=SC2086 # several words
    judge "$base.1" --poly "$base.poly" --max-area "$area" $3
}

# Area bounds for 100,000 to 300,000 triangles; graded inputs have many of them along their boundaries. If small angles
# or narrow channels of the input leave triangles below the bound, their number is limited.
same 4e-4 -pq30 "--min-angle 30" letter.poly
same 6e-6 -pq "--min-angle 20" square_random1000.poly
same 6e6 -pq30 "--max-bad 300" coast/norway_sea.poly
same 3e8 -pq30aA "--max-bad 60" coast/borders.poly
same 0.004 -pqaA "--min-angle 20" section.poly
same 0.012 -pq32 "--min-angle 32" gear.poly
same 6e-6 -pqD "--min-angle 20 --conforming" koch_lake.poly
same 0.0015 -pq30 "--min-angle 30" perforated.poly
same 1e-4 -pq30 "--min-angle 30" naca2412_box.poly
same 4e-4 -pqY "--max-bad 2000" cracked_plate.poly
same 1e-5 -pq30 "--max-bad 500" nasty/slit_1e-9.poly
same 1e-5 -p "" square.poly
