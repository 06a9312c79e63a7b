# Counts that any correct program finds (vertices triangles edges exterior interior subsegments), on classic inputs that
# are not part of this tree. Registered only if these inputs exist.
reference() { # reference INPUT SWITCHES COUNTS...
    input=$1
    switches=$2
    shift 2
    rm -f ./*
    cp "$shared/$input" .
    run 0 "$switches" "$input"
    counts "$@"
    convex=""
    holes=""
    case $switches in *c*) convex=--keep-hull ;; esac
    case $switches in -z) convex=--convex ;; *O*) convex=--convex holes=--keep-holes ;; esac
    # shellcheck disable=SC2086 # one word or none
    judge "${input%.*}.1" --poly "$input" $convex $holes
}

reference classic_A.poly -p 29 29 58 29 0 29
reference classic_A.poly -pc 29 47 76 11 21 32
reference classic_face.poly -p 26 36 64 20 2 22
reference classic_face.poly -pc 26 38 66 18 6 24
reference classic_la.poly -p 141 265 405 15 133 148
reference classic_box.poly -pc 8 8 16 8 0 8
reference classic_box.poly -pcO 8 10
reference classic_spiral.node -z 15 15 29 13
reference classic_dots.node -z 100 187 286 11
reference classic_greenland.node -z 33343 66647 99989 37
reference classic_square_circle_hole.poly -p 826 1517 2343 135
reference classic_double_hex.poly -p 96 98 . 96 0
