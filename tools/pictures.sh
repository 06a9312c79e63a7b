#!/bin/sh
# Makes the pictures of the README and the site from data/: docs/pictures/*.png by meshplot, docs/pictures/speed.svg by
# tools/draw_speed.py. PNG files are smaller if pngquant and optipng are installed.
# Usage: tools/pictures.sh     after tools/build.sh release
set -eu
cd "$(dirname "$0")/.."
programs=$(cd "${PTRIANGLE_BUILD:-build}/release/bin" && pwd)
pictures=docs/pictures
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$pictures"

plot() { # plot NAME BASE OPTION...: writes docs/pictures/NAME.png of the mesh BASE.1
    name=$1
    base=$2
    shift 2
    "$programs/meshplot" "$scratch/$base.1" -o "$scratch/$name.png" --legend off "$@"
    if command -v pngquant >/dev/null; then
        pngquant --force --nofs --speed 1 --output "$scratch/$name.png" 64 "$scratch/$name.png"
    fi
    if command -v optipng >/dev/null; then
        optipng -quiet -o5 "$scratch/$name.png"
    fi
    cp "$scratch/$name.png" "$pictures/"
}

mesh() { # mesh INPUT OPTION...: writes $scratch/NAME.1 from data/INPUT, which is NAME.poly in some folder
    cp "data/$1" "$scratch/"
    input=$scratch/$(basename "$1")
    shift
    "$programs/triangle" -Qp "$@" "$input"
}

mesh coast/norway_sea.poly -q30
mesh coast/islands.poly --size-near 1:2000,0.15 --max-size 20000
mesh section.poly -q30aA
mesh naca2412_box.poly --size-near 2:0.004,0.15 --max-size 0.3
mesh koch_lake.poly --size-near 2:0.004,0.15 --max-size 0.1
mesh gear.poly -q30a4

frame=20000,290000,125000,380000 # metres
plot norway norway_sea --size 900 --mark $frame
plot norway_zoom norway_sea --size 560 --window $frame
plot islands islands --size 560 --window -350000,-200000,210000,280000
plot section section --color region --size 560 --window 5,-12,33,12
plot airfoil naca2412_box --size 560 --window -0.15,-0.47,1.1,0.6
plot lake koch_lake --size 560 --window -0.7,-0.6,0.7,0.6
plot gear gear --size 560 --window -32.6,-28,32.6,28
python3 tools/draw_speed.py
ls -l "$pictures"
