# Switches that programs pass to Triangle, and problems that its users reported: crashes, endless loops, locales,
# numbers. docs/compatibility.md lists the report behind each part.

contents() { # contents BASE: all records of the output of BASE, without the closing comments
    for output in "$1".1.*; do
        echo "== $output"
        grep -v '^#' "$output"
    done
}

same() { # same FILE SWITCHES OTHER: both spellings of the switches give the same files
    rm -f "${1%.*}".1.*
    # shellcheck disable=SC2086 # several words
    run 0 $2 "$1"
    contents "${1%.*}" >.expected
    rm -f "${1%.*}".1.*
    # shellcheck disable=SC2086
    run 0 $3 "$1"
    contents "${1%.*}" >.found
    check "not as $2" cmp .expected .found
}

ends() { # ends SECONDS WORDS...: expects exit code 0 in time
    seconds=$1
    shift
    what="triangle $*"
    checks=$((checks + 1))
    timeout "$seconds" "$bin/triangle" "$@" >.out 2>.err
    found=$?
    [ "$found" -eq 0 ] || fault "exit code $found: $(head -n 1 .err)"
}

# --- bundles: ignored characters inside, numbers without exponents and signs, the last number wins
fresh letter.poly section.poly
same letter.poly -pq30Q "-Qz{pq30}"
same letter.poly "-p -c -e -v -Q" "-Qpc-e-v"
same section.poly "-p -z -e -A -a -q33 -Y" "-YpzeAfaq33"
same letter.poly "-p" "-z -i -p"
same section.poly "-pAa -a2.5 -q30 -YY" "-pA -a -a2.5 -q30 -YY"
same letter.poly "-p -q32.5 -a0.2 -A -Y -S100 -e -z -Q" "-pq32.5a0.2AYS100ezQ"
same letter.poly "-pq32.5a0.2AYS100eQ" "-Y -eQpS100 -a0.2 -Aq32.5"
same letter.poly -pqa0.1 -pqa.1.2
same letter.poly -pqa0.1 -pqa.5a.1
same letter.poly -pq20 -pq20.
same letter.poly -pq -pq20
same letter.poly -pq0.5 -pq.5
same letter.poly -pq -pq-5
same letter.poly -pq30e -pq30e1
same letter.poly -pa1e -pa1e-3
same section.poly -pAa -pAa-1
same section.poly -pAaa6.2 -pAa6.2a
same letter.poly -pqS1e -pqS1e3
same letter.poly -pqS0 -pqS-3
same letter.poly -pqS0 -pqS
same letter.poly -p -pq0S0
same letter.poly -pq -pqRUk%w
same letter.poly -po2 -po22
same letter.poly -p -poo3o
for word in -pa0 -pqa. -pa0.0; do
    run 1 $word letter.poly
    complains "area"
    matches "^Error:  "
done
same letter.poly -pqa0.05 -pqa0.05000000000000000000 # as MeshPy (%.20f) and ANUGA (%20.20f) write it
fresh letter.poly
run 0 -pqa0.00000000000000000001S10 letter # 1e-20: far below any possible area
judge letter.1 --poly letter.poly
run 0 -pq180S50 letter # an impossible angle
judge letter.1 --poly letter.poly

# --- numbers and the locale: a locale with decimal commas changes nothing. It is generated if the system has none.
locale_of() {
    for name in de_DE.UTF-8 de_DE.utf8 fr_FR.UTF-8; do
        LC_ALL=$name locale decimal_point 2>/dev/null | grep -q "^,$" && echo "$name" && return
    done
    full && localedef -i de_DE -f UTF-8 "$PWD/.locales/de_DE.UTF-8" >/dev/null 2>&1 && echo de_DE.UTF-8
}
fresh letter.poly
mkdir .locales
comma=$(locale_of)
if [ -n "$comma" ]; then
    [ -d .locales/de_DE.UTF-8 ] && LOCPATH=$PWD/.locales && export LOCPATH
    run 0 -pq20.5a0.1V letter
    contents letter >.expected
    grep -E "area:|angle:|-  +[0-9]" .out >.numbers
    rm -f letter.1.*
    LC_ALL=$comma
    run 0 -pq20.5a0.1V letter
    LC_ALL=C
    contents letter >.found
    what="LC_ALL=$comma"
    check "the mesh depends on the locale" cmp .expected .found
    check "printed numbers depend on the locale" sh -c 'grep -E "area:|angle:|-  +[0-9]" .out | cmp -s - .numbers'
    # The libraries, inside a process that has set the locale: these tests search for such locales themselves. Skipped
    # if an emulator runs the programs through scripts (tools/ports.sh), since the locales have this machine's byte
    # order.
    for program in switches decimal triangulate; do
        test="$bin/../tests/test_$program"
        [ ! -x "$test" ] || [ "$(head -c 2 "$bin/triangle")" = '#!' ] ||
            check "test_$program" sh -c '"$1" >.tests 2>&1 && ! grep -q "SKIPPED.*locale" .tests' sh "$test"
    done
    unset LOCPATH
fi
rm -rf .locales .numbers .tests

# --- programs that run triangle
# FEMM: no iteration number, only .node, .ele, .edge; counts from 0
fresh section.poly
sed 's/\r//' section.poly >femm.poly
cp femm.poly kept.poly
ls >.before
for more in "" -Y; do
    # shellcheck disable=SC2086
    run 0 -p -P -j -q30 -e -A -a -z -Q -I $more femm.poly
    wrote femm.node femm.ele femm.edge
    check "nothing is printed" test ! -s .out -a ! -s .err
    check "the input is unchanged" cmp femm.poly kept.poly
    rm -f femm.node femm.ele femm.edge
done
# base 0 as FEMM writes it: all numbers in the files count from 0
fresh base0.poly
run 0 -p -P -j -q30 -e -A -a.01 -z -Q -I base0.poly
for output in node ele edge; do
    check "$output counts from 0" test "$(records base0.$output | sed -n 2p | cut -d' ' -f1)" = 0
done
check "vertices exist" awk '
    /^#/ || FNR == 1 { if (FNR == 1 && FILENAME ~ /node/) n = $1; next }
    FILENAME ~ /ele/ { for (k = 2; k <= 4; k++) if ($k < 0 || $k >= n) exit 1 }
    FILENAME ~ /edge/ { if ($2 < 0 || $2 >= n || $3 < 0 || $3 >= n) exit 1 }' base0.node base0.ele base0.edge

# FloPy: numbered files with separate vertices; all tables readable by columns; integer attributes
fresh section.poly
n=$(records section.poly | sed -n 1p | cut -d' ' -f1)
records section.poly | head -n $((n + 1)) | awk 'NR > 1 { $1 = $1 - 1 } { print }' >base.0.node
{
    records section.poly | sed -n 1p | sed 's/^[0-9]*/0/'
    records section.poly | tail -n +$((n + 2)) | awk '
        left == 0 { left = $1; section++; print; next }
        { left--; $1 = $1 - 1; if (section == 1) { $2 = $2 - 1; $3 = $3 - 1 } print }'
} >base.0.poly
ls >.before
run 0 -a -q30 -A -p -V -D -e -n base.0
wrote base.1.node base.1.ele base.1.poly base.1.edge base.1.neigh
check "attributes are integers" test "$(records base.1.ele | awk 'NR > 1 && $5 !~ /^-?[0-9]+$/' | wc -l)" -eq 0
check "all rows of a table have the same number of columns" awk '/^#/ || FNR == 1 { next }
    !(FILENAME in n) { n[FILENAME] = NF } NF != n[FILENAME] { exit 1 }' base.1.node base.1.ele base.1.edge base.1.neigh
judge base.1 --min-angle 30

# gptoolbox and scripts
fresh letter.poly
same letter.poly "-p -q20 -a0.02" "-pq20-a0.02"
run 0 -peq30a0.02 letter
wrote letter.1.node letter.1.ele letter.1.poly letter.1.edge
check "grep 'Mesh vertices'" test "$(grep "Mesh vertices" .out | awk '{ print $3 }')" \
    = "$(records letter.1.node | sed -n 1p | cut -d' ' -f1)"

# --- reports: crashes and endless loops. The expected meshes of data/regress are in data/expected.txt; here they get
# bounds.
fresh regress/hole_outside.poly regress/near_collinear_repeat.poly regress/touching_squares.poly \
    regress/pentagon_repeat.poly regress/outline_repeat.poly regress/arrow.poly regress/ulp_apart.poly \
    regress/near_cocircular.poly
for input in *.poly; do
    for words in -p -pc -pq -pq30 -pcq33D -pqa10YY -pi -pF; do
        every 4 || continue
        case $input$words in near_coll*q* | *_apart*q*) words=${words}S1000 ;; esac
        ends 20 $words "$input"
        case $words in *S1000) more="" ;; *c*) more="--poly $input --keep-hull" ;; *) more="--poly $input" ;; esac
        # shellcheck disable=SC2086
        [ "$(records "${input%.*}.1.ele" | sed -n 1p | cut -d' ' -f1)" = 0 ] || judge "${input%.*}.1" $more
    done
done
run 0 -p hole_outside
counts 13 11 23 13 0 13
run 0 -pe touching_squares
counts 7 4 10 8 0 8
run 0 -pe pentagon_repeat
counts 4 2 5 4 0 4
ends 20 -pq arrow
judge arrow.1 --poly arrow.poly --min-angle 20

# --- bounds that earlier versions violated: sizes beside slivers, circles of adjacent subsegments
fresh regress/ulps_apart.poly regress/needles.poly
for words in -pa0.0002 -pq30a0.0002 -pq30a0.0002Y -pq30a0.0002YY; do
    every 2 || continue
    ends 20 $words ulps_apart
    judge ulps_apart.1 --poly ulps_apart.poly --max-area 0.0002
done
for words in -pD -pq20D -pq30Da0.01; do
    ends 20 $words needles
    judge needles.1 --poly needles.poly --conforming
done

fresh nasty/duplicates.poly nasty/crossing_random.poly nasty/huge_offset.poly nasty/overlap.poly nasty/spike.poly \
    nasty/slit_1e-9.poly nasty/tiny_feature.poly nasty/bowtie.poly
for input in *.poly; do
    ends 60 -pq30 "$input"
    judge "${input%.*}.1" --poly "$input"
done

# --- holes and regions beyond the range of exact arithmetic are outside
fresh regress/far_hole.poly regress/far_places.poly regress/far_places_tiny.poly regress/far_region.poly
for input in *.poly; do
    run 0 -pA "$input"
    judge "${input%.*}.1" --poly "$input"
    check "no triangle has a region" test "$(records "${input%.*}.1.ele" | awk 'NR > 1 && $5 + 0 != 0' | wc -l)" -eq 0
    ends 20 -pAq30 "$input"
    judge "${input%.*}.1" --poly "$input" --min-angle 30
done

# --- many features within rounding: segments and vertices are kept, markers are right, boundaries do not intersect
everywhere() { # everywhere NAME SWITCHES...: runs each program with each of the switches and checks the mesh
    name=$1
    shift
    for words; do
        for program in triangle ptriangle; do
            [ -x "$bin/$program" ] && every 3 || continue
            fresh "regress/$name.poly"
            what="$program $words $name"
            check "exit code" timeout 20 "$bin/$program" "$words" "$name"
            case $words in *c*) more=--keep-hull ;; *) more= ;; esac
            # shellcheck disable=SC2086 # one word or none
            judge "$name.1" --poly "$name.poly" $more
        done
    done
}
everywhere lost_segment -pc
everywhere lost_overlay -pc -pq20
everywhere lost_ladder -pc -pq20
everywhere lost_overlay_vertex -pq20
everywhere lost_vertex -pq34D
everywhere overlap_rings -pq20
everywhere overlap_water -pq20
everywhere overlap_ulp -pa0.0915136812
everywhere overlap_spikes -pq31
everywhere same_place -pq32D
everywhere marker_bend -pc
everywhere marker_precincts -pc
everywhere hole_on_segment -pcq24a0.26
everywhere hole_at_vertex -p
fresh regress/hole_at_vertex.poly
run 0 -p hole_at_vertex
counts 5 3 7 5 0 5
matches "hole points on segments, which empty nothing: 1"
everywhere hole_in_chain -p -pc
fresh regress/hole_in_chain.poly
run 0 -p hole_in_chain
counts 16 18 33 12 6 18
matches "hole points on segments, which empty nothing: 1"
everywhere slit -p -pq20
fresh regress/slit.poly
run 0 -p slit
counts 4 2 5 4 0 4

# --- impossible angles: the run ends and reports it
fresh letter.poly
for angle in 35 36 40 45 59 60 61 90; do
    every 4 || continue
    ends 60 -pq$angle letter
    judge letter.1 --poly letter.poly
done

# --- angles at which points would accumulate endlessly: valid meshes, in time. (test_refine tries all inputs.)
fresh regress/endless_q36_small.poly regress/endless_q36_fan.poly regress/endless_q35_graded.poly \
    regress/slow_q41D_2369.poly regress/ranaway30.poly regress/thin_comb.poly \
    regress/ranaway_fan.poly regress/ranaway_zigzag.poly regress/hidden_gap.poly \
    regress/hatching.poly regress/cut_wedge.poly regress/nearly_straight.poly regress/bundle_levels.poly \
    regress/graded_1899.poly regress/spike_levels.poly
right() { # right WORDS...: expects a valid mesh
    every 3 || return 0
    ends 60 "$@"
    case $1 in *c*) judge "$2.1" --poly "$2.poly" --keep-hull ;; *) judge "$2.1" --poly "$2.poly" ;; esac
}
right -pq34.5 endless_q36_small
right -pq36 endless_q36_small
right -pq34 endless_q36_fan
right -pq36 endless_q36_fan
right -pq34 endless_q35_graded
right -pq38 endless_q35_graded
right -pq38AD slow_q41D_2369
right -pq30 ranaway30
right -pcq33 ranaway_fan
right -pq1S10000 hidden_gap
right -pq30S10000 hidden_gap
right -pcq30S50000 hatching
right -pq30S50000 cut_wedge
right -pcq30S50000 nearly_straight
right -pcq34 ranaway_fan
right -pcq34 ranaway_zigzag
right -pq33 thin_comb # each bar is a narrow space that no edge of the triangulation bridges
right -pD bundle_levels # circles in a bundle of segments whose ends differ in height
right -pa0.00065D bundle_levels
right -pq25D spike_levels # circles that rounding keeps from being empty
run 0 -pq34 graded_1899
run 0 -rpq34 graded_1899.1
judge graded_1899.2 --poly graded_1899.poly
fresh regress/flat_hole.poly # the sliver is empty and has no small features beside it
run 0 -pq33 flat_hole
says "All triangles keep the bounds."
judge flat_hole.1 --poly flat_hole.poly --min-angle 33
fresh regress/drifted_chain.poly # repeated split points an ulp inside, where coordinates get finer
run 0 -pq33 drifted_chain
judge drifted_chain.1 --poly drifted_chain.poly --min-angle 33
fresh regress/flat_hull.poly # the hull lies outside its segments, by an ulp
for switches in -pcq20 -pcq30a0.05 -pcq20F; do
    rm -f flat_hull.1.*
    run 0 $switches flat_hull
    judge flat_hull.1 --poly flat_hull.poly --keep-hull
done
fresh regress/near_wall.poly # a corner 115 resolutions from a wall
run 0 -pq20D near_wall
matches "^All triangles keep the bounds"
judge near_wall.1 --poly near_wall.poly --min-angle 20 --conforming
fresh regress/subnormal.poly # the crossing would be rounded to a corner
run 1 -p subnormal
complains "numbers lose their precision"

fresh regress/below_dxf.poly # two triangles that need not stay below the bound
run 0 -pq20 below_dxf
says 'All triangles keep the bounds.'

# --- empty and degenerate input
fresh nasty/identical.node nasty/nan.node nasty/inf.node nasty/inf_word.node nasty/two_points.node nasty/empty.node \
    nasty/collinear.node nasty/collinear.poly
printf '0 2 0 0\n' >none.node
ls >.before
for input in identical nan inf inf_word two_points empty none; do
    for words in "" -q -i -F -c; do
        every 2 || continue
        # shellcheck disable=SC2086
        run 1 $words $input.node
        complains "$input\.node|same place"
    done
done
wrote
for words in "" -q -c -i -env -o2 -j; do
    # shellcheck disable=SC2086
    run 0 $words collinear.node
    counts . 0 0 0
    run 0 -p$words collinear.poly
    counts . 0 0 0
done

# --- the inputs of the reports themselves, if they are available
if [ -n "$shared" ]; then
    for input in "$shared"/bug_*.poly; do
        every 4 || continue
        rm -f ./*
        cp "$input" report.poly
        ends 60 -pq30 report.poly
        [ "$(records report.1.ele | sed -n 1p | cut -d' ' -f1)" = 0 ] || judge report.1 --poly report.poly
    done
fi
