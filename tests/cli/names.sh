# File names: suffixes, iterations, reading a mesh again.
fresh letter.poly
run 0 letter.poly
wrote letter.1.node letter.1.ele letter.1.poly
run 0 -pq letter.1
wrote letter.1.node letter.1.ele letter.1.poly letter.2.node letter.2.ele letter.2.poly
judge letter.2 --poly letter.poly --min-angle 20
run 0 -pqa.5 letter.2.poly
judge letter.3 --poly letter.poly --min-angle 20 --max-area .5
check "attribute interpolated: y / 14" \
    awk '!/^#/ && FNR > 1 { d = $4 - $3 / 14; if (d > 1e-6 || d < -1e-6) exit 1 }' letter.3.node
mkdir d.1
cp letter.poly d.1/box
cp letter.poly d.1/box.poly
run 0 -p d.1/box
check "in its folder" test -f d.1/box.1.node
cp letter.poly letter.9.poly
run 0 letter.9.poly
check "9 -> 10" test -f letter.10.node
cp letter.poly letter.01.poly
run 0 -p letter.01
check "01 -> 2" grep -q letter.01 letter.2.node
