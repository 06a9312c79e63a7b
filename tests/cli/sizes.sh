# Lengths of edges: --size and related options, in both programs; fields in files of every format; invalid fields.

triangles() { awk '!/^[ \t]*(#|$)/ { print $1; exit }' "$1.ele"; } # triangles BASE: number of triangles

same() { # same A B: two files are equal except for the command in their last line
    records "$1" >.expected
    check "$1 and $2 are the same" sh -c 'test -s .expected && grep -v "^#" "$1" | awk "{ \$1 = \$1; print }" | cmp - .expected' sh "$2"
}

alike() { # alike N M: two counts differ by at most 3%
    checks=$((checks + 1))
    echo "$1 $2" | awk '{ exit !($1 > 0 && $1 < 1.03 * $2 && $2 < 1.03 * $1) }' || fault "$1 and $2 triangles"
}

sizes_ratio() { # sizes_ratio BASE H: the mean edge length of the triangles is about H
    ratio=$(awk -v h="$2" 'FNR == 1 { file++ } /^[ \t]*(#|$)/ { next } !((file, 0) in head) { head[file, 0]; next }
        file == 1 { x[$1] = $2; y[$1] = $3; next }
        { for (k = 2; k < 5; k++) { a = $k; b = $(k == 4 ? 2 : k + 1); sum += sqrt((x[a] - x[b])^2 + (y[a] - y[b])^2); n++ } }
        END { print sum / n / h }' "$1.node" "$1.ele")
    checks=$((checks + 1))
    echo "$ratio" | awk '{ exit !($1 > 0.75 && $1 < 1.2) }' || fault "edges are $ratio times as long as asked for"
}

# The field h = 0.25 + (x + 1) / 16 + (y + 1) / 8 on the square from -1 to 15, at 3 x 3 nodes, as rasters and as meshes.
fields() {
    awk 'BEGIN {
        asc = "ncols 3\nnrows 3\nxllcenter -1\nyllcenter -1\ncellsize 8\n"
        for (j = 2; j >= 0; j--) asc = asc h(0, j) " " h(1, j) " " h(2, j) "\n"
        printf "%s", asc >"raster.asc"
        axis = "-1\n7\n15\n"
        grid = "mshid=3;euclidean-grid\nndims=2\ncoord=1;3\n" axis "coord=2;3\n" axis "value=9;1\n"
        for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) grid = grid h(i, j) "\n"
        printf "%s", grid >"raster.msh"
        node = "9 2 1 0\n"; ele = "8 3 0\n"; nodes = "$Nodes\n9\n"; tags = ""; places = ""; data = ""; elements = ""; faces = ""
        points = "point=9\n"; values = "value=9;1\n"; tria = "tria3=8\n"; pos = "View \"h\" {\n"
        for (j = 0; j < 3; j++) for (i = 0; i < 3; i++) {
            n = 3 * j + i + 1; x[n] = 8 * i - 1; y[n] = 8 * j - 1; v[n] = h(i, j)
            node = node n " " x[n] " " y[n] " " v[n] "\n"
            nodes = nodes n " " x[n] " " y[n] " 0\n"; tags = tags n "\n"; places = places x[n] " " y[n] " 0\n"
            data = data n " " v[n] "\n"; points = points x[n] ";" y[n] ";0\n"; values = values v[n] "\n"
        }
        for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) {
            n = 3 * j + i + 1
            face(n, n + 1, n + 4); face(n, n + 4, n + 3)
        }
        printf "%s", node >"mesh.node"; printf "%s", ele >"mesh.ele"
        data = "$NodeData\n1\n\"lengths\"\n1\n0\n3\n0\n1\n9\n" data "$EndNodeData\n"
        format = " 0 8\n$EndMeshFormat\n"
        printf "%s", "$MeshFormat\n2.2" format nodes "$EndNodes\n$Elements\n8\n" elements "$EndElements\n" data >"mesh2.msh"
        printf "%s", "$MeshFormat\n4.1" format "$Nodes\n1 9 1 9\n2 1 0 9\n" tags places "$EndNodes\n$Elements\n1 8 1 8\n2 1 2 8\n" \
            faces "$EndElements\n" data >"mesh4.msh"
        printf "%s", "mshid=3;euclidean-mesh\nndims=2\n" points values tria >"mesh3.msh"
        printf "%s", pos "};\n" >"mesh.pos"
    }
    function h(i, j) { return 0.25 + i / 2 + j }
    function corner(n) { return x[n] "," y[n] ",0" }
    function face(a, b, c) {
        f++
        ele = ele f " " a " " b " " c "\n"; elements = elements f " 2 2 0 1 " a " " b " " c "\n"
        faces = faces f " " a " " b " " c "\n"; tria = tria (a - 1) ";" (b - 1) ";" (c - 1) ";0\n"
        pos = pos "ST(" corner(a) "," corner(b) "," corner(c) "){" v[a] "," v[b] "," v[c] "};\n"
    }'
    # the same numbers divided by four, as float32, the lowest row first
    { printf '\223NUMPY\001\000\077\000' && printf '%-62s\n' "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 3), }" &&
        printf '\000\000\200\076\000\000\100\077\000\000\240\077\000\000\240\077\000\000\340\077\000\000\020\100' &&
        printf '\000\000\020\100\000\000\060\100\000\000\120\100'; } >raster.npy
}

for mesher in triangle ptriangle; do
    [ -x "$bin/$mesher" ] || continue

    # --- values
    fresh letter.poly
    for words in "--size 0" "--size=-1" "--size 5m" "--size coast.tif" "--size-near 3" "--size-near 1:0" "--gradation 0" \
        "--min-size x" "--max-size inf" "--size a.npy@1,2,3"; do
        # shellcheck disable=SC2086 # one word or two
        mesher 1 $mesher -p letter $words
        complains "^$mesher: --[a-z-]*: \"[^\"]*\" is n"
        check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
    done
    mesher 1 $mesher -p letter --size
    complains "^$mesher: --size needs a value\$"
    mesher 1 $mesher -p letter --gradation 0.1
    complains "^$mesher: --gradation limits lengths that nothing asks for: "
    mesher 1 $mesher -p letter --max-size 1 --min-size 2
    complains "^$mesher: --min-size 2 is above --max-size 1\$"
    mesher 1 $mesher -p letter --size 1 --size 1 --size 1 --size 1 --size 1 --size 1 --size 1 --size 1 --size-near 1:1
    complains "^$mesher: no more than 8 times --size and --size-near\$"
    mesher 1 $mesher -p letter --size-near 99:1
    complains "^$mesher: --size-near 99:1.*: no segment has the marker 99\$"
    wrote

    # --- invalid files
    printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 x\n' >broken.asc
    printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 9\n-9999 0\n0 -9999\n' >empty.asc
    mesher 1 $mesher -p letter --size broken.asc
    complains '^broken\.asc:7: a length: "x" is not a number$'
    mesher 1 $mesher -p letter --size absent.asc
    complains '^absent\.asc: cannot open: '
    mesher 1 $mesher -p letter --size empty.asc
    complains "^$mesher: --size empty.asc.*: no value is above 0\$"
    wrote broken.asc empty.asc

    # --- a number sets an angle bound of 20 degrees and edges of about that length
    fresh letter.poly
    mesher 0 $mesher -p letter --size 0.5
    says "  Sizes: 0.5; gradation 0.2"
    says "All triangles keep the bounds."
    judge letter.1 --poly letter.poly --min-angle 20
    sizes_ratio letter.1 0.5
    mesher 0 $mesher -pq30 letter --max-size=0.5
    judge letter.1 --poly letter.poly --min-angle 30
    sizes_ratio letter.1 0.5
    # trianglecheck compares them, and fails below a share of edges that fit
    judge letter.1 --poly letter.poly --size 0.5 --min-fitting 0.8
    judge letter.1 --poly letter.poly --size 1.5
    "$bin/trianglecheck" letter.1 --poly letter.poly --size 1.5 --min-fitting 0.8 --json >.out 2>.err
    check "exit code of edges that are too short" test $? -eq 1
    matches '"passed": false.*"fitting": 0, "min_fitting": 0.8[0-9]*, "triangles_per_wanted": [0-9.]*, "mean_quality": 0\.[6-9]'
    "$bin/trianglecheck" letter.1 --poly letter.poly --size 1.5 --min-fitting 0.8 >.out 2>.err
    matches "^FAIL  lengths: [0-9]* of [0-9]* edges are not 0.7 to 1.4 times as long as wanted$"
    for words in "--size 1" "--poly letter.poly --min-fitting 0.5" "--poly letter.poly --size 0" \
        "--poly letter.poly --min-size 1" "--poly letter.poly --size 1 --optimise 1"; do
        # shellcheck disable=SC2086 # several words
        "$bin/trianglecheck" letter.1 $words >.out 2>.err
        check "trianglecheck $words: exit code" test $? -eq 2
    done
    # of an existing mesh
    mesher 0 $mesher -rp letter.1 --size 0.25
    sizes_ratio letter.2 0.25

    # --- near a marker: the shortest edges are there, and lengths grow with distance
    fresh koch_lake.poly
    mesher 0 $mesher -p koch_lake --size-near 2:0.004,0.15 --max-size 0.1
    says "  Sizes: 0.004 at segments with marker 2 growing by 0.15; at most 0.1; gradation 0.2"
    near=$(triangles koch_lake.1)
    mesher 0 $mesher -p koch_lake --size-near 2:0.004 --max-size 0.1 --gradation 0.5
    [ "$(triangles koch_lake.1)" -lt "$near" ] || fault "a steeper growth makes no fewer triangles than $near"

    # --- channels and curves: larger counts give more triangles
    fresh thin_channel.poly gear.poly
    more() { # more FILE OPTION N...: each value gives more triangles than the one before
        file=$1 option=$2 last=0
        shift 2
        for n; do
            mesher 0 $mesher -p "$file" "$option" "$n"
            [ "$(triangles "$file.1")" -gt $((last * 5 / 4)) ] || fault "$(triangles "$file.1") triangles after $last"
            last=$(triangles "$file.1")
        done
    }
    more thin_channel --elements-across 2 4 8
    more gear --per-circle 20 100 400

    # --- details of the input are removed, and a line says how many, also with -Q
    fresh koch_lake.poly letter.poly
    mesher 0 $mesher -p koch_lake --min-edge 0.02 --size 0.05
    matches "^Simplified by --min-edge 0.02: [1-9][0-9]* of [0-9]+ points are gone, .* [0-9]+ short segments remain\.\$"
    judge koch_lake.1 --poly koch_lake.poly --min-edge 0.02 --min-angle 20
    denies_simplified() {
        "$bin/trianglecheck" koch_lake.1 --poly koch_lake.poly "$@" >.out 2>.err
        check "the checker compares with another input: exit code" test $? -eq 1
    }
    denies_simplified
    denies_simplified --min-edge 0.1
    mesher 0 $mesher -pQ koch_lake --min-edge 0.02
    complains "^$mesher: Simplified by --min-edge 0.02: "
    mesher 1 $mesher -p letter --min-edge 1000
    complains ": no segment remains"
    mesher 1 $mesher -rp koch_lake.1 --min-edge 0.02
    complains "^$mesher: --min-edge simplifies segments"

    # --- one field in all formats: rasters give the same bytes, meshes as well, and both agree up to a few triangles
    fresh letter.poly
    fields
    ls >.before
    for field in raster.asc raster.npy@-1,-1,15,15 raster.msh mesh.node mesh2.msh mesh4.msh mesh3.msh mesh.pos; do
        mesher 0 $mesher -p letter --size "$field" --gradation inf
        mv letter.1.node "out_$field.node"
        mv letter.1.ele "out_$field.ele"
        silent_on "covers"
    done
    for field in raster.npy@-1,-1,15,15 raster.msh; do
        same out_raster.asc.node "out_$field.node"
    done
    for field in mesh2.msh mesh4.msh mesh3.msh; do
        same out_mesh.node.node "out_$field.node"
    done
    for field in mesh.node mesh.pos; do
        alike "$(triangles out_raster.asc)" "$(triangles "out_$field")"
    done
    # a field that ends too early is reported
    printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1\n1 1\n' >small.asc
    mesher 0 $mesher -p letter --size small.asc
    matches "^Warning:  .*small.asc covers .*nearest lengths count\.\$"
    # and no field file is overwritten
    cp mesh.node letter.1.node
    cp mesh.ele letter.1.ele
    mesher 1 $mesher -p letter --size letter.1.node
    complains "letter\.1\.node: "
    check "the field is unchanged" cmp mesh.node letter.1.node
done

[ -x "$bin/ptriangle" ] || return 0

# --- estimate and report
fresh letter.poly
program 0 -p letter --size 0.05 --report report.json
made=$(triangles letter.1)
check "the report contains it" grep -q '"sizes": {' report.json
check "the report contains it" grep -q '"length": 0.05' report.json
program 0 -p letter --size 0.05 --dry-run
told=$(awk '/^  Triangles:/ { gsub(/[^0-9.]/, "", $2); print $2 * ($3 == "thousand" ? 1e3 : 1) }' .out)
echo "$told $made" | awk '{ exit !($1 > 0.7 * $2 && $1 < 1.4 * $2) }' || fault "$told triangles are estimated, $made made"

grep -q '"placement": "lattice"' report.json || grep -q '"placement": "front"' report.json || fault "which placement?"
program 0 -p letter --size-near 1:0.05 --report report.json
check "the report contains it" grep -q '"placement": "front"' report.json
check "the report contains it" grep -q '"marker": 1' report.json
front=$(triangles letter.1)
program 0 -p letter --size-near 1:0.05 --report report.json --placement classic
check "the report contains it" grep -q '"placement": "classic"' report.json
[ "$(triangles letter.1)" -ne "$front" ] || fault "classic makes the mesh of the front"

# --- threads make no difference, and neither do swept blocks
fields
for words in "--size 0.1" "--size raster.asc --size-near 1:0.05,0.3 --max-size 0.4"; do
    # shellcheck disable=SC2086 # several words
    PTRIANGLE_TEST_BLOCK=60 program 0 -pQ letter $words --threads 1 --output one.node
    # shellcheck disable=SC2086
    PTRIANGLE_TEST_BLOCK=60 program 0 -pQ letter $words --threads 3 --output three.node
    for suffix in node ele poly; do
        same one.$suffix three.$suffix
    done
done

# smoothing needs the whole mesh, even if it does not fit in memory; without smoothing the mesh differs
program 0 -pQ letter --size 0.02 --threads 2 --output one
program 0 -pQ letter --size 0.02 --threads 2 --optimise 0 --output rough
case "${LD_PRELOAD:-}$(ldd "$bin/ptriangle")" in
*libasan* | *libtsan* | *libubsan*) ;; # have memory of their own
*)
    program 0 -pQ letter --size 0.02 --threads 2 --memory 48M --output less
    for suffix in node ele poly; do
        same one.$suffix less.$suffix
    done ;;
esac
cmp -s one.node rough.node && fault "--optimise 0 moves vertices"
program 1 -pQ letter --size 0.02 -D --optimise 1
complains 'optimise moves vertices'

# --- a run resumes only with the same field
limit=0.02
rm -rf state
until [ -e state/state-0 ] || [ -e big.node ]; do
    rm -rf state
    limit=$(echo "$limit" | awk '{ print $1 * 1.3 }')
    PTRIANGLE_TEST_BLOCK=60 "$bin/ptriangle" -Qp letter --size raster.asc --max-size 0.04 --output big --checkpoint state \
        --every 0 --time-limit "$limit" >.out 2>.err
    in_time $? || break
done
if [ -e state/state-0 ]; then
    sed 's/^1\.25 /1.5 /' raster.asc >other.asc
    for words in "--size other.asc --max-size 0.04" "--size raster.asc --max-size 0.05" "--size raster.asc" \
        "--size raster.asc --max-size 0.04 --gradation 0.01" "--size raster.asc --max-size 0.04 --min-size 0.039" "-a1"; do
        # shellcheck disable=SC2086 # several words
        PTRIANGLE_TEST_BLOCK=60 program 1 -Qp letter $words --output big --resume state
        complains '^state: is the checkpoint of another run'
    done
    PTRIANGLE_TEST_BLOCK=60 program 0 -Qp letter --size raster.asc --max-size 0.04 --output big --resume state
    PTRIANGLE_TEST_BLOCK=60 program 0 -Qp letter --size raster.asc --max-size 0.04 --output whole
    for suffix in node ele poly; do
        same big.$suffix whole.$suffix
    done
fi
