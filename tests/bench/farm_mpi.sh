#!/usr/bin/env bash
# A bake in shares under OpenMPI, merged, and compared with a single run byte for byte (docs/farm.md):
#     farm_mpi.sh PROGRAM MODEL [PROCESSES]
set -euo pipefail
program=$(realpath "$1")
model=$(realpath "$2")
processes=${3:-2}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
end=${model##*.}
[ "$end" != stl ] || end=ply
if [ "$(id -u)" = 0 ]; then  # as in a container
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

"$program" bake "$model" -o "whole.$end" > /dev/null
mpirun --oversubscribe -n "$processes" bash -c '
    "$0" bake "$1" -o "$2" --part "$((OMPI_COMM_WORLD_RANK + 1))/$OMPI_COMM_WORLD_SIZE"
' "$program" "$model" "baked.$end"
"$program" merge "baked.$end".*.part
cmp "whole.$end" "baked.$end"
echo "$processes shares: the bytes of a single run"
