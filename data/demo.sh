#!/usr/bin/env bash
# From a real model to a baked file, its error and a picture: demo.sh SURFELAO MODELS OUT
# OUT is a folder of the demo's own.
set -euo pipefail
surfelao=$1
model=$2/bunny.obj
out=$3
mkdir -p "$out"

echo "1. bake: occlusion and bent normals at every vertex"
"$surfelao" bake "$model" -o "$out/bunny.ply"
echo
echo "2. compare: the same model by ray tracing, error at 5000 points of its surface"
"$surfelao" compare "$model" --engines masks --qualities draft,good --sample 5000 --rounds 1 \
    -o "$out" --overwrite
echo
echo "3. render: a picture of the visibility"
"$surfelao" render "$model" -o "$out/bunny.png"
