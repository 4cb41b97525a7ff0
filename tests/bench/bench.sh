#!/usr/bin/env bash
# Speed against error over all scenes at hand, one run, one machine: bench.sh BUILD [SCENE...]
# Generated scenes (six times finer than the committed ones), the Debian packages' models and, where
# present, ../shared/models beside the project; or only the scenes given. Tables go to the terminal,
# report.html, CSV and JSON to out/bench/. What the pages tell is measured by measure.py.
set -euo pipefail
build=$1
shift
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$root/out/bench
mkdir -p "$out"

if [ $# -eq 0 ]; then
    "$root/data/generate.py" "$out/scenes" 6
    set -- "$out"/scenes/* "$root"/data/models/bunny.obj "$root"/data/models/engine.glb
    shared=$root/../shared/models
    for model in "$shared"/*.obj "$shared"/*.ply "$shared"/*.gltf "$shared"/*/*.gltf; do
        [ ! -e "$model" ] || set -- "$@" "$model"
    done
fi
"$build/bin/surfelao" compare --frontier "$@" -o "$out" --overwrite \
    --json "$out/frontier.json" --csv "$out/frontier.csv"
"$build/bin/scaling" masks
"$build/bin/scaling" disks
