#!/usr/bin/env bash
# Everything that docs/gpu.md tells of this machine's GPU, in one go: gpu_table.sh BUILD [MODEL...]
#
# Solving: grids of 81 to 16,641 vertices by brute force and by the tree, bodies of 10^4 to 10^6
# vertices by disks and masks, beside the CPU in the same run, and how much the two differ; the same
# for the models. Drawing: frames per second of triangles and splats at 1920 x 1080, up to 10^6
# vertices. Takes the GPU that EGL finds; the first line of each part says which, and says so where
# it is only software: masks of 10^6 vertices then take most of an hour (MASKS=20000 leaves those
# above 20,000 vertices out).
set -euo pipefail
build=$1
shift
masks=(--largest-masks "${MASKS:-1100000}")
"$build/bin/gpu_tables" --backend egl "${masks[@]}"
[ $# -eq 0 ] || "$build/bin/gpu_tables" --backend egl "${masks[@]}" "$@"
echo
"$build/bin/drawing_tables" egl
