#!/usr/bin/env bash
# The disk engine on this machine's GPU beside its CPU, in one run: gpu_table.sh BUILD [MODEL...]
# Takes the GPU that EGL finds; the first line says which, and says so where it is only software.
set -euo pipefail
build=$1
shift
"$build/bin/gpu_tables" --backend egl
[ $# -eq 0 ] || "$build/bin/gpu_tables" --backend egl "$@"
