#!/usr/bin/env bash
# Everything that docs/gpu.md tells of this machine's GPU, in one go: gpu_table.sh BUILD [MODEL...]
#
# Solving: grids of 81 to 16,641 vertices by brute force and by the tree, bodies of 10^4 to 10^6
# vertices by disks and masks, beside the CPU in the same run, and how much the two differ; the same
# for the models, and the error of their masks on both devices against rays. Drawing: frames per
# second of triangles and splats at 1920 x 1080, up to 10^6 vertices; and the screen-space passes at
# 1280 x 720 (docs/screen_space.md), as JSON, by the device's own clock. Takes the GPU that EGL finds;
# the first line of each part says which, and says so where it is only software: masks of 10^6
# vertices then take most of an hour. LARGEST=N leaves bodies above N vertices out, MASKS=N only
# their masks and those of larger models.
set -euo pipefail
build=$1
shift
limits=(--largest "${LARGEST:-1100000}" --largest-masks "${MASKS:-1100000}")
"$build/bin/gpu_tables" --backend egl "${limits[@]}"
if [ $# -gt 0 ]; then
    "$build/bin/gpu_tables" --backend egl "${limits[@]}" "$@"
    for model in "$@"; do
        echo
        "$build/bin/surfelao" compare "$model" --engines masks --devices cpu,gpu \
            --qualities good --rounds 1 --sample 4000
    done
fi
echo
"$build/bin/drawing_tables" egl
echo
"$build/bin/screen_tables" egl
