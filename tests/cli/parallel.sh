# ptriangle: tiny cells, long options, the report.
without_comments() { grep -v '^#' "$1"; }

alike() { # alike A B: two files are equal except for the comment that quotes the command line
    without_comments "$1" >.expected
    without_comments "$2" | cmp -s - .expected
}

# --- tiny cells, for tests: many blocks in a small mesh
fresh letter.poly
PTRIANGLE_TEST_BLOCK=60 program 0 -pq30a0.1Q --report report.json letter
check "many blocks" test "$(grep -c '"block":' report.json)" -gt 4
judge letter.1 --poly letter.poly --min-angle 30 --max-area 0.1
fresh regress/graded_1899.poly # a triangle deferred by a block is listed once; otherwise work doubles in every phase
PTRIANGLE_TEST_BLOCK=60 program 0 -pcOq25DQ --report report.json graded_1899
check "the worklist does not double" awk '/"worklist":/ { gsub(/,/, ""); for (i = 1; i < NF; i++) if ($i == "\"worklist\":") n += $(i + 1) }
    END { exit !(n > 0 && n < 50000) }' report.json
fresh regress/tangle.poly # triangles that one stage makes bad are in the list of the next
PTRIANGLE_TEST_BLOCK=250 program 0 -pcq34a1.79824924 --report report.json tangle
check "all bad triangles have been treated" grep -q 'below the bounds: [0-9]* at small angles of the input\.$' .out
below=$(sed -n 's/^\([0-9]*\) triangles stay below the bounds.*/\1/p' .out)
check "the report lists them" test "$(grep -A1 below_bounds report.json | grep -c "\"input_angle\": $below,$")" = 1

# --- long options
fresh letter.poly
program 0 --version
matches '^ptriangle [0-9]+\.[0-9]+\.[0-9]+$'
program 0 --help
matches '^  --threads N '
matches '^usage: ptriangle '
wrote
program 0 -pq30a0.5Q --threads 2 letter
cp letter.1.ele one.ele
program 0 --threads=3 --min-angle=3e1 --max-area 5e-1 -pQ letter.poly
check "the same bounds" alike one.ele letter.1.ele
program 0 -pQ --output other --no-progress letter
check "other names" test -f other.node -a -f other.ele -a -f other.poly
program 0 -pQI --output third letter
check "other names, whatever -I says" test -f third.poly
fresh letter.poly # a ring in a ring, which no hole point empties
cat >rings.poly <<'END'
12 2 0 0
1 0 0
2 8 0
3 8 8
4 0 8
5 1 1
6 5 1
7 5 5
8 1 5
9 2 2
10 3 2
11 3 3
12 2 3
12 1
1 1 2 1
2 2 3 1
3 3 4 1
4 4 1 1
5 5 6 2
6 6 7 2
7 7 8 2
8 8 5 2
9 9 10 3
10 10 11 3
11 11 12 3
12 12 9 3
0
END
program 0 --holes auto -pq30a0.5 rings
judge rings.1 --poly rings.poly --any-holes --min-angle 30 --max-area 0.5
cp "$data/regress/carved_fan.poly" . # markers of the pieces that remain of segments within rounding of each other
program 0 --holes auto -pQ carved_fan
judge carved_fan.1 --poly carved_fan.poly --any-holes
check "odd rings are kept" sh -c '"$0/trianglecheck" rings.1 | grep -q "total 49\$"' "$bin"
cp rings.1.ele auto.ele
program 0 --holes points -pq30a0.5Q rings
check "with --holes points all rings are kept" sh -c 'test "$(sed -n 1s/\ .*//p rings.1.ele)" -gt "$(sed -n 1s/\ .*//p auto.ele)"'
fresh letter.poly
program 1 --no-such-thing letter
complains '^ptriangle: there is no option --no-such-thing'
matches '^Error:  '
check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
program 1 letter --threads
complains 'threads needs a value'
for number in 0 -1 1.5 1e3 many 100000 ''; do
    program 1 letter --threads "$number"
    complains 'threads: .*whole number'
done
for number in 0 -1 nan inf 1e999 x 1x ''; do
    program 1 letter "--max-area=$number"
    complains 'max-area: .*number > 0'
done
for number in 61 -1 nan x; do
    program 1 letter --min-angle "$number"
    complains 'min-angle: .*from 0 to 60'
done
for words in "--placement hexagons" --placement=; do
    # shellcheck disable=SC2086 # one word or two
    program 1 -pq30 letter $words
    complains '^ptriangle: --placement: "[a-z]*" is neither front, lattice nor classic$'
    check "one line" sh -c 'test "$(wc -l <.err)" -eq 1'
done
program 1 --output= letter
complains 'output: the name is empty'
for base in / ./ . .. ./.. .h5; do
    program 1 letter --output "$base"
    complains 'output: .* does not end in a name that'
done
program 1 --progress=yes letter
complains 'progress takes no value'
program 1 -- letter
complains 'no option'
program 1 -p --output letter letter.poly
complains 'letter\.poly: would be overwritten'
program 1 -p --report nowhere/report.json letter
complains '^nowhere/report\.json: cannot create'
program 1 -p --blocks nowhere/blocks letter
complains '^nowhere/blocks: cannot create'
wrote
program 1 -p nothing --report report.json
complains '^nothing\.poly: cannot open'
wrote

if [ -e /dev/full ]; then
    what="ptriangle to a full standard output"
    "$bin/ptriangle" -p letter >/dev/full 2>.err
    check "exit code" test $? -eq 1
    check "one line" test "$(wc -l <.err)" -eq 1
    wrote
    program 1 -pQ --report /dev/full letter
    complains '^/dev/full: cannot write'
    wrote
fi
# files that are not input may be replaced
cp "$data/letter.poly" letter.node
program 0 -pPQ --output letter letter.poly
header letter.node "57 2 1 1"
fresh letter.poly

# --- report
program 0 -pQ --report - letter
wrote letter.1.node letter.1.ele letter.1.poly
check "the report on standard output" sh -c 'head -n 1 .out | grep -qx "{" && tail -n 1 .out | grep -qx "}"'
fresh letter.poly
program 0 -pq30a0.001Q --threads 2 --report report.json letter
wrote letter.1.node letter.1.ele letter.1.poly report.json
for key in threads peak_memory_bytes read delaunay segments holes quality write total prerefine partition find worklist room refine \
    merge number last phases shared overhead_percent numbering_percent free on_segments deferred left_over rounds pauses radius_lemma7 radius_theory \
    radius_measured round phase block smallest_angle mean_area_over_bound; do
    check "no $key in the report" grep -q "\"$key\":" report.json
done
if command -v python3 >/dev/null; then
    check "valid JSON" python3 -m json.tool report.json
    check "blocks and counts agree" python3 -c '
import json
report = json.load(open("report.json"))
schedule = report["schedule"]
blocks = schedule["blocks"]
counted = sum(block["inserted"] for block in blocks)
inserted = schedule["inserted"]["free"] + schedule["inserted"]["on_segments"]
assert 0.9 * inserted < counted <= inserted
assert report["mesh"]["vertices"] == 57 + inserted
assert report["mesh"]["smallest_angle"] >= 30 and report["mesh"]["mean_area_over_bound"] < 1
assert report["bounds"] == {"min_angle": 30, "max_area": 0.001}
assert report["placement"] == "lattice" and report["mesh"]["mean_area_over_bound"] > 0.8
'
fi

# --- placement: as in triangle, see switches.sh; here also with many blocks
for words in "-pq30a0.01" "-pq30a0.01 --placement lattice"; do
    # shellcheck disable=SC2086
    PTRIANGLE_TEST_BLOCK=60 program 0 $words letter --report report.json
    judge letter.1 --poly letter.poly --min-angle 30 --max-area 0.01
    check "a third fewer triangles" sh -c 'n=$(head -n 1 letter.1.ele | cut -d " " -f 1); [ $n -gt 7000 ] && [ $n -lt 8500 ]'
    check "the report contains it" grep -q '"placement": "lattice"' report.json
done
PTRIANGLE_TEST_BLOCK=60 program 0 -pq30a0.01 letter --placement=classic --report report.json
counts 5755 10968
check "the report contains it" grep -q '"placement": "classic"' report.json
program 0 -pq20a0.1 letter --placement=classic
counts 611 1074
for words in -pq33a0.01 -pq30; do # no lattice: high angle bounds, or no bound on areas
    PTRIANGLE_TEST_BLOCK=60 program 0 $words letter --report report.json
    check "the report contains it" grep -q '"placement": "classic"' report.json
    cp letter.1.ele one.ele
    PTRIANGLE_TEST_BLOCK=60 program 0 $words letter --placement classic
    check "one mesh" alike one.ele letter.1.ele
done
fresh letter.poly
program 0 -pQ --report report.json letter
check "nothing was refined" grep -qx ' "schedule": null' report.json

# --- options for which the schedule uses the sequential program, and the printed messages
program 0 -pq30a0.001S100Q letter
cp letter.1.node one.node
cp letter.1.ele one.ele
what="triangle -pq30a0.001S100Q letter"
"$bin/triangle" -pq30a0.001S100Q letter
check "the nodes of triangle" alike one.node letter.1.node
check "the triangles of triangle" alike one.ele letter.1.ele
program 0 -pq30a0.001 --progress letter
says 'All triangles keep the bounds.'
complains '^ptriangle: refining: round 1, phase 1 of 4, [0-9]+ triangles, [0-9.]+( thousand| million)?/s(, [0-9]+%, [0-9]+ s to go)?, [0-9]+ MB$'
complains '^ptriangle: numbering$'
complains '^ptriangle: refined to [0-9]+ triangles in '
program 0 -pq30a0.01 letter
calm
program 0 -pq30a0.01Q --progress letter
calm
OMP_NUM_THREADS=3 program 0 -pq30a0.01 --progress letter
complains ' on 3 threads'
OMP_NUM_THREADS=3 program 0 -pq30a0.01 --progress --threads 2 letter
complains ' on 2 threads'
(unset OMP_NUM_THREADS && SLURM_CPUS_PER_TASK=3 && export SLURM_CPUS_PER_TASK &&
    "$bin/ptriangle" -pq30a0.01 --progress letter >.out 2>.err)
complains ' on 3 threads'
OMP_NUM_THREADS=2 SLURM_CPUS_PER_TASK=3 program 0 -pq30a0.01 --progress letter
complains ' on 2 threads'
