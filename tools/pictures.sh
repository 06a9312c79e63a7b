#!/bin/sh
# Makes the pictures of the README, docs/pictures/*.png, anew from data/. Smaller files where pngquant and optipng are
# installed. Usage: tools/pictures.sh
set -eu
cd "$(dirname "$0")/.."
programs=$(cd "${PTRIANGLE_BUILD:-build}/release/bin" && pwd) # tools/build.sh release
pictures=docs/pictures
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$pictures"

plot() { # plot NAME BASE OPTION...
    name=$1
    base=$2
    shift 2
    "$programs/meshplot" "$scratch/$base.1" -o "$scratch/$name.png" "$@"
    if command -v pngquant >/dev/null; then
        pngquant --force --nofs --speed 1 --output "$scratch/$name.png" 128 "$scratch/$name.png"
    fi
    if command -v optipng >/dev/null; then
        optipng -quiet -o5 "$scratch/$name.png"
    fi
    cp "$scratch/$name.png" "$pictures/"
}

cp data/coast/norway_sea.poly data/section.poly "$scratch/"
"$programs/triangle" -pq30Q "$scratch/norway_sea.poly"
"$programs/triangle" -pq30aAQ "$scratch/section.poly"

frame=20000,290000,125000,380000 # metres
plot norway norway_sea --legend off --size 680 --mark $frame
plot norway_zoom norway_sea --size 1000 --window $frame
plot section section --color region --size 1100
ls -l "$pictures"
