#!/usr/bin/env bash
# docs/images/screen_space.png: three scenes by the screen-space methods, the exact pass before them.
#
#   screen_pictures.sh BUILD MODELS OUT.png
#
# BUILD holds bin/surfelao; MODELS stanford_bunny.obj and FlightHelmet/FlightHelmet.gltf
# (docs/measurements.md names where they come from). Needs ImageMagick.
set -euo pipefail
build=$1 models=$2 out=$3
here=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

tiles=()
row() { # name, mesh, options
    local name=$1 mesh=$2
    shift 2
    for engine in masks ssao-disc ssao-sphere vo hbao gtao bitmask; do
        "$build/bin/surfelao" render "$mesh" --at pixels --engine "$engine" --width 300 --height 260 \
            --samples 1 "$@" -o "$work/$name-$engine.png" > /dev/null
        tiles+=("$work/$name-$engine.png")
    done
}
row bunny "$models/stanford_bunny.obj" --max-distance 10% --camera azimuth=20,elevation=12,distance=0.8
row room "$here/data/room.obj" --up z --max-distance 15% \
    --camera eye=7.3:0.7:1.9,target=3.4:4.2:0.9,fov=70
row helmet "$models/FlightHelmet/FlightHelmet.gltf" --max-distance 10% \
    --camera azimuth=25,elevation=10,distance=0.6
montage "${tiles[@]}" -tile 7x3 -background "#7b8694" -geometry 220x191+2+2 miff:- |
    convert - -dither None -colors 32 -depth 8 -type Palette "$out"
