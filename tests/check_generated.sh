#!/usr/bin/env bash
# The committed scenes are what their generator makes, byte for byte. check_generated.sh SCRATCH
set -euo pipefail
data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data" && pwd)
rm -rf "$1"
"$data/generate.py" "$1"
for file in "$1"/*; do
    cmp "$file" "$data/$(basename "$file")"
done
