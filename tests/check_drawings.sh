#!/usr/bin/env bash
# The committed drawings are what their script makes, byte for byte. check_drawings.sh SCRATCH
set -euo pipefail
drawings=$(cd "$(dirname "${BASH_SOURCE[0]}")/../docs/drawings" && pwd)
trap 'echo "make them anew: docs/drawings/draw.py docs/drawings" >&2' ERR
rm -rf "$1"
"$drawings/draw.py" "$1"
diff <(cd "$1" && ls) <(cd "$drawings" && ls ./*.svg ./*.json | sed 's|^\./||')
for file in "$1"/*; do
    cmp "$file" "$drawings/$(basename "$file")"
done
