#!/bin/sh
# Makes the seed corpora of the fuzz targets: the small files of data/, preceded by the two bytes that select how to
# read them, and a few seeds for the other targets. Usage: seeds.sh DATA_DIR CORPUS_DIR
set -eu
data=$1
corpus=$2
mkdir -p "$corpus/read" "$corpus/sizes" "$corpus/triangulate" "$corpus/mesh" "$corpus/schedule"

seed() { # seed BYTES FILE...: makes one seed of these bytes and the files
    name=$(basename "$2" | tr . _)_$(printf '%s' "$1" | tr -dc 0-9)
    { printf "$1" && shift && cat "$@"; } >"$corpus/read/$name"
}
for file in "$data"/*.poly "$data"/nasty/*.poly "$data"/regress/*.poly; do
    [ "$(wc -c <"$file")" -gt 4000 ] || { seed '\001\020' "$file" && seed '\021\003' "$file"; }
done
for file in "$data"/nasty/*.node; do
    [ "$(wc -c <"$file")" -gt 4000 ] || seed '\000\007' "$file"
done
printf '\003\0102 3 0\n1 1 2 3\n2 3 2 4\n' >"$corpus/read/ele"
printf '\003\0011 6 1\n1 1 2 3 4 5 6 0.5\n' >"$corpus/read/ele6"
printf '\004\0102 3 0\n1 1 2 3\n2 3 2 4\n\0002\n1 0.5\n2 -1\n' >"$corpus/read/area"
printf '\002\0100 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n\0003 2 0 0\n1 0 0\n2 1 0\n3 0 1\n' >"$corpus/read/poly_node"

# A square with a diagonal and a crossing; points with one decimal in rows; the same for triangulate() with all its
# outputs.
for target in mesh schedule; do
    printf '\000\003\006\001\001\000\000\007\000\007\007\000\007\003\001\005\006\001\003\001\002\002\003\003\004\000\001\002\003\004\004\005\005\030\024\020' \
        >"$corpus/$target/square"
    head -c 200 /dev/zero | tr '\0' '\052' >"$corpus/$target/even"
done
printf '\006\000\004\016\017\020\027\100\001\000\010\000\004\001\001\000\000\000\000\000\007\000\007\007\000\007\003\001\005\006' \
    >"$corpus/triangulate/square"

# A field of lengths in each format.
printf '\000ncols 3\nnrows 2\nxllcenter 0\nyllcorner -1\ncellsize 2\ndx 1\nnodata_value 9\n1 2 3\n.75 9 2.75\n' >"$corpus/sizes/asc"
{ printf '\001\223NUMPY\001\000\077\000' && printf '%-62s\n' "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }" &&
    printf '\000\000\200\077%.0s' 1 2 3 4 5 6; } >"$corpus/sizes/npy"
{ printf '\001\223NUMPY\001\000\077\000' && printf '%-62s\n' "{'descr': '>i2', 'fortran_order': False, 'shape': (2, 3), }" &&
    printf '\000\002%.0s' 1 2 3 4 5 6; } >"$corpus/sizes/npy_i2"
printf '\002mshid=3;euclidean-mesh\nndims=2\npoint=3\n0;-1;0\n2;-1;0\n4;0;0\nvalue=3;1\n.75\n1.75\n2.75\ntria3=1\n0;1;2;0\n' \
    >"$corpus/sizes/jigsaw"
printf '\002mshid=3;euclidean-grid\ncoord=1;3\n0\n1\n4\ncoord=2;2\n-1\n0\nvalue=6;1\n1\n2\n3\n4\n5\n6\n' >"$corpus/sizes/grid"
printf '\002$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n11 0 -1 0\n12 2 -1 0\n13 4 0 0\n$EndNodes\n$Elements\n2\n1 15 2 0 1 11\n3 2 2 0 1 11 12 13\n$EndElements\n$NodeData\n1\n"h"\n1\n0.0\n3\n0\n1\n3\n11 .75\n12 1.75\n13 2\n$EndNodeData\n' \
    >"$corpus/sizes/gmsh2"
printf '\002$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 3 1 3\n1 1 0 1\n1\n0 -1 0\n2 1 0 2\n2\n3\n2 -1 0\n4 0 0\n$EndNodes\n$Elements\n2 2 1 2\n1 1 1 1\n1 1 2\n2 1 2 1\n2 1 2 3\n$EndElements\n$NodeData\n1\n"h"\n0\n3\n0\n1\n3\n1 .75\n2 1.75\n3 2\n$EndNodeData\n' \
    >"$corpus/sizes/gmsh4"
printf '\003View "h" {\nST(0,-1,0, 2,-1,0, 2,0,0){.75,1.75,2};\nSP(2,0,0){1};\n};\n' >"$corpus/sizes/pos"
