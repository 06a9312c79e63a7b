# Regions by polygons (--region-polygons, and .geojson as input), in both programs.

# ring X0 Y0 X1 Y1: a box as a ring
ring() { printf '[[%s,%s],[%s,%s],[%s,%s],[%s,%s],[%s,%s]]' "$1" "$2" "$3" "$2" "$3" "$4" "$1" "$4" "$1" "$2"; }
feature() { # feature PROPERTIES RING...: a polygon
    properties=$1
    shift
    printf '{"type":"Feature","properties":%s,"geometry":{"type":"Polygon","coordinates":[%s' "$properties" "$1"
    shift
    for more; do printf ',%s' "$more"; done
    printf ']}}'
}
features() { # features FEATURE...
    printf '{"type":"FeatureCollection","features":[%s' "$1"
    shift
    for more; do printf ',%s' "$more"; done
    printf ']}\n'
}

# areas BASE: for each attribute its area and the largest triangle, rounded
areas() {
    awk '/^#/ { next } FNR == 1 { file++; next } file == 1 { x[$1] = $2; y[$1] = $3; next }
        { area = ((x[$3] - x[$2]) * (y[$4] - y[$2]) - (x[$4] - x[$2]) * (y[$3] - y[$2])) / 2
                  sum[$5] += area; if (area > most[$5]) most[$5] = area }
        END { for (a in sum) printf "%s:%.4f:%s ", a, sum[a], most[a] <= 0.0101 ? "small" : "large" }' "$1.node" "$1.ele" |
        tr ' ' '\n' | grep . | LC_ALL=C sort | tr '\n' ' '
}
has_areas() { # has_areas BASE TEXT
    checks=$((checks + 1))
    found=$(areas "$1")
    [ "$found" = "$2 " ] || fault "areas $found instead of $2"
}

# A box of 4 by 4 with a hole of 1 by 1. Zones cross its border and the hole, and later ones cover earlier ones.
box() {
    printf '%s\n' "8 2 0 0" "1 0 0" "2 4 0" "3 4 4" "4 0 4" "5 2 1" "6 3 1" "7 3 2" "8 2 2" \
        "8 0" "1 1 2" "2 2 3" "3 3 4" "4 4 1" "5 5 6" "6 6 7" "7 7 8" "8 8 5" "1" "1 2.5 1.5" >box.poly
    features "$(feature '{"attribute":7,"area":0.01}' "$(ring -1 -1 1 5)")" \
        "$(feature null "$(ring 0.5 3 9 3.5)" "$(ring 1.5 3.125 3.5 3.375)")" \
        '{"type":"Feature","properties":{},"geometry":null}' \
        "$(feature '{"attribute":-1.5}' "$(ring 1.5 0.5 2.5 2.5)")" "$(feature '{}' "$(ring 7 7 8 8)")" >zones.geojson
    ls >.before
}

for mesher in triangle ptriangle; do
    fresh
    box
    mesher 0 $mesher -pqA --region-polygons zones.geojson box.poly
    matches '^Regions by the polygons of 5 features: [0-9]+ points more, [0-9]+ segments, [0-9]+ region points\.$'
    wrote box.1.node box.1.ele box.1.poly
    has_areas box.1 "-1.5:1.5000:large 0:8.5000:large 2:1.2500:large 7:3.7500:large"
    mesher 0 $mesher -pqaA --region-polygons=zones.geojson box
    has_areas box.1 "-1.5:1.5000:large 0:8.5000:large 2:1.2500:large 7:3.7500:small"
    judge box.1 --poly box.poly --region-polygons zones.geojson --min-angle 20
    judge box.1 --poly box.poly --min-angle 20

    # --- the regions of the .poly file stay in force outside the zones, although the zones cut it into pieces
    printf '%s\n' 1 "1 3.9 3.9 40 0.01" >>box.poly
    mesher 0 $mesher -pqaA --region-polygons zones.geojson box
    has_areas box.1 "-1.5:1.5000:large 2:1.2500:large 40:8.5000:small 7:3.7500:small"
    judge box.1 --poly box.poly --region-polygons zones.geojson
    "$bin/trianglecheck" box.1 --poly box.poly >.out
    check "the checker knows the regions: exit code" test $? -eq 1
    if [ $mesher = ptriangle ]; then
        mesher 0 $mesher -pqA --holes auto --region-polygons zones.geojson box
        has_areas box.1 "-1.5:1.5000:large 2:1.2500:large 40:8.5000:large 7:3.7500:large"
        judge box.1 --poly box.poly --region-polygons zones.geojson --any-holes
    fi

    # --- a file of polygons as input
    mesher 0 $mesher -qaA zones.geojson
    has_areas zones.1 "-1.5:2.0000:large 2:3.7500:large 5:1.0000:large 7:11.7500:small"
    judge zones.1 --poly zones.geojson --min-angle 20

    # --- errors in one line
    for words in "-rp box.1" "-q box.1.node"; do
        mesher 1 $mesher --region-polygons zones.geojson $words
        complains '^[a-z]*: --region-polygons adds segments: it needs -p, without -r'
    done
    mesher 1 $mesher -p --region-polygons zones.geojson zones.geojson
    complains 'zones.geojson: --region-polygons|the polygons of zones.geojson are the regions'
    mesher 1 $mesher -p --region-polygons missing.geojson box
    complains 'missing.geojson: cannot open'
    printf '{"type":"Point","coordinates":[1,2]}' >point.geojson
    mesher 1 $mesher -p --region-polygons point.geojson box
    complains 'point.geojson: feature 1: Point is no polygon'
    cp zones.geojson box.1.poly
    mesher 1 $mesher -p --region-polygons box.1.poly box
    complains 'box.1.poly'
    check "zones are not overwritten" cmp zones.geojson box.1.poly
done
